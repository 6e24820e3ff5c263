//! The marks of a class as views: who has how much, what waits, what was adjusted, who is near a boundary.

use super::class_summary::{ClassRow, ClassSummary};
use super::figure::Figure;
use super::figures::{Middle, distribution};
use super::numbers::{counted, number};
use super::pictures::draw;
use super::view::FigureView;
use crate::english::listed;
use crate::lab::{LabDefinition, Points};
use crate::source::sanitize;
use serde::Serialize;

/// A picture of how a class is spread, with the numbers of its bars.
#[derive(Serialize)]
pub struct SpreadView {
    title: &'static str,
    pub figure: FigureView,
    bars: Vec<CountView>,
}

/// A row behind a bar of a plot.
#[derive(Serialize)]
struct CountView {
    range: String,
    count: String,
}

/// How many have a grade.
#[derive(Serialize)]
pub struct GradeView {
    name: String,
    /// `85 to 100`, `below 50`
    range: String,
    count: u64,
}

#[derive(Serialize)]
pub struct BorderlineView {
    /// `1.8 points (2 % of 90)`
    width: String,
    rows: Vec<BorderlineRow>,
    /// Near a boundary, and not listed.
    more: usize,
    /// Marks that cannot be held against a boundary yet.
    waiting: usize,
    /// One of the rows has an adjustment.
    adjusted: bool,
}

#[derive(Serialize)]
struct BorderlineRow {
    name: String,
    link: String,
    mark: String,
    adjustments: AdjustmentsView,
    distance: String,
    /// `below A (85)`
    side: String,
    provisional: String,
}

/// From what a mark was made by adjustments; all empty where there are none.
#[derive(Serialize)]
pub struct AdjustmentsView {
    /// The sum before them: `72`, `waiting`.
    before: String,
    /// `−5: left the bench untidy`
    each: Vec<String>,
}

/// A share in percent of the whole that counts as near a boundary.
const NEAR_PERCENT: i64 = 2;
/// Rows of the borderline list.
const MOST_NEAR: usize = 200;
const MARKS: &str = "Marks";
const QUESTIONS: &str = "Points earned in the questions";

/// The marks, where there are any, and the points earned in the questions, where these are something else.
pub fn spreads(lab: &LabDefinition, summary: &ClassSummary) -> Vec<SpreadView> {
    let possible = questions_possible(lab);
    let marks = (!summary.marks.is_empty()).then(|| distribution(MARKS, &summary.marks, lab.cover.total));
    let questions =
        (!is_of_questions(lab, summary)).then(|| distribution(QUESTIONS, &summary.totals, possible));
    let view = |(title, id, figure): (&'static str, &str, Option<Figure>)| {
        let figure = figure?;
        let drawn = draw(&figure, id).ok()?;
        Some(SpreadView { title, figure: drawn, bars: bars(&figure) })
    };
    [(MARKS, "figure-marks", marks), (QUESTIONS, "figure-distribution", questions)]
        .into_iter()
        .filter_map(view)
        .collect()
}

/// The numbers of the bars. A range holds its lower end; the last also its upper one.
fn bars(figure: &Figure) -> Vec<CountView> {
    let bars = figure.bars.iter().map(|bar| {
        let below = if bar.to < figure.x.to { "below " } else { "" };
        CountView {
            range: format!("{} to {below}{}", number(bar.from, 4), number(bar.to, 4)),
            count: number(bar.height, 9),
        }
    });
    bars.collect()
}

/// The marks are the points earned in the questions.
fn is_of_questions(lab: &LabDefinition, summary: &ClassSummary) -> bool {
    summary.marks == summary.totals && questions_possible(lab) == lab.cover.total
}

fn questions_possible(lab: &LabDefinition) -> Points {
    lab.questions.iter().map(|question| question.points).sum()
}

