//! What is handed in, in every form it comes in.

use crate::class::Class;
use crate::forms::{self, FORMS, Form};
use crate::program::{files_below, samples};
use polemark::class::{Record, Status, find_answer_files};
use polemark::lab;
use polemark::reference::Reference;
use polemark::submission::AnswerValue;
use std::collections::{BTreeMap, BTreeSet};
use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

/// Writes an archive of (name, content).
pub fn write_zip(path: &Path, entries: &[(String, Vec<u8>)]) {
    let mut zip = ZipWriter::new(File::create(path).expect("made"));
    for (name, content) in entries {
        zip.start_file(name.as_str(), SimpleFileOptions::default()).expect("started");
        zip.write_all(content).expect("written");
    }
    zip.finish().expect("finished");
}

fn grade(arguments: &[&str], out: &Path) -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_polemark"))
        .arg("grade")
        .args(arguments)
        .arg("--out")
        .arg(out)
        .output()
        .expect("the program starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("text")
}

#[test]
fn a_folder_and_an_archive_of_it_give_the_same_bytes() {
    let bench = tempfile::tempdir().expect("a folder");
    let files: Vec<(String, Vec<u8>)> = files_below(&samples()).into_iter().collect();
    write_zip(&bench.path().join("class.zip"), &files);
    let (one, two) = (bench.path().join("one"), bench.path().join("two"));
    grade(&[samples().to_str().expect("a path")], &one);
    grade(&[bench.path().join("class.zip").to_str().expect("a path")], &two);
    let (one, two) = (files_below(&one), files_below(&two));
    assert_eq!(one.keys().collect::<Vec<_>>(), two.keys().collect::<Vec<_>>());
    for (name, bytes) in &one {
        assert!(two[name] == *bytes, "{name} differs");
    }
}

/// (student, criterion) → (points, code) of a run.
fn marks(out: &Path) -> BTreeMap<(String, String), (String, String)> {
    let text = fs::read_to_string(out.join("results.jsonl")).expect("results");
    let mut marks = BTreeMap::new();
    for line in text.lines() {
        let record = Record::from_line(line).expect("a record");
        assert_eq!(record.status, Status::Marked, "{line}");
        assert_eq!(record.held().count(), 0, "{line}");
        for student in &record.students {
            assert!(student.roster.is_some() && !student.unknown, "{line}");
            for item in &record.items {
                let earned = (item.earned.to_string(), item.code.clone());
                marks.insert((student.id.clone(), item.id.clone()), earned);
            }
        }
    }
    marks
}

#[test]
fn a_class_gets_the_same_marks_in_every_form_it_is_handed_in() {
    marked_alike("cruise-control", 40);
}

/// `cargo test --release --test it -- --ignored three_thousand`
#[test]
#[ignore = "takes minutes, and hours without --release"]
fn three_thousand_get_the_same_marks_in_every_form_they_are_handed_in() {
    marked_alike(lab::DEFAULT, 3_000);
}

/// Marks a generated class in every form.
fn marked_alike(lab: &str, students: usize) {
    let (id, count) = (lab, students);
    let lab = lab::load(id).expect("an embedded lab");
    let reference = Reference::compute(&lab).expect("a reference");
    let class = Class::new(&lab, &reference, 5);
    let texts: BTreeSet<String> = (0..count)
        .map(|number| class.student(number).answers.split_once("answers:").expect("answers").1.to_owned())
        .collect();
    assert_eq!(texts.len(), count, "all different");
    let bench = tempfile::tempdir().expect("a folder");
    let mut first: Option<BTreeMap<_, _>> = None;
    for (name, form) in FORMS {
        let (folder, out) = (bench.path().join(name), bench.path().join(format!("{name}-out")));
        forms::write(&class, count, *form, &folder).expect("written");
        let given = folder.join(if form.is_archive() { "submissions.zip" } else { "submissions" });
        let roster = folder.join("roster.csv");
        let shown = |path: &Path| path.to_str().expect("a path").to_owned();
        let said = grade(&[&shown(&given), "--roster", &shown(&roster), "--lab", id], &out);
        assert!(!said.contains("handed nothing in"), "{name}: {said}");
        let marks = marks(&out);
        assert!(marks.values().any(|(earned, _)| earned != "0"), "{name}");
        match &first {
            None => first = Some(marks),
            Some(first) if *form == Form::Groups => {
                // The second of a group has the first one's marks.
                let of = |id: &str| -> Vec<_> {
                    first
                        .iter()
                        .filter(|((one, _), _)| one == id)
                        .map(|((_, item), mark)| (item, mark))
                        .collect()
                };
                for ((id, item), mark) in &marks {
                    let number: usize = id[3..].parse().expect("a number");
                    let own = format!("EE-{:05}", (number - 1) / 2 * 2 + 1);
                    assert!(of(&own).contains(&(item, mark)), "{name}: {id} {item} {mark:?}");
                }
                assert_eq!(marks.len(), first.len());
            }
            Some(first) => assert!(marks == *first, "{name} differs"),
        }
    }
}

