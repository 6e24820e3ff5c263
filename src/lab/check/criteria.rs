use super::questions::{Fields, kind_name};
use super::scalars::Defaults;
use super::{Checker, Names, span};
use crate::algebra::Rational;
use crate::lab::defaults;
use crate::lab::file::{ConceptFile, CriterionFile, Entries, QuestionFile, Text};
use crate::lab::names::list;
use crate::lab::{AskedFeature, Check, Concept, Criterion, Curve, Described, FeatureKind, Points, SystemRef};
use crate::lti::InputKind;
use crate::prose::Phrase;
use crate::source::Span;
use crate::submission::{FieldKind, Unit, nonlinearity_word};

/// A check: its name, the kind of field it judges, and the keys it takes beyond `title`, `points`, `field` and `check`.
pub(in crate::lab) type CheckRow = (&'static str, FieldKind, &'static [&'static str]);

pub(in crate::lab) const CHECKS: &[CheckRow] = &[
    ("structure", FieldKind::TransferFunction, &["of"]),
    ("numerator", FieldKind::TransferFunction, &["of", "tolerance"]),
    ("denominator", FieldKind::TransferFunction, &["of", "tolerance", "one_slip"]),
    ("poles", FieldKind::Poles, &["of", "tolerance", "follow_through"]),
    ("stability", FieldKind::Stability, &["of", "follow_through"]),
    (
        "feature",
        FieldKind::Value,
        &["of", "tolerance", "response", "feature", "other_convention", "follow_through"],
    ),
    ("rest", FieldKind::Value, &["of", "tolerance", "value"]),
    ("shape", FieldKind::Shape, &["of", "response", "follow_through"]),
    (
        "plot",
        FieldKind::Figure,
        &["of", "tolerance", "response", "data", "min_points", "span_s", "follow_through"],
    ),
    (
        "concepts",
        FieldKind::Prose,
        &["concepts", "needed", "contradictions", "follow_through", "of", "describes"],
    ),
    ("nonlinearity", FieldKind::Nonlinearity, &["expected"]),
    ("tangent", FieldKind::Formula, &["of", "tolerance", "form", "other_form"]),
];

/// What a criterion is judged against.
enum Subject {
    System(SystemRef),
    Simulation(String),
}

impl Checker<'_> {
    #[allow(clippy::too_many_arguments, reason = "each is what some check needs of the file around it")]
    pub(super) fn criterion(
        &mut self,
        name: &Text,
        file: &CriterionFile,
        points: Option<Points>,
        question: &QuestionFile,
        fields: &Fields<'_>,
        names: &Names<'_>,
        given: &Defaults,
    ) -> Option<Criterion> {
        self.path(name, "criterion id");
        let known: Vec<&str> = CHECKS.iter().map(|(check, _, _)| *check).collect();
        let row = self.one_of(&file.check, "check", &known).map(|i| &CHECKS[i]);
        let field = self.field(name, file, fields);
        let (check_name, kind, takes) = *row?;
        for (key, place) in keys(file) {
            if !takes.contains(&key) {
                let message = format!("`{key}` means nothing to the check `{check_name}`");
                let help = match takes {
                    [] => "remove it".to_owned(),
                    _ => format!("it takes {}", list(takes)),
                };
                self.error("lab.criterion", place, message, Some(help));
            }
        }
        let (path, found) = field?;
        if found != kind {
            let message = format!(
                "the check `{check_name}` judges a field of kind `{}`, but `{path}` is of kind `{}`",
                kind_name(kind),
                kind_name(found)
            );
            self.error("lab.criterion", span(&file.check), message, None);
            return None;
        }
        let follow_through = match &file.follow_through {
            Some(text) => self.fraction(text, "`follow_through`"),
            None => Some(given.follow_through.credit.clone()),
        };
        let unit = fields.units.iter().find(|(of, _)| *of == path).map(|(_, unit)| *unit);
        let check = self.check(check_name, file, question, fields, unit, names, given)?;
        if !self.has_what_is_asked(&check, &file.check, names) {
            return None;
        }
        Some(Criterion {
            id: format!("{}.{}", fields.question.value, name.value),
            title: defaults::title(file.title.as_ref(), &name.value),
            points: points?,
            field: path,
            follow_through: follow_through?,
            check,
            span: span(name),
        })
    }

    /// Path and kind of the field a criterion judges.
    fn field(
        &mut self,
        name: &Text,
        file: &CriterionFile,
        fields: &Fields<'_>,
    ) -> Option<(String, FieldKind)> {
        let known: Vec<&str> = fields.entries.iter().map(|(n, _, _)| *n).collect();
        let position = match &file.field {
            Some(_) if !fields.complete => None,
            Some(field) => self.one_of(field, "field of this question", &known),
            None => match known.iter().position(|n| begins(&name.value, n)) {
                None if known.len() == 1 => Some(0),
                None if fields.complete && !known.is_empty() => {
                    let message = format!("it is not said which field the criterion `{}` judges", name.value);
                    let help = format!("add `field:` with one of {}", list(&known));
                    self.error("lab.criterion", span(name), message, Some(help));
                    None
                }
                found => found,
            },
        };
        position.map(|i| (fields.entries[i].1.clone(), fields.entries[i].2))
    }

    #[allow(clippy::too_many_arguments, reason = "each is what some check needs of the file around it")]
    fn check(
        &mut self,
        check: &str,
        file: &CriterionFile,
        question: &QuestionFile,
        fields: &Fields<'_>,
        unit: Option<&Text>,
        names: &Names<'_>,
        defaults: &Defaults,
    ) -> Option<Check> {
        let coefficients = &defaults.coefficients;
        match check {
            "structure" => Some(Check::Structure { of: self.system(file, question, names)? }),
            "numerator" => {
                let tolerance = self.tolerance_or(file.tolerance.as_ref(), coefficients.clone());
                Some(Check::Numerator { of: self.system(file, question, names)?, tolerance })
            }
            "denominator" => {
                let tolerance = self.tolerance_or(file.tolerance.as_ref(), coefficients.clone());
                let one_slip = match &file.one_slip {
                    Some(text) => self.fraction(text, "`one_slip`"),
                    None => Some(Rational::ZERO),
                };
                let of = self.system(file, question, names);
                Some(Check::Denominator { of: of?, tolerance, one_slip: one_slip? })
            }
            "poles" => {
                let tolerance = self.tolerance_or(file.tolerance.as_ref(), defaults.values.clone());
                let coefficients = coefficients.relative.clone();
                Some(Check::Poles { of: self.system(file, question, names)?, tolerance, coefficients })
            }
            "stability" => Some(Check::Stability { of: self.system(file, question, names)? }),
            "feature" => {
                let tolerance = self.tolerance_or(file.tolerance.as_ref(), defaults.values.clone());
                let of = self.system(file, question, names);
                let (response, feature) = self.feature(file, question, of.as_ref(), unit, names)?;
                Some(Check::Feature { of: of?, response, feature, tolerance })
            }
            "rest" => self.rest_check(file, question, unit, names, defaults),
            "shape" => {
                let response = self.response(file, question);
                let of = self.system(file, question, names);
                Some(Check::Shape { of: of?, response: response? })
            }
            "tangent" => self.tangent_check(file, question, names, defaults),
            "plot" => self.plot(file, question, fields, names, defaults),
            "concepts" => self.concepts(file, question, names),
            _ => {
                let text = self.required(file.expected.as_ref(), file, "expected")?;
                let expected = nonlinearity_word(&text.value);
                if expected.is_none() {
                    let message = format!("`{}` is no nonlinearity known here", text.value);
                    let help = "write `saturation`, `dead zone`, `backlash`, `relay`, …".to_owned();
                    self.error("lab.unknown_name", span(text), message, Some(help));
                }
                Some(Check::Nonlinearity { expected: expected? })
            }
        }
    }

    /// The feature asked for, in its unit and under its convention, and the response it is read off.
    fn feature(
        &mut self,
        file: &CriterionFile,
        question: &QuestionFile,
        of: Option<&SystemRef>,
        unit: Option<&Text>,
        names: &Names<'_>,
    ) -> Option<(InputKind, AskedFeature)> {
        let text = self.required(file.feature.as_ref(), file, "feature")?;
        let kinds: Vec<FeatureKind> = FeatureKind::all().collect();
        let known: Vec<&str> = kinds.iter().map(|kind| kind.as_str()).collect();
        let kind = kinds[self.one_of(text, "feature", &known)?];
        let response = match (&file.response, &question.response) {
            (None, None) if kind.is_of_steps() => Some(InputKind::Step),
            _ => self.response(file, question),
        };
        if kind.is_of_steps() && response == Some(InputKind::Impulse) {
            let message = format!("an impulse response has no `{}`", kind.as_str());
            self.error("lab.criterion", span(text), message, Some("add `response: step`".to_owned()));
        }
        let other_convention = match &file.other_convention {
            Some(given) if !kind.has_conventions() => {
                let message = format!("`other_convention` means nothing for `{}`", kind.as_str());
                self.error("lab.criterion", span(given), message, Some("remove it".to_owned()));
                None
            }
            Some(given) => self.fraction(given, "`other_convention`"),
            None => Some(Rational::ZERO),
        };
        let (output, input) = names.units_of(of?);
        let named = |text: &str| Unit::parse(text).unwrap_or_else(|| Unit::named(text));
        let output = (!output.is_empty()).then(|| named(output));
        let native = match kind {
            FeatureKind::DcGain if !input.is_empty() => {
                output.as_ref().and_then(|output| output.over(&Unit::parse(input)?))
            }
            _ => kind.unit(output.as_ref()),
        };
        let (unit, also) = match unit {
            Some(unit) => (Some(self.asked_unit(unit, kind.as_str(), native.as_ref())?), Vec::new()),
            None => {
                // A response to a unit impulse or step may be given per unit of it.
                let per = native.as_ref().filter(|_| kind.is_output() && !input.is_empty());
                let once = per.zip(Unit::parse(input)).and_then(|(native, input)| native.over(&input));
                let twice = once.as_ref().zip(Unit::parse("s")).and_then(|(once, s)| once.over(&s));
                (native.clone(), [once, twice].into_iter().flatten().collect())
            }
        };
        Some((response?, AskedFeature { kind, unit, native, also, other_convention: other_convention? }))
    }

    /// The unit a field asks for, which must measure what is asked for.
    pub(super) fn asked_unit(&mut self, text: &Text, what: &str, native: Option<&Unit>) -> Option<Unit> {
        let unit = match text.value.trim() {
            "1" => Some(Unit::one()),
            text => Unit::parse(text).or_else(|| native.filter(|native| native.symbol() == text).cloned()),
        };
        let Some(unit) = unit else {
            let message = format!("`{}` is no unit known here", text.value);
            let help = "write `rad/s`, `Hz`, `deg`, `s`, `ms`, `m`, `cm`, `V`, `%`, …".to_owned();
            self.error("lab.unknown_name", span(text), message, Some(help));
            return None;
        };
        let Some(native) = native else { return Some(unit) };
        if native.in_unit(&unit).is_none() {
            let message = format!(
                "`{what}` is {}, but it is asked for in `{}`, the unit of {}",
                native.quantity(),
                text.value.trim(),
                unit.quantity()
            );
            let symbol = if native.symbol().is_empty() { "1" } else { native.symbol() };
            self.error("lab.criterion", span(text), message, Some(format!("write `unit: {symbol}`")));
            return None;
        }
        Some(unit.understood_as(native))
    }

    fn plot(
        &mut self,
        file: &CriterionFile,
        question: &QuestionFile,
        fields: &Fields<'_>,
        names: &Names<'_>,
        defaults: &Defaults,
    ) -> Option<Check> {
        let tolerance = self.tolerance_or(file.tolerance.as_ref(), defaults.plots.clone());
        let response = self.response(file, question);
        let curve = match self.subject(file, question, names) {
            Some(Subject::System(of)) => response.map(|response| Curve::Response { of, response }),
            Some(Subject::Simulation(id)) => Some(Curve::Simulation { id }),
            None => None,
        };
        let min_points = match &file.min_points {
            Some(text) => self.whole(text, "`min_points`", 2, 100_000),
            None => Some(10),
        };
        let (data, span_s) = match &file.data {
            Some(text) => {
                let data = self.data(text, fields);
                if let Some(Curve::Simulation { id }) = &curve
                    && let Some((_, block)) = names.jumping.iter().find(|(jumping, _)| jumping == id)
                {
                    let message = format!(
                        "the output of `{id}` jumps where its `{block}` switches: data cannot be held against it"
                    );
                    let help =
                        "leave `data` out, so that a person looks at the figure, or end the chain with a lag";
                    self.error("lab.criterion", span(text), message, Some(help.to_owned()));
                }
                let span_s = self
                    .required(file.span_s.as_ref(), file, "span_s")
                    .and_then(|text| self.positive(text, "the span of the data"));
                (data.map(Some), span_s)
            }
            None => (Some(None), Some(0.0)),
        };
        Some(Check::Plot { data: data?, curve: curve?, tolerance, min_points: min_points?, span_s: span_s? })
    }

    /// The path of the field with the data.
    fn data(&mut self, text: &Text, fields: &Fields<'_>) -> Option<String> {
        if !fields.complete {
            return None;
        }
        let known: Vec<&str> = fields.entries.iter().map(|(n, _, _)| *n).collect();
        let (_, path, kind) = &fields.entries[self.one_of(text, "field of this question", &known)?];
        if *kind != FieldKind::Data {
            let message = format!("`{path}` is of kind `{}`, but data is needed", kind_name(*kind));
            self.error("lab.criterion", span(text), message, None);
            return None;
        }
        Some(path.clone())
    }

    fn concepts(
        &mut self,
        file: &CriterionFile,
        question: &QuestionFile,
        names: &Names<'_>,
    ) -> Option<Check> {
        let stated = file.concepts.as_ref();
        if stated.is_none() {
            let message = "the check `concepts` needs the key `concepts`";
            self.error("lab.missing_key", span(&file.check), message, None);
        }
        let concepts = self.concept_list(&stated?.value);
        let count = stated?.value.0.len();
        if count == 0 {
            self.error("lab.concept", span(stated?), "at least one concept is needed", None);
        }
        let needed = match &file.needed {
            Some(text) => self.whole(text, "`needed`", 1, count.max(1)),
            None => Some(count),
        };
        let contradictions = match &file.contradictions {
            Some(entries) => self.concept_list(entries),
            None => Some(Vec::new()),
        };
        let describes = match &file.describes {
            None => None,
            Some(text) => {
                let response = self.input_kind(text);
                let of = self.system(file, question, names);
                Some(Described { of: of?, response: response? })
            }
        };
        Some(Check::Concepts {
            concepts: concepts?,
            needed: needed?,
            contradictions: contradictions?,
            describes,
        })
    }

    fn concept_list(&mut self, entries: &Entries<ConceptFile>) -> Option<Vec<Concept>> {
        let concepts = entries.0.iter().map(|(id, concept)| {
            self.id(id, "concept id");
            let before = self.findings.len();
            if concept.phrases.value.is_empty() {
                let message = format!("the concept `{}` has no phrase", id.value);
                self.error("lab.concept", span(&concept.phrases), message, None);
            }
            for phrase in &concept.phrases.value {
                self.phrase(phrase);
            }
            (self.findings.len() == before).then(|| Concept {
                id: id.value.clone(),
                title: concept.title.trim().to_owned(),
                phrases: concept.phrases.value.iter().map(|p| Phrase::new(&p.value)).collect(),
            })
        });
        let concepts: Vec<_> = concepts.collect();
        concepts.into_iter().collect()
    }

    fn phrase(&mut self, phrase: &Text) {
        let words: Vec<&str> = phrase.value.split_whitespace().collect();
        let stray = words.iter().any(|word| {
            let stem = word.strip_suffix('*').unwrap_or(word);
            stem.is_empty() || stem.contains('*')
        });
        if words.is_empty() {
            self.error("lab.concept", span(phrase), "the phrase is empty", None);
        } else if stray {
            let message = format!("in the phrase `{}`, a `*` is not at the end of a word", phrase.value);
            let help = "`oscillat*` matches every word that begins so".to_owned();
            self.error("lab.concept", span(phrase), message, Some(help));
        }
    }

    fn response(&mut self, file: &CriterionFile, question: &QuestionFile) -> Option<InputKind> {
        match file.response.as_ref().or(question.response.as_ref()) {
            Some(text) => self.input_kind(text),
            None => Some(InputKind::Impulse),
        }
    }

    pub(super) fn input_kind(&mut self, text: &Text) -> Option<InputKind> {
        self.one_of(text, "response", &["impulse", "step"]).map(|i| [InputKind::Impulse, InputKind::Step][i])
    }

    pub(super) fn required<'a>(
        &mut self,
        text: Option<&'a Text>,
        file: &CriterionFile,
        key: &str,
    ) -> Option<&'a Text> {
        if text.is_none() {
            let message = format!("the check `{}` needs the key `{key}`", file.check.value);
            self.error("lab.missing_key", span(&file.check), message, None);
        }
        text
    }

    pub(super) fn system(
        &mut self,
        file: &CriterionFile,
        question: &QuestionFile,
        names: &Names<'_>,
    ) -> Option<SystemRef> {
        match self.subject(file, question, names)? {
            Subject::System(system) => Some(system),
            Subject::Simulation(id) => {
                let message = format!(
                    "the check `{}` needs an operating point, not the simulation `{id}`",
                    file.check.value
                );
                let known: Vec<&str> = names.systems.iter().map(String::as_str).collect();
                self.error(
                    "lab.criterion",
                    span(&file.check),
                    message,
                    Some(format!("add `of:` with one of {}", list(&known))),
                );
                None
            }
        }
    }

    /// What `of`, or else the question's `about`, names.
    fn subject(
        &mut self,
        file: &CriterionFile,
        question: &QuestionFile,
        names: &Names<'_>,
    ) -> Option<Subject> {
        let find = |text: &Text| match names.system(&text.value) {
            Some(system) => Some(Subject::System(system)),
            None if names.simulations.contains(&text.value.as_str()) => {
                Some(Subject::Simulation(text.value.clone()))
            }
            None => None,
        };
        match (&file.of, &question.about) {
            (Some(of), _) => {
                let found = find(of);
                if found.is_none() {
                    let known: Vec<&str> = names
                        .systems
                        .iter()
                        .map(String::as_str)
                        .chain(names.simulations.iter().copied())
                        .collect();
                    self.one_of(of, "operating point or simulation", &known);
                }
                found
            }
            // An `about` that names nothing has been reported with its question.
            (None, Some(about)) => find(about),
            (None, None) => {
                if let [only] = names.systems.as_slice() {
                    return names.system(only).map(Subject::System);
                }
                let message =
                    format!("it is not said which system the check `{}` is about", file.check.value);
                let help = "add `about:` to the question, or `of:` to the criterion".to_owned();
                self.error("lab.criterion", span(&file.check), message, Some(help));
                None
            }
        }
    }
}

