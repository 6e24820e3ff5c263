use super::*;
use crate::lab;

fn parse(text: &str) -> (HandMarksFile, Vec<String>) {
    parse_as("marks.yaml", text)
}

fn parse_as(name: &str, text: &str) -> (HandMarksFile, Vec<String>) {
    let lab = lab::load(lab::DEFAULT).unwrap();
    let source = SourceText::new(name, text);
    let (file, findings) = HandMarksFile::parse(&source, &lab);
    let shown = findings
        .iter()
        .map(|finding| {
            let at = finding.span.map_or_else(String::new, |span| {
                let position = source.position(span.start);
                format!("{}:{} ", position.line, position.column)
            });
            let help = finding.help.as_deref().unwrap_or_default();
            format!("{at}{} {} {help}", finding.code, finding.message)
        })
        .collect();
    (file, shown)
}

#[test]
fn everything_a_person_gives() {
    let (file, findings) = parse(
        "lab: ee361-lab3\nstudents:\n  EE-001:\n    viva: 30\n    observed: {realization: 4, teamwork: 4.5}\n    items:\n      \
         hanging.transfer_function.denominator: {points: 1.5, reason: \"slip in the last step\"}\n  EE-002:\n",
    );
    assert!(findings.is_empty(), "{findings:?}");
    assert_eq!(file.student_ids().collect::<Vec<_>>(), ["EE-001", "EE-002"]);
    let marks = file.student("EE-001").unwrap();
    assert_eq!(marks.cover["viva"], Points(3000));
    assert_eq!((marks.observed["realization"], marks.observed["teamwork"]), (Points(400), Points(450)));
    let item = &marks.items["hanging.transfer_function.denominator"][0];
    assert_eq!((item.points, item.reason.as_str()), (Points(150), "slip in the last step"));
    assert_eq!(file.student("EE-002"), Some(&HandMarks::default()));
    assert_eq!(file.student("EE-003"), None);
}

#[track_caller]
fn check(rows: &[(&str, &str)]) {
    check_as("marks.yaml", rows);
}

#[track_caller]
fn check_as(name: &str, rows: &[(&str, &str)]) {
    for (text, want) in rows {
        let (_, findings) = parse_as(name, text);
        assert_eq!(findings.len(), 1, "{text:?}: {findings:#?}");
        assert!(findings[0].starts_with(want), "{text:?}: {}", findings[0]);
    }
}

