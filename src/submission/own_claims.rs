use super::self_check::{plain_number, stability_of};
use super::{Answer, AnswerSheet, AnswerValue, Field, FieldKind, FinalValue, Submission};
use crate::algebra::Rational;
use crate::lti::{Features, InputKind, Limit, Response, Stability, TransferFunction, stability};
use crate::prose::{Claim, ClaimKind, Quantity, claims};
use std::sync::Arc;

/// A claim of prose that another answer of the same file contradicts.
#[derive(Clone, Debug, PartialEq)]
pub struct ContradictedClaim<'a> {
    pub claim: Claim,
    /// The other answer.
    pub answer: &'a Answer,
    /// What it says, in a sentence: `Your pole 5.57 lies in the right half-plane.`
    pub says: String,
}

/// The response that the prose of `field` describes: of which system, and to what; `None` when it describes none.
///
/// It describes one when the lab says so, or when shape, stability, poles or values are asked for beside it.
fn described<'a>(field: &'a Field, sheet: &'a AnswerSheet) -> Option<(&'a str, Option<InputKind>)> {
    let about = field.about.as_deref().filter(|_| field.kind == FieldKind::Prose)?;
    let beside =
        || sheet.fields.iter().filter(|one| one.question == field.question && one.about == field.about);
    let of_response = |one: &Field| {
        matches!(one.kind, FieldKind::Stability | FieldKind::Shape | FieldKind::Poles | FieldKind::Value)
    };
    if field.response.is_some() {
        return Some((about, field.response));
    }
    beside().any(of_response).then(|| (about, beside().find_map(|one| one.response)))
}

/// What `prose` claims about a response of the system `about`, in text order; sentences that name another operating point of the
/// same model speak of that.
pub fn claims_about(prose: &str, about: &str, sheet: &AnswerSheet) -> Vec<Claim> {
    let others = elsewhere(about, sheet);
    let others: Vec<&str> = others.iter().map(String::as_str).collect();
    claims(prose, &others)
}

/// Names of other operating points of the same model, as words.
fn elsewhere(about: &str, sheet: &AnswerSheet) -> Vec<String> {
    let Some((model, this)) = about.rsplit_once('.') else { return Vec::new() };
    let others = sheet.fields.iter().filter_map(|field| field.about.as_deref()?.rsplit_once('.'));
    let mut names: Vec<String> = others
        .filter(|(of, name)| *of == model && *name != this)
        .map(|(_, name)| name.to_lowercase())
        .collect();
    names.sort();
    names.dedup();
    names
}

/// What a transfer function says of the system: its stability, and what is seen of its response where it has one.
#[derive(Clone, Debug)]
pub struct Behaviour {
    pub stability: Stability,
    pub features: Option<Features>,
}

/// Common factors are cancelled. No response is asked for without `response`.
pub fn behaviour(typed: &TransferFunction, response: Option<InputKind>) -> Behaviour {
    let own = typed.cancelled().0;
    let response = response.and_then(|kind| Response::new(&own, kind).ok());
    Behaviour { stability: stability(&own.den), features: response.map(|response| Features::of(&response)) }
}

/// Where claims and behaviours come from: worked out, or remembered.
pub trait Knowledge {
    /// [`behaviour`]
    fn behaviour(&self, typed: &TransferFunction, response: Option<InputKind>) -> Arc<Behaviour>;
    /// [`claims_about`]
    fn claims(&self, prose: &str, about: &str, sheet: &AnswerSheet) -> Arc<Vec<Claim>>;
}

/// Everything is worked out.
pub struct WorkedOut;

impl Knowledge for WorkedOut {
    fn behaviour(&self, typed: &TransferFunction, response: Option<InputKind>) -> Arc<Behaviour> {
        Arc::new(behaviour(typed, response))
    }

    fn claims(&self, prose: &str, about: &str, sheet: &AnswerSheet) -> Arc<Vec<Claim>> {
        Arc::new(claims_about(prose, about, sheet))
    }
}