/// Median, mean and spread of the marks; of the points earned in the questions while no mark is known.
pub fn facts(lab: &LabDefinition, summary: &ClassSummary) -> Vec<(&'static str, String)> {
    let no_mark = summary.marks.is_empty();
    let (totals, possible) = match no_mark {
        true => (&summary.totals, questions_possible(lab)),
        false => (&summary.marks, lab.cover.total),
    };
    let Some(middle) = Middle::of(totals) else { return Vec::new() };
    let names = match no_mark {
        true => ["Median in the questions", "Mean in the questions"],
        false => ["Median mark", "Mean mark"],
    };
    let mut facts = vec![
        (names[0], format!("{} of {possible}", number(middle.median, 4))),
        (names[1], format!("{} of {possible}", number(middle.mean, 4))),
    ];
    if let Some(deviation) = middle.deviation {
        facts.push(("Standard deviation", number(deviation, 3)));
    }
    let questions = Middle::of(&summary.totals).filter(|_| !no_mark && !is_of_questions(lab, summary));
    if let Some(questions) = questions {
        let possible = questions_possible(lab);
        facts.push(("Mean in the questions", format!("{} of {possible}", number(questions.mean, 4))));
    }
    let waiting = marks_waiting(summary);
    if !no_mark && waiting > 0 {
        facts.push(("Marks not known yet", waiting.to_string()));
    }
    facts
}

/// Submissions of the statistics whose mark waits for a person.
fn marks_waiting(summary: &ClassSummary) -> u64 {
    summary.counted.saturating_sub(summary.marks.iter().map(|(_, n)| n).sum())
}

/// What the marks are, and what they wait for: sentences.
///
/// `One mark is not known yet, and not among these: to be given by a person are still Viva (1).`
pub fn words(summary: &ClassSummary) -> String {
    let waiting = marks_waiting(summary);
    let boxes = summary.boxes_waiting.iter().map(|(title, n)| format!("{} ({n})", sanitize(title)));
    let boxes: Vec<String> = boxes.collect();
    let for_what = match boxes.len() {
        0 => String::new(),
        _ => format!(": to be given by a person are still {}", listed(&boxes, "and")),
    };
    let mut words = match (waiting, summary.marks.is_empty()) {
        (0, _) => String::new(),
        (_, true) => format!(
            "No mark is known yet{for_what}. Until then median, mean and picture are of the points earned in the questions."
        ),
        (1, false) => format!("One mark is not known yet, and not among these{for_what}."),
        (n, false) => format!("{n} marks are not known yet, and not among these{for_what}."),
    };
    let adjusted = summary.rows.iter().filter(|row| !row.adjustments.is_empty()).count();
    if adjusted > 0 && !summary.marks.is_empty() {
        words += &format!(
            " Marks are with the adjustments of {}: each stands with its reason under Every report.",
            counted(adjusted, "submission")
        );
    }
    words.trim_start().to_owned()
}

/// How many have each grade, the best first, and how many none; empty where the lab states no grades or no mark is known.
pub fn grades(lab: &LabDefinition, summary: &ClassSummary) -> Vec<GradeView> {
    let mut grades: Vec<_> = lab.grades.iter().collect();
    grades.sort_by_key(|grade| grade.from);
    let Some(lowest) = grades.first().filter(|_| !summary.marks.is_empty()) else { return Vec::new() };
    let count = |from: Points, below: Option<Points>| {
        let here =
            summary.marks.iter().filter(|(mark, _)| *mark >= from && below.is_none_or(|end| *mark < end));
        here.map(|(_, n)| n).sum()
    };
    let none = GradeView {
        name: "none".to_owned(),
        range: format!("below {}", lowest.from),
        count: count(Points(i64::MIN), Some(lowest.from)),
    };
    let mut views = Vec::new();
    for (place, grade) in grades.iter().enumerate() {
        let next = grades.get(place + 1).map(|next| next.from);
        views.push(GradeView {
            name: sanitize(&grade.name),
            range: match next {
                Some(next) => format!("{} to below {next}", grade.from),
                None => format!("{} to {}", grade.from, lab.cover.total),
            },
            count: count(grade.from, next),
        });
    }
    views.reverse();
    views.push(none);
    views
}

/// The mark of a submission: `67`, `waiting`.
pub fn mark(row: &ClassRow) -> String {
    row.mark.map_or_else(|| "waiting".to_owned(), |mark| mark.to_string())
}

pub fn adjustments(row: &ClassRow) -> AdjustmentsView {
    let each = row.adjustments.iter().map(|(points, reason)| {
        let points = match points {
            Some(Points(more @ 1..)) => format!("+{}", Points(*more)),
            Some(points) => points.to_string().replace('-', "−"),
            None => "not known yet".to_owned(),
        };
        format!("{points}: {}", sanitize(&reason.chars().take(200).collect::<String>()))
    });
    let each: Vec<String> = each.collect();
    let before = match (each.is_empty(), row.cover_total) {
        (true, _) => String::new(),
        (false, None) => "waiting".to_owned(),
        (false, Some(total)) => total.to_string(),
    };
    AdjustmentsView { before, each }
}

