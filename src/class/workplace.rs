use super::run::ClassError;
use std::fs::{self, File, TryLockError};
use std::io;
use std::path::{Path, PathBuf};

/// The hidden folder of the output folder where a run keeps what is not finished yet, and what the next run may use again.
///
/// `.polemark/running/` is there while a run is under way, and after one that was stopped; `.polemark/kept.jsonl` after one
/// that finished. Only one run at a time works in an output folder.
pub struct Workplace {
    folder: PathBuf,
    /// Held while this lives; the system lets go of it when the process ends, however it ends.
    _lock: File,
}

/// What the next run may use again, relative to `.polemark`.
pub const KEPT: &str = "kept.jsonl";

impl Workplace {
    /// Sets up in `out`, which is made when it is not there. What a stopped run left is put aside as `stopped/`.
    pub fn open(out: &Path) -> Result<Self, ClassError> {
        let folder = out.join(".polemark");
        let written = |path: &Path, error| ClassError::Write { path: path.to_path_buf(), error };
        fs::create_dir_all(&folder).map_err(|error| written(&folder, error))?;
        let lock_path = folder.join("lock");
        let lock = File::create(&lock_path).map_err(|error| written(&lock_path, error))?;
        match lock.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => return Err(ClassError::Busy { out: out.to_path_buf() }),
            Err(TryLockError::Error(error)) if error.kind() == io::ErrorKind::Unsupported => {}
            Err(TryLockError::Error(error)) => return Err(written(&lock_path, error)),
        }
        let workplace = Self { folder, _lock: lock };
        let (running, stopped) = (workplace.running(), workplace.stopped());
        if running.exists() {
            // Of two stopped runs the one that came further is of more use.
            if size(&running.join(KEPT)) >= size(&stopped.join(KEPT)) {
                remove_folder(&stopped).map_err(|error| written(&stopped, error))?;
                fs::rename(&running, &stopped).map_err(|error| written(&stopped, error))?;
            } else {
                remove_folder(&running).map_err(|error| written(&running, error))?;
            }
        }
        fs::create_dir(&running).map_err(|error| written(&running, error))?;
        Ok(workplace)
    }

    /// Where files grow until they are whole.
    pub fn running(&self) -> PathBuf {
        self.folder.join("running")
    }

    /// What a run that was stopped had done.
    pub fn stopped(&self) -> PathBuf {
        self.folder.join("stopped")
    }

    /// What the last run that finished had done.
    pub fn kept(&self) -> PathBuf {
        self.folder.join(KEPT)
    }

    /// Puts `running/name` in its place, whole.
    pub fn publish(&self, name: &str, place: &Path) -> Result<(), ClassError> {
        fs::rename(self.running().join(name), place)
            .map_err(|error| ClassError::Write { path: place.to_path_buf(), error })
    }

    /// The run is finished: nothing of it or of a stopped one is left over.
    pub fn finish(self) -> Result<(), ClassError> {
        for folder in [self.running(), self.stopped()] {
            remove_folder(&folder).map_err(|error| ClassError::Write { path: folder, error })?;
        }
        Ok(())
    }
}

/// Whether the last run in `out` was stopped before its end: reports may be newer than gradebook and class page.
pub fn is_unfinished(out: &Path) -> bool {
    out.join(".polemark/running").exists() || out.join(".polemark/stopped").exists()
}

fn size(path: &Path) -> u64 {
    fs::metadata(path).map_or(0, |metadata| metadata.len())
}

fn remove_folder(folder: &Path) -> io::Result<()> {
    match fs::remove_dir_all(folder) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => Err(error),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_run_at_a_time_and_the_further_of_two_stopped_ones_is_kept() {
        let out = tempfile::tempdir().unwrap();
        let first = Workplace::open(out.path()).unwrap();
        assert!(matches!(Workplace::open(out.path()), Err(ClassError::Busy { .. })));
        fs::write(first.running().join(KEPT), "far along\n").unwrap();
        drop(first);
        assert!(is_unfinished(out.path()));

        let second = Workplace::open(out.path()).unwrap();
        assert_eq!(fs::read(second.stopped().join(KEPT)).unwrap(), b"far along\n");
        fs::write(second.running().join(KEPT), "less\n").unwrap();
        drop(second);

        let third = Workplace::open(out.path()).unwrap();
        assert_eq!(fs::read(third.stopped().join(KEPT)).unwrap(), b"far along\n");
        assert_eq!(fs::read_dir(third.running()).unwrap().count(), 0);
        third.finish().unwrap();
        assert!(!is_unfinished(out.path()));
    }
}
