//! Who else of the class has the numbers that an answer is right for: told to the instructor alone.

use super::numbers::light_reference;
use super::{ClassJob, Marked};
use crate::grading::other_variant::{
    Numbers, near_fields, right_fields, right_numbers, typed_numbers, weigh, wrong_fields,
};
use crate::grading::{Catalogue, grade};
use crate::lab::{Variant, VariantRule, folded_id};
use crate::submission::{NoFiles, read};
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};

/// Answers that are wrong for a student's own numbers, and right for those of other students.
#[derive(Clone, Debug, PartialEq)]
pub struct OtherVariant {
    /// Ids of those who have these numbers.
    pub students: Vec<String>,
    /// (parameter, value as typed).
    pub parameters: Vec<(String, String)>,
    /// Fields that are right by them.
    pub fields: Vec<String>,
    /// At most so likely by chance, for a wrong answer of this kind.
    pub chance: f64,
}

/// Looked at more closely for each submission, the likeliest first.
const MOST_CANDIDATES: usize = 3;
/// Ids that are named; there may be more.
const MOST_NAMED: usize = 10;

/// The numbers of everybody in the class and on the roster.
pub struct Others {
    ids: BTreeMap<Variant, Vec<String>>,
    /// What is right by each of them, when it was first needed.
    right: Option<BTreeMap<Variant, Numbers>>,
}

impl Others {
    /// Reads who is in the class; nobody when the lab has the same numbers for everyone.
    pub fn new(job: &ClassJob<'_>) -> Self {
        let mut ids: BTreeMap<Variant, Vec<String>> = BTreeMap::new();
        let Some(rule) = &job.lab.variants else { return Self { ids, right: None } };
        let students = |file: &super::AnswerFile| -> Vec<String> {
            let Ok(bytes) = file.read_capped() else { return Vec::new() };
            // An answer file that makes reading fail is told of when it is marked.
            let read = || read(&file.id, &file.name, &bytes, &job.lab.sheet, &NoFiles);
            let read = std::panic::catch_unwind(std::panic::AssertUnwindSafe(read));
            read.map_or_else(
                |_| Vec::new(),
                |one| one.students.into_iter().map(|student| student.id).collect(),
            )
        };
        let in_class: Vec<String> = job.intake.files.par_iter().flat_map_iter(students).collect();
        let listed = job.roster.iter().flat_map(|roster| &roster.students).map(|student| student.id.clone());
        let mut seen = BTreeSet::new();
        for id in in_class.into_iter().chain(listed) {
            if seen.insert(folded_id(&id))
                && let Some(variant) = rule.of(&id)
            {
                ids.entry(variant).or_default().push(id);
            }
        }
        Self { ids, right: None }
    }

    /// Who has which numbers, as text.
    pub fn fingerprint(&self) -> String {
        format!("{:?}", self.ids)
    }

    /// Finds for each submission whose numbers its wrong answers are right for.
    pub fn point_out(&mut self, job: &ClassJob<'_>, marked: &mut [Marked]) {
        let Some(rule) = &job.lab.variants else { return };
        let wrong: Vec<(usize, BTreeSet<String>)> = marked
            .iter()
            .enumerate()
            .filter(|(_, one)| !one.failed && one.variant.is_some())
            .map(|(place, one)| (place, wrong_fields(job.lab, &one.scorecard)))
            .filter(|(_, fields)| !fields.is_empty())
            .collect();
        if wrong.is_empty() {
            return;
        }
        let ids = &self.ids;
        let right = self.right.get_or_insert_with(|| {
            let numbers = ids.par_iter().filter_map(|(variant, _)| {
                let (lab, reference) = light_reference(job.lab, variant)?;
                Some((variant.clone(), right_numbers(&lab, &reference)))
            });
            numbers.collect()
        });
        let found: Vec<(usize, Vec<OtherVariant>)> = wrong
            .into_par_iter()
            .map(|(place, fields)| (place, others_of(job, rule, ids, right, &marked[place], &fields)))
            .collect();
        for (place, others) in found {
            marked[place].other_variants = others;
        }
    }
}

fn others_of(
    job: &ClassJob<'_>,
    rule: &VariantRule,
    ids: &BTreeMap<Variant, Vec<String>>,
    right: &BTreeMap<Variant, Numbers>,
    marked: &Marked,
    fields: &BTreeSet<String>,
) -> Vec<OtherVariant> {
    let Some(own) = &marked.variant else { return Vec::new() };
    let Some(own_numbers) = right.get(own) else { return Vec::new() };
    let members: BTreeSet<Variant> =
        marked.submission.students.iter().filter_map(|student| rule.of(&student.id)).collect();
    let typed = typed_numbers(job.lab, &marked.submission);
    let mut candidates: Vec<(usize, &Variant, BTreeSet<String>)> = right
        .iter()
        .filter(|(variant, _)| !members.contains(*variant) && *variant != own)
        .map(|(variant, numbers)| (variant, near_fields(&typed, numbers, fields)))
        .filter(|(_, near)| !near.is_empty())
        .map(|(variant, near)| (near.len(), variant, near))
        .collect();
    candidates.sort_by(|a, b| b.0.cmp(&a.0).then(a.1.cmp(b.1)));
    let mut others = Vec::new();
    for (_, variant, near) in candidates.into_iter().take(MOST_CANDIDATES) {
        let Some((lab, reference)) = light_reference(job.lab, variant) else { continue };
        let card = grade(&lab, &reference, &Catalogue::default(), &marked.submission, None);
        let right_by_them = right_fields(job.lab, &card, &near);
        let differing = own.differing(variant);
        let alike = right.keys().filter(|other| own.differing(other) == differing).count();
        let Some(numbers) = right.get(variant) else { continue };
        if let Some(evidence) = weigh(job.lab, own_numbers, numbers, &right_by_them, differing.len(), alike) {
            let pairs = rule.values(variant).into_iter();
            let students = ids.get(variant).into_iter().flatten();
            others.push(OtherVariant {
                students: students.take(MOST_NAMED).cloned().collect(),
                parameters: pairs.map(|(name, value)| (name.to_owned(), value.to_owned())).collect(),
                fields: evidence.fields,
                chance: evidence.chance,
            });
        }
    }
    others
}
