use super::intake::{AnswerFile, Superseded, handed_in, student_records};
use super::{HandedIn, Marked, OtherVariant, Roster, RosterStudent};
use crate::grading::{
    Adjustment, Cause, Conflict, Diagnosis, FollowThrough, ItemScore, Ledger, Tally, Verdict,
};
use crate::lab::{LabDefinition, Points};
use crate::source::{Finding, Position, sanitize};
use crate::submission::Submission;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// What became of one submission: a line of `results.jsonl`.
///
/// Everything that is written after marking – class page, gradebooks, statistics, comparisons – is made from records alone,
/// so that a submission that was marked by an earlier run and one that was marked just now cannot be told apart. Fields may
/// be added, never renamed. Points are numbers with at most two decimals.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// Unique in the class; names the report where no student is known.
    pub submission: String,
    /// The answer file's name, as found.
    pub file: String,
    /// Whether it was marked, and if not, why there is a line all the same.
    #[serde(default, skip_serializing_if = "Status::is_marked")]
    pub status: Status,
    /// The submission of the same owner that counts instead; only when superseded.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub superseded_by: Option<String>,
    /// Who handed it in, as the LMS says it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub handed_in: Option<HandedIn>,
    pub students: Vec<StudentRecord>,
    /// Values as typed in the lab, where they differ from student to student; empty when it is not known whose file it is.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub parameters: Option<BTreeMap<String, String>>,
    /// Other students whose numbers the wrong answers are right for; nothing changes a mark.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub other_variant: Vec<OtherVariantRecord>,
    pub total: TallyRecord,
    #[serde(default)]
    pub questions: Vec<QuestionRecord>,
    pub items: Vec<ItemRecord>,
    /// Rows of the observation sheet; null until a person has given the points.
    #[serde(default)]
    pub observed: Vec<BoxRecord>,
    /// Boxes of the cover sheet; null while a part waits for a person.
    #[serde(default)]
    pub cover: Vec<BoxRecord>,
    /// Sum of the cover sheet; null while a box is.
    #[serde(default, with = "points::optional")]
    pub cover_total: Option<Points>,
    /// Where that sum is null: what is known of it, whatever waits for a person counted for nothing.
    #[serde(default, skip_serializing_if = "Option::is_none", with = "points::optional")]
    pub so_far: Option<Points>,
    /// What changes that sum, and why; lateness first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub adjustments: Vec<AdjustmentRecord>,
    /// What is to be passed on: the sum of the cover sheet with the adjustments, within its bounds; null while a part waits for a
    /// person, and for an attempt that does not count.
    #[serde(default)]
    pub mark: Option<MarkRecord>,
    /// By field, 16 hexadecimal digits that tell whether its answer is what it was; what is blank is absent.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub answers: BTreeMap<String, String>,
    pub ledger: LedgerRecord,
    pub findings: Vec<FindingRecord>,
    /// Relative to the output folder, percent-encoded.
    pub report: String,
    /// The same with all there is to say, for the instructor; only where the report withholds something.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub instructor: Option<String>,
    /// False when the file as a whole could not be read.
    #[serde(default = "yes")]
    pub readable: bool,
    /// polemark itself failed on it.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub failed: bool,
}

#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct StudentRecord {
    pub id: String,
    pub name: String,
    /// The row of the roster that is about them; absent without a roster, and for somebody who is not on it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub roster: Option<Box<RosterStudent>>,
    /// There is a roster, and they are not on it.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub unknown: bool,
}

/// What became of what was handed in, or was not.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Status {
    #[default]
    Marked,
    /// Marked, but there was nothing that could be read: a file that is no answer file, a broken one.
    Unreadable,
    /// On the roster, and handed nothing in: no points.
    Missing,
    /// Handed in again later: not marked, and counted nowhere.
    Superseded,
}

impl Status {
    /// The word that stands in files.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Marked => "marked",
            Self::Unreadable => "unreadable",
            Self::Missing => "missing",
            Self::Superseded => "superseded",
        }
    }

    fn is_marked(&self) -> bool {
        *self == Self::Marked
    }
}

