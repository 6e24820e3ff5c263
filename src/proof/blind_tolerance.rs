use crate::algebra::{significant, to_f64};
use crate::lab::{Check, ExpectedValue, LabDefinition};
use crate::reference::{Reference, values_at};

/// Criteria whose stated absolute tolerance is as wide as what they expect: 0, or the other sign, would be right.
///
/// `settling.value: 0.0004 ± 0.001`. Expected zeros need such a width, and are not among them.
pub(super) fn blind_tolerances(lab: &LabDefinition, reference: &Reference) -> Vec<String> {
    let criteria = lab.questions.iter().flat_map(|question| &question.criteria);
    criteria
        .filter_map(|criterion| {
            let (path, tolerance, factor) = match &criterion.check {
                Check::Feature { of, response, feature, tolerance } => {
                    let ratio = feature.ratio();
                    let factor = to_f64(&ratio.factor) * std::f64::consts::PI.powi(ratio.pi);
                    (format!("{of}.{}.{}", response.as_str(), feature.kind.path_name()), tolerance, factor)
                }
                Check::Poles { of, tolerance, .. } => (format!("{of}.poles"), tolerance, 1.0),
                _ => return None,
            };
            // What polemark chooses is no wider than a tenth of what is expected.
            if tolerance.of_scale.is_some() {
                return None;
            }
            let width = to_f64(&tolerance.absolute);
            let expected = values_at(reference, &path)?;
            let narrowest = expected.iter().map(|value| size(value) * factor).filter(|size| *size > 0.0);
            let narrowest = narrowest.fold(f64::INFINITY, f64::min);
            (narrowest <= width).then(|| {
                format!("{}: {} ± {}", criterion.id, significant(narrowest, 3), significant(width, 3))
            })
        })
        .collect()
}

fn size(value: &ExpectedValue) -> f64 {
    match value {
        ExpectedValue::Number(x) => x.abs(),
        ExpectedValue::Complex(re, im) => re.hypot(*im),
        ExpectedValue::Word(_) => 0.0,
    }
}
