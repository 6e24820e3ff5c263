//! A class as it is handed in: folders, single files, and the archives of Moodle and Canvas.

use super::class::{Class, Student};
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::Path;
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// A folder a student.
    Folder,
    /// All files in one folder.
    Files,
    /// Moodle, a folder a student.
    Moodle,
    /// Moodle, all files in one folder.
    MoodleFlat,
    /// Moodle, with hidden names.
    MoodleHidden,
    Canvas,
    /// Canvas, with hidden names.
    CanvasHidden,
    /// Moodle, groups of two: the answers of the first of them.
    Groups,
}

pub const FORMS: &[(&str, Form)] = &[
    ("folder", Form::Folder),
    ("files", Form::Files),
    ("moodle", Form::Moodle),
    ("moodle-flat", Form::MoodleFlat),
    ("moodle-hidden", Form::MoodleHidden),
    ("canvas", Form::Canvas),
    ("canvas-hidden", Form::CanvasHidden),
    ("groups", Form::Groups),
];

impl Form {
    /// What is handed in lies in `submissions`, or in `submissions.zip`.
    pub fn is_archive(self) -> bool {
        !matches!(self, Self::Folder | Self::Files)
    }
}

/// Writes what `students` students hand in to `out`, and `roster.csv` beside it.
pub fn write(class: &Class<'_>, students: usize, form: Form, out: &Path) -> io::Result<()> {
    fs::create_dir_all(out)?;
    let mut roster = String::from("id,name,email,canvas_id,moodle_id,group\n");
    let mut archive = match form.is_archive() {
        true => Some(ZipWriter::new(File::create(out.join("submissions.zip"))?)),
        false => None,
    };
    let mut first: Option<Student> = None;
    for number in 0..students {
        let student = class.student(number);
        roster.push_str(&format!(
            "{id},\"{name}\",{id}@example.org,{canvas},{moodle},Group {group:04}\n",
            id = student.id,
            name = student.name(),
            canvas = canvas_id(number),
            moodle = moodle_id(number),
            group = number / 2 + 1,
        ));
        let entries = match (form, first.take()) {
            (Form::Groups, None) if number + 1 < students => {
                first = Some(student);
                continue;
            }
            (Form::Groups, Some(other)) => group(class, &other, &student, number),
            _ => entries(&student, number, form),
        };
        for (name, content) in entries {
            match &mut archive {
                Some(zip) => {
                    zip.start_file(name, SimpleFileOptions::default()).map_err(io::Error::other)?;
                    zip.write_all(&content)?;
                }
                None => {
                    let path = out.join("submissions").join(name);
                    fs::create_dir_all(path.parent().unwrap_or(out))?;
                    fs::write(path, content)?;
                }
            }
        }
    }
    if let Some(zip) = archive {
        zip.finish().map_err(io::Error::other)?;
    }
    fs::write(out.join("roster.csv"), roster)
}

fn canvas_id(number: usize) -> usize {
    1_000 + number
}

fn moodle_id(number: usize) -> usize {
    40_000 + number
}

/// (name, content) of all that one student hands in.
fn entries(student: &Student, number: usize, form: Form) -> Vec<(String, Vec<u8>)> {
    let mut files = vec![("lab.yaml".to_owned(), student.answers.clone().into_bytes())];
    files.extend(student.attachments.iter().cloned());
    // Moodle takes out signs that file systems do not like.
    let plain: String = student.name().chars().filter(|c| !matches!(c, '\'' | '"' | '/' | ':')).collect();
    let moodle = match form {
        Form::MoodleHidden => format!("Participant_{}", moodle_id(number)),
        _ => format!("{plain}_{}", moodle_id(number)),
    };
    // Canvas: family name first, letters and digits only.
    let sortable = format!("{}, {}", student.family, student.given).to_lowercase();
    let canvas: String = sortable.chars().filter(|c| c.is_alphanumeric() || *c == '_').collect();
    let late = if student.late { "LATE_" } else { "" };
    let named = |(place, (name, content)): (usize, (String, Vec<u8>))| {
        let attachment = 100_000 + number * 40 + place;
        let name = match form {
            Form::Folder => format!("{}/{name}", student.id),
            Form::Files if place == 0 => format!("{}.yaml", student.id),
            Form::Files => name,
            Form::Moodle | Form::MoodleHidden | Form::Groups => {
                format!("{moodle}_assignsubmission_file/{name}")
            }
            Form::MoodleFlat => format!("{moodle}_assignsubmission_file_{name}"),
            Form::Canvas => format!("{canvas}_{late}{}_{attachment}_{name}", canvas_id(number)),
            Form::CanvasHidden => format!("{late}anon_x{number:05}_{attachment}_{name}"),
        };
        (name, content)
    };
    files.into_iter().enumerate().map(named).collect()
}

/// The first one's answers for both.
fn group(class: &Class<'_>, first: &Student, second: &Student, number: usize) -> Vec<(String, Vec<u8>)> {
    let folder = format!("Group {:04}_{}_assignsubmission_file", number / 2 + 1, 700 + number / 2);
    let answers = class.with_students(first, &[first, second]).into_bytes();
    let mut files = vec![(format!("{folder}/lab.yaml"), answers)];
    files.extend(
        first.attachments.iter().map(|(name, content)| (format!("{folder}/{name}"), content.clone())),
    );
    files
}
