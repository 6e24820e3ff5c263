use super::problem::Problem;
use crate::algebra::Expression;
use unicode_normalization::UnicodeNormalization;

/// A formula as typed: an equation, or what would stand on its right side.
#[derive(Clone, Debug, PartialEq)]
pub struct TypedFormula {
    /// What stands before the last `=` or `≈`; `None` when nothing does, or nothing that is a formula (`f(x) =`).
    pub left: Option<Expression>,
    pub right: Expression,
}

const CODE: &str = "formula.unreadable";
const HELP: &str = "Write it as `y = 2x + 1`, or `dy = 2 dx` for deviations.";
/// More than this is no formula of a student's.
const MOST_LETTERS: usize = 2_000;
/// What parts the sides; the deviation signs that are read as `d`.
const EQUALS: [&str; 9] = ["\\approx", "\\simeq", "\\cong", "≈", "≅", "≃", "≐", "~=", "="];
const DEVIATIONS: [&str; 9] =
    ["\\Delta", "\\delta", "\\tilde", "\\widetilde", "Delta ", "delta ", "Δ", "∆", "δ"];
/// The wave over a letter.
const TILDE: char = '\u{303}';

impl TypedFormula {
    /// `y = 6x - 9`, `y ≈ 9 + 6(x - 3)`, `6*(x-3)+9`; a deviation `Δx` or `δx` becomes the name `dx`.
    pub(super) fn read(text: &str) -> Result<Self, Problem> {
        let problem = |message: String| Problem::new(CODE, 0, text.len(), message).help(HELP);
        if text.chars().count() > MOST_LETTERS {
            return Err(problem(format!("This is longer than the {MOST_LETTERS} letters we read.")));
        }
        let plain = without_signs(text.trim().trim_matches('$'));
        let parted = EQUALS.iter().filter_map(|sign| Some((plain.rfind(sign)?, sign.len()))).max();
        let (left, right) = match parted {
            Some((at, width)) => (Some(&plain[..at]), &plain[at + width..]),
            None => (None, plain.as_str()),
        };
        let right = Expression::parse_typed(right.trim())
            .map_err(|error| problem(format!("This formula cannot be read: {}.", error.message)))?;
        // Of `y = a = b` the middle is passed over.
        let left =
            left.map(|left| EQUALS.iter().fold(left, |left, sign| left.split(sign).next().unwrap_or(left)));
        let left = left.and_then(|left| Expression::parse_typed(without_argument(left.trim())).ok());
        Ok(Self { left, right })
    }

    /// As print has it.
    pub fn to_mathml(&self) -> String {
        match &self.left {
            Some(left) => format!("{}<mo>=</mo>{}", left.to_mathml(), self.right.to_mathml()),
            None => self.right.to_mathml(),
        }
    }
}

/// `y(x)` as `y`: on the left side a name with a name in brackets behind it is a function and its argument.
fn without_argument(left: &str) -> &str {
    let is_name = |text: &str| {
        text.starts_with(char::is_alphabetic) && text.chars().all(|c| c.is_alphanumeric() || c == '_')
    };
    let parted = left.strip_suffix(')').and_then(|rest| rest.split_once('('));
    match parted {
        Some((name, argument)) if is_name(name.trim()) && is_name(argument.trim()) => name.trim(),
        _ => left,
    }
}

/// `Δx`, `\delta x`, `\tilde{x}`, `x̃`, `δ_x` and their like as `dx`.
fn without_signs(text: &str) -> String {
    let mut plain = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(c) = rest.chars().next() {
        let sign = DEVIATIONS.iter().find(|sign| rest.starts_with(**sign));
        let after = sign.map(|sign| rest[sign.len()..].trim_start_matches([' ', '\u{a0}', '_']));
        let waved: Vec<char> = rest[..c.len_utf8()].nfd().collect();
        match after {
            _ if waved.ends_with(&[TILDE]) || rest[c.len_utf8()..].starts_with(TILDE) => {
                plain.push('d');
                plain.extend(waved.into_iter().filter(|c| *c != TILDE));
                rest = rest[c.len_utf8()..].trim_start_matches(TILDE);
            }
            Some(after) if after.starts_with('{') && after.find('}').is_some() => {
                let (name, behind) = after[1..].split_once('}').unwrap_or((after, ""));
                plain.push('d');
                plain.push_str(name.trim());
                rest = behind;
            }
            Some(after) if after.starts_with(char::is_alphabetic) => {
                plain.push('d');
                rest = after;
            }
            _ => {
                plain.push(c);
                rest = &rest[c.len_utf8()..];
            }
        }
    }
    plain
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formulas_as_students_write_them() {
        #[track_caller]
        fn check(text: &str, left: &str, right: &str) {
            let read = TypedFormula::read(text).unwrap_or_else(|e| panic!("{text}: {e:?}"));
            let shown = read.left.map_or_else(String::new, |left| left.to_string());
            assert_eq!((shown.as_str(), read.right.to_string().as_str()), (left, right), "{text}");
        }
        check("y = 6x - 9", "y", "6*x - 9");
        check("y ≈ 9 + 6(x - 3)", "y", "9 + 6*(x - 3)");
        check("6*(x-3)+9", "", "6*(x - 3) + 9");
        check("y(x) = 6x - 9", "y", "6*x - 9");
        check("f (x) ≈ 6x - 9", "f", "6*x - 9");
        check("Δy = 6Δx", "dy", "6*dx");
        check("\\delta y = 6 \\delta x", "dy", "6*dx");
        check("$dy = 6 dx$", "dy", "6*dx");
        check(r"\tilde{y} = 6 \tilde x", "dy", "6*dx");
        check("ỹ \\simeq 6 x\u{303}", "dy", "6*dx");
        check("δ_y = 6 δ_{x}", "dy", "6*dx");
        check("y - 9 = 6(x - 3)", "y - 9", "6*(x - 3)");
        check("y = 9 + 6(x - 3) = 6x - 9", "y", "6*x - 9");
    }

    #[test]
    fn what_is_no_formula_is_told() {
        for text in ["y = ", "the tangent!", "y = 6x -", &"x+".repeat(3_000)] {
            assert!(TypedFormula::read(text).is_err(), "{text}");
        }
    }
}