/// A run over an archive of (name, content), with what it wrote.
struct Run {
    records: Vec<Record>,
    said: String,
    gradebook: String,
    page: String,
}

fn run(entries: &[(&str, &str)], roster: Option<&str>) -> Run {
    let bench = tempfile::tempdir().expect("a folder");
    let entries: Vec<(String, Vec<u8>)> =
        entries.iter().map(|(name, text)| ((*name).to_owned(), text.as_bytes().to_vec())).collect();
    let (given, list, out) =
        (bench.path().join("c.zip"), bench.path().join("r.csv"), bench.path().join("out"));
    write_zip(&given, &entries);
    let mut arguments = vec![given.to_str().expect("a path"), "--lab", "cruise-control"];
    if let Some(roster) = roster {
        fs::write(&list, roster).expect("written");
        arguments.extend(["--roster", list.to_str().expect("a path")]);
    }
    let said = grade(&arguments, &out);
    let read = |name: &str| fs::read_to_string(out.join(name)).expect(name);
    let lines = read("results.jsonl");
    Run {
        records: lines.lines().map(|line| Record::from_line(line).expect("a record")).collect(),
        said,
        gradebook: read("gradebook.csv"),
        page: read("index.html"),
    }
}

impl Run {
    /// `file: status [students] codes` of each record, codes of findings about how it was handed in.
    fn shown(&self) -> Vec<String> {
        let shown = self.records.iter().map(|record| {
            let ids: Vec<String> = record
                .students
                .iter()
                .map(|one| if one.unknown { format!("{}?", one.id) } else { one.id.clone() })
                .collect();
            let codes = record.findings.iter().map(|finding| finding.code.as_str());
            let codes: Vec<&str> =
                codes.filter(|code| code.starts_with("intake.") || code.starts_with("student.")).collect();
            let line =
                format!("{}: {} {} {}", record.file, record.status.as_str(), ids.join("+"), codes.join(" "));
            line.trim_end().to_owned()
        });
        shown.collect()
    }
}

fn answers(id: &str, name: &str, answered: bool) -> String {
    let answer = "throttle.transfer_function: 1.3203 / (s + 0.010124)\n  stop.nonlinearity: saturation";
    let body = if answered { format!("answers:\n  {answer}\n") } else { "answers: {}\n".to_owned() };
    let student =
        if id.is_empty() { String::new() } else { format!("student: {{id: {id}, name: {name}}}\n") };
    format!("lab: cruise-control\n{student}{body}")
}

