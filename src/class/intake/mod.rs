//! What was handed in: folders, files, zip archives, as people keep them and as learning management systems hand them out.

mod archive;
mod aside;
mod attempts;
mod lms_names;
mod owners;
mod people;
mod place;
mod reading;
mod unique_names;

pub use archive::{Archive, ArchiveError};
pub use aside::{Aside, WhyAside};
pub use attempts::{Superseded, answers_another_lab};
pub use lms_names::{HandedIn, Lms};
pub use people::{handed_in, settle_people, student_records};
pub use place::{NotRead, Place, read_capped};
pub use unique_names::UniqueNames;

use archive::Entry;
use owners::Found;
use place::{Beside, READ_LIMIT};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// What a class handed in.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Intake {
    /// To be marked, in a fixed order. Who handed in nothing that can be marked has an entry that says so.
    pub files: Vec<AnswerFile>,
    /// Answer files that do not count, since others of the same owners do.
    pub superseded: Vec<Superseded>,
    /// Not marked, and why.
    pub aside: Vec<Aside>,
}

/// An answer file to mark.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AnswerFile {
    pub place: Place,
    /// Name shown in reports and findings: relative to the folder or archive given, so that it does not depend on the machine.
    pub name: String,
    /// File stem or owner, made unique within the class: `blank`, `blank-2`, `Jane-Doe_1234`.
    pub id: String,
    /// Whether a link is followed: when the caller named it, not when it lay in a folder of other people's files.
    pub followed: bool,
    /// Who handed it in, where an LMS says so.
    pub handed_in: HandedIn,
    /// When an archive says it was last changed, in an order that can be compared.
    pub changed: Option<u64>,
    /// Its owner handed in nothing but these, none of which is an answer file.
    pub only_others: Vec<String>,
    /// Other answer files of the same owner that are marked too, since nothing says which counts.
    pub beside_others: Vec<String>,
    /// As it was called when it was handed in.
    own_name: String,
    beside: Beside,
}

/// What was asked for cannot be found: the caller's fault.
#[derive(Debug, thiserror::Error)]
pub enum IntakeError {
    #[error("`{path}` does not exist")]
    Missing { path: PathBuf },
    #[error("`{path}` cannot be read: {error}")]
    Unreadable { path: PathBuf, error: walkdir::Error },
    #[error("no answer files (.yaml or .yml) in `{path}`")]
    NoAnswers { path: PathBuf },
    #[error(
        "no answer files (.yaml or .yml) in `{folder}`, but an archive: name it to have it read, `{archive}`"
    )]
    OnlyArchive { folder: PathBuf, archive: PathBuf },
    #[error("the archive `{path}` is not read: {error}")]
    Archive { path: PathBuf, error: ArchiveError },
}

/// The answer files among `paths`, in a fixed order: as given, folders and archives by name within.
///
/// A file that is named is taken whatever it is called; a `.zip` is read as a folder, in place. In folders `.yaml` and `.yml`
/// count, also with the `.txt` that Windows appends and hides; hidden files and those of which `leave_out` says so (the marks file; told by
/// their canonical path) do not. Links are
/// not followed: a link to a file is an answer file that cannot be read. What Moodle and Canvas say in names is kept.
pub fn find_answer_files(
    paths: &[PathBuf],
    leave_out: &dyn Fn(&Path) -> bool,
) -> Result<Intake, IntakeError> {
    let (mut seen, mut archives) = (BTreeSet::new(), BTreeSet::new());
    let mut found = Vec::new();
    for (source, path) in paths.iter().enumerate() {
        let files = if path.is_dir() {
            in_folder(path, source)?
        } else if has_ending(&path.to_string_lossy(), &[".zip"]) {
            if path.canonicalize().is_ok_and(|place| !archives.insert(place)) {
                continue;
            }
            in_archive(path, source)?
        } else {
            vec![alone(path, source)]
        };
        for file in files {
            if let Place::File(place) = &file.place {
                // A link in a folder stands for itself, wherever it points.
                let place = if place.is_symlink() && !file.named {
                    std::path::absolute(place).ok()
                } else {
                    place.canonicalize().ok()
                };
                let Some(place) = place else {
                    return Err(IntakeError::Missing { path: path.clone() });
                };
                if leave_out(&place) || !seen.insert(place) {
                    continue;
                }
            }
            found.push(file);
        }
    }
    let beside = beside_given(&found).into_iter().filter(|(place, _)| !seen.contains(place));
    found.extend(beside.map(|(_, file)| file).collect::<Vec<_>>());
    Ok(owners::sorted_out(found))
}