/// What the prose in `path` claims and another answer about the same response contradicts, in text order; each claim once.
pub fn contradicted_claims<'a>(
    submission: &'a Submission,
    sheet: &'a AnswerSheet,
    path: &str,
    knowledge: &dyn Knowledge,
) -> Vec<ContradictedClaim<'a>> {
    let Some(field) = sheet.fields.iter().find(|field| field.path == path) else { return Vec::new() };
    let Some((about, response)) = described(field, sheet) else { return Vec::new() };
    let Some(AnswerValue::Prose(prose)) = value(submission, path).map(|(_, value)| value) else {
        return Vec::new();
    };
    let found = knowledge.claims(prose, about, sheet);
    if found.is_empty() {
        return Vec::new();
    }
    let witnesses = witnesses(submission, sheet, about, response, knowledge);
    let against = |claim: &Claim| witnesses.iter().find_map(|witness| witness.contradicts(claim));
    let contradicted = found.iter().filter_map(|claim| {
        let (answer, says) = against(claim)?;
        Some(ContradictedClaim { claim: claim.clone(), answer, says })
    });
    contradicted.collect()
}

fn value<'a>(submission: &'a Submission, path: &str) -> Option<(&'a Answer, &'a AnswerValue)> {
    let answer = submission.answers.get(path)?;
    Some((answer, answer.value.as_ref().ok()?))
}

/// An answer about the same system, and what is known by it.
struct Witness<'a> {
    answer: &'a Answer,
    known: Known<'a>,
}

enum Known<'a> {
    Value(&'a AnswerValue, Option<Quantity>),
    /// Of a transfer function.
    Function(Arc<Behaviour>),
}

/// The answers about `about`, those that say it in a word before those it follows from.
fn witnesses<'a>(
    submission: &'a Submission,
    sheet: &'a AnswerSheet,
    about: &str,
    response: Option<InputKind>,
    knowledge: &dyn Knowledge,
) -> Vec<Witness<'a>> {
    let mut all: Vec<(u8, Witness<'a>)> = Vec::new();
    for field in sheet.fields.iter().filter(|field| field.about.as_deref() == Some(about)) {
        let Some((answer, value)) = value(submission, &field.path) else { continue };
        // Of another response only what concerns the system.
        let other = field.response.is_some() && response.is_some() && field.response != response;
        let (order, known) = match value {
            AnswerValue::Stability(_) => (0, Known::Value(value, None)),
            AnswerValue::Shape(_) if !other => (1, Known::Value(value, None)),
            AnswerValue::Value(_) if !other => match quantity(&field.path) {
                Some(of) => (2, Known::Value(value, Some(of))),
                None => continue,
            },
            AnswerValue::Poles(poles) if !poles.is_empty() => (3, Known::Value(value, None)),
            AnswerValue::TransferFunction { transfer_function, .. } if !sheet.leans_on_untold(answer) => {
                (4, Known::Function(knowledge.behaviour(transfer_function, response)))
            }
            _ => continue,
        };
        all.push((order, Witness { answer, known }));
    }
    all.sort_by_key(|(order, _)| *order);
    all.into_iter().map(|(_, witness)| witness).collect()
}

fn quantity(path: &str) -> Option<Quantity> {
    if path.ends_with("initial_value") {
        Some(Quantity::Initial)
    } else if path.ends_with("final_value") {
        Some(Quantity::Final)
    } else {
        None
    }
}

