//! Values with their units and conventions, from the lab file to the mark.

use crate::bench::Bench;
use polemark::proof::prove;
use polemark::submission::{NoFiles, read, self_check};

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

/// Field, what is typed, points in hundredths, code, and a part of the reason.
#[track_caller]
fn check(rows: &[(&str, &str, i64, &str, &str)]) {
    let bench = Bench::oscillator();
    for (field, typed, points, code, reason) in rows {
        let items = bench.mark(&format!("  {field}: \"{typed}\"\n"));
        let item = items.iter().find(|item| item.id == *field).unwrap();
        let said = &item.evidence.reason;
        assert_eq!((item.earned.0, item.code), (*points, *code), "{field}: {typed}: {said}");
        assert!(said.contains(reason), "{field}: {typed}: {said}");
    }
}

#[test]
fn both_sides_of_each_end() {
    check(&[
        // 1.5708 s ± 1 %: 1.55509 to 1.58650, and π/2 to two figures or more
        ("motion.period", "1.5551", 100, "right", ""),
        ("motion.period", "1.5550", 0, "value.differs", "off by 1.01 %"),
        ("motion.period", "1.5865", 100, "right", ""),
        ("motion.period", "1.5866", 0, "value.differs", ""),
        ("motion.period", "1.6", 100, "right", "correctly rounded"),
        ("motion.period", "1.60", 0, "value.differs", ""),
        ("motion.period", "2", 0, "value.differs", ""),
        ("motion.period", "1.6e3 ms", 100, "right", "1.6e3 ms is 1.6 s"),
        ("motion.period", "1600 ms", 100, "right", "correctly rounded"),
        ("motion.period", "1600.0 ms", 0, "value.differs", ""),
        ("motion.period", "1555.1 ms", 100, "right", ""),
        ("motion.period", "1555.0 ms", 0, "value.differs", ""),
        // 4 rad/s ± 1 % is 0.630253… to 0.642986… Hz
        ("motion.frequency", "0.63026 Hz", 100, "right", ""),
        ("motion.frequency", "0.63025 Hz", 0, "value.differs", ""),
        ("motion.frequency", "0.64298 Hz", 100, "right", ""),
        ("motion.frequency", "0.64299 Hz", 0, "value.differs", ""),
        ("motion.frequency", "3.96", 100, "right", ""),
        ("motion.frequency", "3.9599999", 0, "value.differs", ""),
        // 0, to a thousandth of the largest displacement, 0.0499 m
        ("motion.limit", "0.0000498", 100, "right", ""),
        ("motion.limit", "-0.0000498", 100, "right", ""),
        ("motion.limit", "0.00005", 0, "value.differs", ""),
        ("motion.limit", "0.0498 mm", 100, "right", "0.0498 mm is 4.98e-5 m"),
        ("motion.limit", "0.05 mm", 0, "value.differs", ""),
        ("step.final_value", "1.98", 100, "right", ""),
        ("step.final_value", "1.979", 0, "value.differs", ""),
        ("step.final_value", "0.0202 m", 100, "right", ""),
        ("step.final_value", "0.02021 m", 0, "value.differs", ""),
    ]);
}