/// Findings after which a person has to say whose the mark is, or whether it counts, before it is passed on.
pub const HOLDS: &[&str] = &[
    "student.not_on_roster",
    "student.twice",
    "intake.other_owner",
    "intake.other_group",
    "intake.other_lab",
    "intake.several_files",
];

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct OtherVariantRecord {
    pub students: Vec<String>,
    pub parameters: BTreeMap<String, String>,
    pub fields: Vec<String>,
    /// At most so likely by chance, for a wrong answer of this kind.
    pub chance: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct TallyRecord {
    #[serde(with = "points")]
    pub earned: Points,
    #[serde(with = "points")]
    pub possible: Points,
    /// How many of the earned points wait for a person.
    #[serde(with = "points")]
    pub provisional: Points,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct QuestionRecord {
    pub id: String,
    #[serde(flatten)]
    pub tally: TallyRecord,
}

/// Points of a row or box that is not marked from answers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BoxRecord {
    pub id: String,
    #[serde(with = "points::optional")]
    pub earned: Option<Points>,
    #[serde(with = "points")]
    pub possible: Points,
}

/// Points given or taken beside the cover sheet.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct AdjustmentRecord {
    /// Null while it is a part of a sum that waits for a person.
    #[serde(with = "points::optional")]
    pub points: Option<Points>,
    pub reason: String,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct MarkRecord {
    #[serde(with = "points")]
    pub earned: Points,
    #[serde(with = "points")]
    pub possible: Points,
}

/// One criterion.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ItemRecord {
    pub id: String,
    #[serde(with = "points")]
    pub earned: Points,
    #[serde(with = "points")]
    pub possible: Points,
    /// `right`, `partly`, `wrong`, `blank`, `unreadable`, `unmarked`.
    pub verdict: String,
    pub code: String,
    pub provisional: bool,
    /// The group of like answers that one decision of a person can serve, or served.
    pub alike: Option<String>,
    /// Tells whether the answer is what it was: of one field, that of [`Record::answers`]; absent where it is blank.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub answer: Option<String>,
    pub evidence: EvidenceRecord,
    pub line: Option<usize>,
    pub column: Option<usize>,
    pub diagnosis: Option<DiagnosisRecord>,
    pub follow_through: Option<FollowThroughRecord>,
    /// What a person should look at; absent where nothing waits.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub review: Option<ReviewRecord>,
}

/// Why a mark waits for a person, and what it is about. The student's words are hostile until escaped.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ReviewRecord {
    pub why: String,
    /// The words found in prose, quoted; empty where there are none.
    pub words: String,
    /// How the answer begins.
    pub answer: String,
    /// A person has decided about another answer than the one that stands here now.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub decided: bool,
}

#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct EvidenceRecord {
    pub expected: String,
    pub found: String,
    pub reason: String,
    pub conflicts: Vec<ConflictRecord>,
}

#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ConflictRecord {
    pub claim: String,
    pub against: String,
    pub own: bool,
}

#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct DiagnosisRecord {
    pub explanations: Vec<ExplanationRecord>,
    pub searched: usize,
}

#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ExplanationRecord {
    pub code: String,
    pub words: String,
    pub changes: Vec<String>,
}

#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct FollowThroughRecord {
    pub credited: bool,
    pub guard: String,
    pub root: String,
}

#[derive(Clone, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct LedgerRecord {
    pub lost: Vec<LossRecord>,
    pub spared: Vec<SparedRecord>,
}

#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct LossRecord {
    pub item: String,
    #[serde(with = "points")]
    pub points: Points,
    pub cause: String,
    pub root: Option<String>,
}

#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct SparedRecord {
    pub item: String,
    #[serde(with = "points")]
    pub points: Points,
    pub root: String,
}

#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct FindingRecord {
    /// `error`, `warning`, `note`.
    pub severity: String,
    pub code: String,
    pub message: String,
    pub line: Option<usize>,
    pub column: Option<usize>,
}

