use super::defaults;
use super::file::{Entries, LabFile, ModelFile, OperatingPointFile, QuantityFile, Spanned, Text};
use super::read::span;
use crate::source::Finding;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserialize, Deserializer, Error, MapAccess, Visitor};
use serde_yaml::Location;
use std::borrow::Cow;
use std::fmt;

/// A linear model. Entries are numbers, or formulas of parameters.
#[derive(Debug, schemars::JsonSchema, serde::Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub(super) enum LinearFile {
    /// A formula in s (`K/(s*(T*s + 1))`), or `{num, den}`.
    TransferFunction(Spanned<TransferFunctionFile>),
    /// Zeros, poles and gain.
    Zpk(ZerosPolesGainFile),
    /// x' = A x + B u, y = C x + D u.
    StateSpace(StateSpaceFile),
}

/// A transfer function; common factors are not cancelled.
#[derive(Debug)]
pub(super) enum TransferFunctionFile {
    Formula(String),
    Quotient(QuotientFile),
}

/// Coefficients, highest power of s first.
#[derive(Debug, schemars::JsonSchema, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct QuotientFile {
    /// Numerator.
    pub num: Spanned<Vec<Text>>,
    /// Denominator.
    pub den: Spanned<Vec<Text>>,
}

/// gain · Π (s − zero) / Π (s − pole)
#[derive(Debug, schemars::JsonSchema, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ZerosPolesGainFile {
    /// `-3`, or two at once: `-1 ± 2j`, `-1 ± sqrt(2)`. Default: none.
    #[serde(default)]
    pub zeros: Vec<Text>,
    /// Likewise; a multiple pole is repeated.
    #[serde(default)]
    pub poles: Vec<Text>,
    /// The factor in front. Default 1.
    pub gain: Option<Text>,
}

/// A state-space model; rows of rows.
#[derive(Debug, schemars::JsonSchema, serde::Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case, reason = "the keys are the field's own")]
pub(super) struct StateSpaceFile {
    /// n×n.
    pub A: Spanned<Vec<Vec<Text>>>,
    /// n×inputs.
    pub B: Spanned<Vec<Vec<Text>>>,
    /// outputs×n.
    pub C: Spanned<Vec<Vec<Text>>>,
    /// outputs×inputs. Default 0.
    pub D: Option<Spanned<Vec<Vec<Text>>>>,
    /// Names of the states, in order, with unit and description. Default `x1`, `x2`, …
    #[serde(default)]
    pub states: Entries<QuantityFile>,
}

/// One input and one output of a linear model.
#[derive(Debug, schemars::JsonSchema, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ChannelFile {
    /// Title, one line. Default: the id in words.
    pub title: Option<String>,
    /// The input that is varied.
    pub input: Text,
    /// The output that is watched.
    pub output: Text,
}

impl JsonSchema for TransferFunctionFile {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "TransferFunctionFile".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        json_schema!({ "anyOf": [{ "type": "string" }, generator.subschema_for::<QuotientFile>()] })
    }
}

impl<'de> Deserialize<'de> for TransferFunctionFile {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Either;

        impl<'de> Visitor<'de> for Either {
            type Value = TransferFunctionFile;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a formula in s, or `{num: [...], den: [...]}`")
            }

            fn visit_str<E: Error>(self, text: &str) -> Result<Self::Value, E> {
                Ok(TransferFunctionFile::Formula(text.to_owned()))
            }

            fn visit_i64<E: Error>(self, gain: i64) -> Result<Self::Value, E> {
                Ok(TransferFunctionFile::Formula(gain.to_string()))
            }

            fn visit_u64<E: Error>(self, gain: u64) -> Result<Self::Value, E> {
                Ok(TransferFunctionFile::Formula(gain.to_string()))
            }

            fn visit_f64<E: Error>(self, gain: f64) -> Result<Self::Value, E> {
                Ok(TransferFunctionFile::Formula(gain.to_string()))
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Self::Value, A::Error> {
                QuotientFile::deserialize(MapAccessDeserializer::new(map)).map(TransferFunctionFile::Quotient)
            }
        }

        deserializer.deserialize_any(Either)
    }
}

