//! What of a scorecard students get to see. What is not released is taken out before anything is shown, so that no page can tell it.

use crate::grading::{ItemScore, Ledger, Scorecard, Verdict};
use crate::lab::{Check, LabDefinition, Release};
use std::borrow::Cow;
use std::collections::BTreeMap;

/// The scorecard without what `release` withholds. Points stay: whether they are shown is for the page to say.
///
/// Without solutions, titles of criteria and reasons go too, since they tell them (`It swings about the bottom`), and so does
/// what may explain a mistake; what stays is the verdict, the student's own words, and what of them contradicts the student's
/// own answers.
pub fn released<'a>(scorecard: &'a Scorecard, lab: &LabDefinition, release: Release) -> Cow<'a, Scorecard> {
    if release == Release::ALL {
        return Cow::Borrowed(scorecard);
    }
    let mut card = scorecard.clone();
    let criteria = lab.questions.iter().flat_map(|question| &question.criteria);
    let checks: BTreeMap<&str, &Check> = criteria.map(|one| (one.id.as_str(), &one.check)).collect();
    for item in card.questions.iter_mut().flat_map(|question| &mut question.items) {
        if !release.solutions {
            item.title =
                checks.get(item.id.as_str()).map_or("Criterion", |check| plain_title(check)).to_owned();
            without_solution(item);
        }
        if !release.feedback {
            without_feedback(item);
        }
    }
    if !(release.feedback && release.marks) {
        card.ledger = Ledger::default();
    }
    Cow::Owned(card)
}

fn without_solution(item: &mut ItemScore) {
    let evidence = &mut item.evidence;
    evidence.expected.clear();
    // Nothing of the answer itself is needed to say that there is none.
    if !matches!(item.verdict, Verdict::Blank | Verdict::Unreadable) {
        evidence.reason.clear();
    }
    evidence.conflicts.retain(|conflict| conflict.own);
    for phrase in &mut evidence.phrases {
        phrase.concept.clear();
    }
    item.diagnosis = None;
}

fn without_feedback(item: &mut ItemScore) {
    item.evidence = Default::default();
    item.diagnosis = None;
    item.follow_through = None;
    item.override_reason = None;
}