impl Record {
    pub fn of(marked: &Marked, lab: &LabDefinition) -> Self {
        let (submission, card) = (&marked.submission, &marked.scorecard);
        let position = |span: Option<crate::source::Span>| span.map(|s| submission.source.position(s.start));
        let observed = lab.observed.iter().zip(&card.observed);
        Self {
            submission: submission.id.clone(),
            file: submission.source.name.clone(),
            status: if submission.readable { Status::Marked } else { Status::Unreadable },
            superseded_by: None,
            handed_in: marked.handed_in.clone(),
            students: marked.students.clone(),
            parameters: marked.parameters.as_ref().map(|values| values.iter().cloned().collect()),
            other_variant: marked.other_variants.iter().map(OtherVariantRecord::of).collect(),
            total: TallyRecord::of(&card.total),
            questions: card
                .questions
                .iter()
                .map(|question| QuestionRecord {
                    id: question.id.clone(),
                    tally: TallyRecord::of(&question.tally),
                })
                .collect(),
            items: card
                .questions
                .iter()
                .flat_map(|question| &question.items)
                .map(|item| ItemRecord::of(item, marked, lab))
                .collect(),
            observed: observed
                .map(|(row, (id, earned))| BoxRecord {
                    id: id.clone(),
                    earned: *earned,
                    possible: row.points,
                })
                .collect(),
            cover: card
                .cover
                .iter()
                .map(|(id, possible, earned)| BoxRecord {
                    id: id.clone(),
                    earned: *earned,
                    possible: *possible,
                })
                .collect(),
            cover_total: card.cover_total,
            so_far: card.cover_total.is_none().then_some(card.so_far),
            adjustments: card.adjustments.iter().map(AdjustmentRecord::of).collect(),
            mark: card.mark.map(|earned| MarkRecord { earned, possible: lab.cover.total }),
            answers: card.answers.clone(),
            ledger: LedgerRecord::of(&card.ledger),
            findings: submission
                .findings
                .iter()
                .map(|finding| FindingRecord::of(finding, position(finding.span)))
                .collect(),
            report: marked.report.clone(),
            instructor: marked.instructor.clone(),
            readable: submission.readable,
            failed: marked.failed,
        }
    }

    /// Of somebody on the roster who handed nothing in.
    pub fn missing(student: &RosterStudent, lab: &LabDefinition) -> Self {
        let person = StudentRecord {
            id: student.id.clone(),
            name: student.name.clone(),
            roster: Some(Box::new(student.clone())),
            unknown: false,
        };
        let mark = Some(MarkRecord { earned: Points::ZERO, possible: lab.cover.total });
        Self { status: Status::Missing, students: vec![person], mark, ..Self::without_marks(lab) }
    }

    /// Of an answer file of which a person said that another counts: `by`, with its name.
    pub fn not_counting(
        submission: &Submission,
        file: &AnswerFile,
        (by, by_name): (&str, &str),
        roster: Option<&Roster>,
        lab: &LabDefinition,
    ) -> Self {
        let message =
            format!("A person said that `{}` counts for its student, not this file.", sanitize(by_name));
        let one = Finding::note("marks.other_file_counts", message);
        Self {
            submission: file.id.clone(),
            file: file.name.clone(),
            status: Status::Superseded,
            superseded_by: Some(by.to_owned()),
            handed_in: handed_in(file, roster),
            students: student_records(submission, roster),
            findings: vec![FindingRecord::of(&one, None)],
            readable: submission.readable,
            ..Self::without_marks(lab)
        }
    }

    /// Of an answer file in whose place its owner handed in another. `by` is the name of that one.
    pub fn superseded(
        one: &Superseded,
        by: &str,
        submission: &Submission,
        roster: Option<&Roster>,
        lab: &LabDefinition,
    ) -> Self {
        Self {
            submission: one.file.id.clone(),
            file: one.file.name.clone(),
            status: Status::Superseded,
            superseded_by: Some(one.by.clone()),
            handed_in: handed_in(&one.file, roster),
            students: student_records(submission, roster),
            findings: vec![FindingRecord::of(&one.finding(by), None)],
            readable: submission.readable,
            ..Self::without_marks(lab)
        }
    }

    /// No points, no criteria, no report.
    fn without_marks(lab: &LabDefinition) -> Self {
        let nothing = |possible| TallyRecord { earned: Points::ZERO, possible, provisional: Points::ZERO };
        let questions = lab.questions.iter();
        let empty = |id: &str, possible| BoxRecord { id: id.to_owned(), earned: None, possible };
        Self {
            submission: String::new(),
            file: String::new(),
            status: Status::Marked,
            superseded_by: None,
            handed_in: None,
            students: Vec::new(),
            parameters: None,
            other_variant: Vec::new(),
            total: nothing(lab.questions.iter().map(|question| question.points).sum()),
            questions: questions
                .map(|question| QuestionRecord { id: question.id.clone(), tally: nothing(question.points) })
                .collect(),
            items: Vec::new(),
            observed: lab.observed.iter().map(|row| empty(&row.id, row.points)).collect(),
            cover: lab.cover.rows.iter().map(|row| empty(&row.id, row.points)).collect(),
            cover_total: None,
            so_far: None,
            adjustments: Vec::new(),
            mark: None,
            answers: BTreeMap::new(),
            ledger: LedgerRecord::default(),
            findings: Vec::new(),
            report: String::new(),
            instructor: None,
            readable: true,
            failed: false,
        }
    }