#[test]
fn what_does_not_fit_is_said_and_where() {
    check(&[
        ("lab: ee361-lab4", "1:6 marks.lab These marks are for `ee361-lab4`, not for `ee361-lab3`."),
        ("student: {}", "1:1 marks.unknown There is no key `student`. Did you mean `students`?"),
        ("students: [1]", "1:11 marks.shape "),
        ("students: {A: {vivva: 3}}", "1:16 marks.unknown There is no key `vivva`. Did you mean `viva`?"),
        (
            "students: {A: {observed: {team_work: 3}}}",
            "1:27 marks.unknown There is no row of the observation sheet `team_work`. Did you mean `teamwork`?",
        ),
        (
            "students: {A: {items: {battery.nonlinearity.clas: {points: 1, reason: x}}}}",
            "1:24 marks.unknown There is no criterion `battery.nonlinearity.clas`. Did you mean \
             `battery.nonlinearity.class`?",
        ),
        (
            "students: {A: {viva: 36}}",
            "1:22 marks.points_out_of_range 36 points for `viva` are not between 0 and 35.",
        ),
        ("students: {A: {viva: -1}}", "1:22 marks.points_out_of_range "),
        ("students: {A: {viva: many}}", "1:22 marks.points_unreadable `many`"),
        ("students: {A: {viva: 1.005}}", "1:22 marks.points_unreadable "),
        ("students: {A: {viva: 1e300}}", "1:22 marks.points_unreadable "),
        ("students: {A: {viva: [1]}}", "1:22 marks.points_unreadable "),
        ("students: {A: {items: {battery.nonlinearity.class: {points: 1}}}}", "1:24 marks.reason_missing "),
        (
            "students: {A: {items: {battery.nonlinearity.class: {points: 1, reason: '  '}}}}",
            "1:24 marks.reason_missing ",
        ),
        ("students: {A: {items: {battery.nonlinearity.class: {reason: x}}}}", "1:24 marks.points_missing "),
        ("students: {A: {items: {battery.nonlinearity.class: 1}}}", "1:52 marks.shape "),
        ("alike: [1]", "1:8 marks.shape "),
        (
            "alike: {expect_hanging.settle: {}}",
            "1:9 marks.unknown There is no criterion `expect_hanging.settle`. Did you mean `expect_hanging.settles`?",
        ),
        ("alike: {expect_hanging.settles: 1}", "1:33 marks.shape Under a criterion stand groups"),
        ("alike: {expect_hanging.settles: {text-1: 1}}", "1:42 marks.shape A criterion takes"),
        (
            "alike: {expect_hanging.settles: {text-1: {points: 2, reason: x}}}",
            "1:51 marks.points_out_of_range 2 points for `expect_hanging.settles/text-1` are not between 0 and 1.",
        ),
        ("alike: {expect_hanging.settles: {text-1: {points: 1}}}", "1:34 marks.reason_missing "),
        ("alike: {expect_hanging.settles: {text-1: {reason: x}}}", "1:34 marks.points_missing "),
        ("students: {A: {viva: 1}", "1:"),
        (
            "students: {EE-1: {viva: 1}, ee 1: {viva: 2}}",
            "1:29 marks.twice `ee 1`, who is also `EE-1`, has marks twice.",
        ),
        ("late: 5", "1:7 marks.shape What it costs"),
        ("late: {points: 5, percent: 10}", "1:7 marks.shape `late` takes points or a percentage"),
        ("late: {percent: 110}", "1:17 marks.points_out_of_range "),
        ("late: {pionts: 5}", "1:8 marks.unknown There is no key `pionts`. Did you mean `points`?"),
        ("files: {a.yaml: {is: {}}}", "1:22 marks.shape Whose `a.yaml` is"),
        ("files: {a.yaml: {was: EE-1}}", "1:18 marks.unknown "),
        ("students: {A: {adjustments: {points: -5}}}", "1:29 marks.shape `adjustments` is a list"),
        ("students: {A: {adjustments: [{points: -500, reason: x}]}}", "1:39 marks.points_out_of_range "),
        ("students: {A: {adjustments: [{points: -5}]}}", "1:30 marks.reason_missing "),
        ("students: {A: {counts: [a]}}", "1:24 marks.shape "),
        ("students: {A: {late: perhaps}}", "1:22 marks.shape "),
        (
            "students: {A: {items: {battery.nonlinearity.class: {points: 1, reason: x, answer: abc}}}}",
            "1:83 marks.answer_unreadable `abc`",
        ),
    ]);
}

#[test]
fn a_bad_mark_does_not_take_the_others_with_it() {
    let (file, findings) = parse("students: {A: {viva: 99, observed: {safety: 3, teamwork: 6}}}");
    assert_eq!(findings.len(), 2);
    let marks = file.student("A").unwrap();
    assert_eq!((marks.cover.len(), marks.observed.len(), marks.observed["safety"]), (0, 1, Points(300)));
}

