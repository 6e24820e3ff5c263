//! Prose of the sample class that does not go with the numbers.

use polemark::grading::{self, Catalogue};
use polemark::lab;
use polemark::reference::Reference;
use polemark::submission::{self, AnswerValue, Folder, NoFiles};
use std::fmt::Write;
use std::path::PathBuf;

/// One line a conflict: criterion, words, what says otherwise, and whether it is the student's own answer that does.
fn conflicts() -> String {
    let lab = lab::load(lab::DEFAULT).expect("the embedded lab is right");
    let reference = Reference::compute(&lab).expect("the lab has a reference");
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("submissions");
    let mut files: Vec<String> = std::fs::read_dir(&folder)
        .expect("the sample class is there")
        .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
        .filter(|name| name.ends_with(".yaml"))
        .collect();
    files.sort();
    let mut found = String::new();
    for name in files {
        let bytes = std::fs::read(folder.join(&name)).expect("a file of the class");
        let submission = submission::read(&name, &name, &bytes, &lab.sheet, &Folder(folder.clone()));
        let card = grading::grade(&lab, &reference, &Catalogue::default(), &submission, None);
        let criteria = lab.questions.iter().flat_map(|question| &question.criteria);
        let items = card.questions.iter().flat_map(|question| &question.items);
        for (criterion, item) in criteria.zip(items) {
            for conflict in &item.evidence.conflicts {
                let Ok(AnswerValue::Prose(prose)) = &submission.answers[&criterion.field].value else {
                    panic!()
                };
                let words = &prose[conflict.span.start..conflict.span.end];
                let words = words.split_whitespace().collect::<Vec<_>>().join(" ");
                let by = if conflict.own { "own" } else { "reference" };
                let stem = name.trim_end_matches(".yaml");
                let (id, claim, against) = (&item.id, &conflict.claim, &conflict.against);
                writeln!(found, "{stem} {id}: “{words}”, {claim} / {by}: {against}").expect("a string");
            }
        }
    }
    found
}

#[test]
fn conflicts_of_the_sample_class() {
    let rows =
        include_str!("conflicts.txt").lines().filter(|line| !line.is_empty() && !line.starts_with('#'));
    let want: String = rows.map(|row| format!("{row}\n")).collect();
    assert_eq!(conflicts(), want);
}

/// The table in `docs/marking.md` whose first column is the description in words of `hanging.response`.
#[test]
fn conflicts_in_the_manual() {
    let lab = lab::load(lab::DEFAULT).expect("the embedded lab is right");
    let reference = Reference::compute(&lab).expect("the lab has a reference");
    let manual = include_str!("../../docs/marking.md");
    let start = manual.find("| description | beside it |").expect("the manual has the table");
    let rows: Vec<&str> = manual[start..].lines().take_while(|line| line.starts_with('|')).skip(2).collect();
    assert!(rows.len() >= 10, "{rows:#?}");
    for row in rows {
        let cells: Vec<&str> = row.trim_matches('|').split('|').map(str::trim).collect();
        let [description, beside, claim, own, by_reference] = cells.as_slice() else { panic!("{row}") };
        let text = format!(
            "answers:\n  hanging.response:\n    description: \"{description}\"\n    {}\n",
            beside.trim_matches('`')
        );
        let submission = submission::read("a", "a.yaml", text.as_bytes(), &lab.sheet, &NoFiles);
        let card = grading::grade(&lab, &reference, &Catalogue::default(), &submission, None);
        let items = card.questions.iter().flat_map(|question| &question.items);
        let found: Vec<_> = items.flat_map(|item| &item.evidence.conflicts).collect();
        let against =
            |own: bool| found.iter().find(|one| one.own == own).map_or("", |one| one.against.as_str());
        assert_eq!((against(true), against(false)), (*own, *by_reference), "{row}: {found:?}");
        assert!(found.iter().all(|one| one.claim == *claim), "{row}: {found:?}");
    }
}
