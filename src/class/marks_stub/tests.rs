use super::yaml::quoted;
use super::*;
use crate::class::run_facts::LevelFacts;
use crate::source;
use proptest::prelude::*;
use serde_json::json;

fn lab() -> LabFacts {
    let part = |id: &str, possible: &str| PartFacts {
        id: id.to_owned(),
        title: format!("Title of {id}"),
        possible: possible.to_owned(),
        levels: Vec::new(),
    };
    let level =
        LevelFacts { points: "3–4".to_owned(), title: "Good".to_owned(), text: "with help".to_owned() };
    LabFacts {
        id: "a-lab".to_owned(),
        title: "A lab".to_owned(),
        hash: String::new(),
        items: vec![part("q.one", "2"), part("q.two", "1")],
        observed: vec![PartFacts { levels: vec![level], ..part("care", "5") }],
        by_hand: vec![part("viva", "35")],
    }
}

/// A record with (item, group, hash) waiting, `begins` as the answer.
fn record(
    id: &str,
    waiting: &[(&str, Option<&str>, Option<&str>)],
    findings: &[&str],
    begins: &str,
) -> Record {
    let items: Vec<_> = waiting
        .iter()
        .map(|(item, group, hash)| {
            json!({"id": item, "earned": 0.5, "possible": 2, "verdict": "partly", "code": "concepts.missing", "provisional": true,
                "alike": group, "answer": hash, "evidence": {"expected": "", "found": "", "reason": "", "conflicts": []}, "line": null,
                "column": null, "diagnosis": null, "follow_through": null,
                "review": {"why": "prose is judged by its words only", "words": "", "answer": begins}})
        })
        .collect();
    let findings: Vec<_> = findings
        .iter()
        .map(|code| json!({"severity": "warning", "code": code, "message": "why", "line": null, "column": null}))
        .collect();
    let given = if id == "done" { json!(5) } else { json!(null) };
    let text = json!({"submission": id, "file": format!("{id}.yaml"), "students": [{"id": id, "name": "=A\n# B"}],
        "total": {"earned": 1, "possible": 3, "provisional": 1}, "items": items, "ledger": {"lost": [], "spared": []}, "findings": findings,
        "observed": [{"id": "care", "earned": given, "possible": 5}],
        "cover": [{"id": "lab", "earned": null, "possible": 65}, {"id": "viva", "earned": given, "possible": 35}], "report": "r"});
    Record::from_line(&text.to_string()).unwrap()
}

fn stub(records: &[Record]) -> MarksStub {
    let mut stub = MarksStub::new(lab());
    records.iter().for_each(|record| stub.add(record));
    stub
}

const HASH: &str = "0123456789abcdef";

fn class() -> MarksStub {
    stub(&[
        record(
            "EE-1",
            &[("q.one", Some("said-1"), Some(HASH)), ("q.two", None, None)],
            &[],
            "It \"swings\" # not",
        ),
        record("EE-2", &[("q.one", Some("said-1"), Some("fedcba9876543210"))], &[], "x"),
        record("done", &[], &[], ""),
        record("EE-3", &[("q.two", None, Some(HASH))], &["student.not_on_roster"], "y"),
        record("EE-1", &[("q.two", None, Some(HASH))], &["student.twice"], "z"),
    ])
}

