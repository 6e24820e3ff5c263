use super::accepted::{Accepted, coefficient_tolerance};
use super::closeness::percent;
use super::grade::{Field, Grader};
use super::guard::{self, Guard};
use super::mark::{Mark, share};
use super::own::OwnModel;
use super::own_claims::{self, Behaviour};
use super::own_poles::OwnPoles;
use super::truth::Truth;
use super::{Evidence, Explanation, Verdict, stability};
use crate::algebra::Rational;
use crate::lab::{Check, Criterion, Curve, Described, LabDefinition, Points, Question, SystemRef};
use crate::lti::TransferFunction;
use crate::submission::{AnswerValue, stability_name};
use std::cell::OnceCell;
use std::sync::Arc;

/// How an answer stands to the student's own earlier answer, on which it rests.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FollowThrough {
    /// It is right for the earlier answer, and earns the lab's part of the points.
    pub credited: bool,
    pub guard: Guard,
    /// The criterion where the earlier answer lost its points.
    pub root: String,
    /// What it was held against, in words: `your own transfer function`.
    pub own: String,
}

/// What a criterion earns once a person has had a say.
pub(super) type Earned<'a> = &'a dyn Fn(&Criterion, &Mark) -> Points;

/// Judges every criterion that is not right by the reference again, against the student's own earlier answers.
///
/// `marks` are those by the reference, by question and criterion. No mark is lowered.
pub(super) fn follow(lab: &LabDefinition, grader: &Grader<'_>, earned: Earned<'_>, marks: &mut [Vec<Mark>]) {
    let functions = own_functions(lab, grader, earned, marks);
    // Words of stability rest on poles as well, so they come last.
    for words in [false, true] {
        for (question, asked) in lab.questions.iter().enumerate() {
            for (index, criterion) in asked.criteria.iter().enumerate() {
                let Some(of) = of_system(&criterion.check) else { continue };
                let Some(base) = marks.get(question).and_then(|marks| marks.get(index)) else { continue };
                let judged = matches!(base.verdict, Verdict::Right | Verdict::Partly | Verdict::Wrong);
                if !judged || matches!(criterion.check, Check::Stability { .. }) != words {
                    continue;
                }
                let function = functions.iter().find(|known| known.of == of && known.question <= question);
                let follower = Follower { lab, grader, criterion, question, base, function };
                let next = if words {
                    follower.word_of_stability(follower.own_poles(of, earned, marks))
                } else {
                    follower.anything_else()
                };
                if let Some(next) = next {
                    marks[question][index] = next;
                }
            }
        }
    }
}

/// The system on whose own model an answer can rest. Where it rests says no transfer function.
fn of_system(check: &Check) -> Option<&SystemRef> {
    check.system().filter(|_| check.transfer_function().is_none() && !matches!(check, Check::Rest { .. }))
}

/// A criterion whose answer may rest on an earlier one.
struct Follower<'a> {
    lab: &'a LabDefinition,
    grader: &'a Grader<'a>,
    criterion: &'a Criterion,
    /// Its question's place in the lab.
    question: usize,
    /// The mark by the reference.
    base: &'a Mark,
    function: Option<&'a OwnFunction<'a>>,
}

