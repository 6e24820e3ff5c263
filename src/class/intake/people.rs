//! Whose answers they are: what the file says, what the LMS says, and who is on the roster.

use super::attempts::other_lab;
use super::{AnswerFile, HandedIn, Lms};
use crate::class::record::StudentRecord;
use crate::class::roster::{Roster, RosterStudent, name_words};
use crate::english::listed;
use crate::source::{Finding, Severity, sanitize};
use crate::submission::{AnswerSheet, Student, Submission};

/// Members of a group that are taken from the roster.
const MOST_MEMBERS: usize = 20;

/// Gives `submission` the students that it does not name itself, and says where file, LMS, roster and lab disagree.
///
/// What the file says stands: nobody's mark goes to somebody else because of the name of a folder. Only what a person has `said`,
/// ids of students, comes before it, and is asked no more.
pub fn settle_people(
    submission: &mut Submission,
    file: &AnswerFile,
    sheet: &AnswerSheet,
    roster: Option<&Roster>,
    said: Option<&[String]>,
) {
    submission.findings.extend(other_lab(submission, sheet));
    submission.findings.extend(several_files(file));
    if let Some(said) = said {
        return name_as_said(submission, said, roster);
    }
    let handed_in = &file.handed_in;
    let owner = Owner::of(handed_in, roster);
    if names_nobody(submission) {
        name_the_owner(submission, handed_in, &owner);
    }
    let Some(roster) = roster else {
        if let (Owner::Unknown, Some(name)) = (&owner, &handed_in.owner)
            && !may_be_one_of(name, &submission.students)
        {
            submission.findings.push(other_owner(handed_in, name, &submission.students));
        }
        return;
    };
    take_ids_from(roster, submission);
    let known: Vec<Option<&RosterStudent>> =
        submission.students.iter().map(|student| roster.find(&student.id)).collect();
    let mut findings = Vec::new();
    for (student, _) in submission.students.iter().zip(&known).filter(|(_, known)| known.is_none()) {
        findings.push(not_on_roster(student));
    }
    let is_named = |one: &RosterStudent| known.iter().flatten().any(|other| other.id == one.id);
    match owner {
        Owner::Student(one)
            if !is_named(one) && !may_be_one_of(&one.name, unknown(submission, &known).as_slice()) =>
        {
            findings.push(other_owner(handed_in, &one.name, &submission.students));
        }
        Owner::Group(group, members) => {
            let outside: Vec<&RosterStudent> = known
                .iter()
                .flatten()
                .copied()
                .filter(|one| !members.iter().any(|member| member.id == one.id))
                .collect();
            if !outside.is_empty() {
                findings.push(other_group(&group, &outside));
            }
            let left_out: Vec<&RosterStudent> =
                members.into_iter().filter(|member| !is_named(member)).collect();
            if !left_out.is_empty() {
                findings.push(left_out_of_group(&group, &left_out));
            }
        }
        Owner::Unknown => {
            if let Some(name) = &handed_in.owner
                && !may_be_one_of(name, &submission.students)
            {
                findings.push(other_owner(handed_in, name, &submission.students));
            }
        }
        Owner::Student(_) | Owner::Nobody => {}
    }
    submission.findings.extend(findings);
}

/// A person said whose it is: nothing is left to ask.
fn name_as_said(submission: &mut Submission, said: &[String], roster: Option<&Roster>) {
    let student = |id: &String| match roster.and_then(|roster| roster.find(id)) {
        Some(row) => Student { id: row.id.clone(), name: row.name.clone() },
        None => {
            let own = submission.students.iter().find(|one| one.id == *id).or(match said {
                [_] => submission.students.first(),
                _ => None,
            });
            Student { id: id.clone(), name: own.map_or_else(String::new, |one| one.name.clone()) }
        }
    };
    let students: Vec<Student> = said.iter().take(MOST_MEMBERS).map(student).collect();
    submission.students = students;
    submission.findings.retain(|finding| !matches!(finding.code, "student.missing" | "student.id_missing"));
    let ids: Vec<String> = said.iter().take(MOST_MEMBERS).map(|id| quoted(id)).collect();
    let message = format!("A person said that this is the work of {}.", listed(&ids, "and"));
    submission.findings.push(finding(Severity::Note, "marks.whose", message));
}