/// Marks near the boundary of a grade, the nearest first; `None` where the lab states no grades.
pub fn borderline(lab: &LabDefinition, rows: &[ClassRow]) -> Option<BorderlineView> {
    if lab.grades.is_empty() {
        return None;
    }
    let total = lab.cover.total;
    let width = Points(total.0 * NEAR_PERCENT / 100);
    let here = rows.iter().filter(|row| !row.missing);
    let near = here.clone().filter_map(|row| {
        let mark = row.mark?;
        let distance = |from: Points| Points((mark.0 - from.0).abs());
        let nearest = lab.grades.iter().min_by_key(|grade| (distance(grade.from), mark < grade.from))?;
        let distance = distance(nearest.from);
        (distance <= width).then(|| {
            let side = if mark < nearest.from { "below" } else { "above" };
            let side = if distance == Points::ZERO { "at" } else { side };
            let side = format!("{side} {} ({})", nearest.name, nearest.from);
            (distance, mark, side, row)
        })
    });
    let mut near: Vec<_> = near.collect();
    // Stable: those as near stay in the order of the class.
    near.sort_by_key(|(distance, ..)| *distance);
    let more = near.len().saturating_sub(MOST_NEAR);
    near.truncate(MOST_NEAR);
    let view = |(distance, mark, side, row): &(Points, Points, String, &ClassRow)| BorderlineRow {
        name: names(row),
        link: row.report.clone(),
        mark: mark.to_string(),
        adjustments: adjustments(row),
        distance: distance.to_string(),
        side: side.clone(),
        provisional: row.provisional.to_string(),
    };
    Some(BorderlineView {
        width: format!("{} ({NEAR_PERCENT}\u{a0}% of {total})", counted(width, "point")),
        adjusted: near.iter().any(|(.., row)| !row.adjustments.is_empty()),
        rows: near.iter().map(view).collect(),
        more,
        waiting: here.filter(|row| row.mark.is_none()).count(),
    })
}

