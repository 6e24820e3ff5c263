//! Students and what they answer: right, with a mistake of the catalogue, with a slip, or nothing.

use polemark::algebra::{Polynomial, Rational, significant};
use polemark::lab::{LabDefinition, SystemRef};
use polemark::lti::{InputKind, Response, Stability, TransferFunction, stability};
use polemark::reference::Reference;
use polemark::submission::{AnswerValue, AnsweredIn, Field, FieldKind};
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// A class that can be asked for any of its students; the same seed gives the same ones.
pub struct Class<'a> {
    lab: &'a LabDefinition,
    seed: u64,
    /// Right functions and wrong ones of every system that something is asked about.
    systems: BTreeMap<(String, String), System>,
}

struct System {
    right: Vec<TransferFunction>,
    wrong: Vec<TransferFunction>,
}

/// One student and what they hand in.
pub struct Student {
    pub id: String,
    pub given: String,
    pub family: String,
    /// The answer file.
    pub answers: String,
    /// (name, content) of the files it names; no two students' have the same name.
    pub attachments: Vec<(String, Vec<u8>)>,
    pub late: bool,
}

impl Student {
    pub fn name(&self) -> String {
        format!("{} {}", self.given, self.family)
    }
}

const GIVEN: &[&str] = &[
    "Jane", "José", "Sinéad", "Lei", "Aylin", "Björn", "Chidi", "Divya", "Émile", "Fatima", "Giulia",
    "Hiroshi", "Ingrid", "Jörg", "Kwame", "Łukasz", "Mei-Ling", "Nikos", "Olga", "Pedro", "Quynh", "Rania",
    "Søren", "Tariq", "Uma", "Victor", "Wanjiru", "Xavier", "Yusuf", "Zoë", "محمد", "ליאת",
];
const FAMILY: &[&str] = &[
    "Doe",
    "Núñez",
    "O'Brien",
    "Li",
    "Yılmaz",
    "Ångström",
    "Okafor",
    "Sharma",
    "d'Arc",
    "Al Zahra",
    "Rossi",
    "Tanaka",
    "van den Berg",
    "Müller",
    "Mensah",
    "Kowalski",
    "Chen",
    "Papadopoulos",
    "Ivanova",
    "García Márquez",
    "Nguyen",
    "Haddad",
    "Kierkegaard",
    "Hussain",
    "Patel",
    "Hugo",
    "Mwangi",
    "Smith-Jones",
    "Demir",
    "Bakker",
    "علي",
    "כהן",
];

impl<'a> Class<'a> {
    pub fn new(lab: &'a LabDefinition, reference: &Reference, seed: u64) -> Self {
        let mut systems = BTreeMap::new();
        for model in &reference.models {
            let Some(definition) = lab.models.iter().find(|one| one.id == model.id) else { continue };
            for point in &model.operating_points {
                let Some(of) = definition.operating_points.iter().find(|one| one.id == point.id) else {
                    continue;
                };
                let right: Vec<TransferFunction> =
                    point.accepted.iter().map(|one| one.linearization.transfer_function.clone()).collect();
                let derivation = definition.derivation(of, &lab.parameters);
                let mistakes = derivation.mistakes();
                let wrong = mistakes.iter().filter_map(|mistake| derivation.function(&[mistake]));
                let wrong =
                    wrong.map(|one| one.cancelled().0).filter(|one| one.den.degree() > 0).take(40).collect();
                systems.insert((model.id.clone(), point.id.clone()), System { right, wrong });
            }
        }
        Self { lab, seed, systems }
    }

    /// The student of a number, from 0.
    pub fn student(&self, number: usize) -> Student {
        let (given, family) =
            (GIVEN[number % GIVEN.len()], FAMILY[(number / GIVEN.len() + number) % FAMILY.len()]);
        let more = number / (GIVEN.len() * FAMILY.len());
        let mut student = Student {
            id: format!("EE-{:05}", number + 1),
            given: if more == 0 { given.to_owned() } else { format!("{given} {}", roman(more)) },
            family: family.to_owned(),
            answers: String::new(),
            attachments: Vec::new(),
            late: number % 7 == 3,
        };
        let mut writer = Writer {
            class: self,
            chance: Chance(self.seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ (number as u64) << 1),
            own: BTreeMap::new(),
            student: &mut student,
        };
        writer.answers();
        student
    }

