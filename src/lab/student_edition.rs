//! What students may be given of a lab so that `check` can read their answers: the sheet of answers, the letters and their
//! values. Nothing that tells an answer is in it, nor what one follows from: no equations, criteria, phrases, tolerances.

use super::file::{Entries, Text};
use super::template::quoted;
use super::{
    LabDefinition, LabErrors, OperatingPointDefinition, Parameter, Variant, VariantRule, VariedParameter,
    read,
};
use crate::algebra::{Expression, Rational, from_f64, parse_decimal};
use crate::lti::InputKind;
use crate::model::{
    DerivedParameter, DerivedParameters, Exact, LetterAtRest, ParameterValues, known_at_rest, letters_at_rest,
};
use crate::source::{Finding, SourceText, Span};
use crate::submission::{
    AnswerSheet, AnsweredIn, Field, FieldKind, FieldLetters, LetterName, LineNames, Unit,
};
use std::collections::{BTreeMap, BTreeSet};

/// What [`check`](crate::submission::self_check) needs of a lab, and no more.
///
/// Made from a lab, or read from the file that an instructor hands out: both give the same sheets.
#[derive(Clone, Debug, PartialEq)]
pub struct StudentEdition {
    lab: String,
    title: String,
    variants: Option<VariantRule>,
    letters: Vec<Letter>,
    fields: Vec<EditionField>,
}

/// A parameter.
#[derive(Clone, Debug, PartialEq)]
struct Letter {
    name: String,
    /// As typed: a decimal, or a formula of others.
    text: String,
    is_formula: bool,
    also: Vec<String>,
}

#[derive(Clone, Debug, PartialEq)]
struct EditionField {
    field: Field,
    answered_in: AnsweredIn,
    rest: Vec<LetterOfRest>,
    /// The letters that are of use in it.
    names: Vec<LetterName>,
    line: Option<LineNames>,
}

/// A value at rest that may stand in a formula.
#[derive(Clone, Debug, PartialEq)]
struct LetterOfRest {
    /// `h_0`
    letter: String,
    /// `h`
    of: String,
    /// A formula of parameters where the handout states it; `None` where it is to be found.
    stated: Option<String>,
}

/// Stands for what is not told: a value at which nothing vanishes or cancels by chance. No two are equal.
fn stand_in(place: usize) -> Rational {
    let place = i64::try_from(place).unwrap_or(0);
    Rational::from(1_000_003 + 7_919 * place) / Rational::from(999_983)
}

impl StudentEdition {
    /// What of a lab students may have.
    pub fn of(lab: &LabDefinition) -> Self {
        let spellings = |name: &str| {
            let own = lab.sheet.also.iter().filter(|(_, known)| *known == name);
            own.map(|(spelling, _)| spelling.clone()).collect()
        };
        let letter = |one: &Parameter| Letter {
            name: one.name.clone(),
            text: one.formula.as_ref().map_or_else(|| one.text.clone(), |(text, _)| text.clone()),
            is_formula: one.formula.is_some(),
            also: spellings(&one.name),
        };
        // The id of a simulation may say which nonlinearity is to be recognized.
        let simulations: BTreeSet<&str> =
            lab.sheet.fields.iter().filter_map(|f| f.about.as_deref()).collect();
        let simulations: BTreeMap<&str, String> = simulations
            .into_iter()
            .filter(|about| lab.simulations.iter().any(|one| one.id == *about))
            .zip(1..)
            .map(|(about, number)| (about, format!("simulation_{number:04}")))
            .collect();
        let fields = lab.sheet.fields.iter().map(|field| {
            let about = field.about.as_deref();
            let hidden = about.and_then(|about| simulations.get(about)).cloned();
            let own = lab.sheet.letters.get(&field.path);
            EditionField {
                answered_in: own.map_or(AnsweredIn::Either, |own| own.answered_in),
                rest: own.map_or_else(Vec::new, |own| letters_of_rest(lab, about, own)),
                names: own.map_or_else(Vec::new, |own| own.names.clone()),
                line: own.and_then(|own| own.line.clone()),
                field: Field { about: hidden.or_else(|| field.about.clone()), ..field.clone() },
            }
        });
        Self {
            lab: lab.id.clone(),
            title: lab.title.clone(),
            variants: lab.variants.clone().map(without_places),
            letters: lab.parameters.iter().map(letter).collect(),
            fields: fields.collect(),
        }
    }

