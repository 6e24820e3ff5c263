use super::names::suggestion;
use super::{LabDefinition, LoadError};
use crate::source::{self, SourceText, sanitize};
use std::path::Path;

/// The lab that is meant when none is named.
pub const DEFAULT: &str = "ee361-lab3";

const EMBEDDED: &[(&str, &str)] = &[("ee361-lab3", include_str!("../../labs/ee361-lab3/lab.yaml"))];

/// Labs inside the program: (id, text of the lab file).
pub fn embedded() -> &'static [(&'static str, &'static str)] {
    EMBEDDED
}

/// The lab of an embedded name, of a lab file, or of a folder that holds `lab.yaml`.
///
/// Anything with a path separator or an extension is a path; an embedded name wins over a folder of that name.
pub fn load(name_or_path: &str) -> Result<LabDefinition, LoadError> {
    if let Some((id, text)) = EMBEDDED.iter().find(|(id, _)| *id == name_or_path) {
        return Ok(LabDefinition::parse(SourceText::new(format!("{id}/lab.yaml"), *text))?);
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
    Ok(LabDefinition::parse(SourceText::new(shown, text))?)
}

fn unknown(name: &str) -> LoadError {
    let ids: Vec<&str> = EMBEDDED.iter().map(|(id, _)| *id).collect();
    LoadError::Unknown { name: sanitize(name), help: suggestion(name, &ids) }
}