    /// What a student hands in under other people's names too.
    pub fn with_students(&self, student: &Student, all: &[&Student]) -> String {
        let each = all.iter().map(|one| format!("  - {{id: {}, name: {}}}\n", one.id, quoted(&one.name())));
        let own = format!("student: {{id: {}, name: {}}}\n", student.id, quoted(&student.name()));
        student.answers.replacen(&own, &format!("students:\n{}", each.collect::<String>()), 1)
    }
}

fn roman(number: usize) -> String {
    "I".repeat(number)
}

struct Writer<'a> {
    class: &'a Class<'a>,
    chance: Chance,
    /// What the student takes each system for.
    own: BTreeMap<(String, String), TransferFunction>,
    student: &'a mut Student,
}

impl Writer<'_> {
    fn answers(&mut self) {
        let lab = self.class.lab;
        for (place, system) in &self.class.systems {
            let own = match self.chance.below(20) {
                0..=10 => pick(&mut self.chance, &system.right),
                11..=16 => pick(&mut self.chance, &system.wrong).or_else(|| system.right.first()),
                _ => None,
            };
            let own = match (own, system.right.first()) {
                (Some(own), _) => own.clone(),
                (None, Some(right)) => self.slipped(right),
                (None, None) => continue,
            };
            self.own.insert(place.clone(), own);
        }
        let head = format!(
            "lab: {}\nstudent: {{id: {}, name: {}}}\nanswers:\n",
            lab.id,
            self.student.id,
            quoted(&self.student.name())
        );
        self.student.answers.push_str(&head);
        for field in &lab.sheet.fields {
            // Now and then something is left out.
            if self.chance.below(16) == 0 {
                continue;
            }
            if let Some(answer) = self.answer(field) {
                let _ = writeln!(self.student.answers, "  {}: {answer}", field.path);
            }
        }
    }

    /// One coefficient with the wrong sign, ten times too large, or left out.
    fn slipped(&mut self, right: &TransferFunction) -> TransferFunction {
        let mut den = right.den.coefficients().to_vec();
        let place = self.chance.below(den.len());
        den[place] = match self.chance.below(3) {
            0 => -den[place].clone(),
            1 => den[place].clone() * Rational::from(10),
            _ if place > 0 => Rational::ZERO,
            _ => den[place].clone() / Rational::from(10),
        };
        let den = Polynomial::new(den);
        if den.is_zero() { right.clone() } else { TransferFunction { num: right.num.clone(), den } }
    }

    fn own(&self, field: &Field) -> Option<&TransferFunction> {
        let criteria = self.class.lab.questions.iter().flat_map(|question| &question.criteria);
        let of: &SystemRef =
            criteria.filter(|one| one.field == field.path).find_map(|one| one.check.system())?;
        self.own.get(&(of.model.clone(), of.operating_point.clone()))
    }

    /// As it stands in the file; `None` where nothing is answered.
    fn answer(&mut self, field: &Field) -> Option<String> {
        let model = self.class.lab.model_answer.answers.get(&field.path);
        let own = self.own(field).cloned();
        let figures = 3 + self.chance.below(4);
        match (field.kind, own) {
            (FieldKind::TransferFunction, Some(own)) if !self.wants_letters(field) => {
                let scale = [1.0, 1.0, 10.0, -1.0][self.chance.below(4)];
                let typed = |polynomial: &Polynomial| -> String {
                    let all =
                        polynomial.to_f64().into_iter().map(|value| significant(value * scale, figures));
                    all.collect::<Vec<_>>().join(", ")
                };
                Some(format!("{{num: [{}], den: [{}]}}", typed(&own.num), typed(&own.den)))
            }
            (FieldKind::Poles, Some(own)) => {
                let poles = own.poles().ok()?;
                let upper = poles.iter().filter(|pole| pole.im >= 0.0).map(|pole| match pole.im > 0.0 {
                    true => format!("{} ± {}j", significant(pole.re, figures), significant(pole.im, figures)),
                    false => significant(pole.re, figures),
                });
                let mut poles = upper.collect::<Vec<_>>().join(", ");
                // Nor is everything typed as it was meant.
                if self.chance.below(30) == 0 {
                    poles.push_str(", 2..1");
                }
                Some(format!("[{poles}]"))
            }
            (FieldKind::Stability, Some(own)) if self.chance.below(5) > 0 => Some(
                match stability(&own.den) {
                    Stability::AsymptoticallyStable => "stable",
                    Stability::MarginallyStable => "marginally stable",
                    Stability::Unstable => "unstable",
                }
                .to_owned(),
            ),
            (FieldKind::Stability, _) => Some(["stable", "unstable"][self.chance.below(2)].to_owned()),
            (FieldKind::Nonlinearity, _) if self.chance.below(4) == 0 => {
                Some(["dead zone", "backlash", "saturation", "Deadband"][self.chance.below(4)].to_owned())
            }
            (FieldKind::Value, _) if self.chance.below(4) == 0 => {
                let value = 0.1 + self.chance.below(1000) as f64 / 7.0;
                Some(significant(value, figures))
            }
            (FieldKind::Prose, _) => Some(self.prose(model.map_or("", |answer| answer.text.as_str()))),
            (FieldKind::Figure, _) => None,
            (FieldKind::Data, own) => {
                let rows =
                    own.and_then(|own| self.response(&own, field.response?)).or_else(|| {
                        match &model?.value {
                            Ok(AnswerValue::Data(series)) => Some(self.again(&series.rows)),
                            _ => None,
                        }
                    })?;
                let columns = rows.first()?.len();
                let header = ["t", "y", "y2", "y3"].get(..columns)?.join(", ");
                let lines = rows
                    .iter()
                    .map(|row| row.iter().map(|value| significant(*value, 6)).collect::<Vec<_>>().join(", "));
                let table = format!("{header}\n{}\n", lines.collect::<Vec<_>>().join("\n"));
                if self.chance.below(3) == 0 {
                    return Some(format!("|\n    {}", table.trim_end().replace('\n', "\n    ")));
                }
                let name = format!("{}_{}.csv", self.student.id.to_lowercase(), field.path.replace('.', "_"));
                self.student.attachments.push((name.clone(), table.into_bytes()));
                Some(name)
            }
            _ => {
                let text = &model?.text;
                Some(if text.starts_with(['{', '[']) { text.clone() } else { quoted(text) })
            }
        }
    }

    fn wants_letters(&self, field: &Field) -> bool {
        self.class
            .lab
            .sheet
            .letters
            .get(&field.path)
            .is_some_and(|one| one.answered_in == AnsweredIn::Letters)
    }

    /// The response at times of the student's own, as a simulation prints it.
    fn response(&mut self, own: &TransferFunction, input: InputKind) -> Option<Vec<Vec<f64>>> {
        let response = Response::new(own, input).ok()?;
        let end = 5.0 + self.chance.below(20) as f64;
        let rows: Vec<Vec<f64>> =
            (0..=120).map(|step| end * f64::from(step) / 120.0).map(|t| vec![t, response.at(t)]).collect();
        rows.iter().flatten().all(|value| value.abs() < 1e12).then_some(rows)
    }

    /// A run of the lab, some of its rows, now and then of another gain.
    fn again(&mut self, rows: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let gain = [1.0, 1.0, 1.0, 1.3][self.chance.below(4)];
        let first = self.chance.below(2);
        let mut again = rows.to_vec();
        again.iter_mut().flat_map(|row| row.iter_mut().skip(1)).for_each(|value| *value *= gain);
        again.split_off(first.min(again.len().saturating_sub(1)))
    }

    /// Some sentences of the model answer, and some that anybody writes.
    fn prose(&mut self, model: &str) -> String {
        const ANYBODY: &[&str] = &[
            "This matches what we expected before the lab.",
            "The curve starts at zero and then changes slowly.",
            "It oscillates with a slowly shrinking amplitude, $A e^{-\\sigma t}\\cos\\omega t$.",
            "The amplitude decays because energy is lost to friction.",
            "The output is clipped while the input is beyond the limit.",
            "It keeps growing without bound, which the real system cannot do.",
            "The simulation agrees with our calculation within a few percent.",
            "We think the linear model is good for small deviations only.",
        ];
        let mut sentences: Vec<&str> =
            model.split_inclusive(". ").map(str::trim).filter(|one| !one.is_empty()).collect();
        sentences.retain(|_| self.chance.below(5) > 0);
        for _ in 0..=self.chance.below(3) {
            let place = self.chance.below(sentences.len() + 1);
            sentences.insert(place, ANYBODY[self.chance.below(ANYBODY.len())]);
        }
        quoted(&sentences.join(" "))
    }
}

fn pick<'a, T>(chance: &mut Chance, all: &'a [T]) -> Option<&'a T> {
    all.get(chance.below(all.len().max(1)))
}

/// JSON's strings are YAML's.
fn quoted(text: &str) -> String {
    serde_json::Value::from(text).to_string()
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
