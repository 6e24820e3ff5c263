use super::rewrite::negated;
use super::{Derivation, Mistake, MistakeKind, Place};
use crate::algebra::{Expression, Function, NodeKind, significant};
use crate::lti::TransferFunction;
use crate::model::Exact;

/// Each sin and cos taken as it is near zero where the operating point turns its sign: cos π as +1, sin(π + φ) as +φ.
pub(super) fn mistakes(of: &Derivation<'_>) -> Vec<(Mistake, TransferFunction)> {
    let mut all = Vec::new();
    for (index, equation) in of.model.equations.iter().enumerate() {
        let mut calls = Vec::new();
        collect(&equation.left, &mut calls);
        collect(&equation.right, &mut calls);
        for (call, function, argument) in calls {
            let Some(cosine) = cosine(of, argument).filter(|value| *value < 0.0) else { continue };
            let name = equation.text.get(call.start..call.end).unwrap_or_default();
            let number = index + 1;
            let (is, not) = (significant(cosine, 3), significant(-cosine, 3));
            // The same call may stand in several terms: its place in the line tells which.
            let before = equation.text.get(..call.start).unwrap_or_default();
            let which = before.matches(name).count() + 1;
            let which =
                if equation.text.matches(name).count() > 1 { format!(" no. {which}") } else { String::new() };
            let about = if function == Function::Cos {
                format!("it is {is} there, not {not}")
            } else {
                format!("its slope there is {is}, not {not}")
            };
            let mistake = Mistake {
                kind: MistakeKind::PointSign,
                words: format!(
                    "`{name}`{which} of equation {number} has the wrong sign at the operating point ({about})"
                ),
                change: format!("equation {number}: {name} -> -{name}{which}"),
                places: vec![Place { equation: index, start: call.start, end: call.end }],
            };
            let result = of.with_node(index, (call.start, call.end), &negated);
            all.extend(result.map(|function| (mistake, function)));
        }
    }
    all
}

/// Of the argument at the operating point: the value of a cos, the slope of a sin.
fn cosine(of: &Derivation<'_>, argument: &Expression) -> Option<f64> {
    let lookup = |name: &str, primes: u8| of.at.lookup(of.parameters, name, primes);
    Exact::evaluate(argument, &lookup).ok().map(|value| value.to_f64().cos())
}

fn collect<'a>(node: &'a Expression, calls: &mut Vec<(&'a Expression, Function, &'a Expression)>) {
    if let NodeKind::Call(function @ (Function::Sin | Function::Cos), argument) = &node.kind {
        calls.push((node, *function, argument));
    }
    node.children().for_each(|child| collect(child, calls));
}
