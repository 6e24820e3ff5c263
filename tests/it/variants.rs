//! A lab whose numbers differ from student to student, and a class that answers it.

use crate::program::told_in;
use polemark::lab::{self, LabDefinition};
use polemark::reference::Reference;
use polemark::report::HandoutKit;
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

const LAB: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/it/variants.yaml");

fn pendulum() -> LabDefinition {
    lab::load(LAB).expect("the lab is right")
}

/// What a student was given.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Given {
    m: f64,
    l: f64,
    b: f64,
}

fn given(lab: &LabDefinition, id: &str) -> Given {
    let own = lab.with_variant(&lab.variant_of(id).expect("an id")).expect("a variant");
    let value = |name: &str| {
        let one = own.parameters.iter().find(|one| one.name == name).expect("a parameter");
        one.text.parse().expect("a number")
    };
    Given { m: value("m"), l: value("l"), b: value("b") }
}

/// An answer file, right for `given`; the formulas are those of a pendulum, not of the program.
fn answers(students: &str, given: Given) -> String {
    let Given { m, l, b } = given;
    let (inertia, weight) = (m * l * l, m * 9.81 * l);
    let decay = b / (2.0 * inertia);
    let frequency = (weight / inertia - decay * decay).sqrt();
    let upright = (weight / inertia + decay * decay).sqrt();
    let at = |t: f64| (-decay * t).exp() * (frequency * t).sin() / (inertia * frequency);
    let rows: String =
        (0..=50).map(|i| f64::from(i) * 0.1).map(|t| format!("      {t:.1}, {:.5}\n", at(t))).collect();
    format!(
        "lab: pendulum-of-ones-own\n{students}\nanswers:\n  \
         down.transfer_function: 1/({inertia:.6}s^2 + {b}s + {weight:.6})\n  \
         down.response:\n    \
         poles: [{:.5} ± {frequency:.5}j]\n    \
         period: {:.5}\n    \
         final_value: 0\n    shape: decaying oscillation\n    stability: stable\n    \
         description: It swings and comes to rest.\n    data: |\n{rows}  \
         up.transfer_function: 1/({inertia:.6}s^2 + {b}s - {weight:.6})\n  \
         up.response:\n    poles: [{:.5}, {:.5}]\n    stability: unstable\n  bearing: Coulomb friction\n",
        -decay,
        2.0 * std::f64::consts::PI / frequency,
        upright - decay,
        -upright - decay,
    )
}

fn of(id: &str) -> String {
    format!("student: {{id: {id}, name: Student {id}}}")
}

struct Class {
    folder: tempfile::TempDir,
}

