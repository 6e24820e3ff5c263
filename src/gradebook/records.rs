use super::ExportError;
use crate::class::{Record, is_unfinished};
use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};

/// Records of a finished run, in their order, one in memory at a time.
pub struct Records {
    path: PathBuf,
    lines: BufReader<File>,
    line: usize,
}

impl Records {
    /// Of the output folder `out`; refused when its last run was stopped.
    pub fn open(out: &Path) -> Result<Self, ExportError> {
        if is_unfinished(out) {
            return Err(ExportError::Unfinished { out: out.to_path_buf() });
        }
        let path = out.join("results.jsonl");
        let file = File::open(&path).map_err(|error| ExportError::Read { path: path.clone(), error })?;
        Ok(Self { path, lines: BufReader::new(file), line: 0 })
    }
}

impl Iterator for Records {
    type Item = Result<Record, ExportError>;

    fn next(&mut self) -> Option<Self::Item> {
        let mut line = String::new();
        self.line += 1;
        match self.lines.read_line(&mut line) {
            Ok(0) => None,
            Ok(_) => Some(Record::from_line(line.trim_end()).map_err(|error| ExportError::Record {
                path: self.path.clone(),
                line: self.line,
                error,
            })),
            Err(error) => Some(Err(ExportError::Read { path: self.path.clone(), error })),
        }
    }
}
