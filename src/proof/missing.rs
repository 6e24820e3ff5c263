//! What a lab has not got yet: nothing that fails, but without some of it nothing is proven.

use super::blind_tolerance::blind_tolerances;
use super::mistakes::undeclared;
use crate::algebra::{Expression, significant, to_f64};
use crate::lab::{Check, Concept, ExpectedValue, LabDefinition, LineForm, Question, SystemRef};
use crate::reference::{OperatingPointReference, Reference, values_at};
use crate::submission::{AnsweredIn, Field, FieldKind, Unit, nonlinearity_name};
use std::collections::BTreeSet;

/// Fewer phrases than this are rarely all that students say of a thing.
const FEW_PHRASES: usize = 3;

/// Figures of a value to be pasted into a model answer.
const FIGURES: usize = 6;

/// Something to be done about a lab.
#[derive(Clone, Debug, PartialEq)]
pub struct Missing {
    pub what: String,
    /// Why it matters, and what to do.
    pub found: String,
    /// Whether the lab is not proven without it.
    pub keeps_from_proof: bool,
}

/// What `lab` has not got yet, the things without which it is not proven first.
pub fn missing(lab: &LabDefinition, reference: &Reference) -> Vec<Missing> {
    let mut all = Vec::new();
    let mut say = |what: &str, found: String, keeps_from_proof| {
        all.push(Missing { what: what.to_owned(), found, keeps_from_proof });
    };
    if let Some(names) = listed(unexpected(lab).iter().map(ToString::to_string)) {
        let found = format!(
            "nothing is stated under `expect` of {names}: a mistyped equation or parameter would not be noticed. State values found \
             by another route, by hand or with another program"
        );
        say("expectations", found, true);
    }
    if let Some(names) = listed(unanswered(lab).map(|field| field.path.clone())) {
        let found = format!("none for {names}: write `model_answer` under the question, as a student would");
        say("model answers", found, true);
    }
    if let Some(changes) = listed(undeclared(lab, reference).into_iter()) {
        let found = format!(
            "no answer shows {changes}: is the equation right? Declare what is meant to be so under `mistakes: {{without_effect: […]}}`"
        );
        say("mistakes without effect", found, true);
    }
    if let Some(names) = listed(blind_tolerances(lab, reference).into_iter()) {
        let found = format!(
            "0 would be right at {names}: give the criterion a `tolerance` of its own, or the lab a smaller `absolute` under \
             `tolerances: {{values: …}}`"
        );
        say("tolerances", found, true);
    }
    for (system, words) in in_doubt(lab, reference) {
        let found = format!(
            "the coefficients of `{system}` are rounded, and {words} cannot be told from them: such answers go to a person. Choose \
             other values, or some from which the point of rest is a rational number"
        );
        say("inconclusive", found, true);
    }
    let asked: Vec<&str> = lab.sheet.fields.iter().filter_map(|field| field.about.as_deref()).collect();
    let points = lab.models.iter().flat_map(|model| {
        model.operating_points.iter().map(move |point| format!("{}.{}", model.id, point.id))
    });
    if let Some(names) = listed(points.filter(|path| !asked.contains(&path.as_str()))) {
        say("systems", format!("nothing is asked about {names}"), false);
    }
    let assessed = |id: &str| {
        let mut of_questions = lab.questions.iter().flat_map(|question| &question.outcomes);
        let mut of_rows = lab.observed.iter().flat_map(|row| &row.outcomes);
        of_questions.any(|outcome| outcome == id) || of_rows.any(|outcome| outcome == id)
    };
    if let Some(names) = listed(lab.outcomes.iter().map(|o| o.id.clone()).filter(|id| !assessed(id))) {
        say("outcomes", format!("no question assesses {names}: list it under `outcomes` of one"), false);
    }
    if let Some(names) = listed(unused(lab).into_iter()) {
        say("parameters", format!("nothing uses {names}: is it missing in an equation?"), false);
    }
    for (whose, word) in unknown_units(lab) {
        let near = match Unit::nearest(&word) {
            Some(near) => format!("did you mean `{near}`?"),
            None => "nothing is known of it but its name".to_owned(),
        };
        say("units", format!("`{word}`, in the unit of {whose}, is none that polemark knows; {near}"), false);
    }
    let few = concepts(lab).filter(|(_, concept)| concept.phrases.len() < FEW_PHRASES);
    if let Some(names) = listed(few.map(|(criterion, concept)| format!("{criterion}: {}", concept.id))) {
        let found = format!(
            "fewer than {FEW_PHRASES} phrases for {names}. Students say a thing in many ways; what is not found is read by a person"
        );
        say("phrases", found, false);
    }
    all
}

