//! Values with their units and conventions, from the lab file to the mark.

use crate::bench::Bench;
use polemark::proof::prove;

/// Its model answer is written in every unit it may be: `2 cm`, `785.4 ms`, `9.48 %`.
#[test]
fn a_lab_of_features_is_proven() {
    let bench = Bench::oscillator();
    let failed: Vec<String> = prove(&bench.lab, &bench.reference)
        .into_iter()
        .filter(|check| !check.holds)
        .map(|check| format!("{}: {}", check.what, check.found))
        .collect();
    assert!(failed.is_empty(), "{failed:#?}");
}

#[track_caller]
fn check(rows: &[(&str, &str, i64, &str, &str)]) {
    let bench = Bench::oscillator();
    for (field, typed, points, code, reason) in rows {
        let items = bench.mark(&format!("  {field}: \"{typed}\"\n"));
        let item = items.iter().find(|item| item.id == *field).unwrap();
        let found = (item.earned.0, item.code, item.evidence.reason.as_str());
        assert_eq!(found, (*points, *code, *reason), "{field}: {typed}");
    }
}

#[test]
fn units_are_converted_and_named() {
    check(&[
        // field, typed, points, code, reason
        ("motion.period", "1.5708", 100, "right", "It is within the tolerance of 1.5708 s."),
    ]);
}
