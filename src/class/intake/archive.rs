use super::NotRead;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use zip::ZipArchive;
use zip::result::ZipError;

/// A zip archive that is read in place: nothing is ever unpacked to disk, whatever its entries are called.
///
/// Work is bounded for any input: the number of entries, the length of names, what is unpacked of an entry, and what all
/// answer files of an archive may unpack to together.
pub struct Archive {
    path: PathBuf,
    zip: ZipArchive<Positioned>,
    entries: Vec<Entry>,
    /// Of entries whose names lead nowhere else, for files that answers name.
    by_name: BTreeMap<String, usize>,
    /// Two entries have one name; the last of them counts, as it does when an archive is unpacked.
    pub has_duplicate_names: bool,
}

/// A file in an archive.
#[derive(Clone, Debug)]
pub struct Entry {
    /// Its place in the archive's directory.
    index: usize,
    /// Plain names joined by `/`: where the archive says `..`, or begins at a root or a drive, that part is left out.
    pub name: String,
    pub is_link: bool,
    is_encrypted: bool,
    /// As the directory says; not more than this is unpacked.
    size: u64,
    /// When the entry was last changed, as its archive says, in an order that can be compared.
    pub changed: Option<u64>,
}

/// Why an archive as a whole is not read.
#[derive(Debug, thiserror::Error)]
pub enum ArchiveError {
    #[error("it cannot be read: {0}")]
    Io(#[from] io::Error),
    #[error("this is no zip archive, or only a part of one: {what}")]
    NotZip { what: String },
    #[error("it has {found} entries, more than the {limit} that are read")]
    TooManyEntries { found: u64, limit: u64 },
    #[error("its directory takes {found} MB, more than the {limit} MB that are read")]
    LargeDirectory { found: u64, limit: u64 },
    #[error("its answer files would unpack to {size} MB, which is more than {ratio} times the archive")]
    Bomb { size: u64, ratio: u64 },
}

/// Entries of an archive, folders included.
const MOST_ENTRIES: u64 = 500_000;
/// Bytes of the list of entries, names included.
const MOST_OF_A_DIRECTORY: u64 = 256 << 20;
/// Letters of an entry's name, its folders included.
const MOST_OF_A_NAME: usize = 1000;
/// All answer files together may unpack to so much of the archive's own size. Deflate makes at most 1032 of 1; answers
/// people write, some 5 of 1.
const MOST_RATIO: u64 = 200;
/// Below this nobody counts.
const HARMLESS: u64 = 64 << 20;

impl Archive {
    /// Reads the directory of an archive.
    pub fn open(path: &Path) -> Result<Self, ArchiveError> {
        let mut reader = Positioned::open(path)?;
        let (found, directory) = claimed(&mut reader)?;
        let too_many = |found| ArchiveError::TooManyEntries { found, limit: MOST_ENTRIES };
        if found > MOST_ENTRIES {
            return Err(too_many(found));
        }
        if directory > MOST_OF_A_DIRECTORY {
            let limit = MOST_OF_A_DIRECTORY >> 20;
            return Err(ArchiveError::LargeDirectory { found: directory >> 20, limit });
        }
        let zip = ZipArchive::new(reader).map_err(not_zip)?;
        if zip.len() as u64 > MOST_ENTRIES {
            return Err(too_many(zip.len() as u64));
        }
        let mut archive = Self {
            path: path.to_path_buf(),
            entries: Vec::new(),
            by_name: BTreeMap::new(),
            has_duplicate_names: zip.has_duplicate_names(),
            zip: zip.clone(),
        };
        for index in 0..zip.len() {
            let raw = zip.by_index_data(index).map_err(not_zip)?;
            let Ok(name) = raw.name() else { continue };
            if raw.is_dir() || name.ends_with(['/', '\\']) {
                continue;
            }
            let (name, is_plain) = plain_name(&name);
            let entry = Entry {
                index,
                is_link: raw.is_symlink(),
                is_encrypted: raw.encrypted(),
                size: raw.size(),
                changed: raw
                    .last_modified()
                    .map(|at| u64::from(at.datepart()) << 16 | u64::from(at.timepart())),
                name,
            };
            if is_plain {
                archive.by_name.insert(entry.name.clone(), archive.entries.len());
            }
            archive.entries.push(entry);
        }
        Ok(archive)
    }