/// The values that [`missing`] asks for, and the mistakes to declare, as lines of a lab file. `None` when nothing is asked for that can be computed.
///
/// They are polemark's own, so that they prove nothing until somebody has found them by another route.
pub fn to_paste(lab: &LabDefinition, reference: &Reference) -> Option<String> {
    let mut text = String::new();
    let unanswered: Vec<&Field> = unanswered(lab).collect();
    for question in &lab.questions {
        let fields: Vec<&Field> =
            unanswered.iter().filter(|field| field.question == question.id).copied().collect();
        text.push_str(&model_answer(question, &fields, reference));
    }
    if !text.is_empty() {
        text.insert_str(0, "questions:\n");
    }
    let stated: String = unexpected(lab)
        .iter()
        .flat_map(|of| {
            ["transfer_function.num", "transfer_function.den", "poles"].map(|what| format!("{of}.{what}"))
        })
        .filter_map(|path| {
            let known = values_at(reference, &path).filter(|known| !known.is_empty())?;
            Some(format!("  {path}: {{values: [{}]}}\n", values(&known)))
        })
        .collect();
    if !stated.is_empty() {
        text.push_str("expect:\n");
        text.push_str(&stated);
    }
    let without_effect = undeclared(lab, reference);
    if !without_effect.is_empty() {
        text.push_str("mistakes:\n  without_effect:\n");
        without_effect.iter().for_each(|change| text.push_str(&format!("    - \"{change}\"\n")));
    }
    (!text.is_empty()).then_some(text)
}

/// Systems that are asked about whose verdicts rounding leaves open: which they are, in words.
fn in_doubt(lab: &LabDefinition, reference: &Reference) -> Vec<(SystemRef, String)> {
    let mut found: Vec<(SystemRef, String)> = Vec::new();
    for of in lab.questions.iter().flat_map(|question| &question.criteria).filter_map(|c| c.check.system()) {
        let doubts = reference.operating_point(of).map(|point| point.main().doubts);
        if let Some(doubts) = doubts.filter(|doubts| doubts.any())
            && !found.iter().any(|(known, _)| known == of)
        {
            found.push((of.clone(), doubts.words()));
        }
    }
    found
}

/// Parameters in no equation, rest, simulation, or formula of a parameter that is used.
fn unused(lab: &LabDefinition) -> Vec<String> {
    let letters = |formula: &Expression| formula.symbols().into_iter().map(|symbol| symbol.name);
    let mut used: BTreeSet<String> = lab.simulations.iter().flat_map(|one| one.letters.clone()).collect();
    for model in &lab.models {
        let sides = model.model.equations.iter().flat_map(|equation| [&equation.left, &equation.right]);
        used.extend(sides.flat_map(letters));
        let texts = model.operating_points.iter().flat_map(|point| &point.at_text);
        used.extend(
            texts
                .filter_map(|(_, text)| Expression::parse(text).ok())
                .flat_map(|rest| letters(&rest).collect::<Vec<_>>()),
        );
    }
    for _ in 0..lab.parameters.len() {
        let derived = lab.parameters.iter().filter(|one| used.contains(&one.name));
        let more: Vec<String> = derived
            .filter_map(|one| one.formula.as_ref())
            .flat_map(|(_, formula)| letters(formula))
            .collect();
        used.extend(more);
    }
    lab.parameters.iter().map(|one| one.name.clone()).filter(|name| !used.contains(name)).collect()
}