    pub fn variants(&self) -> Option<&VariantRule> {
        self.variants.as_ref()
    }

    /// The sheet with the lab's own values.
    pub fn sheet(&self) -> AnswerSheet {
        self.sheet_with(&BTreeMap::new())
    }

    /// The sheet with the values of a variant.
    pub fn sheet_of(&self, variant: &Variant) -> AnswerSheet {
        let values = self.variants.iter().flat_map(|rule| rule.values(variant));
        self.sheet_with(&values.collect())
    }

    fn sheet_with(&self, own: &BTreeMap<&str, &str>) -> AnswerSheet {
        let values = self.values(own).unwrap_or_default();
        let value = |value: &Exact| value.as_rational().cloned().or_else(|| from_f64(value.to_f64()));
        let symbols = values.iter().filter_map(|(name, exact)| Some((name.clone(), value(exact)?)));
        let also = self.letters.iter().flat_map(|letter| {
            letter.also.iter().map(move |spelling| (spelling.clone(), letter.name.clone()))
        });
        let letters = self.fields.iter().filter_map(|one| {
            let own = one.letters(&values);
            (own != FieldLetters::default()).then(|| (one.field.path.clone(), own))
        });
        AnswerSheet {
            lab: self.lab.clone(),
            title: self.title.clone(),
            fields: self.fields.iter().map(|one| one.field.clone()).collect(),
            symbols: symbols.collect(),
            also: also.collect(),
            letters: letters.collect(),
        }
    }

    /// `None` where a formula has no value.
    fn values(&self, own: &BTreeMap<&str, &str>) -> Option<ParameterValues> {
        let (formulas, numbers): (Vec<_>, Vec<_>) = self.letters.iter().partition(|letter| letter.is_formula);
        let given = numbers.into_iter().map(|letter| {
            let text = own.get(letter.name.as_str()).copied().unwrap_or(&letter.text);
            Some((letter.name.clone(), parse_decimal(text.trim()).ok()?))
        });
        let given = given.collect::<Option<BTreeMap<_, _>>>()?;
        let derived = formulas.into_iter().map(|letter| {
            Some(DerivedParameter {
                name: letter.name.clone(),
                formula: Expression::parse(&letter.text).ok()?,
            })
        });
        DerivedParameters::new(derived.collect::<Option<_>>()?).ok()?.values(&given).ok()
    }
}

impl EditionField {
    fn letters(&self, values: &ParameterValues) -> FieldLetters {
        let mut own = FieldLetters {
            answered_in: self.answered_in,
            line: self.line.clone(),
            names: self.names.clone(),
            ..FieldLetters::default()
        };
        for (place, one) in self.rest.iter().enumerate() {
            let value = one.stated.as_deref().and_then(|text| value_of(text, values));
            let value =
                value.and_then(|value| value.as_rational().cloned().or_else(|| from_f64(value.to_f64())));
            if value.is_none() {
                own.untold.insert(one.letter.clone());
            }
            // Nobody needs a letter for what is 0.
            if value.as_ref().is_none_or(|value| *value != Rational::ZERO) {
                own.also.insert(one.of.clone(), one.letter.clone());
            }
            own.symbols.insert(one.letter.clone(), value.unwrap_or_else(|| stand_in(place)));
        }
        own
    }
}

fn value_of(text: &str, values: &ParameterValues) -> Option<Exact> {
    let lookup = |name: &str, primes: u8| values.get(name).filter(|_| primes == 0).cloned();
    Exact::evaluate(&Expression::parse(text).ok()?, &lookup).ok()
}

