//! Whole pages: well-formed, harmless, the same every time.

use super::*;
use crate::algebra::{Polynomial, parse_decimal};
use crate::grading::{Catalogue, Scorecard, grade};
use crate::lab::{self, Criterion, LabDefinition, Points};
use crate::lti::{InputKind, Response, TransferFunction};
use crate::reference::Reference;
use crate::report::figures::{PreparedResponse, StudentCurves};
use crate::source::{Finding, SourceText, Span};
use crate::submission::{self, Answer, AnswerValue, NoFiles, Student, Submission};
use std::collections::BTreeSet;
use std::sync::LazyLock;

pub(super) struct Fixture {
    pub lab: LabDefinition,
    pub reference: Reference,
    pub catalogue: Catalogue,
    pub kit: ReportKit,
}

pub(super) static FIXTURE: LazyLock<Fixture> = LazyLock::new(|| {
    let lab = lab::load(lab::DEFAULT).expect("the embedded lab reads");
    let reference = Reference::compute(&lab).expect("the embedded lab computes");
    let kit = ReportKit::new(&lab, &reference).expect("its figures can be drawn");
    let catalogue = Catalogue::new(&lab, &reference);
    Fixture { lab, reference, catalogue, kit }
});

fn page(submission: &Submission) -> (Scorecard, String) {
    let scorecard = grade(&FIXTURE.lab, &FIXTURE.reference, &FIXTURE.catalogue, submission, None);
    let page = FIXTURE.kit.student_page(submission, &scorecard);
    (scorecard, page)
}

pub(super) fn read(yaml: &str) -> Submission {
    submission::read("s", "s.yaml", yaml.as_bytes(), &FIXTURE.lab.sheet, &NoFiles)
}

pub(super) const HOSTILE: [&str; 12] = [
    "<script>alert(1)</script>",
    "</style><style>*{display:none}</style>",
    "\" onload=\"alert(1)",
    "' onmouseover='alert(1)",
    "[x](javascript:alert(1)) <a href=javascript:alert(1)>x</a>",
    "$\\text{</math><img src=x onerror=alert(1)>}$ $\\operatorname{<b onclick=x>}$",
    "<math><mtext><table><mglyph><style><!--</style><img src onerror=alert(1)>",
    "<svg><animate onbegin=alert(1)></svg> <iframe src=//e.org></iframe>",
    "{{ version }} {% raw %} {# x #}",
    "</title></head><body onload=alert(1)>",
    "![x](https://e.org/track.png) <img src=https://e.org/t.png>",
    "\u{202e}gnp.exe \u{1b}[31m\u{0}",
];

/// A submission whose every text is hostile.
fn hostile(text: &str) -> Submission {
    let source = SourceText::new(format!("{text}.yaml"), format!("a: {text}\nb: {text}"));
    let finding =
        Finding::error("poles.unreadable", text).with_help(text).at(Span { start: 3, end: 3 + text.len() });
    let prose = |path: &str| Answer {
        path: path.to_owned(),
        span: Span::default(),
        text: text.to_owned(),
        value: Ok(AnswerValue::Prose(text.to_owned())),
    };
    let picture = submission::Figure {
        file_name: format!("{text}.png"),
        media_type: "image/png",
        bytes: vec![1, 2, 3],
        width: 3,
        height: 2,
    };
    let data = submission::Series {
        file_name: text.to_owned(),
        headers: vec![text.to_owned(), text.to_owned(), text.to_owned()],
        rows: (0..20).map(|i| vec![f64::from(i), 1e300 * f64::from(i), -1.0]).collect(),
    };
    let mut answers = std::collections::BTreeMap::new();
    for field in &FIXTURE.lab.sheet.fields {
        let mut answer = prose(&field.path);
        match field.kind {
            submission::FieldKind::Prose => {}
            submission::FieldKind::Figure => answer.value = Ok(AnswerValue::Figure(picture.clone())),
            submission::FieldKind::Data => answer.value = Ok(AnswerValue::Data(data.clone())),
            _ => answer.value = Err(submission::Unreadable { finding: finding.clone() }),
        }
        answers.insert(field.path.clone(), answer);
    }
    Submission {
        id: "hostile".into(),
        source,
        lab: None,
        students: vec![Student { id: text.into(), name: text.into() }],
        answers,
        findings: vec![finding],
        readable: true,
    }
}

