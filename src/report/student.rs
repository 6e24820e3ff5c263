//! One submission's report as a view.

use super::answers;
use super::given::{self, GivenView};
use super::kit::{QuestionKit, ReportKit};
use super::ledger::{self, LedgerView};
use super::prose;
use super::released::released;
use super::view::{
    AnswerView, BoxView, DiagnosisView, FigureView, FindingView, ItemGroup, LevelView, ObservedView,
    OutcomeView, TallyView, VerdictView,
};
use super::{conflicts, items, opening};
use crate::english::{capitalized, listed};
use crate::grading::{Adjustment, Scorecard, Tally};
use crate::lab::{LabDefinition, ObservedRow, Points, Question, Release};
use crate::source::{Finding, SourceText, sanitize};
use crate::submission::{AnswerValue, AnsweredIn, Submission};
use serde::Serialize;

#[derive(Serialize)]
pub struct StudentPage {
    page_title: String,
    /// What is shown.
    marks: bool,
    feedback: bool,
    solutions: bool,
    /// What is not, in a sentence; empty when all is.
    withheld: String,
    course: String,
    lab_title: String,
    students: Vec<StudentView>,
    file: String,
    cover: Vec<BoxView>,
    /// What changes the sum of the boxes, and why.
    adjustments: Vec<AdjustmentView>,
    /// The sum with the adjustments, where there are any.
    mark: Option<BoxView>,
    /// The student's own values, in a lab where they differ from student to student; empty otherwise.
    given: Vec<GivenView>,
    given_words: String,
    findings_intro: &'static str,
    findings: Vec<FindingView>,
    /// What is right, what to look at again, and what it did not cost.
    opening_html: Vec<String>,
    total: TallyView,
    /// Where each point went.
    ledger: Option<LedgerView>,
    legend: Vec<VerdictView>,
    questions: Vec<QuestionView>,
    observed: Vec<ObservedView>,
    observed_levels: Vec<String>,
    outcomes: Vec<OutcomeView>,
}

#[derive(Serialize)]
struct StudentView {
    label: &'static str,
    id: String,
    name: String,
}

#[derive(Serialize)]
struct QuestionView {
    anchor: String,
    number: String,
    title: String,
    text_html: String,
    #[serde(flatten)]
    tally: TallyView,
    short_answers: Vec<AnswerView>,
    long_answers: Vec<AnswerView>,
    figures: Vec<FigureView>,
    remark: String,
    items: Vec<ItemGroup>,
    diagnosis: Option<DiagnosisView>,
}

/// More findings than this are counted, not shown.
const MOST_FINDINGS: usize = 60;

pub fn page(
    kit: &ReportKit,
    submission: &Submission,
    scorecard: &Scorecard,
    release: Release,
) -> StudentPage {
    let lab = &kit.lab;
    let scorecard = &released(scorecard, lab, release);
    let Release { marks, feedback, solutions } = release;
    let students = students(submission);
    let names: Vec<_> = students.iter().map(|s| s.name.as_str()).collect();
    let questions = lab.questions.iter().zip(&kit.questions);
    StudentPage {
        page_title: format!("{} – {}", names.join(", "), lab.title),
        course: lab.course.clone(),
        lab_title: lab.title.clone(),
        file: sanitize(&submission.source.name),
        marks,
        feedback,
        solutions,
        withheld: withheld(release),
        cover: cover(lab, scorecard, marks),
        adjustments: scorecard.adjustments.iter().filter(|_| marks).map(adjustment).collect(),
        mark: (marks && !scorecard.adjustments.is_empty()).then(|| BoxView {
            title: "Mark".to_owned(),
            earned: scorecard.mark.map(|points| points.to_string()),
            possible: lab.cover.total.to_string(),
            waiting: WAITING,
        }),
        given: given::own(lab),
        given_words: given_words(submission),
        findings_intro: if submission.readable {
            "Only the items named here are affected; everything else was marked as usual."
        } else {
            "The file as a whole could not be read, so nothing in it could be marked."
        },
        findings: findings(submission),
        opening_html: if submission.readable && marks {
            opening::paragraphs(lab, scorecard)
        } else {
            Vec::new()
        },
        total: TallyView::new(&scorecard.total),
        ledger: if marks && feedback { ledger::view(lab, scorecard) } else { None },
        legend: VerdictView::legend(),
        questions: questions.map(|(q, own)| question(kit, q, own, submission, scorecard, release)).collect(),
        observed: lab.observed.iter().map(|row| observed(row, scorecard, marks)).collect(),
        observed_levels: lab.observed.first().map(level_titles).unwrap_or_default(),
        outcomes: lab
            .outcomes
            .iter()
            .map(|o| OutcomeView { id: o.id.clone(), text: o.text.clone() })
            .collect(),
        students,
    }
}

/// `Marks and solutions are not released yet.`
fn withheld(release: Release) -> String {
    let parts = [(release.marks, "marks"), (release.feedback, "feedback"), (release.solutions, "solutions")];
    let parts: Vec<String> =
        parts.iter().filter(|(shown, _)| !shown).map(|(_, name)| (*name).to_owned()).collect();
    match parts.as_slice() {
        [] => String::new(),
        [one] if one == "feedback" => "Feedback is not released yet.".to_owned(),
        _ => capitalized(&format!("{} are not released yet.", listed(&parts, "and"))),
    }
}