/// What a criterion is about, without what is right.
fn plain_title(check: &Check) -> &'static str {
    match check {
        Check::Structure { .. } => "Structure",
        Check::Numerator { .. } => "Numerator",
        Check::Denominator { .. } => "Denominator",
        Check::Poles { .. } => "Poles",
        Check::Stability { .. } => "Stability",
        Check::Feature { .. } => "Value of the response",
        Check::Rest { .. } => "Value at rest",
        Check::Shape { .. } => "Shape",
        Check::Plot { .. } => "Plot",
        Check::Concepts { .. } => "In words",
        Check::Tangent { .. } => "Tangent",
        Check::Nonlinearity { .. } => "Kind of nonlinearity",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grading::grade;
    use crate::report::numbers::typeset;
    use crate::report::tests::{FIXTURE, check_page};
    use crate::source::sanitize;
    use crate::submission::{self, NoFiles, Submission};
    use std::collections::BTreeSet;

    const NOTHING: Release = Release { marks: false, feedback: false, solutions: false };

    /// Every sample submission.
    fn samples() -> Vec<Submission> {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/submissions");
        let mut paths: Vec<_> =
            std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
        paths.sort();
        let answers = paths.iter().filter(|path| path.extension().is_some_and(|end| end == "yaml"));
        let read = |path: &std::path::PathBuf| {
            submission::read("s", "s.yaml", &std::fs::read(path).unwrap(), &FIXTURE.lab.sheet, &NoFiles)
        };
        answers.map(read).collect()
    }

    fn card(submission: &Submission) -> Scorecard {
        grade(&FIXTURE.lab, &FIXTURE.reference, &FIXTURE.catalogue, submission, None)
    }

    /// What a reader sees of HTML, roughly.
    fn visible(html: &str) -> String {
        let tags = html.split('<').map(|part| part.split_once('>').map_or(part, |(_, text)| text));
        tags.collect::<Vec<_>>().join(" ")
    }

    /// Numbers of four digits and more.
    fn numbers(text: &str) -> BTreeSet<String> {
        let parts = text.split(|c: char| !c.is_ascii_digit() && c != '.').map(|part| part.trim_matches('.'));
        let long = |part: &&str| part.chars().filter(char::is_ascii_digit).count() >= 4;
        parts.filter(long).map(str::to_owned).collect()
    }

    #[test]
    fn what_is_not_released_is_nowhere_on_the_page() {
        let (lab, kit) = (&FIXTURE.lab, &FIXTURE.kit);
        let prompts = lab.questions.iter().flat_map(|q| &q.fields).map(|field| field.prompt.as_str());
        let texts = lab.questions.iter().flat_map(|q| [&q.text, &q.title, &q.number]);
        let asked = texts.map(String::as_str).chain(prompts).collect::<Vec<_>>().join(" ");
        let right: String = kit
            .questions
            .iter()
            .flat_map(|question| &question.fields)
            .map(|field| visible(&field.reference_html))
            .collect::<Vec<_>>()
            .join(" ");
        let criteria = lab.questions.iter().flat_map(|question| &question.criteria);
        let criteria: BTreeMap<&str, &Check> = criteria.map(|one| (one.id.as_str(), &one.check)).collect();
        for submission in samples() {
            let name = submission.students.first().map_or(String::new(), |one| one.id.clone());
            let card = card(&submission);
            let release = Release { solutions: false, ..Release::ALL };
            let page = kit.released_page(&submission, &card, release);
            // Who answers `inf` sees it again.
            if !submission.source.text.contains("inf") {
                check_page(&name, &page);
            }
            let main = &page[page.find("<main").unwrap()..];
            let items = card.questions.iter().flat_map(|question| &question.items);
            let own: String = items.clone().map(|item| item.evidence.found.as_str()).collect();
            let theirs = format!("{asked} {own} {}", submission.source.text);
            let mut secret = numbers(&right);
            for item in items {
                secret.extend(numbers(&item.evidence.expected));
                let expected = typeset(&sanitize(&item.evidence.expected));
                assert!(expected.is_empty() || !visible(main).contains(&expected), "{name}: {expected}");
                let title = &item.title;
                let plain = criteria.get(item.id.as_str()).map_or("", |check| plain_title(check));
                let known = title == plain || theirs.contains(title.as_str());
                assert!(known || !main.contains(title.as_str()), "{name}: title {title}");
            }
            let shown = numbers(&visible(main));
            let leaks: Vec<_> =
                secret.intersection(&shown).filter(|number| !theirs.contains(number.as_str())).collect();
            assert!(leaks.is_empty(), "{name}: {leaks:?}");
            for words in ["Reference", "Expected", "How it may have come about", "<svg"] {
                assert!(!main.contains(words), "{name}: {words}");
            }
        }
    }

    #[test]
    fn marks_and_feedback_are_withheld_each_by_itself() {
        for submission in samples() {
            let card = card(&submission);
            let page = |release| {
                let page = FIXTURE.kit.released_page(&submission, &card, release);
                if !submission.source.text.contains("inf") {
                    check_page("released", &page);
                }
                page[page.find("<header").unwrap()..].to_owned()
            };
            let without_marks = page(Release { marks: false, ..Release::ALL });
            let total = format!("{} of {}", card.total.earned, card.total.possible);
            for words in [
                "class=\"points\"",
                "class=\"meter\"",
                total.as_str(),
                "points in the questions",
                "Where the points went",
            ] {
                let own = submission.source.text.contains(words);
                assert!(own || !visible(&without_marks).contains(words), "{words}");
                assert!(words.starts_with("class") <= !without_marks.contains(words), "{words}");
            }
            let without_feedback = page(Release { marks: true, ..NOTHING });
            assert!(!without_feedback.contains("class=\"verdict"));
            for item in card.questions.iter().flat_map(|question| &question.items) {
                let reason = crate::report::prose::sentences(&sanitize(&item.evidence.reason));
                assert!(reason.len() < 30 || !without_feedback.contains(&reason), "{reason}");
            }
            let nothing = page(NOTHING);
            assert!(nothing.contains("Marks, feedback and solutions are not released yet."));
            assert!(!nothing.contains("<h3>Marks</h3>"));
        }
    }

    #[test]
    fn all_of_it_is_the_report_as_it_was() {
        let submission = &FIXTURE.lab.model_answer;
        let card = card(submission);
        assert_eq!(*released(&card, &FIXTURE.lab, Release::ALL), card);
    }
}
