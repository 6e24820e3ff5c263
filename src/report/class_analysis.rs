//! What a class did, as views: how hard each criterion was, which mistakes were made, how far outcomes are reached, who
//! shares wrong answers.

use super::class_summary::{
    AnswersShared, Attainment, ClassSummary, Confusion, ItemStatistics, MistakeMade, People,
};
use super::numbers::counted;
use super::prose;
use super::view::BarView;
use crate::algebra::to_f64;
use crate::lab::{LabDefinition, Points};
use crate::source::sanitize;
use serde::Serialize;
use std::collections::BTreeMap;

#[derive(Serialize)]
pub struct ItemView {
    /// The question's number.
    number: String,
    title: String,
    mean: String,
    possible: String,
    bar: BarView,
    facility: String,
    discrimination: String,
    upper_less_lower: String,
    /// Those who earned the points seem to be the weaker ones.
    doubtful: bool,
    right: usize,
    partly: usize,
    wrong: usize,
    blank: usize,
    open: usize,
    provisional: usize,
}

#[derive(Serialize)]
pub struct MistakeView {
    number: String,
    /// It was one of these; one of them says what is so of an answer that nothing explains.
    explanations: Vec<ExplanationView>,
    count: usize,
    share: String,
    people: PeopleView,
}

#[derive(Serialize)]
pub struct ExplanationView {
    words_html: String,
    for_example: bool,
}

#[derive(Serialize)]
pub struct PeopleView {
    amount: String,
    /// So few that they are named at once.
    few: bool,
    first: Vec<PersonView>,
    more: usize,
}

#[derive(Serialize)]
pub struct PersonView {
    name: String,
    link: String,
}

#[derive(Serialize)]
pub struct ConfusionView {
    columns: Vec<&'static str>,
    rows: Vec<ConfusionRow>,
}

#[derive(Serialize)]
pub struct ConfusionRow {
    right: &'static str,
    /// Whether it is the right one, and how many.
    cells: Vec<(bool, usize)>,
}

#[derive(Serialize)]
pub struct AttainmentView {
    id: String,
    text: String,
    possible: String,
    mean: String,
    target: String,
    reached: String,
    waiting: String,
}

#[derive(Serialize)]
pub struct SharedView {
    people: PeopleView,
    answers: Vec<SharedAnswerView>,
}

#[derive(Serialize)]
pub struct SharedAnswerView {
    place: String,
    answer: String,
    /// `2 of 17 unexplained wrong answers there`
    among: String,
}

/// Kinds of mistakes that are listed.
const MOST_MISTAKES: usize = 60;
/// Groups who share answers that are listed.
const MOST_SHARED: usize = 100;

/// `The statistics are of 41 submissions; 2 of which nothing could be judged are left out.`
pub fn counted_words(summary: &ClassSummary) -> String {
    let handed_in = summary.rows.iter().filter(|row| !row.missing).count() as u64;
    let missing = summary.rows.len() as u64 - handed_in;
    let mut words = format!("The statistics are of {}.", counted(summary.counted, "submission"));
    let left_out = handed_in.saturating_sub(summary.counted);
    if left_out > 0 {
        words += &format!(" Left out: {left_out} of which nothing could be judged.");
    }
    if missing > 0 {
        words += &format!(" Who handed nothing in is not counted ({missing}).");
    }
    let provisional: usize = summary.criteria.iter().map(|one| one.provisional).sum();
    let open: usize = summary.criteria.iter().map(|one| one.open).sum();
    if provisional + open > 0 {
        words += " Marks to be confirmed, and what could not be judged, count as they stand.";
    }
    words
}

/// `n` submissions are counted.
pub fn questions(lab: &LabDefinition, statistics: &[ItemStatistics], n: u64) -> Vec<ItemView> {
    let named = |one: &ItemStatistics| {
        let question = lab.questions.iter().find(|question| question.id == one.id);
        question.map_or_else(|| (String::new(), one.id.clone()), |q| (q.number.clone(), q.title.clone()))
    };
    statistics.iter().map(|one| item(named(one), one, n)).collect()
}