fn alone(path: &Path, source: usize) -> Found {
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let folder = path.parent().and_then(Path::file_name).map(|folder| folder.to_string_lossy());
    let name = match folder {
        Some(folder) if owners::is_folder_of_moodle(&folder) => format!("{folder}/{name}"),
        _ => name,
    };
    let place = Place::File(path.to_path_buf());
    Found { place, name, named: true, source, changed: None, beside_given: false }
}

/// (place, file) of what lies beside named files that an LMS has put among those of a whole class: answers may name them.
fn beside_given(found: &[Found]) -> Vec<(PathBuf, Found)> {
    let mut folders = BTreeSet::new();
    for file in found.iter().filter(|file| file.named && owners::is_among_a_class(file)) {
        if let Place::File(path) = &file.place {
            folders.insert(path.parent().unwrap_or(Path::new("")).to_path_buf());
        }
    }
    let mut beside = Vec::new();
    for folder in folders {
        let folder = if folder.as_os_str().is_empty() { PathBuf::from(".") } else { folder };
        let mut paths: Vec<PathBuf> = std::fs::read_dir(&folder)
            .into_iter()
            .flatten()
            .filter_map(|entry| Some(entry.ok()?.path()))
            .filter(|path| path.is_file() && !path.is_symlink())
            .collect();
        paths.sort();
        for path in paths {
            let Ok(place) = path.canonicalize() else { continue };
            beside.push((place, Found { named: false, beside_given: true, ..alone(&path, usize::MAX) }));
        }
    }
    beside
}

fn in_folder(folder: &Path, source: usize) -> Result<Vec<Found>, IntakeError> {
    let mut found = Vec::new();
    let visible =
        |entry: &walkdir::DirEntry| entry.depth() == 0 || !is_hidden(&entry.file_name().to_string_lossy());
    for entry in walkdir::WalkDir::new(folder).sort_by_file_name().into_iter().filter_entry(visible) {
        let entry = entry.map_err(|error| IntakeError::Unreadable { path: folder.to_path_buf(), error })?;
        if entry.file_type().is_dir() {
            continue;
        }
        let path = entry.into_path();
        let relative = path.strip_prefix(folder).unwrap_or(&path);
        let name = relative.to_string_lossy().replace('\\', "/");
        found.push(Found {
            place: Place::File(path),
            name,
            named: false,
            source,
            changed: None,
            beside_given: false,
        });
    }
    if !owners::has_answers(&found) {
        let archive = found.iter().find(|file| has_ending(&file.name, &[".zip"]));
        return Err(match archive {
            Some(archive) => {
                IntakeError::OnlyArchive { folder: folder.to_path_buf(), archive: folder.join(&archive.name) }
            }
            None => IntakeError::NoAnswers { path: folder.to_path_buf() },
        });
    }
    Ok(found)
}

