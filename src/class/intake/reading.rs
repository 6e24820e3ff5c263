use super::place::attachments;
use super::{AnswerFile, NotRead, Place};
use crate::class::marked::{our_failure, unreadable_submission};
use crate::english::listed;
use crate::source::{Finding, Severity, sanitize};
use crate::submission::{AnswerSheet, Attachments, Student, Submission, read};
use std::panic::{AssertUnwindSafe, catch_unwind};

impl AnswerFile {
    /// At most a little more than an answer file may hold, so that a huge one is refused without being read.
    pub fn read_capped(&self) -> Result<Vec<u8>, NotRead> {
        match &self.place {
            Place::File(path) if path.is_symlink() && !self.followed => Err(NotRead::Link),
            place => place.read_capped(),
        }
    }

    /// The files that its answers may name.
    pub fn attachments(&self) -> Box<dyn Attachments> {
        attachments(&self.place, &self.beside)
    }

    /// The submission in it. Never fails: what cannot be read says so.
    pub fn read(&self, sheet: &AnswerSheet) -> Submission {
        self.read_from(&self.read_capped(), sheet, &*self.attachments())
    }

    /// The submission in `content`, which [`read_capped`](Self::read_capped) has read.
    pub fn read_from(
        &self,
        content: &Result<Vec<u8>, NotRead>,
        sheet: &AnswerSheet,
        attachments: &dyn Attachments,
    ) -> Submission {
        if !self.only_others.is_empty() {
            return unreadable_submission(&self.id, &self.name, no_answers(&self.only_others));
        }
        let reading = || match content {
            Ok(bytes) => read(&self.id, &self.name, bytes, sheet, attachments),
            Err(why) => unreadable_submission(&self.id, &self.name, why.finding()),
        };
        let mut submission = catch_unwind(AssertUnwindSafe(reading))
            .unwrap_or_else(|_| unreadable_submission(&self.id, &self.name, our_failure()));
        if submission.students.is_empty() {
            submission.students.push(Student { id: self.id.clone(), name: String::new() });
        }
        submission
    }
}

/// Names of files listed.
const MOST_NAMED: usize = 5;

fn no_answers(others: &[String]) -> Finding {
    let own = |name: &String| {
        let name = name.rsplit('/').next().unwrap_or(name);
        format!("`{}`", sanitize(&name.chars().take(100).collect::<String>()))
    };
    let mut names: Vec<String> = others.iter().take(MOST_NAMED).map(own).collect();
    if others.len() > MOST_NAMED {
        names.push(format!("{} more", others.len() - MOST_NAMED));
    }
    Finding {
        severity: Severity::Error,
        code: "intake.wrong_type",
        message: format!(
            "What was handed in, {}, holds no answers that polemark reads.",
            listed(&names, "and")
        ),
        help: Some(
            "Hand in the answer file, whose name ends in `.yaml`; pictures and data go with it.".to_owned(),
        ),
        span: None,
    }
}
