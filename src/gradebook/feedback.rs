use super::class_marks::{Rules, key};
use super::{ExportError, Records, Summary, Why};
use crate::class::{HandedIn, Lms, Record};
use crate::source::sanitize;
use std::collections::BTreeMap;
use std::io::{Read, Seek, Write};
use std::path::{Component, Path, PathBuf};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

/// Which LMS is to hand the reports back.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FeedbackFor {
    Moodle,
    Canvas,
}

/// A zip file with which an LMS hands all reports back in one upload.
///
/// Reports are those of `out` whose marks `rules` pass on, and whole. Same records, same bytes: times are 1980-01-01.
///
/// **Moodle**: `<full name>_<number>_assignfeedback_file_<file>`, the number being the participant's or, for group work, the
/// group's, who then all get it. The importer parts a name at its first four `_`, so names have none, and passes over what
/// begins with `.` or `~`.
/// Source: moodle/moodle, `mod/assign/feedback/file/importziplib.php` (`is_valid_filename_for_import`,
/// `get_participant_mapping`).
///
/// **Canvas**: `<name>_<user>_<attachment>_<file>`: the importer takes the first two parts that are numbers for the user and for
/// what the user had handed in, and hands back under the name of that. So only what Canvas gave out can be handed back; for
/// group work the whole group gets it. The last part must not begin with `link`, nor the name with `._`.
/// Source: instructure/canvas-lms, `Assignment#infer_comment_context_from_filename` and `#generate_comments_from_files`.
pub fn write_feedback<W: Write + Seek>(
    out: &Path,
    lms: FeedbackFor,
    rules: &Rules,
    writer: W,
) -> Result<Summary, ExportError> {
    let mut zip = ZipWriter::new(writer);
    let options = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Deflated)
        .last_modified_time(DateTime::default())
        .unix_permissions(0o644);
    let mut summary = Summary::default();
    let shared = Shared::read(out, lms, rules)?;
    for record in Records::open(out)? {
        let record = record?;
        if !record.counts() {
            continue;
        }
        if let Err(why) = rules.mark(&record) {
            summary.leave_out(who(&record), why);
            continue;
        }
        if let Some(files) = shared.files(&record) {
            summary.leave_out(who(&record), Why::SeveralFiles(files.clone()));
            continue;
        }
        let receivers = receivers(lms, &record, &mut summary);
        if receivers.is_empty() {
            continue;
        }
        let Some(report) = whole_report(out, &record.report) else {
            summary.leave_out(who(&record), Why::NoReport);
            continue;
        };
        for receiver in receivers {
            if shared.names.get(&receiver).is_some_and(|count| *count > 1) {
                summary.leave_out(who(&record), Why::SharedNumber);
                continue;
            }
            zip.start_file(receiver, options)?;
            zip.write_all(&report)?;
            summary.given += 1;
        }
    }
    zip.finish()?;
    Ok(summary)
}

/// What only the whole class tells.
#[derive(Default)]
struct Shared {
    /// How many reports would have each name: where there are several, everybody would get the report of one.
    names: BTreeMap<String, usize>,
    /// Files that count for each student.
    files: BTreeMap<String, Vec<String>>,
}

impl Shared {
    fn read(out: &Path, lms: FeedbackFor, rules: &Rules) -> Result<Self, ExportError> {
        let mut shared = Self::default();
        for record in Records::open(out)? {
            let record = record?;
            if !record.counts() {
                continue;
            }
            for student in &record.students {
                shared.files.entry(key(&student.id)).or_default().push(record.file.clone());
            }
            if rules.mark(&record).is_ok() {
                for name in receivers(lms, &record, &mut Summary::default()) {
                    *shared.names.entry(name).or_insert(0) += 1;
                }
            }
        }
        Ok(shared)
    }

    /// Files that count for a student of `record`, when there are several.
    fn files(&self, record: &Record) -> Option<&Vec<String>> {
        let mut files = record.students.iter().filter_map(|student| self.files.get(&key(&student.id)));
        files.find(|files| files.len() > 1)
    }
}

fn receivers(lms: FeedbackFor, record: &Record, summary: &mut Summary) -> Vec<String> {
    match lms {
        FeedbackFor::Moodle => moodle_receivers(record, summary),
        FeedbackFor::Canvas => canvas_receivers(record, summary),
    }
}

