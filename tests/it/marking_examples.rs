//! The examples of `docs/marking.md` are true.
//!
//! An example is a table below a comment, or a block of YAML.
//!
//! ```text
//! <!-- example: hanging.response.poles -->        a field, a criterion or a question with one field
//! | written | points | code |
//! |---|---|---|
//! | `[-0.143, 0.0195 ± 5.59j]` | none | `poles.mirrored`: a real part has the wrong sign |
//! ```
//!
//! The column `written`, or the first, is the answer; several answers in backticks are as many examples. `points` is `all`, `three quarters`, `half`, `none` or a number, with `, provisional` when
//! a person has to confirm it. Of `code`, the code in backticks counts. A column `structure` holds the points of the
//! criterion of that name in the question; then every code of these that is not `right` stands in the row. `says`, where
//! there is one, is a part of what the student reads. `<!-- example: 0 = FIELD; 1.5 = FIELD -->` goes by the column `expected`.
//! `<!-- example of an explanation: FIELD -->` has the columns `explained by`, of which what stands in backticks is said,
//! and `code`: that of the first explanation, then those of others that are told; empty when there is none.
//!
//! ````text
//! ```yaml example
//! hanging.response:
//!   poles: [0.143, 0.0195 ± 5.59j]
//! marks:
//!   hanging.response.poles: none, poles.mirrored, "wrong sign", explained by term.sign
//! ```
//! ````
//!
//! What stands before `marks:` is what an answer file has below `answers:`; files are those of `submissions/`. What is in
//! double quotes is a part of what the student reads beside the mark. A first line `students: ME-001, ME-002` says whose it is.
//!
//! The embedded lab is asked, or `small.yaml`, `oscillator.yaml`, `tangent.yaml`, `letters.yaml`, `rest.yaml` or `variants.yaml` when the ids
//! are its own.

use crate::bench::Bench;
use polemark::grading::ItemScore;
use polemark::lab::Points;
use std::collections::BTreeSet;

const MANUAL: &str = include_str!("../../docs/marking.md");

/// Sections that state no rule of marking by polemark.
const WITHOUT_EXAMPLE: &[(&str, &str)] =
    &[("What a person gives", "marks files have tests of their own"), ("All codes", "a list")];

/// Codes no example can show.
const WITHOUT_EXAMPLE_CODE: &[(&str, &str)] = &[
    ("unmarked", "of what polemark itself fails on"),
    ("by_hand", "from the marks file"),
    ("factor.slope", "of the tanks on the shelf: src/grading/follow_through_tests.rs"),
    ("inconclusive", "of a lab that rests on rounded coefficients at such a line"),
];

/// What an example says of one criterion.
#[derive(Debug, Default)]
struct Want {
    item: String,
    points: Option<String>,
    codes: Vec<String>,
    says: Vec<String>,
    /// The code of the first explanation, then codes of others; empty when there is none.
    explained: Option<Vec<String>>,
}

#[derive(Debug)]
struct Example {
    line: usize,
    students: Vec<String>,
    /// As below `answers:`.
    answers: String,
    wants: Vec<Want>,
    /// Codes that some of the criteria must have, and no other but `right`.
    codes_of_all: Option<BTreeSet<String>>,
}

struct Manual<'a> {
    benches: &'a [&'a Bench],
    /// Heading and the number of its examples.
    sections: Vec<(String, usize)>,
    examples: Vec<Example>,
}

fn is_code(text: &str) -> bool {
    let letters = |part: &str| !part.is_empty() && part.bytes().all(|b| b.is_ascii_lowercase() || b == b'_');
    let one = |text: &str| text.split('.').all(letters) && text.split('.').count() <= 2;
    text.split('+').all(one)
}

/// What stands between backticks.
fn quoted(text: &str, mark: char) -> Vec<String> {
    text.split(mark).skip(1).step_by(2).map(str::to_owned).collect()
}

fn cells(line: &str) -> Vec<String> {
    let body = line.trim().trim_start_matches('|').trim_end_matches('|').replace("\\|", "\u{1}");
    body.split('|').map(|cell| cell.trim().replace('\u{1}', "|")).collect()
}

/// Each answer of a cell: all it says, or each of several in backticks.
fn answers_of(cell: &str) -> Vec<String> {
    let several = cell.split(", ").filter(|one| one.len() > 2 && one.starts_with('`') && one.ends_with('`'));
    let several: Vec<String> = several.map(str::to_owned).collect();
    if several.join(", ") == cell { several } else { vec![cell.to_owned()] }
}

