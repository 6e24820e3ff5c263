use super::run::ClassError;
use std::fs::File;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// A file that takes its name only when it is whole.
pub struct NewFile {
    pub path: PathBuf,
    pub file: tempfile::NamedTempFile,
}

impl NewFile {
    /// Grows in `folder`, which is of the same file system, and is to become `path`.
    pub fn create(path: PathBuf, folder: &Path) -> Result<Self, ClassError> {
        let mut builder = tempfile::Builder::new();
        builder.prefix("new-");
        // Others may read it, as with any file one writes.
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o644));
        // Without the name of what is only there for a while.
        let plain = |error: io::Error| error.raw_os_error().map_or(error, io::Error::from_raw_os_error);
        let file = builder
            .tempfile_in(folder)
            .map_err(|error| ClassError::Write { path: path.clone(), error: plain(error) })?;
        Ok(Self { path, file })
    }

    /// The same file, for somebody who writes into it bit by bit.
    pub fn again(&self) -> Result<File, ClassError> {
        let again = self.file.as_file().try_clone();
        again.map_err(|error| ClassError::Write { path: self.path.clone(), error })
    }

    pub fn write_all(mut self, bytes: &[u8]) -> Result<(), ClassError> {
        self.file
            .as_file_mut()
            .write_all(bytes)
            .map_err(|error| ClassError::Write { path: self.path.clone(), error })?;
        self.finish()
    }

    /// [`Self::finish`] where no file has the name yet; an error of the kind `AlreadyExists` where one has.
    pub fn finish_new(self) -> Result<(), ClassError> {
        let Self { path, file } = self;
        match file.persist_noclobber(&path) {
            Ok(_) => Ok(()),
            Err(failed) => Err(ClassError::Write { path, error: failed.error }),
        }
    }

    pub fn finish(self) -> Result<(), ClassError> {
        let Self { path, file } = self;
        match file.persist(&path) {
            Ok(_) => Ok(()),
            Err(failed) => Err(ClassError::Write { path, error: failed.error }),
        }
    }
}