impl Follower<'_> {
    /// `None`: the mark stays as it is.
    fn anything_else(&self) -> Option<Mark> {
        if self.base.verdict == Verdict::Right {
            return None;
        }
        let (premise, ways) = self.own_function()?;
        if let Some(why) = self.why_not_followed(ways) {
            return self.left_to_a_person(&premise, &why);
        }
        if let Check::Concepts { describes: Some(described), .. } = &self.criterion.check {
            let own = self.claimed(described, &premise, ways.first()?)?;
            return self.resting_on(&premise, own);
        }
        let ways = match self.criterion.check {
            Check::Poles { .. } => ways,
            // To a response common factors make no difference.
            _ => &ways[..ways.len().min(1)],
        };
        let own = ways
            .iter()
            .map(|way| self.grader.criterion(self.criterion, Truth::Own(way)))
            .reduce(|best, next| if next.earned > best.earned { next } else { best })?;
        self.resting_on(&premise, own)
    }

    /// Why what follows from the own model cannot be told; `None` when it can.
    fn why_not_followed(&self, ways: &[OwnModel]) -> Option<String> {
        let kind = match &self.criterion.check {
            Check::Poles { .. } => {
                let known = ways.iter().any(|way| way.why_no_poles().is_none());
                return if known { None } else { ways.first()?.why_no_poles() };
            }
            Check::Feature { response, .. } | Check::Shape { response, .. } => *response,
            Check::Plot { curve: Curve::Response { response, .. }, .. } => *response,
            Check::Concepts { describes: Some(described), .. } => described.response,
            _ => return None,
        };
        ways.first()?.why_no_response(kind)
    }

    /// What might follow from the earlier answer, where nobody but a person can tell.
    fn left_to_a_person(&self, premise: &Premise, why: &str) -> Option<Mark> {
        let lost_nothing = premise.root.is_none();
        if self.criterion.follow_through.is_zero() && !lost_nothing || premise.guard != Guard::Passed {
            return None;
        }
        let words =
            format!("Whether it follows from {} polemark cannot tell: {why}. A person will.", premise.name());
        let mark = said(self.base, &words);
        Some(Mark { verdict: Verdict::Unmarked, code: "unmarked", provisional: true, ..mark })
    }

    /// The mark of prose by what it claims of the response.
    fn claimed(&self, described: &Described, premise: &Premise, own: &OwnModel) -> Option<Mark> {
        premise.root.as_ref()?;
        let Field::Value(_, AnswerValue::Prose(prose)) = self.grader.field(&self.criterion.field) else {
            return None;
        };
        let truth = Truth::Reference(self.grader.reference);
        let (of, kind) = (&described.of, described.response);
        let (responses, words) = (truth.responses(of, kind), truth.stability(of));
        let known: Vec<Behaviour<'_>> = responses
            .iter()
            .zip(&words)
            .map(|(response, word)| (&response.what.features, *word.what))
            .collect();
        let response = own.response(kind)?;
        let behaviour = (&response.features, own.stability);
        let mark = own_claims::judge(
            self.criterion.points,
            &self.grader.claims_of(prose, described),
            &known,
            behaviour,
        )?;
        let found = self.base.evidence.found.clone();
        let conflicts = self.base.evidence.conflicts.clone();
        Some(Mark { evidence: Evidence { found, conflicts, ..mark.evidence }, ..mark })
    }

    fn own_function(&self) -> Option<(Premise, &[OwnModel])> {
        let function = self.function?;
        let (guard, ways) = function.model.get_or_init(|| {
            let truth = Truth::Reference(self.grader.reference).poles(function.of);
            let asked = truth.iter().map(|one| one.denominator.degree()).max().unwrap_or(0);
            let ways = self.grader.known.own_models(function.typed, asked + guard::HIGHER);
            let guard = self.grader.known.guard(function.of, function.typed, || {
                let tolerance = coefficient_tolerance(self.lab, function.of);
                ways.first().map_or(Guard::Order, |short| {
                    guard::of_function(&short.function, self.grader.reference, function.of, &tolerance)
                })
            });
            // What a slip leads to as well is no proof of another operating point.
            let guard =
                if guard == Guard::OtherPoint && function.may_be_a_slip { Guard::Passed } else { guard };
            (guard, ways)
        });
        let root = function.root.clone();
        Some((self.premise(OWN_FUNCTION, function.question, function.field, root, *guard), ways))
    }

    /// `question`, `field`: where the earlier answer stands.
    fn premise(
        &self,
        own: &'static str,
        question: usize,
        field: &str,
        root: Option<String>,
        guard: Guard,
    ) -> Premise {
        let asked = self.lab.questions.get(question).filter(|_| question != self.question);
        let whose = asked.map_or_else(String::new, |asked| format!(" of {}", question_name(asked)));
        let charged_elsewhere = |root: &String| {
            let has =
                |asked: &&Question| asked.criteria.iter().any(|one| one.id == *root && one.field != field);
            self.lab.questions.iter().find(has).map(question_name)
        };
        let charged_in = root.as_ref().and_then(charged_elsewhere);
        Premise { own, whose, root, charged_in, guard }
    }

    /// The mark by the earlier answer in place of the one by the reference, where that earns more.
    fn resting_on(&self, premise: &Premise, own: Mark) -> Option<Mark> {
        let (base, points) = (self.base, self.criterion.points);
        let expected = || {
            let (reference, own) = (&base.evidence.expected, &own.evidence.expected);
            if reference == own {
                reference.clone()
            } else {
                format!("{reference} For {}: {own}", premise.own)
            }
        };
        let name = premise.name();
        let Some(root) = &premise.root else {
            // An earlier answer that lost nothing is as good as the reference, to its digits.
            let reason = format!("It agrees with {name}, which is right within its digits.");
            let evidence = Evidence { expected: expected(), reason, ..own.evidence.clone() };
            // Rounded poles beside the axis, and a word that is another than that of the right ones: a person has a look.
            let is_word = matches!(self.criterion.check, Check::Stability { .. });
            let provisional = base.provisional || own.provisional || is_word;
            return (own.earned > base.earned).then_some(Mark { evidence, provisional, ..own });
        };
        if self.criterion.follow_through.is_zero() || own.verdict == Verdict::Unmarked {
            return None;
        }
        let follow_through = |credited| {
            let own = premise.own.to_owned();
            Some(FollowThrough { credited, guard: premise.guard, root: root.clone(), own })
        };
        if own.earned <= base.earned {
            let nothing = premise.guard == Guard::Passed && own.earned == Points::ZERO;
            let words = match own.code {
                "plot.too_short" | "plot.too_few_points" => {
                    format!("Held against {name}: {}", own.evidence.reason)
                }
                _ => format!("It does not follow from {name} either."),
            };
            return nothing.then(|| Mark { follow_through: follow_through(false), ..said(base, &words) });
        }
        if premise.guard != Guard::Passed {
            let why = premise.why_refused();
            let words = format!("It would follow from {name}, but {why}, and so cannot be followed.");
            return Some(Mark { follow_through: follow_through(false), ..said(base, &words) });
        }
        let earned = share(own.earned, &self.criterion.follow_through);
        if earned <= base.earned {
            return None;
        }
        let doubtful = premise.own == OWN_FUNCTION && self.function.is_some_and(|own| own.may_be_a_slip);
        let charged = match &premise.charged_in {
            None => format!("{name}, where the mistake was charged"),
            Some(question) => format!("{name}, for a mistake that was charged in {question}"),
        };
        let mut reason = if own.earned == points {
            format!("It follows from {charged}.")
        } else {
            format!("Held against {charged}: {}", own.evidence.reason)
        };
        if self.criterion.follow_through < Rational::ONE {
            let part = percent(&self.criterion.follow_through);
            reason.push_str(&format!(" That earns {part} of the points."));
        }
        if doubtful {
            reason.push_str(
                " That one may be what belongs to another operating point or come from a slip; which of them, a person will see.",
            );
        }
        Some(Mark {
            verdict: if earned == points { Verdict::Right } else { Verdict::Partly },
            code: follows(&self.criterion.check),
            earned,
            evidence: Evidence { expected: expected(), reason, ..own.evidence.clone() },
            provisional: base.provisional || own.provisional || doubtful,
            follow_through: follow_through(true),
            spared: Points(earned.0 - base.earned.0),
            withheld: Points(own.earned.0 - earned.0),
            ..base.clone()
        })
    }

    /// The word, held against the student's own poles where there are any, and against their own transfer function.
    fn word_of_stability(&self, poles: Option<(Premise, OwnPoles)>) -> Option<Mark> {
        let Field::Value(_, AnswerValue::Stability(word)) = self.grader.field(&self.criterion.field) else {
            return None;
        };
        // Too few poles say nothing of the rest.
        let telling = poles.as_ref().filter(|(premise, _)| premise.guard != Guard::Order);
        let needed = self.base.verdict != Verdict::Right || telling.is_none();
        let function = if needed { self.own_function() } else { None };
        let against = match (telling, &function) {
            (Some((premise, own)), _) => (!own.are(*word)).then(|| (premise, own.stability())),
            (None, Some((premise, ways))) => {
                let is = ways.iter().any(|way| way.stability == *word);
                ways.first().filter(|_| !is).map(|way| (premise, way.stability))
            }
            (None, None) => None,
        };
        if self.base.verdict == Verdict::Right {
            let (premise, says) = against?;
            let (own, says) = (premise.name(), stability_name(says));
            let words = format!("It is not what {own} would give: by that, it is {says}.");
            return Some(Mark { code: "stability.unsupported", ..said(self.base, &words) });
        }
        let by_poles = poles.iter().filter(|(_, own)| own.are(*word)).map(|(premise, _)| premise);
        let by_function = function
            .iter()
            .filter(|(_, ways)| ways.iter().any(|way| way.stability == *word))
            .map(|(premise, _)| premise);
        let premises: Vec<&Premise> = by_poles.chain(by_function).collect();
        let right = |premise: &Premise| {
            let own = Accepted { differs: &[], what: word };
            self.resting_on(premise, stability::judge(self.criterion.points, &[own], None, *word))
        };
        let stands = |premise: &&&Premise| premise.root.is_none() || premise.guard == Guard::Passed;
        if let Some(premise) = premises.iter().find(stands).or(premises.first()) {
            let next = right(premise)?;
            let credited = next.follow_through.as_ref().is_some_and(|followed| followed.credited);
            return match against {
                Some((other, says)) if credited && other.own == OWN_POLES => {
                    let words = format!("By {}, though, it is {}.", other.name(), stability_name(says));
                    Some(said(&next, &words))
                }
                _ => Some(next),
            };
        }
        let (premise, says) = against?;
        let own = Accepted { differs: &[], what: &says };
        let wrong = stability::judge(self.criterion.points, &[own], None, *word);
        let next = self.resting_on(premise, wrong);
        if premise.own != OWN_POLES {
            return next;
        }
        let words =
            format!("It contradicts {} too: by those it is {}.", premise.name(), stability_name(says));
        let follow_through = next.and_then(|next| next.follow_through);
        Some(Mark { code: "stability.contradicts_own", follow_through, ..said(self.base, &words) })
    }

    /// The first readable poles of the system, and how far they may be followed.
    fn own_poles(
        &self,
        of: &SystemRef,
        earned: Earned<'_>,
        marks: &[Vec<Mark>],
    ) -> Option<(Premise, OwnPoles)> {
        let places = self.lab.questions.iter().zip(marks).enumerate().take(self.question + 1);
        for (question, (asked, marks)) in places {
            for (criterion, mark) in asked.criteria.iter().zip(marks) {
                if !matches!(&criterion.check, Check::Poles { of: other, .. } if other == of) {
                    continue;
                }
                let Field::Value(_, AnswerValue::Poles(typed)) = self.grader.field(&criterion.field) else {
                    continue;
                };
                let Some(own) = OwnPoles::new(typed) else { continue };
                let truth = Truth::Reference(self.grader.reference).poles(of);
                let guard = match (&mark.follow_through, truth.first()) {
                    // They follow a transfer function that may not be followed.
                    (Some(followed), _) if followed.guard != Guard::Passed => followed.guard,
                    (_, Some(right)) => guard::of_poles(&own, right.denominator),
                    (_, None) => Guard::Order,
                };
                let root = match &mark.follow_through {
                    Some(followed) if followed.guard != Guard::Passed => Some(followed.root.clone()),
                    _ => root_of(criterion, mark, earned),
                };
                return Some((self.premise(OWN_POLES, question, &criterion.field, root, guard), own));
            }
        }
        None
    }
}