fn letters_of_rest(lab: &LabDefinition, system: Option<&str>, own: &FieldLetters) -> Vec<LetterOfRest> {
    let points = lab.models.iter().flat_map(|model| {
        let path = move |point: &OperatingPointDefinition| format!("{}.{}", model.id, point.id);
        model.operating_points.iter().map(move |point| (path(point), model, point))
    });
    let Some((_, model, point)) = points.into_iter().find(|(path, _, _)| Some(path.as_str()) == system)
    else {
        return Vec::new();
    };
    let at_rest = letters_at_rest(&model.model, &point.at);
    let known = known_at_rest(&model.model, &point.at);
    let letters = at_rest.into_iter().chain(known).filter(|one| own.symbols.contains_key(&one.letter));
    // What is not stated is 0, or follows from the rest.
    let stated = |one: &LetterAtRest| {
        let text = point.at_text.iter().find(|(name, _)| *name == one.name).map(|(_, text)| text.trim());
        let zero = one.value.as_rational().is_some_and(|value| *value == Rational::ZERO).then_some("0");
        text.or(zero).filter(|_| !point.solved.contains(&one.name)).map(str::to_owned)
    };
    letters.map(|one| LetterOfRest { stated: stated(&one), letter: one.letter, of: one.name }).collect()
}

/// Places in a lab file mean nothing to its students.
fn without_places(rule: VariantRule) -> VariantRule {
    let parameters = rule.parameters.into_iter();
    let parameters = parameters.map(|one| VariedParameter { span: Span::default(), ..one }).collect();
    VariantRule { parameters, ..rule }
}

/// The key that tells a student edition from a lab.
const KEY: &str = "student_edition";
const CODE: &str = "lab.student_edition";

/// Whether a file is a student edition, right or damaged, rather than a lab.
pub(super) fn is_one(text: &SourceText) -> bool {
    crate::source::parse(&text.text).is_ok_and(|tree| tree.entry(KEY).is_some())
}

/// Where a file says that it is a student edition and no lab.
pub(super) fn mark(tree: &crate::source::Node) -> Option<Finding> {
    let (key, _) = tree.entry(KEY)?;
    let message =
        "this is the student edition of a lab: no right answers are in it, and nothing they follow from";
    Some(
        Finding::error(CODE, message)
            .at(key)
            .with_help("give the lab file itself; only `polemark check` reads this one"),
    )
}

/// The file, as text.
impl StudentEdition {
    /// The name it is handed out under: `duffing.student.yaml`.
    pub fn file_name(&self) -> String {
        format!("{}.student.yaml", self.lab)
    }

    /// As [`Self::parse`] reads it.
    pub fn to_yaml(&self) -> String {
        let name = self.file_name();
        let mut text = format!(
            "# What polemark needs to read the answers of this lab; no right answers are in it.\n#   polemark check answers.yaml --lab {name}\n"
        );
        text.push_str(&format!("{KEY}: {}\ntitle: {}\n", self.lab, filled(&self.title)));
        if let Some(rule) = &self.variants {
            text.push_str(&format!("seed: {}\n", filled(&rule.seed)));
        }
        let list = |texts: &mut dyn Iterator<Item = &String>| {
            texts.map(|text| filled(text)).collect::<Vec<_>>().join(", ")
        };
        if !self.letters.is_empty() {
            text.push_str("parameters:\n");
        }
        for letter in &self.letters {
            let key = if letter.is_formula { "formula" } else { "value" };
            let mut keys = vec![format!("{key}: {}", filled(&letter.text))];
            let varied =
                self.variants.iter().flat_map(|rule| &rule.parameters).find(|one| one.name == letter.name);
            if let Some(varied) = varied {
                keys.push(format!("varies: [{}]", list(&mut varied.values.iter().map(|(text, _)| text))));
            }
            if !letter.also.is_empty() {
                keys.push(format!("also: [{}]", list(&mut letter.also.iter())));
            }
            text.push_str(&format!("  {}: {{{}}}\n", letter.name, keys.join(", ")));
        }
        text.push_str("fields:\n");
        self.fields.iter().for_each(|one| one.write(&mut text));
        text
    }

