//! A lab with every block that switches is proven, and its simulations are shown.

use polemark::lab::LabDefinition;
use polemark::proof::prove;
use polemark::reference::Reference;
use polemark::source::SourceText;

const LAB: &str = include_str!("switches.yaml");

#[test]
fn every_block_that_switches_is_proven() {
    let lab = LabDefinition::parse(SourceText::new("switches.yaml", LAB)).expect("the lab parses");
    let reference = Reference::compute(&lab).expect("the lab has a reference");
    let checks = prove(&lab, &reference);
    let failed: Vec<_> = checks.iter().filter(|check| !check.holds).map(|c| (&c.what, &c.found)).collect();
    assert!(failed.is_empty(), "{failed:#?}");
    assert_eq!(checks.iter().filter(|check| check.what.contains("with the nonlinearity")).count(), 6);

    // Upright steps: two samples at each instant the output jumps.
    let staircase = reference.simulations.iter().find(|s| s.id == "staircase").expect("it is there");
    let jumps = staircase.with.jumps();
    assert_eq!(jumps, staircase.with.switch_times);
    for jump in jumps {
        let there: Vec<f64> = staircase.samples.iter().filter(|s| s.0 == jump).map(|s| s.2).collect();
        assert!(there.len() == 2 && (there[1] - there[0]).abs() == 0.5, "{there:?} at {jump}");
    }
}
