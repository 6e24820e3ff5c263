//! What students get to see, and what the instructor does.

use crate::program::{Program, files_below, samples};
use std::collections::BTreeMap;

fn pages(files: &BTreeMap<String, Vec<u8>>, folder: &str) -> Vec<String> {
    files.keys().filter_map(|name| name.strip_prefix(folder)).map(str::to_owned).collect()
}

#[test]
fn what_is_withheld_from_students_is_in_the_instructors_edition() {
    let bench = Program::new();
    let file = samples().join("sign_error_friction.yaml");
    let file = file.to_string_lossy();
    bench.run(&["grade", &file, "--out", "all"]).ends_with(0);
    bench.run(&["grade", &file, "--out", "some", "--release", "marks,feedback"]).ends_with(0);
    let (all, some) = (files_below(&bench.path("all")), files_below(&bench.path("some")));
    assert_eq!(pages(&all, "instructor/"), Vec::<String>::new());
    assert_eq!(pages(&some, "instructor/"), pages(&all, "reports/"));
    for name in pages(&all, "reports/") {
        let full = &all[&format!("reports/{name}")];
        assert_eq!(&some[&format!("instructor/{name}")], full, "the report as it always was");
        let student = String::from_utf8_lossy(&some[&format!("reports/{name}")]).into_owned();
        assert!(student.contains("Solutions are not released yet.") && !student.contains("<svg"));
        let index = String::from_utf8_lossy(&some["index.html"]).replace("&#x2f;", "/");
        assert!(index.contains(&format!("instructor/{name}")) && !index.contains("\"reports/"));
    }
    assert_eq!(all["gradebook.csv"], some["gradebook.csv"]);

    // Released later, into the same folder: as if it had always been.
    bench.run(&["grade", &file, "--out", "some"]).ends_with(0);
    let later: BTreeMap<_, _> = files_below(&bench.path("some"))
        .into_iter()
        .filter(|(name, _)| !name.starts_with(".polemark"))
        .collect();
    let all: BTreeMap<_, _> = all.into_iter().filter(|(name, _)| !name.starts_with(".polemark")).collect();
    assert_eq!(later.keys().collect::<Vec<_>>(), all.keys().collect::<Vec<_>>());
    assert!(later == all, "the same bytes");
}
