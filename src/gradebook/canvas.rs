use super::directory::{Directory, Key};
use super::moodle::would_run;
use super::numbers::two_decimals;
use super::table::{Row, Table};
use super::{ClassMarks, Export, ExportError, Why, points_of};
use crate::class::{Lms, disarmed};

/// A file for Canvas' gradebook import, made from the gradebook that Canvas exported.
///
/// - The columns up to `Section`, which say who it is, as they are in the export, and one assignment, whose header is
///   `Title (id)`; no other assignment, no totals, no columns of the teacher's own, so that nothing else can change.
/// - The rows of those whose mark is passed on, in the order of the export. Nobody else has a row: an empty cell would take
///   away the score that is there: only where both are empty does the importer see no change, and what it shows as a change is sent.
/// - Whoever is excused (`EX`) stays excused, and the test student has no row.
/// - The row `Points Possible` as it is, and `Manual Posting` where there is one.
/// - Marks have two decimals, to which the importer rounds both sides before it compares them, and a decimal point.
/// - Comma or semicolon as in the export; no byte order mark, for the importer's `LastName` is not found behind one.
///
/// `assignment` is the title, the number or both. Errors: no such assignment; the points of the assignment are not those of the
/// marks.
/// Source: instructure/canvas-lms, `lib/gradebook_importer.rb` (`header?`, `update_column_count`, `strip_non_assignment_columns`,
/// `check_for_non_student_row`, `no_change_to_value?`), `Assignment.title_and_id`, `lib/gradebook_exporter.rb`, and
/// `populateGradeDataPerSubmission` of its page.
pub fn canvas_filled(
    class: &ClassMarks,
    file: &[u8],
    assignment: Option<&str>,
) -> Result<Export, ExportError> {
    let table = Table::parse(file)?;
    let sheet = Sheet::find(&table, assignment)?;
    let mut summary = class.summary();
    let mut bytes = Vec::with_capacity(file.len());
    let mut directory = Directory::default();
    let mut students = Vec::new();
    for (at, row) in table.rows.iter().enumerate() {
        let first = table.text(row, 0);
        if at == 0 || sheet.says_manual_posting(&table, row) {
            sheet.write(&table, row, table.raw(row, sheet.assignment), &mut bytes);
        } else if first.contains("Points Possible") {
            sheet.check_points(&table, row, class, &mut summary.notes)?;
            sheet.write(&table, row, table.raw(row, sheet.assignment), &mut bytes);
        } else if !sheet.is_test_student(&table, row) {
            sheet.enter(&table, at, row, &mut directory);
            students.push(at);
        }
    }
    let matched = directory.matched(&class.people, Lms::Canvas, &mut summary);
    for at in students {
        let Some(row) = table.rows.get(at) else { continue };
        let Some(person) = matched.rows.get(&at).and_then(|person| class.people.get(*person)) else {
            summary.not_in_class.push(sheet.name(&table, row));
            continue;
        };
        let Ok(mark) = &person.mark else { continue };
        match table.text(row, sheet.assignment).as_str() {
            cell if cell.eq_ignore_ascii_case("EX") => summary.leave_out(person.who(), Why::Excused),
            "N/A" => summary.leave_out(person.who(), Why::NotAssigned),
            _ => {
                sheet.write(&table, row, two_decimals(*mark).as_bytes(), &mut bytes);
                summary.given += 1;
            }
        }
    }
    Ok(Export { bytes, summary })
}

/// Where things are in an exported gradebook.
struct Sheet {
    /// Columns that say who it is: so many from the left.
    identity: usize,
    assignment: usize,
    /// Of the name (one or two), Canvas' number, the SIS ids.
    names: Vec<usize>,
    number: usize,
    identifiers: Vec<usize>,
}

