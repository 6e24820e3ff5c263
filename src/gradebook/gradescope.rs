use super::class_marks::out_of;
use super::numbers::scaled;
use super::{ExportError, Rules};
use crate::class::{ItemRecord, Record};
use crate::lab::{Points, folded_id};
use crate::source::sanitize;
use serde::Serialize;

/// Which submission: Gradescope takes the results of one at a time.
#[derive(Clone, Debug)]
pub enum Wanted {
    /// Student id, however it is typed.
    Student(String),
    /// The answer file's name.
    File(String),
}

impl Wanted {
    fn is(&self, record: &Record) -> bool {
        match self {
            Self::Student(id) => {
                let same = |other: &str| {
                    other == id || (!folded_id(id).is_empty() && folded_id(other) == folded_id(id))
                };
                record.students.iter().any(|student| same(&student.id))
            }
            Self::File(name) => record.file == *name || record.submission == *name,
        }
    }

    fn name(&self) -> &str {
        match self {
            Self::Student(name) | Self::File(name) => name,
        }
    }
}

/// `results.json` as Gradescope reads it from an autograder: a test for each criterion and each row of the observation sheet.
///
/// - `score` on top is the mark and goes before the sum of the tests, for boxes of the cover sheet that a person fills and
///   adjustments are no tests; `output` on top says what the adjustments are for. It must be a number, and so nothing is
///   written for a mark that waits for a person, unless `rules` say so.
/// - A test has `score`, `max_score`, `name`, `number` (question and criterion), `status`, and in `output` what was found and
///   why, as text, which Gradescope escapes; control characters are taken out. A row that is not given yet has no `score`.
/// - `visibility` is `after_published`: students see nothing before the instructor publishes. Where marks are withheld from
///   students it is `hidden`: tests with their scores are never shown to them, nor what the adjustments are for.
/// - With `scale_to` the mark on top is scaled, and the tests are not.
///
/// Source: Gradescope, Autograder Specifications, Output Format (gradescope-autograders.readthedocs.io/en/latest/specs).
pub fn gradescope(
    records: impl Iterator<Item = Result<Record, ExportError>>,
    wanted: &Wanted,
    rules: &Rules,
) -> Result<Vec<u8>, ExportError> {
    let mut found: Option<Record> = None;
    let mut files = Vec::new();
    for record in records {
        let record = record?;
        if record.counts() && wanted.is(&record) {
            files.push(record.file.clone());
            found.get_or_insert(record);
        }
    }
    let who = || sanitize(wanted.name());
    let record = found.ok_or_else(|| ExportError::NoSubmission(who()))?;
    if files.len() > 1 {
        return Err(ExportError::SeveralSubmissions { who: who(), files: sanitize(&files.join(", ")) });
    }
    let not_ready = |why: String| ExportError::NotReady { who: who(), why };
    let mark = rules.mark(&record).map_err(|why| not_ready(why.to_string()))?;
    let mark = match rules.scale_to {
        Some(to) => scaled(mark, out_of(&record), to).ok_or(ExportError::NothingToScale)?,
        None => mark,
    };
    let visibility = if rules.withhold_marks { HIDDEN } else { AFTER_PUBLISHED };
    let results = Results {
        score: number(mark),
        output: if rules.withhold_marks { String::new() } else { adjustments(&record) },
        output_format: "text",
        visibility,
        stdout_visibility: "hidden",
        tests: tests(&record, visibility),
    };
    let mut bytes = serde_json::to_vec_pretty(&results)?;
    bytes.push(b'\n');
    Ok(bytes)
}

const AFTER_PUBLISHED: &str = "after_published";
const HIDDEN: &str = "hidden";

#[derive(Serialize)]
struct Results {
    score: serde_json::Number,
    #[serde(skip_serializing_if = "String::is_empty")]
    output: String,
    output_format: &'static str,
    visibility: &'static str,
    stdout_visibility: &'static str,
    tests: Vec<Test>,
}

#[derive(Serialize)]
struct Test {
    #[serde(skip_serializing_if = "Option::is_none")]
    score: Option<serde_json::Number>,
    max_score: serde_json::Number,
    status: &'static str,
    name: String,
    name_format: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    number: Option<String>,
    output: String,
    output_format: &'static str,
    visibility: &'static str,
}

/// What changed the mark beside the tests, a line each.
fn adjustments(record: &Record) -> String {
    let lines = record.adjustments.iter().map(|one| {
        let points = one.points.map_or_else(String::new, |points| format!("{points} points: "));
        format!("{points}{}", sanitize(&one.reason))
    });
    lines.collect::<Vec<_>>().join("\n")
}

fn tests(record: &Record, visibility: &'static str) -> Vec<Test> {
    let mut tests = Vec::new();
    for (question, place) in record.questions.iter().zip(1..) {
        let of_question = |item: &&ItemRecord| {
            item.id.strip_prefix(question.id.as_str()).is_some_and(|rest| rest.starts_with('.'))
        };
        for (item, number) in record.items.iter().filter(of_question).zip(1..) {
            tests.push(test(
                &item.id,
                Some(item.earned),
                item.possible,
                Some(format!("{place}.{number}")),
                // What the report withholds is not told here either.
                if record.instructor.is_some() { String::new() } else { output(item) },
            ));
        }
    }
    for row in &record.observed {
        let output = if row.earned.is_some() { "given by a person" } else { "not given yet" };
        tests.push(test(&row.id, row.earned, row.possible, None, output.to_owned()));
    }
    tests.iter_mut().for_each(|test| test.visibility = visibility);
    tests
}

