use super::edit::{Edit, Replacement};
use super::{Derivation, Mistake, MistakeKind, Place};
use crate::algebra::{Expression, Function, NodeKind, significant};
use crate::model::Exact;

/// A cos or sin of the equations whose sign the operating point turns.
struct Call<'a> {
    place: Place,
    text: &'a str,
    function: Function,
    /// The value of a cos, the slope of a sin.
    cosine: f64,
}

/// Each sin and cos taken as it is near zero where the operating point turns its sign: cos π as +1, sin(π + φ) as +φ. One by
/// one, all that are written alike at once, and all of them.
pub(super) fn mistakes(of: &Derivation) -> Vec<Mistake> {
    let calls = turned(of);
    let mut all: Vec<Mistake> = calls.iter().map(|call| one(of, call)).collect();
    let mut alike: Vec<Vec<&Call<'_>>> = Vec::new();
    for call in &calls {
        match alike.iter_mut().find(|group| group[0].text == call.text) {
            Some(group) => group.push(call),
            None => alike.push(vec![call]),
        }
    }
    all.extend(alike.iter().filter(|group| group.len() > 1).map(|group| together(group)));
    if alike.len() > 1 {
        all.push(together(&calls.iter().collect::<Vec<_>>()));
    }
    all
}

fn turned(of: &Derivation) -> Vec<Call<'_>> {
    let mut calls = Vec::new();
    let Ok((parameters, at)) = of.place(&of.parameters, &[]) else { return calls };
    let lookup = |name: &str, primes: u8| at.lookup(&parameters, name, primes);
    for (index, equation) in of.equations() {
        let mut nodes = Vec::new();
        collect(&equation.left, &mut nodes);
        collect(&equation.right, &mut nodes);
        for (node, function, argument) in nodes {
            let Some(cosine) = cosine(argument, &lookup).filter(|value| *value < 0.0) else { continue };
            let text = equation.text.get(node.start..node.end).unwrap_or_default();
            let place = Place { equation: index, start: node.start, end: node.end };
            calls.push(Call { place, text, function, cosine });
        }
    }
    calls
}

fn one(of: &Derivation, call: &Call<'_>) -> Mistake {
    let (name, number) = (call.text, call.place.equation + 1);
    // The same call may stand in several terms: its place in the line tells which.
    let equation = of.model.equations.get(call.place.equation).map_or("", |equation| equation.text.as_str());
    let before = equation.get(..call.place.start).unwrap_or_default();
    let which = before.matches(name).count() + 1;
    let which = if equation.matches(name).count() > 1 { format!(" no. {which}") } else { String::new() };
    Mistake {
        kind: MistakeKind::PointSign,
        words: format!(
            "`{name}`{which} of equation {number} has the wrong sign at the operating point ({})",
            call.about()
        ),
        change: format!("equation {number}: {name} -> -{name}{which}"),
        places: vec![call.place],
        edit: Edit::Nodes(vec![call.place], Replacement::Negated),
    }
}

fn together(calls: &[&Call<'_>]) -> Mistake {
    let mut names: Vec<&Call<'_>> = Vec::new();
    for call in calls {
        if !names.iter().any(|known| known.text == call.text) {
            names.push(call);
        }
    }
    let places: Vec<Place> = calls.iter().map(|call| call.place).collect();
    let list = |part: &dyn Fn(&Call<'_>) -> String| names.iter().map(|call| part(call)).collect::<Vec<_>>();
    Mistake {
        kind: MistakeKind::PointSign,
        words: match names.as_slice() {
            [only] => {
                format!("every `{}` has the wrong sign at the operating point ({})", only.text, only.about())
            }
            _ => format!(
                "{} all have the signs they have near zero, not those at the operating point",
                list(&|call| format!("`{}`", call.text)).join(" and ")
            ),
        },
        change: list(&|call| format!("every {0} -> -{0}", call.text)).join(", "),
        edit: Edit::Nodes(places.clone(), Replacement::Negated),
        places,
    }
}

impl Call<'_> {
    fn about(&self) -> String {
        let (is, not) = (significant(self.cosine, 3), significant(-self.cosine, 3));
        if self.function == Function::Cos {
            format!("it is {is} there, not {not}")
        } else {
            format!("its slope there is {is}, not {not}")
        }
    }
}

/// Of the argument at the operating point: the value of a cos, the slope of a sin.
fn cosine(argument: &Expression, lookup: &dyn Fn(&str, u8) -> Option<Exact>) -> Option<f64> {
    Exact::evaluate(argument, lookup).ok().map(|value| value.to_f64().cos())
}

fn collect<'a>(node: &'a Expression, calls: &mut Vec<(&'a Expression, Function, &'a Expression)>) {
    if let NodeKind::Call(function @ (Function::Sin | Function::Cos), argument) = &node.kind {
        calls.push((node, *function, argument));
    }
    node.children().for_each(|child| collect(child, calls));
}
