//! What a lab need not say. `docs/lab-file.md` lists these under *What may be left out*.

use super::{Check, Cover, CoverRow, CoverSource, Curve, FeatureKind, LineForm, Points};
use crate::english::capitalized;
use crate::lti::InputKind;
use crate::submission::FieldKind;

/// An id as a title: `full.transfer_function` is `Full: transfer function`.
pub(super) fn in_words(id: &str) -> String {
    let words = id.replace('.', ": ").replace(['_', '-'], " ");
    capitalized(&words)
}

/// A title as typed, or else the id in words.
pub(super) fn title(typed: Option<&String>, id: &str) -> String {
    typed.map_or_else(|| in_words(id), |title| title.trim().to_owned())
}

/// `whole` in these proportions, each part rounded to hundredths so that together they are `whole` again.
pub(super) fn split(whole: Points, proportions: &[i64]) -> Vec<Points> {
    let sum = proportions.iter().sum::<i64>().max(1);
    let (mut before, mut reached) = (0, 0);
    let mut part = |proportion: &i64| {
        reached += proportion;
        let up_to = (whole.0 * reached + sum / 2) / sum;
        let part = Points(up_to - before);
        before = up_to;
        part
    };
    proportions.iter().map(&mut part).collect()
}

/// The usual criteria of a kind of field: (id, its check, its percentage of the points). Empty where there are none.
pub(super) fn usual_criteria(kind: FieldKind) -> &'static [(&'static str, &'static str, i64)] {
    match kind {
        FieldKind::TransferFunction => &[
            ("structure", "structure", 20),
            ("numerator", "numerator", 40),
            ("denominator", "denominator", 40),
        ],
        FieldKind::Poles => &[("poles", "poles", 100)],
        FieldKind::Value => &[("value", "feature", 100)],
        FieldKind::Stability => &[("stability", "stability", 100)],
        FieldKind::Shape => &[("shape", "shape", 100)],
        FieldKind::Nonlinearity => &[("nonlinearity", "nonlinearity", 100)],
        FieldKind::Formula => &[("tangent", "tangent", 100)],
        FieldKind::Prose => &[("prose", "concepts", 100)],
        FieldKind::Figure => &[("figure", "plot", 100)],
        FieldKind::Data => &[],
    }
}

/// One box with everything in it.
pub(super) fn cover(questions: Points, observed: Points) -> Cover {
    let total = questions + observed;
    let (id, title, from) = match observed {
        Points::ZERO => ("questions", "Questions", CoverSource::Questions),
        _ => ("lab", "Questions and observation", CoverSource::QuestionsAndObserved),
    };
    Cover { rows: vec![CoverRow { id: id.to_owned(), title: title.to_owned(), points: total, from }], total }
}

/// What a single wrong coefficient of a denominator leaves of the points of the usual criterion.
pub(super) const USUAL_ONE_SLIP: &str = "0.5";

/// What a field asks for when the lab does not say: of a value its feature, of what is read off a response which one.
///
/// `check` is what judges the field; `signals` are the names of the output and the input, where they are known.
pub(super) fn prompt(kind: FieldKind, check: Option<&Check>, signals: Option<(&str, &str)>) -> String {
    let response = match check {
        Some(
            Check::Feature { response, .. }
            | Check::Shape { response, .. }
            | Check::Plot { curve: Curve::Response { response, .. }, .. },
        ) => match response {
            InputKind::Impulse => "impulse response",
            InputKind::Step => "step response",
        },
        _ => "response",
    };
    match kind {
        FieldKind::TransferFunction => match signals {
            Some((output, input)) => format!("Transfer function from {input} to {output}"),
            None => "Transfer function".to_owned(),
        },
        FieldKind::Poles => "Poles, rad/s".to_owned(),
        FieldKind::Value => match check {
            Some(Check::Feature { feature, .. }) => {
                let words = feature.kind.words();
                let words = capitalized(words.strip_prefix("the ").unwrap_or(words));
                if is_of_poles(feature.kind) { words } else { format!("{words}, of the {response}") }
            }
            Some(Check::Rest { asked, .. }) => format!("{} at rest", asked.signal),
            _ => "A number".to_owned(),
        },
        FieldKind::Stability => "Is it stable?".to_owned(),
        FieldKind::Shape => format!("General shape of the {response}"),
        FieldKind::Nonlinearity => "Kind of nonlinearity".to_owned(),
        FieldKind::Formula => match (check, signals) {
            (Some(Check::Tangent { form: LineForm::Deviations, .. }), Some((output, input))) => {
                format!("Linear model in deviations of {output} and {input}")
            }
            (_, Some((output, input))) => format!("Tangent: {output} as a linear function of {input}"),
            _ => "Tangent".to_owned(),
        },
        FieldKind::Prose => "In your own words".to_owned(),
        FieldKind::Figure => match check {
            Some(Check::Plot { curve: Curve::Response { .. }, .. }) => format!("Plot of the {response}"),
            _ => "Plot".to_owned(),
        },
        FieldKind::Data => "The data of the plot".to_owned(),
    }
}

/// Whether it is the same for every response of a system.
fn is_of_poles(feature: FeatureKind) -> bool {
    matches!(
        feature,
        FeatureKind::PeriodS
            | FeatureKind::DampingRatio
            | FeatureKind::NaturalFrequencyRadS
            | FeatureKind::DampedFrequencyRadS
            | FeatureKind::DcGain
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_id_is_its_own_title() {
        for (id, words) in [
            ("full", "Full"),
            ("full.transfer_function", "Full: transfer function"),
            ("rc-circuit", "Rc circuit"),
            ("swing.x1.peak", "Swing: x1: peak"),
        ] {
            assert_eq!(in_words(id), words);
        }
    }

    #[test]
    fn parts_add_up_to_the_whole() {
        #[track_caller]
        fn check(whole: i64, proportions: &[i64], parts: &[i64]) {
            let found = split(Points(whole), proportions);
            assert_eq!(found.iter().map(|p| p.0).collect::<Vec<_>>(), parts);
            assert_eq!(found.into_iter().sum::<Points>(), Points(whole));
        }

        check(500, &[20, 40, 40], &[100, 200, 200]);
        check(100, &[20, 40, 40], &[20, 40, 40]);
        check(3, &[20, 40, 40], &[1, 1, 1]);
        check(101, &[20, 40, 40], &[20, 41, 40]);
        check(100, &[1, 1, 1], &[33, 34, 33]);
        check(3, &[1, 1, 1, 1, 1], &[1, 0, 1, 0, 1]);
        check(700, &[100], &[700]);
    }
}
