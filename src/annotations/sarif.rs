use super::{Annotations, Case, Place, with_slashes};
use crate::source::Severity;
use serde::Serialize;
use std::collections::BTreeSet;

/// Results that GitHub takes of one run; it shows the first 5,000 of them.
///
/// Source: <https://docs.github.com/code-security/code-scanning/integrating-with-code-scanning/sarif-support-for-code-scanning>
const MOST: usize = 25_000;

/// A SARIF 2.1.0 log: a result for each finding, the worst first, none for what is well.
///
/// More than 25,000 results are not written; a notification in the log says how many were left out.
///
/// Source: OASIS, Static Analysis Results Interchange Format 2.1.0, sections 3.27 (result), 3.29 and 3.30 (places).
///
/// Errors: none in practice; text and numbers can always be written.
pub fn sarif(annotations: &Annotations) -> Result<String, serde_json::Error> {
    let mut all: Vec<(Severity, &str, &Case)> = annotations
        .files
        .iter()
        .flat_map(|file| file.cases.iter().map(|case| (file.file.as_str(), case)))
        .filter_map(|(file, case)| Some((case.severity?, file, case)))
        .collect();
    all.sort_by_key(|(severity, _, _)| *severity);
    let left_out = all.len().saturating_sub(MOST);
    all.truncate(MOST);
    let rules: BTreeSet<&str> = all.iter().map(|(_, _, case)| case.code.as_str()).collect();
    let notification = (left_out > 0).then(|| Notification {
        level: "warning",
        message: Message { text: format!("{left_out} more results were left out") },
    });
    let log = Log {
        schema: "https://json.schemastore.org/sarif-2.1.0.json",
        version: "2.1.0",
        runs: [Run {
            tool: Tool {
                driver: Driver {
                    name: "polemark",
                    semantic_version: env!("CARGO_PKG_VERSION"),
                    rules: rules.into_iter().map(|id| Rule { id }).collect(),
                },
            },
            column_kind: "unicodeCodePoints",
            invocations: [Invocation {
                execution_successful: true,
                tool_execution_notifications: notification.into_iter().collect(),
            }],
            results: all.iter().map(|(severity, file, case)| result(*severity, file, case)).collect(),
        }],
    };
    Ok(serde_json::to_string_pretty(&log)? + "\n")
}

fn result<'a>(severity: Severity, file: &str, case: &'a Case) -> ResultView<'a> {
    ResultView {
        rule_id: &case.code,
        level: severity.word(),
        message: Message { text: format!("{}: {}", case.name, case.told()) },
        locations: [Location {
            physical_location: PhysicalLocation {
                artifact_location: Artifact { uri: uri(&with_slashes(file)) },
                region: case.place.map(Region::of),
            },
        }],
    }
}

/// A relative reference: everything is percent-encoded that may not stand in the path of a URI (RFC 3986, 3.3). A colon would
/// make what is before it a scheme.
fn uri(path: &str) -> String {
    let mut uri = String::new();
    for byte in path.bytes() {
        let plain = byte.is_ascii_alphanumeric() || b"-._~/!$&'()*+,;=@".contains(&byte);
        if plain { uri.push(char::from(byte)) } else { uri.push_str(&format!("%{byte:02X}")) }
    }
    uri
}

#[derive(Serialize)]
struct Log<'a> {
    #[serde(rename = "$schema")]
    schema: &'static str,
    version: &'static str,
    runs: [Run<'a>; 1],
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Run<'a> {
    tool: Tool<'a>,
    column_kind: &'static str,
    invocations: [Invocation; 1],
    results: Vec<ResultView<'a>>,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Invocation {
    execution_successful: bool,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    tool_execution_notifications: Vec<Notification>,
}

#[derive(Serialize)]
struct Notification {
    level: &'static str,
    message: Message,
}

#[derive(Serialize)]
struct Tool<'a> {
    driver: Driver<'a>,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Driver<'a> {
    name: &'static str,
    semantic_version: &'static str,
    rules: Vec<Rule<'a>>,
}

#[derive(Serialize)]
struct Rule<'a> {
    id: &'a str,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct ResultView<'a> {
    rule_id: &'a str,
    level: &'static str,
    message: Message,
    locations: [Location; 1],
}

#[derive(Serialize)]
struct Message {
    text: String,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Location {
    physical_location: PhysicalLocation,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct PhysicalLocation {
    artifact_location: Artifact,
    #[serde(skip_serializing_if = "Option::is_none")]
    region: Option<Region>,
}

#[derive(Serialize)]
struct Artifact {
    uri: String,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Region {
    start_line: usize,
    start_column: usize,
    end_line: usize,
    end_column: usize,
}

impl Region {
    fn of(place: Place) -> Self {
        Self {
            start_line: place.line,
            start_column: place.column,
            end_line: place.end_line,
            end_column: place.end_column,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::hostile;
    use super::*;

    #[test]
    fn a_result_says_where_and_is_encoded() {
        let log: serde_json::Value = serde_json::from_str(&sarif(&hostile()).unwrap()).unwrap();
        let run = &log["runs"][0];
        assert_eq!(run["results"].as_array().unwrap().len(), 1);
        let result = &run["results"][0];
        assert_eq!((&result["ruleId"], &result["level"]), (&"poles.unreadable".into(), &"warning".into()));
        let place = &result["locations"][0]["physicalLocation"];
        assert_eq!(place["artifactLocation"]["uri"], "a%20b/%C3%BC,%3A%25.yaml");
        assert_eq!((&place["region"]["startLine"], &place["region"]["endColumn"]), (&2.into(), &7.into()));
        assert_eq!(run["tool"]["driver"]["rules"][0]["id"], "poles.unreadable");
    }

    #[test]
    fn what_github_refuses_is_left_out_and_said() {
        let mut many = hostile();
        let case = many.files[0].cases[1].clone();
        many.files[0].cases = vec![case; MOST + 2];
        let log: serde_json::Value = serde_json::from_str(&sarif(&many).unwrap()).unwrap();
        let run = &log["runs"][0];
        assert_eq!(run["results"].as_array().unwrap().len(), MOST);
        let said = &run["invocations"][0]["toolExecutionNotifications"][0]["message"]["text"];
        assert_eq!(said, "2 more results were left out");
    }
}