impl<'a> Witness<'a> {
    /// The answer and what it says, when the claim cannot be true by it.
    fn contradicts(&self, claim: &Claim) -> Option<(&'a Answer, String)> {
        let (holds, says) = match &self.known {
            Known::Function(own) => {
                let of_system = matches!(
                    claim.kind,
                    ClaimKind::Stable | ClaimKind::MarginallyStable | ClaimKind::Unstable
                );
                match &own.features {
                    None => (claim.holds_for_stability(own.stability), function_is(own.stability)),
                    Some(features) if of_system => {
                        (claim.holds(features, own.stability), function_is(own.stability))
                    }
                    Some(features) => {
                        let fact = claim.fact(features, own.stability);
                        (claim.holds(features, own.stability), format!("By your transfer function, {fact}."))
                    }
                }
            }
            Known::Value(AnswerValue::Stability(own), _) => {
                (claim.holds_for_stability(*own), format!("Your answer on stability is “{}”.", own.words()))
            }
            Known::Value(AnswerValue::Shape(own), _) => {
                (claim.holds_for_shape(*own), format!("Your answer on the shape is {}.", own.words()))
            }
            Known::Value(AnswerValue::Value(own), Some(Quantity::Initial)) => {
                let start = match own {
                    FinalValue::Number(number, unit) => plain_number(number, unit.as_ref())
                        .and_then(|number| claim.holds_for_initial_value(number)),
                    _ => None,
                };
                (start, format!("Your initial value is {}.", own.read_as()))
            }
            Known::Value(AnswerValue::Value(own), Some(Quantity::Final)) => {
                let says = match own {
                    FinalValue::Number(..) => format!("Your final value is {}.", own.read_as()),
                    _ => format!("Your answer on the final value is “{}”.", own.read_as()),
                };
                (by_final_value(claim, own), says)
            }
            Known::Value(AnswerValue::Poles(poles), _) => {
                let real = poles.iter().all(|pole| pole.im.is_zero());
                if real && claim.kind == ClaimKind::Oscillates && !claim.denied {
                    (Some(false), "Your poles are all real.".to_owned())
                } else {
                    let own = stability_of(poles);
                    let right = poles.iter().find(|pole| pole.re.value > Rational::ZERO);
                    let says = match (own, right) {
                        (Stability::Unstable, Some(pole)) => {
                            format!("Your pole {} lies in the right half-plane.", pole.read_as())
                        }
                        (Stability::AsymptoticallyStable, _) => {
                            "Your poles all lie in the left half-plane.".to_owned()
                        }
                        _ => format!("Your poles are those of a system that is {}.", own.words()),
                    };
                    (claim.holds_for_stability(own), says)
                }
            }
            Known::Value(..) => return None,
        };
        (holds == Some(false)).then_some((self.answer, says))
    }
}

fn function_is(own: Stability) -> String {
    format!("By its denominator, your transfer function is {}.", own.words())
}