/// (whose it is, word) of words in units that are no units.
fn unknown_units(lab: &LabDefinition) -> Vec<(String, String)> {
    let parameters = lab.parameters.iter().map(|one| (&one.name, &one.unit));
    let coordinates =
        lab.models.iter().flat_map(|model| &model.model.coordinates).map(|one| (&one.name, &one.unit));
    let inputs = lab
        .models
        .iter()
        .flat_map(|model| &model.operating_points)
        .map(|point| (&point.input, &point.input_unit));
    let signals = lab
        .simulations
        .iter()
        .flat_map(|one| [(&one.input, &one.input_unit), (&one.output, &one.output_unit)]);
    let mut seen = BTreeSet::new();
    parameters
        .chain(coordinates)
        .chain(inputs)
        .chain(signals)
        .filter_map(|(name, unit)| Some((format!("`{name}`"), Unit::unknown_word(unit)?.to_owned())))
        .filter(|(_, word)| seen.insert(word.clone()))
        .collect()
}

/// Systems that are asked about and of which nothing is stated.
fn unexpected(lab: &LabDefinition) -> Vec<SystemRef> {
    let mut systems: Vec<SystemRef> = Vec::new();
    for criterion in lab.questions.iter().flat_map(|question| &question.criteria) {
        if let Some(of) = criterion.check.system()
            && !systems.contains(of)
            && !lab.expectations.iter().any(|stated| stated.path.starts_with(&format!("{of}.")))
        {
            systems.push(of.clone());
        }
    }
    systems
}

/// Fields that full marks need and the model answer leaves out; pictures cannot stand in a lab file.
fn unanswered(lab: &LabDefinition) -> impl Iterator<Item = &Field> {
    lab.sheet.fields.iter().filter(|field| {
        field.required
            && !matches!(field.kind, FieldKind::Figure | FieldKind::Data)
            && !lab.model_answer.answers.contains_key(&field.path)
    })
}

fn concepts(lab: &LabDefinition) -> impl Iterator<Item = (&str, &Concept)> {
    lab.questions.iter().flat_map(|question| &question.criteria).flat_map(|criterion| {
        let concepts = match &criterion.check {
            Check::Concepts { concepts, .. } => concepts.as_slice(),
            _ => &[],
        };
        concepts.iter().map(|concept| (criterion.id.as_str(), concept))
    })
}

/// `a`, `b` and `c`; `None` for nothing.
fn listed(names: impl Iterator<Item = String>) -> Option<String> {
    let names: Vec<String> = names.map(|name| format!("`{name}`")).collect();
    (!names.is_empty()).then(|| crate::english::listed(&names, "and"))
}

fn model_answer(question: &Question, fields: &[&Field], reference: &Reference) -> String {
    let own = fields.iter().any(|field| field.path == question.id);
    let mut text = String::new();
    for field in fields {
        let judging = question.criteria.iter().find(|criterion| criterion.field == field.path);
        let in_letters = question
            .fields
            .iter()
            .any(|one| one.path == field.path && one.answered_in == AnsweredIn::Letters);
        let answer = judging.and_then(|criterion| {
            let letters = if in_letters { letters(&criterion.check, reference) } else { None };
            letters.or_else(|| answer(&criterion.check, reference))
        });
        let answer = answer.unwrap_or_else(|| "# not computed: write it in your own words".to_owned());
        let name = field.path.strip_prefix(&question.id).and_then(|rest| rest.strip_prefix('.'));
        match name {
            Some(name) if !own => text.push_str(&format!("      {name}: {answer}\n")),
            _ => return format!("  {}:\n    model_answer: {answer}\n", question.id),
        }
    }
    if text.is_empty() { text } else { format!("  {}:\n    model_answer:\n{text}", question.id) }
}

/// A transfer function in the lab's letters; `None` where there are none in it.
fn letters(check: &Check, reference: &Reference) -> Option<String> {
    let (Check::Structure { of } | Check::Numerator { of, .. } | Check::Denominator { of, .. }) = check
    else {
        return None;
    };
    let derivation = reference.operating_point(of)?.letters.as_ref().ok()?;
    derivation.has_letters().then(|| derivation.transfer_function().to_string())
}

