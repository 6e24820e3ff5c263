use crate::class::run_facts::RunFacts;
use crate::class::{Record, Results, ResultsError, Status};
use crate::lab::Points;
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::path::Path;

/// How a class stood after a run: as much of its records as a comparison needs, some kilobytes a student.
#[derive(Clone, Debug, Default)]
pub struct Standing {
    /// Absent where an older polemark left none.
    pub facts: Option<RunFacts>,
    /// By id, and which of several submissions of it.
    pub(super) students: BTreeMap<(String, usize), One>,
    names: Vec<String>,
    by_name: BTreeMap<String, u32>,
}

/// One student.
#[derive(Clone, Debug)]
pub(super) struct One {
    pub name: String,
    pub late: bool,
    pub mark: Option<Points>,
    pub earned: Points,
    /// Of all answers.
    pub answers: [u8; 8],
    pub parts: Vec<Part>,
}

/// Something that points are given for.
#[derive(Clone, Debug)]
pub(super) struct Part {
    name: u32,
    pub points: Option<Points>,
    pub by_hand: bool,
    /// Of what is judged; zero for none.
    pub answer: [u8; 8],
}

impl Standing {
    /// From an output folder, or its `results.jsonl`.
    pub fn load(path: &Path) -> Result<Self, ResultsError> {
        let results = match path.is_dir() {
            true => Results::of_file(&path.join("results.jsonl")),
            false => Results::of_file(path),
        }?;
        let mut standing = Self::new(results.facts().cloned());
        for record in results {
            standing.add(&record?);
        }
        Ok(standing)
    }

    pub fn new(facts: Option<RunFacts>) -> Self {
        Self { facts, ..Self::default() }
    }

    /// Notes a record. Who handed nothing in is not there, and what does not count is left out.
    pub fn add(&mut self, record: &Record) {
        if matches!(record.status, Status::Missing | Status::Superseded) {
            return;
        }
        let mut parts = Vec::new();
        for item in &record.items {
            parts.push(Part {
                name: self.name(&item.id),
                points: Some(item.earned),
                by_hand: item.code == "by_hand",
                answer: item.answer.as_deref().map_or([0; 8], short),
            });
        }
        let is_by_hand = |id: &str| {
            self.facts.as_ref().is_some_and(|facts| facts.lab.by_hand.iter().any(|one| one.id == id))
        };
        let observed = record.observed.iter().map(|row| (format!("observed.{}", row.id), row.earned));
        let boxes = record.cover.iter().filter(|row| is_by_hand(&row.id));
        let boxes = boxes.map(|row| (format!("cover.{}", row.id), row.earned));
        let adjustments: Option<Points> = record.adjustments.iter().map(|one| one.points).sum();
        let given: Vec<_> = observed.chain(boxes).chain([("adjustments".to_owned(), adjustments)]).collect();
        for (name, points) in given {
            let name = self.name(&name);
            parts.push(Part { name, points, by_hand: true, answer: [0; 8] });
        }
        let one = One {
            name: String::new(),
            late: record.is_late(),
            mark: record.mark.map(|mark| mark.earned),
            earned: record.total.earned,
            answers: short(&format!("{:?}", record.answers)),
            parts,
        };
        let nobody = [(record.submission.clone(), String::new())];
        let students = record.students.iter().map(|student| (student.id.clone(), student.name.clone()));
        let students: Vec<_> = if record.students.is_empty() { nobody.to_vec() } else { students.collect() };
        for (id, name) in students {
            let mut which = 0;
            while self.students.contains_key(&(id.clone(), which)) {
                which += 1;
            }
            self.students.insert((id, which), One { name, ..one.clone() });
        }
    }

    pub(super) fn name_of(&self, part: &Part) -> &str {
        self.names.get(part.name as usize).map_or("", String::as_str)
    }

    fn name(&mut self, name: &str) -> u32 {
        if let Some(place) = self.by_name.get(name) {
            return *place;
        }
        let place = u32::try_from(self.names.len()).unwrap_or(u32::MAX);
        self.names.push(name.to_owned());
        self.by_name.insert(name.to_owned(), place);
        place
    }
}

/// Eight bytes that tell texts apart.
fn short(text: &str) -> [u8; 8] {
    let hash = Sha256::digest(text);
    let mut bytes = [0; 8];
    bytes.iter_mut().zip(hash).for_each(|(to, from)| *to = from);
    bytes
}