/// An answer as YAML: a list or a map as it stands, anything else as text.
fn as_yaml(cell: &str) -> String {
    let bare = cell.strip_prefix('`').and_then(|rest| rest.strip_suffix('`')).unwrap_or(cell);
    if bare.starts_with(['[', '{']) || bare.is_empty() {
        return bare.to_owned();
    }
    format!("\"{}\"", bare.replace('\\', "\\\\").replace('"', "\\\""))
}

impl<'a> Manual<'a> {
    fn read(benches: &'a [&'a Bench]) -> Self {
        let mut manual = Self { benches, sections: Vec::new(), examples: Vec::new() };
        let mut lines = MANUAL.lines().enumerate().peekable();
        while let Some((index, line)) = lines.next() {
            let comment = |name: &str| {
                line.strip_prefix(name)
                    .and_then(|rest| rest.strip_suffix("-->"))
                    .map(|target| target.trim().to_owned())
            };
            if let Some(heading) = line.strip_prefix("## ").or_else(|| line.strip_prefix("### ")) {
                manual.sections.push((heading.to_owned(), 0));
            } else if line == "```yaml example" {
                let block: Vec<&str> =
                    lines.by_ref().map(|(_, line)| line).take_while(|line| *line != "```").collect();
                manual.block(index + 1, &block);
            } else if line.starts_with("```") {
                while lines.next().is_some_and(|(_, line)| !line.starts_with("```")) {}
            } else if line.starts_with("<!--") {
                let (target, explanations) =
                    match (comment("<!-- example:"), comment("<!-- example of an explanation:")) {
                        (Some(target), _) => (target, false),
                        (_, Some(target)) => (target, true),
                        _ => panic!("marking.md:{}: not a comment of an example: {line}", index + 1),
                    };
                let mut table = Vec::new();
                while let Some((index, line)) = lines.next_if(|(_, line)| line.starts_with('|')) {
                    table.push((index + 1, cells(line)));
                }
                assert!(table.len() > 2, "marking.md:{}: no table follows the comment", index + 1);
                manual.table(&target, explanations, &table);
            }
        }
        manual
    }

    fn push(&mut self, example: Example) {
        if let Some((_, count)) = self.sections.last_mut() {
            *count += 1;
        }
        self.examples.push(example);
    }

    fn block(&mut self, line: usize, block: &[&str]) {
        let at = block.iter().position(|line| *line == "marks:");
        let at = at.unwrap_or_else(|| panic!("marking.md:{line}: the example has no `marks:`"));
        let (students, answers) = match block[..at].split_first() {
            Some((first, rest)) if first.starts_with("students: ") => {
                (first.trim_start_matches("students: "), rest)
            }
            _ => ("", &block[..at]),
        };
        let students = students.split(", ").filter(|id| !id.is_empty()).map(str::to_owned).collect();
        let answers: String = answers.iter().map(|line| format!("  {line}\n")).collect();
        let wants: Vec<Want> = block[at + 1..]
            .iter()
            .map(|row| {
                let (item, rest) = row
                    .trim()
                    .split_once(": ")
                    .unwrap_or_else(|| panic!("marking.md:{line}: `{row}` is no mark"));
                let mut want = Want { item: item.to_owned(), says: quoted(rest, '"'), ..Want::default() };
                let plain: String = rest.split('"').step_by(2).collect();
                let mut parts = plain.split(',').map(str::trim).filter(|part| !part.is_empty());
                let points = parts.next().unwrap_or_default().to_owned();
                want.points = Some(points);
                for part in parts {
                    match part.strip_prefix("explained by ") {
                        Some(code) => want.explained = Some(vec![code.to_owned()]),
                        None if part == "provisional" => {
                            want.points = want.points.map(|points| points + ", provisional")
                        }
                        None => want.codes.push(part.to_owned()),
                    }
                }
                want
            })
            .collect();
        assert!(!wants.is_empty(), "marking.md:{line}: the example has no marks");
        self.push(Example { line, students, answers, wants, codes_of_all: None });
    }

    fn table(&mut self, target: &str, explanations: bool, table: &[(usize, Vec<String>)]) {
        let header = &table[0].1;
        let place = |name: &str| header.iter().position(|cell| cell == name);
        let rows = table[2..].iter().flat_map(|(line, row)| {
            let cell = place("written").unwrap_or_default();
            answers_of(&row[cell]).into_iter().map(move |answer| (line, row, answer))
        });
        for (line, row, answer) in rows {
            let cell = |name: &str| place(name).and_then(|place| row.get(place)).map(String::as_str);
            let target = match cell("expected") {
                Some(expected) if target.contains('=') => target
                    .split("; ")
                    .filter_map(|one| one.split_once(" = "))
                    .find(|(name, _)| *name == expected)
                    .map_or_else(
                        || panic!("marking.md:{line}: `{expected}` is of no field"),
                        |(_, target)| target,
                    ),
                _ => target,
            };
            let criteria: Vec<_> = self.benches.iter().flat_map(|bench| bench.criteria(target)).collect();
            let first = criteria.first().unwrap_or_else(|| panic!("marking.md:{line}: no field `{target}`"));
            let answers = format!("  {}: {}\n", first.field, as_yaml(&answer));
            let codes: Vec<String> =
                cell("code").or(cell("because")).map(|cell| quoted(cell, '`')).unwrap_or_default();
            let codes: Vec<String> = codes.into_iter().filter(|code| is_code(code)).collect();
            if explanations {
                let want = Want {
                    item: target.to_owned(),
                    explained: Some(codes),
                    says: cell("explained by").map(|cell| quoted(cell, '`')).unwrap_or_default(),
                    ..Want::default()
                };
                self.push(Example {
                    line: *line,
                    students: Vec::new(),
                    answers,
                    wants: vec![want],
                    codes_of_all: None,
                });
                continue;
            }
            let says: Vec<String> = cell("says").into_iter().map(str::to_owned).collect();
            let parts: Vec<(String, String)> = criteria
                .iter()
                .filter_map(|criterion| {
                    let name = criterion.id.rsplit('.').next()?;
                    cell(name).map(|points| (criterion.id.clone(), points.to_owned()))
                })
                .collect();
            let example = if parts.is_empty() {
                assert_eq!(criteria.len(), 1, "marking.md:{line}: `{target}` is judged by several criteria");
                let points =
                    cell("points").unwrap_or_else(|| panic!("marking.md:{line}: no column `points`"));
                let codes = codes.into_iter().take(1).collect();
                let want = Want {
                    item: first.id.clone(),
                    points: Some(points.to_owned()),
                    codes,
                    says,
                    explained: None,
                };
                Example { line: *line, students: Vec::new(), answers, wants: vec![want], codes_of_all: None }
            } else {
                let wants = parts
                    .into_iter()
                    .map(|(item, points)| Want { item, points: Some(points), ..Want::default() })
                    .collect();
                Example {
                    line: *line,
                    students: Vec::new(),
                    answers,
                    wants,
                    codes_of_all: Some(codes.into_iter().collect()),
                }
            };
            self.push(example);
        }
    }
}

