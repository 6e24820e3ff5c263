use super::*;
use crate::algebra::{Polynomial, to_f64};
use crate::lti::{Limit, Pole};
use serde::Serialize;
use std::collections::BTreeMap;

/// The answer key as JSON, for other tools. Fields may be added, never renamed.
///
/// `den` is monic, highest power first; times in s, poles in rad/s, everything else in plant units.
pub fn to_json(reference: &Reference) -> Result<String, serde_json::Error> {
    to_json_for(reference, None)
}

/// Whose numbers a key is for.
pub struct ForStudent<'a> {
    /// As given.
    pub student: &'a str,
    /// Every parameter with its value as typed.
    pub parameters: BTreeMap<&'a str, &'a str>,
}

/// Like [`to_json`], with the student it is for and the values of the parameters.
pub fn to_json_for(
    reference: &Reference,
    student: Option<ForStudent<'_>>,
) -> Result<String, serde_json::Error> {
    serde_json::to_string_pretty(&ReferenceView {
        student: student.as_ref().map(|one| one.student),
        parameters: student.map(|one| one.parameters),
        ..view(reference)
    })
}

#[derive(Serialize)]
struct ReferenceView<'a> {
    lab: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    student: Option<&'a str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    parameters: Option<BTreeMap<&'a str, &'a str>>,
    models: Vec<ModelView<'a>>,
    simulations: Vec<SimulationView<'a>>,
}

#[derive(Serialize)]
struct ModelView<'a> {
    id: &'a str,
    title: &'a str,
    operating_points: Vec<OperatingPointView<'a>>,
}

#[derive(Serialize)]
struct OperatingPointView<'a> {
    id: &'a str,
    title: &'a str,
    equilibrium: BTreeMap<&'a str, f64>,
    input: &'a str,
    output: &'a str,
    transfer_function: TransferFunctionView,
    /// The derivation in the lab's own letters; null when it takes more terms than a page holds.
    letters: Option<super::letters::Steps>,
    poles: Vec<PoleView>,
    zeros: Vec<PoleView>,
    stability: &'static str,
    internal_stability: &'static str,
    /// What the rounding of coefficients leaves open, in words; null when nothing is.
    inconclusive: Option<String>,
    internal_poles: Vec<PoleView>,
    /// Null of an improper transfer function.
    impulse: Option<ResponseView<'a>>,
    step: Option<ResponseView<'a>>,
    accepted: Vec<AcceptedView<'a>>,
    /// Of a static function; null of what moves.
    tangent: Option<TangentView>,
    parting_push: Option<f64>,
    parting_amplitude: Option<f64>,
}

#[derive(Serialize)]
struct TangentView {
    slope: f64,
    input: f64,
    output: f64,
    departure: f64,
    good_from: Option<f64>,
    good_to: Option<f64>,
}

#[derive(Serialize)]
struct TransferFunctionView {
    num: Vec<f64>,
    den: Vec<f64>,
    /// The same coefficients as exact fractions.
    exact_num: Vec<String>,
    exact_den: Vec<String>,
}

#[derive(Serialize)]
struct PoleView {
    re: f64,
    im: f64,
    multiplicity: usize,
    error_bound: f64,
}

#[derive(Serialize)]
struct AcceptedView<'a> {
    parameters: BTreeMap<&'a str, f64>,
    transfer_function: TransferFunctionView,
    poles: Vec<PoleView>,
}

#[derive(Serialize)]
struct ResponseView<'a> {
    initial_value: f64,
    /// A number, or null when the response has no limit; then `final_behaviour` says which way it goes.
    final_value: Option<f64>,
    final_behaviour: &'static str,
    shape: &'static str,
    peak_value: Option<f64>,
    peak_time_s: Option<f64>,
    period_s: Option<f64>,
    damping_ratio: Option<f64>,
    natural_frequency_rad_s: Option<f64>,
    settling_time_2_percent_s: Option<f64>,
    settling_time_5_percent_s: Option<f64>,
    overshoot_percent: Option<f64>,
    rise_time_10_90_s: Option<f64>,
    rise_time_0_100_s: Option<f64>,
    samples: &'a [(f64, f64)],
}

