use super::number_text::{number_mathml, significant};
use super::{Polynomial, symbol_mathml, to_f64};

/// `0.0132s^3 + 0.0024s^2 - 0.412s`: unit coefficients and zero terms dropped; `0` for zero.
pub fn polynomial_text(p: &Polynomial, variable: &str, figures: usize) -> String {
    let mut text = String::new();
    for term in terms(p, figures) {
        text.push_str(match (text.is_empty(), term.negative) {
            (true, false) => "",
            (true, true) => "-",
            (false, false) => " + ",
            (false, true) => " - ",
        });
        if !term.unit() {
            text.push_str(&term.size);
        }
        match term.power {
            0 => {}
            1 => text.push_str(variable),
            n => text.push_str(&format!("{variable}^{n}")),
        }
    }
    if text.is_empty() { "0".to_owned() } else { text }
}

/// The same as MathML: one `<mrow>`, and in it one `<mrow>` a term with the signs between.
pub fn polynomial_mathml(p: &Polynomial, variable: &str, figures: usize) -> String {
    let variable = symbol_mathml(variable, 0);
    let mut inner = String::new();
    for term in terms(p, figures) {
        match (inner.is_empty(), term.negative) {
            (true, false) => {}
            (false, false) => inner.push_str("<mo>+</mo>"),
            (_, true) => inner.push_str("<mo>−</mo>"),
        }
        inner.push_str("<mrow>");
        if !term.unit() {
            inner.push_str(&number_mathml(&term.size));
        }
        match term.power {
            0 => {}
            1 => inner.push_str(&variable),
            n => inner.push_str(&format!("<msup>{variable}<mn>{n}</mn></msup>")),
        }
        inner.push_str("</mrow>");
    }
    if inner.is_empty() { "<mn>0</mn>".to_owned() } else { format!("<mrow>{inner}</mrow>") }
}

struct Term {
    negative: bool,
    /// The coefficient without its sign.
    size: String,
    power: usize,
}

impl Term {
    /// Whether the coefficient is a 1 that is not written.
    fn unit(&self) -> bool {
        self.size == "1" && self.power > 0
    }
}

/// The terms that are not zero, highest power first.
fn terms(p: &Polynomial, figures: usize) -> impl Iterator<Item = Term> {
    let n = p.degree();
    let coefficients = p.coefficients().iter().enumerate().filter(|(_, c)| !c.is_zero());
    coefficients.map(move |(i, c)| {
        let value = to_f64(c);
        Term { negative: value < 0.0, size: significant(value.abs(), figures), power: n - i }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::algebra::parse_decimal;

    fn p(coefficients: &[&str]) -> Polynomial {
        Polynomial::new(coefficients.iter().map(|c| parse_decimal(c).unwrap()).collect())
    }

    #[track_caller]
    fn check(rows: &[(&[&str], usize, &str)]) {
        for (coefficients, figures, expected) in rows {
            assert_eq!(polynomial_text(&p(coefficients), "s", *figures), *expected);
        }
    }

    #[test]
    fn signs_units_and_zeros() {
        check(&[
            (&["0.0132", "0.0024", "-0.41202", "0"], 3, "0.0132s^3 + 0.0024s^2 - 0.412s"),
            (&["1", "-1"], 3, "s - 1"),
            (&["-1", "0", "1"], 3, "-s^2 + 1"),
            (&["-0.06", "0"], 3, "-0.06s"),
            (&["1"], 3, "1"),
            (&["-1"], 3, "-1"),
            (&[], 3, "0"),
            (&["0.00000012", "0", "5"], 3, "1.2e-7s^2 + 5"),
        ]);
    }

    #[test]
    fn mathml_has_a_row_for_each_term() {
        assert_eq!(
            polynomial_mathml(&p(&["2", "-1", "0"]), "s", 3),
            "<mrow><mrow><mn>2</mn><msup><mi>s</mi><mn>2</mn></msup></mrow><mo>−</mo>\
             <mrow><mi>s</mi></mrow></mrow>"
        );
        assert_eq!(polynomial_mathml(&Polynomial::zero(), "s", 3), "<mn>0</mn>");
    }
}
