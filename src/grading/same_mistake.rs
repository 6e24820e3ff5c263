use super::closeness::percent;
use super::follow_through::{Earned, FollowThrough, OWN_FUNCTION, question_name, root_of};
use super::grade::Grader;
use super::mark::{Mark, share};
use super::{Evidence, Explanation, Guard, Verdict};
use crate::algebra::Rational;
use crate::lab::{Check, Criterion, LabDefinition, Points, Question, SystemRef};

/// Gives back to a later transfer function what it lost by a mistake that was charged at an earlier one of the same model.
///
/// It is the same mistake when what explains the later function is part of what explains the earlier one, and when a common
/// factor is left in once more. Where another mistake came with it, the later function is held against what the earlier
/// mistake alone leads to. The lab says what part of the points is given back.
pub(super) fn spare(lab: &LabDefinition, grader: &Grader<'_>, earned: Earned<'_>, marks: &mut [Vec<Mark>]) {
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
        let not_cancelled = charged_by(Mistake::NotCancelled);
        let explained = charged_by(Mistake::Explained);
        let again = match explained {
            Some(_) => None,
            None => earlier.iter().find_map(|earlier| {
                let root = earlier.root(Mistake::Explained, marks, earned)?;
                Some((earlier.question, root, made_again(grader, later, earlier, marks)?))
            }),
        };
        for (place, (index, criterion)) in later.criteria.iter().enumerate() {
            let Some(mark) = marks.get_mut(later.place).and_then(|marks| marks.get_mut(*index)) else {
                continue;
            };
            if !matches!(mark.verdict, Verdict::Wrong | Verdict::Partly) {
                continue;
            }
            let charged = match Mistake::of(mark) {
                Mistake::NotCancelled => &not_cancelled,
                Mistake::Explained => &explained,
            };
            let back = match (charged, &again) {
                (Some((question, root)), _) => Some(Back::all(criterion, mark, question, root)),
                (None, Some((question, root, without))) if Mistake::of(mark) == Mistake::Explained => {
                    without.get(place).map(|without| Back::but_for(without, criterion, mark, question, root))
                }
                _ => None,
            };
            if let Some(back) = back.filter(|back| back.without > mark.earned) {
                *mark = spared(criterion, mark, part, back);
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

/// The later function's marks, held against what mistakes of the earlier one lead to there: those that earn the most, where
/// that is more than by the reference.
fn made_again(
    grader: &Grader<'_>,
    later: &Function<'_>,
    earlier: &Function<'_>,
    marks: &[Vec<Mark>],
) -> Option<Vec<Mark>> {
    let criteria: Vec<&Criterion> = later.criteria.iter().map(|(_, criterion)| *criterion).collect();
    let sum = |marks: &[Mark]| marks.iter().map(|mark| mark.earned).sum::<Points>();
    let base: Points = later.marks(marks).map(|(_, mark)| mark.earned).sum();
    let mut best: Option<Vec<Mark>> = None;
    for explanation in earlier.explanations(marks).iter().filter(|one| is_forgivable(one)) {
        let all: Vec<&str> = explanation.mistakes.iter().map(String::as_str).collect();
        let each = all.chunks(1).filter(|_| all.len() > 1);
        for mistakes in std::iter::once(all.as_slice()).chain(each) {
            let Some(next) = grader.with_mistakes(&criteria, later.of, mistakes) else { continue };
            if sum(&next) > best.as_deref().map_or(base, sum) {
                best = Some(next);
            }
        }
    }
    best
}

/// Whoever takes one operating point for another makes a new choice each time.
fn is_forgivable(one: &Explanation) -> bool {
    !one.mistakes.is_empty() && !one.code.split('+').any(|code| code == "point.other")
}

fn is_same(later: &[Explanation], earlier: &[Explanation]) -> bool {
    later.iter().filter(|one| is_forgivable(one)).any(|later| {
        earlier.iter().any(|earlier| later.mistakes.iter().all(|change| earlier.mistakes.contains(change)))
    })
}

/// What an earlier mistake cost again.
struct Back<'a> {
    root: &'a str,
    /// What the criterion earns without it.
    without: Points,
    why: String,
}

impl<'a> Back<'a> {
    /// Nothing else was wrong.
    fn all(criterion: &Criterion, base: &Mark, question: &Question, root: &'a str) -> Self {
        let why = format!(
            "{} It is the same mistake as in {}, where it was charged.",
            base.evidence.reason,
            question_name(question)
        );
        Self { root, without: criterion.points, why }
    }

    /// `without`: the mark by what the earlier mistake alone leads to.
    fn but_for(
        without: &Mark,
        criterion: &Criterion,
        base: &Mark,
        question: &Question,
        root: &'a str,
    ) -> Self {
        let mut why = format!(
            "{} The mistake of {} is in it again, where it was charged.",
            base.evidence.reason,
            question_name(question)
        );
        if without.earned < criterion.points {
            why.push_str(&format!(" Beside it: {}", without.evidence.reason));
        }
        Self { root, without: without.earned, why }
    }
}

fn spared(criterion: &Criterion, base: &Mark, part: &Rational, back: Back<'_>) -> Mark {
    let lost = Points(back.without.0 - base.earned.0);
    let given = share(lost, part);
    let earned = base.earned + given;
    let mut reason = back.why;
    if *part < Rational::ONE {
        reason.push_str(&format!(" {} of what it would cost here is given back.", percent(part)));
    }
    let own = OWN_FUNCTION.to_owned();
    Mark {
        verdict: if earned == criterion.points { Verdict::Right } else { Verdict::Partly },
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
            root: back.root.to_owned(),
            own,
        }),
        spared: given,
        withheld: Points(lost.0 - given.0),
        ..base.clone()
    }
}