fn by_final_value(claim: &Claim, own: &FinalValue) -> Option<bool> {
    match own {
        FinalValue::Number(number, unit) => {
            plain_number(number, unit.as_ref()).and_then(|number| claim.holds_for_limit(Limit::Value(number)))
        }
        FinalValue::PlusInfinity => claim.holds_for_limit(Limit::PlusInfinity),
        FinalValue::MinusInfinity => claim.holds_for_limit(Limit::MinusInfinity),
        // It may grow, or swing for ever: what holds for neither does not hold.
        FinalValue::Unbounded => {
            let one = claim.holds_for_limit(Limit::OscillatesUnbounded);
            (one == claim.holds_for_limit(Limit::Oscillates)).then_some(one).flatten()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{NoFiles, read, self_check};
    use super::*;

    fn sheet() -> AnswerSheet {
        use FieldKind::*;
        let fields = [
            ("before", "before", Prose, "tank.low", None),
            ("transfer_function", "transfer_function", TransferFunction, "tank.low", None),
            ("poles", "response", Poles, "tank.low", None),
            ("initial_value", "response", Value, "tank.low", Some(InputKind::Impulse)),
            ("final_value", "response", Value, "tank.low", Some(InputKind::Impulse)),
            ("shape", "response", FieldKind::Shape, "tank.low", Some(InputKind::Impulse)),
            ("stability", "response", FieldKind::Stability, "tank.low", None),
            ("description", "response", Prose, "tank.low", None),
            ("afterwards", "afterwards", Prose, "tank.low", Some(InputKind::Impulse)),
            ("high", "high", Prose, "tank.high", None),
        ];
        let fields = fields.map(|(path, question, kind, about, response)| Field {
            path: path.to_owned(),
            kind,
            question: question.to_owned(),
            prompt: String::new(),
            about: Some(about.to_owned()),
            response,
            unit: None,
            required: false,
        });
        AnswerSheet {
            lab: "tank".into(),
            title: "Tank".into(),
            fields: fields.into(),
            ..AnswerSheet::default()
        }
    }

    fn submission(answers: &str) -> Submission {
        let answers: String = answers.split("; ").map(|line| format!("  {line}\n")).collect();
        let text = format!("lab: tank\nstudent: {{id: a, name: A}}\nanswers:\n{answers}");
        read("a", "a.yaml", text.as_bytes(), &sheet(), &NoFiles)
    }

    /// `says` of every contradiction in the fields `description` and `afterwards`.
    #[track_caller]
    fn check(rows: &[(&str, &[&str])]) {
        for (answers, want) in rows {
            let submission = submission(answers);
            assert_eq!(submission.findings, [], "{answers}");
            let sheet = sheet();
            let found: Vec<String> = sheet
                .fields
                .iter()
                .flat_map(|field| contradicted_claims(&submission, &sheet, &field.path, &WorkedOut))
                .map(|one| format!("{}: {}", one.claim.words(), one.says))
                .collect();
            assert_eq!(found, *want, "{answers}");
            let told = self_check(&submission, &sheet);
            let told = told.iter().filter(|finding| finding.code == "contradiction.prose");
            assert_eq!(told.count(), want.len(), "{answers}");
        }
    }

    #[test]
    fn prose_is_held_against_the_answers_beside_it() {
        check(&[
            // the word
            (
                "stability: unstable; description: It is stable.",
                &["it is stable: Your answer on stability is “unstable”."],
            ),
            ("stability: unstable; description: It is not stable.", &[]),
            ("stability: marginally stable; description: It is stable.", &[]),
            ("stability: marginally stable; description: It is not unstable.", &[]),
            (
                "stability: stable; description: It grows without bound.",
                &["it grows without bound: Your answer on stability is “asymptotically stable”."],
            ),
            // the shape
            (
                "shape: exponential decay; description: It oscillates.",
                &["it oscillates: Your answer on the shape is an exponential approach to the final value."],
            ),
            ("shape: decaying oscillation; description: It oscillates and dies away.", &[]),
            (
                "shape: sustained oscillation; description: It dies away.",
                &["it settles: Your answer on the shape is a sustained oscillation."],
            ),
            // values
            (
                "final_value: 0; description: It settles at 2.5.",
                &["the final value is 2.5: Your final value is 0."],
            ),
            ("final_value: 2.46; description: It settles at 2.5.", &[]),
            (
                "final_value: 0; description: It goes on for ever.",
                &["it goes on for ever: Your final value is 0."],
            ),
            ("final_value: does not exist; description: It swings with constant amplitude.", &[]),
            (
                "final_value: does not exist; description: It settles.",
                &["it settles: Your answer on the final value is “unbounded”."],
            ),
            (
                "initial_value: 1; description: It starts at 0.",
                &["the initial value is 0: Your initial value is 1."],
            ),
            // poles
            (
                "poles: [-1, 2]; description: It is stable.",
                &["it is stable: Your pole 2 lies in the right half-plane."],
            ),
            (
                "poles: [-1, -2]; description: It is unstable.",
                &["it is unstable: Your poles all lie in the left half-plane."],
            ),
            ("poles: [-1, -2]; description: It oscillates.", &["it oscillates: Your poles are all real."]),
            (
                "poles: [0, 0]; description: It is stable.",
                &["it is stable: Your poles are those of a system that is unstable."],
            ),
            // the transfer function
            (
                "transfer_function: 1/(s-1); description: It is stable.",
                &["it is stable: By its denominator, your transfer function is unstable."],
            ),
            (
                "transfer_function: 1/(s+1); description: It starts at 0.",
                &["the initial value is 0: By your transfer function, the initial value is 1."],
            ),
            ("transfer_function: 1/(s+1); description: It starts at 1 and settles at 0.", &[]),
            (
                "transfer_function: 2/(s^2+4); description: It oscillates with a period of 5 s.",
                &["the period is 5 s: By your transfer function, the period is 3.142 s."],
            ),
            // only where it speaks of this response
            ("stability: unstable; before: It is stable.", &[]),
            ("stability: unstable; high: It is stable.", &[]),
            ("stability: unstable; description: \"Unlike high, it is stable.\"", &[]),
            (
                "stability: unstable; afterwards: It is stable.",
                &["it is stable: Your answer on stability is “unstable”."],
            ),
            ("stability: unstable; description: \"\"", &[]),
        ]);
    }

    #[test]
    fn a_student_is_told_where_the_words_stand() {
        let submission = submission("stability: unstable; description: So it is stable and stays so.");
        let findings = self_check(&submission, &sheet());
        let [finding] = findings.as_slice() else { panic!("{findings:#?}") };
        let span = finding.span.unwrap();
        assert_eq!(&submission.source.text[span.start..span.end], "stable");
        assert_eq!(
            finding.message,
            "`stability` (line 4) and `description` (line 5) do not agree: the text says “stable”, which we take as “it is \
             stable”. Your answer on stability is “unstable”."
        );
    }
}
