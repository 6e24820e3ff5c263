use super::anchor::{item_anchor, question_anchor};
use super::view::LinkView;
use crate::grading::{ItemScore, QuestionScore, Scorecard};
use crate::lab::{LabDefinition, Question};

/// Where a criterion stands: its question and its score.
#[derive(Clone, Copy)]
pub struct Place<'a> {
    pub question: &'a Question,
    pub score: &'a QuestionScore,
    pub item: &'a ItemScore,
}

/// The place of a criterion; `None` for one that the lab does not have.
pub fn find<'a>(lab: &'a LabDefinition, scorecard: &'a Scorecard, item: &str) -> Option<Place<'a>> {
    scorecard.questions.iter().find_map(|score| {
        let item = score.items.iter().find(|i| i.id == item)?;
        let question = lab.questions.iter().find(|q| q.id == score.id)?;
        Some(Place { question, score, item })
    })
}

impl Place<'_> {
    /// `Denominator`
    pub fn title(&self) -> LinkView {
        LinkView { anchor: item_anchor(&self.item.id), words: self.item.title.clone() }
    }

    /// `Task 1, question 3: Denominator`
    pub fn full(&self) -> LinkView {
        let words = format!("{}: {}", self.question.number, self.item.title);
        LinkView { anchor: item_anchor(&self.item.id), words }
    }
}

/// `Transfer function about θ = 0`
pub fn question_link(question: &Question) -> LinkView {
    LinkView { anchor: question_anchor(&question.id), words: question.title.clone() }
}
