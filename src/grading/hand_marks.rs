use super::Verdict;
use super::mark::Mark;
use crate::algebra::{Rational, parse_decimal};
use crate::lab::{CoverSource, LabDefinition, Points};
use crate::names::nearest;
use crate::source::{self, Finding, Node, Severity, SourceText, Span, Value, sanitize};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// A person's decisions for groups of like answers: by criterion id, then by the group's id.
pub type AlikeMarks = BTreeMap<String, BTreeMap<String, Override>>;

/// What a person gave one student. Nothing here is ever written by polemark.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct HandMarks {
    /// Boxes of the cover sheet that are filled by hand, by row id.
    pub cover: BTreeMap<String, Points>,
    /// Rows of the observation sheet, by row id.
    pub observed: BTreeMap<String, Points>,
    /// Criteria whose mark a person has decided, by criterion id.
    pub items: BTreeMap<String, Override>,
    /// Decisions for like answers of the whole class: for what is not in `items`.
    pub alike: Arc<AlikeMarks>,
}

impl HandMarks {
    /// What a person gave for a criterion worth `most`: for this student's answer, else for answers like it. Points out of
    /// range are not given.
    pub(super) fn given(&self, criterion: &str, most: Points, alike: Option<&str>) -> Option<&Override> {
        let of_group = || self.alike.get(criterion)?.get(alike?);
        let in_range = |given: &&Override| (Points::ZERO..=most).contains(&given.points);
        self.items.get(criterion).filter(in_range).or_else(|| of_group().filter(in_range))
    }
}

/// A mark by a person, and why.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Override {
    pub points: Points,
    pub reason: String,
}

impl Override {
    /// The mark with the person's points; what polemark saw stays as evidence.
    pub(super) fn apply(&self, possible: Points, mark: Mark) -> Mark {
        let verdict = match self.points {
            points if points >= possible => Verdict::Right,
            Points::ZERO => Verdict::Wrong,
            _ => Verdict::Partly,
        };
        Mark { verdict, code: "by_hand", earned: self.points, provisional: false, ..mark }
    }
}

/// A marks file: what a person gave, by student id.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct HandMarksFile {
    students: BTreeMap<String, HandMarks>,
    /// What holds for whoever is not listed.
    others: HandMarks,
    /// Where the decisions for groups stand: (criterion, group).
    groups: BTreeMap<(String, String), Span>,
}

impl HandMarksFile {
    pub fn student(&self, id: &str) -> Option<&HandMarks> {
        self.students.get(id)
    }

    /// What counts for a student, listed or not.
    pub fn marks_for(&self, id: &str) -> &HandMarks {
        self.students.get(id).unwrap_or(&self.others)
    }

    /// A warning for each decision about a group that is not among `groups`, the (criterion, group) of a class's answers.
    pub fn decisions_without_answers(&self, groups: &BTreeSet<(String, String)>) -> Vec<Finding> {
        let nobody = self.groups.iter().filter(|(group, _)| !groups.contains(*group));
        let finding = |((criterion, group), span): (&(String, String), &Span)| {
            let message =
                format!("No answer of this class is in the group {} of `{criterion}`.", quoted(group));
            Finding::warning("marks.alike_nobody", message)
                .with_help("The class page lists the groups; they change with the answers and with the lab's phrases.")
                .at(*span)
        };
        nobody.map(finding).collect()
    }

    /// In alphabetical order.
    pub fn student_ids(&self) -> impl Iterator<Item = &str> {
        self.students.keys().map(String::as_str)
    }
}

