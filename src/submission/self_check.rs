use super::own_claims::{WorkedOut, contradicted_claims};
use super::problem::quote;
use super::shape_name;
use super::unworkable::unworkable;
use super::{
    Answer, AnswerSheet, AnswerValue, Decimal, Field, FieldKind, FinalValue, Series, Submission,
    TypedComplex, Unit, UnitRatio,
};
use crate::algebra::{Rational, to_f64};
use crate::lti::{InputKind, Response, Shape, Stability, TransferFunction, roots, stability};
use crate::source::{Finding, Span};
use std::collections::BTreeMap;

/// What is missing, and where the file contradicts itself. Uses only the student's own answers.
///
/// A contradiction names the two answers and their lines, never which of them is right. Fields are held against each
/// other when they speak [about](Field::about) the same system; a [`Value`](super::FieldKind::Value) whose path ends
/// in `initial_value` or `final_value` is what it says.
pub fn self_check(submission: &Submission, sheet: &AnswerSheet) -> Vec<Finding> {
    if !submission.readable {
        return Vec::new();
    }
    let mut findings: Vec<Finding> = sheet
        .fields
        .iter()
        .filter(|field| field.required && !submission.answers.contains_key(&field.path))
        .filter(|field| !plotted_otherwise(field, submission, sheet))
        .map(missing)
        .collect();
    findings.extend(unworkable(submission, sheet));
    let mut systems: BTreeMap<&str, System<'_>> = BTreeMap::new();
    for field in &sheet.fields {
        if let (Some(about), Some(answer)) = (field.about.as_deref(), submission.answers.get(&field.path))
            && !sheet.leans_on_untold(answer)
        {
            systems.entry(about).or_insert_with(|| System::new(submission)).add(field, answer);
        }
    }
    findings.extend(systems.values().flat_map(System::contradictions));
    findings.extend(sheet.fields.iter().flat_map(|field| prose_against_answers(field, submission, sheet)));
    findings
}

/// More contradictions than these in one text are one misunderstanding.
const MOST_OF_PROSE: usize = 4;

/// What a description in words claims, against the other answers about the same response.
fn prose_against_answers(field: &Field, submission: &Submission, sheet: &AnswerSheet) -> Vec<Finding> {
    let Some(answer) = submission.answers.get(&field.path) else { return Vec::new() };
    let Ok(AnswerValue::Prose(prose)) = &answer.value else { return Vec::new() };
    let line = |answer: &Answer| submission.source.position(answer.span.start).line;
    let mut found = contradicted_claims(submission, sheet, &field.path, &WorkedOut);
    found.truncate(MOST_OF_PROSE);
    found
        .iter()
        .map(|contradicted| {
            let claim = &contradicted.claim;
            let words = prose.get(claim.span.start..claim.span.end).unwrap_or_default();
            let other = contradicted.answer;
            let message = format!(
                "`{}` (line {}) and `{}` (line {}) do not agree: the text says “{}”, which we take as “{}”. {}",
                other.path,
                line(other),
                field.path,
                line(answer),
                words.split_whitespace().collect::<Vec<_>>().join(" "),
                claim.words(),
                contradicted.says
            );
            Finding::warning("contradiction.prose", message)
                .with_help("Look at both again.")
                .at(words_in_file(answer, words, submission))
        })
        .collect()
}

/// Where `words` of an answer stand in the file, when they are there once as they are; the whole answer otherwise.
fn words_in_file(answer: &Answer, words: &str, submission: &Submission) -> Span {
    let text = submission.source.text.get(answer.span.start..answer.span.end).unwrap_or_default();
    let mut places = text.match_indices(words).map(|(at, _)| answer.span.start + at);
    match (places.next(), places.next()) {
        (Some(start), None) if !words.is_empty() => Span { start, end: start + words.len() },
        _ => answer.span,
    }
}

/// Figure and data of one question are alternatives: with one given, the other is not missing.
fn plotted_otherwise(field: &Field, submission: &Submission, sheet: &AnswerSheet) -> bool {
    let other = match field.kind {
        FieldKind::Figure => FieldKind::Data,
        FieldKind::Data => FieldKind::Figure,
        _ => return false,
    };
    sheet.fields.iter().any(|given| {
        given.kind == other
            && given.question == field.question
            && submission.answers.contains_key(&given.path)
    })
}

fn missing(field: &Field) -> Finding {
    let message = format!("`{}` has no answer: {}", field.path, field.prompt.trim());
    let message = if message.ends_with(['.', '?', '!', ':']) { message } else { format!("{message}.") };
    Finding::warning("answer.missing", message)
}

