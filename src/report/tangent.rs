//! A static function and its tangent, in words and formulas.

use super::math;
use super::numbers::{letter, number, quantity};
use crate::algebra::{number_mathml, significant, symbol_mathml};
use crate::lab::LineForm;
use crate::model::Tangent;
use crate::reference::OperatingPointReference;

const FIGURES: usize = 6;

/// `y ≈ 9 + 6 (x − 3)`, or `δy = 6 δx`.
pub fn line_html(point: &OperatingPointReference, form: LineForm) -> Option<String> {
    let tangent = point.tangent.as_ref()?;
    let (x, y) = (symbol_mathml(&point.input, 0), symbol_mathml(&point.output, 0));
    let (x0, y0) = tangent.at;
    let delta = |symbol: &str| format!("<mrow><mi>δ</mi>{symbol}</mrow>");
    let factor = |value: f64| format!("{}<mo>\u{2062}</mo>", size(value));
    let sign = |value: f64| if value < 0.0 { "−" } else { "+" };
    Some(match form {
        LineForm::Line => math::block(&format!(
            "{y}<mo>≈</mo>{}<mo>{}</mo>{}<mrow><mo>(</mo>{x}<mo>{}</mo>{}<mo>)</mo></mrow>",
            signed(y0),
            sign(tangent.slope),
            factor(tangent.slope.abs()),
            sign(-x0),
            size(x0)
        )),
        LineForm::Deviations => math::block(&format!(
            "{}<mo>=</mo>{}<mo>\u{2062}</mo>{}",
            delta(&y),
            signed(tangent.slope),
            delta(&x)
        )),
    })
}

/// What the deviations are measured from.
pub fn deviations_html(point: &OperatingPointReference) -> Option<String> {
    let tangent = point.tangent.as_ref()?;
    let one = |name: &str, at: f64| {
        let symbol = symbol_mathml(name, 0);
        let sign = if at < 0.0 { "+" } else { "−" };
        format!("<mrow><mi>δ</mi>{symbol}</mrow><mo>=</mo>{symbol}<mo>{sign}</mo>{}", size(at))
    };
    let gap = "<mspace width=\"2em\"/>";
    let (x, y) = (one(&point.input, tangent.at.0), one(&point.output, tangent.at.1));
    Some(math::block(&format!("{x}{gap}{y}")))
}

fn size(value: f64) -> String {
    number_mathml(&significant(value.abs(), FIGURES))
}

fn signed(value: f64) -> String {
    let minus = if value < 0.0 { "<mo>−</mo>" } else { "" };
    format!("{minus}{}", size(value))
}

/// Where the tangent is good, in full sentences.
pub fn good_words(point: &OperatingPointReference, tangent: &Tangent) -> String {
    let (x, y) = (letter(&point.input), letter(&point.output));
    if tangent.slope == 0.0 {
        return format!(
            "At {x} = {} the slope is 0: there is no linear part. To first order, small deviations of {x} leave {y} where it is.",
            quantity(tangent.at.0, 4, &point.input_unit)
        );
    }
    let share = format!("{}\u{a0}%", number(100.0 * tangent.rule.departure, 3));
    let at = |value: f64| format!("{x} = {}", quantity(value, FIGURES, &point.input_unit));
    let range = match (tangent.good_from, tangent.good_to) {
        (Some(from), Some(to)) => format!("between {} and {}", at(from), at(to)),
        (Some(from), None) => format!("above {}, as far as is shown", at(from)),
        (None, Some(to)) => format!("below {}, as far as is shown", at(to)),
        (None, None) => "everywhere in what is shown".to_owned(),
    };
    format!("The tangent is off by less than {share} of the change it foretells {range}.")
}