#[test]
fn what_is_handed_in_again_counts_and_the_rest_is_listed() {
    let (jane, bob, li) =
        (answers("1", "Jane Doe", true), answers("2", "Bob Smith", true), answers("3", "Li Lei", true));
    let jane_again = format!("{jane}# again\n");
    let bob_blank = answers("2", "Bob Smith", false);
    let other = "lab: other\nstudent: {id: 3}\nanswers: {x: 1}\n";
    let ann_one = answers("4", "Ann", true);
    let ann_two = answers("5", "Eve", true);
    let ran = run(
        &[
            ("doejane_11_100_lab.yaml", &jane),
            ("doejane_LATE_11_200_lab-1.yaml", &jane_again),
            ("smithbob_12_101_lab.yaml", &bob),
            ("smithbob_12_102_template.yaml", &bob_blank),
            ("leili_13_103_lab.yaml", &li),
            ("leili_13_104_lab2.yaml", other),
            ("poeann_14_105_a.yaml", &ann_one),
            ("poeann_14_106_b.yaml", &ann_two),
            ("rayx_15_107_report.pdf", "%PDF"),
            ("rayx_15_108_answers.docx", "PK"),
            ("hillo_16_109_lab.yaml", "lab: other\nstudent: {id: 6, name: O. Hill}\nanswers: {x: 1}\n"),
            ("hillo_16_text.html", "<p>hello"),
        ],
        None,
    );
    assert_eq!(
        ran.shown(),
        [
            "doejane_LATE_11_200_lab-1.yaml: marked 1",
            "hillo_16_109_lab.yaml: marked 6 intake.other_lab",
            "leili_13_103_lab.yaml: marked 3",
            "poeann_14_105_a.yaml: marked 4 intake.several_files",
            "poeann_14_106_b.yaml: marked 5 intake.several_files intake.other_owner",
            "rayx_15_107_report.pdf: unreadable rayx_15 intake.wrong_type",
            "smithbob_12_101_lab.yaml: marked 2",
            "doejane_11_100_lab.yaml: superseded 1 intake.superseded",
            "leili_13_104_lab2.yaml: superseded 3 intake.other_lab",
            "smithbob_12_102_template.yaml: superseded 2 intake.superseded",
        ]
    );
    let late = &ran.records[0];
    assert!(late.is_late() && late.handed_in.as_ref().is_some_and(|one| one.attempt == Some(200)));
    // Another lab's file earns neither points nor zeros.
    let other = &ran.records[1];
    assert!(other.items.iter().all(|item| item.verdict == "unmarked"), "{:?}", other.items);
    assert_eq!(ran.gradebook.lines().count(), 1 + 7, "what was superseded has no row: {}", ran.gradebook);
    assert!(
        ran.gradebook.lines().nth(1).is_some_and(|line| line.contains(",marked,yes,")),
        "{}",
        ran.gradebook
    );
    assert!(ran.said.contains("3 answer files do not count"), "{}", ran.said);
    assert!(ran.page.contains("Answer files that do not count") && ran.page.contains("hillo_16_text.html"));
}

#[test]
fn the_list_of_the_course_says_who_is_missing_unknown_and_meant() {
    let roster = "Student,ID,SIS User ID,SIS Login ID,Section,Group\n    Points Possible,,,,,\n\"Doe, Jane\",11,EE-1,jdoe,A,\n\
                  \"Smith, Bob\",12,EE-2,bsmith,A,Team One\n\"Lei, Li\",13,EE-3,lli,B,Team One\n\"Núñez, José\",14,EE-4,jn,B,\n\
                  \"Poe, Ann\",15,EE-5,ap,B,\n\"Student, Test\",99,,x,A,\n";
    let nobody = answers("", "", true);
    let (by_login, stranger) = (answers("jdoe", "J. Doe", true), answers("EE-9", "X. Stranger", true));
    let borrowed = answers("EE-5", "Ann Poe", true);
    let ran = run(
        &[
            ("doejane_11_100_lab.yaml", &by_login),
            ("teamone_12_101_lab.yaml", &nobody),
            ("strangerx_77_102_lab.yaml", &stranger),
            ("nunezjose_14_103_lab.yaml", &borrowed),
        ],
        Some(roster),
    );
    assert_eq!(
        ran.shown(),
        [
            "doejane_11_100_lab.yaml: marked EE-1 intake.id_from_roster",
            "nunezjose_14_103_lab.yaml: marked EE-5 intake.other_owner",
            "strangerx_77_102_lab.yaml: marked EE-9? student.not_on_roster",
            "teamone_12_101_lab.yaml: marked EE-2+EE-3 intake.owner",
            ": missing EE-4",
        ]
    );
    let row = ran.records[3].students[1].roster.as_ref().expect("on the roster");
    let ids = (row.canvas_id.as_deref(), row.sis_login_id.as_deref(), row.section.as_deref());
    assert_eq!((row.name.as_str(), ids), ("Li Lei", (Some("13"), Some("lli"), Some("B"))));
    let missing = ran.gradebook.lines().last().expect("a row");
    assert!(missing.starts_with("EE-4,José Núñez,,0,") && missing.contains(",missing,,"), "{missing}");
    assert!(ran.said.contains("1 on the list of the course handed nothing in"), "{}", ran.said);
    assert!(ran.page.contains("handed nothing in"));
    let held: Vec<usize> = ran.records.iter().map(|record| record.held().count()).collect();
    assert_eq!(held, [0, 1, 1, 0, 0]);
    assert_eq!(ran.page.matches(">held until a person says that it counts<").count(), 2, "each in its row");
}

