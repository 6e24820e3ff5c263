use crate::algebra::{Polynomial, significant, to_f64};
use crate::grading::other_variant::value;
use crate::lab::{Check, Criterion, Curve, FeatureKind, LabDefinition};
use crate::lti::{InputKind, Limit, Pole};
use crate::reference::{LinearReference, Reference};
use crate::submission::{NoFiles, Submission, UnitRatio, read};
use std::collections::BTreeMap;

/// Figures that are written: as many as the strictest tolerance could ask for.
const FIGURES: usize = 12;
const ROWS: usize = 60;

/// What a student would hand in who has everything right that follows from the equations, worked out from the reference.
pub(super) fn computed_answer(lab: &LabDefinition, reference: &Reference) -> Submission {
    let mut answers: BTreeMap<&str, String> = BTreeMap::new();
    for criterion in lab.questions.iter().flat_map(|question| &question.criteria) {
        let Some(text) = answer(reference, criterion) else { continue };
        let field = match &criterion.check {
            Check::Plot { data: Some(data), .. } => data,
            _ => &criterion.field,
        };
        answers.insert(field, text);
    }
    let mut text = format!("lab: {}\nstudent: {{id: computed, name: Computed}}\nanswers:\n", lab.id);
    for (field, answer) in answers {
        text.push_str(&format!("  {field}: {answer}\n"));
    }
    read("computed", "computed answer", text.as_bytes(), &lab.sheet, &NoFiles)
}

/// Whether a criterion judges something that [`computed_answer`] works out, and that differs from student to student.
pub(super) fn is_computed(lab: &LabDefinition, criterion: &Criterion) -> bool {
    let kind = match &criterion.check {
        Check::Structure { .. }
        | Check::Numerator { .. }
        | Check::Denominator { .. }
        | Check::Poles { .. }
        | Check::Stability { .. }
        | Check::Shape { .. } => true,
        Check::Rest { .. } => true,
        Check::Feature { feature, .. } => feature.kind != FeatureKind::DcGain,
        Check::Plot { data, curve, .. } => data.is_some() && matches!(curve, Curve::Response { .. }),
        _ => false,
    };
    kind && lab.judges_varied(criterion)
}

fn answer(reference: &Reference, criterion: &Criterion) -> Option<String> {
    let main = reference.operating_point(criterion.check.system()?)?.main();
    match &criterion.check {
        Check::Structure { .. } | Check::Numerator { .. } | Check::Denominator { .. } => {
            let g = main.linearization.transfer_function.monic();
            let list = |one: &Polynomial| {
                let numbers = one.coefficients().iter().map(|number| significant(to_f64(number), FIGURES));
                numbers.collect::<Vec<_>>().join(", ")
            };
            Some(format!("{{num: [{}], den: [{}]}}", list(&g.num), list(&g.den)))
        }
        Check::Poles { .. } => {
            let each = main.poles.iter().flat_map(|pole| std::iter::repeat_n(pole, pole.multiplicity));
            Some(format!("[{}]", each.map(pole_text).collect::<Vec<_>>().join(", ")))
        }
        Check::Stability { .. } => Some(main.stability.words().to_owned()),
        Check::Shape { response, .. } => {
            Some(response_of(main, *response)?.features.shape.words().to_owned())
        }
        Check::Feature { response, feature, .. } => {
            let features = &response_of(main, *response)?.features;
            let ratio = match (&feature.native, &feature.unit) {
                (Some(native), Some(asked)) => native.in_unit(asked),
                _ => None,
            };
            let factor = to_f64(&ratio.unwrap_or_else(UnitRatio::one).value().0);
            match value(features, feature.kind) {
                Some(value) => Some(significant(value * factor, FIGURES)),
                None => Some(
                    match features.final_value {
                        Limit::PlusInfinity => "inf",
                        Limit::MinusInfinity => "-inf",
                        _ => "does not exist",
                    }
                    .to_owned(),
                ),
            }
        }
        Check::Rest { asked, .. } => {
            let value = to_f64(main.values.get(&asked.signal)?) * to_f64(&asked.ratio().value().0);
            Some(significant(value, FIGURES))
        }
        Check::Plot { data: Some(_), curve: Curve::Response { response, .. }, span_s, .. } => {
            let curve = &response_of(main, *response)?.response;
            let rows = (0..=ROWS).map(|row| {
                let t = span_s * row as f64 / ROWS as f64;
                format!("\n    {}, {}", significant(t, FIGURES), significant(curve.at(t), FIGURES))
            });
            Some(format!("|{}", rows.collect::<String>()))
        }
        _ => None,
    }
}

fn pole_text(pole: &Pole) -> String {
    let part = |value: f64| significant(value, FIGURES);
    match pole.im {
        0.0 => part(pole.re),
        im => format!("{} {} {}j", part(pole.re), if im < 0.0 { "-" } else { "+" }, part(im.abs())),
    }
}

fn response_of(main: &LinearReference, kind: InputKind) -> Option<&crate::reference::ResponseReference> {
    match kind {
        InputKind::Impulse => main.impulse.as_ref(),
        InputKind::Step => main.step.as_ref(),
    }
}
