use super::desk::SourceFile;
use super::fingerprint::fingerprint;
use super::kept::{Entry, EntryPart, Pages};
use super::record::Record;
use super::results::{ResultsFacts, ResultsSum};
use super::run::{ClassError, ClassJob};
use super::workplace::{KEPT, Workplace};
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// A record and its line, and the fingerprints of its reports.
pub struct Written {
    pub record: Record,
    pub line: String,
    pub pages: Pages,
    /// An earlier run wrote it.
    pub kept: bool,
}

/// `results.jsonl` of a run as it grows, and beside it what the next run needs to use it again.
///
/// Both grow under `.polemark/running/` and take their place when the run is finished; what a stopped run wrote there is used
/// by the next one.
pub struct RunRecords<'a> {
    job: &'a ClassJob<'a>,
    results: Growing,
    entries: Growing,
    /// Bytes of `results` so far.
    at: u64,
    sum: ResultsSum,
    kept: usize,
    /// The entry of the file whose parts are being written.
    open: Option<(usize, Entry)>,
}

impl<'a> RunRecords<'a> {
    pub fn create(job: &'a ClassJob<'a>, workplace: &Workplace) -> Result<Self, ClassError> {
        let folder = workplace.running();
        let results = Growing::create(folder.join("results.jsonl"))?;
        let entries = Growing::create(folder.join(KEPT))?;
        Ok(Self { job, results, entries, at: 0, sum: ResultsSum::default(), kept: 0, open: None })
    }

    /// The next part, in order; those of one file come one after another.
    pub fn add(&mut self, source: &SourceFile, said: String, written: &Written) -> Result<(), ClassError> {
        self.results.line(&written.line)?;
        let length = written.line.len() as u64;
        let part = EntryPart {
            at: self.at,
            length,
            line: fingerprint(&written.line),
            said,
            report: written.record.report.clone(),
            page: written.pages.report.clone(),
            instructor: written.pages.instructor.clone(),
        };
        self.sum.add(&part.line);
        self.at += length + 1;
        self.kept += usize::from(written.kept);
        if self.open.as_ref().is_none_or(|(place, _)| *place != source.place) {
            self.close()?;
            let name = self.job.intake.files.get(source.place).map_or("", |file| file.name.as_str());
            let entry = Entry {
                name: fingerprint(name),
                key: source.key.clone(),
                attachments: source.attachments.clone(),
                students: source.students.clone(),
                marks: source.marks.clone(),
                parts: Vec::new(),
            };
            self.open = Some((source.place, entry));
        }
        if let Some((_, entry)) = &mut self.open {
            entry.parts.push(part);
        }
        Ok(())
    }

    /// A line for what is not marked, and so is nothing that the next run could use again.
    pub fn add_unmarked(&mut self, record: &Record) -> Result<(), ClassError> {
        self.close()?;
        let line = record.to_line()?;
        self.sum.add(&fingerprint(&line));
        self.at += line.len() as u64 + 1;
        self.results.line(&line)
    }

    /// Submissions of which nothing had changed.
    pub fn kept(&self) -> usize {
        self.kept
    }

    /// Everything so far is in the files, records before what points to them.
    pub fn flush(&mut self) -> Result<(), ClassError> {
        self.close()?;
        self.results.flush()?;
        self.entries.flush()
    }

    /// Puts both in place, the results first: entries that point into older results are found out by their fingerprints. Gives
    /// by what the results are known again.
    pub fn publish(mut self, workplace: &Workplace) -> Result<ResultsFacts, ClassError> {
        self.flush()?;
        workplace.publish("results.jsonl", &self.job.out.join("results.jsonl"))?;
        workplace.publish(KEPT, &workplace.kept())?;
        Ok(self.sum.facts())
    }

    fn close(&mut self) -> Result<(), ClassError> {
        match self.open.take() {
            Some((_, entry)) => self.entries.line(&serde_json::to_string(&entry)?),
            None => Ok(()),
        }
    }
}

/// A file that grows by lines.
struct Growing {
    path: PathBuf,
    file: BufWriter<File>,
}

impl Growing {
    fn create(path: PathBuf) -> Result<Self, ClassError> {
        let file = File::create(&path).map_err(|error| written(&path, error))?;
        Ok(Self { path, file: BufWriter::new(file) })
    }

    fn line(&mut self, line: &str) -> Result<(), ClassError> {
        writeln!(self.file, "{line}").map_err(|error| written(&self.path, error))
    }

    fn flush(&mut self) -> Result<(), ClassError> {
        self.file.flush().map_err(|error| written(&self.path, error))
    }
}

fn written(path: &Path, error: io::Error) -> ClassError {
    ClassError::Write { path: path.to_path_buf(), error }
}