#[test]
fn the_stub_asks_for_everything_that_waits() {
    let text = class().to_yaml();
    let node = source::parse(&text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    assert_eq!(node.get("lab").and_then(source::Node::as_scalar), Some("a-lab"));
    let at = |path: &[&str]| path.iter().try_fold(&node, |node, key| node.get(key));
    for (path, hash) in [
        (&["students", "EE-1", "viva"][..], None),
        (&["students", "EE-1", "observed", "care"], None),
        (&["students", "EE-1", "items", "q.two", "points"], None),
        (&["students", "EE-1", "items", "q.two", "answer"], Some("none")),
        (&["students", "EE-1", "counts"], None),
        (&["students", "EE-2", "viva"], None),
        (&["alike", "q.one", "said-1", "reason"], None),
        (&["files", "EE-3.yaml", "is"], None),
    ] {
        let found = at(path).unwrap_or_else(|| panic!("{path:?} in\n{text}"));
        assert_eq!(found.as_scalar(), hash, "{path:?}");
    }
    let answers =
        at(&["alike", "q.one", "said-1", "answer"]).and_then(source::Node::as_sequence).map(<[_]>::len);
    assert_eq!(answers, Some(2));
    assert!(at(&["students", "done"]).is_none() && at(&["students", "EE-3"]).is_none(), "{text}");
    assert!(text.contains("#     3–4  Good: with help"), "{text}");
    assert!(text.contains("# polemark gave 0.5 of 2: prose is judged"), "{text}");
    assert!(stub(&[record("done", &[], &[], "")]).is_empty());
}

#[test]
fn only_points_that_polemark_gave_to_all_of_a_group_are_suggested() {
    let group = |id: &str| record(id, &[("q.one", Some("said-1"), Some("3f2a91c05be7d410"))], &[], "Word.");
    let alone = |id: &str| record(id, &[("q.two", None, None)], &[], "Word.");
    let changed = |mut record: Record, change: fn(&mut ItemRecord)| {
        record.items.iter_mut().for_each(change);
        record
    };
    let decided = |item: &mut ItemRecord| item.review.iter_mut().for_each(|review| review.decided = true);
    let (given, nothing) = (Some(" 0.5\n"), None);
    for (what, records, wanted) in [
        ("a group", vec![group("EE-1"), group("EE-2")], given),
        (
            "of which one got more",
            vec![group("EE-1"), changed(group("EE-2"), |item| item.earned = Points(100))],
            nothing,
        ),
        (
            "of which one got more, and comes first",
            vec![changed(group("EE-2"), |item| item.earned = Points(100)), group("EE-1")],
            nothing,
        ),
        ("one alone", vec![alone("EE-1")], given),
        ("not judged", vec![changed(alone("EE-1"), |item| item.verdict = "unmarked".to_owned())], nothing),
        ("decided for another answer", vec![changed(alone("EE-1"), decided)], nothing),
    ] {
        let yaml = stub(&records).with_suggestions(true).to_yaml();
        let points = yaml.split_once(" points:").map(|(_, rest)| rest).unwrap_or_default();
        assert!(points.starts_with(wanted.unwrap_or("\n")), "{what}: {yaml}");
        assert_eq!(yaml.contains("reason: confirmed"), wanted.is_some(), "{what}: {yaml}");
        // A viva is nobody's to suggest.
        assert!(yaml.contains("viva: # of 35"), "{what}: {yaml}");
        let table = appended(b"", &stub(&records).with_suggestions(true)).unwrap().0;
        let table = String::from_utf8(table).unwrap();
        assert_eq!(table.contains(",0.5,confirmed,"), wanted.is_some(), "{what}: {table}");
        assert!(!stub(&records).to_yaml().contains("confirmed"), "{what}: nothing is filled in unasked");
    }
}

#[test]
fn a_table_gets_only_the_rows_that_are_not_there() {
    let stub = class();
    let (first, added) = appended(b"", &stub).unwrap();
    let text = String::from_utf8(first.clone()).unwrap();
    assert_eq!((added, text.lines().count()), (8, 9), "{text}");
    assert!(text.starts_with("\u{feff}student_id,item,"), "{text}");
    assert!(text.contains("'=A") && !text.contains(",=A"), "{text}");
    let (again, added) = appended(&first, &stub).unwrap();
    assert_eq!((again == first, added), (true, 0));
    // A person's own columns, separator, order and line ends stay, and so does every byte.
    for before in [
        "\u{feff}Points;item;Student ID;mine;group;reason;answer\r\n30;viva;EE-1;\"a; note\"\r\n;is;;;;;EE-3.yaml\r\n".to_owned(),
        "item,points,student_id,answer,group,reason\nviva,,EE-1".to_owned(),
        text.replace("EE-1,viva,,,", "EE-1,viva,,30,"),
    ] {
        let (after, added) = appended(before.as_bytes(), &stub).unwrap();
        assert!(after.starts_with(before.as_bytes()), "{before}");
        let after = String::from_utf8(after).unwrap();
        let asked = after.lines().filter(|line| line.split([',', ';']).any(|cell| cell == "viva")).count();
        assert!(asked == 2 && added < 8, "{after}");
        assert_eq!(appended(after.as_bytes(), &stub).unwrap().1, 0, "{after}");
    }
    for (before, error) in [
        (&b"a,b\n1,2\n"[..], "must have the columns"),
        (b"\xff\xfei\0,\0", "not in UTF-8"),
        (b"item,points\n\xff\n", "not text in UTF-8"),
        (
            b"student_id,item,group,points,reason,answer\nA,viva,,3,\"x,\n",
            "since line 2 is not CSV: a quote is not closed",
        ),
    ] {
        let said = appended(before, &stub).unwrap_err().to_string();
        assert!(said.contains(error), "{said}");
    }
}

proptest! {
    #[test]
    fn whatever_a_student_writes_stays_text(text in "\\PC{0,20}|[\\x00-\\xff\u{2028}\u{feff}:#'\"\\[{&*!|>%@`\\-? ]{0,20}") {
        prop_assume!(!text.contains('\0'));
        let yaml = format!("key: {}\n", quoted(&text));
        let node = source::parse(&yaml).map_err(|error| TestCaseError::fail(format!("{error}: {yaml:?}")))?;
        prop_assert_eq!(node.get("key").and_then(source::Node::as_scalar), Some(text.as_str()), "{}", yaml);
        let hostile = record("EE-1", &[("q.two", None, Some(HASH))], &[], &text);
        let whole = stub(&[hostile]).to_yaml();
        let node = source::parse(&whole).map_err(|error| TestCaseError::fail(format!("{error}: {whole:?}")))?;
        prop_assert_eq!(node.as_mapping().map(<[_]>::len), Some(2), "{}", whole);
    }
}