pub(super) const OWN_FUNCTION: &str = "your own transfer function";
const OWN_POLES: &str = "your own poles";

/// An earlier answer on which later ones rest.
struct Premise {
    /// `your own transfer function`.
    own: &'static str,
    /// ` of Task 1, question 3`, or nothing.
    whose: String,
    /// Where it lost its points; `None` when it lost none.
    root: Option<String>,
    /// `Task 1, question 3`, when it is another answer that was charged.
    charged_in: Option<String>,
    guard: Guard,
}

impl Premise {
    fn name(&self) -> String {
        format!("{}{}", self.own, self.whose)
    }

    /// `that one is of the wrong order`.
    fn why_refused(&self) -> &'static str {
        match (self.guard, self.own == OWN_POLES) {
            (Guard::Passed, _) => "it may be followed",
            (Guard::Order, true) => "these are too few or of a function of the wrong order",
            (Guard::Order, false) => "that one is of the wrong order",
            (Guard::Trivial, true) => "these are too simple to show anything",
            (Guard::Trivial, false) => "that one is too simple to show anything",
            (Guard::OtherPoint, true) => "these belong to another operating point",
            (Guard::OtherPoint, false) => "that one belongs to another operating point",
        }
    }
}

/// `mark` with more words to its reason.
fn said(mark: &Mark, words: &str) -> Mark {
    let reason = format!("{} {words}", mark.evidence.reason).trim().to_owned();
    Mark { evidence: Evidence { reason, ..mark.evidence.clone() }, ..mark.clone() }
}

