use super::class_summary::ClassSummary;
use super::kit::ReportKit;
use super::{answer_key, class_page, prose, student};
use crate::grading::Scorecard;
use crate::submission::Submission;
use minijinja::value::Serde;

impl ReportKit {
    /// The report of one submission, one self-contained HTML file.
    pub fn student_page(&self, submission: &Submission, scorecard: &Scorecard) -> String {
        self.render("student.html", &student::page(self, submission, scorecard))
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
        let rendered = self.environment.get_template(template).and_then(|t| t.render(Serde(page)));
        // Templates and views are ours, and tested together; if they disagree all the same, the reader is told.
        rendered.unwrap_or_else(|e| {
            let words = prose::as_typed(&format!("polemark could not write this page: {e:#}"));
            format!("<!doctype html><html lang=\"en\"><title>Report</title>{words}</html>")
        })
    }
}