impl Sheet {
    fn find(table: &Table<'_>, assignment: Option<&str>) -> Result<Self, ExportError> {
        let header = table.header();
        let column = |name: &str| header.iter().position(|one| one == name);
        let names: Vec<usize> = match (column("Student"), column("LastName"), column("FirstName")) {
            (Some(student), _, _) => vec![student],
            (None, Some(last), Some(first)) => vec![last, first],
            _ => return Err(ExportError::NotCanvas("its first column is not `Student`")),
        };
        if names.first() != Some(&0) {
            return Err(ExportError::NotCanvas("its first column is not `Student`"));
        }
        let number = column("ID").ok_or(ExportError::NotCanvas("it has no column `ID`"))?;
        let section = column("Section").ok_or(ExportError::NotCanvas("it has no column `Section`"))?;
        if number != names.len() || number > section {
            return Err(ExportError::NotCanvas("its columns are in another order"));
        }
        let identifiers =
            ["SIS User ID", "SIS Login ID", "Integration ID"].into_iter().filter_map(column).collect();
        let assignment = chosen(&header, section + 1, assignment)?;
        Ok(Self { identity: section + 1, assignment, names, number, identifiers })
    }

    /// The columns of a row that are kept, with `cell` for the assignment.
    fn write(&self, table: &Table<'_>, row: &Row, cell: &[u8], bytes: &mut Vec<u8>) {
        for column in 0..self.identity {
            bytes.extend_from_slice(table.raw(row, column));
            bytes.push(table.separator);
        }
        bytes.extend_from_slice(cell);
        bytes.push(b'\n');
    }

    /// `Muted` or `Manual Posting` for the assignment, and nothing in front.
    fn says_manual_posting(&self, table: &Table<'_>, row: &Row) -> bool {
        let nobody = (0..self.identity).all(|column| table.text(row, column).is_empty());
        let said = table.text(row, self.assignment).to_lowercase();
        nobody && (said == "muted" || said.starts_with("manual posting"))
    }

    /// Canvas' `Student, Test`, and what is nobody's row.
    fn is_test_student(&self, table: &Table<'_>, row: &Row) -> bool {
        let name = self.name(table, row);
        let nobody = (0..self.identity).all(|column| table.text(row, column).is_empty());
        nobody || name.eq_ignore_ascii_case("Student, Test")
    }

    fn name(&self, table: &Table<'_>, row: &Row) -> String {
        self.names.iter().map(|column| unwrapped(&table.text(row, *column))).collect::<Vec<_>>().join(", ")
    }

    fn enter(&self, table: &Table<'_>, at: usize, row: &Row, directory: &mut Directory) {
        directory.add(at, Key::Number, &table.text(row, self.number));
        for column in &self.identifiers {
            directory.add(at, Key::Identifier, &table.text(row, *column));
        }
        directory.add(at, Key::Name, &self.name(table, row));
    }

    fn check_points(
        &self,
        table: &Table<'_>,
        row: &Row,
        class: &ClassMarks,
        notes: &mut Vec<String>,
    ) -> Result<(), ExportError> {
        let cell = table.text(row, self.assignment);
        let lower = cell.to_lowercase();
        if lower.contains("read only") {
            return Err(ExportError::ReadOnly(
                table.header().get(self.assignment).cloned().unwrap_or_default(),
            ));
        }
        if cell.is_empty() {
            notes.push("Canvas does not say how many points the assignment is out of".to_owned());
            return Ok(());
        }
        let theirs = points_of(&cell).ok_or(ExportError::NoMaximum(cell))?;
        if theirs == class.out_of { Ok(()) } else { Err(ExportError::Scale { theirs, ours: class.out_of }) }
    }
}

/// A name that Canvas wrote as `="…"`, because it would have been a formula.
fn unwrapped(name: &str) -> String {
    name.strip_prefix("=\"").and_then(|rest| rest.strip_suffix('"')).unwrap_or(name).to_owned()
}

/// What the importer takes for totals of its own wherever it is in a header.
const TOTALS: &[&str] = &[
    "Current Score",
    "Current Points",
    "Current Grade",
    "Final Score",
    "Final Points",
    "Final Grade",
    "Override Score",
    "Override Grade",
    "Override Status",
];

/// A column of an assignment.
#[derive(Clone, Copy)]
struct Candidate<'a> {
    column: usize,
    header: &'a str,
    title: &'a str,
    id: &'a str,
}