#[test]
fn moodles_groups_are_held_against_the_list_of_the_course() {
    let roster = "Identifier,Full name,ID number,Email address,Group\nParticipant 501,Jane Doe,EE-1,j@x.org,Team A\n\
                  Participant 502,Bob Smith,EE-2,b@x.org,Team A\nParticipant 503,Li Lei,EE-3,l@x.org,Team B\n\
                  Participant 504,Ann Poe,EE-4,a@x.org,\n";
    let nobody = answers("", "", true);
    let both = "lab: cruise-control\nstudents: [{id: EE-1}, {id: EE-3}]\nanswers: {}\n";
    let ran = run(
        &[
            ("Team A_9_assignsubmission_file/lab.yaml", both),
            ("Team B_10_assignsubmission_file/lab.yaml", &nobody),
            ("Ann Poe_504_assignsubmission_onlinetext/onlinetext.html", "<p>typed"),
        ],
        Some(roster),
    );
    assert_eq!(
        ran.shown(),
        [
            "Ann Poe_504_assignsubmission_onlinetext/onlinetext.html: unreadable EE-4 intake.wrong_type intake.owner",
            "Team A_9_assignsubmission_file/lab.yaml: marked EE-1+EE-3 intake.other_group intake.left_out",
            "Team B_10_assignsubmission_file/lab.yaml: marked EE-3 intake.owner student.twice",
            ": missing EE-2",
        ]
    );
    let row = ran.records[0].students[0].roster.as_ref().expect("on the roster");
    assert_eq!((row.moodle_id.as_deref(), row.email.as_deref()), (Some("504"), Some("a@x.org")));
}

#[test]
fn files_that_are_named_one_by_one_find_their_own_data_and_owners() {
    let bench = tempfile::tempdir().expect("a folder");
    let folder = bench.path();
    let moodle = folder.join("Jane Doe_1234_assignsubmission_file");
    fs::create_dir(&moodle).expect("made");
    let data = "answers: {hanging.response: {data: own.csv}}\n";
    let files = [
        ("doejane_1_100_lab.yaml", data),
        ("doejane_1_101_own.csv", "t, y\n0, 1\n1, 2\n"),
        ("smithbob_2_102_lab.yaml", data),
        ("own.csv", "t, y\n0, 5\n1, 5\n"),
        ("Jane Doe_1234_assignsubmission_file/lab.yaml", data),
        ("Jane Doe_1234_assignsubmission_file/own.csv", "t, y\n0, 7\n1, 7\n"),
    ];
    for (name, text) in files {
        fs::write(folder.join(name), text).expect("written");
    }
    let paths: Vec<PathBuf> =
        files.iter().filter(|(name, _)| name.ends_with(".yaml")).map(|(name, _)| folder.join(name)).collect();
    let intake = find_answer_files(&paths, &|_| false).expect("found");
    let lab = lab::load(lab::DEFAULT).expect("the embedded lab");
    let seen: Vec<(String, Option<String>, Option<f64>)> = intake
        .files
        .iter()
        .map(|file| {
            let value =
                file.read(&lab.sheet).answers.remove("hanging.response.data").map(|answer| answer.value);
            let first = match value {
                Some(Ok(AnswerValue::Data(series))) => Some(series.rows[0][1]),
                _ => None,
            };
            (file.name.clone(), file.handed_in.owner.clone(), first)
        })
        .collect();
    let owner = |name: &str| Some(name.to_owned());
    assert_eq!(
        seen,
        [
            ("doejane_1_100_lab.yaml".to_owned(), owner("doejane"), Some(1.0)),
            // Somebody else's data is nobody's.
            ("smithbob_2_102_lab.yaml".to_owned(), owner("smithbob"), None),
            ("Jane Doe_1234_assignsubmission_file/lab.yaml".to_owned(), owner("Jane Doe"), Some(7.0)),
        ]
    );
}
