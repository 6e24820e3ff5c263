//! What a student wrote and what would have been right, field by field, as HTML.

use super::escape::escape;
use super::figures::{limit_words, root_words};
use super::math;
use super::numbers::{number, quantity, typographic};
use super::prose::{self, Highlight};
use super::tangent;
use crate::algebra::to_f64;
use crate::lab::{Check, Criterion, FeatureKind, SystemRef};
use crate::lti::Features;
use crate::reference::{OperatingPointReference, Reference};
use crate::source::sanitize;
use crate::submission::{
    Answer, AnswerValue, Decimal, FieldKind, Figure, FinalValue, Series, TypedComplex, Unit,
    nonlinearity_name, shape_name,
};
use base64::Engine as _;

/// The answer as HTML, with words of prose marked; `None` stands for a blank.
pub fn yours(answer: Option<&Answer>, prompt: &str, marks: &[Highlight]) -> String {
    let Some(answer) = answer else { return "<span class=\"waiting\">left blank</span>".to_owned() };
    match &answer.value {
        Err(_) => format!("{}<p class=\"waiting\">cannot be read</p>", typed(&answer.text)),
        Ok(AnswerValue::Prose(markdown)) => prose::to_html_marked(markdown, marks),
        Ok(value) => value_html(value, prompt),
    }
}

fn value_html(value: &AnswerValue, prompt: &str) -> String {
    match value {
        AnswerValue::TransferFunction { transfer_function, formula } => {
            let numbers = math::transfer_function(transfer_function);
            match formula {
                None => numbers,
                Some(formula) => {
                    let as_typed = math::formula(formula);
                    if visible(&as_typed) == visible(&numbers) {
                        numbers
                    } else {
                        format!("{as_typed}<p class=\"muted\">read as</p>{numbers}")
                    }
                }
            }
        }
        AnswerValue::Poles(poles) => text(&pole_list(poles)),
        AnswerValue::Value(value) => text(&final_value(value)),
        AnswerValue::Stability(stability) => text(stability.words()),
        AnswerValue::Shape(shape) => text(shape_name(*shape)),
        AnswerValue::Nonlinearity(kind) => text(nonlinearity_name(*kind)),
        AnswerValue::Formula(formula) => math::block(&formula.to_mathml()),
        AnswerValue::Prose(markdown) => prose::to_html(markdown),
        AnswerValue::Figure(figure) => picture(figure, prompt),
        AnswerValue::Data(series) => text(&data_words(series)),
    }
}

/// What would have been right, for each field of a question, from the criteria that judge it; empty where there is nothing to show.
pub fn reference(reference: &Reference, criteria: &[Criterion], path: &str) -> String {
    let mut parts: Vec<String> = Vec::new();
    let judges = |c: &&Criterion| {
        c.field == path || matches!(&c.check, Check::Plot { data: Some(data), .. } if data == path)
    };
    for criterion in criteria.iter().filter(judges) {
        let part = expected(reference, &criterion.check);
        if !part.is_empty() && !parts.contains(&part) {
            parts.push(part);
        }
    }
    parts.concat()
}

/// The right transfer function in letters, to stand before the one in numbers; empty where it has none.
pub fn letters(reference: &Reference, criteria: &[Criterion], path: &str) -> String {
    let judging = criteria.iter().filter(|criterion| criterion.field == path);
    let of = judging.filter_map(|criterion| match &criterion.check {
        Check::Structure { of } | Check::Numerator { of, .. } | Check::Denominator { of, .. } => Some(of),
        _ => None,
    });
    let derivation = of.into_iter().find_map(|of| find(reference, of)?.letters.as_ref().ok());
    match derivation.filter(|derivation| derivation.has_letters()) {
        Some(derivation) => {
            format!("{}<p class=\"muted\">in numbers</p>", math::formula(&derivation.transfer_function()))
        }
        None => String::new(),
    }
}