fn in_archive(path: &Path, source: usize) -> Result<Vec<Found>, IntakeError> {
    let failed = |error| IntakeError::Archive { path: path.to_path_buf(), error };
    if !path.exists() {
        return Err(IntakeError::Missing { path: path.to_path_buf() });
    }
    let archive = Arc::new(Archive::open(path).map_err(failed)?);
    let visible = |entry: &Entry| {
        !entry.name.is_empty() && !entry.name.split('/').any(|part| is_hidden(part) || part == "__MACOSX")
    };
    let entries = archive.entries().iter().enumerate().filter(|(_, entry)| visible(entry));
    let mut found: Vec<Found> = entries
        .map(|(number, entry)| Found {
            place: Place::Entry { archive: Arc::clone(&archive), number },
            name: entry.name.clone(),
            named: false,
            source,
            changed: entry.changed,
            beside_given: false,
        })
        .collect();
    // As a folder is walked.
    found.sort_by(|one, two| one.name.split('/').cmp(two.name.split('/')));
    let answers = found.iter().filter(|file| answer_stem(&file.name).is_some());
    let answers = answers.filter_map(|file| match &file.place {
        Place::Entry { number, .. } => archive.entries().get(*number),
        Place::File(_) => None,
    });
    archive.weigh(answers, READ_LIMIT).map_err(failed)?;
    if !owners::has_answers(&found) {
        return Err(IntakeError::NoAnswers { path: path.to_path_buf() });
    }
    Ok(found)
}

fn is_hidden(name: &str) -> bool {
    name.starts_with('.')
}

/// What stands before `.yaml` or `.yml`, in capitals or not, and before a `.txt` behind them; `None` for other files.
fn answer_stem(name: &str) -> Option<&str> {
    let name = without_ending(name, ".txt").unwrap_or(name);
    [".yaml", ".yml"].iter().find_map(|ending| without_ending(name, ending))
}

/// Whether a name ends in one of these, in capitals or not.
fn has_ending(name: &str, endings: &[&str]) -> bool {
    endings.iter().any(|ending| without_ending(name, ending).is_some())
}

fn without_ending<'a>(name: &'a str, ending: &str) -> Option<&'a str> {
    let at = name.len().checked_sub(ending.len())?;
    name.get(at..)?.eq_ignore_ascii_case(ending).then(|| &name[..at])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_are_walked_in_order_and_the_marks_file_is_left_out() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["b.yaml", "a.yml", "notes.txt", ".hidden.yaml", "marks.yaml", "c.YAML.txt"] {
            std::fs::write(folder.path().join(name), "x: 1").unwrap();
        }
        std::fs::create_dir(folder.path().join("late")).unwrap();
        std::fs::write(folder.path().join("late/b.yaml"), "x: 1").unwrap();
        let is_marks = |path: &Path| path.ends_with("marks.yaml");
        let found = find_answer_files(&[folder.path().to_path_buf()], &is_marks).unwrap();
        let shown: Vec<(&str, &str)> = found.files.iter().map(|f| (f.name.as_str(), f.id.as_str())).collect();
        assert_eq!(shown, [("a.yml", "a"), ("b.yaml", "b"), ("c.YAML.txt", "c"), ("late/b.yaml", "b-2")]);
    }

    #[test]
    fn what_is_not_there_is_the_callers_fault() {
        let missing = find_answer_files(&[PathBuf::from("no/such/file.yaml")], &|_| false);
        assert!(matches!(missing, Err(IntakeError::Missing { .. })));
        let empty = tempfile::tempdir().unwrap();
        let none = find_answer_files(&[empty.path().to_path_buf()], &|_| false);
        assert!(matches!(none, Err(IntakeError::NoAnswers { .. })));
    }

    #[test]
    fn every_code_is_documented() {
        let manual = include_str!("../../../docs/intake.md");
        let sources = [
            include_str!("attempts.rs"),
            include_str!("people.rs"),
            include_str!("place.rs"),
            include_str!("reading.rs"),
            include_str!("../record.rs"),
        ];
        let words = sources.iter().flat_map(|source| source.split('"'));
        let codes: Vec<&str> =
            words.filter(|word| word.starts_with("intake.") && *word != "intake.").collect();
        assert!(codes.len() > 10, "{codes:?}");
        for code in codes {
            assert!(manual.contains(&format!("`{code}`")), "docs/intake.md does not list `{code}`");
        }
    }
}
