//! A lab proves itself: its key agrees with stated values and with a second route, its model answer earns everything,
//! a blank nothing.

mod blind_tolerance;
mod computed_answer;
mod missing;
mod mistakes;
mod near_misses;
mod variants;

pub use missing::{Missing, missing, to_paste};

use crate::grading::{Catalogue, ItemScore, Verdict, grade};
use crate::lab::{LabDefinition, Points};
use crate::reference::{Reference, check_expectations, second_route};
use crate::source::SourceText;
use crate::submission::{NoFiles, Submission, read};
use std::collections::BTreeMap;

/// One thing that must hold of a lab.
#[derive(Clone, Debug, PartialEq)]
pub struct Check {
    pub what: String,
    /// What was found, in words; for a failed check also what was wanted.
    pub found: String,
    pub holds: bool,
    /// Where in the lab file, when there is one place.
    pub span: Option<crate::source::Span>,
}

/// Every check of `lab` against its computed `reference`, in a fixed order.
pub fn prove(lab: &LabDefinition, reference: &Reference) -> Vec<Check> {
    let mut checks = vec![points_add_up(lab)];
    checks.extend(stated_values(lab, reference));
    checks.extend(second_routes(lab, reference));
    checks.push(model_answer_reads(lab));
    checks.extend(model_answer_earns_everything(lab, reference));
    checks.push(blank_earns_nothing(lab, reference));
    checks.extend(near_misses::near_misses(lab, reference));
    checks.push(template_is_blank(lab));
    checks.extend(answers_of_other_points_are_told_apart(lab, reference));
    checks.extend(mistakes::mistakes_are_told_apart(lab, reference));
    checks.extend(variants::variants_are_fair(lab, reference));
    checks
}

fn points_add_up(lab: &LabDefinition) -> Check {
    let criteria: Points = lab.questions.iter().flat_map(|q| &q.criteria).map(|c| c.points).sum();
    let questions: Points = lab.questions.iter().map(|q| q.points).sum();
    let cover: Points = lab.cover.rows.iter().map(|row| row.points).sum();
    Check {
        what: "points add up".to_owned(),
        found: format!(
            "{} questions worth {questions}, their criteria {criteria}; cover sheet {cover} of {}",
            lab.questions.len(),
            lab.cover.total
        ),
        holds: criteria == questions && cover == lab.cover.total,
        span: None,
    }
}

fn stated_values(lab: &LabDefinition, reference: &Reference) -> Vec<Check> {
    let disagreements = check_expectations(reference, &lab.expectations);
    // That there are none is said with what is missing.
    if disagreements.is_empty() && !lab.expectations.is_empty() {
        return vec![Check {
            what: "stated values".to_owned(),
            found: format!("agree with the computed reference at {} places", lab.expectations.len()),
            holds: true,
            span: None,
        }];
    }
    disagreements
        .into_iter()
        .map(|d| Check {
            what: format!("stated value `{}`", d.path),
            found: d.message,
            holds: false,
            span: Some(d.span),
        })
        .collect()
}

fn second_routes(lab: &LabDefinition, reference: &Reference) -> Vec<Check> {
    second_route(lab, reference)
        .into_iter()
        .map(|agreement| Check {
            found: {
                let digits = match agreement.digits {
                    d if d.is_infinite() => "equal".to_owned(),
                    d if agreement.holds() => format!("{d:.1} digits"),
                    d => format!("only {d:.1} digits agree, {:.1} are wanted", agreement.wanted),
                };
                match agreement.note.as_str() {
                    "" => format!("{digits}, {}", agreement.routes),
                    note => format!("{digits}, {}; {note}", agreement.routes),
                }
            },
            holds: agreement.holds(),
            span: operating_point(lab, &agreement.what),
            what: agreement.what,
        })
        .collect()
}

/// Where the operating point stands that a check is about: `cart.hanging poles`.
fn operating_point(lab: &LabDefinition, what: &str) -> Option<crate::source::Span> {
    let (path, _) = what.split_once(' ')?;
    let (model, point) = path.split_once('.')?;
    let model = lab.models.iter().find(|one| one.id == model)?;
    model.operating_points.iter().find(|one| one.id == point).map(|point| point.span)
}

fn model_answer_reads(lab: &LabDefinition) -> Check {
    let findings = &lab.model_answer.findings;
    Check {
        what: "model answer reads".to_owned(),
        found: match findings.first() {
            None => format!("{} answers, no findings", lab.model_answer.answers.len()),
            Some(first) => format!("{} findings, the first: {}", findings.len(), first.message),
        },
        holds: findings.is_empty() && lab.model_answer.readable,
        span: None,
    }
}