/// Every start tag as (name, attributes with values); text is skipped.
fn tags(html: &str) -> Vec<(String, Vec<(String, String)>)> {
    let mut found = Vec::new();
    let mut rest = html;
    while let Some(open) = rest.find('<') {
        rest = &rest[open + 1..];
        let mut quoted = false;
        let close = rest
            .find(|c| {
                quoted ^= c == '"';
                c == '>' && !quoted
            })
            .expect("every tag is closed");
        let (tag, after) = rest.split_at(close);
        rest = &after[1..];
        if tag.starts_with(['/', '!']) {
            continue;
        }
        let tag = tag.trim_end_matches('/');
        let (name, mut inner) = tag.split_once(' ').unwrap_or((tag, ""));
        let mut attributes = Vec::new();
        while !inner.trim().is_empty() {
            let (attribute, value) = inner.split_once("=\"").unwrap_or((inner.trim(), "\""));
            let (value, more) = value.split_once('"').expect("values are quoted");
            for bare in attribute.split_whitespace() {
                attributes.push((bare.to_owned(), value.to_owned()));
            }
            inner = more;
        }
        if name == "script" {
            let fixed = super::class_page::TABLES_SCRIPT;
            rest = rest.strip_prefix(fixed).expect("the script is the one that is allowed");
        }
        if name == "style" {
            rest = &rest[rest.find("</style>").expect("the style sheet ends")..];
        }
        found.push((name.to_owned(), attributes));
    }
    found
}

#[track_caller]
pub(super) fn check_page(what: &str, html: &str) {
    const ELEMENTS: &str = "html head meta title style body a header main section footer nav h1 h2 h3 p dl div dt dd \
        table caption thead tbody tfoot tr th td span strong em del code pre ol ul li q mark figure figcaption img br hr \
        blockquote sup details summary script svg desc path text math mrow mi mn mo mtext mspace mfrac msqrt mroot msup msub \
        msubsup munder mover munderover mtable mtr mtd mpadded mphantom mstyle";
    const ATTRIBUTES: &str = "lang charset name content http-equiv class href id aria-labelledby aria-label aria-hidden \
        role scope colspan value style viewBox d x y alt width height src display accent stretchy mathvariant symmetric \
        fence separator lspace rspace minsize maxsize movablelimits largeop form accentunder linethickness rel open \
        start displaystyle scriptlevel columnspan rowspan depth";
    let (elements, attributes): (BTreeSet<_>, BTreeSet<_>) =
        (ELEMENTS.split_whitespace().collect(), ATTRIBUTES.split_whitespace().collect());
    assert!(html.starts_with("<!doctype html>") && html.trim_end().ends_with("</html>"), "{what}: not whole");
    assert!(!html.contains("could not write"), "{what}: a template failed: {html}");
    let (mut ids, mut links) = (BTreeSet::new(), Vec::new());
    for (name, list) in tags(html) {
        assert!(elements.contains(name.as_str()), "{what}: <{name}>");
        for (attribute, value) in list {
            assert!(attributes.contains(attribute.as_str()), "{what}: <{name} {attribute}=\"{value}\">");
            match (name.as_str(), attribute.as_str()) {
                ("a", "href") => links.push(value.replace("&#x2f;", "/")),
                (_, "href") => panic!("{what}: <{name} href>"),
                (_, "src") => assert!(value.starts_with("data:image/"), "{what}: src {value}"),
                (_, "style") => assert!(value.starts_with("width:"), "{what}: style {value}"),
                (_, "id") => assert!(ids.insert(value.clone()), "{what}: id {value} twice"),
                _ => {}
            }
        }
    }
    for link in links {
        let harmless =
            ["https://", "http://", "mailto:", "reports/", "instructor/"].iter().any(|s| link.starts_with(s));
        match link.strip_prefix('#') {
            Some(target) => assert!(ids.contains(target), "{what}: nothing at #{target}"),
            None => assert!(harmless, "{what}: link to {link}"),
        }
    }
    for word in ["NaN", ">inf", "-inf", "undefined", "not a number"] {
        assert!(!html.contains(word), "{what}: {word}");
    }
}

#[test]
fn pages_of_all_kinds_are_whole() {
    let (card, full) = page(&FIXTURE.lab.model_answer);
    assert_eq!(card.total.earned, card.total.possible);
    check_page("model answer", &full);
    check_page("blank", &page(&read("lab: ee361-lab3\n")).1);
    check_page("not YAML", &page(&read("lab: [\n  :")).1);
    check_page("reference", &FIXTURE.kit.reference_page());
    check_page("empty class", &FIXTURE.kit.class_page(&ClassSummary::default()));
}

