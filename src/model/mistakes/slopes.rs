use super::edit::{Edit, Replacement};
use super::{Derivation, Mistake, MistakeKind, Place};
use crate::algebra::{Expression, Function, NodeKind, Rational, significant, to_f64};
use crate::model::Exact;

/// The slope of each power and root taken without its exponent in front: of x² as x, of √h as 1/√h.
///
/// The value at rest, which multiplies the slopes of other factors, is right.
pub(super) fn mistakes(of: &Derivation) -> Vec<Mistake> {
    let mut all = Vec::new();
    let Ok((parameters, at)) = of.place(&of.parameters, &[]) else { return Vec::new() };
    let lookup = |name: &str, primes: u8| at.lookup(&parameters, name, primes);
    let value = |node: &Expression| Exact::evaluate(node, &lookup).ok();
    for (index, equation) in of.equations() {
        let text = |node: &Expression| equation.text.get(node.start..node.end).unwrap_or_default().trim();
        let mut found = Vec::new();
        bent(of, &equation.left, &mut found);
        bent(of, &equation.right, &mut found);
        for (node, bend) in found {
            let (factor, instead) = match bend {
                Bend::Root => (Rational::from(2), "1/2".to_owned()),
                Bend::Power(exponent) => {
                    let exponent = value(exponent);
                    match exponent.as_ref().and_then(Exact::as_rational) {
                        Some(n) if !n.is_zero() && *n != Rational::ONE => {
                            (Rational::ONE / n, significant(to_f64(n), 4))
                        }
                        _ => continue,
                    }
                }
            };
            let is_steep = node.symbols().iter().any(|symbol| {
                let slope = value(&node.differentiate(&symbol.name, 0));
                slope.is_some_and(|slope| slope.to_f64() != 0.0)
            });
            if !is_steep {
                continue;
            }
            let place = Place { equation: index, start: node.start, end: node.end };
            all.push(Slope { place, text: text(node), factor, instead });
        }
    }
    let mut mistakes: Vec<Mistake> = all.iter().map(|slope| one(of, slope)).collect();
    let mut alike: Vec<Vec<&Slope<'_>>> = Vec::new();
    let mut like_factors: Vec<Vec<&Slope<'_>>> = Vec::new();
    for slope in &all {
        match alike.iter_mut().find(|group| group[0].text == slope.text) {
            Some(group) => group.push(slope),
            None => alike.push(vec![slope]),
        }
        match like_factors.iter_mut().find(|group| group[0].factor == slope.factor) {
            Some(group) => group.push(slope),
            None => like_factors.push(vec![slope]),
        }
    }
    let several = alike.iter().filter(|group| group.len() > 1);
    mistakes.extend(several.map(|group| together(group, format!("`{}`", group[0].text), group[0].text)));
    let all_alike = |group: &&Vec<&Slope<'_>>| group.iter().any(|slope| slope.text != group[0].text);
    mistakes.extend(like_factors.iter().filter(all_alike).map(|group| {
        let mut names: Vec<&str> = Vec::new();
        group.iter().for_each(|slope| {
            if !names.contains(&slope.text) {
                names.push(slope.text);
            }
        });
        let quoted: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
        together(group, crate::english::listed(&quoted, "and"), &names.join(", "))
    }));
    mistakes
}

/// A power or a root of what moves.
struct Slope<'a> {
    place: Place,
    text: &'a str,
    /// What the slope is multiplied with when the exponent is left out,
    factor: Rational,
    /// and what is left out.
    instead: String,
}

fn one(of: &Derivation, slope: &Slope<'_>) -> Mistake {
    let (name, number) = (slope.text, slope.place.equation + 1);
    // The same power may stand in several terms: its place in the line tells which.
    let equation = of.model.equations.get(slope.place.equation).map_or("", |equation| equation.text.as_str());
    let which = equation.get(..slope.place.start).unwrap_or_default().matches(name).count() + 1;
    let which = if equation.matches(name).count() > 1 { format!(" no. {which}") } else { String::new() };
    Mistake {
        kind: MistakeKind::Slope,
        words: format!(
            "the factor {} is missing in the slope of `{name}`{which} of equation {number}",
            slope.instead
        ),
        change: format!("equation {number}: slope of {name}{which} without {}", slope.instead),
        places: vec![slope.place],
        edit: Edit::Nodes(vec![slope.place], Replacement::Slope(slope.factor.clone())),
    }
}

fn together(slopes: &[&Slope<'_>], quoted: String, names: &str) -> Mistake {
    let (factor, instead) = slopes
        .first()
        .map_or((Rational::ONE, String::new()), |slope| (slope.factor.clone(), slope.instead.clone()));
    let places: Vec<Place> = slopes.iter().map(|slope| slope.place).collect();
    Mistake {
        kind: MistakeKind::Slope,
        words: format!("the factor {instead} is missing in every slope of {quoted}"),
        change: format!("every slope of {names} without {instead}"),
        edit: Edit::Nodes(places.clone(), Replacement::Slope(factor)),
        places,
    }
}

enum Bend<'a> {
    Power(&'a Expression),
    Root,
}

/// Powers and roots of what moves, but of no rates: those are 0 at rest.
fn bent<'a>(of: &Derivation, node: &'a Expression, found: &mut Vec<(&'a Expression, Bend<'a>)>) {
    let moves = |node: &Expression| {
        let symbols = node.symbols();
        let is_signal = |name: &String| {
            of.model.coordinates.iter().any(|one| one.name == *name) || of.model.inputs.contains(name)
        };
        symbols.iter().any(|symbol| is_signal(&symbol.name))
            && symbols.iter().all(|symbol| symbol.primes == 0)
    };
    match &node.kind {
        NodeKind::Power(base, exponent) if moves(base) => found.push((node, Bend::Power(exponent))),
        NodeKind::Call(Function::Sqrt, inside) if moves(inside) => found.push((node, Bend::Root)),
        _ => {}
    }
    node.children().for_each(|child| bent(of, child, found));
}