/// `half, provisional` of what is possible, and whether a person has to confirm it.
fn points(text: &str, possible: Points) -> Option<(Points, bool)> {
    let (part, provisional) = match text.split_once(", provisional") {
        Some((part, "")) => (part, true),
        Some(_) => return None,
        None => (text, false),
    };
    let hundredths = match part {
        "all" | "right" => possible.0,
        "three quarters" => (possible.0 * 3 + 2) / 4,
        "half" => (possible.0 + 1) / 2,
        "none" | "wrong" => 0,
        number => (number.parse::<f64>().ok()? * 100.0).round() as i64,
    };
    Some((Points(hundredths), provisional))
}

/// What the student reads beside a mark.
fn read_beside(item: &ItemScore) -> String {
    let evidence = &item.evidence;
    let mut text = format!("{}\n{}\n{}\n", evidence.expected, evidence.found, evidence.reason);
    for conflict in &evidence.conflicts {
        text += &format!("{}\n{}\n", conflict.claim, conflict.against);
    }
    text
}

/// How the marks differ from what the example says; the codes that were met.
fn differences(bench: &Bench, example: &Example, met: &mut BTreeSet<String>) -> Vec<String> {
    let items = bench.mark_of(&example.students, &example.answers);
    let mut wrong = Vec::new();
    let mut codes = BTreeSet::new();
    for want in &example.wants {
        if let Some(explained) = &want.explained {
            let diagnosis = items
                .iter()
                .filter(|item| item.id.starts_with(want.item.as_str()))
                .find_map(|item| item.diagnosis.as_ref());
            let told = diagnosis.map_or(&[][..], |diagnosis| &diagnosis.explanations);
            let first = told.first();
            let codes: Vec<&str> = told.iter().map(|one| one.code.as_str()).collect();
            let meets = codes.first().copied() == explained.first().map(String::as_str)
                && explained.iter().all(|code| codes.contains(&code.as_str()));
            met.extend(explained.iter().flat_map(|code| code.split('+')).map(str::to_owned));
            if !meets {
                wrong.push(format!("`{}` is explained by {codes:?}, not {explained:?}", want.item));
            }
            if want.points.is_none() {
                let words = first.map_or("", |first| first.words.as_str());
                let unsaid = want.says.iter().filter(|said| !words.contains(said.as_str()));
                wrong.extend(unsaid.map(|said| format!("not said: `{said}` in `{words}`")));
                continue;
            }
        }
        let Some(item) = items.iter().find(|item| item.id == want.item) else {
            wrong.push(format!("there is no criterion `{}`", want.item));
            continue;
        };
        met.insert(item.code.to_owned());
        codes.insert(item.code.to_owned());
        let text = want.points.as_deref().unwrap_or_default();
        let judged = |(points, provisional): (Points, bool)| {
            item.earned == points && (item.provisional == provisional || item.code.starts_with("concepts."))
        };
        if !points(text, item.possible).is_some_and(judged) {
            let provisional = if item.provisional { ", provisional" } else { "" };
            let (id, earned, possible) = (&item.id, item.earned, item.possible);
            wrong.push(format!("`{id}` earns {earned}{provisional} of {possible}, not {text}"));
        }
        if !want.codes.is_empty() && want.codes != [item.code] {
            wrong.push(format!("`{}` has the code `{}`, not {:?}", item.id, item.code, want.codes));
        }
        let beside = read_beside(item);
        let unsaid = want.says.iter().filter(|said| !beside.contains(said.as_str()));
        wrong.extend(unsaid.map(|said| format!("`{}` does not say `{said}` but\n{beside}", item.id)));
    }
    if let Some(stated) = &example.codes_of_all {
        codes.remove("right");
        if codes != *stated {
            wrong.push(format!("its codes are {codes:?}, not {stated:?}"));
        }
    }
    if !wrong.is_empty() {
        for want in &example.wants {
            let item = items.iter().find(|item| item.id == want.item);
            wrong.extend(item.map(|item| format!("{}: {}", item.id, item.evidence.reason)));
        }
    }
    wrong
}

