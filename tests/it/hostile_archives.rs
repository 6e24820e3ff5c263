//! Zip archives that people should not hand in, and some that they cannot help handing in.

use polemark::class::{AnswerFile, IntakeError, find_answer_files};
use polemark::lab::{self, LabDefinition};
use std::fs;
use std::io::{Cursor, Write};
use std::path::PathBuf;
use std::sync::LazyLock;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

const ANSWERS: &str =
    "lab: ee361-lab3\nstudent: {id: EE-1, name: A}\nanswers:\n  battery.nonlinearity: dead zone\n";

/// An archive of (name, content), in memory.
fn archive(entries: &[(&str, &[u8])]) -> Vec<u8> {
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, content) in entries {
        zip.start_file(*name, SimpleFileOptions::default()).expect("started");
        zip.write_all(content).expect("written");
    }
    zip.finish().expect("finished").into_inner()
}

/// Turns `from` into `to`, of the same length, wherever it stands.
fn replaced(mut bytes: Vec<u8>, from: &[u8], to: &[u8]) -> Vec<u8> {
    assert_eq!(from.len(), to.len());
    let places: Vec<usize> =
        (0..bytes.len() - from.len()).filter(|at| &bytes[*at..*at + from.len()] == from).collect();
    assert!(!places.is_empty(), "{}", String::from_utf8_lossy(from));
    for at in places {
        bytes[at..at + to.len()].copy_from_slice(to);
    }
    bytes
}

/// Sets a bit of the flags of every header, local and central.
fn flagged(mut bytes: Vec<u8>, bit: u8) -> Vec<u8> {
    for at in 0..bytes.len() - 10 {
        match &bytes[at..at + 4] {
            b"PK\x03\x04" => bytes[at + 6] |= bit,
            b"PK\x01\x02" => bytes[at + 8] |= bit,
            _ => {}
        }
    }
    bytes
}

struct Taken {
    _folder: tempfile::TempDir,
    found: Result<Vec<AnswerFile>, IntakeError>,
}

fn take(bytes: &[u8]) -> Taken {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("class.zip");
    fs::write(&path, bytes).expect("written");
    let found = find_answer_files(&[path], &|_| false).map(|intake| intake.files);
    let left: Vec<PathBuf> =
        fs::read_dir(folder.path()).expect("read").map(|e| e.expect("read").path()).collect();
    assert_eq!(left.len(), 1, "nothing is unpacked: {left:?}");
    Taken { _folder: folder, found }
}

/// `name: codes of findings` of each answer file.
fn read(taken: &Taken) -> Vec<String> {
    static LAB: LazyLock<LabDefinition> =
        LazyLock::new(|| lab::load(lab::DEFAULT).expect("the embedded lab"));
    let files = taken.found.as_ref().expect("an archive");
    let said = files.iter().map(|file| {
        let submission = file.read(&LAB.sheet);
        let codes: Vec<&str> = submission.findings.iter().map(|finding| finding.code).collect();
        format!("{}: {} {}", file.name, submission.readable, codes.join(" "))
    });
    said.collect()
}

#[track_caller]
fn check(bytes: &[u8], expected: &[&str]) {
    assert_eq!(read(&take(bytes)), expected);
}

#[track_caller]
fn refused(bytes: &[u8], because: &str) {
    let error = take(bytes).found.expect_err("refused").to_string();
    assert!(error.contains(because), "{error}");
}

#[test]
fn names_lead_nowhere() {
    let a = ANSWERS.as_bytes();
    check(
        &archive(&[
            ("../../etc/a.yaml", a),
            ("/lib/b.yaml", a),
            ("C:\\c.yaml", a),
            ("x\\d.yaml", a),
            ("./e/../f.yaml", a),
            ("__MACOSX/._g.yaml", a),
            (".hidden.yaml", a),
            ("..", a),
        ]),
        &["c.yaml: true ", "e/f.yaml: true ", "etc/a.yaml: true ", "lib/b.yaml: true ", "x/d.yaml: true "],
    );
}

#[test]
fn names_are_read_in_the_code_page_of_dos() {
    let a = ANSWERS.as_bytes();
    check(&replaced(archive(&[("Jos_.yaml", a)]), b"Jos_", b"Jos\x82"), &["José.yaml: true "]);
    // Canvas writes UTF-8 without saying so.
    let unsaid = replaced(archive(&[("Jo__.yaml", a)]), b"Jo__", "Joé".as_bytes());
    check(&unsaid, &["Joé.yaml: true "]);
}

