use super::outcome::Failure;
use crate::annotations::{Annotations, github, json, junit, sarif};

/// How `check` and `verify` tell what they found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Format {
    /// For people.
    Text,
    /// For other programs.
    Json,
    /// For what shows test results.
    Junit,
    /// For code scanning and editors.
    Sarif,
    /// Annotations in GitHub Actions.
    Github,
}

impl Format {
    /// `text` as it is, or the annotations in another format.
    pub fn output(self, text: String, annotations: &Annotations) -> Result<String, Failure> {
        Ok(match self {
            Self::Text => text,
            Self::Json => json(annotations)?,
            Self::Junit => junit(annotations)?,
            Self::Sarif => sarif(annotations)?,
            Self::Github => github(annotations),
        })
    }
}