/// The students of a submission for its record.
pub fn student_records(submission: &Submission, roster: Option<&Roster>) -> Vec<StudentRecord> {
    let record = |student: &Student| {
        let row = roster.and_then(|roster| roster.find(&student.id));
        StudentRecord {
            id: student.id.clone(),
            name: student.name.clone(),
            unknown: roster.is_some() && row.is_none(),
            roster: row.cloned().map(Box::new),
        }
    };
    submission.students.iter().map(record).collect()
}

/// Who handed `file` in, for its record, with the group of the roster whose work it is; `None` where no LMS says so.
pub fn handed_in(file: &AnswerFile, roster: Option<&Roster>) -> Option<HandedIn> {
    file.handed_in.lms?;
    let group = match Owner::of(&file.handed_in, roster) {
        Owner::Group(group, _) => Some(group),
        _ => None,
    };
    Some(HandedIn { group, ..file.handed_in.clone() })
}

/// Who handed it in, as far as that is known.
enum Owner<'a> {
    /// No LMS says so, or it hides it.
    Nobody,
    /// There is a name, and nobody on the roster has it.
    Unknown,
    Student(&'a RosterStudent),
    Group(String, Vec<&'a RosterStudent>),
}

impl<'a> Owner<'a> {
    fn of(handed_in: &HandedIn, roster: Option<&'a Roster>) -> Self {
        let (Some(lms), name) = (handed_in.lms, handed_in.owner.as_deref()) else { return Self::Nobody };
        let unknown = || if name.is_some() { Self::Unknown } else { Self::Nobody };
        let Some(roster) = roster else { return unknown() };
        if let Some(name) = name {
            // In group work Moodle's number is the group's, which may be somebody else's as a participant.
            let members = roster.group(name);
            if !members.is_empty() {
                return Self::Group(name.to_owned(), members);
            }
        }
        let id = handed_in.lms_id.as_deref();
        let by_number = match lms {
            Lms::Canvas => id.and_then(|id| roster.find_by_canvas_id(id)),
            Lms::Moodle => id.and_then(|id| roster.find_by_moodle_id(id)),
        };
        let by_name = name.and_then(|name| match lms {
            Lms::Canvas => roster.find_by_letters(name),
            Lms::Moodle => roster.find_by_name(name).or_else(|| behind_a_group(name, roster)),
        });
        by_number.or(by_name).map_or_else(unknown, Self::Student)
    }
}

/// `Group A-Jane Doe`, as Moodle wrote it before 4.1: a group of the roster, and a student of it.
fn behind_a_group<'a>(name: &str, roster: &'a Roster) -> Option<&'a RosterStudent> {
    name.match_indices('-').take(5).find_map(|(at, _)| {
        let student = roster.find_by_name(&name[at + 1..])?;
        let members = roster.group(&name[..at]);
        members.iter().any(|member| member.id == student.id).then_some(student)
    })
}

/// Whether the file's own name stands for its student.
fn names_nobody(submission: &Submission) -> bool {
    matches!(submission.students.as_slice(), [] | [_])
        && submission.students.iter().all(|one| one.id == submission.id && one.name.is_empty())
        && (!submission.readable || has(submission, "student.missing"))
}

fn has(submission: &Submission, code: &str) -> bool {
    submission.findings.iter().any(|finding| finding.code == code)
}

