//! What the class page and the editions of a report rest on: targets, grades, what is released.

use super::super::file::{GradeFile, OutcomeFile, ReleaseFile, Text};
use super::super::{Grade, Outcome, Points, Release};
use super::{Checker, span};

impl Checker<'_> {
    pub(super) fn learning_outcome(&mut self, id: &Text, file: &OutcomeFile) -> Outcome {
        self.id(id, "outcome id");
        let target = file.target.as_ref().and_then(|text| self.fraction(text, "target"));
        Outcome { id: id.value.clone(), text: file.text.trim().to_owned(), target }
    }

    /// The highest first. `total` is what the cover sheet adds up to.
    pub(super) fn grades(&mut self, file: &[GradeFile], total: Option<Points>) -> Option<Vec<Grade>> {
        let mut grades: Vec<Grade> = Vec::new();
        for one in file {
            let (name, from) = (one.name.trim().to_owned(), self.points(&one.from)?);
            if total.is_some_and(|total| from > total) {
                let message = format!("the grade `{name}` begins at {from} points, above the total");
                self.error("lab.grades", span(&one.from), message, None);
            }
            if let Some(other) = grades.iter().find(|other| other.name == name || other.from == from) {
                let message = format!("the grades `{}` and `{name}` share a name or a boundary", other.name);
                self.error("lab.grades", span(&one.from), message, None);
            }
            grades.push(Grade { name, from });
        }
        grades.sort_by_key(|grade| std::cmp::Reverse(grade.from));
        Some(grades)
    }
}

pub(super) fn release(file: &ReleaseFile) -> Release {
    let shown = |key: Option<bool>| key.unwrap_or(true);
    Release { marks: shown(file.marks), feedback: shown(file.feedback), solutions: shown(file.solutions) }
}
