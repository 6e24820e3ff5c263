//! What has changed between two runs, as a page.

use super::ReportError;
use super::kit::{environment, render};
use crate::source::sanitize;
use serde::Serialize;

/// Rows that a page shows; the table beside it has them all.
const MOST_ROWS: usize = 5000;

#[derive(Serialize)]
struct ComparePage<'a> {
    page_title: &'a str,
    lab_title: &'a str,
    words: &'a str,
    rows: Vec<Vec<String>>,
    more: usize,
}

/// A page of the differences: what is said in short, and rows of student id, name, item, old, new, change and cause.
pub fn compare_page<'r>(
    lab_title: &str,
    words: &str,
    rows: impl Iterator<Item = [String; 7]> + 'r,
) -> Result<String, ReportError> {
    let mut rows = rows.map(|cells| cells.map(|cell| sanitize(&cell)).to_vec());
    let shown: Vec<_> = rows.by_ref().take(MOST_ROWS).collect();
    let page =
        ComparePage { page_title: "What has changed", lab_title, words, rows: shown, more: rows.count() };
    Ok(render(&environment()?, "compare.html", &page))
}