fn follows(check: &Check) -> &'static str {
    match check {
        Check::Poles { .. } => "poles.follows",
        Check::Stability { .. } => "stability.follows",
        Check::Shape { .. } => "shape.follows",
        Check::Plot { .. } => "plot.follows",
        Check::Concepts { .. } => "concepts.follows",
        _ => "value.follows",
    }
}

/// A transfer function the student gave for a system.
struct OwnFunction<'a> {
    of: &'a SystemRef,
    /// The place of its question in the lab.
    question: usize,
    field: &'a str,
    typed: &'a TransferFunction,
    root: Option<String>,
    /// Another operating point explains it, and a single slip does as well.
    may_be_a_slip: bool,
    /// Whether it may be followed, and the ways to take it; worked out when it is needed, and once.
    model: OnceCell<(Guard, Arc<Vec<OwnModel>>)>,
}

/// The first readable transfer function of each system, in the order of the lab.
fn own_functions<'a>(
    lab: &'a LabDefinition,
    grader: &'a Grader<'_>,
    earned: Earned<'_>,
    marks: &[Vec<Mark>],
) -> Vec<OwnFunction<'a>> {
    let mut found: Vec<OwnFunction<'a>> = Vec::new();
    for (question, (asked, marks)) in lab.questions.iter().zip(marks).enumerate() {
        for criterion in &asked.criteria {
            let Some(of) = criterion.check.transfer_function() else { continue };
            if found.iter().any(|known| known.of == of) {
                continue;
            }
            let Field::Value(_, AnswerValue::TransferFunction { transfer_function: typed, .. }) =
                grader.field(&criterion.field)
            else {
                continue;
            };
            let same = |other: &Criterion| {
                other.field == criterion.field && other.check.transfer_function() == Some(of)
            };
            let judged = asked.criteria.iter().zip(marks).filter(|(other, _)| same(other));
            let root = judged.clone().find_map(|(other, mark)| root_of(other, mark, earned));
            let diagnosed = judged.clone().find_map(|(_, mark)| mark.diagnosis.as_ref());
            let explanations = diagnosed.map_or(&[][..], |diagnosis| &diagnosis.explanations);
            let is_other = |one: &Explanation| one.code == "point.other";
            // A wrong sign cannot be told from a copy: `docs/decisions/0009`.
            let is_slip = |one: &Explanation| {
                let signs = ["point.", "term.sign", "function.sign"];
                !one.code.split('+').any(|code| signs.iter().any(|sign| code.starts_with(sign)))
            };
            let may_be_a_slip = explanations.iter().any(is_other) && explanations.iter().any(is_slip);
            let field = criterion.field.as_str();
            found.push(OwnFunction {
                of,
                question,
                field,
                typed,
                root,
                may_be_a_slip,
                model: OnceCell::new(),
            });
        }
    }
    found
}

/// Where the points of this criterion were charged; `None` when none were.
pub(super) fn root_of(criterion: &Criterion, mark: &Mark, earned: Earned<'_>) -> Option<String> {
    match &mark.follow_through {
        Some(followed) if followed.credited => Some(followed.root.clone()),
        _ => (earned(criterion, mark) < criterion.points).then(|| criterion.id.clone()),
    }
}

/// `Task 1, question 3`; the title of a question without a number.
pub(super) fn question_name(question: &Question) -> String {
    match question.number.as_str() {
        "" => format!("“{}”", question.title),
        number => number.to_owned(),
    }
}