impl HandMarks {
    /// Reads a marks file: what could be read, and a finding for everything that could not or that does not fit `lab`.
    ///
    /// ```yaml
    /// lab: ee361-lab3
    /// students:
    ///   EE-001:
    ///     viva: 30
    ///     observed: {realization: 4}
    ///     items:
    ///       hanging.response.plot: {points: 0.5, reason: "axes without units"}
    /// alike:
    ///   expect_hanging.settles:
    ///     text-3f2a91c0: {points: 1, reason: "says so in other words"}
    /// ```
    pub fn parse(source: &SourceText, lab: &LabDefinition) -> (HandMarksFile, Vec<Finding>) {
        let mut reader = Reader { allowed: Allowed::new(lab), findings: Vec::new() };
        let file = match source::parse(&source.text) {
            Ok(node) => reader.file(&node),
            Err(error) => {
                reader.report(
                    error.span,
                    "marks.yaml",
                    format!("This marks file is not YAML: {}.", error.message),
                    None,
                );
                HandMarksFile::default()
            }
        };
        (file, reader.findings)
    }
}

/// What may be given, and how many points at most.
struct Allowed<'a> {
    lab: &'a str,
    cover: BTreeMap<&'a str, Points>,
    observed: BTreeMap<&'a str, Points>,
    items: BTreeMap<&'a str, Points>,
}

impl<'a> Allowed<'a> {
    fn new(lab: &'a LabDefinition) -> Self {
        let by_hand = lab.cover.rows.iter().filter(|row| row.from == CoverSource::ByHand);
        let criteria = lab.questions.iter().flat_map(|question| &question.criteria);
        Self {
            lab: &lab.id,
            cover: by_hand.map(|row| (row.id.as_str(), row.points)).collect(),
            observed: lab.observed.iter().map(|row| (row.id.as_str(), row.points)).collect(),
            items: criteria.map(|criterion| (criterion.id.as_str(), criterion.points)).collect(),
        }
    }
}

struct Reader<'a> {
    allowed: Allowed<'a>,
    findings: Vec<Finding>,
}

