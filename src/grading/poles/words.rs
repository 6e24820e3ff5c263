use super::super::accepted::also;
use super::super::closeness::{in_words, inward, percent};
use super::assignment::Assignment;
use super::set::Right;
use super::typed_pole::{Side, TypedPole, expected_part};
use super::{ExpectedPoles, MOST, Nearness};
use crate::algebra::{Rational, significant};
use crate::lab::Tolerance;
use crate::lti::Pole;
use crate::submission::TypedComplex;

/// The poles, the accepted interval of each part, and what else is right.
pub(super) fn expected(accepted: &[ExpectedPoles<'_>], nearness: &Nearness<'_>) -> String {
    let sets: Vec<_> = accepted.iter().map(|one| one.poles).collect();
    let Some(main) = sets.first() else { return String::new() };
    if main.what.is_empty() {
        return format!("No poles.{}", also(&sets));
    }
    let poles: Vec<_> = main
        .what
        .iter()
        .filter(|pole| pole.im >= 0.0)
        .map(|pole| with_intervals(pole, nearness.parts))
        .collect();
    let figures = match nearness.parts.figures {
        Some(1) => ", or each part correctly rounded to at least 1 figure".to_owned(),
        Some(figures) => format!(", or each part correctly rounded to at least {figures} figures"),
        None => String::new(),
    };
    let by_denominator = if nearness.coefficients.is_zero() {
        String::new()
    } else {
        format!(
            " Also right, on the same side of the imaginary axis: the poles, as rounded, of a denominator whose coefficients \
             are each within {} of the expected ones.",
            percent(nearness.coefficients)
        )
    };
    format!("{}{figures}.{by_denominator}{}", poles.join("; "), also(&sets))
}

/// `-0.019468 ± 5.5864j (real part from -0.020467 to -0.018468, imaginary part from ±5.5306 to ±5.6422)`
fn with_intervals(pole: &Pole, tolerance: &Tolerance) -> String {
    let (re, im) = shown(pole);
    let complex = im != 0.0;
    let mut text = significant(re, 5);
    if complex {
        text.push_str(&format!(" ± {}j", significant(im, 5)));
    }
    let times = match pole.multiplicity {
        1 => String::new(),
        many => format!("{}, ", times(many)),
    };
    let side = Side::of(pole);
    let intervals = match (interval(pole.re, pole, tolerance), interval(pole.im, pole, tolerance)) {
        (Some((low, high)), im) => {
            // The sign of a real part is held to, whatever the tolerance.
            let re = match side {
                Side::Left if !is_negative(&high) => format!("from {low} to below 0"),
                Side::Right if is_negative(&low) || low == "0" => format!("from above 0 to {high}"),
                _ => format!("from {low} to {high}"),
            };
            match im {
                Some((low, high)) if complex && is_negative(&low) => {
                    format!("real part {re}, imaginary part up to ±{high}")
                }
                Some((low, high)) if complex => {
                    format!("real part {re}, imaginary part from ±{low} to ±{high}")
                }
                _ if complex => {
                    format!(
                        "real part {re}, imaginary part {}",
                        in_words(&without_figures(pole.im, pole, tolerance))
                    )
                }
                _ => re,
            }
        }
        (None, _) => format!("each part {}", in_words(&without_figures(pole.re, pole, tolerance))),
    };
    format!("{text} ({times}{intervals})")
}

fn is_negative(number: &str) -> bool {
    number.starts_with('-')
}

/// What holds for a part of a pole, but for rounding.
fn without_figures(part: f64, pole: &Pole, tolerance: &Tolerance) -> Tolerance {
    let here = expected_part(part, pole).map_or_else(|| tolerance.clone(), |part| part.stated(tolerance));
    Tolerance { figures: None, ..here }
}

fn interval(part: f64, pole: &Pole, tolerance: &Tolerance) -> Option<(String, String)> {
    let (low, high) = expected_part(part, pole)?.interval(tolerance);
    let width = (&high - &low) / Rational::from(2);
    inward(&low, &high, &width)
}

/// Why a set is right.
pub(super) fn right(right: &Right, one: &ExpectedPoles<'_>, allowed: &Rational) -> String {
    let with = one.poles.with();
    match right {
        Right::EachPart => {
            format!("Every pole{with} is there, each as often as it should be, and no other.")
        }
        Right::Denominator(change) => {
            let why = if one.poles.what.iter().any(|pole| pole.multiplicity > 1) {
                "near a multiple pole small changes of the coefficients move the poles far"
            } else {
                "small changes of the coefficients move some of these poles farther than their own tolerance"
            };
            format!(
                "These are, rounded, the poles of a denominator whose coefficients differ from the expected ones{with} by at most {}, \
                 within the {} allowed; {why}.",
                percent(&rounded_up(change, allowed)),
                percent(allowed)
            )
        }
    }
}

/// To a hundredth of `allowed`.
fn rounded_up(change: &Rational, allowed: &Rational) -> Rational {
    let step = allowed / Rational::from(100);
    Rational::from((change / &step).ceil()).max(Rational::ONE) * step
}

/// `1 of 3 poles is right. -0.2 is written where -0.143 is expected.`
pub(super) fn wrong_pairs(each: &[Pole], values: &[TypedPole], fit: &Assignment) -> String {
    let right = fit.accepted();
    let mut reason =
        format!("{right} of {} poles {} right", each.len(), if right == 1 { "is" } else { "are" });
    let pairs: Vec<_> = fit
        .wrong_pairs()
        .map(|(typed, expected)| {
            format!("{} is written where {} is expected", values[typed].text(), pole_text(&each[expected]))
        })
        .collect();
    if !pairs.is_empty() {
        reason = format!("{reason}: {}", pairs.join("; "));
    }
    reason.push('.');
    let of_pairs = |index: &usize, typed: bool| {
        fit.wrong_pairs().any(|pair| *index == if typed { pair.0 } else { pair.1 })
    };
    let missing: Vec<_> = fit
        .not_found(each.len())
        .into_iter()
        .filter(|index| !of_pairs(index, false))
        .map(|index| pole_text(&each[index]))
        .collect();
    if !missing.is_empty() {
        reason.push_str(&format!(" Nothing is written for {}.", missing.join(", ")));
    }
    let extra: Vec<_> = fit
        .not_right(values.len())
        .into_iter()
        .filter(|index| !of_pairs(index, true))
        .map(|index| values[index].text())
        .collect();
    if !extra.is_empty() {
        reason.push_str(&format!(" Too many: {}.", extra.join(", ")));
    }
    reason
}

pub(super) fn multiplicities(want: &[Pole], values: &[TypedPole], tolerance: &Tolerance) -> String {
    let off: Vec<_> = want
        .iter()
        .filter_map(|pole| {
            let given = values.iter().filter(|value| value.accepted_for(pole, tolerance)).count();
            (given != pole.multiplicity).then(|| {
                let (counts, is) = (times(pole.multiplicity), times(given));
                format!("{} counts {counts}, it is given {is}", pole_text(pole))
            })
        })
        .collect();
    format!("The places are right, but not how often each counts: {}.", off.join("; "))
}

pub(super) fn is_are(list: &[String]) -> String {
    format!("{} {}", list.join(", "), if list.len() == 1 { "is" } else { "are" })
}

pub(super) fn list_each(poles: &[Pole]) -> Vec<String> {
    poles.iter().map(pole_text).collect()
}

pub(super) fn typed_list(typed: &[TypedComplex]) -> String {
    if typed.is_empty() {
        return "No poles".to_owned();
    }
    let shown: Vec<_> = typed.iter().take(MOST).map(|pole| TypedPole::of(pole).text()).collect();
    let more = if typed.len() > MOST { format!(" and {} more", typed.len() - MOST) } else { String::new() };
    format!("{}{more}", shown.join(", "))
}

fn times(n: usize) -> String {
    match n {
        1 => "once".to_owned(),
        2 => "twice".to_owned(),
        n => format!("{n} times"),
    }
}

fn pole_text(pole: &Pole) -> String {
    let (re, im) = shown(pole);
    complex_text(&significant(re, 5), &significant(im, 5), im == 0.0)
}

/// Below its error bound a part is zero as far as anyone can tell.
fn shown(pole: &Pole) -> (f64, f64) {
    let shown = |part: f64| if part.abs() <= pole.error_bound { 0.0 } else { part };
    (shown(pole.re), shown(pole.im))
}

impl TypedPole {
    pub fn text(&self) -> String {
        complex_text(&self.re.text, &self.im.text, self.im.value.is_zero())
    }
}

/// `-0.0195 + 5.59j`; a real number stands alone.
fn complex_text(re: &str, im: &str, real: bool) -> String {
    if real {
        return re.to_owned();
    }
    match im.strip_prefix(['-', '−']) {
        Some(positive) => format!("{re} - {positive}j"),
        None => format!("{re} + {}j", im.trim_start_matches('+')),
    }
}