fn given_words(submission: &Submission) -> String {
    match submission.students.as_slice() {
        [first, _, ..] => format!(
            "Students of this lab have values of their own. A group is marked by those of the first one listed, {}.",
            sanitize(&first.id)
        ),
        _ => "Students of this lab have values of their own. These are yours, and your answers were held against them."
            .to_owned(),
    }
}

fn students(submission: &Submission) -> Vec<StudentView> {
    if submission.students.is_empty() {
        let name = "not named in the file".to_owned();
        return vec![StudentView { label: "Student", id: String::new(), name }];
    }
    let shown = |text: &str| text.chars().take(200).collect::<String>();
    let view = |id: String, name: String| {
        if name.trim().is_empty() {
            StudentView { label: "Student", id: String::new(), name: id }
        } else {
            StudentView { label: "Student", id, name }
        }
    };
    let students = submission.students.iter();
    students.map(|s| view(sanitize(&shown(&s.id)), sanitize(&shown(&s.name)))).collect()
}

const WAITING: &str = "waiting for a person";
const WITHHELD: &str = "not released";

#[derive(Serialize)]
struct AdjustmentView {
    points: String,
    reason: String,
}

fn adjustment(one: &Adjustment) -> AdjustmentView {
    AdjustmentView {
        // A minus sign as in print.
        points: one.points.map_or_else(|| WAITING.to_owned(), |points| points.to_string().replace('-', "−")),
        reason: sanitize(&one.reason),
    }
}

fn cover(lab: &LabDefinition, scorecard: &Scorecard, marks: bool) -> Vec<BoxView> {
    let waiting = if marks { WAITING } else { WITHHELD };
    let title = |id: &str| {
        lab.cover.rows.iter().find(|row| row.id == id).map_or_else(|| id.to_owned(), |row| row.title.clone())
    };
    let boxes = scorecard.cover.iter().map(|(id, possible, earned)| BoxView {
        title: title(id),
        earned: earned.filter(|_| marks).map(|p| p.to_string()),
        possible: possible.to_string(),
        waiting,
    });
    let total = BoxView {
        title: "Total".to_owned(),
        earned: scorecard.cover_total.filter(|_| marks).map(|p| p.to_string()),
        possible: lab.cover.total.to_string(),
        waiting,
    };
    boxes.chain([total]).collect()
}

fn question(
    kit: &ReportKit,
    question: &Question,
    own: &QuestionKit,
    submission: &Submission,
    scorecard: &Scorecard,
    release: Release,
) -> QuestionView {
    let score = scorecard.questions.iter().find(|s| s.id == question.id);
    let unscored = Tally { possible: question.points, ..Tally::default() };
    let (mut short_answers, mut long_answers) = (Vec::new(), Vec::new());
    for field in &own.fields {
        let answer = submission.answers.get(&field.path);
        let (marks, conflicts) = match (score, answer.map(|a| &a.value)) {
            (Some(score), Some(Ok(AnswerValue::Prose(text)))) => {
                conflicts::of_field(question, &score.items, &field.path, text)
            }
            _ => Default::default(),
        };
        let view = AnswerView {
            prompt: field.prompt.clone(),
            yours_html: answers::yours(answer, &field.prompt, &marks),
            reference_heading: answers::reference_heading(field.kind),
            reference_html: match field.answered_in {
                _ if !release.solutions => String::new(),
                AnsweredIn::Letters => format!("{}{}", field.letters_html, field.reference_html),
                AnsweredIn::Either if answers::has_letters(answer) => {
                    format!("{}{}", field.letters_html, field.reference_html)
                }
                _ => field.reference_html.clone(),
            },
            conflicts_title: conflicts::title(&conflicts),
            conflicts,
        };
        if answers::is_short(field.kind, answer.is_some()) {
            short_answers.push(view);
        } else {
            long_answers.push(view);
        }
    }
    QuestionView {
        anchor: own.anchor.clone(),
        number: question.number.clone(),
        title: question.title.clone(),
        text_html: own.text_html.clone(),
        tally: TallyView::new(score.map_or(&unscored, |s| &s.tally)),
        short_answers,
        long_answers,
        // Each has a reference curve in it.
        figures: match release.solutions {
            true => own.pictures.iter().flat_map(|p| p.for_student(submission, &kit.drawn)).collect(),
            false => Vec::new(),
        },
        remark: if release.solutions { own.remark.clone() } else { String::new() },
        items: score.map(|s| items::groups(&kit.lab, question, s, scorecard, submission)).unwrap_or_default(),
        diagnosis: score
            .and_then(|s| s.items.iter().find_map(|i| i.diagnosis.as_ref()))
            .map(|diagnosis| items::diagnosis(&kit.lab, diagnosis)),
    }
}

