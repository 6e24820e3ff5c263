//! The answer key as a view: from the equations to every reference answer. Says nothing that is not in the lab or computed from it.

use super::anchor::{anchor, question_anchor};
use super::derivation::DerivationView;
use super::figures::{
    PreparedResponse, PreparedSimulation, StudentCurves, characteristic_figure, comparison_figure,
    feature_words, limit_words, pole_zero, root_words, tangent_figure,
};
use super::kit::{ReportKit, trust};
use super::math;
use super::numbers::{complex, letter, number, quantity, typeset};
use super::pictures::draw;
use super::tangent;
use super::view::{AnswerView, FigureView};
use crate::algebra::{Polynomial, to_f64};
use crate::lab::{LabDefinition, LineForm, ModelDefinition, Question, SimulationDefinition, SystemRef};
use crate::lti::{Features, Pole, Stability, roots};
use crate::model::Linearization;
use crate::nonlinear::{Block, Nonlinearity, Signal};
use crate::reference::{
    LinearReference, ModelReference, OperatingPointReference, ResponseReference, SimulationReference,
};
use crate::source::sanitize;
use crate::submission::AnsweredIn;
use serde::Serialize;

#[derive(Serialize)]
pub struct ReferencePage {
    page_title: String,
    course: String,
    lab_title: String,
    source_note: String,
    /// Whose numbers these are; empty for the lab's own.
    student: String,
    parameters: Vec<ParameterView>,
    models: Vec<ModelView>,
    simulations: Vec<SimulationView>,
    questions: Vec<KeyQuestion>,
}

#[derive(Serialize)]
struct ParameterView {
    symbol_html: String,
    value: String,
    unit: String,
    description: String,
    accepted: String,
}

#[derive(Serialize)]
struct ModelView {
    anchor: String,
    title: String,
    /// A linear model as it was given; empty for one given by equations of motion.
    given_html: String,
    equations_html: Vec<String>,
    coordinates: Vec<ParameterView>,
    points: Vec<PointView>,
}

#[derive(Serialize)]
struct PointView {
    anchor: String,
    title: String,
    equilibrium_html: Vec<String>,
    exactness: String,
    /// There was nothing to linearize.
    given_linear: bool,
    linear_html: Vec<String>,
    derivation: DerivationView,
    state_html: String,
    space_html: Vec<String>,
    from_to: String,
    uncancelled_html: String,
    /// The common factor; empty when there is none.
    factor_html: String,
    transfer_html: String,
    monic_html: String,
    poles: Vec<RootView>,
    zeros: Vec<RootView>,
    stability: &'static str,
    internal_poles: String,
    internal_stability: &'static str,
    hidden: String,
    features: Vec<FeatureRow>,
    impulse_words: String,
    step_words: String,
    alternatives: Vec<AlternativeView>,
    figures: Vec<FigureView>,
    comparisons: Vec<FigureView>,
    trust: String,
    /// Of a static function: its deviations, its tangent, both ways; empty of what moves.
    /// Of a static function: the tangent, what deviations are, and the tangent in deviations. Empty where there is none.
    tangent_html: String,
    deviations_html: String,
    deviation_line_html: String,
}

#[derive(Serialize)]
struct RootView {
    value: String,
    multiplicity: String,
    bound: String,
}

#[derive(Serialize)]
struct FeatureRow {
    name: &'static str,
    impulse: String,
    step: String,
}

#[derive(Serialize)]
struct AlternativeView {
    differs: String,
    transfer_html: String,
    poles: String,
}