#[test]
fn linear_models_given_in_letters_are_derived_in_the_key() {
    let source = SourceText::new("linear.yaml", include_str!("../../tests/it/linear.yaml"));
    let lab = LabDefinition::parse(source).expect("the lab reads");
    let reference = Reference::compute(&lab).expect("the lab computes");
    let page = ReportKit::new(&lab, &reference).expect("its figures can be drawn").reference_page();
    check_page("linear models", &page);
    let count = |heading: &str| page.matches(heading).count();
    assert!(count("<h3>In letters, from ") >= 3);
    // Steps from equations: of a state space with letters, but not of its channel without any.
    assert_eq!(count("<h3>Laplace transform</h3>"), 1);
    assert_eq!(count("<h3>Linearized equations</h3>"), 0);
}

#[test]
fn hostile_text_stays_text() {
    for text in HOSTILE {
        check_page(text, &page(&hostile(text)).1);
    }
    let (_, all) = page(&hostile(&HOSTILE.join(" ")));
    check_page("all at once", &all);
    assert!(!all.contains('\u{1b}') && !all.contains('\u{202e}') && !all.contains('\u{0}'));
    for deep in ["[".repeat(30_000), "> ".repeat(9_000), format!("${}$", "{".repeat(9_000))] {
        check_page("nested", &page(&hostile(&deep)).1);
    }
}

#[test]
fn extreme_answers_still_give_a_page() {
    for g in [
        "1e300/(1e-300*s + 1)",
        "s^5/(s + 1)",
        "0*s/(s + 1)",
        "1/(s - 1e9)",
        "1/(s^2 + 1e12)",
        "1e-9/(s^2 - 1e-9)",
        "1/(s + 1)^9",
        "7",
    ] {
        let yaml = format!(
            "answers:\n  hanging.transfer_function: {g}\n  hanging.response:\n    poles: [1e300, -1e-300 ± 1e9j]\n"
        );
        check_page(g, &page(&read(&yaml)).1);
    }
}

#[test]
fn the_same_answers_give_the_same_bytes() {
    let again = ReportKit::new(&FIXTURE.lab, &FIXTURE.reference).unwrap();
    let submission = &FIXTURE.lab.model_answer;
    let (card, first) = page(submission);
    assert_eq!(first, again.student_page(submission, &card));
    assert_eq!(FIXTURE.kit.reference_page(), again.reference_page());
}

#[test]
fn a_report_is_light() {
    let (_, full) = page(&FIXTURE.lab.model_answer);
    let pictures: usize = full.split("data:image").skip(1).map(|p| p.find('"').unwrap_or(0)).sum();
    assert!(full.len() - pictures < 250_000, "{} bytes", full.len());
    let largest = full.split("<svg").skip(1).filter_map(|p| p.find("</svg>")).max();
    assert!(largest < Some(12_000), "{largest:?} bytes in one figure");
}

#[test]
fn a_wrong_system_is_drawn_over_the_right_one_and_the_caption_says_where_it_leaves() {
    let point = &FIXTURE.reference.models[0].operating_points[0];
    let decimals = |t: &str| Polynomial::new(t.split(' ').map(|c| parse_decimal(c).unwrap()).collect());
    let unstable =
        TransferFunction::new(decimals("0.06 0"), decimals("-0.0132 -0.0024 0.4166 0.0588")).unwrap();
    let response = Response::new(&unstable, InputKind::Impulse).unwrap();
    let prepared = PreparedResponse::new(point, point.main().impulse.as_ref().unwrap());
    let own = prepared.own_curves(&response);
    let figures = prepared.figures(StudentCurves { own: Some(&own), data: None });
    assert_eq!(figures.len(), 2, "a long lightly damped decay is shown near and far");
    let near = &figures[0];
    assert_eq!(near.title, "Hanging straight down: impulse response, first 7.9\u{a0}s");
    let names: Vec<_> = near.series.iter().map(|s| s.name.as_str()).collect();
    assert_eq!(names, ["reference", "your transfer function"]);
    assert!(near.caption.starts_with("The curve of your transfer function leaves the picture at t = 0.2"));
    let alone = own.alone.expect("it leaves at once");
    assert!(alone.check().is_ok() && alone.caption.starts_with("It leaves to one side, ever faster"));
    assert!(alone.x.to < 2.0 && alone.series[0].points.len() < 100, "{} s", alone.x.to);
    assert!((near.y.to - 0.96).abs() < 0.05 && near.y.from > -1.7, "{} to {}", near.y.from, near.y.to);
    assert!(figures.iter().all(|f| f.check().is_ok() && f.summary.contains("Period 1.125")));

    let right = Response::new(&point.main().linearization.transfer_function, InputKind::Impulse).unwrap();
    let right = prepared.own_curves(&right);
    let whole = &prepared.figures(StudentCurves { own: Some(&right), data: None })[1];
    assert!(right.alone.is_none(), "it is seen over the reference");
    let [_, tops, bottoms] = whole.series.as_slice() else { panic!("{} curves", whole.series.len()) };
    assert!(tops.points.iter().all(|p| p.1 > 0.0) && bottoms.points.iter().all(|p| p.1 < 0.0));
    assert!(bottoms.name.is_empty(), "one entry in the legend");

    let alone = prepared.figures(StudentCurves::default());
    assert_eq!(alone[0].caption, "");
    assert_eq!(alone[1].x.to, point.main().impulse.as_ref().unwrap().horizon_s);
}