/// Whether `id` is the field's name, or that name and more behind a dot: `hanging.match` judges `hanging`.
fn begins(id: &str, field: &str) -> bool {
    !field.is_empty() && id.strip_prefix(field).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
}

/// The keys that depend on the check and are given, each with a place.
fn keys(file: &CriterionFile) -> Vec<(&'static str, Span)> {
    let check = span(&file.check);
    let text = |text: &Option<Text>| text.as_ref().map(span);
    [
        ("of", text(&file.of)),
        ("form", text(&file.form)),
        ("other_form", text(&file.other_form)),
        ("response", text(&file.response)),
        ("feature", text(&file.feature)),
        ("value", text(&file.value)),
        ("tolerance", file.tolerance.as_ref().map(span)),
        ("one_slip", text(&file.one_slip)),
        ("other_convention", text(&file.other_convention)),
        ("follow_through", text(&file.follow_through)),
        ("data", text(&file.data)),
        ("min_points", text(&file.min_points)),
        ("span_s", text(&file.span_s)),
        ("concepts", file.concepts.as_ref().map(span)),
        ("needed", text(&file.needed)),
        ("contradictions", file.contradictions.as_ref().map(|_| check)),
        ("describes", text(&file.describes)),
        ("expected", text(&file.expected)),
    ]
    .into_iter()
    .filter_map(|(key, place)| place.map(|place| (key, place)))
    .collect()
}