/// Relative difference below which rounded coefficients may explain that two answers differ.
const ROUNDING: f64 = 0.02;
/// The same for a repeated root, which rounding moves much further.
const ROUNDING_REPEATED: f64 = 0.15;
/// Share of the largest value by which a curve may miss the transfer function's response.
const CURVE: f64 = 0.1;
/// Points of a curve that are compared.
const CURVE_POINTS: usize = 400;

/// What one file says about one system.
struct System<'a> {
    submission: &'a Submission,
    /// With common factors cancelled.
    transfer_function: Option<(&'a Answer, TransferFunction)>,
    poles: Option<(&'a Answer, &'a [TypedComplex])>,
    stability: Option<(&'a Answer, Stability)>,
    initial: Option<(&'a Field, &'a Answer, &'a FinalValue)>,
    last: Option<(&'a Field, &'a Answer, &'a FinalValue)>,
    shape: Option<(&'a Field, &'a Answer, Shape)>,
    data: Option<(&'a Field, &'a Answer, &'a Series)>,
}

impl<'a> System<'a> {
    fn new(submission: &'a Submission) -> Self {
        Self {
            submission,
            transfer_function: None,
            poles: None,
            stability: None,
            initial: None,
            last: None,
            shape: None,
            data: None,
        }
    }

    fn add(&mut self, field: &'a Field, answer: &'a Answer) {
        match &answer.value {
            Ok(AnswerValue::TransferFunction { transfer_function, .. }) => {
                self.transfer_function = Some((answer, transfer_function.cancelled().0));
            }
            Ok(AnswerValue::Poles(poles)) if !poles.is_empty() => self.poles = Some((answer, poles)),
            Ok(AnswerValue::Stability(word)) => self.stability = Some((answer, *word)),
            Ok(AnswerValue::Shape(shape)) => self.shape = Some((field, answer, *shape)),
            Ok(AnswerValue::Data(series)) => self.data = Some((field, answer, series)),
            Ok(AnswerValue::Value(value)) if field.path.ends_with("initial_value") => {
                self.initial = Some((field, answer, value));
            }
            Ok(AnswerValue::Value(value)) if field.path.ends_with("final_value") => {
                self.last = Some((field, answer, value));
            }
            _ => {}
        }
    }

    fn contradictions(&self) -> Vec<Finding> {
        [
            self.lone_conjugate().or_else(|| self.poles_against_transfer_function()),
            self.stability_against_transfer_function(),
            self.stability_against_poles(),
            self.last_value(),
            self.shape_against_stability(),
            self.shape_against_poles(),
            self.initial_value(),
            self.data_against_transfer_function(),
        ]
        .into_iter()
        .flatten()
        .collect()
    }

    /// Two answers that disagree; the caret stands at the second.
    fn clash(&self, code: &'static str, first: &Answer, second: &Answer, why: impl AsRef<str>) -> Finding {
        let line = |answer: &Answer| self.submission.source.position(answer.span.start).line;
        let message = format!(
            "`{}` (line {}) and `{}` (line {}) do not agree: {}.",
            first.path,
            line(first),
            second.path,
            line(second),
            why.as_ref()
        );
        Finding::warning(code, message).with_help("Look at both again.").at(second.span)
    }

    fn lone_conjugate(&self) -> Option<Finding> {
        let (answer, poles) = self.poles?;
        let count = |re: &Decimal, im: &Decimal| {
            poles.iter().filter(|p| close(&p.re, re) && close(&p.im, im)).count()
        };
        let lone = poles.iter().find(|pole| {
            !pole.im.is_zero() && count(&pole.re, &pole.im) != count(&pole.re, &pole.im.negated())
        })?;
        let message = format!(
            "`{}` lists {} without its conjugate as often; a system with real coefficients has both.",
            answer.path,
            quote(&lone.read_as())
        );
        Some(
            Finding::warning("poles.conjugate_missing", message)
                .with_help("A pair is written like `-2 ± 3.1j`.")
                .at(lone.span),
        )
    }

    fn poles_against_transfer_function(&self) -> Option<Finding> {
        const CODE: &str = "contradiction.poles_and_transfer_function";
        let (first, g) = self.transfer_function.as_ref()?;
        let (second, listed) = self.poles?;
        let degree = g.den.degree();
        if degree != listed.len() {
            let why = format!(
                "with common factors cancelled the denominator has degree {degree}, and {} listed",
                if listed.len() == 1 {
                    "1 pole is".to_owned()
                } else {
                    format!("{} poles are", listed.len())
                }
            );
            return Some(self.clash(CODE, first, second, why));
        }
        let own: Vec<(f64, f64, usize)> = roots(&g.den)
            .ok()?
            .iter()
            .flat_map(|root| std::iter::repeat_n((root.re, root.im, root.multiplicity), root.multiplicity))
            .collect();
        let stray = unmatched(listed, &own)?;
        let why = format!("{} is listed, and no root of the denominator is near it", quote(&stray.read_as()));
        let mut finding = self.clash(CODE, first, second, why);
        finding.span = Some(stray.span);
        Some(finding)
    }

    fn stability_against_transfer_function(&self) -> Option<Finding> {
        let (first, g) = self.transfer_function.as_ref()?;
        let (second, word) = self.stability?;
        let own = stability(&g.den);
        (own != word).then(|| {
            let why = format!(
                "by its denominator the transfer function is {}, and the word is {}",
                own.words(),
                word.words()
            );
            self.clash("contradiction.stability_and_transfer_function", first, second, why)
        })
    }

    fn stability_against_poles(&self) -> Option<Finding> {
        let (first, poles) = self.poles?;
        let (second, word) = self.stability?;
        let own = stability_of(poles);
        (own != word).then(|| {
            let why = format!(
                "the poles are those of a system that is {}, and the word is {}",
                own.words(),
                word.words()
            );
            self.clash("contradiction.stability_and_poles", first, second, why)
        })
    }

    /// The best witness of stability in the file: the word, else the transfer function, else the poles.
    fn witness(&self) -> Option<(&'a Answer, Stability)> {
        self.stability
            .or_else(|| self.transfer_function.as_ref().map(|(answer, g)| (*answer, stability(&g.den))))
            .or_else(|| self.poles.map(|(answer, poles)| (answer, stability_of(poles))))
    }

    fn last_value(&self) -> Option<Finding> {
        let (field, second, value) = self.last?;
        let (first, stability) = self.witness()?;
        let impulse = field.response == Some(InputKind::Impulse);
        let why = match (stability, value) {
            (Stability::AsymptoticallyStable, FinalValue::Number(number, _)) => {
                (impulse && !number.is_zero()).then_some("a stable system returns to zero after an impulse")
            }
            (Stability::AsymptoticallyStable, _) => Some("a stable system does not grow without bound"),
            (Stability::MarginallyStable, FinalValue::Number(..)) => None,
            (Stability::MarginallyStable, _) => {
                impulse.then_some("a marginally stable system stays bounded after an impulse")
            }
            (Stability::Unstable, FinalValue::Number(..)) => Some("an unstable system does not settle"),
            (Stability::Unstable, _) => None,
        };
        why.map(|why| self.clash("contradiction.final_value", first, second, why))
    }

    fn shape_against_stability(&self) -> Option<Finding> {
        let (_, second, shape) = self.shape?;
        let (first, stability) = self.witness()?;
        let fits = match shape {
            Shape::DecayingOscillation | Shape::ExponentialDecay => {
                stability == Stability::AsymptoticallyStable
            }
            Shape::GrowingOscillation | Shape::ExponentialGrowth => stability == Stability::Unstable,
            Shape::SustainedOscillation => stability == Stability::MarginallyStable,
            Shape::PolynomialGrowth => stability != Stability::AsymptoticallyStable,
            Shape::Constant => true,
        };
        (!fits).then(|| {
            let why = format!("the one says {}, the other {}", stability.words(), shape_name(shape));
            self.clash("contradiction.shape_and_stability", first, second, why)
        })
    }

    fn shape_against_poles(&self) -> Option<Finding> {
        let (first, poles) = self.poles?;
        let (_, second, shape) = self.shape?;
        let swings = matches!(
            shape,
            Shape::DecayingOscillation | Shape::SustainedOscillation | Shape::GrowingOscillation
        );
        (swings && poles.iter().all(|pole| pole.im.is_zero())).then(|| {
            self.clash(
                "contradiction.shape_and_poles",
                first,
                second,
                "an oscillation needs a complex pair of poles",
            )
        })
    }

    fn initial_value(&self) -> Option<Finding> {
        const CODE: &str = "contradiction.initial_value";
        let (first, g) = self.transfer_function.as_ref()?;
        let (field, second, value) = self.initial?;
        let degree = g.relative_degree();
        // The power of s that lim s·Y(s) leaves over.
        let order = match field.response {
            Some(InputKind::Impulse) => degree - 1,
            Some(InputKind::Step) => degree,
            // Zero for either input.
            None if degree >= 2 => 1,
            None => return None,
        };
        let start = match order {
            1.. => 0.0,
            0 => to_f64(g.num.leading()?) / to_f64(g.den.leading()?),
            _ => return None,
        };
        let FinalValue::Number(number, unit) = value else {
            return Some(self.clash(
                CODE,
                first,
                second,
                "by its degrees the response starts at a finite value",
            ));
        };
        let found = plain_number(number, unit.as_ref())?;
        // A zero is meant exactly, whatever its digits; noise such as 3e-18 is zero.
        let typed = if number.is_zero() || start == 0.0 { 1e-9 } else { half_place(number) };
        ((found - start).abs() > typed.max(ROUNDING * start.abs())).then(|| {
            let why = if start == 0.0 {
                "by its degrees the response starts at zero, and another value is given"
            } else {
                "by its highest coefficients the response starts at another value"
            };
            self.clash(CODE, first, second, why)
        })
    }

    fn data_against_transfer_function(&self) -> Option<Finding> {
        let (first, g) = self.transfer_function.as_ref()?;
        let (field, second, series) = self.data?;
        let response = Response::new(g, field.response?).ok()?;
        let step = series.rows.len().div_ceil(CURVE_POINTS).max(1);
        let columns = series.headers.len();
        let (mut largest, mut apart) = (0.0f64, vec![0.0f64; columns]);
        for row in series.rows.iter().step_by(step).filter(|row| row[0] >= 0.0) {
            let own = response.at(row[0]);
            if !own.is_finite() {
                return None;
            }
            largest = largest.max(own.abs());
            for (column, value) in row.iter().enumerate().skip(1) {
                apart[column] = apart[column].max((value - own).abs());
            }
        }
        let nearest = apart.iter().skip(1).copied().fold(f64::INFINITY, f64::min);
        (nearest > CURVE * largest).then(|| {
            let kind = match field.response {
                Some(InputKind::Step) => "step",
                _ => "impulse",
            };
            let why = format!("the curve is not the {kind} response of the transfer function");
            self.clash("contradiction.data_and_transfer_function", first, second, why)
        })
    }
}

/// A number that may be held against others of the file: without a unit, in one of SI without prefix, or 0.
pub(super) fn plain_number(number: &Decimal, unit: Option<&Unit>) -> Option<f64> {
    let coherent = |unit: &Unit| unit.in_si() == Some(UnitRatio::one());
    (unit.is_none_or(coherent) || number.is_zero()).then(|| to_f64(&number.value))
}

/// What rounding to the last digit typed may change, and a little more.
fn half_place(number: &Decimal) -> f64 {
    0.6 * 10f64.powi(number.last_place.clamp(-400, 400))
}

/// Equal when rounded to the coarser last digit.
fn close(a: &Decimal, b: &Decimal) -> bool {
    (to_f64(&a.value) - to_f64(&b.value)).abs() <= half_place(a).max(half_place(b))
}

/// What the poles say, taken as exact.
pub(super) fn stability_of(poles: &[TypedComplex]) -> Stability {
    let on_axis = |pole: &&TypedComplex| pole.re.value == Rational::ZERO;
    let repeated = |pole: &TypedComplex| {
        poles.iter().filter(on_axis).filter(|other| other.im.value == pole.im.value).count() > 1
    };
    if poles.iter().any(|pole| pole.re.value > Rational::ZERO) || poles.iter().filter(on_axis).any(repeated) {
        Stability::Unstable
    } else if poles.iter().any(|pole| on_axis(&pole)) {
        Stability::MarginallyStable
    } else {
        Stability::AsymptoticallyStable
    }
}

/// A listed pole with no root left near it, when the closest are paired first.
fn unmatched<'p>(listed: &'p [TypedComplex], own: &[(f64, f64, usize)]) -> Option<&'p TypedComplex> {
    let mut pairs: Vec<(f64, usize, usize)> = Vec::new();
    for (i, pole) in listed.iter().enumerate() {
        for (j, (re, im, _)) in own.iter().enumerate() {
            let distance = (to_f64(&pole.re.value) - re).hypot(to_f64(&pole.im.value) - im);
            pairs.push((distance, i, j));
        }
    }
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)).then(a.2.cmp(&b.2)));
    let (mut paired, mut taken) = (vec![None; listed.len()], vec![false; own.len()]);
    for (_, i, j) in pairs {
        if paired[i].is_none() && !taken[j] {
            paired[i] = Some(j);
            taken[j] = true;
        }
    }
    listed.iter().zip(paired).find_map(|(pole, pair)| {
        let (re, im, multiplicity) = own[pair?];
        let rounding = if multiplicity > 1 { ROUNDING_REPEATED } else { ROUNDING };
        let near = |typed: &Decimal, own: f64| {
            (to_f64(&typed.value) - own).abs() <= (rounding * re.hypot(im)).max(half_place(typed))
        };
        (!near(&pole.re, re) || !near(&pole.im, im)).then_some(pole)
    })
}
