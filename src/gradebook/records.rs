use super::ExportError;
use crate::class::{Record, Results};
use std::path::Path;

/// Records of a finished run, in their order, one in memory at a time.
pub struct Records(Results);

impl Records {
    /// Of the output folder `out`; refused when its last run was stopped.
    pub fn open(out: &Path) -> Result<Self, ExportError> {
        Ok(Self(Results::open(out)?))
    }

    /// Whether students are not to see their points: the lab says so, or `grade --release`.
    pub fn withhold_marks(&self) -> bool {
        self.0.facts().and_then(|facts| facts.release).is_some_and(|release| !release.marks)
    }
}

impl Iterator for Records {
    type Item = Result<Record, ExportError>;

    fn next(&mut self) -> Option<Self::Item> {
        Some(self.0.next()?.map_err(ExportError::from))
    }
}