impl Class {
    fn new() -> Self {
        Self { folder: tempfile::tempdir().expect("a folder") }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn hand_in(&self, name: &str, text: &str) {
        let folder = self.path("in");
        std::fs::create_dir_all(&folder).expect("made");
        std::fs::write(folder.join(name), text).expect("written");
    }

    #[track_caller]
    fn run(&self, arguments: &[&str], code: i32) -> String {
        let (found, text) = told_in(self.folder.path(), arguments);
        assert_eq!(found, Some(code), "{text}");
        text
    }

    /// Marks what was handed in; a line of `results.jsonl` each, by file name.
    #[track_caller]
    fn grade(&self, more: &[&str]) -> BTreeMap<String, Value> {
        let arguments = ["grade", "in", "--out", "out", "--lab", LAB];
        self.run(&[&arguments[..], more].concat(), 0);
        let lines = self.read("out/results.jsonl");
        let lines = lines.lines().map(|line| serde_json::from_str::<Value>(line).expect("JSON"));
        lines.map(|line| (line["file"].as_str().expect("a name").to_owned(), line)).collect()
    }

    fn read(&self, name: &str) -> String {
        std::fs::read_to_string(self.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }
}

fn earned(line: &Value) -> f64 {
    line["total"]["earned"].as_f64().expect("points")
}

/// (criterion, code) of what waits for a person because of whose numbers it is.
fn left(line: &Value) -> Vec<(&str, &str)> {
    let items = line["items"].as_array().expect("items").iter();
    let pairs = items.map(|item| (item["id"].as_str().expect("id"), item["code"].as_str().expect("code")));
    pairs.filter(|(_, code)| code.starts_with("variant.")).collect()
}

#[test]
fn everyone_is_marked_by_their_own_numbers() {
    let (lab, class) = (pendulum(), Class::new());
    for number in 0..24 {
        let id = format!("ME-{number:03}");
        class.hand_in(&format!("{id}.yaml"), &answers(&of(&id), given(&lab, &id)));
    }
    let marked = class.grade(&[]);
    assert_eq!(marked.len(), 24);
    for (name, line) in &marked {
        let given = given(&lab, name.trim_end_matches(".yaml"));
        assert_eq!(earned(line), 20.0, "{name}: {given:?} {line:#}");
        let m = line["parameters"]["m"].as_str().expect("a value").parse::<f64>().expect("a number");
        assert_eq!(m, given.m, "{name}");
    }
    let different: std::collections::BTreeSet<String> =
        marked.values().map(|line| line["parameters"].to_string()).collect();
    assert!(different.len() > 15, "{different:?}");
    // A student's own values, and nobody else's.
    let page = class.read("out/reports/ME-003.html");
    assert!(page.contains("What was given") && page.contains("These are yours"));
    assert!(!page.contains("ME-004"));
    assert!(class.read("out/index.html").contains("Own values"));
}

#[test]
fn letters_stand_for_ones_own_values() {
    let (lab, class) = (pendulum(), Class::new());
    let ids = ["ME-001", "ME-002"];
    assert_ne!(given(&lab, ids[0]), given(&lab, ids[1]));
    for id in ids {
        let text = format!(
            "lab: pendulum-of-ones-own\n{}\nanswers:\n  down.transfer_function: 1/(m*l^2*s^2 + b*s + m*g*l)\n",
            of(id)
        );
        class.hand_in(&format!("{id}.yaml"), &text);
        let Given { m, l, b } = given(&lab, id);
        let echo = class.run(&["check", &format!("in/{id}.yaml"), "--lab", LAB], 0);
        assert!(echo.contains(&format!("The values of {id} are m = {m}, l = {l}, b = {b}.")), "{echo}");
    }
    for line in class.grade(&[]).values() {
        assert_eq!(earned(line), 5.0, "{line:#}");
    }
}

#[test]
fn without_an_id_nothing_that_depends_on_it_is_marked() {
    let (lab, class) = (pendulum(), Class::new());
    let right = given(&lab, "ME-001");
    class.hand_in("ME-001.yaml", &answers("student:", right));
    class.hand_in("named.yaml", &answers("student: {name: A. Student}", right));
    class.hand_in("dashes.yaml", &answers("student: {id: \"--\"}", right));
    for (name, line) in class.grade(&[]) {
        assert_eq!(earned(&line), 1.0, "only the question about the bearing: {name}");
        assert_eq!(left(&line).len(), 14, "{name}: {line:#}");
        assert!(left(&line).iter().all(|(_, code)| *code == "variant.unknown"));
        assert_eq!(line["parameters"], serde_json::json!({}));
    }
    let page = class.read("out/reports/named.html");
    assert!(page.contains("not known whose answer this is") && !page.contains("What was given"));
    for value in ["24.525", "4.942"] {
        assert!(!page.contains(value), "the lab's own {value} is nobody's");
    }
    class.run(&["check", "in/named.yaml", "--lab", LAB], 1);
}

#[test]
fn a_group_is_marked_by_its_first_students_numbers() {
    let (lab, class) = (pendulum(), Class::new());
    let students = "students: [{id: ME-001, name: One}, {id: ME-002, name: Two}]";
    class.hand_in("first.yaml", &answers(students, given(&lab, "ME-001")));
    class.hand_in("second.yaml", &answers(students, given(&lab, "ME-002")));
    let marked = class.grade(&[]);
    assert_eq!((earned(&marked["first.yaml"]), left(&marked["first.yaml"]).len()), (20.0, 0));
    let left = left(&marked["second.yaml"]);
    assert!(left.contains(&("down.transfer_function.denominator", "variant.member")), "{left:?}");
    assert!(left.iter().all(|(_, code)| *code == "variant.member"));
    let lost: Vec<_> = marked["second.yaml"]["items"]
        .as_array()
        .expect("items")
        .iter()
        .filter(|item| item["verdict"] != "right" && item["verdict"] != "unmarked")
        .collect();
    assert!(lost.is_empty(), "nothing is a zero: {lost:#?}");
}

#[test]
fn an_id_that_is_not_on_the_roster_is_pointed_out() {
    let (lab, class) = (pendulum(), Class::new());
    for id in ["ME-001", "ME-777"] {
        class.hand_in(&format!("{id}.yaml"), &answers(&of(id), given(&lab, id)));
    }
    std::fs::write(class.path("roster.csv"), "Name,Student ID\nOne,me 001\nTwo,ME-002\n").expect("written");
    let marked = class.grade(&["--roster", "roster.csv"]);
    let findings = |name: &str| marked[name]["findings"].to_string();
    assert!(!findings("ME-001.yaml").contains("not_on_roster"));
    assert!(findings("ME-777.yaml").contains("student.not_on_roster"));
    assert_eq!(earned(&marked["ME-777.yaml"]), 20.0);
}

#[test]
fn keys_and_templates_are_a_students_own() {
    let class = Class::new();
    let key = class.run(&["reference", LAB, "--student", "EE-001"], 0);
    assert!(key.starts_with("For EE-001: m = 0.7 kg, l = 0.35 m, b = 0.04 N m s\n"), "{key}");
    assert!(key.contains("1 / (0.08575s^2 + 0.04s + 2.40345)"), "{key}");
    let json = class.run(&["reference", LAB, "--student", "EE-001", "--format", "json"], 0);
    let json: Value = serde_json::from_str(&json).expect("JSON");
    assert_eq!((&json["student"], &json["parameters"]["m"]), (&"EE-001".into(), &"0.7".into()));
    let page = class.run(&["reference", LAB, "--student", "<b>1", "--format", "html"], 0);
    assert!(page.contains("For the numbers of &lt;b&gt;1"));
    let template = class.run(&["new", LAB, "--student", "a\"b: [c"], 0);
    assert!(template.contains("id: \"a\\\"b: [c\"") && template.contains("# m = 0."), "{template}");
    class.run(&["new", "--student", "EE-001"], 2);
    assert!(Path::new(LAB).exists());
}

#[test]
fn answers_for_somebody_elses_numbers_are_pointed_out_to_the_instructor_alone() {
    let (lab, class) = (pendulum(), Class::new());
    let ids: Vec<String> = (0..12).map(|number| format!("ME-{number:03}")).collect();
    for id in &ids {
        class.hand_in(&format!("{id}.yaml"), &answers(&of(id), given(&lab, id)));
    }
    // Two whose masses and lengths differ change places.
    let (one, two) = ids
        .iter()
        .flat_map(|one| ids.iter().map(move |two| (one, two)))
        .find(|(one, two)| {
            let (a, b) = (given(&lab, one), given(&lab, two));
            a.m != b.m && a.l != b.l
        })
        .expect("a pair");
    class.hand_in(&format!("{one}.yaml"), &answers(&of(one), given(&lab, two)));
    let marked = class.grade(&[]);
    for id in &ids {
        let line = &marked[&format!("{id}.yaml")];
        if id != one {
            assert!(line.get("other_variant").is_none(), "{id}: {line:#}");
            assert_eq!(earned(line), 20.0, "{id}");
            continue;
        }
        let others = line["other_variant"].as_array().expect("a list");
        assert_eq!(others.len(), 1, "{others:#?}");
        assert!(others[0]["students"].as_array().expect("ids").contains(&two.as_str().into()), "{others:#?}");
        let fields = others[0]["fields"].to_string();
        assert!(
            fields.contains("down.transfer_function") && fields.contains("up.response.poles"),
            "{fields}"
        );
        assert!(others[0]["chance"].as_f64().expect("a number") < 0.01, "{others:#?}");
        let page = class.read(&format!("out/reports/{one}.html"));
        assert!(!page.contains(two.as_str()), "no other student on a student's page");
    }
    let index = class.read("out/index.html");
    assert!(index.contains(&format!("right for those of {two}")), "{index}");
}

#[test]
fn a_few_small_numbers_are_no_evidence() {
    let (lab, class) = (pendulum(), Class::new());
    for id in ["ME-001", "ME-002"] {
        class.hand_in(&format!("{id}.yaml"), &answers(&of(id), given(&lab, id)));
    }
    let other = given(&lab, "ME-002");
    let period = 2.0 * std::f64::consts::PI
        / (9.81 / other.l - (other.b / (2.0 * other.m * other.l * other.l)).powi(2)).sqrt();
    class.hand_in(
        "ME-001.yaml",
        &format!(
            "lab: pendulum-of-ones-own\n{}\nanswers:\n  down.transfer_function: 1/(s^2 + 1)\n  down.response:\n    \
             period: {period:.4}\n    final_value: 0\n",
            of("ME-001")
        ),
    );
    let marked = class.grade(&[]);
    assert!(marked["ME-001.yaml"].get("other_variant").is_none(), "{:#}", marked["ME-001.yaml"]);
}

#[test]
fn the_number_of_threads_changes_nothing() {
    let (lab, class) = (pendulum(), Class::new());
    for number in 0..20 {
        let id = format!("ME-{number:03}");
        let theirs = format!("ME-{:03}", number / 2);
        class.hand_in(&format!("{id}.yaml"), &answers(&of(&id), given(&lab, &theirs)));
    }
    let run = |threads: &str| {
        class.grade(&["--threads", threads]);
        ["out/results.jsonl", "out/index.html", "out/gradebook.csv", "out/reports/ME-007.html"]
            .map(|name| class.read(name))
    };
    assert!(run("1") == run("4"));
}

#[test]
fn everyone_gets_a_sheet_and_an_answer_file() {
    let (lab, class) = (pendulum(), Class::new());
    let roster = "Section,\"Student, full name\",Student ID,Name\n1,x,ME-001,Ada One\n1,x,../../ME 002,<b>Two</b>\n1,x,=cmd|calc,\"=HYPERLINK(\"\"x\"\")\"\n";
    std::fs::write(class.path("roster.csv"), roster).expect("written");
    let told = class.run(&["handout", LAB, "--roster", "roster.csv", "--out", "sheets"], 0);
    assert!(told.contains("3 sheets in sheets") && told.contains("of 60 possible"), "{told}");
    let sheet = class.read("sheets/ME-001/handout.html");
    let Given { m, l, b } = given(&lab, "ME-001");
    for value in [m, l, b] {
        assert!(sheet.contains(&format!("<td class=\"num\">{value}</td>")), "{value}: {sheet}");
    }
    assert!(sheet.contains("Ada One") && sheet.contains("Question 1") && sheet.contains("<math"));
    assert!(!sheet.contains("24.525") && !sheet.contains("decaying"), "nothing of the answers");
    let template = class.read("sheets/ME-001/answers.yaml");
    assert!(template.contains("id: \"ME-001\"") && template.contains(&format!("# m = {m} kg")), "{template}");
    let hostile = class.read("sheets/ME-002/handout.html");
    assert!(hostile.contains("&lt;b&gt;Two") && !hostile.contains("<b>Two"), "{hostile}");
    let list = class.read("sheets/variants.csv");
    assert!(list.starts_with("student_id,student_name,folder,m,l,b\nME-001,Ada One,ME-001,"), "{list}");
    assert!(list.contains("'=cmd|calc,") && list.contains("\"'=HYPERLINK(\"\"x\"\")\""), "{list}");
    // An answer file reads back as blank, whoever it is of, and is left alone when it was filled in.
    class.run(&["check", "sheets/ME-002/answers.yaml", "--lab", LAB], 0);
    class.run(&["check", "sheets/cmd-calc/answers.yaml", "--lab", LAB], 0);
    std::fs::write(class.path("sheets/ME-001/answers.yaml"), "mine").expect("written");
    let again = class.run(&["handout", LAB, "--roster", "roster.csv", "--out", "sheets"], 0);
    assert!(again.contains("1 answer file left alone"), "{again}");
    assert_eq!(class.read("sheets/ME-001/answers.yaml"), "mine");
    assert_eq!(class.read("sheets/ME-001/handout.html"), sheet);
    class.run(&["handout", LAB, "--out", "none"], 2);
    class.run(&["handout", "--out", "common"], 0);
    assert!(class.read("common/handout.html").contains("Linearization of nonlinear systems"));
}

#[test]
fn every_variant_is_proven() {
    let class = Class::new();
    let told = class.run(&["verify", LAB], 0);
    let told: String = told.split_whitespace().collect::<Vec<_>>().join(" ");
    for words in [
        "variants: solvable: all 60 have right answers",
        "variants: equally hard: the same orders",
        "variants: different: 60 different sets",
        "variants: mistakes told apart: in all 60, at least",
        "variants: answers are one's own: computed answers of 6 variants earn",
    ] {
        assert!(told.contains(words), "{words}: {told}");
    }
}

#[test]
fn a_variant_of_another_kind_is_named() {
    let class = Class::new();
    let text = std::fs::read_to_string(LAB).expect("read");
    // So much friction that nothing swings any more.
    let text = text.replace("varies: [0.04, 0.06, 0.08]", "varies: [0.04, 5]");
    std::fs::write(class.path("lab.yaml"), text).expect("written");
    let told = class.run(&["verify", "lab.yaml"], 1);
    let told: String = told.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        told.contains("FAIL variants: equally hard: 20 of 40 are not like the lab's own, such as m = 0.4"),
        "{told}"
    );
    assert!(
        told.contains("b = 5: pendulum.down:") && told.contains("2 real and 0 complex poles, not"),
        "{told}"
    );
}

/// A lab of one's own values with simulations into which they enter, and do not.
fn with_simulations() -> LabDefinition {
    let text = std::fs::read_to_string(LAB).expect("read");
    let chain = |id: &str, limit: &str| {
        format!(
            "  {id}:\n    title: {id}\n    source: {{sine: {{amplitude: 8, frequency_rad_s: 1}}}}\n    chain: [{{saturation: \
             {{limit: {limit}}}}}, {{transfer_function: {{num: [1], den: [1, 2]}}}}]\n    duration_s: 3\n    input: {{name: \
             u, unit: V}}\n    output: {{name: y, unit: V}}\n    shown_in: bearing\n"
        )
    };
    let simulations: String = [("number", "5"), ("common", "g/2"), ("own", "10*m"), ("follows", "w")]
        .map(|(id, limit)| chain(id, limit))
        .concat();
    let text = text
        .replace("\nmodels:", "  w: {formula: m*g, unit: N, description: weight}\n\nmodels:")
        .replace("\nquestions:", &format!("\nsimulations:\n{simulations}\nquestions:"));
    let source = polemark::source::SourceText::new("lab.yaml", text);
    LabDefinition::parse(source).unwrap_or_else(|errors| panic!("{errors:#?}"))
}

#[test]
fn a_simulation_varies_when_a_varied_parameter_enters_it() {
    let lab = with_simulations();
    for (id, varied) in
        [("number", false), ("common", false), ("own", true), ("follows", true), ("none", false)]
    {
        assert_eq!(lab.is_simulation_varied(id), varied, "{id}");
    }
}

#[test]
fn what_is_shared_between_variants_is_what_each_would_have() {
    let lab = with_simulations();
    let own = Reference::compute(&lab).expect("a reference");
    for id in ["ME-001", "ME-002"] {
        let theirs = lab.with_variant(&lab.variant_of(id).expect("an id")).expect("a variant");
        let (shared, whole) = (
            Reference::for_marking(&theirs, &own).expect("a reference"),
            Reference::compute(&theirs).expect("a reference"),
        );
        assert_eq!(format!("{:?}", shared.simulations), format!("{:?}", whole.simulations), "{id}");
        let points = |reference: &Reference| -> Vec<String> {
            let points = reference.models.iter().flat_map(|model| &model.operating_points);
            points.map(|point| format!("{:?} {:?}", point.accepted, point.comparison)).collect()
        };
        assert_eq!(points(&shared), points(&whole), "{id}");
    }
}

#[test]
fn a_group_in_any_order_and_spelling_is_never_marked_down_for_its_order() {
    let (lab, class) = (pendulum(), Class::new());
    let one = given(&lab, "ME-001");
    // (students, answers are right by ME-001, earned, the code of what is left to a person)
    for (name, students, earns, code) in [
        ("same", "students: [{id: me 001}, {id: ME-001}]", 20.0, None),
        ("first", "students: [{id: ME-001}, {id: ME-002}, {id: ME-003}]", 20.0, None),
        ("last", "students: [{id: ME-003}, {id: ME-002}, {id: ME-001}]", 1.0, Some("variant.member")),
        ("dashes", "students: [{id: \"--\"}, {id: ME-001}]", 1.0, Some("variant.unknown")),
        ("nameless", "students: [{name: A. Student}, {id: ME-001}]", 1.0, Some("variant.unknown")),
        ("second", "students: [{id: ME-001}, {name: A. Student}]", 20.0, None),
        ("ME-001", "students: [{id: ME-001}, {name: A. Student}]", 20.0, None),
    ] {
        class.hand_in("one.yaml", &answers(students, one));
        std::fs::rename(class.path("in/one.yaml"), class.path(&format!("in/{name}.yaml"))).expect("renamed");
        let line = &class.grade(&[])[&format!("{name}.yaml")];
        std::fs::remove_file(class.path(&format!("in/{name}.yaml"))).expect("removed");
        let codes: std::collections::BTreeSet<&str> = left(line).into_iter().map(|(_, code)| code).collect();
        assert_eq!(codes.into_iter().collect::<Vec<_>>(), code.into_iter().collect::<Vec<_>>(), "{name}");
        assert!(earned(line) >= earns, "{name}: {}", earned(line));
        let items = line["items"].as_array().expect("items").iter();
        let lost = items.filter(|item| item["verdict"] != "right" && item["verdict"] != "unmarked");
        assert_eq!(lost.count(), 0, "{name}: nothing is a zero: {line:#}");
    }
}

#[test]
fn a_hostile_roster_of_300_stays_in_its_folder() {
    let class = Class::new();
    let long = "x".repeat(300);
    let mut rows = vec!["id,name".to_owned()];
    for (id, name) in [
        ("../../x", "<script>alert(1)</script>"),
        ("=cmd|calc", "@SUM(1)"),
        ("<script>", "\u{202e}drawkcab"),
        ("\u{200f}ME-9\u{200e}", "\u{1b}[31mred"),
        ("CON", "con"),
        ("..", "dots"),
        ("", "nobody"),
        ("--", "dashes"),
        ("ME-1", "One"),
        ("me 1", "One again"),
        ("ME-1", "One twice"),
        (long.as_str(), long.as_str()),
    ] {
        rows.push(format!("{id},{name}"));
    }
    rows.extend((0..288).map(|number| format!("S{number:03},Student {number}")));
    std::fs::write(class.path("roster.csv"), rows.join("\n")).expect("written");
    let told = class.run(&["handout", LAB, "--roster", "roster.csv", "--out", "a/b/sheets"], 0);
    assert!(told.contains("296 sheets"), "{told}");
    assert!(!told.contains('\u{1b}') && !told.contains('\u{202e}'), "{told}");
    for words in ["`nobody` has no id", "`dashes` has no id", "is on line 10 already", "only in spelling"] {
        assert!(told.contains(words), "{words}: {told}");
    }
    let mut folders = 0;
    for entry in std::fs::read_dir(class.path("a/b/sheets")).expect("a folder") {
        let entry = entry.expect("an entry").path();
        if entry.is_dir() {
            folders += 1;
            let sheet = std::fs::read_to_string(entry.join("handout.html")).expect("a sheet");
            assert!(!sheet.contains("<script") && !sheet.contains('\u{202e}'), "{}", entry.display());
        }
    }
    assert_eq!(folders, 296);
    for (folder, count) in [("a/b", 1), ("a", 1)] {
        assert_eq!(
            std::fs::read_dir(class.path(folder)).expect("a folder").count(),
            count,
            "nothing beside it"
        );
    }
    // An answer file keeps to the values that were handed out, whatever the id.
    let list = class.read("a/b/sheets/variants.csv");
    let mut reader = csv_rows(&list);
    assert_eq!(reader.remove(0)[2], "folder");
    for row in reader.iter().take(10) {
        let file = format!("a/b/sheets/{}/answers.yaml", row[2].trim_start_matches('\''));
        let echo = class.run(&["check", &file, "--lab", LAB], 0);
        let values = format!("m = {}, l = {}, b = {}.", row[3], row[4], row[5]);
        assert!(echo.contains(&values), "{file}: {values}: {echo}");
    }
}

/// Rows without line breaks in them; no cell here has a comma.
fn csv_rows(text: &str) -> Vec<Vec<String>> {
    text.lines().map(|line| line.split(',').map(|cell| cell.trim_matches('"').to_owned()).collect()).collect()
}

#[test]
fn a_roster_with_nul_in_it_is_refused_or_cleaned() {
    let class = Class::new();
    std::fs::write(class.path("roster.csv"), "id,name\nA\0B,x\n").expect("written");
    let arguments = ["handout", LAB, "--roster", "roster.csv", "--out", "sheets"];
    let (code, told) = told_in(class.folder.path(), &arguments);
    assert!(matches!(code, Some(0 | 2)) && !told.contains("panicked"), "{told}");
    if code == Some(0) {
        assert!(!class.read("sheets/A-B/handout.html").contains('\0'));
    }
}

/// Numbers and words that a sheet must not hold: coefficients, poles and features, to three figures and more.
#[test]
fn sheets_hold_nothing_of_the_answers() {
    for name in [LAB, "ee361-lab3", "dc-motor", "inverted-pendulum"] {
        let lab = lab::load(name).expect("a lab");
        let sheet = HandoutKit::new().expect("templates").sheet(&lab, None);
        let (_, body) = sheet.split_once("<body").expect("a body");
        let asked: String = std::iter::once(lab.title.as_str())
            .chain(lab.questions.iter().flat_map(|question| {
                let prompts = question.fields.iter().map(|field| field.prompt.as_str());
                [question.title.as_str(), question.text.as_str()].into_iter().chain(prompts)
            }))
            .collect::<Vec<_>>()
            .join("\n");
        let given: Vec<f64> = lab.parameters.iter().filter_map(|one| one.text.parse().ok()).collect();
        let reference = Reference::numbers(&lab).expect("a reference");
        let mut numbers = Vec::new();
        for point in reference.models.iter().flat_map(|model| &model.operating_points) {
            let main = point.main();
            let g = main.linearization.transfer_function.monic();
            numbers.extend(g.num.to_f64().into_iter().chain(g.den.to_f64()));
            numbers.extend(main.poles.iter().flat_map(|pole| [pole.re, pole.im]));
        }
        for number in numbers.into_iter().map(f64::abs) {
            let typed = polemark::algebra::significant(number, 4);
            let digits = typed.chars().filter(char::is_ascii_digit).collect::<String>();
            let plain = digits.trim_matches('0').len() < 4;
            if plain || asked.contains(&typed) || given.iter().any(|one| (one - number).abs() < 1e-3 * number)
            {
                continue;
            }
            assert!(!body.contains(&typed), "{name}: {typed} is an answer");
        }
        for answer in lab.model_answer.answers.values() {
            let text = answer.text.trim();
            if text.chars().count() >= 6 && !asked.contains(text) {
                assert!(!body.contains(text), "{name}: `{text}` is an answer");
            }
        }
    }
}
