//! A static function: its slope by differences, and where its tangent stops being good by dense sampling.

use super::{Agreement, digits};
use crate::algebra::{Rational, significant};
use crate::lab::OperatingPointDefinition;
use crate::model::{Model, StaticFunction};
use crate::reference::OperatingPointReference;
use std::collections::BTreeMap;

/// Samples on each side.
const SAMPLES: usize = 100_000;

pub(super) fn tangent_routes(
    name: &str,
    model: &Model,
    parameters: &BTreeMap<String, Rational>,
    at: &OperatingPointDefinition,
    point: &OperatingPointReference,
) -> Vec<Agreement> {
    let Some(tangent) = &point.tangent else { return Vec::new() };
    let Ok(Some(function)) = StaticFunction::new(model, parameters, &at.at, &at.input, &at.output) else {
        return Vec::new();
    };
    let (x0, y0) = tangent.at;
    let reach = (x0 - tangent.rule.from).min(tangent.rule.to - x0);
    // Richardson: the error of the difference falls with h², and that of the combination with h⁴.
    let difference = |h: f64| (function.at(x0 + h) - function.at(x0 - h)) / (2.0 * h);
    let h = 1e-3 * reach;
    let slope = (4.0 * difference(0.5 * h) - difference(h)) / 3.0;
    let scale = tangent.slope.abs().max(1e-3 * (y0 / reach).abs());
    let mut agreements = vec![Agreement {
        what: format!("{name} slope"),
        routes: "exact derivative against differences of the function",
        digits: digits((slope - tangent.slope).abs(), scale.max(f64::MIN_POSITIVE)),
        wanted: 6.0,
        note: String::new(),
    }];
    for (what, end, found) in
        [("below", tangent.rule.from, tangent.good_from), ("above", tangent.rule.to, tangent.good_to)]
    {
        if tangent.slope == 0.0 {
            continue;
        }
        let sampled = sampled(&function, tangent.slope, tangent.rule.departure, (x0, y0), end);
        let digits = match (found, sampled) {
            (None, None) => f64::INFINITY,
            (Some(found), Some(sampled)) => digits((found - sampled).abs(), (found - x0).abs()),
            _ => 0.0,
        };
        agreements.push(Agreement {
            what: format!("{name} tangent, {what}"),
            routes: "bisection against a dense sampling of function and tangent",
            digits,
            wanted: 4.0,
            note: found.map_or_else(
                || "good as far as is shown".to_owned(),
                |x| format!("good to {}", significant(x, 6)),
            ),
        });
    }
    agreements
}

/// The first crossing of the departure from x0 towards `end`, by straight lines between samples.
fn sampled(
    function: &StaticFunction,
    slope: f64,
    departure: f64,
    (x0, y0): (f64, f64),
    end: f64,
) -> Option<f64> {
    let share =
        |x: f64| (function.at(x) - y0 - slope * (x - x0)).abs() / (slope * (x - x0)).abs() - departure;
    let x = |k: usize| x0 + (end - x0) * k as f64 / SAMPLES as f64;
    let mut before = None;
    for k in 1..=SAMPLES {
        let here = share(x(k));
        if here.is_nan() {
            return Some(x(k));
        }
        if here > 0.0 {
            let Some(before) = before else { return Some(x(k)) };
            let part: f64 = before / (before - here);
            return Some(x(k - 1) + part * (x(k) - x(k - 1)));
        }
        before = Some(here);
    }
    None
}