#[test]
fn what_settles_and_what_adjusts() {
    let (file, findings) = parse(
        "late: {percent: 12.5}\nfiles: {a/b.yaml: {is: EE-001}, c.yaml: {is: [EE-002, EE-003]}, d.yaml: {is: }, e.yaml: }\n\
         students:\n  EE-001:\n    counts: a/b.yaml\n    late: false\n    adjustments:\n      - {points: -5, reason: untidy}\n      - {points: \
         2.5, reason: helped}\nalike:\n  expect_hanging.settles:\n    text-1: {points: 1, reason: x, answer: [3F2A91C05BE7D410, none]}\n",
    );
    assert!(findings.is_empty(), "{findings:?}");
    assert_eq!(file.whose("a/b.yaml"), Some(["EE-001".to_owned()].as_slice()));
    assert_eq!(file.whose("c.yaml").map(<[String]>::len), Some(2));
    assert_eq!((file.whose("d.yaml"), file.whose("e.yaml")), (None, None));
    assert_eq!((file.counts_for("ee 001"), file.counts_for("EE-002")), (Some("a/b.yaml"), None));
    let marks = file.student("EE-001").unwrap();
    assert_eq!(marks.late, Some(false));
    let by: Vec<_> = marks.adjustments.iter().map(|one| (one.points, one.reason.as_str())).collect();
    assert_eq!(by, [(Some(Points(-500)), "untidy"), (Some(Points(250)), "helped")]);
    let rule = LateRule {
        cost: LateCost::Percent(Points(1250)),
        reason: "handed in late: 12.5 % of what was earned".to_owned(),
    };
    assert_eq!(
        (marks.late_rule.as_ref(), file.marks_for("?").late_rule.as_ref()),
        (Some(&rule), Some(&rule))
    );
    let decided = &file.alike()["expect_hanging.settles"]["text-1"][0];
    assert_eq!(decided.answers, ["3f2a91c05be7d410", "none"]);
    let names = ["c.yaml", "d.yaml"].into();
    let absent: Vec<_> =
        file.files_not_there(&names).into_iter().map(|(_, finding)| finding.message).collect();
    assert_eq!(absent, ["No answer file of this class is called `a/b.yaml`."; 2]);
}

#[test]
fn what_is_left_empty_is_not_given_yet() {
    for text in [
        "students: {A: {viva: , observed: {safety: }, items: {battery.nonlinearity.class: {points: , reason: }}}}",
        "students: {A: {viva: null, items: {battery.nonlinearity.class: {points: ~, reason: \"\", answer: 3f2a91c05be7d410}}}}",
        "students: {A: {adjustments: [{points: , reason: x}], counts: , late: }}\nlate: {points: , reason: x}\nfiles: {a: {is: }}",
        "alike: {expect_hanging.settles: {text-1: {points: , reason: , answer: []}}}",
    ] {
        let (file, findings) = parse(text);
        assert!(findings.is_empty(), "{text}: {findings:?}");
        let marks = file.marks_for("A");
        assert_eq!(marks, &HandMarks::default(), "{text}");
        assert!(file.alike().is_empty());
    }
}

#[test]
fn a_table_says_the_same() {
    let (yaml, _) = parse(
        "late: {percent: 10}\nfiles: {b.yaml: {is: EE-002}}\nstudents:\n  EE-001:\n    viva: 30.5\n    observed: {safety: 4}\n    items: \
         {battery.nonlinearity.class: {points: 1, reason: \"a, \\\"b\\\"; c\", answer: 3f2a91c05be7d410}}\n    adjustments: [{points: -5, reason: \
         =x}]\n    counts: a.yaml\n    late: false\nalike: {expect_hanging.settles: {text-1: {points: 1, reason: x}}}\n",
    );
    for (name, head, points, separator) in
        [("marks.csv", "", "30.5", ","), ("MARKS.CSV", "\u{feff}", "30,5", ";")]
    {
        let row = |cells: [&str; 6]| cells.join(separator) + "\r\n";
        let text = [
            format!("{head}{}", row(["Student ID", "item", "group", "points", "reason", "answer"])),
            row(["EE-001", "viva", "", points, "", ""]),
            row(["EE-001", "observed.safety", "", "4", "", ""]),
            row(["EE-001", "observed.teamwork", "", "", "", ""]),
            row(["EE-001", "battery.nonlinearity.class", "", "1", "\"a, \"\"b\"\"; c\"", "3f2a91c05be7d410"]),
            row(["EE-001", "adjustment", "", "-5", "'=x", ""]),
            row(["EE-001", "counts", "", "", "", "a.yaml"]),
            row(["EE-001", "late", "", "no", "", ""]),
            row(["EE-002", "is", "", "", "", "b.yaml"]),
            row(["", "late", "", "10 %", "", ""]),
            row(["", "expect_hanging.settles", "text-1", "1", "x", ""]),
            row(["", "", "", "", "", ""]),
        ]
        .concat();
        let (table, findings) = parse_as(name, &text);
        assert!(findings.is_empty(), "{findings:?}");
        assert_eq!(table.students, yaml.students);
        assert_eq!(table.others, yaml.others);
        assert_eq!(table.whose("b.yaml"), yaml.whose("b.yaml"));
        assert_eq!(table.counts_for("EE-001"), Some("a.yaml"));
    }
}

