use super::Check;
use crate::english::listed;
use crate::lab::{LabDefinition, ModelDefinition, OperatingPointDefinition};
use crate::lti::TransferFunction;
use crate::model::Mistake;
use crate::reference::Reference;
use std::collections::BTreeSet;

/// Mistakes that no answer tells apart are listed, and those that no answer tells from the truth.
///
/// That the lab has not declared one of these is something to do: the term may be meant so, or be a mistyped equation.
/// It is enough that an answer tells it at one of a model's operating points: a term in one input cannot matter to another's
/// transfer function. A declaration that no mistake needs fails as well.
pub(super) fn mistakes_are_told_apart(lab: &LabDefinition, reference: &Reference) -> Vec<Check> {
    let mut checks = Vec::new();
    let mut needed = vec![false; lab.mistakes.without_effect.len()];
    for model in &lab.models {
        let led = Led::of(lab, reference, model);
        let told = told(&led);
        for (point, led) in &led {
            for (needed, entry) in needed.iter_mut().zip(&lab.mistakes.without_effect) {
                *needed |= led.nowhere.iter().any(|mistake| entry.covers(mistake, &model.model));
            }
            checks.push(led.apart(model, point));
            checks.push(led.beside_the_truth(lab, model, point, &told));
        }
    }
    for (entry, _) in lab.mistakes.without_effect.iter().zip(needed).filter(|(_, needed)| !needed) {
        checks.push(Check {
            what: format!("without effect: `{}`", entry.text),
            found: "is declared, but every mistake it covers changes a transfer function".to_owned(),
            holds: false,
            span: Some(entry.span),
        });
    }
    checks
}

/// How many different wrong functions the mistakes lead to, over all operating points that are asked about.
///
/// Errors: in words, mistakes that no answer tells from the truth, and that the lab does not declare.
///
/// `known`: changes that show nowhere with the lab's own values either, which is said of the lab.
pub(super) fn wrong_functions(
    lab: &LabDefinition,
    reference: &Reference,
    known: &[String],
) -> Result<usize, String> {
    let mut count = 0;
    for model in &lab.models {
        let led = Led::of(lab, reference, model);
        let told = told(&led);
        for (point, led) in &led {
            let mut undeclared = led.undeclared(lab, model, &told);
            undeclared.retain(|mistake| !known.contains(&mistake.change));
            if !undeclared.is_empty() {
                let changes = listed(&changes(&undeclared), "and");
                return Err(format!(
                    "mistakes without effect at {}.{}: no answer shows {changes}",
                    model.id, point.id
                ));
            }
            count += led.groups.len();
        }
    }
    Ok(count)
}

/// The changes that [`mistakes_are_told_apart`] finds undeclared, each once.
pub(super) fn undeclared(lab: &LabDefinition, reference: &Reference) -> Vec<String> {
    let mut changes: Vec<String> = Vec::new();
    for (model, led) in lab.models.iter().map(|model| (model, Led::of(lab, reference, model))) {
        let told = told(&led);
        for (_, led) in &led {
            for mistake in led.undeclared(lab, model, &told) {
                if !changes.contains(&mistake.change) {
                    changes.push(mistake.change.clone());
                }
            }
        }
    }
    changes
}

/// The mistakes that show at one of these points.
fn told<'a>(led: &'a [(&OperatingPointDefinition, Led)]) -> BTreeSet<&'a str> {
    let shown = led.iter().flat_map(|(_, led)| led.groups.iter().flatten().chain(&led.none));
    shown.map(|mistake| mistake.change.as_str()).collect()
}

/// Where mistakes lead.
struct Led {
    /// Mistakes that lead to the same wrong function.
    groups: Vec<Vec<Mistake>>,
    /// Mistakes that lead to a right one.
    nowhere: Vec<Mistake>,
    /// Mistakes that leave no function to write down: it is 0, or the equations cannot be solved any more.
    none: Vec<Mistake>,
}

