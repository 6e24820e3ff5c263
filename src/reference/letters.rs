//! The derivation in letters, as text and as JSON.

use crate::algebra::{NodeKind, Rational};
use crate::model::{LetterDerivation, LetterEquation, LetterTerm, LettersError};
use serde::Serialize;

/// Every step, a line each, indented by two spaces; a derivation that was not made says why.
pub(super) fn text(letters: &Result<LetterDerivation, LettersError>) -> String {
    let derivation = match letters {
        Ok(derivation) => derivation,
        Err(error) => return format!("  in letters: {error}\n"),
    };
    let steps = steps(derivation);
    let mut lines = vec![format!("  in letters: {}", steps.transfer_function)];
    for (title, equations) in [
        ("at rest", &steps.at_rest),
        ("linearized", &steps.linearized),
        ("transformed", &steps.transformed),
        ("without fractions", &steps.without_fractions),
    ] {
        lines.extend(equations.iter().map(|equation| format!("    {title}: {equation}")));
    }
    lines.push(format!("    eliminated: {}", steps.eliminated));
    lines.extend(steps.cancelled.iter().map(|factor| format!("    cancelled: {factor}")));
    lines.iter().map(|line| format!("{line}\n")).collect()
}

/// The steps as formulas that can be read back.
#[derive(Serialize)]
pub(super) struct Steps {
    /// `Theta(s)/F(s) = -m*l*s/(…)`.
    transfer_function: String,
    num: String,
    den: String,
    /// `theta = pi`, `h = h_0`, and the equations at rest.
    at_rest: Vec<String>,
    linearized: Vec<String>,
    transformed: Vec<String>,
    /// Empty when there are no fractions.
    without_fractions: Vec<String>,
    /// Quotient of determinants, nothing cancelled.
    eliminated: String,
    /// The common factor; null when there is none.
    cancelled: Option<String>,
}

pub(super) fn steps(derivation: &LetterDerivation) -> Steps {
    let all = |equations: &[LetterEquation]| equations.iter().map(equation).collect();
    let values = derivation.rest.iter().map(|at| format!("{} = {}", at.name, at.is));
    let balance = derivation.rest_equations.iter().map(|(left, right)| format!("{left} = {right}"));
    let name = format!("{}/{}", derivation.unknowns[derivation.output].to_text(), derivation.input.to_text());
    Steps {
        transfer_function: format!("{name} = {}", derivation.transfer_function()),
        num: derivation.num.to_string(),
        den: derivation.den.to_string(),
        at_rest: values.chain(balance).collect(),
        linearized: all(&derivation.linear),
        transformed: all(&derivation.transformed),
        without_fractions: derivation.without_fractions.as_deref().map(all).unwrap_or_default(),
        eliminated: format!("{name} = ({})/({})", derivation.numerator, derivation.denominator),
        cancelled: derivation.cancelled.as_ref().map(ToString::to_string),
    }
}

fn equation(equation: &LetterEquation) -> String {
    format!("{} = {}", side(&equation.left), side(&equation.right))
}

fn side(terms: &[LetterTerm]) -> String {
    let mut text = String::new();
    for term in terms {
        text.push_str(match (text.is_empty(), term.negative) {
            (true, false) => "",
            (true, true) => "-",
            (false, false) => " + ",
            (false, true) => " - ",
        });
        let signal = term.signal.to_text();
        text.push_str(&match &term.coefficient.kind {
            NodeKind::Number(one) if *one == Rational::ONE => signal,
            NodeKind::Add(..) | NodeKind::Subtract(..) => format!("({})*{signal}", term.coefficient),
            _ => format!("{}*{signal}", term.coefficient),
        });
    }
    if text.is_empty() { "0".to_owned() } else { text }
}
