use super::Verdict;
use super::accepted::operating_point;
use super::grade::Grader;
use super::mark::Mark;
use crate::lab::{Check, Criterion, LabDefinition, Points};
use crate::model::Doubts;

/// Leaves to a person what rounded coefficients of the reference cannot decide: nobody loses a mark by it.
///
/// A word of stability always, when that is in doubt; anything else that rests on it when it is not right by the reference.
pub(super) fn leave_open(lab: &LabDefinition, grader: &Grader<'_>, marks: &mut [Vec<Mark>]) {
    for (question, marks) in lab.questions.iter().zip(marks) {
        for (criterion, mark) in question.criteria.iter().zip(marks) {
            let Some(doubts) = doubts(grader, criterion) else { continue };
            let is_word = matches!(criterion.check, Check::Stability { .. });
            let judged = match mark.verdict {
                Verdict::Wrong | Verdict::Partly => true,
                Verdict::Right => is_word,
                _ => false,
            };
            if judged {
                *mark = left_open(mark, doubts);
            }
        }
    }
}

/// What is in doubt of the system that a criterion is about, as far as it may turn the mark.
fn doubts(grader: &Grader<'_>, criterion: &Criterion) -> Option<Doubts> {
    let point = operating_point(grader.reference, criterion.check.system()?)?;
    let all = point.accepted.iter().map(|one| one.doubts);
    let doubts = all.reduce(|a, b| Doubts {
        form: a.form || b.form,
        stability: a.stability || b.stability,
        whole_state: a.whole_state || b.whole_state,
    })?;
    let matters = match &criterion.check {
        Check::Structure { .. } | Check::Numerator { .. } | Check::Denominator { .. } => doubts.form,
        Check::Poles { .. } => doubts.form || doubts.stability,
        Check::Stability { .. } | Check::Shape { .. } | Check::Feature { .. } | Check::Plot { .. } => {
            doubts.stability
        }
        _ => false,
    };
    matters.then_some(doubts)
}

fn left_open(mark: &Mark, doubts: Doubts) -> Mark {
    let mut evidence = mark.evidence.clone();
    evidence.reason = format!(
        "{} But the coefficients of this system are rounded, and {} cannot be told from them. A person will mark it.",
        evidence.reason,
        doubts.words()
    )
    .trim()
    .to_owned();
    Mark {
        verdict: Verdict::Unmarked,
        code: "inconclusive",
        earned: Points::ZERO,
        evidence,
        provisional: true,
        diagnosis: None,
        follow_through: None,
        spared: Points::ZERO,
        withheld: Points::ZERO,
        ..mark.clone()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grading::{Catalogue, grade};
    use crate::reference::Reference;
    use crate::source::SourceText;
    use crate::submission::{NoFiles, read};

    /// A spring of √2 N/m, damped by what is nothing but rounding.
    const LAB: &str = "lab: open
models:
  spring:
    coordinates: {x: {unit: m}}
    inputs: {F: {unit: N}}
    equations: [\"x'' + (sqrt(2)^2 - 2)*x' + sqrt(2)*x = F\"]
    operating_points: {rest: {}}
questions:
  g: {points: 5, answer: transfer_function}
  response:
    points: 3
    response: impulse
    fields: {poles: poles, word: stability, shape: shape}
";

    #[test]
    fn nobody_loses_a_mark_by_a_verdict_that_rounding_leaves_open() {
        let lab = LabDefinition::parse(SourceText::new("lab.yaml", LAB))
            .unwrap_or_else(|error| panic!("{}", error.render(false)));
        let reference = Reference::compute(&lab).unwrap();
        assert!(reference.models[0].operating_points[0].main().doubts.stability);
        for (answers, id, code) in [
            ("  response: {word: stable}", "response.word", "inconclusive"),
            ("  response: {word: marginally stable}", "response.word", "inconclusive"),
            ("  response: {word: unstable}", "response.word", "inconclusive"),
            ("  response: {poles: ±1.1892j}", "response.poles", "inconclusive"),
            ("  response: {poles: -3 ± 1.1892j}", "response.poles", "inconclusive"),
            ("  response: {shape: undamped oscillation}", "response.shape", "right"),
            ("  response: {shape: growing oscillation}", "response.shape", "inconclusive"),
            ("  g: 1/(s^2 + 1)", "g.denominator", "inconclusive"),
            ("  g: 1/(s^2 + 1)", "response.word", "blank"),
        ] {
            let text = format!("lab: open\nstudent: {{id: a, name: A}}\nanswers:\n{answers}\n");
            let submission = read("a", "a.yaml", text.as_bytes(), &lab.sheet, &NoFiles);
            let card = grade(&lab, &reference, &Catalogue::default(), &submission, None);
            let items = card.questions.iter().flat_map(|question| &question.items);
            let item = items.into_iter().find(|item| item.id == id).unwrap();
            assert_eq!(item.code, code, "{answers}: {:?}", item.evidence);
        }
    }
}