fn name_the_owner(submission: &mut Submission, handed_in: &HandedIn, owner: &Owner<'_>) {
    let of = |one: &&RosterStudent| Student { id: one.id.clone(), name: one.name.clone() };
    let (students, message): (Vec<Student>, String) = match owner {
        Owner::Nobody => return,
        Owner::Unknown => {
            // The file keeps its own name for an id.
            if let (Some(student), Some(name)) = (submission.students.first_mut(), &handed_in.owner) {
                student.name.clone_from(name);
            }
            return;
        }
        Owner::Student(one) => {
            let message =
                format!("The file does not say whose it is. It was handed in by {}.", quoted(&one.name));
            (vec![of(one)], message)
        }
        Owner::Group(group, members) => {
            let message = format!(
                "The file does not say whose it is. It was handed in for the group {}, so it counts for all of it: {}.",
                quoted(group),
                names(members)
            );
            (members.iter().take(MOST_MEMBERS).map(of).collect(), message)
        }
    };
    submission.students = students;
    submission.findings.retain(|finding| finding.code != "student.missing");
    submission.findings.push(finding(Severity::Note, "intake.owner", message));
}

/// Whoever gave a login, an e-mail address or only a name is called by the id of the roster.
fn take_ids_from(roster: &Roster, submission: &mut Submission) {
    let own = &submission.id;
    let mut said = Vec::new();
    for student in &mut submission.students {
        let stands_in = student.id == *own;
        let row = match roster.find(&student.id) {
            Some(row) if crate::lab::folded_id(&row.id) == crate::lab::folded_id(&student.id) => continue,
            Some(row) => Some(row),
            None if stands_in => roster.find_by_name(&student.name),
            None => None,
        };
        let Some(row) = row else { continue };
        let given = if stands_in { &student.name } else { &student.id };
        let message = format!("{} is {} on the list of the course.", quoted(given), quoted(&row.id));
        said.push(finding(Severity::Note, "intake.id_from_roster", message));
        student.id.clone_from(&row.id);
    }
    if !said.is_empty() {
        let stands_in = submission.students.iter().any(|student| student.id == *own);
        submission.findings.retain(|finding| stands_in || finding.code != "student.id_missing");
        submission.findings.extend(said);
    }
}

/// Those who are not on the roster.
fn unknown(submission: &Submission, known: &[Option<&RosterStudent>]) -> Vec<Student> {
    let all = submission.students.iter().zip(known);
    all.filter(|(_, known)| known.is_none()).map(|(student, _)| student.clone()).collect()
}

/// Whether nothing speaks against `owner`, as an LMS writes it, being one of these: nobody has only other names.
///
/// A name agrees when all its words are there, in any order, run together or not; an initial stands for a word.
fn may_be_one_of(owner: &str, students: &[Student]) -> bool {
    students.iter().any(|student| student.name.is_empty() || same_name(owner, &student.name))
}

fn same_name(owner: &str, name: &str) -> bool {
    let (owner_words, words) = (name_words(owner), name_words(name));
    if words.is_empty() || owner_words.is_empty() {
        return true;
    }
    let run_together = owner_words.concat();
    let turns = (0..words.len()).map(|turn| [&words[turn..], &words[..turn]].concat().concat());
    if turns.into_iter().any(|turn| turn == run_together) {
        return true;
    }
    let agrees = |one: &String, two: &String| {
        one == two
            || (one.chars().count() == 1 && two.starts_with(one.as_str()))
            || (two.chars().count() == 1 && one.starts_with(two.as_str()))
    };
    // A middle name more or less makes nobody somebody else; nor does a group before the name.
    let within =
        |few: &[String], many: &[String]| few.iter().all(|one| many.iter().any(|two| agrees(one, two)));
    let long = |words: &[String]| words.iter().any(|word| word.chars().count() > 1);
    (within(&words, &owner_words) && long(&words)) || (within(&owner_words, &words) && long(&owner_words))
        // Canvas leaves no spaces to tell where a name ends: `doejane` has all words of `J. Doe` that are words.
        || (owner_words.len() == 1
            && words.iter().filter(|word| word.chars().count() > 1).all(|word| run_together.contains(word.as_str()))
            && long(&words))
}

