use super::closeness::percent;
use super::follow_through::{Earned, FollowThrough, OWN_FUNCTION, question_name, root_of};
use super::mark::{Mark, share};
use super::{Evidence, Explanation, Guard, Verdict};
use crate::algebra::Rational;
use crate::lab::{Check, Criterion, LabDefinition, Points, Question, SystemRef};

/// Gives back to a later transfer function what it lost by a mistake that was charged at an earlier one of the same model.
///
/// It is the same mistake when what explains the later function is part of what explains the earlier one, and when a common
/// factor is left in once more. The lab says what part of the points is given back.
pub(super) fn spare(lab: &LabDefinition, earned: Earned<'_>, marks: &mut [Vec<Mark>]) {
    let part = &lab.follow_through.same_mistake;
    if part.is_zero() {
        return;
    }
    let functions = functions(lab);
    for (place, later) in functions.iter().enumerate() {
        let earlier: Vec<_> =
            functions[..place].iter().filter(|earlier| earlier.of.model == later.of.model).collect();
        let charged_by = |mistake: Mistake| {
            let of = |earlier: &&&Function<'_>| match mistake {
                Mistake::NotCancelled => true,
                Mistake::Explained => is_same(later.explanations(marks), earlier.explanations(marks)),
            };
            earlier
                .iter()
                .filter(of)
                .find_map(|earlier| Some((earlier.question, earlier.root(mistake, marks, earned)?)))
        };
        let charged = [Mistake::NotCancelled, Mistake::Explained].map(|one| (one, charged_by(one)));
        for (index, criterion) in &later.criteria {
            let Some(mark) = marks.get_mut(later.place).and_then(|marks| marks.get_mut(*index)) else {
                continue;
            };
            let lost = matches!(mark.verdict, Verdict::Wrong | Verdict::Partly);
            let by = charged.iter().find(|(mistake, _)| *mistake == Mistake::of(mark));
            if let (true, Some((_, Some((question, root))))) = (lost, by) {
                *mark = spared(criterion, mark, part, question, root);
            }
        }
    }
}

/// Why a criterion on a transfer function lost points.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Mistake {
    NotCancelled,
    /// What the function's explanations explain, who look at it with common factors cancelled.
    Explained,
}

impl Mistake {
    fn of(mark: &Mark) -> Self {
        if mark.code == "structure.not_cancelled" { Self::NotCancelled } else { Self::Explained }
    }
}

/// The criteria on one transfer function.
struct Function<'a> {
    of: &'a SystemRef,
    question: &'a Question,
    /// Of the question, in the lab.
    place: usize,
    /// With their places in the question.
    criteria: Vec<(usize, &'a Criterion)>,
}

fn functions(lab: &LabDefinition) -> Vec<Function<'_>> {
    let mut found: Vec<Function<'_>> = Vec::new();
    for (place, question) in lab.questions.iter().enumerate() {
        for (index, criterion) in question.criteria.iter().enumerate() {
            let Some(of) = criterion.check.transfer_function() else { continue };
            let same = |known: &&mut Function<'_>| {
                known.of == of && known.criteria.iter().any(|(_, one)| one.field == criterion.field)
            };
            match found.iter_mut().find(same) {
                Some(known) => known.criteria.push((index, criterion)),
                None => found.push(Function { of, question, place, criteria: vec![(index, criterion)] }),
            }
        }
    }
    found
}

impl Function<'_> {
    fn marks<'m>(&self, marks: &'m [Vec<Mark>]) -> impl Iterator<Item = (&Criterion, &'m Mark)> {
        let marks = marks.get(self.place).map_or(&[][..], Vec::as_slice);
        self.criteria.iter().filter_map(|(index, criterion)| Some((*criterion, marks.get(*index)?)))
    }

    fn explanations<'m>(&self, marks: &'m [Vec<Mark>]) -> &'m [Explanation] {
        let found = self.marks(marks).find_map(|(_, mark)| mark.diagnosis.as_ref());
        found.map_or(&[], |diagnosis| diagnosis.explanations.as_slice())
    }

    /// Where the mistake was charged; `None` when no points were lost by it.
    fn root(&self, mistake: Mistake, marks: &[Vec<Mark>], earned: Earned<'_>) -> Option<String> {
        self.marks(marks)
            .filter(|(_, mark)| Mistake::of(mark) == mistake)
            .find_map(|(criterion, mark)| root_of(criterion, mark, earned))
    }
}

fn is_same(later: &[Explanation], earlier: &[Explanation]) -> bool {
    let forgivable = |one: &&Explanation| {
        // Whoever takes one operating point for another makes a new choice each time.
        !one.mistakes.is_empty() && !one.code.split('+').any(|code| code == "point.other")
    };
    later.iter().filter(forgivable).any(|later| {
        earlier.iter().any(|earlier| later.mistakes.iter().all(|change| earlier.mistakes.contains(change)))
    })
}

fn spared(criterion: &Criterion, base: &Mark, part: &Rational, question: &Question, root: &str) -> Mark {
    let lost = Points(criterion.points.0 - base.earned.0);
    let back = share(lost, part);
    let earned = base.earned + back;
    let mut reason = format!(
        "{} It is the same mistake as in {}, where it was charged.",
        base.evidence.reason,
        question_name(question)
    );
    if *part < Rational::ONE {
        reason.push_str(&format!(" {} of what it would cost here is given back.", percent(part)));
    }
    let own = OWN_FUNCTION.to_owned();
    Mark {
        verdict: if back == lost { Verdict::Right } else { Verdict::Partly },
        code: match criterion.check {
            Check::Numerator { .. } => "numerator.same_mistake",
            Check::Denominator { .. } => "denominator.same_mistake",
            _ => "structure.same_mistake",
        },
        earned,
        evidence: Evidence { reason: reason.trim().to_owned(), ..base.evidence.clone() },
        follow_through: Some(FollowThrough {
            credited: true,
            guard: Guard::Passed,
            root: root.to_owned(),
            own,
        }),
        spared: back,
        withheld: Points(lost.0 - back.0),
        ..base.clone()
    }
}