/// Whether what was typed is a formula with letters in it, other than the variable.
pub fn has_letters(answer: Option<&Answer>) -> bool {
    match answer.map(|answer| &answer.value) {
        Some(Ok(AnswerValue::TransferFunction { formula: Some(formula), .. })) => {
            formula.symbols().iter().any(|symbol| !symbol.name.eq_ignore_ascii_case("s"))
        }
        _ => false,
    }
}

fn expected(reference: &Reference, check: &Check) -> String {
    let point = |of: &SystemRef| find(reference, of);
    let main = |of: &SystemRef| point(of).map(OperatingPointReference::main);
    let html = match check {
        Check::Structure { of } | Check::Numerator { of, .. } | Check::Denominator { of, .. } => {
            main(of).map(|m| math::transfer_function(&m.linearization.transfer_function))
        }
        Check::Poles { of, .. } => main(of).map(|m| text(&root_words(&m.poles, 6))),
        Check::Stability { of } => main(of).map(|m| text(m.stability.words())),
        Check::Feature { of, response, feature, .. } => point(of).and_then(|p| {
            let features = &p.main().response(*response)?.features;
            Some(text(&feature_value(features, feature.kind, &p.output_unit)))
        }),
        Check::Rest { of, asked, .. } => main(of).and_then(|m| {
            let value = to_f64(m.values.get(&asked.signal)?) * to_f64(&asked.ratio().value().0);
            Some(text(&quantity(value, 5, asked.unit.as_ref().map_or("", Unit::symbol))))
        }),
        Check::Shape { of, response } => {
            main(of).and_then(|m| m.response(*response)).map(|known| text(known.features.shape.words()))
        }
        Check::Plot { .. } => Some(text("the reference curve below")),
        Check::Concepts { concepts, needed, .. } => {
            let list: String = concepts.iter().map(|c| format!("<li>{}</li>", text(&c.title))).collect();
            let lead = if concepts.len() > 1 && *needed < concepts.len() {
                format!("<p>{needed} of:</p>")
            } else {
                String::new()
            };
            Some(format!("{lead}<ul>{list}</ul>"))
        }
        Check::Tangent { of, form, .. } => point(of).and_then(|p| tangent::line_html(p, *form)),
        Check::Nonlinearity { expected } => Some(text(nonlinearity_name(*expected))),
    };
    html.unwrap_or_default()
}

/// Where a system's reference is.
pub fn find<'a>(reference: &'a Reference, of: &SystemRef) -> Option<&'a OperatingPointReference> {
    let model = reference.models.iter().find(|m| m.id == of.model)?;
    model.operating_points.iter().find(|p| p.id == of.operating_point)
}

/// What a heading over the right answer says: prose is not compared word for word.
pub fn reference_heading(kind: FieldKind) -> &'static str {
    match kind {
        FieldKind::Prose => "What is looked for",
        _ => "Reference",
    }
}

/// Whether the field fits in a row of a table.
pub fn is_short(kind: FieldKind, answered: bool) -> bool {
    match kind {
        FieldKind::TransferFunction | FieldKind::Formula | FieldKind::Prose => false,
        FieldKind::Figure => !answered,
        _ => true,
    }
}

fn feature_value(features: &Features, kind: FeatureKind, unit: &str) -> String {
    let optional = |value: Option<f64>, unit: &str| value.map_or("none".to_owned(), |v| quantity(v, 5, unit));
    match kind {
        FeatureKind::InitialValue => quantity(features.initial_value, 5, unit),
        FeatureKind::FinalValue => limit_value(features, unit),
        FeatureKind::Peak => optional(features.peak.map(|p| p.value), unit),
        FeatureKind::PeakTimeS => optional(features.peak.map(|p| p.time_s), "s"),
        FeatureKind::PeriodS => optional(features.period_s, "s"),
        FeatureKind::DampingRatio => optional(features.damping_ratio, ""),
        FeatureKind::NaturalFrequencyRadS => optional(features.natural_frequency_rad_s, "rad/s"),
        FeatureKind::DampedFrequencyRadS => optional(features.damped_frequency_rad_s(), "rad/s"),
        FeatureKind::SettlingTime2PercentS => optional(features.settling_time_2_percent_s, "s"),
        FeatureKind::SettlingTime5PercentS => optional(features.settling_time_5_percent_s, "s"),
        FeatureKind::OvershootPercent => optional(features.overshoot_percent, "%"),
        FeatureKind::RiseTime1090S => optional(features.rise_time_10_90_s, "s"),
        FeatureKind::RiseTime0100S => optional(features.rise_time_0_100_s, "s"),
        FeatureKind::DcGain => optional(features.dc_gain, ""),
    }
}

