use super::fingerprint::{Fingerprint, fingerprint};
use super::record::Record;
use super::run_facts::RunFacts;
use super::workplace::is_unfinished;
use crate::source::sanitize;
use serde::{Deserialize, Serialize};
use std::fs::File;
use std::io::{self, BufRead, BufReader};
use std::path::{Path, PathBuf};

/// Tells whether `results.jsonl` is what a run wrote: how many lines, and a hash over the hash of each.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct ResultsFacts {
    pub lines: usize,
    pub hash: String,
}

/// [`ResultsFacts`] of lines as they come.
#[derive(Clone, Default)]
pub struct ResultsSum {
    lines: usize,
    sum: Fingerprint,
}

impl ResultsSum {
    /// The next line, by its fingerprint.
    pub fn add(&mut self, line: &str) {
        self.lines += 1;
        self.sum = std::mem::take(&mut self.sum).with(line);
    }

    pub fn facts(self) -> ResultsFacts {
        ResultsFacts { lines: self.lines, hash: self.sum.hex() }
    }
}

/// Why the results of a run are not read.
#[derive(Debug, thiserror::Error)]
pub enum ResultsError {
    #[error("the last run in `{}` was stopped before its end: run `polemark grade` again to finish it", out.display())]
    Unfinished { out: PathBuf },
    #[error("`{}` cannot be read: {error}; is this the output folder of `polemark grade`?", path.display())]
    Read { path: PathBuf, error: io::Error },
    #[error("`{}` cannot be read: run `polemark grade` again, which writes it", path.display())]
    NoFacts { path: PathBuf },
    #[error("line {line} of `{}` is not a result of polemark: {what}", path.display())]
    NotARecord { path: PathBuf, line: usize, what: String },
    #[error(
        "`{}` is not as `polemark grade` wrote it, so its marks may be wrong: run `polemark grade` again, which writes it anew; a \
         mark is changed in a marks file",
        path.display()
    )]
    Changed { path: PathBuf },
}

/// Records of a run in their order, one in memory at a time. After the last one comes an error when `run.json` says that these
/// are not the lines that polemark wrote: nothing is to be made of them before that.
pub struct Results {
    path: PathBuf,
    lines: BufReader<File>,
    line: usize,
    facts: Option<RunFacts>,
    /// Of the lines so far, until it has been held against the facts.
    sum: Option<ResultsSum>,
}

impl Results {
    /// Of the output folder `out`; refused when its last run was stopped.
    pub fn open(out: &Path) -> Result<Self, ResultsError> {
        if is_unfinished(out) {
            return Err(ResultsError::Unfinished { out: out.to_path_buf() });
        }
        let results = Self::of_file(&out.join("results.jsonl"))?;
        match results.facts {
            Some(_) => Ok(results),
            None => Err(ResultsError::NoFacts { path: out.join("run.json") }),
        }
    }

    /// Of the file `path`, and held against the `run.json` beside it where there is one.
    pub fn of_file(path: &Path) -> Result<Self, ResultsError> {
        let path = path.to_path_buf();
        let file = File::open(&path).map_err(|error| ResultsError::Read { path: path.clone(), error })?;
        let facts = RunFacts::beside(&path);
        Ok(Self { path, lines: BufReader::new(file), line: 0, facts, sum: Some(ResultsSum::default()) })
    }

    pub fn facts(&self) -> Option<&RunFacts> {
        self.facts.as_ref()
    }

    fn not_a_record(&self, what: &str) -> ResultsError {
        ResultsError::NotARecord {
            path: self.path.clone(),
            line: self.line,
            what: sanitize(what).to_string(),
        }
    }

    fn end(&mut self) -> Option<ResultsError> {
        let facts = self.sum.take()?.facts();
        let wanted = self.facts.as_ref().and_then(|facts| facts.results.as_ref())?;
        // A copy under another name is not what the facts are of.
        let is_theirs = self.path.file_name().is_some_and(|name| name == "results.jsonl");
        (is_theirs && *wanted != facts).then(|| ResultsError::Changed { path: self.path.clone() })
    }
}

impl Iterator for Results {
    type Item = Result<Record, ResultsError>;

    fn next(&mut self) -> Option<Self::Item> {
        let mut line = String::new();
        self.line += 1;
        match self.lines.read_line(&mut line) {
            Ok(0) => self.end().map(Err),
            Ok(_) => {
                let line = line.trim_end_matches(['\r', '\n']);
                if let Some(sum) = &mut self.sum {
                    sum.add(&fingerprint(line));
                }
                Some(Record::from_line(line).map_err(|error| self.not_a_record(&error.to_string())))
            }
            Err(error) if error.kind() == io::ErrorKind::InvalidData => {
                Some(Err(self.not_a_record("it is not in UTF-8")))
            }
            Err(error) => Some(Err(ResultsError::Read { path: self.path.clone(), error })),
        }
    }
}
