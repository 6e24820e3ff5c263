//! What a person gives: read from a marks file, YAML or CSV. Nothing of it is ever written by polemark.

mod adjustment;
mod allowed;
mod decision;
mod merge;
mod table;
#[cfg(test)]
mod tests;
mod yaml;

pub use adjustment::{Adjustment, LateCost, LateRule};
pub use decision::{Given, NO_ANSWER, Override};
pub use merge::Contradiction;

use crate::lab::{LabDefinition, Points, folded_id};
use crate::names::nearest;
use crate::source::{Finding, SourceText, Span, sanitize};
use allowed::Allowed;
use std::cell::OnceCell;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// A person's decisions for groups of like answers: by criterion id, then by the group's id. Several of one group are for
/// different answers.
pub type AlikeMarks = BTreeMap<String, BTreeMap<String, Vec<Override>>>;

/// What a person gave one student.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct HandMarks {
    /// Boxes of the cover sheet that are filled by hand, by row id.
    pub cover: BTreeMap<String, Points>,
    /// Rows of the observation sheet, by row id.
    pub observed: BTreeMap<String, Points>,
    /// Criteria whose mark a person has decided, by criterion id. Several of one criterion are for different answers.
    pub items: BTreeMap<String, Vec<Override>>,
    /// Decisions for like answers of the whole class: for what is not in `items`.
    pub alike: Arc<AlikeMarks>,
    /// Points given or taken beside the cover sheet.
    pub adjustments: Vec<Adjustment>,
    /// What it costs to hand in late, the same for the whole class.
    pub late_rule: Option<LateRule>,
    /// Whether it is late, whatever the LMS says.
    pub late: Option<bool>,
}

impl HandMarks {
    /// What a person decided for a criterion worth `most`: for this student's answer, else for answers like it. One for this
    /// student that was made for another answer is only looked at when none for the group names the answer. Points out of
    /// range are not given. Of several decisions it is the last that was made for the answer, else the last. `answer` works
    /// out the hash of the answer.
    pub(super) fn given(
        &self,
        criterion: &str,
        most: Points,
        alike: Option<&str>,
        answer: &dyn Fn() -> Option<String>,
    ) -> Option<Given<'_>> {
        let own = self.items.get(criterion).map_or(&[][..], Vec::as_slice);
        let groups = || self.alike.get(criterion)?.get(alike?);
        let hash = OnceCell::new();
        let is_for =
            |given: &Override| given.answers.is_empty() || given.is_for(hash.get_or_init(answer).as_deref());
        let like = groups().map_or(&[][..], Vec::as_slice);
        let in_range = |given: &&Override| (Points::ZERO..=most).contains(&given.points);
        let latest = |decisions: &'_ [Override]| decisions.iter().rposition(|given| in_range(&given));
        let applies =
            |decisions: &'_ [Override]| decisions.iter().rposition(|given| in_range(&given) && is_for(given));
        match (applies(own).map(|at| &own[at]), latest(own).map(|at| &own[at])) {
            (Some(given), _) => Some(Given::Applies(given)),
            // One for the group takes its place only when it was made for this very answer.
            (None, Some(held)) => {
                let named = applies(like).map(|at| &like[at]).filter(|given| !given.answers.is_empty());
                Some(named.map_or(Given::Held(held), Given::Applies))
            }
            (None, None) => {
                let given = applies(like).map(|at| Given::Applies(&like[at]));
                given.or_else(|| latest(like).map(|at| Given::Held(&like[at])))
            }
        }
    }

    /// Everything in which one student's marks can differ from another's, for comparing: decisions for groups aside.
    pub fn shown(&self) -> String {
        let Self { cover, observed, items, alike: _, adjustments, late_rule, late } = self;
        format!("{:?}", (cover, observed, items, adjustments, late_rule, late))
    }
}

/// A marks file: what a person gave, by student id.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct HandMarksFile {
    /// By the folded id, with the id as it is spelled.
    students: BTreeMap<String, (String, HandMarks)>,
    /// What holds for whoever is not listed.
    others: HandMarks,
    /// Where the decisions for groups stand: (criterion, group).
    groups: BTreeMap<(String, String), Said>,
    /// Whose an answer file is, by its name, and where that is said.
    files: BTreeMap<String, (Vec<String>, Said)>,
    /// Of a student's several files the name of the one that counts, by the folded id, and where that is said.
    counts: BTreeMap<String, (String, Said)>,
    /// Where everything else is said.
    said: BTreeMap<What, Said>,
}

/// Where something is said: in which marks file, counted from 0 as they were merged, and where in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Said {
    pub file: usize,
    pub span: Span,
}

impl From<Span> for Said {
    fn from(span: Span) -> Self {
        Self { file: 0, span }
    }
}

/// What is said: folded student id (empty for the class), and criterion, box, row (`observed.<id>`) or `late`.
type What = (String, String);