fn limit_value(features: &Features, unit: &str) -> String {
    let words = limit_words(features.final_value, unit);
    words.strip_prefix("to ").map_or_else(|| words.replace("without a limit: ", "none: "), str::to_owned)
}

fn pole_list(poles: &[TypedComplex]) -> String {
    let mut words: Vec<String> = Vec::new();
    let mut rest = poles;
    while let Some((first, others)) = rest.split_first() {
        let conjugate = others.first().is_some_and(|next| {
            let im = to_f64(&first.im.value);
            im != 0.0 && next.re.value == first.re.value && to_f64(&next.im.value) == -im
        });
        words.push(typed_complex(first, conjugate));
        rest = &others[usize::from(conjugate)..];
    }
    if words.is_empty() { "none".to_owned() } else { words.join(", ") }
}

fn typed_complex(pole: &TypedComplex, pair: bool) -> String {
    let im = to_f64(&pole.im.value);
    if im == 0.0 {
        return decimal(&pole.re);
    }
    let size = decimal(&pole.im);
    let size = size.trim_start_matches(['−', '+', ' ']);
    let sign = match (pair, im < 0.0) {
        (true, _) => "±",
        (false, true) => "−",
        (false, false) => "+",
    };
    format!("{} {sign} {size}j", decimal(&pole.re))
}

fn decimal(d: &Decimal) -> String {
    typographic(&sanitize(&d.text))
}

fn final_value(value: &FinalValue) -> String {
    match value {
        FinalValue::Number(d, None) => decimal(d),
        FinalValue::Number(d, Some(unit)) => format!("{} {}", decimal(d), sanitize(unit.symbol())),
        FinalValue::Unbounded => "no limit (unbounded)".to_owned(),
        FinalValue::PlusInfinity => "+∞".to_owned(),
        FinalValue::MinusInfinity => "−∞".to_owned(),
    }
}

fn data_words(series: &Series) -> String {
    let times = || series.rows.iter().filter_map(|r| r.first().copied());
    let from = times().fold(f64::INFINITY, f64::min);
    let to = times().fold(f64::NEG_INFINITY, f64::max);
    let name = sanitize(&series.file_name);
    match series.rows.len() {
        0 => format!("{name}: no rows"),
        n => format!("{name}: {n} rows, t from {} to {}", number(from, 4), quantity(to, 4, "s")),
    }
}

fn picture(figure: &Figure, prompt: &str) -> String {
    let mut alt = String::new();
    escape(&mut alt, &format!("Picture handed in for “{prompt}”: {}", sanitize(&figure.file_name)));
    let data = base64::engine::general_purpose::STANDARD.encode(&figure.bytes);
    // The media type is one of two constants, decided by the bytes.
    format!(
        "<img alt=\"{alt}\" width=\"{}\" height=\"{}\" src=\"data:{};base64,{data}\">",
        figure.width, figure.height, figure.media_type
    )
}

/// What is left of a formula's markup without its tags and invisible operators.
fn visible(markup: &str) -> String {
    let text: String =
        markup.split('<').map(|part| part.split_once('>').map_or(part, |(_, text)| text)).collect();
    text.replace(|c| matches!(c, '\u{2061}'..='\u{2064}'), "")
}

fn typed(source: &str) -> String {
    const LONGEST: usize = 400;
    let shown: String = source.chars().take(LONGEST).collect();
    let more = if shown.len() < source.len() { " …" } else { "" };
    format!("<code>{}</code>", text(&format!("{}{more}", sanitize(&shown))))
}

fn text(plain: &str) -> String {
    let mut out = String::with_capacity(plain.len());
    escape(&mut out, plain);
    out
}
