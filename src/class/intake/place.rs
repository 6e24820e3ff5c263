use super::archive::{Archive, Entry};
use super::lms_names::without_resubmission;
use crate::source::{Finding, Severity};
use crate::submission::{AttachmentError, Attachments, Folder, MAX_ATTACHMENT_BYTES, plain_path};
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Answer files are refused far below this; reading stops here.
pub const READ_LIMIT: u64 = 1 << 20;

/// Where a file is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Place {
    File(PathBuf),
    /// `number` counts [`Archive::entries`].
    Entry {
        archive: Arc<Archive>,
        number: usize,
    },
}

/// Why a file was not read. Messages are full sentences, for the student.
#[derive(Debug, thiserror::Error)]
pub enum NotRead {
    #[error("This is a link to another file, which is not followed.")]
    Link,
    #[error("The file could not be opened: {0}.")]
    Io(#[from] io::Error),
    #[error("The archive asks for a password to open this file.")]
    Encrypted,
    #[error("This file is damaged in the archive it came in: {what}.")]
    Damaged { what: String },
}

impl NotRead {
    pub fn finding(&self) -> Finding {
        let (code, help) = match self {
            Self::Link => ("file.link", Some("Hand in the file itself.")),
            Self::Io(_) => ("file.not_opened", None),
            Self::Encrypted => ("intake.encrypted", Some("Hand in the file without a password.")),
            Self::Damaged { .. } => (
                "intake.damaged",
                Some("A person should download the archive once more, or ask for the file."),
            ),
        };
        Finding {
            severity: Severity::Error,
            code,
            message: self.to_string(),
            help: help.map(str::to_owned),
            span: None,
        }
    }
}

impl Place {
    /// At most a little more than an answer file may hold, so that a huge one is refused without being read.
    pub fn read_capped(&self) -> Result<Vec<u8>, NotRead> {
        match self {
            Self::File(path) => Ok(read_capped(path)?),
            Self::Entry { archive, .. } => archive.read(self.entry_of(archive)?, READ_LIMIT),
        }
    }

    /// The whole of a file that an answer names.
    fn read_attachment(&self) -> Result<Vec<u8>, AttachmentError> {
        let limit = MAX_ATTACHMENT_BYTES;
        let bytes = match self {
            Self::File(path) => {
                let folder = Folder(path.parent().unwrap_or(Path::new("")).to_path_buf());
                let name = path.file_name().and_then(|name| name.to_str()).ok_or(AttachmentError::BadName)?;
                return folder.read(name);
            }
            Self::Entry { archive, .. } => {
                let entry = self.entry_of(archive).map_err(|_| AttachmentError::Unreadable)?;
                archive.read(entry, limit as u64 + 1).map_err(|why| match why {
                    NotRead::Link => AttachmentError::OutsideFolder,
                    _ => AttachmentError::Unreadable,
                })?
            }
        };
        if bytes.len() > limit { Err(AttachmentError::TooLarge { limit }) } else { Ok(bytes) }
    }

    fn entry_of<'a>(&self, archive: &'a Archive) -> Result<&'a Entry, NotRead> {
        let number = match self {
            Self::Entry { number, .. } => archive.entries().get(*number),
            Self::File(_) => None,
        };
        number.ok_or_else(|| NotRead::Damaged { what: "the entry is gone".to_owned() })
    }
}

/// At most a little more than an answer file may hold, so that a huge one is refused without being read.
///
/// Errors: also for what is no plain file; a pipe could keep us waiting for ever.
pub fn read_capped(path: &Path) -> io::Result<Vec<u8>> {
    let metadata = std::fs::metadata(path)?;
    if !metadata.is_file() {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "not a plain file"));
    }
    // One more, so that the end is seen without asking for memory again.
    let mut bytes = Vec::with_capacity(metadata.len().min(READ_LIMIT) as usize + 1);
    std::fs::File::open(path)?.take(READ_LIMIT).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// Where the files are that an answer file names.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Beside {
    /// In the folder of the answer file.
    Folder,
    /// All files of a class lie in one folder, each under its owner's name: those of the owner, and when the answer file
    /// itself was handed in.
    Own { files: Arc<Vec<OwnFile>>, attempt: u64 },
}

/// A file of an owner.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OwnFile {
    /// As it was called when it was handed in.
    pub name: String,
    /// Grows with each file handed in; 0 when nothing says so.
    pub attempt: u64,
    pub place: Place,
}

/// The files that the answer file at `place` may name.
pub fn attachments(place: &Place, beside: &Beside) -> Box<dyn Attachments> {
    match (beside, place) {
        (Beside::Own { files, attempt }, _) => {
            Box::new(OwnFiles { files: Arc::clone(files), attempt: *attempt })
        }
        (Beside::Folder, Place::File(path)) => {
            Box::new(Folder(path.parent().unwrap_or(Path::new("")).to_path_buf()))
        }
        (Beside::Folder, Place::Entry { archive, number }) => {
            let name = archive.entries().get(*number).map_or("", |entry| entry.name.as_str());
            let folder = name.rsplit_once('/').map_or("", |(folder, _)| folder).to_owned();
            Box::new(ArchiveFolder { archive: Arc::clone(archive), folder })
        }
    }
}

/// The files beneath one folder of an archive.
struct ArchiveFolder {
    archive: Arc<Archive>,
    folder: String,
}

impl Attachments for ArchiveFolder {
    fn read(&self, file_name: &str) -> Result<Vec<u8>, AttachmentError> {
        let path = plain_path(file_name)?;
        let parts: Vec<_> = path.iter().map(|part| part.to_string_lossy()).collect();
        let name = parts.join("/");
        let name = if self.folder.is_empty() { name } else { format!("{}/{name}", self.folder) };
        match self.archive.find(&name) {
            Some(number) => Place::Entry { archive: Arc::clone(&self.archive), number }.read_attachment(),
            None if self.archive.has_folder(&name) => Err(AttachmentError::NotAFile),
            None => Err(AttachmentError::NotFound),
        }
    }
}

/// The files of one owner, by the names they had on the owner's disk.
struct OwnFiles {
    files: Arc<Vec<OwnFile>>,
    attempt: u64,
}

impl Attachments for OwnFiles {
    fn read(&self, file_name: &str) -> Result<Vec<u8>, AttachmentError> {
        let path = plain_path(file_name)?;
        // A learning management system keeps no folders.
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let named = |file: &&OwnFile| file.name == name || without_resubmission(&file.name).0 == name;
        // What was handed in with the answers, when it was handed in more than once.
        let own = self
            .files
            .iter()
            .filter(named)
            .min_by_key(|file| (file.attempt.abs_diff(self.attempt), file.name != name));
        own.map_or(Err(AttachmentError::NotFound), |file| file.place.read_attachment())
    }
}