/// What the student sees; Moodle keeps it, Canvas shows the name of what was handed in instead.
const FILE: &str = "report.html";

fn moodle_receivers(record: &Record, summary: &mut Summary) -> Vec<String> {
    let name = |owner: &str, number: &str| format!("{}_{number}_assignfeedback_file_{FILE}", plain(owner));
    let handed_in = by(record, Lms::Moodle);
    if let Some((said, number)) = handed_in
        && (said.group.is_some() || record.students.len() > 1 && numbers_of(record).next().is_none())
    {
        if said.group.is_none() && record.students.len() > 1 {
            summary.notes.push(format!(
                "{}: goes to whom Moodle knows by the number {number}, the group or whoever handed it in",
                sanitize(&who(record))
            ));
        }
        return vec![name(said.owner.as_deref().unwrap_or("Participant"), number)];
    }
    let mut receivers = Vec::new();
    for student in &record.students {
        let own = student
            .roster
            .as_deref()
            .and_then(|row| row.moodle_id.as_deref())
            .filter(|number| is_number(number));
        let said = handed_in.filter(|_| record.students.len() == 1);
        match (own, said) {
            (Some(number), _) => {
                let row = student.roster.as_deref().map_or("", |row| row.name.as_str());
                receivers.push(name(if row.is_empty() { &student.name } else { row }, number));
            }
            (None, Some((said, number))) => {
                receivers.push(name(said.owner.as_deref().unwrap_or("Participant"), number));
            }
            (None, None) => {
                let why = Why::NoLmsNumbers(
                    "Moodle's number of them is not known: neither in the roster nor in a file's name",
                );
                summary.leave_out(format!("{} ({})", student.id, student.name), why);
            }
        }
    }
    receivers
}

fn numbers_of(record: &Record) -> impl Iterator<Item = &str> {
    record.students.iter().filter_map(|student| student.roster.as_deref()?.moodle_id.as_deref())
}

fn canvas_receivers(record: &Record, summary: &mut Summary) -> Vec<String> {
    let numbers = by(record, Lms::Canvas)
        .filter(|(said, _)| !said.anonymous)
        .and_then(|(said, user)| Some((said, user, said.attempt?)));
    let Some((said, user, attachment)) = numbers else {
        let why = Why::NoLmsNumbers(
            "the answer file's name does not have Canvas' numbers of the user and the file",
        );
        summary.leave_out(who(record), why);
        return Vec::new();
    };
    // A number in front would be taken for the user's.
    let owner: String = plain(said.owner.as_deref().unwrap_or_default()).split(' ').collect();
    let owner =
        if owner.bytes().any(|byte| !byte.is_ascii_digit()) { owner } else { format!("student{owner}") };
    vec![format!("{owner}_{user}_{attachment}_{FILE}")]
}

fn by(record: &Record, lms: Lms) -> Option<(&HandedIn, &str)> {
    let said = record.handed_in.as_ref().filter(|one| one.lms == Some(lms))?;
    let number = said.lms_id.as_deref().filter(|number| is_number(number))?;
    Some((said, number))
}

fn is_number(text: &str) -> bool {
    !text.is_empty() && text.len() <= 20 && text.bytes().all(|byte| byte.is_ascii_digit())
}

fn who(record: &Record) -> String {
    let students: Vec<&str> = record.students.iter().map(|student| student.id.as_str()).collect();
    if students.is_empty() { record.file.clone() } else { students.join(", ") }
}

/// A name without anything that ends, parts or hides a file name: letters, digits, spaces, `-`, at most 80 of them.
fn plain(name: &str) -> String {
    let kept = |c: char| if c.is_alphanumeric() || c == '-' { c } else { ' ' };
    let spaced: String = name.chars().filter(|c| !matches!(c, '\'' | '’')).map(kept).take(80).collect();
    let words = spaced.split_whitespace().collect::<Vec<_>>().join(" ");
    if words.is_empty() { "student".to_owned() } else { words }
}

