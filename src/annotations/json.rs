use super::{Annotations, Case};
use serde::Serialize;

/// One JSON document: `{"verb", "files": [{"file", "cases": [{"name", "code", "severity", "message", "help", "line", …}]}]}`.
///
/// `severity` is `error`, `warning`, `note`, or null where all is well.
///
/// Errors: none in practice; text and numbers can always be written.
pub fn json(annotations: &Annotations) -> Result<String, serde_json::Error> {
    let files = annotations
        .files
        .iter()
        .map(|file| FileView { file: &file.file, cases: file.cases.iter().map(CaseView::of).collect() });
    let document = Document { verb: annotations.verb, files: files.collect() };
    Ok(serde_json::to_string_pretty(&document)? + "\n")
}

#[derive(Serialize)]
struct Document<'a> {
    verb: &'a str,
    files: Vec<FileView<'a>>,
}

#[derive(Serialize)]
struct FileView<'a> {
    file: &'a str,
    cases: Vec<CaseView<'a>>,
}

#[derive(Serialize)]
struct CaseView<'a> {
    name: &'a str,
    code: &'a str,
    severity: Option<&'static str>,
    message: &'a str,
    help: Option<&'a str>,
    line: Option<usize>,
    column: Option<usize>,
    end_line: Option<usize>,
    end_column: Option<usize>,
}

impl<'a> CaseView<'a> {
    fn of(case: &'a Case) -> Self {
        Self {
            name: &case.name,
            code: &case.code,
            severity: case.severity.map(|severity| severity.word()),
            message: &case.message,
            help: case.help.as_deref(),
            line: case.place.map(|place| place.line),
            column: case.place.map(|place| place.column),
            end_line: case.place.map(|place| place.end_line),
            end_column: case.place.map(|place| place.end_column),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::hostile;
    use super::*;

    #[test]
    fn it_reads_back() {
        let read: serde_json::Value = serde_json::from_str(&json(&hostile()).unwrap()).unwrap();
        let case = &read["files"][0]["cases"][1];
        assert_eq!(
            (&case["severity"], &case["line"], &case["column"]),
            (&"warning".into(), &2.into(), &4.into())
        );
        assert!(read["files"][0]["cases"][0]["severity"].is_null());
    }
}