#[test]
fn the_last_of_several_entries_of_one_name_counts() {
    let two = archive(&[("b.yaml", b"answers: {}\n"), ("a.yaml", ANSWERS.as_bytes())]);
    check(&replaced(two, b"b.yaml", b"a.yaml"), &["a.yaml: true "]);
}

#[test]
fn links_passwords_and_damage_are_said() {
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    zip.add_symlink("a.yaml", "/etc/passwd", SimpleFileOptions::default()).expect("a link");
    check(&zip.finish().expect("finished").into_inner(), &["a.yaml: false file.link"]);

    let whole = archive(&[("a.yaml", ANSWERS.as_bytes())]);
    check(&flagged(whole.clone(), 1), &["a.yaml: false intake.encrypted"]);

    let stored = SimpleFileOptions::default().compression_method(CompressionMethod::Stored);
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    zip.start_file("a.yaml", stored).expect("started");
    zip.write_all(ANSWERS.as_bytes()).expect("written");
    let stored = zip.finish().expect("finished").into_inner();
    check(&replaced(stored, b"dead zone", b"backlash "), &["a.yaml: false intake.damaged"]);
}

#[test]
fn what_is_no_whole_archive_is_refused() {
    let whole = archive(&[("a.yaml", ANSWERS.as_bytes()), ("b.yaml", ANSWERS.as_bytes())]);
    refused(&whole[..whole.len() / 2], "no zip archive, or only a part of one");
    refused(&whole[..whole.len() - 5], "no zip archive");
    refused(b"", "no zip archive");
    refused(b"lab: ee361-lab3\n", "no zip archive");
    refused(&archive(&[("a.txt", b"x")]), "no answer files");
    // An end that claims more than there is.
    let end = whole.len() - 22;
    let mut claims = whole.clone();
    claims[end + 8..end + 12].copy_from_slice(&[0xfe, 0xff, 0xfe, 0xff]);
    refused(&claims, "no zip archive");
    // A 64-bit end that claims a million million.
    let mut claims = whole[..end].to_vec();
    claims.extend(b"PK\x06\x06");
    claims.extend([44, 0, 0, 0, 0, 0, 0, 0, 45, 0, 45, 0, 0, 0, 0, 0, 0, 0, 0, 0]);
    claims.extend([0, 0, 0, 0, 0, 1, 0, 0].repeat(4));
    claims.extend(&whole[end..]);
    refused(&claims, "entries, more than the 500000 that are read");
}

#[test]
fn any_damage_is_a_finding_or_a_refusal() {
    let whole = archive(&[("a.yaml", ANSWERS.as_bytes()), ("b/c.yaml", ANSWERS.as_bytes())]);
    for at in 0..whole.len() {
        for flip in [0x01, 0x80, 0xff] {
            let mut bytes = whole.clone();
            bytes[at] ^= flip;
            let taken = take(&bytes);
            if taken.found.is_ok() {
                read(&taken);
            }
        }
    }
}

#[test]
fn bombs_do_not_go_off() {
    let zeros = vec![b' '; 100 << 20];
    check(
        &archive(&[("a.yaml", &zeros), ("b.yaml", ANSWERS.as_bytes())]),
        &["a.yaml: false file.too_large", "b.yaml: true "],
    );
    let names: Vec<String> = (0..100).map(|number| format!("{number}.yaml")).collect();
    let entries: Vec<(&str, &[u8])> = names.iter().map(|name| (name.as_str(), &zeros[..1 << 20])).collect();
    refused(&archive(&entries), "would unpack to 100 MB, which is more than 200 times the archive");
}

#[test]
fn a_hundred_thousand_entries_are_listed() {
    let names: Vec<String> = (0..100_000).map(|number| format!("{number:06}.yaml")).collect();
    let entries: Vec<(&str, &[u8])> = names.iter().map(|name| (name.as_str(), &b"x"[..])).collect();
    let taken = take(&archive(&entries));
    let files = taken.found.as_ref().expect("an archive");
    assert_eq!((files.len(), files[99_999].id.as_str()), (100_000, "099999"));
}