impl Reader<'_> {
    fn report(&mut self, span: Option<Span>, code: &'static str, message: String, help: Option<String>) {
        self.findings.push(Finding { severity: Severity::Error, code, message, help, span });
    }

    fn file(&mut self, node: &Node) -> HandMarksFile {
        let mut file = HandMarksFile::default();
        let mut alike = AlikeMarks::new();
        for (key, span, value) in
            self.mapping(node, "A marks file has the keys `lab`, `students` and `alike`.")
        {
            match key.as_str() {
                "lab" => self.lab(value),
                "students" => {
                    for (id, span, marks) in
                        self.mapping(value, "Under `students` stand ids, each with its marks.")
                    {
                        let marks = self.student(marks);
                        if file.students.insert(id.clone(), marks).is_some() {
                            self.report(
                                Some(*span),
                                "marks.twice",
                                format!("{} has marks twice; the later ones would count.", quoted(id)),
                                Some("Put them together.".to_owned()),
                            );
                        }
                    }
                }
                "alike" => alike = self.alike(value, &mut file.groups),
                _ => self.unknown(key, *span, &["lab", "students", "alike"], "key"),
            }
        }
        let alike = Arc::new(alike);
        file.others.alike = Arc::clone(&alike);
        for marks in file.students.values_mut() {
            marks.alike = Arc::clone(&alike);
        }
        file
    }

    /// Decisions for groups, and in `places` where each stands.
    fn alike(&mut self, node: &Node, places: &mut BTreeMap<(String, String), Span>) -> AlikeMarks {
        let mut alike = AlikeMarks::new();
        let known = self.allowed.items.keys().map(|id| (*id).to_owned()).collect::<Vec<_>>();
        for (criterion, span, groups) in
            self.mapping(node, "Under `alike` stand criteria, each with its groups.")
        {
            let Some(most) = self.allowed.items.get(criterion.as_str()).copied() else {
                self.unknown(criterion, *span, &known, "criterion");
                continue;
            };
            let wanted = "Under a criterion stand groups of like answers with points and a reason.";
            for (group, span, value) in self.mapping(groups, wanted) {
                let name = format!("{criterion}/{group}");
                let Some(given) = self.item(value, *span, most, &name) else { continue };
                if places.insert((criterion.clone(), group.clone()), *span).is_some() {
                    let message = format!("The group {} of `{criterion}` is decided twice.", quoted(group));
                    self.report(Some(*span), "marks.twice", message, Some("Keep one.".to_owned()));
                }
                alike.entry(criterion.clone()).or_default().insert(group.clone(), given);
            }
        }
        alike
    }

    fn lab(&mut self, node: &Node) {
        match &node.value {
            Value::Scalar(lab) if lab == self.allowed.lab => {}
            Value::Scalar(lab) => {
                let message = format!("These marks are for {}, not for `{}`.", quoted(lab), self.allowed.lab);
                self.report(Some(node.span), "marks.lab", message, None);
            }
            _ => self.report(Some(node.span), "marks.lab", "`lab` is the lab's id.".to_owned(), None),
        }
    }

    fn student(&mut self, node: &Node) -> HandMarks {
        let mut marks = HandMarks::default();
        for (key, span, value) in
            self.mapping(node, "A student's marks are keys such as `observed` and `items`.")
        {
            let by_hand = self.allowed.cover.get(key.as_str()).copied();
            match (key.as_str(), by_hand) {
                (_, Some(most)) => {
                    if let Some(points) = self.points(value, most, key) {
                        marks.cover.insert(key.clone(), points);
                    }
                }
                ("observed", _) => {
                    let known = self.allowed.observed.keys().map(|id| (*id).to_owned()).collect::<Vec<_>>();
                    for (row, span, value) in
                        self.mapping(value, "Under `observed` stand rows with their points.")
                    {
                        match self.allowed.observed.get(row.as_str()).copied() {
                            None => self.unknown(row, *span, &known, "row of the observation sheet"),
                            Some(most) => {
                                if let Some(points) = self.points(value, most, row) {
                                    marks.observed.insert(row.clone(), points);
                                }
                            }
                        }
                    }
                }
                ("items", _) => {
                    let known = self.allowed.items.keys().map(|id| (*id).to_owned()).collect::<Vec<_>>();
                    for (item, span, value) in
                        self.mapping(value, "Under `items` stand criteria with points and a reason.")
                    {
                        match self.allowed.items.get(item.as_str()).copied() {
                            None => self.unknown(item, *span, &known, "criterion"),
                            Some(most) => {
                                if let Some(given) = self.item(value, *span, most, item) {
                                    marks.items.insert(item.clone(), given);
                                }
                            }
                        }
                    }
                }
                _ => {
                    let mut known = vec!["observed", "items"];
                    known.extend(self.allowed.cover.keys());
                    let known: Vec<String> = known.into_iter().map(str::to_owned).collect();
                    self.unknown(key, *span, &known, "key");
                }
            }
        }
        marks
    }

    fn item(&mut self, node: &Node, at: Span, most: Points, id: &str) -> Option<Override> {
        let (mut points, mut reason) = (None, None);
        let mut given = false;
        for (key, span, value) in self.mapping(node, "A criterion takes `{points: 1.5, reason: \"why\"}`.") {
            match (key.as_str(), &value.value) {
                ("points", _) => {
                    given = true;
                    points = self.points(value, most, id);
                }
                ("reason", Value::Scalar(text)) => {
                    reason = Some(text.trim().to_owned()).filter(|text| !text.is_empty())
                }
                ("reason", _) => {}
                _ => self.unknown(key, *span, &["points", "reason"], "key"),
            }
        }
        if !given && matches!(node.value, Value::Mapping(_)) {
            let message = format!("The points for `{id}` are missing.");
            self.report(Some(at), "marks.points_missing", message, Some("Write `points: 1.5`.".to_owned()));
        }
        if reason.is_none() && matches!(node.value, Value::Mapping(_)) {
            let message = format!("The reason for the mark of `{id}` is missing; the student will read it.");
            self.report(
                Some(at),
                "marks.reason_missing",
                message,
                Some("Write `reason: \"why\"`.".to_owned()),
            );
        }
        Some(Override { points: points?, reason: reason? })
    }

    fn points(&mut self, node: &Node, most: Points, id: &str) -> Option<Points> {
        let Value::Scalar(text) = &node.value else {
            let message = format!("The points for `{id}` are a number.");
            self.report(Some(node.span), "marks.points_unreadable", message, None);
            return None;
        };
        let hundredths = parse_decimal(text.trim()).ok().map(|value| value * Rational::from(100));
        let points = hundredths
            .filter(Rational::is_int)
            .and_then(|value| i64::try_from(value.floor()).ok())
            .map(Points);
        match points {
            None => {
                let message = format!("{} is not a number of points in steps of a hundredth.", quoted(text));
                self.report(
                    Some(node.span),
                    "marks.points_unreadable",
                    message,
                    Some("Write `1.5`, say.".to_owned()),
                );
            }
            Some(points) if points < Points::ZERO || points > most => {
                let message = format!("{points} points for `{id}` are not between 0 and {most}.");
                self.report(Some(node.span), "marks.points_out_of_range", message, None);
            }
            Some(points) => return Some(points),
        }
        None
    }

    /// The entries of a mapping; nothing, with a finding, for anything else. An empty place is an empty mapping.
    fn mapping<'n>(&mut self, node: &'n Node, wanted: &str) -> &'n [(String, Span, Node)] {
        match &node.value {
            Value::Mapping(entries) => entries,
            Value::Null => &[],
            _ => {
                self.report(Some(node.span), "marks.shape", wanted.to_owned(), None);
                &[]
            }
        }
    }

    fn unknown(&mut self, name: &str, span: Span, known: &[impl AsRef<str>], what: &str) {
        let help = match nearest(name, known.iter().map(AsRef::as_ref)) {
            Some(near) => format!("Did you mean `{near}`?"),
            None if known.is_empty() => "This lab has none.".to_owned(),
            None => {
                let names: Vec<_> = known.iter().take(12).map(|one| format!("`{}`", one.as_ref())).collect();
                let more = if known.len() > 12 { " and others" } else { "" };
                format!("There are {}{more}.", names.join(", "))
            }
        };
        self.report(Some(span), "marks.unknown", format!("There is no {what} {}.", quoted(name)), Some(help));
    }
}