#[test]
fn units_are_converted_and_named() {
    check(&[
        ("motion.period", "1.5708 s", 100, "right", "It is within the tolerance of 1.5708 s."),
        (
            "motion.period",
            "1571 ms",
            100,
            "right",
            "1571 ms is 1.571 s: it is within the tolerance of 1.5708 s.",
        ),
        ("motion.period", "0.02618 min", 100, "right", ""),
        ("motion.period", "1571", 0, "value.other_unit", "1571 is the value in ms; it was asked in s"),
        ("motion.period", "1.5708 ms", 0, "value.other_unit", "1.5708 is the value in s, but ms was written"),
        (
            "motion.period",
            "1.5708 rad",
            0,
            "value.unit",
            "The number is right, but its unit is not: rad is a unit of angle",
        ),
        ("motion.period", "0 rad", 0, "value.differs", ""),
        ("motion.frequency", "4 rad s^-1", 100, "right", ""),
        ("motion.frequency", "4 1/s", 100, "right", ""),
        ("motion.frequency", "0.6366 Hz", 100, "right", ""),
        ("motion.frequency", "38.2 rpm", 100, "right", ""),
        ("motion.frequency", "229.18 deg/s", 100, "right", ""),
        (
            "motion.frequency",
            "0.6366",
            0,
            "value.other_unit",
            "0.6366 is the value in Hz; it was asked in rad/s",
        ),
        ("motion.frequency", "38.2", 0, "value.other_unit", "in rpm"),
        ("motion.frequency", "0.6366 rad/s", 0, "value.other_unit", "0.6366 is the value in Hz"),
        ("motion.frequency", "4 Hz", 0, "value.other_unit", "4 is the value in rad/s, but Hz was written"),
        (
            "motion.frequency",
            "4 m",
            0,
            "value.unit",
            "m is a unit of length, and a frequency in rad/s was asked",
        ),
        ("motion.frequency", "-4", 0, "value.sign", ""),
        ("motion.natural", "0.796", 100, "right", ""),
        ("motion.natural", "5 rad/s", 100, "right", "5 rad/s is 0.79577 Hz"),
        ("motion.natural", "0.796 1/s", 100, "right", ""),
        ("motion.natural", "5", 0, "value.other_unit", "5 is the value in rad/s; it was asked in Hz"),
        ("motion.damping", "60 %", 100, "right", "60 % is 0.6"),
        (
            "motion.damping",
            "60",
            0,
            "value.other_unit",
            "60 is the value in %; it was asked as a pure number",
        ),
        ("motion.damping", "0.6 rad", 0, "value.unit", "a pure number was asked"),
        ("motion.peak", "4.99 cm", 100, "right", ""),
        ("motion.peak", "4.99", 0, "value.other_unit", "in cm"),
        // Per unit of the impulse, or of the input
        ("motion.peak", "0.0499 m/(N s)", 100, "right", ""),
        ("motion.peak", "0.0499 m/N", 100, "right", ""),
        ("motion.peak", "0.0499 N", 0, "value.unit", "N is a unit of force"),
        ("motion.limit", "0 s", 100, "right", ""),
        ("step.final_value", "0.02 m", 100, "right", "0.02 m is 2 cm"),
        ("step.final_value", "0.02", 0, "value.other_unit", "0.02 is the value in m; it was asked in cm"),
        ("step.overshoot", "9.5 %", 100, "right", ""),
        ("step.overshoot", "0.0948", 0, "value.other_unit", "0.0948 is the value as a ratio"),
        ("step.overshoot", "0.0948 %", 0, "value.other_unit", "but % was written"),
        ("motion.period", "1.57 apples", 0, "unreadable", "`apples` is not a unit"),
        ("motion.period", "unbounded", 0, "value.number_given_unbounded", ""),
    ]);
}

#[test]
fn other_conventions_are_named() {
    check(&[
        ("step.settling_2", "1.189", 200, "right", ""),
        (
            "step.settling_2",
            "1.046",
            100,
            "value.other_convention",
            "1.046 is the settling time to within 5 %; the settling time to within 2 % was asked, and that is 1.1886 s.",
        ),
        (
            "step.settling_2",
            "1046 ms",
            100,
            "value.other_convention",
            "1046 ms is the settling time to within 5 %",
        ),
        ("step.settling_2", "1.333", 100, "value.other_convention", "four time constants"),
        ("step.settling_2", "1.000", 100, "value.other_convention", "three time constants"),
        ("step.settling_2", "-1.046", 0, "value.differs", ""),
        ("step.settling_5", "1.046", 200, "right", ""),
        ("step.settling_5", "1.189", 0, "value.other_convention", "to within 2 %"),
        ("step.rise", "0.371", 100, "right", ""),
        ("step.rise", "0.5536", 0, "value.other_convention", "from 0 to 100 %"),
        ("step.rise_whole", "0.371", 0, "value.other_convention", "from 10 % to 90 %"),
        ("motion.frequency", "5", 50, "value.other_convention", "5 is the natural frequency"),
        ("motion.frequency", "0.7958 Hz", 50, "value.other_convention", "0.7958 Hz is the natural frequency"),
        ("motion.natural", "0.6366", 0, "value.other_convention", "the natural frequency was asked"),
    ]);
}

/// What `check` says of a file, a student's own check before the deadline: of units nothing, and never what would be right.
#[test]
fn check_says_nothing_of_units() {
    let bench = Bench::oscillator();
    for typed in ["1.5708", "1.5708 ms", "4 m", "0.889 Hz", "17 apples"] {
        let file = format!("lab: oscillator\nstudent: x\nanswers:\n  motion.period: {typed}\n");
        let submission = read("x", "x.yaml", file.as_bytes(), &bench.lab.sheet, &NoFiles);
        let unreadable = typed.ends_with("apples");
        assert_eq!(submission.findings.len(), usize::from(unreadable), "{typed}: {:?}", submission.findings);
        let said = self_check(&submission, &bench.lab.sheet);
        assert!(said.iter().all(|finding| finding.code == "answer.missing"), "{typed}: {said:?}");
    }
}

#[test]
fn the_template_says_the_unit() {
    let template = Bench::oscillator().lab.answer_template();
    for line in [
        "a number in s, or unbounded",
        "a number in Hz, or unbounded",
        "a number in cm",
        "a number in %",
        "#   a number, or",
    ] {
        assert!(template.contains(line), "{line}\n{template}");
    }
}
