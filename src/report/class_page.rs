//! The class page as a view: distribution, statistics, who needs review, links to every report.

use super::class_analysis::{self, AttainmentView, ConfusionView, ItemView, MistakeView, SharedView};
use super::class_marks::{self, AdjustmentsView, BorderlineView, GradeView, SpreadView};
use super::class_summary::{ClassRow, ClassSummary, IntakeEntry, IntakeKind, ReviewEntry};
use super::kit::ReportKit;
use super::numbers::counted;
use super::prose;
use super::view::provisional_words;
use crate::source::sanitize;
use base64::Engine as _;
use serde::Serialize;
use sha2::{Digest, Sha256};
use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet};

/// Sorts and filters the tables of the class page: fixed, allowed by its hash, and not needed to read the page.
pub(super) const TABLES_SCRIPT: &str = include_str!("../../templates/tables.js");

#[derive(Serialize)]
pub struct ClassPage {
    page_title: String,
    course: String,
    lab_title: String,
    script_html: &'static str,
    /// As a Content-Security-Policy names it: `sha256-…`.
    script_hash: String,
    facts: Vec<(&'static str, String)>,
    /// What the statistics are of.
    counted_words: String,
    /// What the marks are, and what they wait for.
    marks_words: String,
    spreads: Vec<SpreadView>,
    grades: Vec<GradeView>,
    questions: Vec<ItemView>,
    criteria: Vec<ItemView>,
    mistakes: Vec<MistakeView>,
    /// `3 answers` whose explanations are not listed, or nothing.
    more_mistakes: String,
    classes: Option<ConfusionView>,
    outcomes: Vec<AttainmentView>,
    /// Some outcome has a target.
    targets: bool,
    borderline: Option<BorderlineView>,
    shared: Vec<SharedView>,
    not_compared: usize,
    review: Vec<ReviewGroup>,
    review_words: String,
    alike_html: String,
    /// Students have numbers of their own.
    varied: bool,
    /// Some mark has adjustments, some submission findings, something that waits.
    adjusted_any: bool,
    with_findings: bool,
    waits: bool,
    rows: Vec<RowView>,
    /// That not all are listed, and where they are; empty when they are.
    more_rows: String,
    /// How things were handed in.
    intake: Vec<IntakeView>,
}

#[derive(Serialize)]
struct IntakeView {
    title: &'static str,
    amount: String,
    entries: Vec<IntakeEntryView>,
    /// Entries that are not listed.
    more: usize,
    open: bool,
}

#[derive(Serialize)]
struct IntakeEntryView {
    who: String,
    words: String,
    link: String,
}

/// Marks on one criterion that wait for a person.
#[derive(Serialize)]
struct ReviewGroup {
    title: String,
    why: String,
    amount: String,
    count: usize,
    /// Long lists start closed, and many lists.
    open: bool,
    /// The largest first.
    groups: Vec<AlikeView>,
}

/// Answers that one decision can serve; answers on their own at the end.
#[derive(Serialize)]
struct AlikeView {
    /// As `alike:` of the marks file names it; empty for answers on their own.
    id: String,
    amount: String,
    count: usize,
    /// Of `count`, how many are not listed.
    more: usize,
    /// One answer only.
    single: bool,
    /// `1 of 1`, when it is the same for all of the group.
    marks: String,
    /// The words found, quoted.
    found: String,
    conflicts: Vec<String>,
    /// How one of the answers begins.
    example: String,
    open: bool,
    entries: Vec<EntryView>,
}

#[derive(Serialize)]
struct EntryView {
    student: String,
    link: String,
    marks: String,
}

#[derive(Serialize)]
struct RowView {
    ids: String,
    names: String,
    file: String,
    link: String,
    numbers: String,
    earned: String,
    possible: String,
    provisional: String,
    findings: String,
    to_review: String,
    /// `late`, `held until a person says that it counts`, `handed nothing in`, or nothing.
    status: &'static str,
    adjustments: AdjustmentsView,
    mark: String,
}

pub fn page(kit: &ReportKit, summary: &ClassSummary) -> ClassPage {
    let lab = &kit.lab;
    let review = review(kit, summary);
    let criteria: BTreeSet<&str> = summary.review.iter().map(|entry| entry.item.as_str()).collect();
    let waiting: usize = review.iter().map(|group| group.count).sum();
    ClassPage {
        page_title: format!("Class – {}", lab.title),
        course: lab.course.clone(),
        lab_title: lab.title.clone(),
        script_html: TABLES_SCRIPT,
        script_hash: script_hash(),
        facts: facts(kit, summary),
        counted_words: class_analysis::counted_words(summary),
        marks_words: class_marks::words(summary),
        spreads: class_marks::spreads(lab, summary),
        grades: class_marks::grades(lab, summary),
        questions: class_analysis::questions(lab, &summary.questions, summary.counted),
        criteria: class_analysis::criteria(lab, &summary.criteria, summary.counted),
        mistakes: class_analysis::mistakes(lab, &summary.mistakes, summary.counted),
        more_mistakes: match summary.more_mistakes + class_analysis::mistakes_not_listed(&summary.mistakes) {
            0 => String::new(),
            n => counted(n, "answer"),
        },
        classes: class_analysis::classes(&summary.classes),
        outcomes: class_analysis::outcomes(&summary.outcomes),
        targets: summary.outcomes.iter().any(|one| one.target.is_some()),
        borderline: class_marks::borderline(lab, &summary.rows),
        shared: class_analysis::shared(&summary.answers_shared),
        not_compared: summary.answers_not_compared,
        review_words: match waiting {
            0 => "No mark waits for a person.".to_owned(),
            1 => "One mark waits for a person.".to_owned(),
            n => format!(
                "{n} marks on {} wait for a person.",
                counted(criteria.len(), "criterion").replace("criterions", "criteria")
            ),
        },
        alike_html: if review.iter().any(|group| group.groups.iter().any(|like| !like.id.is_empty())) {
            prose::sentences(
                "Like answers stand together, under the name that stands for all of them below `alike:` in the marks \
                 file: one decision serves them all.",
            )
        } else {
            String::new()
        },
        review,
        varied: lab.variants.is_some(),
        adjusted_any: summary.rows.iter().any(|row| !row.adjustments.is_empty()),
        with_findings: summary.rows.iter().any(|row| row.findings > 0 || !row.readable),
        waits: summary.rows.iter().any(|row| row.to_review > 0),
        rows: summary.rows.iter().take(MOST_ROWS).map(row).collect(),
        more_rows: more_rows(summary.rows.len()),
        intake: intake(&summary.intake),
    }
}

fn script_hash() -> String {
    let digest = Sha256::digest(TABLES_SCRIPT.as_bytes());
    format!("sha256-{}", base64::engine::general_purpose::STANDARD.encode(digest))
}

/// Reports that are listed: with more, a browser takes seconds for each sort, and the page as much memory as marking.
const MOST_ROWS: usize = 5000;

fn more_rows(all: usize) -> String {
    match all {
        0..=MOST_ROWS => String::new(),
        _ => format!(
            "The first {MOST_ROWS} of {all} are listed here; all are in gradebook.csv and results.jsonl."
        ),
    }
}

/// Entries of a kind that are listed.
const MOST_OF_A_KIND: usize = 1000;

/// What is to be known of how things were handed in, a list for each kind.
fn intake(entries: &[IntakeEntry]) -> Vec<IntakeView> {
    let kinds = [
        (IntakeKind::Held, "Whose it is, and whether it counts", "note"),
        (IntakeKind::Superseded, "Answer files that do not count", "file"),
        (IntakeKind::Aside, "Other files, not marked", "file"),
    ];
    let view = |(kind, title, what): (IntakeKind, &'static str, &str)| {
        let all: Vec<&IntakeEntry> = entries.iter().filter(|entry| entry.kind == kind).collect();
        IntakeView {
            title,
            amount: counted(all.len(), what),
            open: all.len() <= OPEN,
            more: all.len().saturating_sub(MOST_OF_A_KIND),
            entries: all.into_iter().take(MOST_OF_A_KIND).map(intake_entry).collect(),
        }
    };
    kinds.into_iter().map(view).filter(|view| !view.entries.is_empty()).collect()
}

fn intake_entry(entry: &IntakeEntry) -> IntakeEntryView {
    IntakeEntryView {
        who: sanitize(&entry.who.chars().take(200).collect::<String>()),
        words: sanitize(&entry.words),
        link: entry.link.clone(),
    }
}

fn facts(kit: &ReportKit, summary: &ClassSummary) -> Vec<(&'static str, String)> {
    let handed_in = summary.rows.iter().filter(|r| !r.missing).count();
    let mut facts = vec![("Submissions", handed_in.to_string())];
    for (name, count) in [
        ("Handed nothing in", summary.rows.len() - handed_in),
        ("Too late", summary.rows.iter().filter(|r| r.late).count()),
    ] {
        if count > 0 {
            facts.push((name, count.to_string()));
        }
    }
    facts.extend(class_marks::facts(&kit.lab, summary));
    let unreadable = summary.rows.iter().filter(|r| !r.readable).count();
    if unreadable > 0 {
        facts.push(("Files that could not be read", unreadable.to_string()));
    }
    let with_findings = summary.rows.iter().filter(|r| r.findings > 0).count();
    facts.push(("With findings", with_findings.to_string()));
    facts
}

/// Entries of the same criterion and the same reason together, in the lab's order.
fn review(kit: &ReportKit, summary: &ClassSummary) -> Vec<ReviewGroup> {
    let entries = &summary.review;
    let mut groups: Vec<(&ReviewEntry, Vec<&ReviewEntry>)> = Vec::new();
    let mut places = BTreeMap::new();
    for entry in entries {
        let place = *places.entry((&entry.item, &entry.why)).or_insert(groups.len());
        if place == groups.len() {
            groups.push((entry, Vec::new()));
        }
        groups[place].1.push(entry);
    }
    let criteria: Vec<&str> =
        kit.lab.questions.iter().flat_map(|q| &q.criteria).map(|criterion| criterion.id.as_str()).collect();
    groups.sort_by_cached_key(|(first, _)| criteria.iter().position(|id| *id == first.item));
    let few = groups.len() <= OPEN;
    groups
        .into_iter()
        .map(|(first, entries)| {
            let question = kit.lab.questions.iter().find(|q| q.criteria.iter().any(|c| c.id == first.item));
            let title = match question {
                Some(q) => format!("{} – {}", q.number, first.title),
                None => first.title.clone(),
            };
            let groups = alike(&entries, &summary.review_counts);
            let count = groups.iter().map(|group| group.count).sum();
            ReviewGroup {
                title,
                why: sanitize(&first.why).to_string(),
                amount: counted(count, "mark"),
                open: few && count <= OPEN,
                groups,
                count,
            }
        })
        .collect()
}

/// More answers than these start closed, and all do where they are of more criteria than these.
const OPEN: usize = 8;

/// Like answers together, by the group's id, so that files may be named as they will.
fn alike(entries: &[&ReviewEntry], counts: &ReviewCounts) -> Vec<AlikeView> {
    let mut groups: BTreeMap<Option<&str>, Vec<&ReviewEntry>> = BTreeMap::new();
    for entry in entries {
        groups.entry(entry.alike.as_deref()).or_default().push(entry);
    }
    let mut groups: Vec<_> = groups.into_iter().collect();
    let count = |id: Option<&str>, entries: &[&ReviewEntry]| {
        let key = entries.first().map(|one| (one.item.clone(), one.why.clone(), id.map(str::to_owned)));
        let all = key.and_then(|key| counts.get(&key)).copied().unwrap_or(0);
        all.max(entries.len())
    };
    groups.sort_by_key(|(id, entries)| (id.is_none(), Reverse(count(*id, entries))));
    groups.into_iter().map(|(id, entries)| alike_view(id, &entries, count(id, &entries))).collect()
}

/// Entries by criterion, reason and group, those that are not listed too.
type ReviewCounts = BTreeMap<(String, String, Option<String>), usize>;

fn alike_view(id: Option<&str>, entries: &[&ReviewEntry], count: usize) -> AlikeView {
    // What is said of one holds for all of a group, and for none of those on their own.
    let first = id.and(entries.first());
    let marks = |entry: &ReviewEntry| format!("{} of {}", entry.earned, entry.possible);
    let same = first.map(|one| marks(one)).filter(|one| entries.iter().all(|entry| marks(entry) == *one));
    AlikeView {
        single: count == 1,
        id: id.unwrap_or_default().to_owned(),
        amount: counted(count, "answer"),
        count,
        more: count - entries.len(),
        found: first.map_or_else(String::new, |one| sanitize(&one.found)),
        conflicts: first.map_or_else(Vec::new, |one| one.conflicts.iter().map(|c| sanitize(c)).collect()),
        example: first.map_or_else(String::new, |one| sanitize(&one.example)),
        open: count <= OPEN,
        entries: entries
            .iter()
            .map(|entry| EntryView {
                student: sanitize(&entry.student),
                link: entry.link.clone(),
                marks: if same.is_some() { String::new() } else { marks(entry) },
            })
            .collect(),
        marks: same.unwrap_or_default(),
    }
}

fn row(row: &ClassRow) -> RowView {
    let joined = |part: fn(&crate::submission::Student) -> &str| {
        let parts = row.students.iter().map(part).map(str::trim).filter(|p| !p.is_empty());
        sanitize(&parts.map(|p| p.chars().take(80).collect::<String>()).collect::<Vec<_>>().join(", "))
    };
    let names = joined(|s| &s.name);
    RowView {
        ids: joined(|s| &s.id),
        names: if names.is_empty() { "not named".to_owned() } else { names },
        file: sanitize(&row.file),
        link: row.report.clone(),
        numbers: row.numbers.clone(),
        earned: row.earned.to_string(),
        possible: row.possible.to_string(),
        provisional: provisional_words(row.provisional),
        findings: match (row.readable, row.findings) {
            (false, _) => "not readable".to_owned(),
            (true, 0) => String::new(),
            (true, n) => n.to_string(),
        },
        to_review: match row.to_review {
            0 => String::new(),
            n => n.to_string(),
        },
        status: match (row.missing, row.late, row.held) {
            (true, _, _) => "handed nothing in",
            (_, true, false) => "late",
            (_, true, true) => "late; held until a person says that it counts",
            (_, false, true) => "held until a person says that it counts",
            (_, false, false) => "",
        },
        adjustments: class_marks::adjustments(row),
        mark: class_marks::mark(row),
    }
}
