//! Writes a class of different answer files for timing `grade`: same seed, same bytes.
//!
//! ```text
//! cargo run --release --example generate_class -- class 1000 [SEED]
//! cargo run --release -- grade class --out out
//! ```
//!
//! Each file is the embedded lab's model answer with its own g, rounding, scale, slips, prose and simulated data.

use polemark::algebra::significant;
use polemark::lab;
use polemark::lti::{InputKind, Response};
use polemark::reference::Reference;
use std::fmt::Write as _;
use std::path::PathBuf;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let usage = "usage: generate_class FOLDER COUNT [SEED]";
    let folder = PathBuf::from(arguments.next().ok_or(usage)?);
    let count: usize = arguments.next().ok_or(usage)?.parse()?;
    let seed: u64 = arguments.next().map_or(Ok(1), |text| text.parse())?;

    let definition = lab::load(lab::DEFAULT)?;
    let reference = Reference::compute(&definition)?;
    std::fs::create_dir_all(&folder)?;
    for index in 0..count {
        let mut chance = Chance(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ index as u64);
        let text = answer_file(&definition, &reference, index, &mut chance)?;
        std::fs::write(folder.join(format!("student-{index:05}.yaml")), text)?;
    }
    println!("{count} answer files in {}", folder.display());
    Ok(())
}

fn answer_file(
    definition: &lab::LabDefinition,
    reference: &Reference,
    index: usize,
    chance: &mut Chance,
) -> Result<String, std::fmt::Error> {
    let mut text = format!(
        "lab: {}\nstudent: {{id: EE-{index:05}, name: Student {index:05}}}\nanswers:\n",
        definition.id
    );
    for model in &reference.models {
        for point in &model.operating_points {
            let linear = &point.accepted[chance.below(point.accepted.len())];
            let g = &linear.linearization.transfer_function;
            let scale = [1.0, 1.0, 1000.0, -1.0][chance.below(4)];
            let figures = 3 + chance.below(4);
            let slip = chance.below(4).checked_sub(1).filter(|i| *i < g.den.coefficients().len());
            let typed = |coefficients: Vec<f64>, slip: Option<usize>| -> String {
                let words: Vec<String> = coefficients
                    .iter()
                    .enumerate()
                    .map(|(i, c)| significant(if slip == Some(i) { -c } else { *c } * scale, figures))
                    .collect();
                words.join(", ")
            };
            writeln!(
                text,
                "  {}.transfer_function: {{num: [{}], den: [{}]}}",
                point.id,
                typed(g.num.to_f64(), None),
                typed(g.den.to_f64(), slip)
            )?;
            writeln!(text, "  {}.response:", point.id)?;
            let poles: Vec<String> = linear
                .poles
                .iter()
                .filter(|p| p.im >= 0.0)
                .map(|p| match p.im > 0.0 {
                    true => format!("{} ± {}j", significant(p.re, figures), significant(p.im, figures)),
                    false => significant(p.re, figures),
                })
                .collect();
            writeln!(text, "    poles: [{}]", poles.join(", "))?;
            writeln!(text, "    initial_value: 0")?;
            let stable = ["stable", "unstable"][chance.below(2)];
            writeln!(text, "    stability: {stable}")?;
            writeln!(text, "    description: |\n      {}", prose(chance, stable))?;
            if let Ok(response) = Response::new(g, InputKind::Impulse) {
                writeln!(text, "    data: |\n      t, y")?;
                let end = 5.0 + chance.below(10) as f64;
                for step in 0..=120 {
                    let t = end * f64::from(step) / 120.0;
                    writeln!(text, "      {}, {}", significant(t, 5), significant(response.at(t), 5))?;
                }
            }
        }
    }
    for question in &definition.questions {
        for field in &question.fields {
            if field.kind == polemark::submission::FieldKind::Prose
                && !field.path.ends_with("response.description")
            {
                writeln!(text, "  {}: |\n    {}", field.path, prose(chance, "stable"))?;
            }
            if field.kind == polemark::submission::FieldKind::Nonlinearity {
                let word = ["dead zone", "backlash", "saturation", "Deadband"][chance.below(4)];
                writeln!(text, "  {}: {word}", field.path)?;
            }
        }
    }
    Ok(text)
}

/// Three sentences of a student's kind, with a formula now and then.
fn prose(chance: &mut Chance, stability: &str) -> String {
    let sentences = [
        "The pendulum swings back and forth about the bottom.",
        "It oscillates with a slowly shrinking amplitude, $\\theta(t) \\approx A e^{-\\sigma t}\\cos\\omega t$.",
        "The amplitude decays because the cart loses energy to friction.",
        "It falls away from the upright position and does not come back.",
        "The speed is clipped while the voltage is beyond the limit.",
        "The motor stands still until the voltage is larger than the threshold.",
        "The output starts late and is smaller by half the gap.",
        "This matches what we expected before the lab.",
        "The curve keeps growing without bound, which a real pendulum cannot do.",
    ];
    let mut words = format!("The system is {stability}.");
    for _ in 0..3 {
        words.push(' ');
        words.push_str(sentences[chance.below(sentences.len())]);
    }
    words
}

/// SplitMix64 (Steele, Lea & Flood, 2014): small, seeded, the same everywhere.
struct Chance(u64);

impl Chance {
    fn below(&mut self, bound: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) % bound as u64) as usize
    }
}