    /// Reads such a file.
    ///
    /// Errors: whatever is not as it was handed out; the remedy is always the same, to get it again.
    pub fn parse(source: SourceText) -> Result<Self, LabErrors> {
        let read = crate::source::parse(&source.text)
            .map_err(|error| Finding { span: error.span, ..broken(&error.message) })
            .and_then(|tree| {
                let options = serde_yaml::options! { with_snippet: false };
                let file: EditionFile = serde_yaml::from_str_with_options(&source.text, options)
                    .map_err(|error| read::finding(&error, &tree))?;
                file.edition()
            });
        read.map_err(|finding| LabErrors { source, findings: vec![finding] })
    }
}

/// In quotes, an empty text too.
fn filled(text: &str) -> String {
    if text.is_empty() { "\"\"".to_owned() } else { quoted(text) }
}

fn broken(message: &str) -> Finding {
    Finding::error(CODE, format!("this student edition is not as it was handed out: {message}"))
        .with_help("ask for the file again; it is not meant to be edited")
}

impl EditionField {
    fn write(&self, text: &mut String) {
        let field = &self.field;
        let mut line = |key: &str, value: &str| text.push_str(&format!("    {key}: {value}\n"));
        line("path", &field.path);
        line("kind", kind_word(field.kind));
        line("question", &field.question);
        line("prompt", &filled(&field.prompt));
        if let Some(about) = &field.about {
            line("about", &filled(about));
        }
        if let Some(response) = field.response {
            line("response", response.as_str());
        }
        if let Some(unit) = &field.unit {
            line("unit", &filled(unit.symbol()));
        }
        if !field.required {
            line("optional", "true");
        }
        match self.answered_in {
            AnsweredIn::Either => {}
            AnsweredIn::Letters => line("in", "letters"),
            AnsweredIn::Numbers => line("in", "numbers"),
        }
        if let Some(names) = &self.line {
            let at_rest = names.at_rest.join(", ");
            let names = format!("{{output: {}, input: {}, at_rest: [{at_rest}]}}", names.output, names.input);
            line("line", &names);
        }
        if !self.names.is_empty() {
            let each = self.names.iter().map(|one| {
                let spellings = std::iter::once(&one.name).chain(&one.also);
                let spellings: Vec<String> = spellings.map(|name| filled(name)).collect();
                format!("[{}]", spellings.join(", "))
            });
            line("letters", &format!("[{}]", each.collect::<Vec<_>>().join(", ")));
        }
        if !self.rest.is_empty() {
            line("rest", "");
        }
        for one in &self.rest {
            let stated = one.stated.as_ref().map(|text| format!(", value: {}", filled(text)));
            let stated = stated.unwrap_or_default();
            text.push_str(&format!("      - {{letter: {}, of: {}{stated}}}\n", one.letter, one.of));
        }
        // The first line of an entry carries its dash.
        let start = text.rfind("    path: ").unwrap_or(0);
        text.replace_range(start..start + 4, "  - ");
    }
}

const KIND_WORDS: [(FieldKind, &str); 10] = [
    (FieldKind::TransferFunction, "transfer_function"),
    (FieldKind::Poles, "poles"),
    (FieldKind::Value, "value"),
    (FieldKind::Stability, "stability"),
    (FieldKind::Shape, "shape"),
    (FieldKind::Nonlinearity, "nonlinearity"),
    (FieldKind::Formula, "formula"),
    (FieldKind::Prose, "prose"),
    (FieldKind::Figure, "figure"),
    (FieldKind::Data, "data"),
];

/// As the file has it, and serde reads it.
fn kind_word(kind: FieldKind) -> &'static str {
    KIND_WORDS.iter().find(|(known, _)| *known == kind).map_or("prose", |(_, word)| word)
}

#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct EditionFile {
    student_edition: String,
    title: String,
    seed: Option<String>,
    #[serde(default)]
    parameters: Entries<LetterFile>,
    fields: Vec<EditionFieldFile>,
}

#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct LetterFile {
    value: Option<Text>,
    formula: Option<Text>,
    #[serde(default)]
    varies: Vec<Text>,
    #[serde(default)]
    also: Vec<String>,
}