/// Names of the students, ids where there are none.
fn names(row: &ClassRow) -> String {
    let names = row.students.iter().map(|one| if one.name.trim().is_empty() { &one.id } else { &one.name });
    let names = names.map(|name| name.chars().take(80).collect::<String>());
    sanitize(&names.collect::<Vec<_>>().join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::Grade;
    use crate::submission::Student;

    fn lab(grades: &[(&str, i64)]) -> LabDefinition {
        let mut lab = crate::lab::load(crate::lab::DEFAULT).expect("it is checked");
        let grade = |(name, from): &(&str, i64)| Grade { name: (*name).to_owned(), from: Points(*from) };
        lab.grades = grades.iter().map(grade).collect();
        lab
    }

    /// Somebody whose cover sheet adds up to `before`, with these adjustments, and that mark; in hundredths.
    fn row(
        name: &str,
        before: Option<i64>,
        adjustments: &[(Option<i64>, &str)],
        mark: Option<i64>,
    ) -> ClassRow {
        ClassRow {
            students: vec![Student { id: "EE-1".into(), name: name.into() }],
            file: String::new(),
            report: String::new(),
            numbers: String::new(),
            earned: Points(4000),
            possible: Points(4500),
            provisional: Points::ZERO,
            findings: 0,
            to_review: 0,
            cover_total: before.map(Points),
            adjustments: adjustments.iter().map(|(by, why)| (by.map(Points), (*why).to_owned())).collect(),
            mark: mark.map(Points),
            readable: true,
            missing: false,
            late: false,
            held: false,
        }
    }

    fn summary(marks: &[(i64, u64)], counted: u64, boxes: &[(&str, u64)]) -> ClassSummary {
        ClassSummary {
            counted,
            totals: vec![(Points(4000), counted)],
            marks: marks.iter().map(|(mark, n)| (Points(*mark), *n)).collect(),
            boxes_waiting: boxes.iter().map(|(title, n)| ((*title).to_owned(), *n)).collect(),
            ..ClassSummary::default()
        }
    }

    #[test]
    fn what_is_told_is_the_mark_and_that_some_are_not_known_is_said() {
        #[track_caller]
        fn check(of: &ClassSummary, titles: &[&str], median: (&str, &str), want: &str) {
            let lab = lab(&[]);
            let shown: Vec<&str> = spreads(&lab, of).iter().map(|one| one.title).collect();
            assert_eq!(shown, titles);
            assert_eq!(facts(&lab, of)[0], (median.0, median.1.to_owned()));
            assert_eq!(words(of), want);
        }
        check(
            &summary(&[], 3, &[("Lab performance", 3), ("Viva", 2)]),
            &[QUESTIONS],
            ("Median in the questions", "40 of 45"),
            "No mark is known yet: to be given by a person are still Lab performance (3) and Viva (2). Until then median, mean and \
             picture are of the points earned in the questions.",
        );
        check(
            &summary(&[(6000, 1), (7000, 1)], 3, &[("Viva", 1)]),
            &[MARKS, QUESTIONS],
            ("Median mark", "65 of 100"),
            "One mark is not known yet, and not among these: to be given by a person are still Viva (1).",
        );
        check(&summary(&[(6000, 3)], 3, &[]), &[MARKS, QUESTIONS], ("Median mark", "60 of 100"), "");
        let rows =
            vec![row("A", Some(6500), &[(Some(-500), "late")], Some(6000)), row("B", Some(1), &[], Some(1))];
        check(
            &ClassSummary { rows, ..summary(&[(6000, 3)], 3, &[]) },
            &[MARKS, QUESTIONS],
            ("Median mark", "60 of 100"),
            "Marks are with the adjustments of 1 submission: each stands with its reason under Every report.",
        );
        let mut only_questions = lab(&[]);
        only_questions.cover.total = Points(4500);
        assert_eq!(
            spreads(&only_questions, &summary(&[(4000, 3)], 3, &[])).len(),
            1,
            "the same is shown once"
        );
    }

    #[test]
    fn an_adjustment_stands_with_the_sum_before_it_and_its_reason() {
        #[track_caller]
        fn check(before: Option<i64>, given: &[(Option<i64>, &str)], want: (&str, &[&str])) {
            let view = adjustments(&row("A", before, given, None));
            assert_eq!(
                (view.before.as_str(), view.each),
                (want.0, want.1.iter().map(|s| s.to_string()).collect())
            );
        }
        check(Some(7200), &[], ("", &[]));
        check(None, &[], ("", &[]));
        check(Some(7200), &[(Some(-550), "late"), (Some(200), "kind")], ("72", &["−5.5: late", "+2: kind"]));
        check(None, &[(None, "late")], ("waiting", &["not known yet: late"]));
    }

    #[test]
    fn borders_are_held_against_the_mark_with_adjustments() {
        let lab = lab(&[("pass", 5000), ("distinction", 8500)]);
        // 2 % of 100 points: 48 to 52, 83 to 87.
        let rows = [
            row("far", Some(6000), &[], Some(6000)),
            row("just out", Some(4799), &[], Some(4799)),
            row("just in", Some(4800), &[], Some(4800)),
            row("late", Some(5300), &[(Some(-500), "late")], Some(4800)),
            row("late and far", Some(5000), &[(Some(-500), "late")], Some(4500)),
            row("at", Some(8500), &[], Some(8500)),
            row("waits", None, &[(Some(-500), "late")], None),
        ];
        let view = borderline(&lab, &rows).expect("it states grades");
        let found: Vec<_> =
            view.rows.iter().map(|one| (&*one.name, &*one.side, &*one.adjustments.before)).collect();
        assert_eq!(
            found,
            [
                ("at", "at distinction (85)", ""),
                ("just in", "below pass (50)", ""),
                ("late", "below pass (50)", "53")
            ]
        );
        assert_eq!((view.waiting, view.adjusted), (1, true));
        assert!(borderline(&super::tests::lab(&[]), &rows).is_none(), "none are made up");
    }

    #[test]
    fn a_grade_begins_with_its_own_boundary() {
        let lab = lab(&[("pass", 5000), ("distinction", 8500)]);
        let of = summary(&[(0, 1), (4999, 2), (5000, 4), (8499, 8), (8500, 16), (10_000, 32)], 63, &[]);
        let found = grades(&lab, &of);
        let found: Vec<_> = found.iter().map(|one| (&*one.name, &*one.range, one.count)).collect();
        assert_eq!(
            found,
            [("distinction", "85 to 100", 48), ("pass", "50 to below 85", 12), ("none", "below 50", 3)]
        );
        assert!(grades(&lab, &summary(&[], 3, &[])).is_empty(), "no mark is known");
        assert!(grades(&super::tests::lab(&[]), &of).is_empty());
    }
}
