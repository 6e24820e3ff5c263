//! The program marks `submissions/` as a careful teacher does.

use crate::bench::{Bench, items};
use crate::teacher_marks::{self, Given, Mark, Own};
use polemark::grading::{Guard, ItemScore};
use polemark::lab::Points;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

fn agrees(item: &ItemScore, given: &Given) -> bool {
    item.earned == given.points
        && given.own.is_none_or(|own| stands(item, own))
        && given.provisional.is_none_or(|provisional| item.provisional == provisional)
        && given.verdict.is_none_or(|verdict| item.verdict == verdict)
}

/// Whether the answer stands to the student's own earlier one as the table says.
fn stands(item: &ItemScore, own: Own) -> bool {
    let credited = item.follow_through.as_ref().map(|follow| (follow.credited, follow.guard));
    match own {
        Own::Follows => credited == Some((true, Guard::Passed)) && !item.code.ends_with(".same_mistake"),
        Own::Charged => item.code.ends_with(".same_mistake"),
        Own::Refused => credited.is_some_and(|(credited, guard)| !credited && guard != Guard::Passed),
        Own::Contradicts => item.code == "stability.contradicts_own",
        Own::Unsupported => item.code == "stability.unsupported",
    }
}

#[test]
fn the_program_marks_as_the_teacher_does() {
    let bench = Bench::embedded();
    let mut report = String::new();
    let mut disagreements = 0;
    for sheet in teacher_marks::read(&bench.lab) {
        let marks = items(bench.grade(&bench.handed_in(&sheet.file)));
        let items: BTreeMap<String, ItemScore> =
            marks.into_iter().map(|item| (item.id.clone(), item)).collect();
        for (id, Mark { given, program }) in &sheet.marks {
            let item = items.get(id).unwrap_or_else(|| panic!("{}: `{id}` was not marked", sheet.file));
            if agrees(item, program.as_ref().unwrap_or(given)) {
                continue;
            }
            disagreements += 1;
            let known = match program {
                Some(_) if agrees(item, given) => {
                    " (they agree now: delete the `program` line below it)".to_owned()
                }
                Some(known) => format!(" (of the program {known} was known)"),
                None => String::new(),
            };
            writeln!(
                report,
                "{} {id}\n  teacher {given}{known}: {}\n  program {}{} {:?} {}: {}\n    found: {}",
                sheet.file,
                given.reason,
                item.earned,
                if item.provisional { "?" } else { "" },
                item.verdict,
                item.code,
                item.evidence.reason,
                item.evidence.found,
            )
            .unwrap();
        }
    }
    assert!(disagreements == 0, "{disagreements} marks differ\n{report}");
}

#[test]
fn the_table_covers_every_file_and_criterion() {
    let bench = Bench::embedded();
    let criteria = bench.all_criteria().count();
    let mut in_table = BTreeSet::new();
    for sheet in teacher_marks::read(&bench.lab) {
        assert_eq!(sheet.marks.len(), criteria, "{}: criteria", sheet.file);
        let sum: Points = sheet.marks.values().map(|mark| mark.given.points).sum();
        assert_eq!(sum, sheet.total, "{}: sum of its marks, and its heading", sheet.file);
        for (id, mark) in &sheet.marks {
            let earns = mark.given.points > Points::ZERO;
            assert!(earns || !mark.given.reason.is_empty(), "{}: `{id}` has no reason", sheet.file);
            let left_to_a_person = mark.program.as_ref().is_none_or(|known| known.provisional == Some(true));
            assert!(left_to_a_person, "{}: the program decides `{id}` otherwise", sheet.file);
        }
        assert!(in_table.insert(sheet.file.clone()), "{} stands twice in the table", sheet.file);
    }
    let in_folder: BTreeSet<String> = bench.class().into_iter().map(|submission| submission.id).collect();
    assert_eq!(in_table, in_folder, "files in the table, and files in submissions/");
}
