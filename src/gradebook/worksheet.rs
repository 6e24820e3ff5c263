use super::directory::{Directory, Key};
use super::numbers::two_decimals;
use super::table::{Row, Table};
use super::{ClassMarks, Export, ExportError, Why, points_of};
use crate::class::Lms;

/// Moodle's offline grading worksheet with the marks in its column `Grade`; all other bytes as they were.
///
/// - So the separator, quotes, line ends, byte order mark and encoding stay, and so does `Last modified (grade)`, by which
///   the importer tells whether somebody has changed a grade since the worksheet was downloaded.
/// - Whose mark is not passed on keeps the cell as it is: the importer changes nothing where the grade is empty, or the same.
/// - A decimal comma where the worksheet has one (`100,00`); the importer reads both in such a language.
/// - `Grade can be changed` = No: left alone, as the importer would.
/// - The column `Maximum Grade` must be what the marks are out of: the importer skips what is above it.
/// - With `comments`, empty cells of `Feedback comments` get the points by question; those with something in them never change.
///
/// Columns are known in English, German, French and Spanish, and must not be renamed: the importer looks for them in the
/// language of whoever uploads.
/// Source: moodle/moodle, `mod/assign/feedback/offline/importgradeslib.php` and `locallib.php` (`process_import_grades`),
/// `mod/assign/gradingtable.php` (`col_recordid`, `col_grademax`, `col_gradecanbechanged`, `display_grade`).
pub fn worksheet(class: &ClassMarks, file: &[u8], comments: bool) -> Result<Export, ExportError> {
    let table = Table::parse(file)?;
    let columns = Columns::find(&table)?;
    let mut summary = class.summary();
    let rows = || table.rows.iter().enumerate().skip(1);
    let mut directory = Directory::default();
    for (at, row) in rows() {
        columns.check_maximum(&table, row, class)?;
        columns.enter(&table, at, row, &mut directory);
    }
    let matched = directory.matched(&class.people, Lms::Moodle, &mut summary);
    let comma = rows().any(|(_, row)| {
        [columns.grade, columns.maximum].iter().any(|column| table.text(row, *column).contains(','))
    });
    let mut cells = Vec::new();
    for (at, row) in rows() {
        let Some(person) = matched.rows.get(&at).and_then(|person| class.people.get(*person)) else {
            summary.not_in_class.push(columns.who(&table, row));
            continue;
        };
        let Ok(mark) = &person.mark else { continue };
        if columns.is_locked(&table, row) {
            summary.leave_out(person.who(), Why::Locked);
            continue;
        }
        summary.given += 1;
        let mut new = Vec::new();
        if points_of(&table.text(row, columns.grade)) != Some(*mark) {
            let number = two_decimals(*mark);
            let number = if comma { number.replace('.', ",") } else { number };
            new.push((columns.grade, number));
        }
        if let Some(column) =
            columns.comments.filter(|column| comments && table.text(row, *column).is_empty())
        {
            // Moodle reads comments as HTML.
            let text = person.by_question.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
            new.push((column, text));
        }
        new.sort_by_key(|(column, _)| *column);
        for (column, text) in new {
            if let Some(place) = row.cells.get(column) {
                cells.push((place.clone(), table.cell(&text, table.raw(row, column))));
            }
        }
    }
    if comments && columns.comments.is_none() {
        summary
            .notes
            .push("the worksheet has no column for feedback comments: switch them on in Moodle".to_owned());
    }
    Ok(Export { bytes: table.with(&cells), summary })
}

struct Columns {
    identifier: usize,
    grade: usize,
    maximum: usize,
    can_be_changed: Option<usize>,
    comments: Option<usize>,
    name: Option<usize>,
    identifiers: Vec<usize>,
}

/// In small letters.
const IDENTIFIER: &[&str] = &["identifier", "id", "identifiant", "identificador"];
const GRADE: &[&str] = &["grade", "bewertung", "note", "calificación"];
const MAXIMUM: &[&str] =
    &["maximum grade", "bestwertung", "note maximale", "calificación máxima", "puntuación máxima"];
const CAN_BE_CHANGED: &[&str] = &[
    "grade can be changed",
    "bewertung kann geändert werden",
    "la note peut être modifiée",
    "la calificación puede ser cambiada",
];
const COMMENTS: &[&str] =
    &["feedback comments", "feedback als kommentar", "commentaires", "comentarios de retroalimentación"];