/// `n` submissions are counted.
pub fn criteria(lab: &LabDefinition, statistics: &[ItemStatistics], n: u64) -> Vec<ItemView> {
    let all = lab.questions.iter().flat_map(|q| q.criteria.iter().map(move |criterion| (q, criterion)));
    let names: BTreeMap<&str, (String, String)> =
        all.map(|(q, one)| (one.id.as_str(), (q.number.clone(), one.title.clone()))).collect();
    let named = |one: &ItemStatistics| {
        names.get(one.id.as_str()).cloned().unwrap_or_else(|| (String::new(), one.id.clone()))
    };
    statistics.iter().map(|one| item(named(one), one, n)).collect()
}

fn item((number_of, title): (String, String), one: &ItemStatistics, n: u64) -> ItemView {
    let hundredths = one.mean.filter(|mean| mean.is_finite()).map_or(0, |mean| (mean * 100.0).round() as i64);
    ItemView {
        number: number_of,
        title,
        mean: one.mean.map_or_else(|| "–".to_owned(), |_| Points(hundredths).to_string()),
        possible: one.possible.to_string(),
        bar: BarView::new(Points(hundredths), Points::ZERO, one.possible),
        facility: one.facility.map_or_else(|| "–".to_owned(), percent),
        discrimination: index(one.discrimination),
        upper_less_lower: index(one.upper_less_lower),
        doubtful: one.discrimination.is_some_and(|r| is_doubtful(r, n)),
        right: one.right,
        partly: one.partly,
        wrong: one.wrong,
        blank: one.blank,
        open: one.open,
        provisional: one.provisional,
    }
}

/// Whether a correlation among `n` is so far below 0 that chance gives it only about once in forty times: r < −2/√n.
fn is_doubtful(r: f64, n: u64) -> bool {
    n > 2 && r * (n as f64).sqrt() < -2.0
}

/// `0.42`; a dash where it is not defined.
fn index(value: Option<f64>) -> String {
    let shown = |value: f64| {
        let hundredths = (value * 100.0).round() as i64;
        Points(hundredths).to_string().replace('-', "−")
    };
    value.filter(|value| value.is_finite()).map_or_else(|| "–".to_owned(), shown)
}

/// `72 %`
fn percent(share: f64) -> String {
    format!("{:.0}\u{a0}%", 100.0 * share)
}

/// The most frequent ones, and what nothing explains.
pub fn mistakes(lab: &LabDefinition, made: &[MistakeMade], counted_all: u64) -> Vec<MistakeView> {
    let number_of = |id: &str| {
        let question = lab.questions.iter().find(|question| question.id == id);
        question.map_or_else(|| id.to_owned(), |question| question.number.clone())
    };
    let explanation = |words: &str, for_example: bool| ExplanationView {
        words_html: prose::sentences(&sanitize(words)),
        for_example,
    };
    let view = |one: &MistakeMade| MistakeView {
        number: number_of(&one.question),
        explanations: match one.explanations.as_slice() {
            [] => vec![explanation("No single slip or pair of them explains it.", false)],
            some => some.iter().map(|one| explanation(&one.words, one.for_example)).collect(),
        },
        count: one.people.count,
        share: percent(one.people.count as f64 / counted_all.max(1) as f64),
        people: people(&one.people),
    };
    listed_mistakes(made).map(view).collect()
}

/// How many answers have explanations that are not listed.
pub fn mistakes_not_listed(made: &[MistakeMade]) -> usize {
    let all: usize = made.iter().map(|one| one.people.count).sum();
    all - listed_mistakes(made).map(|one| one.people.count).sum::<usize>()
}

fn listed_mistakes(made: &[MistakeMade]) -> impl Iterator<Item = &MistakeMade> {
    let (unexplained, explained): (Vec<_>, Vec<_>) = made.iter().partition(|one| one.explanations.is_empty());
    explained.into_iter().take(MOST_MISTAKES).chain(unexplained)
}

/// Submissions that are named without being asked for.
const FEW: usize = 2;