fn student(i: usize) -> Student {
    Student { id: format!("EE-{i:04}"), name: HOSTILE[i % HOSTILE.len()].into() }
}

fn class_row(i: usize) -> ClassRow {
    ClassRow {
        students: vec![student(i)],
        file: format!("answers {i}.yaml"),
        numbers: String::new(),
        report: format!("reports/answers%20{i}.html"),
        earned: Points(i as i64),
        possible: Points(4500),
        provisional: Points(50),
        findings: i % 3,
        to_review: i % 4,
        cover_total: i.is_multiple_of(2).then_some(Points(4_000)),
        adjustments: if i.is_multiple_of(10) {
            vec![(Some(Points(-500)), HOSTILE[i % HOSTILE.len()].into())]
        } else {
            Vec::new()
        },
        mark: i.is_multiple_of(2).then_some(Points(3_500)),
        readable: !i.is_multiple_of(7),
        missing: i.is_multiple_of(50),
        late: i.is_multiple_of(9),
        held: i.is_multiple_of(11),
    }
}

#[test]
fn of_a_very_large_class_the_first_reports_are_listed_and_the_page_says_so() {
    for (all, listed) in [(5_000, 5_000), (5_001, 5_000)] {
        let summary = ClassSummary { rows: (0..all).map(class_row).collect(), ..ClassSummary::default() };
        let html = FIXTURE.kit.class_page(&summary);
        assert_eq!(html.matches("class=\"file\"").count(), listed);
        assert_eq!(html.contains("The first 5000 of 5001 are listed here; all are in"), all > listed);
    }
}

#[test]
fn three_thousand_submissions_make_a_lean_class_page() {
    let rows = (0..3_000).map(class_row);
    let question = &FIXTURE.lab.questions[0];
    let entry = |i: usize| ReviewEntry {
        student: student(i).name,
        item: question.criteria[0].id.clone(),
        title: question.criteria[0].title.clone(),
        link: format!("reports/answers%20{i}.html#{}", item_anchor(&question.criteria[0].id)),
        why: "prose is judged by its words".into(),
        earned: Points(50),
        possible: Points(100),
        alike: (!i.is_multiple_of(3)).then(|| format!("said-0000000{}", i % 3)),
        found: "“swings”, “<b>”".into(),
        conflicts: vec!["it is stable: Your pole 2 lies in the right half-plane.".into()],
        example: "It swings.</q><script>".into(),
    };
    let intake = |i: usize| IntakeEntry {
        who: HOSTILE[i % HOSTILE.len()].into(),
        words: HOSTILE[(i + 1) % HOSTILE.len()].into(),
        link: if i.is_multiple_of(2) { String::new() } else { format!("reports/answers%20{i}.html") },
        kind: [IntakeKind::Held, IntakeKind::Superseded, IntakeKind::Aside][i % 3],
    };
    let statistics = |id: &str| ItemStatistics {
        id: id.to_owned(),
        possible: question.points,
        mean: Some(f64::NAN),
        facility: Some(0.5),
        discrimination: Some(-0.3),
        upper_less_lower: None,
        right: 1,
        partly: 2,
        wrong: 3,
        blank: 4,
        open: 5,
        provisional: 6,
    };
    let mut people = People::default();
    HOSTILE.iter().for_each(|text| people.add(text, "reports/answers%200.html"));
    let hostile = |text: &&str| AnswersShared {
        people: people.clone(),
        answers: vec![SharedAnswer {
            question: "1".into(),
            prompt: "p".into(),
            field: "q.a".into(),
            answer: (*text).to_owned(),
            count: 2,
            wrong: 9,
        }],
    };
    let summary = ClassSummary {
        rows: rows.collect(),
        counted: 2_940,
        totals: (0..300).map(|i| (Points(i), 10)).collect(),
        questions: vec![statistics(&question.id)],
        criteria: question.criteria.iter().map(|one| statistics(&one.id)).collect(),
        mistakes: vec![MistakeMade {
            question: question.id.clone(),
            explanations: vec![
                Explanation { words: "The term `b*x'` is missing.".into(), for_example: true };
                2
            ],
            people: people.clone(),
        }],
        classes: Confusion {
            rows: vec!["backlash"],
            columns: vec!["backlash", "left blank"],
            counts: vec![vec![7, 0]],
        },
        answers_shared: HOSTILE.iter().map(hostile).collect(),
        review: (0..3_000).map(entry).collect(),
        intake: (0..300).map(intake).collect(),
        ..ClassSummary::default()
    };
    let html = FIXTURE.kit.class_page(&summary);
    check_page("class", &html);
    assert_eq!(html.matches("<script").count(), 1, "only ours");
    assert!(html.len() < 3_000 * 600, "{} bytes", html.len());
    assert!(html.contains("3000 marks on 1 criterion wait for a person"));
    assert!(html.contains("<strong>1000 answers</strong>, 0.5 of 1 each, with “swings”"));
    assert!(html.contains("<code class=\"muted\">said-00000001</code>"));
}