    /// The report for the instructor: the students' own where it withholds nothing.
    pub fn full_report(&self) -> &str {
        self.instructor.as_deref().unwrap_or(&self.report)
    }

    /// Why no mark of it may be passed on before a person has said more; empty for most.
    pub fn held(&self) -> impl Iterator<Item = &FindingRecord> {
        self.findings.iter().filter(|finding| HOLDS.contains(&finding.code.as_str()))
    }

    /// What else was noted about how it was handed in.
    pub fn intake_notes(&self) -> impl Iterator<Item = &FindingRecord> {
        let held = |code: &str| HOLDS.contains(&code);
        self.findings.iter().filter(move |one| one.code.starts_with("intake.") && !held(&one.code))
    }

    /// Whether the LMS says that it came too late.
    pub fn is_late(&self) -> bool {
        self.handed_in.as_ref().is_some_and(|handed_in| handed_in.late)
    }

    /// Whether its points count for its students: not those of an attempt that was superseded.
    pub fn counts(&self) -> bool {
        self.status != Status::Superseded
    }

    /// A line of `results.jsonl`, without the line end.
    pub fn to_line(&self) -> Result<String, serde_json::Error> {
        serde_json::to_string(self)
    }

    /// Reads a line that [`to_line`](Self::to_line) wrote.
    pub fn from_line(line: &str) -> Result<Self, serde_json::Error> {
        serde_json::from_str(line)
    }

    /// Criteria that wait for a person: provisional marks, and what polemark could not judge or read.
    pub fn to_review(&self) -> impl Iterator<Item = (&ItemRecord, &ReviewRecord)> {
        self.items.iter().filter_map(|item| Some((item, item.review.as_ref()?)))
    }
}

impl OtherVariantRecord {
    fn of(other: &OtherVariant) -> Self {
        Self {
            students: other.students.clone(),
            parameters: other.parameters.iter().cloned().collect(),
            fields: other.fields.clone(),
            chance: other.chance,
        }
    }
}

impl AdjustmentRecord {
    fn of(adjustment: &Adjustment) -> Self {
        Self { points: adjustment.points, reason: adjustment.reason.clone() }
    }
}

impl TallyRecord {
    fn of(tally: &Tally) -> Self {
        Self { earned: tally.earned, possible: tally.possible, provisional: tally.provisional }
    }
}

impl ItemRecord {
    fn of(item: &ItemScore, marked: &Marked, lab: &LabDefinition) -> Self {
        let waits = item.provisional || matches!(item.verdict, Verdict::Unmarked | Verdict::Unreadable);
        Self {
            id: item.id.clone(),
            earned: item.earned,
            possible: item.possible,
            verdict: item.verdict.as_str().to_owned(),
            code: item.code.to_owned(),
            provisional: item.provisional,
            alike: item.alike.clone(),
            answer: item.answer.clone(),
            evidence: EvidenceRecord {
                expected: item.evidence.expected.clone(),
                found: item.evidence.found.clone(),
                reason: item.evidence.reason.clone(),
                conflicts: item.evidence.conflicts.iter().map(ConflictRecord::of).collect(),
            },
            line: item.position.map(|position| position.line),
            column: item.position.map(|position| position.column),
            diagnosis: item.diagnosis.as_ref().map(DiagnosisRecord::of),
            follow_through: item.follow_through.as_ref().map(FollowThroughRecord::of),
            review: waits.then(|| ReviewRecord::of(item, marked, lab)),
        }
    }
}

