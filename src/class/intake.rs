use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// An answer file to mark.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AnswerFile {
    pub path: PathBuf,
    /// Name shown in reports and findings: relative to the folder given, so that it does not depend on the machine.
    pub name: String,
    /// File stem, made unique within the class: `blank`, `blank-2`.
    pub id: String,
    /// Whether a link is followed: when the caller named it, not when it lay in a folder of other people's files.
    pub followed: bool,
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
}

/// The answer files among `paths`, in a fixed order: as given, folders by name within.
///
/// A file that is named is taken whatever it is called. In folders `.yaml` and `.yml` count, also with the `.txt` that
/// Windows appends and hides; hidden files and `leave_out` (the marks file) do not. Links are not followed: a link to
/// a file is an answer file that cannot be read.
pub fn find_answer_files(
    paths: &[PathBuf],
    leave_out: Option<&Path>,
) -> Result<Vec<AnswerFile>, IntakeError> {
    let leave_out = leave_out.and_then(|path| path.canonicalize().ok());
    let mut seen = BTreeSet::new();
    let mut ids = UniqueNames::default();
    let mut files = Vec::new();
    for path in paths {
        let found = if path.is_dir() { in_folder(path)? } else { vec![path.clone()] };
        for file in found {
            // A link in a folder stands for itself, wherever it points.
            let place = if file.is_symlink() && *path != file {
                std::path::absolute(&file).ok()
            } else {
                file.canonicalize().ok()
            };
            let Some(place) = place else {
                return Err(IntakeError::Missing { path: file });
            };
            if leave_out.as_ref() == Some(&place) || !seen.insert(place) {
                continue;
            }
            let relative = file.strip_prefix(path).ok().filter(|p| !p.as_os_str().is_empty());
            let name = match relative {
                Some(relative) => relative.to_string_lossy().replace('\\', "/"),
                None => file.file_name().unwrap_or_default().to_string_lossy().into_owned(),
            };
            let file_name = file.file_name().unwrap_or_default().to_string_lossy().into_owned();
            let stem = answer_stem(&file_name).unwrap_or(&file_name);
            let followed = *path == file;
            files.push(AnswerFile { id: ids.claim(stem), name, path: file, followed });
        }
    }
    Ok(files)
}

fn in_folder(folder: &Path) -> Result<Vec<PathBuf>, IntakeError> {
    let mut found = Vec::new();
    let visible = |entry: &walkdir::DirEntry| {
        entry.depth() == 0 || !entry.file_name().to_string_lossy().starts_with('.')
    };
    for entry in walkdir::WalkDir::new(folder).sort_by_file_name().into_iter().filter_entry(visible) {
        let entry = entry.map_err(|error| IntakeError::Unreadable { path: folder.to_path_buf(), error })?;
        if !entry.file_type().is_dir() && answer_stem(&entry.file_name().to_string_lossy()).is_some() {
            found.push(entry.into_path());
        }
    }
    if found.is_empty() {
        return Err(IntakeError::NoAnswers { path: folder.to_path_buf() });
    }
    Ok(found)
}

/// What stands before `.yaml` or `.yml`, in capitals or not, and before a `.txt` behind them; `None` for other files.
fn answer_stem(name: &str) -> Option<&str> {
    let without = |name: &'_ str, ending: &str| {
        let at = name.len().checked_sub(ending.len())?;
        name.get(at..)?.eq_ignore_ascii_case(ending).then_some(at)
    };
    let name = without(name, ".txt").map_or(name, |at| &name[..at]);
    [".yaml", ".yml"].iter().find_map(|ending| without(name, ending)).map(|at| &name[..at])
}

/// Gives out names that are safe as file names everywhere and differ by more than case.
#[derive(Debug, Default)]
pub struct UniqueNames {
    taken: BTreeSet<String>,
}

impl UniqueNames {
    /// `wanted` reduced to letters, digits, `.`, `_`, `-`, at most 80 characters; numbered when taken.
    pub fn claim(&mut self, wanted: &str) -> String {
        let base = safe_file_name(wanted);
        let mut name = base.clone();
        let mut number = 1;
        while !self.taken.insert(name.to_lowercase()) {
            number += 1;
            name = format!("{base}-{number}");
        }
        name
    }
}

fn safe_file_name(wanted: &str) -> String {
    let mut name = String::new();
    for character in wanted.chars().take(80) {
        let safe = character.is_ascii_alphanumeric() || matches!(character, '.' | '_' | '-');
        match (safe, name.ends_with('-')) {
            (true, _) => name.push(character),
            (false, false) => name.push('-'),
            (false, true) => {}
        }
    }
    let name = name.trim_matches(['.', '-']).to_owned();
    let device = name.split('.').next().unwrap_or_default().to_ascii_uppercase();
    let reserved = matches!(device.as_str(), "CON" | "PRN" | "AUX" | "NUL")
        || (device.len() == 4
            && (device.starts_with("COM") || device.starts_with("LPT"))
            && device.ends_with(|c: char| c.is_ascii_digit()));
    match (name.is_empty(), reserved) {
        (true, _) => "submission".to_owned(),
        (false, true) => format!("_{name}"),
        (false, false) => name,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_safe_on_every_system() {
        for (wanted, name) in [
            ("EE-001", "EE-001"),
            ("../../etc/passwd", "etc-passwd"),
            ("<script>", "script"),
            ("=cmd|' /C calc'!A0", "cmd-C-calc-A0"),
            ("", "submission"),
            ("…", "submission"),
            (".hidden", "hidden"),
            ("nul", "_nul"),
            ("com1.yaml", "_com1.yaml"),
            ("a\u{202e}b", "a-b"),
            (&"x".repeat(300), &"x".repeat(80)),
        ] {
            assert_eq!(safe_file_name(wanted), name, "from {wanted:?}");
        }
    }

    #[test]
    fn taken_names_are_numbered_whatever_their_case() {
        let mut names = UniqueNames::default();
        let given: Vec<String> = ["a", "A", "a", "a-2"].iter().map(|n| names.claim(n)).collect();
        assert_eq!(given, ["a", "A-2", "a-3", "a-2-2"]);
    }

    #[test]
    fn folders_are_walked_in_order_and_the_marks_file_is_left_out() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["b.yaml", "a.yml", "notes.txt", ".hidden.yaml", "marks.yaml", "c.YAML.txt"] {
            std::fs::write(folder.path().join(name), "x: 1").unwrap();
        }
        std::fs::create_dir(folder.path().join("late")).unwrap();
        std::fs::write(folder.path().join("late/b.yaml"), "x: 1").unwrap();
        let marks = folder.path().join("marks.yaml");
        let found = find_answer_files(&[folder.path().to_path_buf()], Some(&marks)).unwrap();
        let shown: Vec<(&str, &str)> = found.iter().map(|f| (f.name.as_str(), f.id.as_str())).collect();
        assert_eq!(shown, [("a.yml", "a"), ("b.yaml", "b"), ("c.YAML.txt", "c"), ("late/b.yaml", "b-2")]);
    }

    #[test]
    fn what_is_not_there_is_the_callers_fault() {
        let missing = find_answer_files(&[PathBuf::from("no/such/file.yaml")], None);
        assert!(matches!(missing, Err(IntakeError::Missing { .. })));
        let empty = tempfile::tempdir().unwrap();
        let none = find_answer_files(&[empty.path().to_path_buf()], None);
        assert!(matches!(none, Err(IntakeError::NoAnswers { .. })));
    }
}