    pub fn entries(&self) -> &[Entry] {
        &self.entries
    }

    /// Refuses an archive whose `chosen` entries, at most `limit` bytes of each, are together far larger than itself.
    pub fn weigh<'a>(&self, chosen: impl Iterator<Item = &'a Entry>, limit: u64) -> Result<(), ArchiveError> {
        let unpacked = chosen.fold(0_u64, |sum, entry| sum.saturating_add(entry.size.min(limit)));
        let allowed = self.zip_len()?.saturating_mul(MOST_RATIO).max(HARMLESS);
        if unpacked > allowed {
            return Err(ArchiveError::Bomb { size: unpacked >> 20, ratio: MOST_RATIO });
        }
        Ok(())
    }

    fn zip_len(&self) -> io::Result<u64> {
        Ok(std::fs::metadata(&self.path)?.len())
    }

    /// The number of the entry of this name, for what an answer names.
    pub fn find(&self, name: &str) -> Option<usize> {
        self.by_name.get(name).copied()
    }

    /// Whether entries lie in a folder of this name.
    pub fn has_folder(&self, name: &str) -> bool {
        let beneath = format!("{name}/");
        self.by_name.range(beneath.clone()..).next().is_some_and(|(first, _)| first.starts_with(&beneath))
    }

    /// At most `limit` bytes of an entry.
    pub fn read(&self, entry: &Entry, limit: u64) -> Result<Vec<u8>, NotRead> {
        if entry.is_link {
            return Err(NotRead::Link);
        }
        if entry.is_encrypted {
            return Err(NotRead::Encrypted);
        }
        // A copy shares the directory and the open file, and has a place of its own in it.
        let mut zip = self.zip.clone();
        let file = zip.by_index(entry.index).map_err(|error| damaged(&error))?;
        let mut bytes = Vec::new();
        file.take(limit)
            .read_to_end(&mut bytes)
            .map_err(|error| NotRead::Damaged { what: error.to_string() })?;
        Ok(bytes)
    }
}

impl std::fmt::Debug for Archive {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.debug_struct("Archive").field("path", &self.path).finish_non_exhaustive()
    }
}

impl PartialEq for Archive {
    fn eq(&self, other: &Self) -> bool {
        self.path == other.path
    }
}

impl Eq for Archive {}

fn not_zip(error: ZipError) -> ArchiveError {
    match error {
        ZipError::Io(error) => ArchiveError::NotZip { what: error.to_string() },
        error => ArchiveError::NotZip { what: error.to_string() },
    }
}

fn damaged(error: &ZipError) -> NotRead {
    NotRead::Damaged { what: error.to_string() }
}

/// Plain parts of an entry's name, and whether it has no others. `\` counts as `/`, as archives from Windows have it.
fn plain_name(name: &str) -> (String, bool) {
    let name: String = name.chars().take(MOST_OF_A_NAME).collect();
    let name = name.replace('\\', "/");
    let mut is_plain = !name.starts_with('/');
    let mut parts: Vec<&str> = Vec::new();
    for (place, part) in name.split('/').enumerate() {
        let drive = place == 0 && part.len() == 2 && part.ends_with(':');
        match part {
            "" | "." => {}
            ".." => is_plain = false,
            _ if drive => is_plain = false,
            part => parts.push(part),
        }
    }
    (parts.join("/"), is_plain)
}

