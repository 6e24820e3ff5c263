//! An instructor's first hour: a new folder, the guide's own example, and what is said when something is missing.

use crate::program::told_in as run;
use polemark::reference::Reference;
use std::path::Path;

/// A lab is proven, its template reads as blank, and its own model answers, handed in, earn full marks.
#[track_caller]
fn works(folder: &Path, lab: &str, points: &str) {
    let (code, verified) = run(folder, &["verify", lab, "--strict"]);
    assert_eq!(code, Some(0), "{verified}");
    assert!(verified.contains(": proven, "), "{verified}");
    let (code, template) = run(folder, &["new", lab, "--out", "template.yaml"]);
    assert_eq!(code, Some(0), "{template}");
    // It has no name in it yet, which is all there is to say.
    let (_, checked) = run(folder, &["check", "template.yaml", "--lab", lab]);
    assert!(checked.contains("0 answers read, 1 to look at"), "{checked}");
    let (code, marked) = run(folder, &["grade", "template.yaml", "--lab", lab, "--out", "out"]);
    assert_eq!(code, Some(0), "{marked}");
    assert!(marked.contains(&format!("1 submission marked, mean 0 of {points} points")), "{marked}");
}

#[test]
fn a_new_lab_works_as_it_is() {
    let folder = tempfile::tempdir().expect("a folder");
    let (code, said) = run(folder.path(), &["new", "--lab", "labs/duffing"]);
    assert_eq!(
        (code, said.as_str()),
        (
            Some(0),
            "labs/duffing: lab.yaml, README.md, answers.yaml, lab.schema.json\nNext: polemark verify labs/duffing\n",
        )
    );
    let lab = folder.path().join("labs/duffing");
    assert!(std::fs::read_to_string(lab.join("lab.yaml")).expect("text").contains("\nlab: duffing\n"));
    assert!(std::fs::read_to_string(lab.join("answers.yaml")).expect("text").contains("\nlab: duffing\n"));
    works(&lab, "lab.yaml", "14");
}

#[test]
fn a_new_lab_overwrites_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("README.md"), "mine").expect("written");
    let (code, said) = run(folder.path(), &["new", "--lab", "."]);
    assert_eq!(code, Some(2), "{said}");
    assert!(said.contains("README.md"), "{said}");
    let names: Vec<_> = std::fs::read_dir(folder.path()).expect("read").collect();
    assert_eq!(names.len(), 1);
    assert_eq!(std::fs::read_to_string(folder.path().join("README.md")).expect("text"), "mine");
}

#[test]
fn labs_are_listed() {
    let folder = tempfile::tempdir().expect("a folder");
    let (code, table) = run(folder.path(), &["labs"]);
    assert_eq!(code, Some(0));
    let (_, json) = run(folder.path(), &["labs", "--format", "json"]);
    let json: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    let rows = json.as_array().expect("a list");
    assert_eq!(rows.len(), polemark::lab::embedded().len());
    for (row, (id, _)) in rows.iter().zip(polemark::lab::embedded()) {
        assert_eq!(row["id"], *id);
        assert!(table.contains(id), "{table}");
    }
    assert_eq!(rows[0]["points"], 45.0);
}

/// What is missing is no failure, is told with values to check by hand, and with them the lab is proven.
#[test]
fn what_is_missing_can_be_pasted() {
    let folder = tempfile::tempdir().expect("a folder");
    let whole = include_str!("../../templates/new-lab/lab.yaml");
    let mut bare = String::new();
    let mut answer = false;
    for line in whole.lines().take_while(|line| !line.starts_with("# Values you know")) {
        answer = line.starts_with("    model_answer:") || answer && line.starts_with("      ");
        if !answer {
            bare.push_str(line);
            bare.push('\n');
        }
    }
    std::fs::write(folder.path().join("lab.yaml"), &bare).expect("written");
    let (code, said) = run(folder.path(), &["verify", "lab.yaml"]);
    assert_eq!(code, Some(0), "{said}");
    assert!(said.contains("TO DO expectations:") && said.contains("TO DO model answers:"), "{said}");
    assert!(said.contains("it is not proven yet: 2 to do"), "{said}");
    assert_eq!(run(folder.path(), &["verify", "lab.yaml", "--strict"]).0, Some(1));

    let lines: Vec<&str> = said.lines().skip_while(|line| *line != "questions:").skip(1).collect();
    let (answers, rest) = lines.split_at(lines.iter().position(|line| *line == "expect:").expect("values"));
    let mut complete = bare;
    let mut question = "";
    for line in answers {
        if line.starts_with("  ") && !line.starts_with("    ") {
            question = line;
        } else {
            let place = complete.find(&format!("\n{question}\n")).expect("the question") + question.len() + 2;
            // Lines that belong together are put in one after the other.
            let after = complete[place..]
                .split_inclusive('\n')
                .take_while(|known| known.contains("model_answer") || known.starts_with("      "))
                .map(str::len)
                .sum::<usize>();
            complete.insert_str(place + after, &format!("{line}\n"));
        }
    }
    for line in rest.iter().take_while(|line| !line.is_empty()) {
        complete.push_str(line);
        complete.push('\n');
    }
    std::fs::write(folder.path().join("lab.yaml"), &complete).expect("written");
    works(folder.path(), "lab.yaml", "14");
}

