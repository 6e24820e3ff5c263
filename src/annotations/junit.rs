use super::{Annotations, Case, with_slashes};
use crate::source::Severity;
use quick_junit::{NonSuccessKind, Report, TestCase, TestCaseStatus, TestSuite, XmlString};

/// The report cannot be written as XML.
#[derive(Debug, thiserror::Error)]
#[error("the JUnit report cannot be written: {0}")]
pub struct JunitError(#[from] quick_junit::SerializeError);

/// A JUnit report: a suite a file, a case for each thing looked at. Errors and warnings are failures, notes are only told.
///
/// Holds no time, so that the same input gives the same bytes. Characters that XML 1.0 does not have are left out.
///
/// Source: <https://github.com/testmoapp/junitxml>, and the schema of the Jenkins xUnit plugin.
pub fn junit(annotations: &Annotations) -> Result<String, JunitError> {
    let mut report = Report::new(annotations.verb);
    for file in &annotations.files {
        let name = xml(&with_slashes(&file.file));
        let mut suite = TestSuite::new(name.clone());
        for case in &file.cases {
            let mut test = TestCase::new(xml(&case.name), status(case));
            test.set_classname(name.clone());
            if let Some(place) = case.place {
                test.extra.insert(XmlString::new("file"), name.clone());
                test.extra.insert(XmlString::new("line"), XmlString::new(place.line.to_string()));
            }
            suite.add_test_case(test);
        }
        report.add_test_suite(suite);
    }
    Ok(report.to_string()?)
}

fn status(case: &Case) -> TestCaseStatus {
    match case.severity {
        None | Some(Severity::Note) => TestCaseStatus::success(),
        Some(Severity::Error | Severity::Warning) => {
            let mut status = TestCaseStatus::non_success(NonSuccessKind::Failure);
            status.set_message(xml(&case.message)).set_type(xml(&case.code));
            let place = case.place.map(|place| format!("line {}, column {}: ", place.line, place.column));
            status.set_description(xml(&format!("{}{}", place.unwrap_or_default(), case.told())));
            status
        }
    }
}

/// quick-junit escapes, and drops control characters; these two it lets through, though XML 1.0 has no place for them.
fn xml(text: &str) -> XmlString {
    XmlString::new(text.replace(['\u{fffe}', '\u{ffff}'], ""))
}

#[cfg(test)]
mod tests {
    use super::super::tests::hostile;
    use super::*;

    #[test]
    fn everything_is_escaped() {
        let text = junit(&hostile()).unwrap();
        assert!(text.contains("tests=\"2\"") && text.contains("failures=\"1\""), "{text}");
        assert!(text.contains("type=\"poles.unreadable\""), "{text}");
        assert!(text.contains("line 2, column 4: "), "{text}");
        assert!(text.contains("&lt;b&gt; &amp;"), "{text}");
        assert!(!text.contains("<b>") && !text.contains('\u{1b}') && !text.contains('\u{fffe}'), "{text}");
        assert!(!text.contains("]]>"), "{text}");
        assert!(!text.contains("timestamp") && !text.contains("uuid"), "{text}");
    }
}
