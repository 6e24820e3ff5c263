use std::fs::{self, File};
use std::io::Read;
use std::path::{Component, Path, PathBuf};

/// A figure or data file may be this large, in bytes.
pub const MAX_ATTACHMENT_BYTES: usize = 2_000_000;

/// Where the files come from that an answer names.
pub trait Attachments {
    /// The bytes of `file_name`, as the student wrote it.
    fn read(&self, file_name: &str) -> Result<Vec<u8>, AttachmentError>;
}

/// Why an attached file was not read. Messages are full sentences, for the student.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum AttachmentError {
    #[error("There is no file of this name beside the answer file.")]
    NotFound,
    #[error("Only files beside the answer file, or in a folder beside it, are read.")]
    OutsideFolder,
    #[error("This is not the name of a file we can open.")]
    BadName,
    #[error("This is not a plain file.")]
    NotAFile,
    #[error("The file has more than the {limit} bytes we read.")]
    TooLarge { limit: usize },
    #[error("The file is there but could not be read.")]
    Unreadable,
}

/// No file is ever found.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoFiles;

impl Attachments for NoFiles {
    fn read(&self, _: &str) -> Result<Vec<u8>, AttachmentError> {
        Err(AttachmentError::NotFound)
    }
}

/// The files beneath one folder. Nothing outside it is read, whatever the name says and wherever links point.
#[derive(Clone, Debug)]
pub struct Folder(pub PathBuf);

impl Attachments for Folder {
    fn read(&self, file_name: &str) -> Result<Vec<u8>, AttachmentError> {
        let relative = plain_path(file_name)?;
        let folder = if self.0.as_os_str().is_empty() { Path::new(".") } else { &self.0 };
        let folder = folder.canonicalize().map_err(|_| AttachmentError::NotFound)?;
        let path = folder.join(relative).canonicalize().map_err(|_| AttachmentError::NotFound)?;
        if !path.starts_with(&folder) {
            return Err(AttachmentError::OutsideFolder);
        }
        // Asked before opening: opening a pipe would wait for ever.
        let metadata = fs::metadata(&path).map_err(|_| AttachmentError::Unreadable)?;
        if !metadata.is_file() {
            return Err(AttachmentError::NotAFile);
        }
        let limit = MAX_ATTACHMENT_BYTES;
        let mut bytes = Vec::with_capacity(metadata.len().min(limit as u64) as usize + 1);
        File::open(&path)
            .and_then(|file| file.take(limit as u64 + 1).read_to_end(&mut bytes))
            .map_err(|_| AttachmentError::Unreadable)?;
        if bytes.len() > limit { Err(AttachmentError::TooLarge { limit }) } else { Ok(bytes) }
    }
}

/// A relative path of plain names; `\` counts as `/`, since reports come from Windows too.
pub fn plain_path(file_name: &str) -> Result<PathBuf, AttachmentError> {
    let name = file_name.trim().replace('\\', "/");
    if name.is_empty() || name.len() > 255 || name.contains(|c: char| c.is_control()) {
        return Err(AttachmentError::BadName);
    }
    if name.contains(':') || name.starts_with(['/', '~']) {
        return Err(AttachmentError::OutsideFolder);
    }
    let mut path = PathBuf::new();
    for component in Path::new(&name).components() {
        match component {
            Component::Normal(part) => path.push(part),
            Component::CurDir => {}
            _ => return Err(AttachmentError::OutsideFolder),
        }
    }
    if path.as_os_str().is_empty() { Err(AttachmentError::BadName) } else { Ok(path) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_files_beneath_the_folder_are_read() {
        let outside = tempfile::tempdir().unwrap();
        fs::write(outside.path().join("key.txt"), "secret").unwrap();
        let folder = outside.path().join("class");
        fs::create_dir_all(folder.join("figures")).unwrap();
        fs::write(folder.join("a.csv"), "t,y").unwrap();
        fs::write(folder.join("figures/b.png"), "png").unwrap();
        fs::write(folder.join("large.bin"), vec![0; MAX_ATTACHMENT_BYTES + 1]).unwrap();
        fs::write(folder.join("limit.bin"), vec![0; MAX_ATTACHMENT_BYTES]).unwrap();
        #[cfg(unix)]
        std::os::unix::fs::symlink(outside.path().join("key.txt"), folder.join("link.txt")).unwrap();
        let absolute = outside.path().join("key.txt").display().to_string();

        let files = Folder(folder);
        let read = |name: &str| files.read(name).map(|bytes| bytes.len());
        let limit = MAX_ATTACHMENT_BYTES;
        for (name, expected) in [
            ("a.csv", Ok(3)),
            (" a.csv ", Ok(3)),
            ("./a.csv", Ok(3)),
            ("figures/b.png", Ok(3)),
            ("figures\\b.png", Ok(3)),
            ("limit.bin", Ok(limit)),
            ("large.bin", Err(AttachmentError::TooLarge { limit })),
            ("none.csv", Err(AttachmentError::NotFound)),
            ("figures", Err(AttachmentError::NotAFile)),
            ("../key.txt", Err(AttachmentError::OutsideFolder)),
            ("figures/../../key.txt", Err(AttachmentError::OutsideFolder)),
            ("..\\key.txt", Err(AttachmentError::OutsideFolder)),
            ("C:\\key.txt", Err(AttachmentError::OutsideFolder)),
            ("~/key.txt", Err(AttachmentError::OutsideFolder)),
            (&absolute, Err(AttachmentError::OutsideFolder)),
            ("", Err(AttachmentError::BadName)),
            (".", Err(AttachmentError::BadName)),
            ("a\u{1b}.csv", Err(AttachmentError::BadName)),
            ("a\0.csv", Err(AttachmentError::BadName)),
            #[cfg(unix)]
            ("link.txt", Err(AttachmentError::OutsideFolder)),
        ] {
            assert_eq!(read(name), expected, "{name:?}");
        }
        assert_eq!(Folder(PathBuf::from("/no/such/folder")).read("a"), Err(AttachmentError::NotFound));
        assert_eq!(NoFiles.read("a.csv"), Err(AttachmentError::NotFound));
    }
}
