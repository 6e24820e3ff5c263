//! Data of the embedded lab: what agrees with its curves earns the points however it was exported, what does not earns none.

use polemark::grading::{self, Catalogue};
use polemark::lab::{self, LabDefinition, Points};
use polemark::reference::{Reference, ResponseReference, SimulationReference};
use polemark::submission::{self, NoFiles};
use std::fmt::Write;

struct Bench {
    lab: LabDefinition,
    reference: Reference,
}

impl Bench {
    fn new() -> Self {
        let lab = lab::load(lab::DEFAULT).expect("the embedded lab is right");
        let reference = Reference::compute(&lab).expect("the embedded lab has a reference");
        Self { lab, reference }
    }

    fn impulse(&self, operating_point: &str) -> &ResponseReference {
        let mut points = self.reference.models.iter().flat_map(|model| &model.operating_points);
        let point = points.find(|point| point.id == operating_point).expect("it is in the lab");
        point.accepted[0].impulse.as_ref().expect("it is proper")
    }

    fn simulation(&self, id: &str) -> &SimulationReference {
        self.reference.simulations.iter().find(|one| one.id == id).expect("it is in the lab")
    }

    /// Every `step_s` from 0 to `end_s`, each value as `y` writes it.
    #[track_caller]
    fn check(&self, what: &str, field: &str, step_s: f64, end_s: f64, y: impl Fn(f64) -> String, code: &str) {
        let steps = (end_s / step_s).round() as u32;
        let mut data = String::new();
        for t in (0..=steps).map(|i| f64::from(i) * step_s) {
            writeln!(data, "      {t}, {}", y(t)).unwrap();
        }
        self.check_data(what, field, &data, code);
    }

    #[track_caller]
    fn check_data(&self, what: &str, field: &str, data: &str, code: &str) {
        let file = format!("answers:\n  {field}.data: |\n{data}");
        let submission = submission::read("plot", "plot.yaml", file.as_bytes(), &self.lab.sheet, &NoFiles);
        let card = grading::grade(&self.lab, &self.reference, &Catalogue::default(), &submission, None);
        let mut items = card.questions.iter().flat_map(|question| &question.items);
        let item = items.find(|item| item.id == format!("{field}.plot")).expect("it is in the lab");
        assert_eq!(item.code, code, "{field}, {what}: {}", item.evidence.reason);
        assert_eq!(item.earned > Points::ZERO, code == "right", "{field}, {what}");
    }
}

#[test]
fn the_curves_agree_with_themselves() {
    let bench = Bench::new();
    let (hanging, upright) = (bench.impulse("hanging"), bench.impulse("upright"));
    let backlash = bench.simulation("backlash");
    let at = |one: &ResponseReference, t: f64| one.response.at(t);
    let down = |t: f64| if t == 0.0 { "1e-16".to_owned() } else { at(hanging, t).to_string() };
    bench.check("1e-16 for 0", "hanging.response", 0.1, 5.0, down, "right");
    bench.check("rows after the span", "hanging.response", 0.1, 60.0, down, "right");
    let up = |t: f64| at(upright, t).to_string();
    bench.check("exact", "upright.response", 0.01, 0.5, up, "right");
    bench.check("exact, long after the span", "upright.response", 0.1, 10.0, up, "right");
    bench.check("two decimals", "upright.response", 0.02, 1.0, |t| format!("{:.2}", at(upright, t)), "right");
    let noisy = |t: f64| (backlash.with.at(t) + 1e-15).to_string();
    bench.check("noise beside 0", "backlash", 0.05, 12.0, noisy, "right");
    bench.check("three decimals", "backlash", 0.05, 12.0, |t| format!("{:.3}", backlash.with.at(t)), "right");
}

#[test]
fn other_curves_and_junk_do_not() {
    let bench = Bench::new();
    for (field, end_s) in [
        ("hanging.response", 5.0),
        ("upright.response", 0.5),
        ("saturation", 12.0),
        ("dead_zone", 12.0),
        ("backlash", 12.0),
    ] {
        bench.check("zeros", field, end_s / 100.0, end_s, |_| "0".to_owned(), "plot.differs");
        bench.check("zeros, long", field, end_s / 10.0, 20.0 * end_s, |_| "0.00".to_owned(), "plot.differs");
        let repeated = |last: &str| format!("{}      {last}\n", "      0, 0\n".repeat(30));
        bench.check_data("repeated zeros and a spike", field, &repeated("6, 1e9"), "plot.differs");
        bench.check_data("repeated zeros and 77", field, &repeated("5, 77"), "plot.differs");
        bench.check_data("repeated zeros", field, &"      0, 0\n".repeat(30), "plot.too_few_points");
    }
    for id in ["saturation", "dead_zone", "backlash"] {
        let without = &bench.simulation(id).without;
        for (step_s, end_s) in [(0.02, 6.0), (0.1, 12.0), (0.01, 3.0)] {
            if id == "backlash" || end_s >= 6.0 {
                let exact = |t: f64| without.at(t).to_string();
                bench.check("without it", id, step_s, end_s, exact, "plot.differs");
                let rounded = |t: f64| format!("{:.2}", without.at(t));
                bench.check("without it, two decimals", id, step_s, end_s, rounded, "plot.differs");
            }
        }
    }
}