fn findings(submission: &Submission) -> Vec<FindingView> {
    let mut views: Vec<_> =
        submission.findings.iter().take(MOST_FINDINGS).map(|f| finding(f, &submission.source)).collect();
    let more = submission.findings.len() - views.len();
    if more > 0 {
        let message = format!("{more} more findings of this file are not shown.");
        views.push(finding(&Finding::note("findings.more", message), &submission.source));
    }
    views
}

fn finding(finding: &Finding, source: &SourceText) -> FindingView {
    let mut view = FindingView {
        severity: finding.severity.word(),
        message_html: prose::sentences(&sanitize(&finding.message)),
        place: None,
        line_number: String::new(),
        line: None,
        caret: String::new(),
        help_html: finding.help.as_deref().map(|help| prose::sentences(&sanitize(help))),
    };
    if let Some(span) = finding.span {
        let at = source.position(span.start);
        let name = sanitize(&source.name);
        view.place = Some(format!("{name}, line {}, column {}", at.line, at.column));
        let (line, caret) = excerpt(source, span.start, span.end);
        view.line_number = at.line.to_string();
        view.caret = format!("{}{caret}", " ".repeat(view.line_number.len() + 1));
        view.line = Some(line);
    }
    view
}

/// The line about bytes `start..end`, cut to what is near, and the carets to set under it.
fn excerpt(source: &SourceText, start: usize, end: usize) -> (String, String) {
    const BEFORE: usize = 50;
    const AFTER: usize = 60;
    let floor = |mut i: usize| {
        i = i.min(source.text.len());
        while !source.text.is_char_boundary(i) {
            i -= 1;
        }
        i
    };
    let (start, end) = (floor(start), floor(end.max(start)));
    let left = source.text[..start].rfind('\n').map_or(0, |i| i + 1);
    let right = source.text[start..].find(['\n', '\r']).map_or(source.text.len(), |i| start + i);
    let before: Vec<char> = source.text[left..start].chars().collect();
    let kept = before.len().min(BEFORE);
    let lead = if kept < before.len() { "…" } else { "" };
    let before: String = before[before.len() - kept..].iter().collect();
    let after: String = source.text[start..right].chars().take(AFTER).collect();
    let trail = if after.len() < right - start { "…" } else { "" };
    let marked = source.text[start..end.min(right).max(start)].chars().take(AFTER).count().max(1);
    let tidy = |t: &str| sanitize(&t.replace('\t', " "));
    let line = format!("{lead}{}{}{trail}", tidy(&before), tidy(&after));
    (line, format!("{}{}", " ".repeat(lead.chars().count() + kept), "^".repeat(marked)))
}

fn observed(row: &ObservedRow, scorecard: &Scorecard, marks: bool) -> ObservedView {
    let given = scorecard.observed.iter().find(|(id, _)| *id == row.id).and_then(|(_, points)| *points);
    let earned = given.filter(|_| marks);
    let within = |from: Points, to: Points| earned.is_some_and(|p| (from..=to).contains(&p));
    ObservedView {
        title: row.title.clone(),
        outcomes: if row.outcomes.is_empty() {
            String::new()
        } else {
            format!("outcome {}", row.outcomes.join(", "))
        },
        levels: row
            .levels
            .iter()
            .map(|l| LevelView {
                band: if l.from == l.to { l.from.to_string() } else { format!("{}–{}", l.from, l.to) },
                text: l.text.clone(),
                reached: within(l.from, l.to),
            })
            .collect(),
        earned: earned.map(|p| p.to_string()),
        waiting: if marks { WAITING } else { WITHHELD },
        possible: row.points.to_string(),
    }
}

fn level_titles(row: &ObservedRow) -> Vec<String> {
    row.levels.iter().map(|l| l.title.clone()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check(rows: &[(&str, &str, &str, &str, &str)]) {
        for (what, text, marked, line, caret) in rows {
            let source = SourceText::new("a.yaml", *text);
            let start = text.find(marked).unwrap();
            let got = excerpt(&source, start, start + marked.len());
            assert_eq!((got.0.as_str(), got.1.as_str()), (*line, *caret), "{what}");
        }
    }

    #[test]
    fn the_caret_stands_under_the_word() {
        check(&[
            ("plain", "a: 1\nb: 1,5\nc: 2", "1,5", "b: 1,5", "   ^^^"),
            ("letters of several bytes", "θ: ½ö", "ö", "θ: ½ö", "    ^"),
            ("tab", "\tb: x", "x", " b: x", "    ^"),
            ("to the end of the line only", "a: [1\n2]", "[1\n2]", "a: [1", "   ^^"),
            ("windows line end", "a: x\r\nb", "x", "a: x", "   ^"),
        ]);
    }

    #[test]
    fn long_lines_are_cut_around_the_place() {
        let text = format!("{}bad{}", "x".repeat(500), "y".repeat(500));
        let (line, caret) = excerpt(&SourceText::new("a", text), 500, 503);
        assert!(line.chars().count() < 120 && line.starts_with('…') && line.ends_with('…'));
        assert_eq!(caret.find('^'), Some(51));
        assert_eq!(
            excerpt(&SourceText::new("a", "é"), 1, 99).1,
            "^",
            "offsets inside and beyond the text do no harm"
        );
    }
}
