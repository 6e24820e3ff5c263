//! Responses whose terms cancel or whose times lie far apart, against many digits found by another route.

use crate::hard_table::{Line, entries, multiplied_out};
use polemark::algebra::Polynomial;
use polemark::lti::{Features, InputKind, Response, ResponseError, TransferFunction};
use rayon::prelude::*;

/// One entry of `hard_responses.txt`; its head says what each line means.
#[derive(Default)]
struct Entry {
    name: String,
    num: Polynomial,
    den: Polynomial,
    step: bool,
    shape: String,
    final_value: Option<f64>,
    accuracy: f64,
    values: Vec<(f64, f64)>,
}

fn table() -> Vec<Entry> {
    entries(
        include_str!("hard_responses.txt"),
        |name| Entry { name, ..Entry::default() },
        |entry, line| match line {
            Line::Key("num", text) => entry.num = multiplied_out(text),
            Line::Key("den", text) => entry.den = multiplied_out(text),
            Line::Key("kind", text) => entry.step = text == "step",
            Line::Key("shape", text) => entry.shape = text.to_string(),
            Line::Key("final", text) => entry.final_value = text.parse().ok(),
            Line::Key("accuracy", text) => entry.accuracy = text.parse().unwrap(),
            Line::Key(key, _) => panic!("{}: {key}", entry.name),
            Line::Row(row) => {
                let [t, y] = row[..] else { panic!("{}: {row:?}", entry.name) };
                entry.values.push((t.parse().unwrap(), y.parse().unwrap()));
            }
        },
    )
}

fn faults(entry: &Entry) -> Vec<String> {
    let mut faults = Vec::new();
    let mut demand = |holds: bool, what: String| {
        if !holds {
            faults.push(format!("{}: {what}", entry.name));
        }
    };
    let g = TransferFunction::new(entry.num.clone(), entry.den.clone()).unwrap();
    let kind = if entry.step { InputKind::Step } else { InputKind::Impulse };
    let response = match Response::new(&g, kind) {
        Ok(response) => response,
        Err(error) => return vec![format!("{}: {error}", entry.name)],
    };
    let peak = entry.values.iter().map(|(_, y)| y.abs()).fold(0.0, f64::max);
    for &(t, y) in &entry.values {
        let found = response.at(t);
        demand(
            (found - y).abs() <= entry.accuracy * peak,
            format!("at {t} s {found:e}, not {y:e}: off by {:.1e} of the peak", (found - y).abs() / peak),
        );
    }
    let features = Features::of(&response);
    let samples = response.samples(response.horizon_s(), 1e-3).len();
    demand(features.shape.as_str() == entry.shape, format!("{:?}", features.shape));
    let close = |found: f64, expected: f64| (found - expected).abs() <= 1e-12 * expected.abs();
    demand(
        match (features.final_value.value(), entry.final_value) {
            (None, None) => true,
            (Some(found), Some(expected)) => close(found, expected),
            _ => false,
        },
        format!("final value {:?}", features.final_value),
    );
    demand(samples <= 4000, format!("{samples} points"));
    faults
}

#[test]
fn every_value_shape_and_limit_is_right() {
    let entries = table();
    assert!(entries.len() >= 27, "{} responses", entries.len());
    let faults: Vec<String> = entries.par_iter().flat_map(faults).collect();
    assert!(faults.is_empty(), "{faults:#?}");
}

/// Three real poles 1e-15 apart, or a pair: what one reads off the curve is the same.
#[test]
fn nothing_one_sees_changes_where_poles_meet() {
    let features = |den: &str| {
        let g = TransferFunction::new(Polynomial::one(), multiplied_out(den)).unwrap();
        Features::of(&Response::new(&g, InputKind::Step).unwrap())
    };
    let double = features("1 2 1");
    for den in ["1 2 1.000000000000001", "1 2 0.999999999999999", "1 2 1.0000000000000000000000000001"] {
        let other = features(den);
        assert_eq!(other.shape, double.shape, "{den}");
        let pairs = [
            (other.settling_time_2_percent_s, double.settling_time_2_percent_s),
            (other.settling_time_5_percent_s, double.settling_time_5_percent_s),
            (other.rise_time_10_90_s, double.rise_time_10_90_s),
            (other.natural_frequency_rad_s, double.natural_frequency_rad_s),
            (other.damping_ratio, double.damping_ratio),
            (other.overshoot_percent.map(|p| p + 1.0), double.overshoot_percent.map(|p| p + 1.0)),
        ];
        for (nth, (found, expected)) in pairs.into_iter().enumerate() {
            let (found, expected) = (found.unwrap(), expected.unwrap());
            assert!((found - expected).abs() <= 1e-9 * expected, "{den}, {nth}: {found}, not {expected}");
        }
    }
}

/// What cannot be summed is refused, by name.
#[test]
fn what_takes_too_many_digits_is_refused_and_names_the_poles() {
    let den: Vec<String> = (0..10).map(|k| format!("(1 1.{}{k})", "0".repeat(99))).collect();
    let g = TransferFunction::new(Polynomial::one(), multiplied_out(&den.join(" "))).unwrap();
    let error = Response::new(&g, InputKind::Impulse).unwrap_err();
    assert!(matches!(error, ResponseError::TooClose { .. } | ResponseError::OutOfRange), "{error:?}");
}