/// The line that touches a function at an operating point.
fn tangent(point: &OperatingPointReference, form: LineForm) -> Option<String> {
    let tangent = point.tangent.as_ref()?;
    let (x, y) = (&point.input, &point.output);
    let slope = significant(tangent.slope, FIGURES);
    let offset = tangent.at.1 - tangent.slope * tangent.at.0;
    let sign = if offset < 0.0 { '-' } else { '+' };
    Some(match form {
        LineForm::Line => format!("{y} = {slope}*{x} {sign} {}", significant(offset.abs(), FIGURES)),
        LineForm::Deviations => format!("d{y} = {slope}*d{x}"),
    })
}

/// The right answer to what a check judges, as a student would write it.
fn answer(check: &Check, reference: &Reference) -> Option<String> {
    let at = |of: &SystemRef, what: &str| values_at(reference, &format!("{of}.{what}"));
    match check {
        Check::Structure { of } | Check::Numerator { of, .. } | Check::Denominator { of, .. } => {
            let coefficients = |what| {
                let values = at(of, &format!("transfer_function.{what}"))?;
                Some(values.iter().map(rounded).collect::<Vec<_>>().join(", "))
            };
            Some(format!("{{num: [{}], den: [{}]}}", coefficients("num")?, coefficients("den")?))
        }
        Check::Poles { of, .. } => {
            let poles: Vec<String> = at(of, "poles")?.iter().map(rounded).collect();
            Some(format!("[{}]", poles.join(", ")))
        }
        Check::Stability { of } => at(of, "stability")?.first().map(rounded),
        Check::Shape { of, response } => {
            at(of, &format!("{}.shape", response.as_str()))?.first().map(rounded)
        }
        Check::Feature { of, response, feature, .. } => {
            let value = at(of, &format!("{}.{}", response.as_str(), feature.kind.path_name()));
            Some(
                value
                    .and_then(|value| value.first().map(rounded))
                    .unwrap_or_else(|| "does not exist".to_owned()),
            )
        }
        Check::Rest { of, asked, .. } => {
            let native = at(of, &format!("equilibrium.{}", asked.signal))?;
            match native.first()? {
                ExpectedValue::Number(x) => Some(significant(x * to_f64(&asked.ratio().value().0), FIGURES)),
                _ => None,
            }
        }
        Check::Nonlinearity { expected } => Some(nonlinearity_name(*expected).to_owned()),
        Check::Tangent { of, form, .. } => tangent(reference.operating_point(of)?, *form),
        _ => None,
    }
}

/// Rounded as one writes it; a word as students say it.
fn rounded(value: &ExpectedValue) -> String {
    match value {
        ExpectedValue::Number(x) => significant(*x, FIGURES),
        ExpectedValue::Complex(re, im) if *im == 0.0 => significant(*re, FIGURES),
        ExpectedValue::Complex(re, im) => {
            complex(&significant(*re, FIGURES), &significant(im.abs(), FIGURES), *im)
        }
        ExpectedValue::Word(word) => match word.as_str() {
            "asymptotically_stable" => "stable".to_owned(),
            "plus_infinity" => "+infinity".to_owned(),
            "minus_infinity" => "-infinity".to_owned(),
            "oscillates" | "oscillates_unbounded" => "does not exist".to_owned(),
            word => word.replace('_', " "),
        },
    }
}

/// To every digit, as `expect` reads them.
fn values(values: &[ExpectedValue]) -> String {
    let words: Vec<String> = values
        .iter()
        .map(|value| match value {
            ExpectedValue::Number(x) => x.to_string(),
            ExpectedValue::Complex(re, im) if *im == 0.0 => re.to_string(),
            ExpectedValue::Complex(re, im) => complex(&re.to_string(), &im.abs().to_string(), *im),
            ExpectedValue::Word(word) => word.clone(),
        })
        .collect();
    words.join(", ")
}

fn complex(re: &str, im: &str, sign: f64) -> String {
    format!("{re} {} {im}j", if sign < 0.0 { '-' } else { '+' })
}
