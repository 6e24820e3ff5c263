use super::closeness::percent;
use super::follow_through::{Earned, FollowThrough, OWN_FUNCTION, question_name, root_of};
use super::grade::Grader;
use super::mark::{Mark, share};
use super::{Evidence, Explanation, Guard, Verdict};
use crate::algebra::Rational;
use crate::lab::{Check, Criterion, LabDefinition, Points, Question, SystemRef};

/// Gives back to a later transfer function what it lost by a mistake that was charged at an earlier one.
///
/// It is the same mistake when what explains the later function is part of what explains the earlier one, and when a common
/// factor is left in once more. Of another model only the value of a parameter that both have can be mistaken again. Where another mistake came with it, the later function is held against what the earlier
/// mistake alone leads to. The lab says what part of the points is given back.
pub(super) fn spare(lab: &LabDefinition, grader: &Grader<'_>, earned: Earned<'_>, marks: &mut [Vec<Mark>]) {
    let part = &lab.follow_through.same_mistake;
    if part.is_zero() {
        return;
    }
    let functions = functions(lab);
    for (place, later) in functions.iter().enumerate() {
        // Those of the same model first.
        let (own, others): (Vec<_>, Vec<_>) =
            functions[..place].iter().partition(|earlier| earlier.of.model == later.of.model);
        let earlier = || own.iter().chain(&others).copied();
        let charged_by = |mistake: Mistake| {
            let of = |earlier: &&Function<'_>| match mistake {
                Mistake::NotCancelled => earlier.of.model == later.of.model,
                Mistake::Explained => {
                    let about = Shared::between(later, earlier);
                    is_same(later.explanations(marks), earlier.explanations(marks), about)
                }
            };
            earlier()
                .filter(of)
                .find_map(|earlier| Some((earlier.question, earlier.root(mistake, marks, earned)?)))
        };
        let not_cancelled = charged_by(Mistake::NotCancelled);
        let explained = charged_by(Mistake::Explained);
        let again = match explained {
            Some(_) => None,
            None => earlier().find_map(|earlier| {
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
        let all = Shared::between(later, earlier).mistakes(explanation);
        if all.is_empty() {
            continue;
        }
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

fn is_same(later: &[Explanation], earlier: &[Explanation], shared: Shared) -> bool {
    later.iter().filter(|one| is_forgivable(one)).any(|later| {
        let all = |earlier: &Explanation| {
            let before = shared.mistakes(earlier);
            later.mistakes.iter().all(|change| before.contains(&change.as_str()))
        };
        earlier.iter().any(all)
    })
}

/// What two transfer functions have in common, in which the same mistake can be made.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Shared {
    Model,
    /// Parameters have one value in all of a lab.
    Parameters,
}

impl Shared {
    fn between(later: &Function<'_>, earlier: &Function<'_>) -> Self {
        if later.of.model == earlier.of.model { Self::Model } else { Self::Parameters }
    }

    /// The mistakes of an explanation that can be made in both.
    fn mistakes(self, one: &Explanation) -> Vec<&str> {
        let codes = one.code.split('+').map(Some).chain(std::iter::repeat(None));
        let both = one.mistakes.iter().zip(codes).filter(|(_, code)| {
            self == Self::Model || code.is_some_and(|code| code.starts_with("parameter."))
        });
        both.map(|(change, _)| change.as_str()).collect()
    }
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

#[cfg(test)]
mod tests {
    use crate::grading::{Catalogue, grade};
    use crate::lab;
    use crate::reference::Reference;
    use crate::submission::{NoFiles, read};

    /// The fast motor, and the same without its inductance: two models of the same parameters.
    #[test]
    fn a_parameter_mistaken_in_one_model_is_the_same_mistake_in_another() {
        let lab = lab::load("dc-motor").unwrap();
        let reference = Reference::compute(&lab).unwrap();
        let catalogue = Catalogue::new(&lab, &reference);
        let cubic = |s2: &str, s: &str| format!("0.0274/(8.8781e-12 s^3 + {s2} s^2 + {s} s)");
        for (what, whole, reduced, code) in [
            (
                "R is 40 Ω in both",
                cubic("1.29136e-4", "8.91068e-4"),
                "0.0274/(1.29136e-4 s^2 + 8.91068e-4 s)",
                "denominator.same_mistake",
            ),
            (
                "R is 40 Ω in the second only",
                cubic("1.291361e-5", "7.64791e-4"),
                "0.0274/(1.29136e-4 s^2 + 8.91068e-4 s)",
                "denominator.value",
            ),
            (
                "R is 40 Ω, then 400 Ω",
                cubic("1.29136e-4", "8.91068e-4"),
                "0.0274/(1.29136e-3 s^2 + 2.153842e-3 s)",
                "denominator.value",
            ),
            // −b R + K²: a sign in each of two sets of equations is two signs
            (
                "the friction's sign in both",
                cubic("1.291360e-5", "7.36729e-4"),
                "0.0274/(1.29136e-5 s^2 + 7.36729e-4 s)",
                "denominator.one_slip",
            ),
        ] {
            let text = format!(
                "lab: dc-motor\nanswers:\n  position.transfer_function: {whole}\n  reduction.transfer_function: {reduced}\n"
            );
            let submission = read("x", "x.yaml", text.as_bytes(), &lab.sheet, &NoFiles);
            let card = grade(&lab, &reference, &catalogue, &submission, None);
            let items = card.questions.iter().flat_map(|question| &question.items);
            let item =
                items.into_iter().find(|item| item.id == "reduction.transfer_function.denominator").unwrap();
            assert_eq!(item.code, code, "{what}: {:?}", item.evidence);
        }
    }
}
