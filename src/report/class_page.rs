//! The class page as a view: distribution, means, who needs review, links to every report.

use super::class_summary::{ClassRow, ClassSummary, IntakeEntry, IntakeKind, QuestionMean, ReviewEntry};
use super::figures::distribution;
use super::kit::ReportKit;
use super::numbers::{counted, number};
use super::pictures::draw;
use super::prose;
use super::view::{BarView, FigureView, provisional_words};
use crate::lab::Points;
use crate::source::sanitize;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};

#[derive(Serialize)]
pub struct ClassPage {
    page_title: String,
    course: String,
    lab_title: String,
    facts: Vec<(&'static str, String)>,
    plots: Vec<FigureView>,
    questions: Vec<MeanView>,
    review: Vec<ReviewGroup>,
    review_words: String,
    alike_html: String,
    /// Students have numbers of their own.
    varied: bool,
    rows: Vec<RowView>,
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

#[derive(Serialize)]
struct MeanView {
    number: String,
    title: String,
    mean: String,
    possible: String,
    bar: BarView,
}

/// Marks on one criterion that wait for a person.
#[derive(Serialize)]
struct ReviewGroup {
    title: String,
    why: String,
    amount: String,
    /// Long lists start closed.
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
    /// `late`, `handed nothing in`, or nothing.
    status: &'static str,
    cover: String,
}

pub fn page(kit: &ReportKit, summary: &ClassSummary) -> ClassPage {
    let lab = &kit.lab;
    let totals: Vec<f64> = summary.rows.iter().filter(|r| !r.missing).map(|r| r.earned.as_f64()).collect();
    let possible = lab.questions.iter().map(|q| q.points).sum::<Points>();
    let figure = distribution(&totals, possible.as_f64());
    let review = review(kit, &summary.review);
    let criteria: BTreeSet<&str> = summary.review.iter().map(|entry| entry.item.as_str()).collect();
    ClassPage {
        page_title: format!("Class – {}", lab.title),
        course: lab.course.clone(),
        lab_title: lab.title.clone(),
        facts: facts(summary, &totals, possible),
        plots: draw(&figure, "figure-distribution").into_iter().collect(),
        questions: summary.questions.iter().map(|m| mean(kit, m)).collect(),
        review_words: match summary.review.len() {
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
        rows: summary.rows.iter().map(row).collect(),
        intake: intake(&summary.intake),
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

fn facts(summary: &ClassSummary, totals: &[f64], possible: Points) -> Vec<(&'static str, String)> {
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
    if !totals.is_empty() {
        let mut sorted = totals.to_vec();
        sorted.sort_by(f64::total_cmp);
        let n = sorted.len();
        let median = (sorted[(n - 1) / 2] + sorted[n / 2]) / 2.0;
        let mean = sorted.iter().sum::<f64>() / n as f64;
        facts.push(("Median", format!("{} of {possible}", number(median, 4))));
        facts.push(("Mean", format!("{} of {possible}", number(mean, 4))));
    }
    let unreadable = summary.rows.iter().filter(|r| !r.readable).count();
    if unreadable > 0 {
        facts.push(("Files that could not be read", unreadable.to_string()));
    }
    let with_findings = summary.rows.iter().filter(|r| r.findings > 0).count();
    facts.push(("With findings", with_findings.to_string()));
    facts
}

fn mean(kit: &ReportKit, mean: &QuestionMean) -> MeanView {
    let question = kit.lab.questions.iter().find(|q| q.id == mean.id);
    let hundredths = if mean.mean.is_finite() { (mean.mean * 100.0).round() as i64 } else { 0 };
    MeanView {
        number: question.map_or_else(String::new, |q| q.number.clone()),
        title: question.map_or_else(|| mean.id.clone(), |q| q.title.clone()),
        mean: Points(hundredths).to_string(),
        possible: mean.possible.to_string(),
        bar: BarView::new(Points(hundredths), Points::ZERO, mean.possible),
    }
}

/// Entries of the same criterion and the same reason together, in the lab's order.
fn review(kit: &ReportKit, entries: &[ReviewEntry]) -> Vec<ReviewGroup> {
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
    groups
        .into_iter()
        .map(|(first, entries)| {
            let question = kit.lab.questions.iter().find(|q| q.criteria.iter().any(|c| c.id == first.item));
            let title = match question {
                Some(q) => format!("{} – {}", q.number, first.title),
                None => first.title.clone(),
            };
            ReviewGroup {
                title,
                why: sanitize(&first.why).to_string(),
                amount: counted(entries.len(), "mark"),
                open: entries.len() <= OPEN,
                groups: alike(&entries),
            }
        })
        .collect()
}

/// More answers than these start closed.
const OPEN: usize = 8;

/// Like answers together, by the group's id, so that files may be named as they will.
fn alike(entries: &[&ReviewEntry]) -> Vec<AlikeView> {
    let mut groups: BTreeMap<Option<&str>, Vec<&ReviewEntry>> = BTreeMap::new();
    for entry in entries {
        groups.entry(entry.alike.as_deref()).or_default().push(entry);
    }
    let mut groups: Vec<_> = groups.into_iter().collect();
    groups.sort_by_key(|(id, entries)| (id.is_none(), usize::MAX - entries.len()));
    groups.into_iter().map(|(id, entries)| alike_view(id, &entries)).collect()
}

fn alike_view(id: Option<&str>, entries: &[&ReviewEntry]) -> AlikeView {
    // What is said of one holds for all of a group, and for none of those on their own.
    let first = id.and(entries.first());
    let marks = |entry: &ReviewEntry| format!("{} of {}", entry.earned, entry.possible);
    let same = first.map(|one| marks(one)).filter(|one| entries.iter().all(|entry| marks(entry) == *one));
    AlikeView {
        single: entries.len() == 1,
        id: id.unwrap_or_default().to_owned(),
        amount: counted(entries.len(), "answer"),
        found: first.map_or_else(String::new, |one| sanitize(&one.found)),
        conflicts: first.map_or_else(Vec::new, |one| one.conflicts.iter().map(|c| sanitize(c)).collect()),
        example: first.map_or_else(String::new, |one| sanitize(&one.example)),
        open: entries.len() <= OPEN,
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
        status: match (row.missing, row.late) {
            (true, _) => "handed nothing in",
            (false, true) => "late",
            (false, false) => "",
        },
        cover: row.cover_total.map_or_else(|| "waiting".to_owned(), |p| p.to_string()),
    }
}
