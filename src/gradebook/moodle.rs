use super::numbers::two_decimals;
use super::{ClassMarks, Export, ExportError, Person, Why};
use crate::class::disarmed;
use crate::lab::Points;

/// By what Moodle is to know a student: one of the fields of its import form.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Identity {
    /// `ID number`: the student id.
    #[default]
    IdNumber,
    Email,
    Username,
}

impl Identity {
    /// What the field is called in Moodle's import form.
    pub fn column(self) -> &'static str {
        match self {
            Self::IdNumber => "ID number",
            Self::Email => "Email address",
            Self::Username => "Username",
        }
    }

    fn of(self, person: &Person) -> String {
        let roster = person.roster.as_deref();
        let text = match self {
            Self::IdNumber => Some(person.id.clone()),
            Self::Email => roster.and_then(|row| row.email.clone()),
            Self::Username => roster.and_then(|row| row.sis_login_id.clone()),
        };
        text.unwrap_or_default().trim().to_owned()
    }
}

/// A CSV file for Moodle's grade import (Grades › Import › CSV file): who it is, the full name for whoever reads it, the mark.
///
/// - Who has no mark to pass on has no row: an empty grade is imported as none.
/// - Two decimals and a decimal point, which the importer reads in every language.
/// - One student whom Moodle does not know stops the whole import, so whoever is not on the roster is left out, where there is
///   one. So does a mark above 100 unless the site allows it; a note says so.
/// - Identifiers that a spreadsheet would run are left out, and such names get an apostrophe.
///
/// Source: moodle/moodle, `grade/import/csv/classes/load_data.php` (`map_user_data_with_value`, `check_user_exists`,
/// `update_grade_item`, `insert_grade_record`); `unformat_float` in `lib/moodlelib.php`.
pub fn moodle(class: &ClassMarks, identity: Identity, title: &str) -> Result<Export, ExportError> {
    let mut summary = class.summary();
    if class.out_of > Points(10_000) {
        summary.notes.push(format!(
            "marks are out of {}: Moodle refuses the whole file when a mark is above 100, unless the site allows it",
            class.out_of
        ));
    }
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record([identity.column(), "Full name", disarmed(title).as_str()])?;
    let is_there_a_roster = class.people.iter().any(|person| person.roster.is_some());
    for person in &class.people {
        let Ok(mark) = &person.mark else { continue };
        let id = identity.of(person);
        if is_there_a_roster && person.roster.is_none() {
            summary.leave_out(person.who(), Why::NotOnRoster);
        } else if id.is_empty() {
            summary.leave_out(person.who(), Why::NoIdentifier(identity.column()));
        } else if would_run(&id) {
            summary.leave_out(person.who(), Why::Formula);
        } else {
            writer.write_record([id, disarmed(&person.name), two_decimals(*mark)])?;
            summary.given += 1;
        }
    }
    let bytes = writer.into_inner().map_err(|error| std::io::Error::other(error.to_string()))?;
    Ok(Export { bytes, summary })
}

/// Whether a spreadsheet would take `text` for a formula, or a program for something other than what is seen.
pub fn would_run(text: &str) -> bool {
    disarmed(text) != text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::class::RosterStudent;

    fn person(id: &str, name: &str, email: &str, mark: Result<i64, Why>) -> Person {
        let row = RosterStudent { email: Some(email.to_owned()), ..RosterStudent::default() };
        Person {
            id: id.to_owned(),
            name: name.to_owned(),
            roster: (!email.is_empty()).then(|| Box::new(row)),
            handed_in: None,
            file: String::new(),
            mark: mark.map(Points),
            by_question: String::new(),
        }
    }

    #[test]
    fn a_row_for_each_mark_that_is_passed_on() {
        let class = ClassMarks {
            people: vec![
                person("EE-001", "Doe, \"Jane\"\r\n", "j@x.edu", Ok(7250)),
                person("EE-002", "@SUM(A1)", " ", Ok(10_000)),
                person("EE-003", "", "", Ok(10_000)),
                person("=1", "", "e@x.edu", Ok(1)),
                person("EE-004", "", "f@x.edu", Err(Why::Waits(3))),
            ],
            out_of: Points(10_000),
            of_nobody: vec!["x.yaml".to_owned()],
        };
        for (identity, rows, left_out) in [
            (
                Identity::IdNumber,
                "ID number,Full name,Lab 3\nEE-001,\"Doe, \"\"Jane\"\"\",72.50\nEE-002,'@SUM(A1),100.00\n",
                vec![Why::Nobody, Why::Waits(3), Why::NotOnRoster, Why::Formula],
            ),
            (
                Identity::Email,
                "Email address,Full name,Lab 3\nj@x.edu,\"Doe, \"\"Jane\"\"\",72.50\ne@x.edu,,0.01\n",
                vec![Why::Nobody, Why::Waits(3), Why::NoIdentifier("Email address"), Why::NotOnRoster],
            ),
        ] {
            let export = moodle(&class, identity, "Lab 3").unwrap();
            assert_eq!(String::from_utf8(export.bytes).unwrap(), rows);
            let why: Vec<Why> = export.summary.left_out.into_iter().map(|one| one.why).collect();
            assert_eq!(why, left_out, "{identity:?}");
        }
        let above = ClassMarks { out_of: Points(12_000), ..class };
        assert_eq!(moodle(&above, Identity::IdNumber, "x").unwrap().summary.notes.len(), 1);
    }
}
