use super::marked::Marked;
use super::outcome::Outcome;
use crate::english::listed;
use crate::grading::{ItemScore, Verdict};
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
    /// (criterion, group) of every like answer.
    groups: BTreeSet<(String, String)>,
    /// The field each criterion judges.
    fields: BTreeMap<String, String>,
    reports: BTreeSet<String>,
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
            groups: BTreeSet::new(),
            fields: lab
                .questions
                .iter()
                .flat_map(|question| &question.criteria)
                .map(|criterion| (criterion.id.clone(), criterion.field.clone()))
                .collect(),
            reports: BTreeSet::new(),
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
        self.reports.insert(marked.report.clone());
        self.outcome.submissions += 1;
        self.outcome.possible = card.total.possible.as_f64();
        self.outcome.unreadable += usize::from(!submission.readable);
        self.outcome.failed += usize::from(marked.failed);
        let waiting = self.review.len();
        self.review.extend(review_entries(marked, &self.fields));
        self.review.extend(other_variant_entries(marked));
        let items = card.questions.iter().flat_map(|question| &question.items);
        let groups = items.filter_map(|item| Some((item.id.clone(), item.alike.clone()?)));
        self.groups.extend(groups);
        self.outcome.to_review += usize::from(self.review.len() > waiting);
        self.rows.push(ClassRow {
            students: submission.students.clone(),
            file: submission.source.name.clone(),
            report: marked.report.clone(),
            numbers: numbers_words(marked),
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

    /// (criterion, group) of every like answer of the class.
    pub fn groups(&self) -> &BTreeSet<(String, String)> {
        &self.groups
    }

    /// Whether this run wrote the report of this name, relative to the output folder.
    pub fn has_report(&self, report: &str) -> bool {
        self.reports.contains(report)
    }

    /// At least 1, so that a mean over nobody is 0.
    fn count(&self) -> f64 {
        self.outcome.submissions.max(1) as f64
    }
}

/// `M = 0.4, b = 0.1`; empty where everyone has the lab's own.
fn numbers_words(marked: &Marked) -> String {
    match &marked.parameters {
        None => String::new(),
        Some(values) if values.is_empty() => "not known".to_owned(),
        Some(values) => {
            let each = values.iter().map(|(name, value)| format!("{name} = {value}"));
            each.collect::<Vec<_>>().join(", ")
        }
    }
}

/// One entry a criterion that waits for a person.
fn review_entries<'a>(
    marked: &'a Marked,
    fields: &'a BTreeMap<String, String>,
) -> impl Iterator<Item = ReviewEntry> + 'a {
    let names: Vec<&str> = marked
        .submission
        .students
        .iter()
        .map(|s| if s.name.is_empty() { s.id.as_str() } else { s.name.as_str() })
        .collect();
    let student = names.join(", ");
    marked.items_to_review().map(move |item| ReviewEntry {
        student: student.clone(),
        item: item.id.clone(),
        title: item.title.clone(),
        link: format!("{}#{}", marked.report, item_anchor(&item.id)),
        why: why(item).to_owned(),
        earned: item.earned,
        possible: item.possible,
        alike: item.alike.clone(),
        found: found(item),
        conflicts: conflicts(item),
        example: fields.get(&item.id).map_or_else(String::new, |field| beginning(marked, field)),
    })
}

/// One entry for each variant of other students that wrong answers are right for.
fn other_variant_entries(marked: &Marked) -> impl Iterator<Item = ReviewEntry> + '_ {
    marked.other_variants.iter().filter_map(|other| {
        let items = marked.scorecard.questions.iter().flat_map(|question| &question.items);
        let field = other.fields.first()?;
        let below = format!("{field}.");
        let item = items.into_iter().find(|item| item.id == *field || item.id.starts_with(&below))?;
        let students: Vec<&str> = marked.submission.students.iter().map(|student| student.id.as_str()).collect();
        let values = other.parameters.iter().map(|(name, value)| format!("{name} = {value}"));
        Some(ReviewEntry {
            student: students.join(", "),
            item: item.id.clone(),
            title: item.title.clone(),
            link: format!("{}#{}", marked.report, item_anchor(&item.id)),
            why: format!(
                "wrong for their own values, but right for those of {} ({}) in {}; by chance at most 1 in {} such answers. No mark rests \
                 on it",
                listed(&other.students, "and"),
                values.collect::<Vec<_>>().join(", "),
                listed(&other.fields, "and"),
                (1.0 / other.chance.max(1e-9)).floor()
            ),
            earned: item.earned,
            possible: item.possible,
            alike: None,
            found: String::new(),
            conflicts: Vec::new(),
            example: String::new(),
        })
    })
}

/// The words that were found, when the answer is prose.
fn found(item: &ItemScore) -> String {
    if item.evidence.phrases.is_empty() { String::new() } else { item.evidence.found.clone() }
}

/// What does not go with the numbers, each once: `it is stable: Your pole 2 lies in the right half-plane.`
fn conflicts(item: &ItemScore) -> Vec<String> {
    let mut all: Vec<String> = Vec::new();
    for conflict in &item.evidence.conflicts {
        let one = format!("{}: {}", conflict.claim, conflict.against);
        if !all.contains(&one) {
            all.push(one);
        }
    }
    all
}

/// As much of the answer as tells what it is like.
fn beginning(marked: &Marked, field: &str) -> String {
    const LETTERS: usize = 200;
    let Some(answer) = marked.submission.answers.get(field) else { return String::new() };
    let text = answer.read_as();
    let mut words = text.split_whitespace().collect::<Vec<_>>().join(" ");
    if let Some((end, _)) = words.char_indices().nth(LETTERS) {
        words.truncate(end);
        words.push('…');
    }
    words
}

/// Why a person should look, by the kind of answer.
fn why(item: &ItemScore) -> &'static str {
    match (item.verdict, item.code.split('.').next()) {
        (Verdict::Unmarked, _) if item.code == "variant.unknown" => "it is not known whose numbers count",
        (Verdict::Unmarked, _) if item.code == "variant.member" => {
            "right by the numbers of another member of the group"
        }
        (Verdict::Unmarked, _) => "polemark could not judge it",
        (Verdict::Unreadable, _) => "something was written that cannot be read",
        (_, Some("concepts")) => "prose is judged by its words only",
        (_, Some("plot")) => "a picture cannot be read",
        _ => "to be confirmed",
    }
}