impl Led {
    /// At each point of a model whose transfer function is asked for.
    fn of<'a>(
        lab: &LabDefinition,
        reference: &Reference,
        model: &'a ModelDefinition,
    ) -> Vec<(&'a OperatingPointDefinition, Self)> {
        let asked = model.operating_points.iter().filter(|point| is_asked(lab, model, point));
        asked
            .map(|point| (point, Self::new(lab, model, point, &right_functions(reference, model, point))))
            .collect()
    }

    fn new(
        lab: &LabDefinition,
        model: &ModelDefinition,
        point: &OperatingPointDefinition,
        accepted: &[&TransferFunction],
    ) -> Self {
        let derivation = model.derivation(point, &lab.parameters);
        let mut known: Vec<TransferFunction> = Vec::new();
        let mut own = Self { groups: Vec::new(), nowhere: Vec::new(), none: Vec::new() };
        for mistake in derivation.mistakes() {
            if lab.mistakes.weight(mistake.kind.code()) == 0 {
                continue;
            }
            let Some(function) = derivation.function(&[&mistake]) else {
                own.none.push(mistake);
                continue;
            };
            let comparable = function.cancelled().0.monic();
            if accepted.iter().any(|right| right.equals(&comparable)) {
                own.nowhere.push(mistake);
                continue;
            }
            match known.iter().position(|other| *other == comparable) {
                Some(place) => own.groups[place].push(mistake),
                None => {
                    known.push(comparable);
                    own.groups.push(vec![mistake]);
                }
            }
        }
        own
    }

    fn apart(&self, model: &ModelDefinition, point: &OperatingPointDefinition) -> Check {
        let all: usize = self.groups.iter().map(Vec::len).sum();
        let alike: Vec<String> = self
            .groups
            .iter()
            .filter(|group| group.len() > 1)
            .map(|group| format!("\n        {}", changes(group).join("  =  ")))
            .collect();
        let rest = match alike.len() {
            0 => String::new(),
            _ => format!("; no answer tells these apart:{}", alike.concat()),
        };
        Check {
            what: format!("mistakes at {}.{}", model.id, point.id),
            found: format!("{all} mistakes lead to {} different wrong functions{rest}", self.groups.len()),
            holds: true,
            span: None,
        }
    }

    /// Mistakes that are not declared and show nowhere.
    fn undeclared(
        &self,
        lab: &LabDefinition,
        model: &ModelDefinition,
        told: &BTreeSet<&str>,
    ) -> Vec<Mistake> {
        let nowhere = self.nowhere.iter();
        nowhere
            .filter(|mistake| !declared(lab, model, mistake) && !told.contains(mistake.change.as_str()))
            .cloned()
            .collect()
    }

    fn beside_the_truth(
        &self,
        lab: &LabDefinition,
        model: &ModelDefinition,
        point: &OperatingPointDefinition,
        told: &BTreeSet<&str>,
    ) -> Check {
        let elsewhere = |mistake: &&Mistake| told.contains(mistake.change.as_str());
        let undeclared = self.undeclared(lab, model, told);
        let told_elsewhere =
            self.nowhere.iter().filter(|mistake| !declared(lab, model, mistake) && elsewhere(mistake));
        Check {
            what: format!("mistakes without effect at {}.{}", model.id, point.id),
            found: match (undeclared.as_slice(), self.nowhere.len()) {
                ([], 0) => "there are none".to_owned(),
                ([], count) if model.linear.is_some() => format!("{count}, in a linear model as it is given"),
                ([], count) => match told_elsewhere.count() {
                    0 => format!("{count}, all declared"),
                    told if told == count => format!("{count}, all told at another operating point"),
                    told => format!(
                        "{count}, of which {told} are told at another operating point, the rest declared"
                    ),
                },
                (undeclared, count) => format!("{count}, of which {} are not declared", undeclared.len()),
            },
            holds: true,
            span: None,
        }
    }
}

fn declared(lab: &LabDefinition, model: &ModelDefinition, mistake: &Mistake) -> bool {
    // A linear model is given as it is, hidden states included: there a term without effect is no mistyped equation.
    model.linear.is_some()
        || lab.mistakes.without_effect.iter().any(|entry| entry.covers(mistake, &model.model))
}

fn changes(mistakes: &[Mistake]) -> Vec<String> {
    mistakes.iter().map(|mistake| format!("`{}`", mistake.change)).collect()
}

fn right_functions<'a>(
    reference: &'a Reference,
    model: &ModelDefinition,
    point: &OperatingPointDefinition,
) -> Vec<&'a TransferFunction> {
    let models = reference.models.iter().filter(|known| known.id == model.id);
    let points = models.flat_map(|known| &known.operating_points).filter(|known| known.id == point.id);
    points.flat_map(|known| &known.accepted).map(|one| &one.linearization.transfer_function).collect()
}

/// Whether a criterion judges the transfer function there.
fn is_asked(lab: &LabDefinition, model: &ModelDefinition, point: &OperatingPointDefinition) -> bool {
    let mut criteria = lab.questions.iter().flat_map(|question| &question.criteria);
    criteria.any(|criterion| {
        let of = criterion.check.transfer_function();
        of.is_some_and(|of| of.model == model.id && of.operating_point == point.id)
    })
}