#[test]
fn the_examples_are_true_and_show_every_rule() {
    let benches = [
        Bench::embedded(),
        Bench::small(),
        Bench::oscillator(),
        Bench::tangents(),
        Bench::letters(),
        Bench::variants(),
        Bench::rest(),
    ];
    let manual = Manual::read(&benches);
    let mut met = BTreeSet::new();
    let mut report = Vec::new();
    for example in &manual.examples {
        let item = &example.wants[0].item;
        let bench = benches.iter().find(|bench| !bench.criteria(item).is_empty());
        let bench = bench.unwrap_or_else(|| panic!("marking.md:{}: no criterion `{item}`", example.line));
        for wrong in differences(bench, example, &mut met) {
            report.push(format!("marking.md:{}: {wrong}", example.line));
        }
    }
    let (_, listed) = MANUAL.split_once("## All codes\n").expect("the list of codes");
    let listed: Vec<String> = quoted(listed, '`').into_iter().filter(|code| is_code(code)).collect();
    for code in &listed {
        let exempt = WITHOUT_EXAMPLE_CODE.iter().any(|(exempt, _)| exempt == code);
        match (met.contains(code), exempt) {
            (false, false) => report.push(format!("no example shows the code `{code}`")),
            (true, true) => report.push(format!("`{code}` is shown and need not be exempt")),
            _ => {}
        }
    }
    let unlisted = met.iter().filter(|code| !code.is_empty() && !listed.contains(code));
    report.extend(unlisted.map(|code| format!("`{code}` is not in the list of all codes")));
    for (heading, examples) in &manual.sections {
        let exempt = WITHOUT_EXAMPLE.iter().any(|(exempt, _)| exempt == heading);
        if (*examples == 0) != exempt {
            report.push(format!("section `{heading}` has {examples} examples"));
        }
    }
    assert!(report.is_empty(), "{} differences\n{}", report.len(), report.join("\n"));
}