fn model_answer_earns_everything(lab: &LabDefinition, reference: &Reference) -> Vec<Check> {
    let card = grade(lab, reference, &Catalogue::default(), &lab.model_answer, None);
    let items = card.questions.iter().flat_map(|q| &q.items);
    // What the model answer leaves out is said with what is missing.
    let (blank, items): (Vec<&ItemScore>, Vec<_>) =
        items.partition(|item| item.verdict == Verdict::Blank || item.code == "inconclusive");
    let spans: BTreeMap<&str, _> =
        lab.questions.iter().flat_map(|q| &q.criteria).map(|c| (c.id.as_str(), c.span)).collect();
    let lost: Vec<Check> = items
        .iter()
        .filter(|item| item.verdict != Verdict::Right || item.earned != item.possible)
        .map(|item| Check {
            what: format!("model answer at `{}`", item.id),
            found: format!(
                "earns {} of {} ({}): {}",
                item.earned, item.possible, item.code, item.evidence.reason
            ),
            holds: false,
            span: spans.get(item.id.as_str()).copied(),
        })
        .collect();
    if !lost.is_empty() {
        return lost;
    }
    let left_out: Points = blank.iter().map(|item| item.possible).sum();
    let (earned, possible) = (card.total.earned, card.total.possible);
    let found = match blank.len() {
        0 => format!("earns {earned} of {possible}, so each of the {} criteria can be reached", items.len()),
        n => format!(
            "earns {earned} of {possible}, and leaves {n} criteria worth {left_out} unanswered or to a person"
        ),
    };
    vec![Check { what: "model answer".to_owned(), found, holds: earned + left_out == possible, span: None }]
}

fn blank_earns_nothing(lab: &LabDefinition, reference: &Reference) -> Check {
    let card = grade(lab, reference, &Catalogue::default(), &empty_submission(lab), None);
    Check {
        what: "blank answer".to_owned(),
        found: format!("earns {} of {}", card.total.earned, card.total.possible),
        holds: card.total.earned == Points::ZERO,
        span: None,
    }
}

fn empty_submission(lab: &LabDefinition) -> Submission {
    Submission {
        id: "blank".to_owned(),
        source: SourceText::new("blank", ""),
        lab: Some(lab.id.clone()),
        students: Vec::new(),
        answers: BTreeMap::new(),
        findings: Vec::new(),
        readable: true,
    }
}

fn template_is_blank(lab: &LabDefinition) -> Check {
    let template = read("template", "template", lab.answer_template().as_bytes(), &lab.sheet, &NoFiles);
    let about_answers = template.findings.iter().find(|f| !f.code.starts_with("student"));
    Check {
        what: "answer template".to_owned(),
        found: match about_answers {
            None => format!("reads without findings, {} answers filled in", template.answers.len()),
            Some(finding) => format!("has a finding: {}", finding.message),
        },
        holds: template.readable && template.answers.is_empty() && about_answers.is_none(),
        span: None,
    }
}

/// Two operating points whose transfer functions are equal up to a factor could be answered with one another's answer.
fn answers_of_other_points_are_told_apart(lab: &LabDefinition, reference: &Reference) -> Vec<Check> {
    let mut checks = Vec::new();
    for model in &reference.models {
        for (index, first) in model.operating_points.iter().enumerate() {
            for second in &model.operating_points[index + 1..] {
                let (a, b) = (
                    &first.main().linearization.transfer_function,
                    &second.main().linearization.transfer_function,
                );
                checks.push(Check {
                    what: format!("{}: {} and {}", model.id, first.id, second.id),
                    found: if a.equals(b) {
                        "have the same transfer function: an answer to one cannot be told from an answer to the other"
                            .to_owned()
                    } else {
                        "have different transfer functions".to_owned()
                    },
                    holds: !a.equals(b) || !asks_for_both(lab, &model.id, &first.id, &second.id),
                    span: None,
                });
            }
        }
    }
    checks
}

fn asks_for_both(lab: &LabDefinition, model: &str, first: &str, second: &str) -> bool {
    let asked = |point: &str| {
        let about = format!("{model}.{point}");
        lab.sheet.fields.iter().any(|field| field.about.as_deref() == Some(about.as_str()))
    };
    asked(first) && asked(second)
}