#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct EditionFieldFile {
    path: String,
    kind: FieldKind,
    question: String,
    prompt: String,
    about: Option<String>,
    response: Option<ResponseFile>,
    unit: Option<String>,
    #[serde(default)]
    optional: bool,
    #[serde(rename = "in")]
    answered_in: Option<AnsweredInFile>,
    line: Option<LineFile>,
    /// Each letter, then its other spellings.
    #[serde(default)]
    letters: Vec<Vec<String>>,
    #[serde(default)]
    rest: Vec<LetterOfRestFile>,
}

#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct LineFile {
    output: String,
    input: String,
    at_rest: Vec<String>,
}

#[derive(serde::Deserialize)]
#[serde(rename_all = "snake_case")]
enum ResponseFile {
    Impulse,
    Step,
}

#[derive(serde::Deserialize)]
#[serde(rename_all = "snake_case")]
enum AnsweredInFile {
    Letters,
    Numbers,
}

#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct LetterOfRestFile {
    letter: String,
    of: String,
    value: Option<String>,
}

impl EditionFile {
    fn edition(self) -> Result<StudentEdition, Finding> {
        let mut varied = Vec::new();
        let mut letters = Vec::new();
        for (name, one) in self.parameters.0 {
            let (text, is_formula) = match (one.value, one.formula) {
                (Some(value), None) => (value.value, false),
                (None, Some(formula)) => (formula.value, true),
                _ => return Err(broken("a parameter has a value, or a formula").at(read::span(name.defined))),
            };
            let values = one.varies.into_iter().map(|text| {
                let value = parse_decimal(text.value.trim());
                value.map(|value| (text.value, value)).map_err(|error| broken(&error.to_string()))
            });
            let values: Vec<_> = values.collect::<Result<_, _>>()?;
            if !values.is_empty() {
                varied.push(VariedParameter { name: name.value.clone(), values, span: Span::default() });
            }
            letters.push(Letter { name: name.value, text, is_formula, also: one.also });
        }
        let variants = self.seed.map(|seed| VariantRule { seed, parameters: varied });
        let fields = self.fields.into_iter().map(EditionFieldFile::field).collect();
        let edition =
            StudentEdition { lab: self.student_edition, title: self.title, variants, letters, fields };
        match edition.values(&BTreeMap::new()) {
            Some(_) => Ok(edition),
            None => Err(broken("a parameter has no value")),
        }
    }
}

