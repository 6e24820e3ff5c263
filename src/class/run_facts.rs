use super::fingerprint::{Fingerprint, fingerprint};
use super::kept::program_hash;
use super::results::ResultsFacts;
use super::run::ClassJob;
use crate::lab::{CoverSource, LabDefinition, Release};
use serde::{Deserialize, Serialize};
use std::path::Path;

/// `run.json`: with what the results beside it were made, and what of the lab is needed to read them without it.
///
/// The same input gives the same bytes: no time, no path. Fields may be added, never renamed.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RunFacts {
    pub program: ProgramFacts,
    pub lab: LabFacts,
    /// Tells whether the marks file is what it was; null without one.
    #[serde(default)]
    pub marks: Option<String>,
    /// Tells whether the list of students is what it was; null without one.
    #[serde(default)]
    pub roster: Option<String>,
    /// What students get to see; null where an older polemark wrote the reports.
    #[serde(default)]
    pub release: Option<Release>,
    /// Tells whether the results are as they were written; null where an older polemark wrote them.
    #[serde(default)]
    pub results: Option<ResultsFacts>,
}

#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct ProgramFacts {
    pub version: String,
    /// Of the program's own file; empty when it cannot be read.
    pub hash: String,
}

#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct LabFacts {
    pub id: String,
    pub title: String,
    pub hash: String,
    /// Criteria, in the lab's order.
    #[serde(default)]
    pub items: Vec<PartFacts>,
    /// Rows of the observation sheet.
    #[serde(default)]
    pub observed: Vec<PartFacts>,
    /// Boxes of the cover sheet that a person fills.
    #[serde(default)]
    pub by_hand: Vec<PartFacts>,
}

/// Something that points are given for.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PartFacts {
    pub id: String,
    pub title: String,
    /// Points, as written: `2.5`.
    pub possible: String,
    /// What earns how many points, the best first; of observed rows only.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub levels: Vec<LevelFacts>,
}

#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct LevelFacts {
    /// `3–4`, or `5`.
    pub points: String,
    pub title: String,
    pub text: String,
}

impl RunFacts {
    pub fn of(job: &ClassJob<'_>, results: ResultsFacts) -> Self {
        let shown = |what: &dyn std::fmt::Debug| fingerprint(format!("{what:?}"));
        Self {
            program: ProgramFacts {
                version: env!("CARGO_PKG_VERSION").to_owned(),
                hash: program_hash().unwrap_or_default().to_owned(),
            },
            lab: LabFacts::of(job.lab),
            marks: job.marks.map(|marks| shown(marks)),
            roster: job.roster.map(|roster| shown(roster)),
            release: Some(job.release),
            results: Some(results),
        }
    }

    /// Those of the results in this file; `None` where there are none that can be read.
    pub fn beside(results: &Path) -> Option<Self> {
        let text = std::fs::read_to_string(results.with_file_name("run.json")).ok()?;
        serde_json::from_str(&text).ok()
    }

    /// As it stands in the file.
    pub fn to_text(&self) -> Result<String, serde_json::Error> {
        Ok(serde_json::to_string_pretty(self)? + "\n")
    }
}

impl LabFacts {
    fn of(lab: &LabDefinition) -> Self {
        let part = |id: &str, title: &str, points: crate::lab::Points| PartFacts {
            id: id.to_owned(),
            title: title.to_owned(),
            possible: points.to_string(),
            levels: Vec::new(),
        };
        let criteria = lab.questions.iter().flat_map(|question| {
            question.criteria.iter().map(move |criterion| {
                part(&criterion.id, &format!("{} – {}", question.number, criterion.title), criterion.points)
            })
        });
        let observed = lab.observed.iter().map(|row| {
            let levels = row.levels.iter().map(|level| LevelFacts {
                points: match level.from == level.to {
                    true => level.from.to_string(),
                    false => format!("{}–{}", level.from, level.to),
                },
                title: level.title.clone(),
                text: level.text.clone(),
            });
            PartFacts { levels: levels.collect(), ..part(&row.id, &row.title, row.points) }
        });
        let by_hand = lab.cover.rows.iter().filter(|row| row.from == CoverSource::ByHand);
        Self {
            id: lab.id.clone(),
            title: lab.title.clone(),
            hash: Fingerprint::default().with(&lab.text.text).hex(),
            items: criteria.collect(),
            observed: observed.collect(),
            by_hand: by_hand.map(|row| part(&row.id, &row.title, row.points)).collect(),
        }
    }
}
