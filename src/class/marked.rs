use crate::grading::{Evidence, ItemScore, QuestionScore, Scorecard, Tally, Verdict};
use crate::lab::{LabDefinition, Points};
use crate::source::{Finding, Severity, SourceText};
use crate::submission::{Student, Submission};
use std::collections::BTreeMap;

/// A submission and what became of it.
#[derive(Clone, Debug)]
pub struct Marked {
    pub submission: Submission,
    pub scorecard: Scorecard,
    /// The report, relative to the output folder: `reports/EE-001.html`.
    pub report: String,
    /// polemark itself failed on it.
    pub failed: bool,
}

impl Marked {
    /// Criteria that wait for a person: provisional marks, and what polemark could not judge or read.
    pub fn items_to_review(&self) -> impl Iterator<Item = &ItemScore> {
        self.scorecard.questions.iter().flat_map(|question| &question.items).filter(|item| {
            item.provisional || matches!(item.verdict, Verdict::Unmarked | Verdict::Unreadable)
        })
    }
}

/// A submission of which nothing could be read, for the reason `finding` gives.
pub fn unreadable_submission(id: &str, name: &str, finding: Finding) -> Submission {
    Submission {
        id: id.to_owned(),
        source: SourceText::new(name, ""),
        lab: None,
        students: vec![Student { id: id.to_owned(), name: String::new() }],
        answers: BTreeMap::new(),
        findings: vec![finding],
        readable: false,
    }
}

/// What is said when polemark fails on a submission: nobody loses a mark for it.
pub fn our_failure() -> Finding {
    Finding {
        severity: Severity::Error,
        code: "polemark.failed",
        message: "polemark failed on this submission, which is our fault, not yours. A person will mark it."
            .to_owned(),
        help: None,
        span: None,
    }
}

/// Every criterion left to a person.
pub fn unmarked(lab: &LabDefinition) -> Scorecard {
    let questions: Vec<QuestionScore> = lab
        .questions
        .iter()
        .map(|question| QuestionScore {
            id: question.id.clone(),
            tally: Tally { possible: question.points, ..Tally::default() },
            items: question
                .criteria
                .iter()
                .map(|criterion| ItemScore {
                    id: criterion.id.clone(),
                    title: criterion.title.clone(),
                    earned: Points::ZERO,
                    possible: criterion.points,
                    verdict: Verdict::Unmarked,
                    code: "polemark.failed",
                    evidence: Evidence { reason: our_failure().message, ..Evidence::default() },
                    diagnosis: None,
                    provisional: true,
                    override_reason: None,
                    position: None,
                })
                .collect(),
        })
        .collect();
    Scorecard {
        total: Tally { possible: questions.iter().map(|q| q.tally.possible).sum(), ..Tally::default() },
        questions,
        observed: lab.observed.iter().map(|row| (row.id.clone(), None)).collect(),
        cover: lab.cover.rows.iter().map(|row| (row.id.clone(), row.points, None)).collect(),
        cover_total: None,
    }
}