#[test]
fn what_does_not_fit_in_a_table_is_said_and_where() {
    const HEAD: &str = "student_id,item,group,points,reason,answer\n";
    let row = |text: &str| format!("{HEAD}\n{text}\n");
    for (text, want) in [
        ("a,b\n".to_owned(), "1:1 marks.shape "),
        (row("EE-1,vivva,,3,,"), "3:1 marks.unknown There is no criterion `vivva`. Did you mean `viva`?"),
        (row("EE-1,viva,,36,,"), "3:1 marks.points_out_of_range "),
        (row("EE-1,viva,,many,,"), "3:1 marks.points_unreadable "),
        (
            row("EE-1,observed.team,,3,,"),
            "3:1 marks.unknown There is no row of the observation sheet `team`.",
        ),
        (row("EE-1,battery.nonlinearity.class,,1,,"), "3:1 marks.reason_missing "),
        (row("EE-1,battery.nonlinearity.class,,1,x,y"), "3:1 marks.answer_unreadable "),
        (row(",viva,,3,,"), "3:1 marks.shape Whose mark"),
        (row("EE-1,viva,,3,,\nEE-1,viva,,4,,"), "4:1 marks.twice "),
        (row("EE-1,late,,perhaps,,"), "3:1 marks.shape "),
        (row("EE-1,viva,,30,5,,"), "3:1 marks.csv This row has 7 cells, the first line has 6."),
        (
            row("EE-1,viva,,30,5,"),
            "3:1 marks.points_unreadable The points are `30` and the reason is only `5`.",
        ),
        (row("EE-1,battery.nonlinearity.class,,0,5"), "3:1 marks.points_unreadable The points are `0`"),
        ("student_id,item,points\nEE-1,viva,30,5\n".to_owned(), "2:1 marks.csv This row has 4 cells"),
        (
            row("EE-1,adjustment,,,-5 untidy,"),
            "3:1 marks.points_missing `adjustment` has a reason and no points",
        ),
        (row("EE-1,,,3,,"), "3:1 marks.shape What these points are for is missing."),
        (row("EE-1,viva,,3,,\nee 1,viva,,4,,"), "4:1 marks.twice "),
        (row("EE-1,viva,,3,\"ok,\nEE-2,viva,,4,,"), "3:14 marks.csv This quote is not closed"),
        (row("EE-1,viva,,3,\"ok,\nEE-2,viva,,4,\"fine\","), "3:14 marks.csv Behind the closing quote"),
        (
            row(
                "EE-1,battery.nonlinearity.class,,1,x,#3f2a91c05be7d410\nEE-1,battery.nonlinearity.class,,0,x,3F2A91C05BE7D410",
            ),
            "4:1 marks.twice ",
        ),
        (
            row(
                "EE-1,battery.nonlinearity.class,,1,x,#3f2a91c05be7d410\nEE-1,battery.nonlinearity.class,,0,x,",
            ),
            "4:1 marks.twice ",
        ),
    ] {
        check_as("marks.csv", &[(&text, want)]);
    }
}