/// Gives every linear model the coordinates and operating points that follow from it, so that it is a model like others.
///
/// Errors: a key that a model needs, or that a linear one does not take.
pub(super) fn spell_out(file: &mut LabFile) -> Result<(), Finding> {
    let parameters: Vec<String> = file.parameters.0.iter().map(|(name, _)| name.value.clone()).collect();
    for (id, model) in &mut file.models.0 {
        let keys = [
            ("coordinates", model.coordinates.defined),
            ("inputs", model.inputs.defined),
            ("equations", model.equations.defined),
            ("operating_points", model.operating_points.defined),
            ("channels", model.channels.defined),
        ];
        // A static function may be nothing but its outputs.
        let only_outputs = model.linear.is_none() && !model.outputs.0.is_empty();
        for (key, place) in keys {
            if only_outputs && matches!(key, "coordinates" | "equations") {
                continue;
            }
            let is_given = place != Location::UNKNOWN;
            match (&model.linear, key) {
                (None, "channels") if is_given => {
                    let message = "`channels` belongs to a model given by `linear`";
                    return Err(Finding::error("lab.shape", message).at(span(place)).with_help("remove it"));
                }
                (None, "channels") | (Some(_), "inputs" | "channels") => {}
                (None, _) if is_given => {}
                (None, _) => return Err(missing(key, id.defined)),
                (Some(_), _) if is_given => {
                    let message = format!("`{key}` cannot stand beside `linear`");
                    return Err(Finding::error("lab.shape", message)
                        .at(span(place))
                        .with_help("remove one of them"));
                }
                (Some(_), _) => {}
            }
        }
        for (name, output) in &model.outputs.0 {
            match (&model.linear, &output.formula) {
                (None, None) => return Err(missing("formula", name.defined)),
                (Some(_), Some(formula)) => {
                    let message = "an output of a linear model has no formula: it follows from `linear`";
                    let place = span(formula.defined);
                    return Err(Finding::error("lab.shape", message).at(place).with_help("remove it"));
                }
                _ => {}
            }
        }
        fill_in(model, &parameters, defaults::title(model.title.as_ref(), &id.value));
    }
    Ok(())
}

fn missing(key: &str, place: Location) -> Finding {
    Finding::error("lab.missing_key", format!("the key `{key}` is missing here")).at(span(place))
}

fn fill_in(model: &mut ModelFile, parameters: &[String], title: String) {
    let Some(linear) = &mut model.linear else { return };
    let place = linear.defined;
    let text = |value: &str| Spanned { value: value.to_owned(), defined: place };
    let named = |letter: &str, count: usize| match count {
        1 => vec![(text(letter), QuantityFile::default())],
        _ => numbered(letter, count, place),
    };
    let (mut coordinates, inputs, outputs) = match &mut linear.value {
        LinearFile::StateSpace(file) => {
            let width = |rows: &[Vec<Text>]| rows.first().map_or(1, Vec::len);
            let given = std::mem::take(&mut file.states.0);
            let states = if given.is_empty() { numbered("x", file.A.value.len(), place) } else { given };
            (states, width(&file.B.value), file.C.value.len())
        }
        _ => (Vec::new(), 1, 1),
    };
    if model.inputs.value.0.is_empty() {
        model.inputs = Spanned { value: Entries(named("u", inputs)), defined: place };
    }
    let mut seen: Vec<(Text, QuantityFile)> = std::mem::take(&mut model.outputs.0)
        .into_iter()
        .map(|(name, output)| (name, QuantityFile { unit: output.unit, description: output.description }))
        .collect();
    if seen.is_empty() {
        seen = named("y", outputs);
    }
    let names = |entries: &[(Text, QuantityFile)]| -> Vec<String> {
        entries.iter().map(|(name, _)| name.value.clone()).collect()
    };
    let channels = std::mem::take(&mut model.channels.value.0);
    let (ins, outs) = (names(&model.inputs.value.0), names(&seen));
    let points = match (channels.is_empty(), ins.as_slice(), outs.as_slice()) {
        (true, [input], [output]) => vec![(text("linear"), point(Some(title), text(input), text(output)))],
        _ => channels.into_iter().map(|(id, c)| (id, point(c.title, c.input, c.output))).collect(),
    };
    if !matches!(linear.value, LinearFile::StateSpace(_)) {
        let taken = [ins, outs, parameters.to_vec()].concat();
        let mut candidates = std::iter::once("z".to_owned()).chain((1..).map(|n: usize| format!("z{n}")));
        let inner = candidates.find(|name| !taken.contains(name)).unwrap_or_default();
        coordinates.push((text(&inner), QuantityFile::default()));
    }
    coordinates.extend(seen);
    model.coordinates = Spanned { value: Entries(coordinates), defined: place };
    model.operating_points = Spanned { value: Entries(points), defined: place };
}

/// `x1`, `x2`, …
fn numbered(letter: &str, count: usize, place: Location) -> Vec<(Text, QuantityFile)> {
    let name = |i: usize| Spanned { value: format!("{letter}{i}"), defined: place };
    (1..=count).map(|i| (name(i), QuantityFile::default())).collect()
}

fn point(title: Option<String>, input: Text, output: Text) -> OperatingPointFile {
    OperatingPointFile { title, at: Entries::default(), input, output, comparison: None, tangent: None }
}