impl EditionFieldFile {
    fn field(self) -> EditionField {
        let unit = |symbol: String| match symbol.as_str() {
            "" => Unit::one(),
            symbol => Unit::parse(symbol).unwrap_or_else(|| Unit::named(symbol)),
        };
        EditionField {
            field: Field {
                path: self.path,
                kind: self.kind,
                question: self.question,
                prompt: self.prompt,
                about: self.about,
                response: self.response.map(|response| match response {
                    ResponseFile::Impulse => InputKind::Impulse,
                    ResponseFile::Step => InputKind::Step,
                }),
                unit: self.unit.map(unit),
                required: !self.optional,
            },
            answered_in: match self.answered_in {
                None => AnsweredIn::Either,
                Some(AnsweredInFile::Letters) => AnsweredIn::Letters,
                Some(AnsweredInFile::Numbers) => AnsweredIn::Numbers,
            },
            names: self
                .letters
                .into_iter()
                .filter_map(|spellings| {
                    let mut spellings = spellings.into_iter();
                    Some(LetterName { name: spellings.next()?, also: spellings.collect() })
                })
                .collect(),
            line: self.line.map(|LineFile { output, input, at_rest }| LineNames { output, input, at_rest }),
            rest: self
                .rest
                .into_iter()
                .map(|one| LetterOfRest { letter: one.letter, of: one.of, stated: one.value })
                .collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::embedded;

    fn lab(text: &str) -> LabDefinition {
        LabDefinition::parse(SourceText::new("lab.yaml", text)).unwrap()
    }

    const OTHERS: [&str; 7] = [
        include_str!("../../tests/it/held_ball.yaml"),
        include_str!("../../tests/it/letters.yaml"),
        include_str!("../../tests/it/linear.yaml"),
        include_str!("../../tests/it/rest.yaml"),
        include_str!("../../tests/it/small.yaml"),
        include_str!("../../tests/it/tangent.yaml"),
        include_str!("../../tests/it/variants.yaml"),
    ];

    fn labs() -> impl Iterator<Item = LabDefinition> {
        embedded().iter().map(|(_, text)| *text).chain(OTHERS).map(lab)
    }

    #[test]
    fn every_lab_comes_back_as_it_was_handed_out() {
        for lab in labs() {
            let edition = StudentEdition::of(&lab);
            let text = edition.to_yaml();
            let back = StudentEdition::parse(SourceText::new("x.student.yaml", text.clone()));
            assert_eq!(back.unwrap_or_else(|e| panic!("{}: {e}\n{text}", lab.id)), edition, "{}", lab.id);
            assert_eq!(edition.to_yaml(), text);
        }
    }

    /// Where nothing is hidden, the sheet is the lab's own; also with a variant's values.
    #[test]
    fn the_sheet_is_that_of_the_lab() {
        for lab in labs() {
            let mut own = vec![(StudentEdition::of(&lab).sheet(), lab.sheet.clone())];
            for variant in lab.variants.iter().flat_map(VariantRule::all) {
                let sheet = lab.with_variant(&variant).unwrap().sheet;
                own.push((StudentEdition::of(&lab).sheet_of(&variant), sheet));
            }
            for (mut sheet, mut whole) in own {
                for (path, letters) in &mut sheet.letters {
                    let hidden = std::mem::take(&mut letters.untold);
                    for one in [letters, whole.letters.get_mut(path).unwrap()] {
                        one.symbols.retain(|letter, _| !hidden.contains(letter));
                        one.also.retain(|_, letter| !hidden.contains(letter));
                    }
                }
                for (hidden, told) in sheet.fields.iter_mut().zip(&mut whole.fields) {
                    if hidden.about.as_deref().is_some_and(|about| about.starts_with("simulation_")) {
                        hidden.about.clone_from(&told.about);
                    }
                }
                assert_eq!(sheet, whole, "{}", lab.id);
            }
        }
    }

    #[test]
    fn what_is_to_be_found_is_not_told() {
        let lab = lab(OTHERS[0]);
        let text = StudentEdition::of(&lab).to_yaml();
        let solved = lab.models.iter().flat_map(|model| &model.operating_points).flat_map(|point| {
            point.at_text.iter().filter(|(name, _)| point.solved.contains(name)).map(|(_, value)| value)
        });
        let solved: Vec<&String> = solved.filter(|value| *value != "0").collect();
        assert!(!solved.is_empty());
        for value in solved {
            assert!(!text.contains(value.as_str()), "{value}: {text}");
        }
    }

    #[test]
    fn nothing_of_the_answers_is_in_it() {
        for (id, text) in embedded() {
            let yaml = StudentEdition::of(&lab(text)).to_yaml();
            for word in [
                "model_answer",
                "expect",
                "mistake",
                "accepted",
                "phrases",
                "criteria",
                "equations",
                "tolerance",
            ] {
                assert!(!yaml.contains(&format!("{word}:")), "{id}: {word}");
            }
        }
    }

    #[test]
    fn a_damaged_file_says_so() {
        for (text, message) in [
            ("student_edition: x\ntitle: y\n", "the key `fields` is missing here"),
            ("student_edition: x\ntitle: y\nfields: []\nquestions: {}\n", "there is no key `questions` here"),
            (
                "student_edition: x\ntitle: y\nparameters:\n  m: {}\nfields: []\n",
                "this student edition is not as it was handed out: a parameter has a value, or a formula",
            ),
            (
                "student_edition: x\ntitle: y\nparameters:\n  m: {value: q}\nfields: []\n",
                "a parameter has no value",
            ),
        ] {
            let error = StudentEdition::parse(SourceText::new("x", text)).unwrap_err().to_string();
            assert!(error.contains(message), "{text}: {error}");
        }
    }

    #[test]
    fn it_is_no_lab() {
        let text = StudentEdition::of(&lab(OTHERS[0])).to_yaml();
        let error = LabDefinition::parse(SourceText::new("x.student.yaml", text)).unwrap_err().to_string();
        assert!(error.contains("this is the student edition of a lab"), "{error}");
    }
}
