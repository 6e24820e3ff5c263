use super::{Marked, OtherVariant};
use crate::grading::{Cause, Conflict, Diagnosis, FollowThrough, Ledger};
use crate::source::Severity;
use serde::Serialize;
use std::collections::BTreeMap;

/// One line of `results.jsonl`, without the line end. Fields may be added, never renamed.
pub fn results_line(marked: &Marked) -> Result<String, serde_json::Error> {
    let submission = &marked.submission;
    let tally = &marked.scorecard.total;
    let position = |span: Option<crate::source::Span>| span.map(|s| submission.source.position(s.start));
    serde_json::to_string(&Line {
        submission: &submission.id,
        file: &submission.source.name,
        students: submission.students.iter().map(|s| StudentView { id: &s.id, name: &s.name }).collect(),
        parameters: marked
            .parameters
            .as_ref()
            .map(|values| values.iter().map(|(name, value)| (name.as_str(), value.as_str())).collect()),
        other_variant: marked.other_variants.iter().map(OtherView::of).collect(),
        total: Total {
            earned: tally.earned.as_f64(),
            possible: tally.possible.as_f64(),
            provisional: tally.provisional.as_f64(),
        },
        items: marked
            .scorecard
            .questions
            .iter()
            .flat_map(|question| &question.items)
            .map(|item| Item {
                id: &item.id,
                earned: item.earned.as_f64(),
                possible: item.possible.as_f64(),
                verdict: item.verdict.as_str(),
                code: item.code,
                provisional: item.provisional,
                evidence: EvidenceView {
                    expected: &item.evidence.expected,
                    found: &item.evidence.found,
                    reason: &item.evidence.reason,
                    conflicts: item.evidence.conflicts.iter().map(ConflictView::of).collect(),
                },
                alike: item.alike.as_deref(),
                line: item.position.map(|p| p.line),
                column: item.position.map(|p| p.column),
                diagnosis: item.diagnosis.as_ref().map(DiagnosisView::of),
                follow_through: item.follow_through.as_ref().map(FollowThroughView::of),
            })
            .collect(),
        ledger: LedgerView::of(&marked.scorecard.ledger),
        findings: submission
            .findings
            .iter()
            .map(|finding| FindingView {
                severity: match finding.severity {
                    Severity::Error => "error",
                    Severity::Warning => "warning",
                    Severity::Note => "note",
                },
                code: finding.code,
                message: &finding.message,
                line: position(finding.span).map(|p| p.line),
                column: position(finding.span).map(|p| p.column),
            })
            .collect(),
        report: &marked.report,
    })
}

#[derive(Serialize)]
struct Line<'a> {
    submission: &'a str,
    file: &'a str,
    students: Vec<StudentView<'a>>,
    /// Values as typed in the lab, where they differ from student to student; empty when it is not known whose file it is.
    #[serde(skip_serializing_if = "Option::is_none")]
    parameters: Option<BTreeMap<&'a str, &'a str>>,
    /// Other students whose numbers the wrong answers are right for; nothing changes a mark.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    other_variant: Vec<OtherView<'a>>,
    total: Total,
    items: Vec<Item<'a>>,
    ledger: LedgerView<'a>,
    findings: Vec<FindingView<'a>>,
    report: &'a str,
}

#[derive(Serialize)]
struct OtherView<'a> {
    students: &'a [String],
    parameters: BTreeMap<&'a str, &'a str>,
    fields: &'a [String],
    chance: f64,
}

impl<'a> OtherView<'a> {
    fn of(other: &'a OtherVariant) -> Self {
        let parameters = other.parameters.iter().map(|(name, value)| (name.as_str(), value.as_str()));
        Self {
            students: &other.students,
            parameters: parameters.collect(),
            fields: &other.fields,
            chance: other.chance,
        }
    }
}

#[derive(Serialize)]
struct StudentView<'a> {
    id: &'a str,
    name: &'a str,
}

#[derive(Serialize)]
struct Total {
    earned: f64,
    possible: f64,
    provisional: f64,
}

#[derive(Serialize)]
struct Item<'a> {
    id: &'a str,
    earned: f64,
    possible: f64,
    verdict: &'static str,
    code: &'static str,
    provisional: bool,
    alike: Option<&'a str>,
    evidence: EvidenceView<'a>,
    line: Option<usize>,
    column: Option<usize>,
    diagnosis: Option<DiagnosisView<'a>>,
    follow_through: Option<FollowThroughView<'a>>,
}

#[derive(Serialize)]
struct FollowThroughView<'a> {
    credited: bool,
    guard: &'static str,
    root: &'a str,
}

impl<'a> FollowThroughView<'a> {
    fn of(followed: &'a FollowThrough) -> Self {
        Self { credited: followed.credited, guard: followed.guard.as_str(), root: &followed.root }
    }
}

#[derive(Serialize)]
struct LedgerView<'a> {
    lost: Vec<LossView<'a>>,
    spared: Vec<SparedView<'a>>,
}

#[derive(Serialize)]
struct LossView<'a> {
    item: &'a str,
    points: f64,
    cause: &'static str,
    root: Option<&'a str>,
}

#[derive(Serialize)]
struct SparedView<'a> {
    item: &'a str,
    points: f64,
    root: &'a str,
}

impl<'a> LedgerView<'a> {
    fn of(ledger: &'a Ledger) -> Self {
        let lost = ledger.lost.iter().map(|loss| LossView {
            item: &loss.item,
            points: loss.points.as_f64(),
            cause: loss.cause.as_str(),
            root: match &loss.cause {
                Cause::Part { root } | Cause::Refused { root, .. } => Some(root),
                _ => None,
            },
        });
        let spared = ledger.spared.iter().map(|spared| SparedView {
            item: &spared.item,
            points: spared.points.as_f64(),
            root: &spared.root,
        });
        Self { lost: lost.collect(), spared: spared.collect() }
    }
}

#[derive(Serialize)]
struct DiagnosisView<'a> {
    explanations: Vec<ExplanationView<'a>>,
    searched: usize,
}

#[derive(Serialize)]
struct ExplanationView<'a> {
    code: &'a str,
    words: &'a str,
    changes: &'a [String],
}

impl<'a> DiagnosisView<'a> {
    fn of(diagnosis: &'a Diagnosis) -> Self {
        let explanations = diagnosis.explanations.iter();
        let view =
            explanations.map(|e| ExplanationView { code: &e.code, words: &e.words, changes: &e.changes });
        Self { explanations: view.collect(), searched: diagnosis.searched }
    }
}

#[derive(Serialize)]
struct EvidenceView<'a> {
    expected: &'a str,
    found: &'a str,
    reason: &'a str,
    conflicts: Vec<ConflictView<'a>>,
}

#[derive(Serialize)]
struct ConflictView<'a> {
    claim: &'a str,
    against: &'a str,
    own: bool,
}

impl<'a> ConflictView<'a> {
    fn of(conflict: &'a Conflict) -> Self {
        Self { claim: &conflict.claim, against: &conflict.against, own: conflict.own }
    }
}

#[derive(Serialize)]
struct FindingView<'a> {
    severity: &'static str,
    code: &'static str,
    message: &'a str,
    line: Option<usize>,
    column: Option<usize>,
}