impl ReviewRecord {
    fn of(item: &ItemScore, marked: &Marked, lab: &LabDefinition) -> Self {
        let criteria = lab.questions.iter().flat_map(|question| &question.criteria);
        let field =
            criteria.into_iter().find(|criterion| criterion.id == item.id).map(|one| one.field.as_str());
        Self {
            why: match &item.held {
                Some(held) => format!(
                    "decided for another answer than the one that stands here now ({}: {})",
                    crate::english::points(held.points),
                    held.reason
                ),
                None => why(item).to_owned(),
            },
            words: if item.evidence.phrases.is_empty() { String::new() } else { item.evidence.found.clone() },
            answer: field.map_or_else(String::new, |field| beginning(marked, field)),
            decided: item.held.is_some(),
        }
    }
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

impl ConflictRecord {
    fn of(conflict: &Conflict) -> Self {
        Self { claim: conflict.claim.clone(), against: conflict.against.clone(), own: conflict.own }
    }
}

impl DiagnosisRecord {
    fn of(diagnosis: &Diagnosis) -> Self {
        let explanations = diagnosis.explanations.iter().map(|one| ExplanationRecord {
            code: one.code.clone(),
            words: one.words.clone(),
            changes: one.changes.clone(),
        });
        Self { explanations: explanations.collect(), searched: diagnosis.searched }
    }
}

impl FollowThroughRecord {
    fn of(followed: &FollowThrough) -> Self {
        Self {
            credited: followed.credited,
            guard: followed.guard.as_str().to_owned(),
            root: followed.root.clone(),
        }
    }
}

impl LedgerRecord {
    fn of(ledger: &Ledger) -> Self {
        let lost = ledger.lost.iter().map(|loss| LossRecord {
            item: loss.item.clone(),
            points: loss.points,
            cause: loss.cause.as_str().to_owned(),
            root: match &loss.cause {
                Cause::Part { root } | Cause::Refused { root, .. } => Some(root.clone()),
                _ => None,
            },
        });
        let spared = ledger.spared.iter().map(|spared| SparedRecord {
            item: spared.item.clone(),
            points: spared.points,
            root: spared.root.clone(),
        });
        Self { lost: lost.collect(), spared: spared.collect() }
    }
}

impl FindingRecord {
    fn of(finding: &Finding, position: Option<Position>) -> Self {
        Self {
            severity: finding.severity.word().to_owned(),
            code: finding.code.to_owned(),
            message: finding.message.clone(),
            line: position.map(|p| p.line),
            column: position.map(|p| p.column),
        }
    }
}

fn yes() -> bool {
    true
}

/// Points as a number; exact both ways, as hundredths below 2^53 are.
mod points {
    use crate::lab::Points;
    use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};

    pub fn serialize<S: Serializer>(points: &Points, serializer: S) -> Result<S::Ok, S::Error> {
        points.as_f64().serialize(serializer)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Points, D::Error> {
        read(f64::deserialize(deserializer)?)
    }

    fn read<E: Error>(value: f64) -> Result<Points, E> {
        let hundredths = (value * 100.0).round();
        if hundredths.abs() < 1e15 {
            Ok(Points(hundredths as i64))
        } else {
            Err(E::custom("points out of range"))
        }
    }

    pub mod optional {
        use super::*;

        pub fn serialize<S: Serializer>(points: &Option<Points>, serializer: S) -> Result<S::Ok, S::Error> {
            points.map(Points::as_f64).serialize(serializer)
        }

        pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Points>, D::Error> {
            Option::<f64>::deserialize(deserializer)?.map(read).transpose()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_record_survives_its_line() {
        let line = r#"{"submission":"a","file":"a.yaml","students":[{"id":"EE-1","name":"=A"}],"parameters":{"M":"0.4"},
            "total":{"earned":1.15,"possible":45.0,"provisional":0.1},"questions":[{"id":"q","earned":1.15,"possible":45,"provisional":0.1}],
            "items":[{"id":"q.a","earned":1.15,"possible":2,"verdict":"partly","code":"poles.some","provisional":true,"alike":null,
            "evidence":{"expected":"x","found":"<b>","reason":"r","conflicts":[]},"line":3,"column":4,"diagnosis":null,"follow_through":null,
            "review":{"why":"to be confirmed","words":"","answer":"a\u001b"}}],"observed":[{"id":"o","earned":null,"possible":5}],
            "cover_total":null,"ledger":{"lost":[{"item":"q.a","points":0.85,"cause":"here","root":null}],"spared":[]},"findings":[],
            "report":"reports/EE-1.html"}"#;
        let record = Record::from_line(line).unwrap();
        assert_eq!((record.total.earned, record.items[0].possible), (Points(115), Points(200)));
        assert_eq!((record.observed[0].earned, record.readable), (None, true));
        assert_eq!(Record::from_line(&record.to_line().unwrap()).unwrap(), record);
    }

    #[test]
    fn every_hundredth_is_exact() {
        for hundredths in (0..100_000).chain([-5, 99_999_999]) {
            let tally = TallyRecord {
                earned: Points(hundredths),
                possible: Points(hundredths),
                provisional: Points::ZERO,
            };
            let text = serde_json::to_string(&tally).unwrap();
            assert_eq!(serde_json::from_str::<TallyRecord>(&text).unwrap(), tally, "{text}");
        }
    }
}