fn quoted(text: &str) -> String {
    format!("`{}`", sanitize(text))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grading::Evidence;
    use crate::lab;

    fn parse(text: &str) -> (HandMarksFile, Vec<String>) {
        let lab = lab::load(lab::DEFAULT).unwrap();
        let source = SourceText::new("marks.yaml", text);
        let (file, findings) = HandMarks::parse(&source, &lab);
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
        let item = &marks.items["hanging.transfer_function.denominator"];
        assert_eq!((item.points, item.reason.as_str()), (Points(150), "slip in the last step"));
        assert_eq!(file.student("EE-002"), Some(&HandMarks::default()));
        assert_eq!(file.student("EE-003"), None);
    }

    #[track_caller]
    fn check(rows: &[(&str, &str)]) {
        for (text, want) in rows {
            let (_, findings) = parse(text);
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
            (
                "students: {A: {items: {battery.nonlinearity.class: {points: 1}}}}",
                "1:24 marks.reason_missing ",
            ),
            (
                "students: {A: {items: {battery.nonlinearity.class: {points: 1, reason: '  '}}}}",
                "1:24 marks.reason_missing ",
            ),
            (
                "students: {A: {items: {battery.nonlinearity.class: {reason: x}}}}",
                "1:24 marks.points_missing ",
            ),
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
    fn a_person_has_the_last_word() {
        for (given, verdict) in [(0, Verdict::Wrong), (50, Verdict::Partly), (100, Verdict::Right)] {
            let mark = Mark { provisional: true, ..Mark::wrong("concepts.missing", Evidence::default()) };
            let given = Override { points: Points(given), reason: "seen".into() };
            let mark = given.apply(Points(100), mark);
            assert_eq!((mark.verdict, mark.code, mark.provisional), (verdict, "by_hand", false));
            assert_eq!(mark.earned, given.points);
        }
    }
}
