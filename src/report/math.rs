//! Formulas as MathML. Everything here is made from parsed values, never from a student's own markup.

use crate::algebra::{
    Expression, Matrix, Polynomial, Rational, number_mathml, polynomial_mathml, significant, symbol_mathml,
    to_f64,
};
use crate::lti::TransferFunction;
use crate::model::{Equation, LinearForm};
use std::ops::Range;

/// Figures shown of a coefficient: what was computed, what was typed.
pub const FIGURES: usize = 6;

/// A formula on its own line.
pub fn block(inner: &str) -> String {
    format!("<math display=\"block\"><mrow>{inner}</mrow></math>")
}

/// A formula in running text.
pub fn inline(inner: &str) -> String {
    format!("<math><mrow>{inner}</mrow></math>")
}

/// `G(s) = num/den`.
pub fn transfer_function(g: &TransferFunction) -> String {
    block(&format!("{}{}", G_OF_S, g.to_mathml(FIGURES)))
}

/// `G(s) = …` as it was typed.
pub fn formula(typed: &Expression) -> String {
    block(&format!("{}{}", G_OF_S, typed.to_mathml()))
}

/// An equation of motion as printed in the lab.
pub fn equation(e: &Equation) -> String {
    block(&format!("{}<mo>=</mo>{}", e.left.to_mathml(), e.right.to_mathml()))
}

/// The same with the parts at `places` (bytes of its text) in boxes that say `here`.
pub fn marked_equation(e: &Equation, places: &[Range<usize>]) -> String {
    let boxed =
        |inner: &str| format!("<munder><mrow class=\"here\">{inner}</mrow><mtext>here</mtext></munder>");
    let side = |side: &Expression| side.to_mathml_marked(places, &boxed);
    block(&format!("{}<mo>=</mo>{}", side(&e.left), side(&e.right)))
}

/// A linearized equation: the terms, in the given order, equal 0; signs are turned so that the first is positive.
pub fn linear_equation(terms: &[(String, Rational)]) -> String {
    let mut inner = String::new();
    let turn = if terms.first().is_some_and(|(_, c)| to_f64(c) < 0.0) { -1.0 } else { 1.0 };
    for (symbol, coefficient) in terms {
        let value = turn * to_f64(coefficient);
        match (inner.is_empty(), value < 0.0) {
            (true, false) => {}
            (false, false) => inner.push_str("<mo>+</mo>"),
            (_, true) => inner.push_str("<mo>−</mo>"),
        }
        let size = significant(value.abs(), FIGURES);
        let size = if size == "1" { String::new() } else { number_mathml(&size) };
        inner.push_str(&format!("<mrow>{size}{}</mrow>", symbol_with_primes(symbol)));
    }
    if inner.is_empty() {
        inner.push_str("<mn>0</mn>");
    }
    block(&format!("{inner}<mo>=</mo><mn>0</mn>"))
}

pub fn polynomial(p: &Polynomial) -> String {
    inline(&polynomial_mathml(p, "s", FIGURES))
}

/// `theta''` → θ̈ in running text.
pub fn symbol(name: &str) -> String {
    inline(&symbol_with_primes(name))
}

/// ẋ = A x + B u, y = C x + D u with the matrices written out.
pub fn state_space(a: &Matrix, b: &Matrix, c: &Matrix, d: &Matrix) -> [String; 2] {
    let name = |n: &str| format!("<mi mathvariant=\"normal\">{n}</mi>");
    let x = name("x");
    [
        block(&format!(
            "<mover accent=\"true\">{x}<mo>˙</mo></mover><mo>=</mo>{}{x}<mo>+</mo>{}<mi>u</mi>",
            matrix(a),
            matrix(b)
        )),
        block(&format!("<mi>y</mi><mo>=</mo>{}{x}<mo>+</mo>{}<mi>u</mi>", matrix(c), matrix(d))),
    ]
}

/// A linear model as it was given, in letters.
pub fn linear_form(form: &LinearForm) -> String {
    let LinearForm::StateSpace { a, b, c, d } = form else {
        return form.formula().map(|typed| formula(&typed)).unwrap_or_default();
    };
    let matrix = |name: &str, rows: &[Vec<Expression>]| {
        let cell = |entry: &Expression| format!("<mtd>{}</mtd>", entry.to_mathml());
        let rows: String = rows
            .iter()
            .map(|row| format!("<mtr>{}</mtr>", row.iter().map(cell).collect::<String>()))
            .collect();
        block(&format!(
            "<mi mathvariant=\"normal\">{name}</mi><mo>=</mo><mtable class=\"matrix\">{rows}</mtable>"
        ))
    };
    [("A", a), ("B", b), ("C", c), ("D", d)].map(|(name, rows)| matrix(name, rows)).concat()
}

/// The states as a column.
pub fn state_vector(states: &[String]) -> String {
    let rows: String =
        states.iter().map(|s| format!("<mtr><mtd>{}</mtd></mtr>", symbol_with_primes(s))).collect();
    block(&format!("<mi mathvariant=\"normal\">x</mi><mo>=</mo><mtable class=\"matrix\">{rows}</mtable>"))
}

fn matrix(m: &Matrix) -> String {
    let cell = |v: &Rational| format!("<mtd>{}</mtd>", number_mathml(&significant(to_f64(v), 5)));
    let rows: String =
        m.rows.iter().map(|r| format!("<mtr>{}</mtr>", r.iter().map(cell).collect::<String>())).collect();
    format!("<mtable class=\"matrix\">{rows}</mtable>")
}

fn symbol_with_primes(name: &str) -> String {
    let base = name.trim_end_matches('\'');
    let primes = u8::try_from(name.len() - base.len()).unwrap_or(u8::MAX);
    symbol_mathml(base, primes)
}

const G_OF_S: &str =
    "<mi>G</mi><mrow><mo stretchy=\"false\">(</mo><mi>s</mi><mo stretchy=\"false\">)</mo></mrow><mo>=</mo>";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formulas_are_balanced_and_named() {
        let third = Rational::from_parts(1.into(), 3_u8.into());
        let linear = linear_equation(&[("x''".into(), Rational::ONE), ("theta".into(), -third)]);
        assert!(
            linear.contains("<mo>¨</mo>") && linear.contains("θ") && linear.contains("0.333333"),
            "{linear}"
        );
        assert!(linear.ends_with("<mo>=</mo><mn>0</mn></mrow></math>"));
        let g = TransferFunction::new(Polynomial::from_integers(&[1]), Polynomial::from_integers(&[1, 2]))
            .unwrap();
        assert!(transfer_function(&g).contains("<mfrac>"));
        let m = Matrix { rows: vec![vec![Rational::ONE]] };
        assert_eq!(state_space(&m, &m, &m, &m)[0].matches("<mtable ").count(), 2);
    }
}