fn several_files(file: &AnswerFile) -> Option<Finding> {
    if file.beside_others.is_empty() {
        return None;
    }
    let others: Vec<String> = file.beside_others.iter().map(|name| quoted(name)).collect();
    let message = format!(
        "Whoever handed this in also handed in {}, and nothing says which counts. All are marked; a person has to say.",
        listed(&others, "and")
    );
    Some(finding(Severity::Warning, "intake.several_files", message))
}

fn not_on_roster(student: &Student) -> Finding {
    let message = format!(
        "The student id {} is not on the list of the course. What belongs to it as it is typed was used; a person has to look at it.",
        quoted(&student.id)
    );
    finding(Severity::Warning, "student.not_on_roster", message)
}

fn other_owner(handed_in: &HandedIn, owner: &str, students: &[Student]) -> Finding {
    let lms = handed_in.lms.map_or("The name of the file", Lms::name);
    let named: Vec<String> =
        students.iter().map(|one| quoted(if one.name.is_empty() { &one.id } else { &one.name })).collect();
    let message = format!(
        "{lms} says that {} handed this in, but the file names {}. A person has to say whose it is.",
        quoted(owner),
        listed(&named, "and")
    );
    finding(Severity::Warning, "intake.other_owner", message)
}

fn other_group(group: &str, outside: &[&RosterStudent]) -> Finding {
    let message = format!(
        "This was handed in for the group {}, but by the list of the course {} not in it. A person has to say for whom it counts.",
        quoted(group),
        are(outside)
    );
    finding(Severity::Warning, "intake.other_group", message)
}

fn left_out_of_group(group: &str, left_out: &[&RosterStudent]) -> Finding {
    let message = format!(
        "This was handed in for the group {}. By the list of the course {} in it too, but the file does not name them: it does \
         not count for them.",
        quoted(group),
        are(left_out)
    );
    finding(Severity::Warning, "intake.left_out", message)
}

fn are(students: &[&RosterStudent]) -> String {
    format!("{} {}", names(students), if students.len() == 1 { "is" } else { "are" })
}

fn names(students: &[&RosterStudent]) -> String {
    let shown = |one: &&RosterStudent| quoted(if one.name.is_empty() { &one.id } else { &one.name });
    let mut names: Vec<String> = students.iter().take(MOST_MEMBERS).map(shown).collect();
    if students.len() > MOST_MEMBERS {
        names.push(format!("{} more", students.len() - MOST_MEMBERS));
    }
    listed(&names, "and")
}

fn quoted(text: &str) -> String {
    format!("`{}`", sanitize(text))
}

fn finding(severity: Severity, code: &'static str, message: String) -> Finding {
    Finding { severity, code, message, help: None, span: None }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_agree_however_they_were_passed_on() {
        for (owner, name, agree) in [
            ("Jane Doe", "Jane Doe", true),
            ("Jane Doe", "Doe, Jane", true),
            ("Jane Doe", "J. Doe", true),
            ("Jane Mary Doe", "Jane Doe", true),
            ("doejane", "Jane Doe", true),
            ("doejane", "J. Doe", true),
            ("vandenbergjan", "Jan van den Berg", true),
            ("núñezjosé", "Jose Nunez", true),
            ("Sinéad OBrien", "Sinéad O'Brien", true),
            ("Group A-Jane Doe", "Jane Doe", true),
            ("Jane Doe", "", true),
            ("محمد علي", "علي محمد", true),
            ("Jane Doe", "John Smith", false),
            ("Jane Doe", "Jane Smith", false),
            ("doejane", "John Smith", false),
            ("Jane Doe", "X. Y.", false),
        ] {
            let student = Student { id: "1".to_owned(), name: name.to_owned() };
            assert_eq!(may_be_one_of(owner, &[student]), agree, "{owner} and {name}");
        }
    }
}