#[derive(Serialize)]
struct SimulationView {
    anchor: String,
    title: String,
    chain: String,
    facts: Vec<(&'static str, String)>,
    figures: Vec<FigureView>,
}

#[derive(Serialize)]
struct KeyQuestion {
    anchor: String,
    number: String,
    title: String,
    points: String,
    text_html: String,
    answers: Vec<AnswerView>,
    criteria: Vec<KeyCriterion>,
}

#[derive(Serialize)]
struct KeyCriterion {
    title: String,
    points: String,
}

pub fn page(kit: &ReportKit, student: Option<&str>) -> ReferencePage {
    let lab = &kit.lab;
    let models = lab.models.iter().filter_map(|definition| {
        let reference = kit.reference.models.iter().find(|m| m.id == definition.id)?;
        Some(model(kit, definition, reference))
    });
    let simulations = lab.simulations.iter().filter_map(|definition| {
        let reference = kit.reference.simulations.iter().find(|s| s.id == definition.id)?;
        Some(simulation(definition, reference))
    });
    ReferencePage {
        page_title: format!("Answer key – {}", lab.title),
        course: lab.course.clone(),
        lab_title: lab.title.clone(),
        source_note: lab.source_note.clone(),
        student: student.map_or_else(String::new, |id| sanitize(id).to_string()),
        parameters: parameters(lab),
        models: models.collect(),
        simulations: simulations.collect(),
        questions: lab.questions.iter().zip(&kit.questions).map(|(q, k)| key_question(q, k)).collect(),
    }
}

fn parameters(lab: &LabDefinition) -> Vec<ParameterView> {
    let accepted = |p: &crate::lab::Parameter| {
        p.accepted.iter().map(|(text, _)| text.as_str()).collect::<Vec<_>>().join(", ")
    };
    lab.parameters
        .iter()
        .map(|p| ParameterView {
            symbol_html: math::symbol(&p.name),
            value: p.text.clone(),
            unit: typeset(&p.unit),
            description: p.description.clone(),
            accepted: accepted(p),
        })
        .collect()
}

fn model(kit: &ReportKit, definition: &ModelDefinition, reference: &ModelReference) -> ModelView {
    let coordinates = definition.model.coordinates.iter().map(|c| ParameterView {
        symbol_html: math::symbol(&c.name),
        value: String::new(),
        unit: typeset(&c.unit),
        description: c.description.clone(),
        accepted: String::new(),
    });
    let points = reference.operating_points.iter().map(|p| {
        let system = SystemRef { model: definition.id.clone(), operating_point: p.id.clone() };
        point(kit, &system, p, definition)
    });
    ModelView {
        anchor: anchor("model", &definition.id),
        title: definition.title.clone(),
        given_html: definition.linear.as_ref().map(math::linear_form).unwrap_or_default(),
        equations_html: match definition.linear {
            Some(_) if !definition.model.is_printed() => Vec::new(),
            _ => definition.model.equations.iter().map(math::equation).collect(),
        },
        coordinates: coordinates.collect(),
        points: points.collect(),
    }
}

fn point(
    kit: &ReportKit,
    system: &SystemRef,
    point: &OperatingPointReference,
    definition: &ModelDefinition,
) -> PointView {
    let main = point.main();
    let linearization = &main.linearization;
    let id = |kind: &str| anchor("figure", &format!("{system}.{kind}"));
    let features = |known: &Option<ResponseReference>| known.as_ref().map(|known| known.features.clone());
    let (impulse, step) = (features(&main.impulse), features(&main.step));
    let words = |features: &Option<Features>| match features {
        Some(features) => feature_words(features, &point.output_unit),
        None => "none, since the numerator outranks the denominator.".to_owned(),
    };
    let comparisons = point.comparison.iter().flat_map(|comparison| &comparison.runs).enumerate();
    PointView {
        anchor: anchor("point", &system.to_string()),
        title: point.title.clone(),
        equilibrium_html: point
            .equilibrium_text
            .iter()
            .map(|(name, text)| format!("{} = {}", math::symbol(name), typed_value(text)))
            .collect(),
        exactness: exactness(main),
        given_linear: definition.linear.is_some(),
        linear_html: linearization.linear_equations.iter().map(|e| math::linear_equation(e)).collect(),
        derivation: DerivationView::of(&point.letters, definition.model.is_printed()),
        state_html: math::state_vector(&linearization.states),
        space_html: linearization.state_space.as_ref().map_or_else(Vec::new, |space| {
            math::state_space(&space.a, &space.b, &space.c, &space.d).to_vec()
        }),
        from_to: format!("from {} to {}", letter(&point.input), letter(&point.output)),
        uncancelled_html: math::transfer_function(&linearization.uncancelled),
        factor_html: if linearization.cancelled.degree() > 0 {
            math::polynomial(&linearization.cancelled)
        } else {
            String::new()
        },
        transfer_html: math::transfer_function(&linearization.transfer_function),
        monic_html: math::transfer_function(&linearization.transfer_function.monic()),
        poles: root_views(&main.poles),
        zeros: root_views(&main.zeros),
        stability: main.stability.words(),
        internal_poles: root_words(&main.internal_poles, 10),
        internal_stability: main.internal_stability.words(),
        hidden: hidden_words(linearization, main.internal_stability),
        features: impulse
            .as_ref()
            .zip(step.as_ref())
            .map_or_else(Vec::new, |(impulse, step)| feature_rows(impulse, step, &point.output_unit)),
        impulse_words: words(&impulse),
        step_words: words(&step),
        alternatives: point.accepted.iter().skip(1).map(alternative).collect(),
        figures: point_figures(point, id),
        comparisons: comparisons
            .filter_map(|(i, (push, samples))| {
                draw(&comparison_figure(point, *push, samples), &id(&format!("push{i}"))).ok()
            })
            .collect(),
        trust: trust(&kit.reference, system).unwrap_or_default(),
        tangent_html: tangent::line_html(point, LineForm::Line).unwrap_or_default(),
        deviations_html: tangent::deviations_html(point).unwrap_or_default(),
        deviation_line_html: tangent::line_html(point, LineForm::Deviations).unwrap_or_default(),
    }
}

/// The equilibrium as the lab's author typed it: `pi` → π.
pub(super) fn typed_value(text: &str) -> String {
    match crate::algebra::Expression::parse(text) {
        Ok(expression) => math::inline(&expression.to_mathml()),
        Err(_) => {
            let mut out = String::new();
            super::escape::escape(&mut out, text);
            out
        }
    }
}

fn point_figures(point: &OperatingPointReference, id: impl Fn(&str) -> String) -> Vec<FigureView> {
    if let Some(tangent) = &point.tangent {
        return draw(&tangent_figure(point, tangent), &id("tangent")).into_iter().collect();
    }
    let main = point.main();
    let map = pole_zero(&format!("{}: poles and zeros", point.title), &main.poles, &main.zeros, None);
    let mut drawn: Vec<_> = draw(&map, &id("map")).into_iter().collect();
    for (kind, response) in [("impulse", &main.impulse), ("step", &main.step)] {
        let Some(known) = response else { continue };
        let prepared = PreparedResponse::new(point, known);
        for (i, figure) in prepared.figures(StudentCurves::default()).iter().enumerate() {
            drawn.extend(draw(figure, &id(&format!("{kind}{i}"))));
        }
    }
    drawn
}

fn root_views(roots: &[Pole]) -> Vec<RootView> {
    roots
        .iter()
        .map(|p| RootView {
            value: complex(p.re, p.im, false, 12),
            multiplicity: p.multiplicity.to_string(),
            bound: number(p.error_bound, 2),
        })
        .collect()
}

/// What the transfer function does not show of the whole state.
fn hidden_words(linearization: &Linearization, internal: Stability) -> String {
    if linearization.cancelled.degree() == 0 {
        return "Nothing cancels: the poles of the transfer function are those of the whole state."
            .to_owned();
    }
    let hidden = roots(&linearization.cancelled).unwrap_or_default();
    let places = root_words(&hidden, 6);
    let (eigenvalues, cancel, them) = if hidden.len() == 1 {
        ("the eigenvalue", "cancels", "it")
    } else {
        ("the eigenvalues", "cancel", "them")
    };
    let mut words = format!(
        "The whole state has, besides, {eigenvalues} {places}, which {cancel} between numerator and denominator: this input and this \
         output do not show {them}. With {them} the state is {}.",
        internal.words()
    );
    let free: Vec<_> = free_states(linearization).iter().map(|s| letter(s)).collect();
    if linearization.cancelled.trailing_zeros() > 0 && !free.is_empty() {
        words += &format!(
            " The pole at the origin belongs to {}: it stands in none of the equations itself, only its rates do, so it may rest anywhere.",
            free.join(", ")
        );
    }
    words
}

/// States whose own value changes no rate: their column of A is zero.
fn free_states(linearization: &Linearization) -> Vec<&String> {
    let Some(a) = linearization.state_space.as_ref().map(|space| &space.a) else { return Vec::new() };
    let is_free = |j: usize| a.rows.iter().all(|row| row.get(j).is_some_and(|v| to_f64(v) == 0.0));
    linearization.states.iter().enumerate().filter(|(j, _)| is_free(*j)).map(|(_, s)| s).collect()
}

fn feature_rows(impulse: &Features, step: &Features, unit: &str) -> Vec<FeatureRow> {
    let row = |name, value: &dyn Fn(&Features) -> String| FeatureRow {
        name,
        impulse: value(impulse),
        step: value(step),
    };
    let optional = |v: Option<f64>, unit: &str| v.map_or("–".to_owned(), |v| quantity(v, 6, unit));
    let rows = vec![
        row("Shape", &|f| f.shape.words().trim_start_matches("a ").trim_start_matches("an ").to_owned()),
        row("Initial value", &|f| quantity(f.initial_value, 6, unit)),
        row("Final value", &|f| limit_words(f.final_value, unit).trim_start_matches("to ").to_owned()),
        row("Farthest", &|f| {
            f.peak.map_or("–".to_owned(), |p| {
                format!("{} at {}", quantity(p.value, 6, unit), quantity(p.time_s, 6, "s"))
            })
        }),
        row("Period", &|f| optional(f.period_s, "s")),
        row("Damping ratio", &|f| optional(f.damping_ratio, "")),
        row("Natural frequency", &|f| optional(f.natural_frequency_rad_s, "rad/s")),
        row("Slowest time constant", &|f| optional(f.slowest_time_constant_s, "s")),
        row("Settled within 2\u{a0}%", &|f| optional(f.settling_time_2_percent_s, "s")),
        row("Settled within 5\u{a0}%", &|f| optional(f.settling_time_5_percent_s, "s")),
        row("Overshoot", &|f| optional(f.overshoot_percent, "%")),
        row("Rise time, 10 to 90\u{a0}%", &|f| optional(f.rise_time_10_90_s, "s")),
    ];
    rows.into_iter().filter(|r| r.impulse != "–" || r.step != "–").collect()
}

/// How far the numbers of a key may be trusted.
fn exactness(main: &LinearReference) -> String {
    if main.linearization.exact {
        return "Every coefficient below was computed exactly, in rationals, and is shown rounded."
            .to_owned();
    }
    let rounded = "Where the system rests, or a parameter, is not a rational number, so coefficients were computed in double precision.";
    match main.doubts.any() {
        true => format!("{rounded} From these cannot be told: {}.", main.doubts.words()),
        false => rounded.to_owned(),
    }
}

fn alternative(linear: &LinearReference) -> AlternativeView {
    let differs: Vec<_> =
        linear.differs.iter().map(|(name, text, _)| format!("{} = {text}", letter(name))).collect();
    AlternativeView {
        differs: differs.join(", "),
        transfer_html: math::transfer_function(&linear.linearization.transfer_function),
        poles: root_words(&linear.poles, 6),
    }
}

fn simulation(definition: &SimulationDefinition, reference: &SimulationReference) -> SimulationView {
    let id = |kind: &str| anchor("figure", &format!("{}.{kind}", definition.id));
    let unit = &definition.output_unit;
    let peak =
        |(time, value): (f64, f64)| format!("{} at {}", quantity(value, 8, unit), quantity(time, 6, "s"));
    let times = &reference.with.switch_times;
    let shown: Vec<_> = times.iter().take(12).map(|t| number(*t, 8)).collect();
    let more =
        if times.len() > shown.len() { format!(" … ({} in all)", times.len()) } else { String::new() };
    let figures = [
        draw(&PreparedSimulation::new(definition, reference).figure(None), &id("time")),
        draw(&characteristic_figure(definition, reference), &id("characteristic")),
    ];
    SimulationView {
        anchor: anchor("simulation", &definition.id),
        title: definition.title.clone(),
        chain: chain_words(definition),
        facts: vec![
            ("Largest without", peak(reference.without.peak)),
            ("Largest with", peak(reference.with.peak)),
            (
                "Switches at (s)",
                if shown.is_empty() { "never".to_owned() } else { format!("{}{more}", shown.join(", ")) },
            ),
        ],
        figures: figures.into_iter().flatten().collect(),
    }
}

/// `8 V sine at 1 rad/s → saturation at ±5 → 0.2083/(s + 1.71)`.
pub(super) fn chain_words(definition: &SimulationDefinition) -> String {
    let unit = definition.input_unit.as_str();
    let source = match definition.chain.source {
        Signal::Sine { amplitude, frequency_rad_s, bias, .. } => {
            let about =
                if bias == 0.0 { String::new() } else { format!(" about {}", quantity(bias, 6, unit)) };
            format!(
                "sine of {}{about} at {}",
                quantity(amplitude, 6, unit),
                quantity(frequency_rad_s, 6, "rad/s")
            )
        }
        Signal::Pulse { low, high, period_s, duty, .. } => format!(
            "pulses between {} and {}, period {}, {}\u{a0}% high",
            quantity(low, 6, unit),
            quantity(high, 6, unit),
            quantity(period_s, 6, "s"),
            number(100.0 * duty, 4)
        ),
        Signal::Step { amplitude, time_s } => {
            format!("step of {} at {}", quantity(amplitude, 6, unit), quantity(time_s, 6, "s"))
        }
    };
    let blocks = definition.chain.blocks.iter().map(|block| match block {
        Block::Nonlinearity(Nonlinearity::Saturation { limit }) => {
            format!("saturation at ±{}", number(*limit, 6))
        }
        Block::Nonlinearity(Nonlinearity::DeadZone { threshold }) => {
            format!("dead zone of ±{}", number(*threshold, 6))
        }
        Block::Nonlinearity(Nonlinearity::Backlash { width }) => {
            format!("backlash of width {}", number(*width, 6))
        }
        Block::Nonlinearity(Nonlinearity::Relay { amplitude, hysteresis, dead_zone }) => {
            let of = |value: f64, what: &str| match value {
                0.0 => String::new(),
                value => format!(", {what} ±{}", number(value, 6)),
            };
            let (dead_zone, hysteresis) = (of(*dead_zone, "dead zone"), of(*hysteresis, "hysteresis"));
            format!("relay of ±{}{dead_zone}{hysteresis}", number(*amplitude, 6))
        }
        Block::Nonlinearity(Nonlinearity::Quantizer { interval }) => {
            format!("quantizer with an interval of {}", number(*interval, 6))
        }
        Block::Nonlinearity(Nonlinearity::RateLimit { rising, falling }) => {
            format!("rate limit of +{} and {} per second", number(*rising, 6), number(*falling, 6))
        }
        Block::Nonlinearity(Nonlinearity::CoulombFriction { coulomb, viscous }) => {
            let viscous = match *viscous {
                0.0 => String::new(),
                viscous => format!(" and viscous friction of {}", number(viscous, 6)),
            };
            format!("Coulomb friction of ±{}{viscous}", number(*coulomb, 6))
        }
        Block::Linear { num, den } => format!("{}/{}", factor(num), factor(den)),
    });
    [source].into_iter().chain(blocks).collect::<Vec<_>>().join(" → ")
}

/// A polynomial, in parentheses when it is a sum.
fn factor(coefficients: &[f64]) -> String {
    let text = powers(coefficients);
    if text.contains(' ') { format!("({text})") } else { text }
}

fn powers(coefficients: &[f64]) -> String {
    let exact = coefficients.iter().map(|c| crate::algebra::from_f64(*c).unwrap_or_default()).collect();
    let text = crate::algebra::polynomial_text(&Polynomial::new(exact), "s", 6);
    typeset(&text)
}

fn key_question(question: &Question, kit: &super::kit::QuestionKit) -> KeyQuestion {
    KeyQuestion {
        anchor: question_anchor(&question.id),
        number: question.number.clone(),
        title: question.title.clone(),
        points: question.points.to_string(),
        text_html: kit.text_html.clone(),
        answers: kit
            .fields
            .iter()
            .filter(|f| !f.reference_html.is_empty())
            .map(|f| AnswerView {
                prompt: match f.answered_in {
                    AnsweredIn::Letters => format!("{} (in letters)", f.prompt),
                    _ => f.prompt.clone(),
                },
                yours_html: String::new(),
                reference_heading: super::answers::reference_heading(f.kind),
                reference_html: format!("{}{}", f.letters_html, f.reference_html),
                conflicts: Vec::new(),
                conflicts_title: "",
            })
            .collect(),
        criteria: question
            .criteria
            .iter()
            .map(|c| KeyCriterion { title: c.title.clone(), points: c.points.to_string() })
            .collect(),
    }
}