#[test]
fn the_examples_of_the_manual_are_read() {
    let manual = include_str!("../../../docs/marks.md");
    for (language, name) in [("yaml", "marks.yaml"), ("csv", "marks.csv")] {
        let (_, block) = manual.split_once(&format!("```{language}\n")).unwrap();
        let (text, _) = block.split_once("```").unwrap();
        let (file, findings) = parse_as(name, text);
        assert!(findings.is_empty(), "{name}: {findings:?}");
        assert_eq!(file.marks_for("EE-001").adjustments.len(), 1, "{name}");
        assert_eq!(file.whose("upload.yaml"), Some(["EE-007".to_owned()].as_slice()), "{name}");
    }
}

#[test]
fn a_student_is_known_however_the_id_is_spelled() {
    let (file, findings) = parse("students: {ee 001: {viva: 30}, ---: {viva: 3}}");
    assert!(findings.is_empty(), "{findings:?}");
    for id in ["EE-001", "ee001", "ee 001"] {
        assert_eq!(file.marks_for(id).cover.get("viva"), Some(&Points(3000)), "{id}");
    }
    assert_eq!(file.marks_for("---").cover["viva"], Points(300));
    assert!(file.marks_for("--").cover.is_empty());
    assert_eq!(file.student_ids().collect::<Vec<_>>(), ["---", "ee 001"]);
}

#[test]
fn of_several_decisions_the_one_for_this_answer_counts() {
    let rows = "EE-1,battery.nonlinearity.class,,0.25,old,#1111111111111111\nEE-1,battery.nonlinearity.class,,0.75,new,#2222222222222222 \
                #3333333333333333\n,expect_hanging.settles,text-1,0.25,old,#1111111111111111\n,expect_hanging.settles,text-1,0.75,new,#1111111111111111 \
                #2222222222222222\n";
    let rows = format!(
        "{rows}EE-1,dead_zone.plot,,0.25,own,#2222222222222222\n,dead_zone.plot,text-1,0.75,group,#1111111111111111\n\
         EE-1,saturation.plot,,0.25,own,#2222222222222222\n,saturation.plot,text-1,0.75,group,\n"
    );
    let (file, findings) =
        parse_as("marks.csv", &format!("student_id,item,group,points,reason,answer\n{rows}"));
    assert!(findings.is_empty(), "{findings:?}");
    let check = |criterion: &str, answer: &str, want: (&str, i64)| {
        let hash = || Some(answer.repeat(16));
        let given = file.marks_for("EE-1").given(criterion, Points(100), Some("text-1"), &hash).unwrap();
        let found = match given {
            Given::Applies(given) => ("applies", given.points.0),
            Given::Held(given) => ("held", given.points.0),
        };
        assert_eq!(found, want, "{criterion} {answer}");
    };
    check("battery.nonlinearity.class", "1", ("applies", 25));
    check("battery.nonlinearity.class", "3", ("applies", 75));
    check("battery.nonlinearity.class", "4", ("held", 75));
    check("expect_hanging.settles", "1", ("applies", 75));
    check("expect_hanging.settles", "4", ("held", 75));
    check("dead_zone.plot", "2", ("applies", 25));
    check("dead_zone.plot", "1", ("applies", 75));
    check("dead_zone.plot", "3", ("held", 25));
    check("saturation.plot", "2", ("applies", 25));
    check("saturation.plot", "1", ("held", 25));
}

#[track_caller]
fn merge(files: &[(&str, &str)]) -> (HandMarksFile, Vec<String>) {
    let read = files.iter().map(|(name, text)| {
        let (file, findings) = parse_as(name, text);
        assert!(findings.is_empty(), "{findings:?}");
        file
    });
    let (file, found) = HandMarksFile::merged(read.collect());
    let place = |said: &Said| {
        let (name, text) = files[said.file];
        let position = SourceText::new(name, text).position(said.span.start);
        format!("{name}:{}:{}", position.line, position.column)
    };
    (
        file,
        found
            .iter()
            .map(|one| format!("{} {} {}", one.what, place(&one.places[0]), place(&one.places[1])))
            .collect(),
    )
}

const TABLE: &str = "student_id,item,group,points,reason,answer\n";

