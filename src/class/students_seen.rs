use crate::lab::folded_id;
use crate::source::{Finding, Severity, sanitize};
use crate::submission::Student;
use std::collections::BTreeMap;

/// Which student ids have come up, and in which files: two files under one id are for a person to sort out.
#[derive(Debug, Default)]
pub struct StudentsSeen {
    /// By the folded id: as it was first spelled, and where.
    files: BTreeMap<String, (String, Vec<String>)>,
}

impl StudentsSeen {
    /// Notes who the answer file `file` is from; a finding for each id that was there before.
    pub fn add(&mut self, students: &[Student], file: &str) -> Vec<Finding> {
        let mut findings = Vec::new();
        for student in students {
            let folded = match folded_id(&student.id) {
                folded if folded.is_empty() => student.id.clone(),
                folded => folded,
            };
            let (_, files) = self.files.entry(folded).or_insert_with(|| (student.id.clone(), Vec::new()));
            if !files.is_empty() {
                findings.push(Finding {
                    severity: Severity::Warning,
                    code: "student.twice",
                    message: format!(
                        "Another file of this class gives the same student id, `{}`. A person has to say which counts.",
                        sanitize(&student.id)
                    ),
                    help: None,
                    span: None,
                });
            }
            files.push(file.to_owned());
        }
        findings
    }

    /// (id, files) of every id that more than one file gives.
    pub fn given_twice(&self) -> Vec<(String, Vec<String>)> {
        self.files.values().filter(|(_, files)| files.len() > 1).cloned().collect()
    }
}
