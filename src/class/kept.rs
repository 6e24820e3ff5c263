use super::fingerprint::{Fingerprint, fingerprint};
use super::record::Record;
use super::workplace::{KEPT, Workplace};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufRead, BufReader, Read, Seek, SeekFrom};
use std::path::Path;
use std::sync::{Mutex, OnceLock, PoisonError};

/// What earlier runs in this output folder have marked, so that only what has changed is marked again.
///
/// In memory is where each entry stands, not the entry: a few dozen bytes a submission.
pub struct Kept {
    runs: Vec<KeptRun>,
    /// By the fingerprint of the answer file's name: in which run, and where its entry begins.
    places: BTreeMap<String, (usize, u64)>,
}

/// An earlier run: its entries, and the records that these point into.
struct KeptRun {
    entries: Mutex<File>,
    records: Mutex<File>,
}

/// What a run knows of one answer file: a line of `.polemark/kept.jsonl`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Entry {
    /// Fingerprint of the file's name.
    pub name: String,
    /// Fingerprint of all that its marks rest on: program, lab, roster, the file itself.
    pub key: String,
    /// (name as the answer has it, fingerprint of what came of reading it) of every file beside it that was asked for.
    pub attachments: Vec<(String, String)>,
    /// Ids of its students, in order.
    pub students: Vec<String>,
    /// Fingerprint of what a person gave these students.
    pub marks: String,
    /// One a report.
    pub parts: Vec<EntryPart>,
}

/// One report and its record.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct EntryPart {
    /// Where its line of `results.jsonl` begins and how long it is, in bytes without the line end.
    pub at: u64,
    pub length: u64,
    /// Fingerprint of that line.
    pub line: String,
    /// Fingerprint of what was said because of the other files of the class.
    pub said: String,
    /// Relative to the output folder.
    pub report: String,
    /// Fingerprint of the report.
    pub page: String,
    /// The instructor's edition and its fingerprint, where there is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub instructor: Option<(String, String)>,
}

impl Kept {
    /// Nothing is kept: everything is marked.
    pub fn nothing() -> Self {
        Self { runs: Vec::new(), places: BTreeMap::new() }
    }

    /// What the last finished run in `out` and a stopped one after it have left. What cannot be read is as if it were not there.
    pub fn open(out: &Path, workplace: &Workplace) -> Self {
        let mut kept = Self::nothing();
        kept.add(&workplace.kept(), &out.join("results.jsonl"));
        kept.add(&workplace.stopped().join(KEPT), &workplace.stopped().join("results.jsonl"));
        kept
    }

    /// Entries of a later run count for the same file.
    fn add(&mut self, entries: &Path, records: &Path) {
        let (Ok(file), Ok(records)) = (File::open(entries), File::open(records)) else { return };
        let Ok(again) = File::open(entries) else { return };
        let run = self.runs.len();
        let mut lines = BufReader::new(file);
        let (mut at, mut line) = (0, String::new());
        while let Ok(length) = lines.read_line(&mut line) {
            // A line without an end was being written when the run was stopped.
            if length == 0 || !line.ends_with('\n') {
                break;
            }
            if let Ok(entry) = serde_json::from_str::<Entry>(&line) {
                self.places.insert(entry.name, (run, at));
            }
            at += length as u64;
            line.clear();
        }
        self.runs.push(KeptRun { entries: Mutex::new(again), records: Mutex::new(records) });
    }

    /// The entry of the answer file called `name`.
    pub fn entry(&self, name: &str) -> Option<(Entry, KeptRecords<'_>)> {
        let (run, at) = *self.places.get(&fingerprint(name))?;
        let run = self.runs.get(run)?;
        let entry = serde_json::from_str(&line_at(&run.entries, at)?).ok()?;
        Some((entry, KeptRecords(run)))
    }

    /// (report, fingerprint of it) of everything that was kept, for what is not there any more.
    pub fn reports(&self) -> impl Iterator<Item = (String, String)> + '_ {
        let entries = self.runs.iter().flat_map(|run| {
            let mut file = run.entries.lock().unwrap_or_else(PoisonError::into_inner);
            let mut text = String::new();
            let _ = file.seek(SeekFrom::Start(0)).and_then(|_| file.read_to_string(&mut text));
            let entries = text.lines().filter_map(|line| serde_json::from_str::<Entry>(line).ok());
            let parts = entries.flat_map(|entry| entry.parts);
            parts
                .flat_map(|part| [(part.report, part.page)].into_iter().chain(part.instructor))
                .collect::<Vec<_>>()
        });
        entries.into_iter()
    }
}

/// Fingerprints of a report, and of the instructor's edition where there is one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pages {
    pub report: String,
    pub instructor: Option<(String, String)>,
}

/// The records that an entry points into.
pub struct KeptRecords<'a>(&'a KeptRun);

impl KeptRecords<'_> {
    /// The record of `part` and its line, if they are what they were.
    pub fn record(&self, part: &EntryPart) -> Option<(Record, String)> {
        // A broken entry must not make us read without end.
        const LONGEST: u64 = 64 << 20;
        let mut bytes = vec![0; usize::try_from(part.length.min(LONGEST)).ok()?];
        {
            let mut file = self.0.records.lock().unwrap_or_else(PoisonError::into_inner);
            file.seek(SeekFrom::Start(part.at)).ok()?;
            file.read_exact(&mut bytes).ok()?;
        }
        if fingerprint(&bytes) != part.line {
            return None;
        }
        let line = String::from_utf8(bytes).ok()?;
        let record = Record::from_line(&line).ok()?;
        (record.report == part.report).then_some((record, line))
    }
}

/// Whether the report of `part` lies in `out` as it was written.
pub fn report_is_there(out: &Path, part: &EntryPart) -> bool {
    let full = part.instructor.as_ref();
    is_as_it_was(&out.join(&part.report), &part.page)
        && full.is_none_or(|(path, page)| is_as_it_was(&out.join(path), page))
}

/// Whether the file at `path` still has this fingerprint.
pub fn is_as_it_was(path: &Path, page: &str) -> bool {
    std::fs::read(path).is_ok_and(|bytes| fingerprint(bytes) == page)
}

fn line_at(file: &Mutex<File>, at: u64) -> Option<String> {
    let mut file = file.lock().unwrap_or_else(PoisonError::into_inner);
    file.seek(SeekFrom::Start(at)).ok()?;
    let mut line = String::new();
    BufReader::new(&mut *file).read_line(&mut line).ok()?;
    Some(line)
}

/// The fingerprint of this very program; `None` when it cannot read itself.
pub fn program_hash() -> Option<&'static str> {
    static HASH: OnceLock<Option<String>> = OnceLock::new();
    let read = || Fingerprint::of_file(&std::env::current_exe().ok()?).ok();
    HASH.get_or_init(read).as_deref()
}

/// What every mark of a run rests on, besides the answers: this very program, the lab, the roster, who is in the class.
///
/// `None` when the program cannot read itself: then nothing is used again.
pub fn run_fingerprint(parts: &[&dyn AsRef<[u8]>]) -> Option<Fingerprint> {
    let program = Fingerprint::default().with(program_hash()?);
    Some(parts.iter().fold(program, |all, part| all.with(part.as_ref())))
}
