use sha2::{Digest, Sha256};
use std::fmt::Debug;
use std::fs::File;
use std::io::{self, BufRead, BufReader};
use std::path::Path;

/// Tells whether something is what it was: SHA-256 over parts, each with its length, so that parts cannot run together.
#[derive(Clone, Default)]
pub struct Fingerprint(Sha256);

impl Fingerprint {
    pub fn with(mut self, part: impl AsRef<[u8]>) -> Self {
        let bytes = part.as_ref();
        self.0.update((bytes.len() as u64).to_le_bytes());
        self.0.update(bytes);
        self
    }

    /// Everything that `Debug` shows of a value.
    pub fn with_shown(self, part: &impl Debug) -> Self {
        self.with(format!("{part:?}"))
    }

    /// The fingerprint of a file of any size.
    pub fn of_file(path: &Path) -> io::Result<String> {
        let mut file = BufReader::with_capacity(1 << 16, File::open(path)?);
        let mut all = Self::default();
        loop {
            let piece = file.fill_buf()?;
            let length = piece.len();
            if length == 0 {
                return Ok(all.hex());
            }
            all.0.update(piece);
            file.consume(length);
        }
    }

    /// 32 hexadecimal digits.
    pub fn hex(self) -> String {
        self.0.finalize().iter().take(16).map(|byte| format!("{byte:02x}")).collect()
    }
}

/// The fingerprint of one part.
pub fn fingerprint(part: impl AsRef<[u8]>) -> String {
    Fingerprint::default().with(part).hex()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_do_not_run_together() {
        let one = Fingerprint::default().with("ab").with("c").hex();
        let two = Fingerprint::default().with("a").with("bc").hex();
        assert_ne!(one, two);
        assert_eq!(one.len(), 32);
        assert_eq!(one, Fingerprint::default().with("ab").with("c").hex());
    }
}