const NAME: &[&str] = &["full name", "vollständiger name", "nom complet", "nombre completo"];
const IDENTIFIERS: &[&str] = &[
    "id number",
    "id-nummer",
    "numéro d'identification",
    "número de id",
    "email address",
    "e-mail-adresse",
    "adresse de courriel",
    "dirección de correo",
    "dirección email",
    "username",
    "anmeldename",
    "nom d'utilisateur",
    "nombre de usuario",
];
const SCALE: &[&str] = &["scale", "skala", "barème", "escala"];
const NO: &[&str] = &["no", "nein", "non"];

impl Columns {
    fn find(table: &Table<'_>) -> Result<Self, ExportError> {
        let header: Vec<String> = table.header().iter().map(|name| name.to_lowercase()).collect();
        let column = |names: &[&str]| header.iter().position(|one| names.contains(&one.as_str()));
        let wanted = |names: &[&str], what| {
            let columns =
                || table.header().iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
            column(names).ok_or_else(|| ExportError::NotWorksheet { what, columns: columns() })
        };
        let identifier = wanted(IDENTIFIER, "it has no column `Identifier`")?;
        let grade = wanted(GRADE, "it has no column `Grade`")?;
        if column(MAXIMUM).is_none() && column(SCALE).is_some() {
            return Err(ExportError::ScaleOfWords);
        }
        let named = |(_, name): &(usize, &String)| IDENTIFIERS.contains(&name.as_str());
        Ok(Self {
            identifier,
            grade,
            maximum: wanted(MAXIMUM, "it has no column `Maximum Grade`")?,
            can_be_changed: column(CAN_BE_CHANGED),
            comments: column(COMMENTS),
            name: column(NAME),
            identifiers: header.iter().enumerate().filter(named).map(|(at, _)| at).collect(),
        })
    }

    fn check_maximum(&self, table: &Table<'_>, row: &Row, class: &ClassMarks) -> Result<(), ExportError> {
        let cell = table.text(row, self.maximum);
        let theirs = points_of(&cell).ok_or(ExportError::NoMaximum(cell))?;
        if theirs == class.out_of { Ok(()) } else { Err(ExportError::Scale { theirs, ours: class.out_of }) }
    }

    fn enter(&self, table: &Table<'_>, at: usize, row: &Row, directory: &mut Directory) {
        directory.add(at, Key::Number, &table.text(row, self.identifier));
        for column in &self.identifiers {
            directory.add(at, Key::Identifier, &table.text(row, *column));
        }
        if let Some(column) = self.name {
            directory.add(at, Key::Name, &table.text(row, column));
        }
    }

    fn is_locked(&self, table: &Table<'_>, row: &Row) -> bool {
        let said = self.can_be_changed.map(|column| table.text(row, column).to_lowercase());
        said.is_some_and(|said| NO.contains(&said.as_str()))
    }

