//! What is handed in, in every form it comes in.

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

fn samples() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("submissions")
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

/// Every file below a folder, by name.
fn files_below(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let mut files = Vec::new();
    for entry in walkdir::WalkDir::new(folder).sort_by_file_name() {
        let entry = entry.expect("readable");
        if entry.file_type().is_file() {
            let name = entry.path().strip_prefix(folder).expect("below").to_string_lossy().into_owned();
            files.push((name, fs::read(entry.path()).expect("read")));
        }
    }
    files
}

#[test]
fn a_folder_and_an_archive_of_it_give_the_same_bytes() {
    let bench = tempfile::tempdir().expect("a folder");
    let files = files_below(&samples());
    write_zip(&bench.path().join("class.zip"), &files);
    let (one, two) = (bench.path().join("one"), bench.path().join("two"));
    grade(&[samples().to_str().expect("a path")], &one);
    grade(&[bench.path().join("class.zip").to_str().expect("a path")], &two);
    let (one, two) = (files_below(&one), files_below(&two));
    assert_eq!(one.len(), two.len());
    for ((name, one), (_, two)) in one.iter().zip(&two) {
        assert!(one == two, "{name} differs");
    }
}
