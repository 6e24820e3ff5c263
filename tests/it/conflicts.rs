//! Prose of the sample class that does not go with the numbers.

use polemark::grading::{self, Catalogue};
use polemark::lab;
use polemark::reference::Reference;
use polemark::submission::{self, AnswerValue, Folder};
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