fn test(name: &str, earned: Option<Points>, possible: Points, place: Option<String>, output: String) -> Test {
    Test {
        score: earned.map(number),
        max_score: number(possible),
        status: if earned == Some(possible) { "passed" } else { "failed" },
        name: sanitize(name),
        name_format: "text",
        number: place,
        output,
        output_format: "text",
        visibility: AFTER_PUBLISHED,
    }
}

fn output(item: &ItemRecord) -> String {
    let mut lines = vec![sanitize(&item.evidence.reason)];
    if !item.evidence.found.is_empty() {
        lines.push(format!("Found: {}", sanitize(&item.evidence.found)));
    }
    if item.review.is_some() {
        lines.push("A person has still to look at this.".to_owned());
    }
    lines.retain(|line| !line.is_empty());
    lines.join("\n")
}

/// A number with at most two decimals, whole where it can be.
fn number(points: Points) -> serde_json::Number {
    if points.0 % 100 == 0 {
        return (points.0 / 100).into();
    }
    serde_json::Number::from_f64(points.as_f64()).unwrap_or_else(|| 0.into())
}

#[cfg(test)]
mod tests_of_gradescope {
    use super::*;
    use crate::gradebook::tests::record;
    use serde_json::{Value, json};

    fn results(records: Vec<Record>, wanted: &Wanted, rules: Rules) -> Result<Value, String> {
        let bytes =
            gradescope(records.into_iter().map(Ok), wanted, &rules).map_err(|error| error.to_string())?;
        Ok(serde_json::from_slice(&bytes).unwrap())
    }

    #[test]
    fn a_test_for_each_criterion() {
        let mut one = record("EE-001", "Jane");
        one.items[0].evidence.found = "<b>\u{1b}[31m\"x\"".to_owned();
        let json = results(vec![one], &Wanted::Student("ee001".to_owned()), Rules::default()).unwrap();
        assert_eq!(json["score"], json!(7.5));
        assert_eq!(json["visibility"], "after_published");
        let first = &json["tests"][0];
        assert_eq!((&first["score"], &first["max_score"]), (&json!(2.5), &json!(4)));
        assert_eq!(
            (&first["name"], &first["number"], &first["status"]),
            (&json!("q.a"), &json!("1.1"), &json!("failed"))
        );
        assert_eq!(first["output"], json!("because\nFound: <b>\u{fffd}[31m\"x\""));
        assert_eq!((&first["output_format"], &first["name_format"]), (&json!("text"), &json!("text")));
        assert_eq!(
            (&json["tests"][1]["number"], &json["tests"][1]["status"]),
            (&json!("1.2"), &json!("passed"))
        );
        assert_eq!((&json["tests"][2]["name"], &json["tests"][2]["score"]), (&json!("tidy"), &json!(3)));
        let withheld = Rules { withhold_marks: true, ..Rules::default() };
        let json =
            results(vec![record("EE-001", "Jane")], &Wanted::Student("EE-001".to_owned()), withheld).unwrap();
        let tests = json["tests"].as_array().unwrap();
        assert!(json["visibility"] == "hidden" && tests.iter().all(|test| test["visibility"] == "hidden"));
        assert!(json["score"] == json!(7.5) && json.get("output").is_none());
        let no_other_keys = ["score", "output_format", "visibility", "stdout_visibility", "tests"];
        assert!(json.as_object().unwrap().keys().all(|key| no_other_keys.contains(&key.as_str())));
    }

    #[test]
    fn a_mark_that_waits_is_not_written() {
        let mut waiting = record("EE-001", "Jane");
        waiting.observed[0].earned = None;
        waiting.cover[1].earned = None;
        waiting.cover_total = None;
        let wanted = Wanted::File("EE-001.yaml".to_owned());
        let error = results(vec![waiting.clone()], &wanted, Rules::default()).unwrap_err();
        assert!(error.contains("1 box of the cover sheet is not filled in yet"), "{error}");
        let as_it_stands = Rules { as_it_stands: true, ..Rules::default() };
        let json = results(vec![waiting], &wanted, as_it_stands).unwrap();
        assert_eq!(json["score"], json!(4.5));
        assert_eq!((json["tests"][2].get("score"), &json["tests"][2]["max_score"]), (None, &json!(3)));
    }

    #[test]
    fn one_submission_is_meant() {
        let two = vec![record("EE-001", "Jane"), record("EE-001", "Jane")];
        let wanted = Wanted::Student("EE-001".to_owned());
        assert!(results(two, &wanted, Rules::default()).unwrap_err().contains("several submissions"));
        assert!(results(vec![], &wanted, Rules::default()).unwrap_err().contains("no submission"));
        let to_50 = Rules { scale_to: Some(Points(5000)), ..Rules::default() };
        assert_eq!(results(vec![record("EE-001", "")], &wanted, to_50).unwrap()["score"], json!(37.5));
    }
}