#[test]
fn nothing_keeps_a_lab_of_the_shelf_from_proof() {
    for (id, _) in polemark::lab::embedded() {
        let lab = polemark::lab::load(id).expect("it parses");
        let reference = Reference::compute(&lab).expect("it has a reference");
        let to_do: Vec<_> = polemark::proof::missing(&lab, &reference)
            .into_iter()
            .filter(|one| one.keeps_from_proof)
            .collect();
        assert!(to_do.is_empty(), "{id}: {to_do:#?}");
    }
}

/// The guide's own example, and the way it says to go.
#[test]
fn the_guide_works() {
    const GUIDE: &str = include_str!("../../docs/lab-file.md");
    let lab = GUIDE.split("```yaml\n").nth(1).and_then(|rest| rest.split("```").next()).expect("an example");
    assert!(lab.lines().count() <= 30);
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("lab.yaml"), lab).expect("written");
    works(folder.path(), "lab.yaml", "9");
    for arguments in [
        &["reference", "lab.yaml", "--format", "html", "--out", "key.html"][..],
        &["schema", "lab", "--out", "lab.schema.json"],
        &["schema", "answers", "lab.yaml"],
    ] {
        let (code, said) = run(folder.path(), arguments);
        assert_eq!(code, Some(0), "{arguments:?}: {said}");
    }
}

/// Where a point states nothing, the key says what that means.
#[test]
fn a_point_at_rest_by_default_is_said_to_be_so() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("lab.yaml"), include_str!("../../templates/new-lab/lab.yaml"))
        .expect("written");
    let (code, said) =
        run(folder.path(), &["reference", "lab.yaml", "--format", "html", "--out", "key.html"]);
    assert_eq!(code, Some(0), "{said}");
    let key = std::fs::read_to_string(folder.path().join("key.html")).expect("written");
    assert!(key.contains("<p>Everything is 0 here. Put into") && !key.contains("<p>; every"), "{key}");
}

/// What may be meant so, and rarely is, is pointed out.
#[test]
fn likely_slips_are_hints() {
    let folder = tempfile::tempdir().expect("a folder");
    let whole = include_str!("../../templates/new-lab/lab.yaml");
    for (from, to, hint) in [
        (
            "unit: kg,",
            "unit: kgg,",
            "`kgg`, in the unit of `m`, is none that polemark knows; did you mean `kg`?",
        ),
        ("mass}", "mass of it}", ""),
        ("  m: {", "  q: {value: 1}\n  m: {", "nothing uses `q`: is it missing in an equation?"),
    ] {
        assert!(whole.contains(from), "{from}");
        std::fs::write(folder.path().join("lab.yaml"), whole.replacen(from, to, 1)).expect("written");
        let (code, said) = run(folder.path(), &["verify", "lab.yaml"]);
        assert_eq!(code, Some(0), "{said}");
        let said = said.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(said.contains(hint) && said.contains("hint") != hint.is_empty(), "{said}");
    }
}

/// An inner quantity that the equations hold only implicitly cannot be followed in time.
#[test]
fn what_cannot_be_followed_is_told_at_its_point() {
    let folder = tempfile::tempdir().expect("a folder");
    let lab = "lab: drag\nmodels:\n  plant:\n    coordinates: {x: {}, f: {}}\n    inputs: {F: {}}\n    \
               equations: [\"x'' + x = F - f\", \"f + f^3 = x'\"]\n    operating_points:\n      rest: {output: x}\n\
               questions:\n  tf: {points: 4, answer: transfer_function}\n";
    std::fs::write(folder.path().join("lab.yaml"), lab).expect("written");
    let (code, said) = run(folder.path(), &["verify", "lab.yaml"]);
    assert_eq!(code, Some(1), "{said}");
    assert!(said.contains("lab.yaml:8:7"), "{said}");
    let said = said.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(said.contains("solve it for `f` by hand, and put the result into the other equations"), "{said}");
}
