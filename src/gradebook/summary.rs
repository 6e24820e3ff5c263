use super::Why;

/// A file for an LMS, and what is not in it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Export {
    pub bytes: Vec<u8>,
    pub summary: Summary,
}

/// What an export passed on and what it did not. Names are as they were found: hostile until escaped.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Summary {
    /// Marks, or reports.
    pub given: usize,
    pub left_out: Vec<LeftOut>,
    /// Students for whom nothing but the full name agrees with the row of the LMS.
    pub by_name_alone: Vec<String>,
    /// In the file of the LMS, and nobody of the class.
    pub not_in_class: Vec<String>,
    /// What else to know before it is uploaded.
    pub notes: Vec<String>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LeftOut {
    pub who: String,
    pub why: Why,
}

impl Summary {
    pub fn leave_out(&mut self, who: impl Into<String>, why: Why) {
        self.left_out.push(LeftOut { who: who.into(), why });
    }
}