/// The column of the assignment that `wanted` names: by its header, its number, its title; then by its title in any letters.
fn chosen(header: &[String], from: usize, wanted: Option<&str>) -> Result<usize, ExportError> {
    let is_total = |name: &str| TOTALS.iter().any(|total| name.contains(total));
    let columns = header.iter().enumerate().skip(from);
    let all = columns.filter_map(|(column, header)| {
        let (title, id) = title_and_id(header)?;
        Some(Candidate { column, header, title, id })
    });
    let (totals, open): (Vec<_>, Vec<_>) = all.partition(|one| is_total(one.header));
    let listed = |some: &[Candidate<'_>]| {
        some.iter().map(|one| format!("`{}`", one.header)).collect::<Vec<_>>().join(", ")
    };
    let Some(wanted) = wanted.map(str::trim) else {
        return match open.as_slice() {
            [one] => Ok(one.column),
            [] => Err(ExportError::NoAssignments),
            several => Err(ExportError::WhichAssignment { candidates: listed(several) }),
        };
    };
    if totals.iter().any(|one| one.header == wanted) {
        return Err(ExportError::TakenForTotal(wanted.to_owned()));
    }
    let number = wanted.trim_start_matches('(').trim_end_matches(')');
    let lower = wanted.to_lowercase();
    let ways: [fn(&Candidate<'_>, [&str; 3]) -> bool; 4] = [
        |one, [wanted, _, _]| one.header == wanted,
        |one, [_, number, _]| one.id == number,
        |one, [wanted, _, _]| one.title == wanted,
        |one, [_, _, lower]| one.title.to_lowercase() == lower,
    ];
    for way in ways {
        let found: Vec<_> = open.iter().filter(|one| way(one, [wanted, number, &lower])).copied().collect();
        match found.as_slice() {
            [] => {}
            [one] => return Ok(one.column),
            several => {
                let (wanted, candidates) = (wanted.to_owned(), listed(several));
                return Err(ExportError::SeveralAssignments { wanted, candidates });
            }
        }
    }
    match open.as_slice() {
        [] => Err(ExportError::NoAssignments),
        open => Err(ExportError::NoAssignment { wanted: wanted.to_owned(), candidates: listed(open) }),
    }
}

/// `Title (123)`.
fn title_and_id(header: &str) -> Option<(&str, &str)> {
    let (title, id) = header.strip_suffix(')')?.rsplit_once(" (")?;
    (!id.is_empty() && id.bytes().all(|byte| byte.is_ascii_digit())).then_some((title, id))
}

/// A file for Canvas' gradebook import from the roster alone: `Student,ID,SIS User ID,SIS Login ID,Section` and the assignment.
///
/// `assignment` must be `Title (id)`, for Canvas makes a new assignment of any other. There is no row `Points Possible`: it would
/// set the points of the assignment. Who has neither Canvas' number nor a SIS id in the roster is left out: by the name alone
/// Canvas may find somebody else. Identifiers that a spreadsheet would run are left out, and such names get an apostrophe.
/// Source: as for [`canvas_filled`].
pub fn canvas_by_roster(class: &ClassMarks, assignment: &str) -> Result<Export, ExportError> {
    let assignment = assignment.trim();
    if title_and_id(assignment).is_none() {
        return Err(ExportError::NoCanvasId(assignment.to_owned()));
    }
    if TOTALS.iter().any(|total| assignment.contains(total)) {
        return Err(ExportError::TakenForTotal(assignment.to_owned()));
    }
    let mut summary = class.summary();
    summary.notes.push(format!(
        "marks are out of {}: see that the assignment in Canvas is too, for without its gradebook it cannot be checked",
        class.out_of
    ));
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(["Student", "ID", "SIS User ID", "SIS Login ID", "Section", assignment])?;
    for person in &class.people {
        let Ok(mark) = &person.mark else { continue };
        let text = |text: &Option<String>| text.clone().unwrap_or_default();
        let roster = person.roster.as_deref().cloned().unwrap_or_default();
        let ids = [text(&roster.canvas_id), text(&roster.sis_user_id), text(&roster.sis_login_id)];
        if ids.iter().all(String::is_empty) {
            summary.leave_out(person.who(), Why::NoIdentifier("Canvas or SIS id in the roster"));
            continue;
        }
        if ids.iter().any(|id| would_run(id)) {
            summary.leave_out(person.who(), Why::Formula);
            continue;
        }
        let [id, user, login] = ids;
        let (name, section) = (disarmed(&person.name), disarmed(&text(&roster.section)));
        writer.write_record([name, id, user, login, section, two_decimals(*mark)])?;
        summary.given += 1;
    }
    let bytes = writer.into_inner().map_err(|error| std::io::Error::other(error.to_string()))?;
    Ok(Export { bytes, summary })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gradebook::tests::class;

    const EXPORT: &str = "Student,ID,SIS User ID,SIS Login ID,Section,Notes,Homework (7),Lab 3 (42),\"Lab, 3 (43)\",Current Score,Final Score\n\
        ,,,,,,,Manual Posting,,,\n\
        \"    Points Possible\",,,,,,10.00,100.00,50.00,(read only),(read only)\n\
        \"Doe, Jane\",11,EE-001,jdoe,S1,nice,9.00,,,90.0,90.0\n\
        \"Smith, John\",12,EE-002,jsmith,S1,,8.00,50.00,,80.0,80.0\n\
        \"=\"\"=Cmd\"\"\",13,EE-003,x,S1,,8.00,EX,,80.0,80.0\n\
        \"Nunez, Jose\",14,EE-004,n,S1,,8.00,N/A,,80.0,80.0\n\
        \"Else, Some\",15,EE-005,e,S1,,8.00,30.00,,80.0,80.0\n\
        \"Student, Test\",99,,0a1b2c,S1,,,,,,\n";

    #[track_caller]
    fn check(what: &str, class: &ClassMarks, file: &str, assignment: Option<&str>, rows: &str) {
        let shown = match canvas_filled(class, file.as_bytes(), assignment) {
            Ok(export) => String::from_utf8(export.bytes).unwrap(),
            Err(error) => error.to_string(),
        };
        assert_eq!(shown, rows, "{what}");
    }

    #[test]
    fn only_identity_and_the_assignment_are_written() {
        let waits = class(&[
            ("EE-001", "Jane Doe", Ok(7250)),
            ("EE-002", "John Smith", Err(Why::Waits(2))),
            ("EE-003", "", Ok(100)),
            ("EE-004", "", Ok(100)),
            ("EE-009", "No One", Ok(100)),
        ]);
        check(
            "held, excused, not assigned, unknown and test student have no row",
            &waits,
            EXPORT,
            Some("Lab 3"),
            "Student,ID,SIS User ID,SIS Login ID,Section,Lab 3 (42)\n,,,,,Manual Posting\n\
             \"    Points Possible\",,,,,100.00\n\"Doe, Jane\",11,EE-001,jdoe,S1,72.50\n",
        );
        let export = canvas_filled(&waits, EXPORT.as_bytes(), Some("42")).unwrap();
        let why: Vec<(&str, &Why)> =
            export.summary.left_out.iter().map(|one| (&*one.who, &one.why)).collect();
        assert_eq!(
            why,
            [
                ("EE-002 (John Smith)", &Why::Waits(2)),
                ("EE-009 (No One)", &Why::NotThere),
                ("EE-003", &Why::Excused),
                ("EE-004", &Why::NotAssigned),
            ]
        );
        assert_eq!((export.summary.given, export.summary.not_in_class), (1, vec!["Else, Some".to_owned()]));
    }

    #[test]
    fn the_assignment_is_found_by_title_or_number() {
        let jane = class(&[("EE-001", "Jane Doe", Ok(7250))]);
        let header = |assignment| {
            let export = canvas_filled(&jane, EXPORT.as_bytes(), assignment);
            export.map_or_else(
                |error| error.to_string(),
                |export| String::from_utf8(export.bytes).unwrap().lines().next().unwrap().to_owned(),
            )
        };
        let identity = "Student,ID,SIS User ID,SIS Login ID,Section";
        for wanted in ["Lab 3 (42)", "42", "(42)", "Lab 3", "lab 3", " Lab 3 "] {
            assert_eq!(header(Some(wanted)), format!("{identity},Lab 3 (42)"), "{wanted}");
        }
        let all = "`Homework (7)`, `Lab 3 (42)`, `Lab, 3 (43)`";
        assert_eq!(
            header(Some("Lab 4")),
            format!("no assignment in the gradebook is called `Lab 4`; there are {all}")
        );
        assert_eq!(
            header(None),
            format!("say with `--assignment` which assignment the marks are for: {all}")
        );
        assert!(
            header(Some("43"))
                .contains("out of 50 points in the file, the marks are out of 100: add `--scale-to 50`")
        );
    }

    #[test]
    fn other_exports_are_read_too() {
        let jane = class(&[("EE-001", "Jane Doe", Ok(7250))]);
        check(
            "semicolons, decimal comma, byte order mark, CRLF",
            &jane,
            "\u{feff}Student;ID;SIS Login ID;Section;Lab (1)\r\n    Points Possible;;;;100,00\r\nDoe, Jane;1;ee001;S;12,00\r\n",
            None,
            "Student;ID;SIS Login ID;Section;Lab (1)\n    Points Possible;;;;100,00\nDoe, Jane;1;ee001;S;72.50\n",
        );
        check(
            "family name and first name in columns of their own",
            &jane,
            "LastName,FirstName,ID,SIS Login ID,Section,Lab (1)\n    Points Possible,,,,,100\nDoe,Jane,1,,S,\n",
            None,
            "LastName,FirstName,ID,SIS Login ID,Section,Lab (1)\n    Points Possible,,,,,100\nDoe,Jane,1,,S,72.50\n",
        );
        check(
            "a total with a number behind it is no assignment",
            &jane,
            "Student,ID,Section,Lab (1),Final Score (2020)\n    Points Possible,,,100,(read only)\n\"Doe, Jane\",1,S,,\n",
            None,
            "Student,ID,Section,Lab (1)\n    Points Possible,,,100\n\"Doe, Jane\",1,S,72.50\n",
        );
        check(
            "a total",
            &jane,
            "Student,ID,Section,Final Score (2)\n",
            Some("Final Score (2)"),
            "Canvas would not read a column called `Final Score (2)`: it takes it for one of its own totals",
        );
        check(
            "no gradebook",
            &jane,
            "id,name\n1,2\n",
            None,
            "the file of the LMS is no Canvas gradebook: its first column is not `Student`",
        );
        check(
            "no assignment",
            &jane,
            "Student,ID,Section\n",
            None,
            "there is no assignment in the gradebook: make it in Canvas first, then export the gradebook",
        );
        check(
            "read only",
            &jane,
            "Student,ID,Section,Lab (1)\n Points Possible,,,(read only)\n",
            None,
            "Canvas says that `Lab (1)` is read only",
        );
    }

    #[test]
    fn without_a_gradebook_the_roster_says_who_it_is() {
        let mut class = class(&[
            ("EE-001", "=1+1", Ok(7250)),
            ("EE-002", "John", Ok(1)),
            ("EE-003", "Eve", Ok(1)),
            ("EE-004", "Max", Err(Why::Waits(1))),
        ]);
        let row = |id: &str, login: &str| crate::class::RosterStudent {
            canvas_id: Some(id.to_owned()),
            sis_login_id: Some(login.to_owned()),
            ..Default::default()
        };
        class.people[0].roster = Some(Box::new(row("11", "jdoe")));
        class.people[2].roster = Some(Box::new(row("13", "=HYPERLINK(1)")));
        let export = canvas_by_roster(&class, "Lab 3 (42)").unwrap();
        assert_eq!(
            String::from_utf8(export.bytes).unwrap(),
            "Student,ID,SIS User ID,SIS Login ID,Section,Lab 3 (42)\n'=1+1,11,,jdoe,,72.50\n"
        );
        let why: Vec<&Why> = export.summary.left_out.iter().map(|one| &one.why).collect();
        assert_eq!(
            why,
            [&Why::Waits(1), &Why::NoIdentifier("Canvas or SIS id in the roster"), &Why::Formula]
        );
        assert!(matches!(canvas_by_roster(&class, "Lab 3"), Err(ExportError::NoCanvasId(_))));
    }
}