/// How many entries the end of an archive says there are, and in how many bytes, the largest numbers where it has several ends.
///
/// Asked before the directory is read, for this takes memory by the entry.
fn claimed(reader: &mut Positioned) -> io::Result<(u64, u64)> {
    /// An end is 22 bytes and a comment of at most 65,535; before it may stand its 64-bit form and that one's place.
    const TAIL: u64 = 22 + 65_535 + 20 + 56;
    let start = reader.len.saturating_sub(TAIL);
    let mut tail = Vec::new();
    reader.seek(SeekFrom::Start(start))?;
    reader.take(TAIL).read_to_end(&mut tail)?;
    let number = |at: usize, bytes: usize| {
        let slice = tail.get(at..at + bytes)?;
        Some(slice.iter().rev().fold(0_u64, |sum, byte| sum << 8 | u64::from(*byte)))
    };
    let (mut entries, mut bytes) = (0, 0);
    for at in 0..tail.len() {
        let claimed = match tail.get(at..at + 4) {
            Some(b"PK\x05\x06") => (number(at + 10, 2), number(at + 12, 4)),
            Some(b"PK\x06\x06") => (number(at + 32, 8), number(at + 40, 8)),
            _ => continue,
        };
        entries = claimed.0.map_or(entries, |claimed| entries.max(claimed));
        // All bits set say that the 64-bit form has the number.
        let directory = claimed.1.filter(|size| *size != u64::from(u32::MAX));
        bytes = directory.map_or(bytes, |size| bytes.max(size));
    }
    Ok((entries, bytes))
}

/// A place in a file that several threads read at once: each copy has its own, and its own few bytes read ahead.
#[derive(Debug)]
struct Positioned {
    file: Arc<File>,
    len: u64,
    at: u64,
    /// Bytes of the file from `ahead_at` on.
    ahead: Vec<u8>,
    ahead_at: u64,
}

/// Headers are read a few bytes at a time.
const AHEAD: usize = 4096;

impl Positioned {
    fn open(path: &Path) -> io::Result<Self> {
        let file = File::open(path)?;
        let len = file.metadata()?.len();
        Ok(Self { file: Arc::new(file), len, at: 0, ahead: Vec::new(), ahead_at: 0 })
    }

    fn read_from_file(&self, buffer: &mut [u8]) -> io::Result<usize> {
        #[cfg(unix)]
        return std::os::unix::fs::FileExt::read_at(&*self.file, buffer, self.at);
        #[cfg(windows)]
        return std::os::windows::fs::FileExt::seek_read(&*self.file, buffer, self.at);
    }
}

impl Clone for Positioned {
    fn clone(&self) -> Self {
        Self { file: Arc::clone(&self.file), ahead: Vec::new(), ahead_at: 0, ..*self }
    }
}

impl Read for Positioned {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        if buffer.len() >= AHEAD {
            let count = self.read_from_file(buffer)?;
            self.at += count as u64;
            return Ok(count);
        }
        let known = |one: &Self| {
            let skipped = usize::try_from(one.at.checked_sub(one.ahead_at)?).ok()?;
            one.ahead.get(skipped..).map_or(0, <[u8]>::len).checked_sub(1).map(|_| skipped)
        };
        let skipped = match known(self) {
            Some(skipped) => skipped,
            None => {
                let mut ahead = vec![0; AHEAD];
                let count = self.read_from_file(&mut ahead)?;
                ahead.truncate(count);
                (self.ahead, self.ahead_at) = (ahead, self.at);
                0
            }
        };
        let bytes = self.ahead.get(skipped..).unwrap_or_default();
        let count = bytes.len().min(buffer.len());
        buffer[..count].copy_from_slice(&bytes[..count]);
        self.at += count as u64;
        Ok(count)
    }
}

impl Seek for Positioned {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        let place = match to {
            SeekFrom::Start(place) => Some(place),
            SeekFrom::End(offset) => self.len.checked_add_signed(offset),
            SeekFrom::Current(offset) => self.at.checked_add_signed(offset),
        };
        let before = || io::Error::new(io::ErrorKind::InvalidInput, "a place before the beginning");
        self.at = place.ok_or_else(before)?;
        Ok(self.at)
    }
}