    fn who(&self, table: &Table<'_>, row: &Row) -> String {
        let name = self.name.map(|column| table.text(row, column)).filter(|name| !name.is_empty());
        name.unwrap_or_else(|| table.text(row, self.identifier))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gradebook::tests::class;

    const HEADER: &str = "Identifier,Full name,ID number,Email address,Status,Grade,Maximum Grade,Grade can be changed,\
                          Last modified (grade),Feedback comments";

    #[track_caller]
    fn check(what: &str, class: &ClassMarks, comments: bool, before: &[u8], after: &str) {
        let shown = match worksheet(class, before, comments) {
            Ok(export) => String::from_utf8_lossy(&export.bytes).into_owned(),
            Err(error) => error.to_string(),
        };
        assert_eq!(shown, after, "{what}");
    }

    #[test]
    fn only_the_grade_changes() {
        let people = class(&[
            ("EE-001", "Jane Doe", Ok(7250)),
            ("EE-002", "", Err(Why::Waits(1))),
            ("EE-003", "", Ok(100)),
            ("max@x.edu", "", Ok(5000)),
            ("EE-009", "", Ok(1)),
        ]);
        let before = format!(
            "\u{feff}{HEADER}\r\n\
             \"Participant 1\",\"Jane \"\"J\"\" Doe\",EE-001,j@x.edu,\"Submitted, late\",,100.00,Yes,\"Monday, 1 June 2026, 9:00 AM\",\"well\r\ndone\"\r\n\
             \"Participant 2\",John,EE-002,s@x.edu,Submitted,12.00,100.00,Yes,-,\r\n\
             \"Participant 3\",Eve,EE-003,e@x.edu,Submitted,,100.00,No,-,\r\n\
             \"Participant 4\",Max,,max@x.edu,Submitted,\"40.00\",100.00,Yes,-,\r\n\
             \"Participant 5\",Zoe,EE-005,z@x.edu,No submission,,100.00,Yes,-,\r\n"
        );
        let after = before.replace("late\",,100", "late\",72.50,100").replace("\"40.00\"", "\"50.00\"");
        check("marks", &people, false, before.as_bytes(), &after);
        let after = after.replace(
            "Max,,max@x.edu,Submitted,\"50.00\",100.00,Yes,-,",
            "Max,,max@x.edu,Submitted,\"50.00\",100.00,Yes,-,a&lt;b: 1 of 2; c: 3 of 4",
        );
        check("and empty comments", &people, true, before.as_bytes(), &after);
        let summary = worksheet(&people, before.as_bytes(), false).unwrap().summary;
        let why: Vec<&Why> = summary.left_out.iter().map(|one| &one.why).collect();
        assert_eq!(why, [&Why::Waits(1), &Why::NotThere, &Why::Locked]);
        assert_eq!((summary.given, summary.not_in_class), (2, vec!["Zoe".to_owned()]));
    }

    #[test]
    fn worksheets_of_other_sites() {
        let jane = class(&[("EE-001", "Jane Doe", Ok(7250))]);
        check(
            "German, semicolons, decimal comma, LF, no end",
            &jane,
            false,
            "ID;Vollständiger Name;Bewertung;Bestwertung;Bewertung kann geändert werden\nTeilnehmer/in 1;Jane Doe;;100,00;Ja".as_bytes(),
            "ID;Vollständiger Name;Bewertung;Bestwertung;Bewertung kann geändert werden\nTeilnehmer/in 1;Jane Doe;72,50;100,00;Ja",
        );
        check(
            "a decimal comma between commas is quoted",
            &jane,
            false,
            b"Identifier,Full name,Grade,Maximum Grade\nParticipant 1,Jane Doe,,\"100,00\"\n",
            "Identifier,Full name,Grade,Maximum Grade\nParticipant 1,Jane Doe,\"72,50\",\"100,00\"\n",
        );
        check(
            "a grade that is the same already keeps its bytes",
            &jane,
            false,
            b"Identifier,Full name,Grade,Maximum Grade\nParticipant 1,Jane Doe,72.5,100\n",
            "Identifier,Full name,Grade,Maximum Grade\nParticipant 1,Jane Doe,72.5,100\n",
        );
        check(
            "another maximum",
            &jane,
            false,
            b"Identifier,Full name,Grade,Maximum Grade\nParticipant 1,Jane Doe,,20.00\n",
            "the assignment is out of 20 points in the file, the marks are out of 100: add `--scale-to 20`, or change the assignment",
        );
        check(
            "a scale of words",
            &jane,
            false,
            b"Identifier,Full name,Grade,Scale\nParticipant 1,Jane Doe,,\"A\nB\"\n",
            "the assignment is graded by a scale of words, not by points",
        );
        check(
            "no worksheet",
            &jane,
            false,
            b"id,mark\n1,2\n",
            "the file of the LMS is no grading worksheet of Moodle: it has no column `Grade`; its columns are `id`, `mark`",
        );
    }

    #[test]
    fn hidden_names_are_found_by_the_name_of_the_file() {
        let mut people = class(&[("EE-001", "Jane Doe", Ok(7250))]);
        people.people[0].handed_in = Some(crate::class::HandedIn {
            lms: Some(Lms::Moodle),
            lms_id: Some("17".to_owned()),
            anonymous: true,
            ..Default::default()
        });
        check(
            "participant number",
            &people,
            false,
            b"Identifier,Status,Grade,Maximum Grade\nParticipant 7,x,,100\nParticipant 17,x,,100\n",
            "Identifier,Status,Grade,Maximum Grade\nParticipant 7,x,,100\nParticipant 17,x,72.50,100\n",
        );
    }
}
