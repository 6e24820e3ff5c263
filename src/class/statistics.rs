use super::marked::Marked;
use super::run::Outcome;
use crate::grading::Verdict;
use crate::lab::{LabDefinition, Points};
use crate::report::{ClassRow, ClassSummary, QuestionMean, ReviewEntry, item_anchor};
use std::collections::{BTreeMap, BTreeSet};

/// What the class page and the summary need, gathered one submission at a time.
pub struct Statistics {
    rows: Vec<ClassRow>,
    review: Vec<ReviewEntry>,
    /// Points earned by all, per question of the lab.
    earned: Vec<Points>,
    student_ids: BTreeSet<String>,
    outcome: Outcome,
    total: Points,
}

impl Statistics {
    pub fn new(lab: &LabDefinition) -> Self {
        Self {
            rows: Vec::new(),
            review: Vec::new(),
            earned: vec![Points::ZERO; lab.questions.len()],
            student_ids: BTreeSet::new(),
            outcome: Outcome::default(),
            total: Points::ZERO,
        }
    }

    pub fn add(&mut self, marked: &Marked) {
        let (submission, card) = (&marked.submission, &marked.scorecard);
        for (sum, question) in self.earned.iter_mut().zip(&card.questions) {
            *sum += question.tally.earned;
        }
        self.total += card.total.earned;
        self.student_ids.extend(submission.students.iter().map(|s| s.id.clone()));
        self.outcome.submissions += 1;
        self.outcome.possible = card.total.possible.as_f64();
        self.outcome.unreadable += usize::from(!submission.readable);
        self.outcome.failed += usize::from(marked.failed);
        if let Some(entry) = review_entry(marked) {
            self.outcome.to_review += 1;
            self.review.push(entry);
        }
        self.rows.push(ClassRow {
            students: submission.students.clone(),
            file: submission.source.name.clone(),
            report: marked.report.clone(),
            earned: card.total.earned,
            possible: card.total.possible,
            provisional: card.total.provisional,
            findings: submission.findings.len(),
            cover_total: card.cover_total,
            readable: submission.readable,
        });
    }

    pub fn outcome(&self) -> Outcome {
        Outcome { mean_earned: self.total.as_f64() / self.count(), ..self.outcome.clone() }
    }

    pub fn summary(self, lab: &LabDefinition) -> ClassSummary {
        let count = self.count();
        let questions = lab
            .questions
            .iter()
            .zip(&self.earned)
            .map(|(question, earned)| QuestionMean {
                id: question.id.clone(),
                mean: earned.as_f64() / count,
                possible: question.points,
            })
            .collect();
        ClassSummary { rows: self.rows, questions, review: self.review }
    }

    /// Which of `ids` nobody in the class has.
    pub fn absent<'a>(&self, ids: impl Iterator<Item = &'a str>) -> Vec<String> {
        ids.filter(|id| !self.student_ids.contains(*id)).map(str::to_owned).collect()
    }

    /// At least 1, so that a mean over nobody is 0.
    fn count(&self) -> f64 {
        self.outcome.submissions.max(1) as f64
    }
}

/// One line a submission: how many of its marks wait for a person, of which kinds, and where the first stands.
fn review_entry(marked: &Marked) -> Option<ReviewEntry> {
    let first = marked.items_to_review().next()?;
    let mut kinds: BTreeMap<&str, usize> = BTreeMap::new();
    for item in marked.items_to_review() {
        let kind = match (item.verdict, item.code.split('.').next()) {
            (Verdict::Unmarked, _) => "not marked",
            (_, Some("concepts")) => "prose",
            (_, Some("plot")) => "picture",
            _ => "other",
        };
        *kinds.entry(kind).or_default() += 1;
    }
    let kinds: Vec<String> = kinds.iter().map(|(kind, count)| format!("{kind}: {count}")).collect();
    let names: Vec<&str> = marked
        .submission
        .students
        .iter()
        .map(|s| if s.name.is_empty() { s.id.as_str() } else { s.name.as_str() })
        .collect();
    let others = marked.items_to_review().count() - 1;
    Some(ReviewEntry {
        student: names.join(", "),
        item: first.id.clone(),
        title: match others {
            0 => first.title.clone(),
            n => format!("{} and {n} more", first.title),
        },
        link: format!("{}#{}", marked.report, item_anchor(&first.id)),
        why: kinds.join(" · "),
        earned: marked.items_to_review().map(|item| item.earned).sum(),
        possible: marked.items_to_review().map(|item| item.possible).sum(),
    })
}