#[derive(Serialize)]
struct SimulationView<'a> {
    id: &'a str,
    title: &'a str,
    peak_without: f64,
    peak_with: f64,
    switch_times: &'a [f64],
    samples: &'a [(f64, f64, f64)],
}

fn view(reference: &Reference) -> ReferenceView<'_> {
    ReferenceView {
        lab: &reference.lab,
        student: None,
        parameters: None,
        models: reference
            .models
            .iter()
            .map(|m| ModelView {
                id: &m.id,
                title: &m.title,
                operating_points: m.operating_points.iter().map(operating_point_view).collect(),
            })
            .collect(),
        simulations: reference
            .simulations
            .iter()
            .map(|s| SimulationView {
                id: &s.id,
                title: &s.title,
                peak_without: s.without.peak.1,
                peak_with: s.with.peak.1,
                switch_times: &s.with.switch_times,
                samples: &s.samples,
            })
            .collect(),
    }
}

fn operating_point_view(point: &OperatingPointReference) -> OperatingPointView<'_> {
    let main = point.main();
    OperatingPointView {
        id: &point.id,
        title: &point.title,
        equilibrium: point.equilibrium.iter().map(|(name, value)| (name.as_str(), *value)).collect(),
        input: &point.input,
        output: &point.output,
        transfer_function: transfer_function_view(main),
        letters: point.letters.as_ref().ok().map(super::letters::steps),
        poles: pole_views(&main.poles),
        zeros: pole_views(&main.zeros),
        stability: main.stability.as_str(),
        internal_stability: main.internal_stability.as_str(),
        inconclusive: main.doubts.any().then(|| main.doubts.words()),
        internal_poles: pole_views(&main.internal_poles),
        impulse: main.impulse.as_ref().map(response_view),
        step: main.step.as_ref().map(response_view),
        accepted: point
            .accepted
            .iter()
            .skip(1)
            .map(|linear| AcceptedView {
                parameters: linear.differs.iter().map(|(name, _, v)| (name.as_str(), to_f64(v))).collect(),
                transfer_function: transfer_function_view(linear),
                poles: pole_views(&linear.poles),
            })
            .collect(),
        tangent: point.tangent.as_ref().map(|tangent| TangentView {
            slope: tangent.slope,
            input: tangent.at.0,
            output: tangent.at.1,
            departure: tangent.rule.departure,
            good_from: tangent.good_from,
            good_to: tangent.good_to,
        }),
        parting_push: point.comparison.as_ref().and_then(|c| c.parting_push),
        parting_amplitude: point.comparison.as_ref().and_then(|c| c.parting_amplitude),
    }
}

fn transfer_function_view(linear: &LinearReference) -> TransferFunctionView {
    let monic = linear.linearization.transfer_function.monic();
    let floats = |p: &Polynomial| p.coefficients().iter().map(to_f64).collect();
    let fractions = |p: &Polynomial| p.coefficients().iter().map(ToString::to_string).collect();
    TransferFunctionView {
        num: floats(&monic.num),
        den: floats(&monic.den),
        exact_num: fractions(&monic.num),
        exact_den: fractions(&monic.den),
    }
}

fn pole_views(poles: &[Pole]) -> Vec<PoleView> {
    poles
        .iter()
        .map(|p| PoleView { re: p.re, im: p.im, multiplicity: p.multiplicity, error_bound: p.error_bound })
        .collect()
}

fn response_view(response: &ResponseReference) -> ResponseView<'_> {
    let f = &response.features;
    ResponseView {
        initial_value: f.initial_value,
        final_value: match f.final_value {
            Limit::Value(value) => Some(value),
            _ => None,
        },
        final_behaviour: f.final_value.as_str(),
        shape: f.shape.as_str(),
        peak_value: f.peak.as_ref().map(|p| p.value),
        peak_time_s: f.peak.as_ref().map(|p| p.time_s),
        period_s: f.period_s,
        damping_ratio: f.damping_ratio,
        natural_frequency_rad_s: f.natural_frequency_rad_s,
        settling_time_2_percent_s: f.settling_time_2_percent_s,
        settling_time_5_percent_s: f.settling_time_5_percent_s,
        overshoot_percent: f.overshoot_percent,
        rise_time_10_90_s: f.rise_time_10_90_s,
        rise_time_0_100_s: f.rise_time_0_100_s,
        samples: response.samples(),
    }
}