fn people(people: &People) -> PeopleView {
    let first = people.first.iter().map(|one| PersonView {
        name: sanitize(&one.name.chars().take(80).collect::<String>()),
        link: one.link.clone(),
    });
    PeopleView {
        amount: counted(people.count, "submission"),
        few: people.count <= FEW,
        first: first.collect(),
        more: people.count.saturating_sub(people.first.len()),
    }
}

/// `None` where no class is asked for.
pub fn classes(table: &Confusion) -> Option<ConfusionView> {
    let rows = table.rows.iter().zip(&table.counts).map(|(right, counts)| ConfusionRow {
        right,
        cells: table.columns.iter().zip(counts).map(|(answered, n)| (answered == right, *n)).collect(),
    });
    let rows: Vec<ConfusionRow> = rows.collect();
    (!rows.is_empty()).then(|| ConfusionView { columns: table.columns.clone(), rows })
}

pub fn outcomes(outcomes: &[Attainment]) -> Vec<AttainmentView> {
    let view = |one: &Attainment| AttainmentView {
        id: one.id.clone(),
        text: one.text.clone(),
        possible: one.possible.to_string(),
        mean: one.mean_share.map_or_else(|| "–".to_owned(), percent),
        target: one.target.as_ref().map_or_else(String::new, |target| percent(to_f64(target))),
        reached: match (&one.target, one.students) {
            (None, _) => String::new(),
            (Some(_), 0) => "–".to_owned(),
            (Some(_), all) => {
                format!("{} ({} of {all})", percent(one.reached as f64 / all as f64), one.reached)
            }
        },
        waiting: match one.waiting {
            0 => String::new(),
            n => format!("of {}, a part waits for a person", counted(n, "student")),
        },
    };
    outcomes.iter().map(view).collect()
}

pub fn shared(groups: &[AnswersShared]) -> Vec<SharedView> {
    let view = |group: &AnswersShared| SharedView {
        people: people(&group.people),
        answers: group
            .answers
            .iter()
            .map(|one| SharedAnswerView {
                place: format!("{}, {}", one.question, one.prompt),
                answer: sanitize(&one.answer),
                among: format!("{} of {} wrong answers there that nothing explains", one.count, one.wrong),
            })
            .collect(),
    };
    groups.iter().take(MOST_SHARED).map(view).collect()
}

#[cfg(test)]
mod tests {
    use super::super::class_summary::Explanation;
    use super::*;

    #[test]
    fn a_negative_discrimination_is_doubtful_beyond_chance_only() {
        for (r, n, doubtful) in [
            (-0.03, 3_000, false),
            (-0.05, 3_000, true),
            (-0.44, 20, false),
            (-0.46, 20, true),
            (0.9, 20, false),
            (-1.0, 2, false),
            (f64::NAN, 20, false),
        ] {
            assert_eq!(is_doubtful(r, n), doubtful, "{r} among {n}");
        }
    }

    #[test]
    fn a_long_list_of_mistakes_is_cut_and_what_nothing_explains_stays() {
        let lab = crate::lab::load(crate::lab::DEFAULT).expect("it is checked");
        let made = |explained: bool, count: usize| MistakeMade {
            question: lab.questions[0].id.clone(),
            explanations: if explained {
                vec![Explanation { words: "A term is missing.".into(), for_example: false }]
            } else {
                Vec::new()
            },
            people: People { count, first: Vec::new() },
        };
        #[track_caller]
        fn check(lab: &LabDefinition, made: &[MistakeMade], want: (usize, usize)) {
            assert_eq!((mistakes(lab, made, 9).len(), mistakes_not_listed(made)), want);
        }
        check(&lab, &[], (0, 0));
        let all = |n: usize| (0..n).map(|_| made(true, 2)).chain([made(false, 7)]).collect::<Vec<_>>();
        check(&lab, &all(MOST_MISTAKES), (MOST_MISTAKES + 1, 0));
        check(&lab, &all(MOST_MISTAKES + 3), (MOST_MISTAKES + 1, 6));
    }
}
