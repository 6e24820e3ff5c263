use super::has_ending;
use serde::{Deserialize, Serialize};

/// A file that is not marked: nothing that was handed in is passed over without a word.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Aside {
    /// As [`AnswerFile::name`](super::AnswerFile::name).
    pub name: String,
    pub why: WhyAside,
}

#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum WhyAside {
    /// A document that holds no answers polemark can read.
    WrongType,
    /// Typed into a text box of the LMS.
    OnlineText,
    /// An archive in a folder or in another archive.
    Archive,
}

impl WhyAside {
    /// In words, after the file's name.
    pub fn words(&self) -> &'static str {
        match self {
            Self::WrongType => "is no answer file (.yaml)",
            Self::OnlineText => "was typed into a text box, not handed in as a file",
            Self::Archive => "is an archive within what was handed in, and is not opened",
        }
    }

    /// Why a file that is no answer file is worth a word; `None` for figures, data and whatever else answers may name.
    pub(super) fn of(name: &str, is_online_text: bool) -> Option<Self> {
        if is_online_text {
            return Some(Self::OnlineText);
        }
        if has_ending(name, &[".zip", ".7z", ".rar", ".tar", ".gz", ".tgz", ".bz2", ".xz"]) {
            return Some(Self::Archive);
        }
        has_ending(name, DOCUMENTS).then_some(Self::WrongType)
    }
}

/// Where a report might be.
const DOCUMENTS: &[&str] = &[
    ".pdf", ".doc", ".docx", ".odt", ".rtf", ".pages", ".ppt", ".pptx", ".xls", ".xlsx", ".ods", ".ipynb",
    ".mlx", ".tex", ".html", ".htm", ".heic", ".json",
];