/// The bytes of a report that is there from its beginning to its end.
fn whole_report(out: &Path, report: &str) -> Option<Vec<u8>> {
    const MOST_BYTES: u64 = 64 << 20;
    let path = PathBuf::from(decoded(report)?);
    // A record is a file that anybody may have changed: nothing outside the folder is sent to a student.
    let inside = path.components().all(|part| matches!(part, Component::Normal(_)));
    if report.is_empty() || !inside {
        return None;
    }
    let mut bytes = Vec::new();
    let file = std::fs::File::open(out.join(path)).ok()?;
    file.take(MOST_BYTES).read_to_end(&mut bytes).ok()?;
    bytes.trim_ascii_end().ends_with(b"</html>").then_some(bytes)
}

/// Without percent signs.
fn decoded(text: &str) -> Option<String> {
    let (mut bytes, mut rest) = (Vec::new(), text.as_bytes());
    while let Some((first, after)) = rest.split_first() {
        rest = after;
        if *first == b'%' {
            let (code, after) = rest.split_at_checked(2)?;
            bytes.push(u8::from_str_radix(std::str::from_utf8(code).ok()?, 16).ok()?);
            rest = after;
        } else {
            bytes.push(*first);
        }
    }
    String::from_utf8(bytes).ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::class::RunFacts;
    use crate::gradebook::tests::record;
    use std::io::Cursor;

    fn handed_in(lms: Lms, owner: &str, number: &str, attempt: Option<u64>) -> Option<HandedIn> {
        Some(HandedIn {
            lms: Some(lms),
            owner: (!owner.is_empty()).then(|| owner.to_owned()),
            lms_id: Some(number.to_owned()),
            attempt,
            anonymous: owner.is_empty(),
            ..HandedIn::default()
        })
    }

    /// Names in the zip, then why somebody was left out.
    #[track_caller]
    fn check(what: &str, lms: FeedbackFor, records: Vec<Record>, names: &[&str], left_out: usize) -> Vec<u8> {
        let out = tempfile::tempdir().unwrap();
        std::fs::create_dir(out.path().join("reports")).unwrap();
        for record in &records {
            let end = if record.students[0].name == "Half" { "" } else { "</html>\n" };
            let path = out.path().join(decoded(&record.report).unwrap());
            std::fs::write(path, format!("<!doctype html><p>{}{end}", record.submission)).unwrap();
        }
        let mut bytes = Cursor::new(Vec::new());
        let lines: String = records.iter().map(|record| record.to_line().unwrap() + "\n").collect();
        std::fs::write(out.path().join("results.jsonl"), lines).unwrap();
        std::fs::write(out.path().join("run.json"), RunFacts::default().to_text().unwrap()).unwrap();
        let summary = write_feedback(out.path(), lms, &Rules::default(), &mut bytes).unwrap();
        let mut zip = zip::ZipArchive::new(Cursor::new(bytes.get_ref().clone())).unwrap();
        let found: Vec<String> =
            (0..zip.len()).map(|at| zip.by_index(at).unwrap().name().unwrap().into_owned()).collect();
        assert_eq!(found, names, "{what}");
        assert_eq!((summary.given, summary.left_out.len()), (names.len(), left_out), "{what}: {summary:?}");
        bytes.into_inner()
    }

    /// As `is_valid_filename_for_import` takes a name apart: number, kind, plugin, file.
    fn as_moodle_reads(name: &str) -> Option<(&str, &str, &str, &str)> {
        let parts: Vec<&str> = name.splitn(5, '_').collect();
        let [_, number, kind, plugin, file] = parts[..] else { return None };
        (!name.starts_with(['.', '~']) && is_number(number)).then_some((number, kind, plugin, file))
    }

    /// As `infer_comment_context_from_filename` does: user and attachment.
    fn as_canvas_reads(name: &str) -> Option<(&str, &str)> {
        let parts: Vec<&str> = name.split('_').collect();
        let mut numbers = parts.iter().filter(|part| is_number(part));
        let (user, attachment) = (numbers.next()?, numbers.next()?);
        (!parts.last()?.starts_with("link") && !name.starts_with("._")).then_some((user, attachment))
    }

    #[test]
    fn names_are_what_the_importers_take_apart() {
        for owner in [
            "Jane Doe",
            "R2_D2_2 3",
            "O'Brien, Sinéad",
            "../../etc/passwd",
            "~x",
            ".x",
            "",
            "李 雷",
            "7",
            "link",
            "a\r\nb",
        ] {
            let mut one = record("EE-001", owner);
            one.handed_in = handed_in(Lms::Moodle, if owner.is_empty() { "x" } else { owner }, "1234", None);
            let mut summary = Summary::default();
            let names = moodle_receivers(&one, &mut summary);
            assert_eq!(
                as_moodle_reads(&names[0]),
                Some(("1234", "assignfeedback", "file", FILE)),
                "{names:?}"
            );
            one.handed_in =
                handed_in(Lms::Canvas, if owner.is_empty() { "x" } else { owner }, "12", Some(345));
            let names = canvas_receivers(&one, &mut summary);
            assert_eq!(as_canvas_reads(&names[0]), Some(("12", "345")), "{names:?}");
            assert!(!names[0].contains(['/', '\\', '\n']), "{names:?}");
        }
    }

    #[test]
    fn moodle_gets_reports_by_participant_or_group() {
        let mut jane = record("EE-001", "Jane Doe");
        jane.handed_in = handed_in(Lms::Moodle, "Jane Doe", "1234", None);
        let mut hidden = record("EE-002", "John");
        hidden.handed_in = handed_in(Lms::Moodle, "", "17", None);
        let mut listed = record("EE-003", "Eve");
        let row = crate::class::RosterStudent { moodle_id: Some("99".to_owned()), ..Default::default() };
        listed.students[0].roster = Some(Box::new(row));
        let mut group = record("EE-004", "Max");
        group.students.push(record("EE-005", "Zoe").students.remove(0));
        group.handed_in = handed_in(Lms::Moodle, "Group A", "42", None);
        let unknown = record("EE-006", "Nobody");
        let mut half = record("EE-007", "Half");
        half.handed_in = handed_in(Lms::Moodle, "Half", "5", None);
        let mut waits = record("EE-008", "Waits");
        waits.cover[0].earned = None;
        waits.handed_in = handed_in(Lms::Moodle, "Waits", "6", None);
        let all = vec![jane, hidden, listed, group, unknown, half, waits];
        let names = [
            "Jane Doe_1234_assignfeedback_file_report.html",
            "Participant_17_assignfeedback_file_report.html",
            "Eve_99_assignfeedback_file_report.html",
            "Group A_42_assignfeedback_file_report.html",
        ];
        let bytes = check("all", FeedbackFor::Moodle, all.clone(), &names, 3);
        assert_eq!(bytes, check("again", FeedbackFor::Moodle, all, &names, 3), "same bytes");
    }

    #[test]
    fn canvas_gets_reports_by_user_and_attachment() {
        let mut jane = record("EE-001", "Jane Doe");
        jane.handed_in = handed_in(Lms::Canvas, "doejane", "12", Some(345));
        let mut hidden = record("EE-002", "John");
        hidden.handed_in = handed_in(Lms::Canvas, "", "17", Some(1));
        let mut typed = record("EE-003", "Eve");
        typed.handed_in = handed_in(Lms::Canvas, "eve", "18", None);
        let name = "doejane_12_345_report.html";
        check("canvas", FeedbackFor::Canvas, vec![jane.clone(), hidden, typed], &[name], 2);
        let mut other_member = record("EE-004", "Max");
        other_member.handed_in = jane.handed_in.clone();
        let mut again = jane.clone();
        again.handed_in = handed_in(Lms::Canvas, "doejane", "12", Some(346));
        check("two files of one student", FeedbackFor::Canvas, vec![jane.clone(), again], &[], 2);
        check("members with reports of their own", FeedbackFor::Canvas, vec![jane, other_member], &[], 2);
    }

    #[test]
    fn nothing_outside_the_folder_is_sent() {
        let out = tempfile::tempdir().unwrap();
        std::fs::write(out.path().join("x.html"), "</html>").unwrap();
        for (report, there) in
            [("x.html", true), ("..%2Fx.html", false), ("%2Fetc%2Fpasswd", false), ("", false), ("%", false)]
        {
            assert_eq!(whole_report(out.path(), report).is_some(), there, "{report}");
        }
    }
}
