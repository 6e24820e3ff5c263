//! A lab with derived parameters, values at rest that are solved for, outputs and formulas in its simulation is proven.

use polemark::algebra::to_f64;
use polemark::lab::LabDefinition;
use polemark::proof::prove;
use polemark::reference::Reference;
use polemark::source::SourceText;

const LAB: &str = include_str!("held_ball.yaml");

#[test]
fn a_ball_held_by_a_magnet_is_proven() {
    let lab = LabDefinition::parse(SourceText::new("held_ball.yaml", LAB)).expect("the lab parses");
    let reference = Reference::compute(&lab).expect("the lab has a reference");
    let checks = prove(&lab, &reference);
    let failed: Vec<_> = checks.iter().filter(|check| !check.holds).map(|c| (&c.what, &c.found)).collect();
    assert!(failed.is_empty(), "{failed:#?}");

    // n²/4·10⁷; and by hand i = x √(m g/C) = 20 x, x = i/20.
    let strength = lab.parameters.iter().find(|p| p.name == "C").expect("it is there");
    assert_eq!(to_f64(&strength.value), 0.001);
    let points = reference.models.iter().flat_map(|model| &model.operating_points);
    let found: Vec<_> = points.map(|point| point.equilibrium_text.clone()).collect();
    let text = |name: &str, text: &str| (name.to_owned(), text.to_owned());
    assert_eq!(found[0], [text("x", "0.01"), text("i", "0.2")]);
    assert_eq!(found[1], [text("x", "0.015"), text("i", "0.3"), text("v", "0")]);
    // Nothing is said of a comparison, so it is chosen.
    let mut points = reference.models.iter().flat_map(|model| &model.operating_points);
    assert!(points.all(|point| point.comparison.as_ref().is_some_and(|c| c.parting_push.is_some())));
}