#[test]
fn marks_files_are_put_together() {
    let yaml = "late: {points: 5}\nfiles: {a.yaml: {is: EE-9}}\nstudents:\n  EE-1:\n    viva: 30\n    adjustments: [{points: -5, reason: untidy}]\n    items: \
                {battery.nonlinearity.class: {points: 1, reason: x, answer: 1111111111111111}}\n  EE-2: {observed: {safety: 3}}\n";
    let table = format!(
        "{TABLE}ee1,viva,,30,,\nEE-1,observed.safety,,4,,\nEE-1,adjustment,,-5,untidy,\nEE-1,adjustment,,2,helped,\n\
         EE-1,battery.nonlinearity.class,,0,y,#2222222222222222\n,late,,5,,\n,expect_hanging.settles,text-1,1,x,\nEE-3,viva,,1,,\n"
    );
    let (file, found) = merge(&[("a.yaml", yaml), ("b.csv", &table), ("again.yaml", yaml)]);
    assert_eq!(found, [""; 0]);
    assert_eq!(file.student_ids().collect::<Vec<_>>(), ["EE-1", "EE-2", "EE-3"]);
    let one = file.marks_for("EE-1");
    assert_eq!((one.cover["viva"], one.observed["safety"]), (Points(3000), Points(400)));
    let by: Vec<_> = one.adjustments.iter().map(|one| one.points).collect();
    assert_eq!(by, [Some(Points(-500)), Some(Points(200))]);
    assert_eq!(one.items["battery.nonlinearity.class"].len(), 2);
    assert!(file.marks_for("EE-2").alike["expect_hanging.settles"].contains_key("text-1"));
    assert!(file.marks_for("EE-3").late_rule.is_some() && file.whose("a.yaml").is_some());
    let absent = file.decisions_without_answers(&BTreeSet::new());
    assert_eq!(absent.iter().map(|(file, _)| *file).collect::<Vec<_>>(), [1]);
}

#[test]
fn marks_files_that_contradict_each_other_are_refused() {
    for (one, two, want) in [
        (
            "students: {EE-1: {viva: 30}}",
            "ee 1,viva,,20,,",
            "`viva` of `ee 1` is 30 and 20 a.yaml:1:19 b.csv:2:1",
        ),
        (
            "students: {A: {observed: {safety: 3}}}",
            "A,observed.safety,,4,,",
            "`observed.safety` of `A` is 3 and 4 a.yaml:1:27 b.csv:2:1",
        ),
        (
            "students: {A: {items: {battery.nonlinearity.class: {points: 1, reason: x}}}}",
            "A,battery.nonlinearity.class,,1,y,#1111111111111111",
            "`battery.nonlinearity.class` of `A` is 1 (x) and 1 (y) a.yaml:1:24 b.csv:2:1",
        ),
        (
            "alike: {expect_hanging.settles: {text-1: {points: 1, reason: x}}}",
            ",expect_hanging.settles,text-1,0,x,",
            "The group `text-1` of `expect_hanging.settles` is given 1 (x) and 0 (x) a.yaml:1:34 b.csv:2:1",
        ),
        ("students: {A: {late: true}}", "A,late,,no,,", "`A` is late and not late a.yaml:1:16 b.csv:2:1"),
        ("late: {points: 5}", ",late,,10 %,,", "What it costs to hand in late differs a.yaml:1:1 b.csv:2:1"),
        ("files: {x.yaml: {is: A}}", "B,is,,,,x.yaml", "`x.yaml` is of `A` and of `B` a.yaml:1:9 b.csv:2:1"),
        (
            "students: {A: {counts: x}}",
            "A,counts,,,,y",
            "Of the files of one student `x` counts and `y` a.yaml:1:24 b.csv:2:1",
        ),
    ] {
        let (_, found) = merge(&[("a.yaml", one), ("b.csv", &format!("{TABLE}{two}\n"))]);
        assert_eq!(found, [want], "{one} {two}");
    }
}