impl HandMarksFile {
    /// Reads a marks file: what could be read, and a finding for everything that could not or that does not fit `lab`.
    ///
    /// A name that ends in `.csv` says that it is a table, a row a decision; anything else is YAML:
    ///
    /// ```yaml
    /// lab: ee361-lab3
    /// late: {points: 5}
    /// files:
    ///   upload.yaml: {is: EE-002}
    /// students:
    ///   EE-001:
    ///     viva: 30
    ///     observed: {realization: 4}
    ///     items:
    ///       hanging.response.plot: {points: 0.5, reason: "axes without units", answer: 3f2a91c05be7d410}
    ///     adjustments:
    ///       - {points: -5, reason: "left the bench untidy"}
    ///     counts: EE-001-second.yaml
    /// alike:
    ///   expect_hanging.settles:
    ///     text-3f2a91c0: {points: 1, reason: "says so in other words"}
    /// ```
    pub fn parse(source: &SourceText, lab: &LabDefinition) -> (Self, Vec<Finding>) {
        let allowed = Allowed::new(lab);
        let (mut file, findings) = match source.name.to_lowercase().ends_with(".csv") {
            true => table::read(source, allowed),
            false => yaml::read(source, allowed),
        };
        file.share();
        (file, findings)
    }

    /// Decisions for the class hold for everyone, listed or not.
    fn share(&mut self) {
        let (alike, late_rule) = (Arc::clone(&self.others.alike), self.others.late_rule.clone());
        for (_, marks) in self.students.values_mut() {
            marks.alike = Arc::clone(&alike);
            marks.late_rule.clone_from(&late_rule);
        }
    }

    /// However the id is spelled.
    pub fn student(&self, id: &str) -> Option<&HandMarks> {
        self.students.get(&identity(id)).map(|(_, marks)| marks)
    }

    /// What counts for a student, listed or not.
    pub fn marks_for(&self, id: &str) -> &HandMarks {
        self.student(id).unwrap_or(&self.others)
    }

    /// Decisions for groups of like answers.
    pub fn alike(&self) -> &AlikeMarks {
        &self.others.alike
    }

    /// Whose the answer file of this name is, where a person has said so.
    pub fn whose(&self, file: &str) -> Option<&[String]> {
        self.files.get(file).map(|(students, _)| students.as_slice())
    }

    /// The name of the file that counts for a student, where a person has said so.
    pub fn counts_for(&self, id: &str) -> Option<&str> {
        self.counts.get(&identity(id)).map(|(file, _)| file.as_str())
    }

    /// A warning, with the marks file it is in, for each decision about a group that is not among `groups`, the (criterion,
    /// group) of a class's answers.
    pub fn decisions_without_answers(&self, groups: &BTreeSet<(String, String)>) -> Vec<(usize, Finding)> {
        let nobody = self.groups.iter().filter(|(group, _)| !groups.contains(*group));
        let finding = |((criterion, group), said): (&(String, String), &Said)| {
            let message =
                format!("No answer of this class is in the group {} of `{criterion}`.", quoted(group));
            let finding = Finding::warning("marks.alike_nobody", message)
                .with_help("The class page lists the groups; they change with the answers and with the lab's phrases.")
                .at(said.span);
            (said.file, finding)
        };
        nobody.map(finding).collect()
    }

    /// A warning, with the marks file it is in, for each name of an answer file that is not among `names`.
    pub fn files_not_there(&self, names: &BTreeSet<&str>) -> Vec<(usize, Finding)> {
        let counts = self.counts.values().map(|(name, said)| (name.as_str(), *said));
        let said = self.files.iter().map(|(name, (_, said))| (name.as_str(), *said)).chain(counts);
        let absent = said.filter(|(name, _)| !names.contains(name));
        let finding = |(name, said): (&str, Said)| {
            let message = format!("No answer file of this class is called {}.", quoted(name));
            let help = match nearest(name, names.iter().copied()) {
                Some(near) => format!("Did you mean {}?", quoted(near)),
                None => "Give the name as the class page and results.jsonl have it.".to_owned(),
            };
            (said.file, Finding::warning("marks.no_such_file", message).with_help(help).at(said.span))
        };
        absent.map(finding).collect()
    }

    /// Students who are said to be late where nothing says what that costs.
    pub fn late_for_nothing(&self) -> impl Iterator<Item = &str> {
        let late =
            self.students.values().filter(|(_, marks)| marks.late == Some(true) && marks.late_rule.is_none());
        late.map(|(id, _)| id.as_str())
    }

    /// As they are spelled, in the order of the folded ids.
    pub fn student_ids(&self) -> impl Iterator<Item = &str> {
        self.students.values().map(|(id, _)| id.as_str())
    }
}

/// Tells students apart, however their ids are spelled.
fn identity(id: &str) -> String {
    let folded = folded_id(id);
    if folded.is_empty() { id.to_owned() } else { folded }
}

fn quoted(text: &str) -> String {
    format!("`{}`", sanitize(text))
}