#[test]
fn criteria_stand_on_the_class_page_in_the_order_of_the_lab_whoever_comes_first() {
    let [first, second] = [0, 1].map(|i| &FIXTURE.lab.questions[0].criteria[i]);
    let entry = |criterion: &Criterion, why: &str| ReviewEntry {
        student: "A. Student".into(),
        item: criterion.id.clone(),
        title: criterion.title.clone(),
        link: "reports/a.html".into(),
        why: why.into(),
        earned: Points(50),
        possible: Points(100),
        alike: None,
        found: String::new(),
        conflicts: Vec::new(),
        example: String::new(),
    };
    let review = vec![entry(second, "a picture"), entry(first, "a picture"), entry(second, "words")];
    let html = FIXTURE.kit.class_page(&ClassSummary { review, ..ClassSummary::default() });
    assert!(html.contains("3 marks on 2 criteria wait for a person"), "not a criterion for each reason");
    let places = [(first, "a picture"), (second, "a picture"), (second, "words")].map(|(criterion, why)| {
        let group = format!(" – {}</strong>: 1 mark. <span class=\"muted\">{why}<", criterion.title);
        html.find(&group).unwrap_or_else(|| panic!("no {group}"))
    });
    assert!(places.is_sorted(), "{places:?}");
}

#[test]
fn templates_quote_every_attribute_and_trust_only_markup_of_ours() {
    let templates = [
        include_str!("../../templates/base.html"),
        include_str!("../../templates/parts.html"),
        include_str!("../../templates/student.html"),
        include_str!("../../templates/reference.html"),
        include_str!("../../templates/derivation.html"),
        include_str!("../../templates/class.html"),
        include_str!("../../templates/handout.html"),
    ];
    for template in templates {
        assert!(!template.contains("={{"), "an attribute without quotes");
        for before in template.split("|safe").collect::<Vec<_>>().split_last().unwrap().1 {
            assert!(before.ends_with("_html"), "…{}", &before[before.len() - 30..]);
        }
    }
}

/// WCAG 2.2, success criteria 1.4.3 and 1.4.11.
#[test]
fn colours_have_contrast_in_both_schemes() {
    let css = include_str!("../../templates/style.css");
    let (light, dark) = css.split_once("@media screen and (prefers-color-scheme:dark)").unwrap();
    for scheme in [light, dark.split_once("}}").unwrap().0] {
        let colour = |name: &str| {
            let (_, after) = scheme.split_once(&format!("--{name}:#")).unwrap();
            let hex: String = after.chars().take_while(char::is_ascii_hexdigit).collect();
            let hex = if hex.len() == 3 { hex.chars().flat_map(|c| [c, c]).collect() } else { hex };
            let channel = |i: usize| {
                let v = f64::from(u8::from_str_radix(&hex[2 * i..2 * i + 2], 16).unwrap()) / 255.0;
                if v <= 0.04045 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) }
            };
            0.2126 * channel(0) + 0.7152 * channel(1) + 0.0722 * channel(2)
        };
        let contrast = |a: &str, b: &str| {
            let (a, b) = (colour(a), colour(b));
            (a.max(b) + 0.05) / (a.min(b) + 0.05)
        };
        for text in
            ["ink", "muted", "link", "good", "part", "bad", "quiet", "blue", "orange", "teal", "purple"]
        {
            for ground in ["bg", "panel"] {
                assert!(contrast(text, ground) >= 4.5, "{text} on {ground}: {:.2}", contrast(text, ground));
            }
        }
        for ground in ["mark", "against"] {
            assert!(contrast("ink", ground) >= 4.5, "ink on {ground}: {:.2}", contrast("ink", ground));
        }
    }
}
