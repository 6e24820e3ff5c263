use super::class_summary::ClassSummary;
use super::kit::{self, ReportKit};
use super::{answer_key, class_page, student};
use crate::grading::Scorecard;
use crate::lab::Release;
use crate::submission::Submission;

impl ReportKit {
    /// The report of one submission, one self-contained HTML file, with all there is to say.
    pub fn student_page(&self, submission: &Submission, scorecard: &Scorecard) -> String {
        self.released_page(submission, scorecard, Release::ALL)
    }

    /// The same with no more than is released.
    pub fn released_page(&self, submission: &Submission, scorecard: &Scorecard, release: Release) -> String {
        self.render("student.html", &student::page(self, submission, scorecard, release))
    }

    /// The same, in UTF-8 at the end of `bytes`: who writes many pages need not ask for memory for each.
    pub fn write_released_page(
        &self,
        bytes: &mut Vec<u8>,
        submission: &Submission,
        scorecard: &Scorecard,
        release: Release,
    ) {
        let page = student::page(self, submission, scorecard, release);
        kit::render_into(bytes, &self.environment, "student.html", &page);
    }

    /// The answer key: from the equations to every reference answer.
    pub fn reference_page(&self) -> String {
        self.reference_page_for(None)
    }

    /// The answer key for a student's own numbers.
    pub fn reference_page_for(&self, student: Option<&str>) -> String {
        self.render("reference.html", &answer_key::page(self, student))
    }

    /// `index.html` of a class.
    pub fn class_page(&self, summary: &ClassSummary) -> String {
        self.render("class.html", &class_page::page(self, summary))
    }

    fn render(&self, template: &str, page: &impl serde::Serialize) -> String {
        kit::render(&self.environment, template, page)
    }
}
