use super::{AnswerSheet, Attachments, Submission};

/// Reads one answer file against what the sheet asks for: what could be read, and a finding for all that could not.
///
/// `id` is the file's stem, `name` the name it is shown by. Never fails: a file that cannot be read at all is a
/// [`Submission`] that says so.
pub fn read(
    id: &str,
    name: &str,
    bytes: &[u8],
    sheet: &AnswerSheet,
    attachments: &dyn Attachments,
) -> Submission {
    let _ = (id, name, bytes, sheet, attachments);
    todo!()
}
