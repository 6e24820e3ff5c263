//! The table `teacher_marks.txt`, read. Its head says how it is written.

use polemark::grading::Verdict;
use polemark::lab::{Criterion, LabDefinition, Points};
use std::collections::BTreeMap;
use std::fmt;

const TABLE: &str = include_str!("teacher_marks.txt");

/// The marks of one file, for every criterion of the lab.
pub struct Sheet {
    pub file: String,
    /// As stated in its heading.
    pub total: Points,
    pub marks: BTreeMap<String, Mark>,
}

/// What the teacher gives, and what the program is known to give instead.
#[derive(Clone)]
pub struct Mark {
    pub given: Given,
    pub program: Option<Given>,
}

#[derive(Clone)]
pub struct Given {
    pub points: Points,
    /// `Some(true)` for `1?`; `None` where the table leaves open whether a person has to look.
    pub provisional: Option<bool>,
    /// Where the table says so: `blank`, `unreadable`.
    pub verdict: Option<Verdict>,
    /// Where the table says so: how the answer stands to the student's own earlier one.
    pub own: Option<Own>,
    pub reason: String,
}

/// How an answer stands to the student's own earlier answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Own {
    Follows,
    /// The same mistake, charged before.
    Charged,
    Refused,
    Contradicts,
    Unsupported,
}

impl fmt::Display for Given {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.points)?;
        if self.provisional == Some(true) {
            write!(f, "?")?;
        }
        if let Some(verdict) = self.verdict {
            write!(f, " {verdict:?}")?;
        }
        match self.own {
            Some(own) => write!(f, " {own:?}"),
            None => Ok(()),
        }
    }
}

/// Reads the table. A line that cannot be read, or that names no criterion of `lab`, fails the test.
pub fn read(lab: &LabDefinition) -> Vec<Sheet> {
    let criteria: Vec<&Criterion> = lab.questions.iter().flat_map(|question| &question.criteria).collect();
    let mut sheets: Vec<Sheet> = Vec::new();
    let mut last: Vec<String> = Vec::new();
    for (index, line) in TABLE.lines().enumerate() {
        let at = format!("teacher_marks.txt:{}: `{line}`", index + 1);
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        if let Some(heading) = line.strip_prefix('[') {
            let (file, total) = heading.split_once("] ").unwrap_or_else(|| panic!("{at}: not a heading"));
            let total = points(total).unwrap_or_else(|| panic!("{at}: no sum"));
            sheets.push(Sheet { file: file.to_owned(), total, marks: BTreeMap::new() });
            continue;
        }
        let (words, reason) = line.split_once(" : ").unwrap_or((line, ""));
        let words: Vec<&str> = words.split_whitespace().collect();
        let (pattern, given, word) = match *words.as_slice() {
            [pattern, given] => (pattern, given, None),
            [pattern, given, word] => (pattern, given, Some(word)),
            _ => panic!("{at}: not a mark"),
        };
        let (verdict, own) = match word {
            None => (None, None),
            Some("blank") => (Some(Verdict::Blank), None),
            Some("unreadable") => (Some(Verdict::Unreadable), None),
            Some("follows") => (None, Some(Own::Follows)),
            Some("charged") => (None, Some(Own::Charged)),
            Some("refused") => (None, Some(Own::Refused)),
            Some("contradicts") => (None, Some(Own::Contradicts)),
            Some("unsupported") => (None, Some(Own::Unsupported)),
            Some(_) => panic!("{at}: not a verdict"),
        };
        let sheet = sheets.last_mut().unwrap_or_else(|| panic!("{at}: before the first heading"));
        let give = |id: &str, possible: Points| Given {
            points: match given.trim_end_matches('?') {
                "full" => possible,
                number => points(number).unwrap_or_else(|| panic!("{at}: not a number of points")),
            },
            provisional: provisional(id, given),
            verdict,
            own,
            reason: reason.to_owned(),
        };
        if pattern == "program" {
            for id in &last {
                let mark = sheet.marks.get_mut(id).unwrap_or_else(|| panic!("{at}: no mark above"));
                mark.program = Some(give(id, Points::ZERO));
            }
            continue;
        }
        last.clear();
        for criterion in criteria.iter().filter(|criterion| covers(pattern, &criterion.id)) {
            let given = give(&criterion.id, criterion.points);
            assert!(given.points <= criterion.points, "{at}: more than the {} possible", criterion.points);
            sheet.marks.insert(criterion.id.clone(), Mark { given, program: None });
            last.push(criterion.id.clone());
        }
        assert!(!last.is_empty(), "{at}: no criterion of this name");
    }
    sheets
}

/// Only of a plot does the table always say whether a person has to confirm the mark.
fn provisional(id: &str, given: &str) -> Option<bool> {
    match (given.ends_with('?'), id.ends_with(".plot") && given != "0") {
        (true, _) => Some(true),
        (false, true) => Some(false),
        (false, false) => None,
    }
}

fn covers(pattern: &str, id: &str) -> bool {
    match pattern.strip_suffix('*') {
        Some(beginning) => id.starts_with(beginning),
        None => pattern == id,
    }
}

fn points(text: &str) -> Option<Points> {
    let number: f64 = text.parse().ok()?;
    Some(Points((number * 100.0).round() as i64))
}
