use super::names::suggestion;
use super::shelf::SHELF;
use super::{LabDefinition, LoadError, StudentEdition, student_edition};
use crate::source::{self, SourceText, sanitize};
use std::path::Path;

/// The lab that is meant when none is named.
pub const DEFAULT: &str = "ee361-lab3";

/// Labs inside the program: (id, text of the lab file).
pub fn embedded() -> &'static [(&'static str, &'static str)] {
    SHELF
}

/// The lab of an embedded name, of a lab file, or of a folder that holds `lab.yaml`.
///
/// Anything with a path separator or an extension is a path; an embedded name wins over a folder of that name.
pub fn load(name_or_path: &str) -> Result<LabDefinition, LoadError> {
    Ok(LabDefinition::parse(text_of(name_or_path)?)?)
}

/// The student edition of the same, or the one in the file that an instructor handed out.
pub fn load_student_edition(name_or_path: &str) -> Result<StudentEdition, LoadError> {
    let text = text_of(name_or_path)?;
    if student_edition::is_one(&text) {
        return Ok(StudentEdition::parse(text)?);
    }
    Ok(StudentEdition::of(&LabDefinition::parse(text)?))
}

fn text_of(name_or_path: &str) -> Result<SourceText, LoadError> {
    if let Some((id, text)) = SHELF.iter().find(|(id, _)| *id == name_or_path) {
        return Ok(SourceText::new(format!("{id}/lab.yaml"), *text));
    }
    let given = Path::new(name_or_path);
    let path = if given.is_dir() { given.join("lab.yaml") } else { given.to_owned() };
    let looks_like_path = name_or_path.contains(['/', '\\']) || given.extension().is_some() || given.exists();
    if !looks_like_path {
        return Err(unknown(name_or_path));
    }
    let shown = path.display().to_string();
    let bytes = std::fs::read(&path).map_err(|source| LoadError::Io { path: sanitize(&shown), source })?;
    let text =
        source::decode(&bytes).map_err(|source| LoadError::NotText { path: sanitize(&shown), source })?;
    Ok(SourceText::new(shown, text))
}

fn unknown(name: &str) -> LoadError {
    let ids: Vec<&str> = SHELF.iter().map(|(id, _)| *id).collect();
    LoadError::Unknown { name: sanitize(name), help: suggestion(name, &ids) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_default_is_embedded() {
        assert!(embedded().iter().any(|(id, _)| *id == DEFAULT));
        assert_eq!(load(DEFAULT).unwrap().id, DEFAULT);
    }

    #[test]
    fn an_unknown_name_lists_the_known_ones() {
        assert_eq!(
            load("ee361-lab4").unwrap_err().to_string(),
            "no lab is called `ee361-lab4`, and no file or folder is there; did you mean `ee361-lab3`?"
        );
        let known: Vec<String> = SHELF.iter().map(|(id, _)| format!("`{id}`")).collect();
        assert_eq!(
            load("zzz").unwrap_err().to_string(),
            format!("no lab is called `zzz`, and no file or folder is there; known: {}", known.join(", "))
        );
    }

    #[test]
    fn a_path_is_a_file_or_a_folder_with_a_lab_in_it() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("lab.yaml");
        std::fs::write(&file, SHELF[0].1).unwrap();
        for path in [folder.path(), &file] {
            assert_eq!(load(path.to_str().unwrap()).unwrap().id, "ee361-lab3");
        }
        let missing = folder.path().join("none.yaml");
        assert!(matches!(load(missing.to_str().unwrap()), Err(LoadError::Io { .. })));
        std::fs::write(&file, b"\xff\xff").unwrap();
        assert!(matches!(load(file.to_str().unwrap()), Err(LoadError::NotText { .. })));
        std::fs::write(&file, "lab: x").unwrap();
        assert!(matches!(load(file.to_str().unwrap()), Err(LoadError::Invalid(_))));
    }
}
