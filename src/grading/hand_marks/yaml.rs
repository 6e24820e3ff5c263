use super::allowed::{Allowed, Findings};
use super::{
    Adjustment, AlikeMarks, HandMarks, HandMarksFile, LateCost, LateRule, Override, identity, quoted,
};
use crate::lab::Points;
use crate::source::{self, Finding, Node, SourceText, Span, Value};
use std::sync::Arc;

/// Reads a marks file in YAML.
pub fn read(source: &SourceText, allowed: Allowed<'_>) -> (HandMarksFile, Vec<Finding>) {
    let mut reader = Reader { allowed, findings: Findings::default() };
    let file = match source::parse_of_class(&source.text) {
        Ok(node) => reader.file(&node),
        Err(error) => {
            let message = format!("This marks file is not YAML: {}.", error.message);
            reader.findings.report(error.span, "marks.yaml", message, None);
            HandMarksFile::default()
        }
    };
    (file, reader.findings.0)
}

struct Reader<'a> {
    allowed: Allowed<'a>,
    findings: Findings,
}

impl Reader<'_> {
    fn file(&mut self, node: &Node) -> HandMarksFile {
        const KEYS: [&str; 5] = ["lab", "late", "files", "students", "alike"];
        let mut file = HandMarksFile::default();
        for (key, span, value) in
            self.mapping(node, "A marks file has the keys `lab`, `late`, `files`, `students` and `alike`.")
        {
            match key.as_str() {
                "lab" => self.lab(value),
                "late" => {
                    file.others.late_rule = self.late_rule(value);
                    file.said.insert((String::new(), "late".to_owned()), (*span).into());
                }
                "files" => self.files(value, &mut file),
                "students" => {
                    for (id, span, marks) in
                        self.mapping(value, "Under `students` stand ids, each with its marks.")
                    {
                        let marks = self.student(id, marks, &mut file);
                        if let Some((other, _)) = file.students.insert(identity(id), (id.clone(), marks)) {
                            let who = match other == *id {
                                true => quoted(id),
                                false => format!("{}, who is also {},", quoted(id), quoted(&other)),
                            };
                            self.findings.twice(*span, &format!("{who} has marks"));
                        }
                    }
                }
                "alike" => file.others.alike = Arc::new(self.alike(value, &mut file)),
                _ => self.findings.unknown(key, *span, KEYS, "key"),
            }
        }
        file
    }

    /// Decisions for groups, noting in `file` where each stands.
    fn alike(&mut self, node: &Node, file: &mut HandMarksFile) -> AlikeMarks {
        let mut alike = AlikeMarks::new();
        for (criterion, span, groups) in
            self.mapping(node, "Under `alike` stand criteria, each with its groups.")
        {
            let Some(most) = self.allowed.items.get(criterion.as_str()).copied() else {
                self.findings.unknown(criterion, *span, self.allowed.items.keys().copied(), "criterion");
                continue;
            };
            let wanted = "Under a criterion stand groups of like answers with points and a reason.";
            for (group, span, value) in self.mapping(groups, wanted) {
                let name = format!("{criterion}/{group}");
                let Some(given) = self.item(value, *span, most, &name) else { continue };
                if file.groups.insert((criterion.clone(), group.clone()), (*span).into()).is_some() {
                    let what = format!("The group {} of `{criterion}` is decided", quoted(group));
                    self.findings.twice(*span, &what);
                }
                alike.entry(criterion.clone()).or_default().insert(group.clone(), vec![given]);
            }
        }
        alike
    }

    fn lab(&mut self, node: &Node) {
        let message = match &node.value {
            Value::Scalar(lab) if lab == self.allowed.lab => return,
            Value::Scalar(lab) => {
                format!("These marks are for {}, not for `{}`.", quoted(lab), self.allowed.lab)
            }
            _ => "`lab` is the lab's id.".to_owned(),
        };
        self.findings.report(Some(node.span), "marks.lab", message, None);
    }

    fn late_rule(&mut self, node: &Node) -> Option<LateRule> {
        let wanted = "What it costs to hand in late is `{points: 5}` or `{percent: 10}`.";
        let (mut cost, mut reason) = (None, None);
        let entries = self.mapping(node, wanted);
        for (key, span, value) in entries {
            match (key.as_str(), &value.value) {
                (_, Value::Null) => {}
                ("points", _) => {
                    let range = (Points::ZERO, self.allowed.total);
                    cost = self.points(value, range, "late").map(LateCost::Points);
                }
                ("percent", _) => {
                    let range = (Points::ZERO, Points(10_000));
                    cost = self.points(value, range, "late").map(LateCost::Percent);
                }
                ("reason", Value::Scalar(text)) => reason = written(text),
                ("reason", _) => {}
                _ => self.findings.unknown(key, *span, ["points", "percent", "reason"], "key"),
            }
        }
        let costs = |name: &str| entries.iter().any(|(key, _, _)| key == name);
        if costs("points") && costs("percent") {
            let message = "`late` takes points or a percentage, not both.".to_owned();
            self.findings.report(Some(node.span), "marks.shape", message, Some(wanted));
            return None;
        }
        let words = || match cost {
            Some(LateCost::Percent(percent)) => format!("handed in late: {percent} % of what was earned"),
            _ => "handed in late".to_owned(),
        };
        let reason = reason.unwrap_or_else(words);
        Some(LateRule { cost: cost?, reason })
    }

    fn files(&mut self, node: &Node, file: &mut HandMarksFile) {
        let wanted = "Under `files` stand names of answer files, each with `{is: STUDENT}`.";
        for (name, span, value) in self.mapping(node, wanted) {
            for (key, key_span, is) in self.mapping(value, wanted) {
                let students: Vec<String> = match (key.as_str(), &is.value) {
                    ("is", Value::Null) => continue,
                    ("is", Value::Scalar(id)) => written(id).into_iter().collect(),
                    ("is", Value::Sequence(ids)) => {
                        ids.iter().filter_map(|id| written(id.as_scalar()?)).collect()
                    }
                    ("is", Value::Mapping(_)) => Vec::new(),
                    _ => {
                        self.findings.unknown(key, *key_span, ["is"], "key");
                        continue;
                    }
                };
                if students.is_empty() {
                    let message = format!("Whose {} is, is said by a student's id.", quoted(name));
                    self.findings.report(
                        Some(is.span),
                        "marks.shape",
                        message,
                        Some("Write `{is: EE-001}`."),
                    );
                } else {
                    file.files.insert(name.clone(), (students, (*span).into()));
                }
            }
        }
    }

    fn student(&mut self, id: &str, node: &Node, file: &mut HandMarksFile) -> HandMarks {
        let mut marks = HandMarks::default();
        let who = identity(id);
        for (key, span, value) in
            self.mapping(node, "A student's marks are keys such as `observed` and `items`.")
        {
            let by_hand = self.allowed.cover.get(key.as_str()).copied();
            match (key.as_str(), by_hand) {
                (_, Some(most)) => {
                    if let Some(points) = self.points(value, (Points::ZERO, most), key) {
                        marks.cover.insert(key.clone(), points);
                        file.said.insert((who.clone(), key.clone()), (*span).into());
                    }
                }
                ("observed", _) => {
                    for (row, span, value) in
                        self.mapping(value, "Under `observed` stand rows with their points.")
                    {
                        let Some(most) = self.allowed.observed.get(row.as_str()).copied() else {
                            let known = self.allowed.observed.keys().copied();
                            self.findings.unknown(row, *span, known, "row of the observation sheet");
                            continue;
                        };
                        if let Some(points) = self.points(value, (Points::ZERO, most), row) {
                            marks.observed.insert(row.clone(), points);
                            file.said.insert((who.clone(), format!("observed.{row}")), (*span).into());
                        }
                    }
                }
                ("items", _) => {
                    for (item, span, value) in
                        self.mapping(value, "Under `items` stand criteria with points and a reason.")
                    {
                        let Some(most) = self.allowed.items.get(item.as_str()).copied() else {
                            let known = self.allowed.items.keys().copied();
                            self.findings.unknown(item, *span, known, "criterion");
                            continue;
                        };
                        if let Some(given) = self.item(value, *span, most, item) {
                            marks.items.insert(item.clone(), vec![given]);
                            file.said.insert((who.clone(), item.clone()), (*span).into());
                        }
                    }
                }
                ("adjustments", _) => marks.adjustments = self.adjustments(value),
                ("late", _) => {
                    file.said.insert((who.clone(), key.clone()), (*span).into());
                    match (&value.value, value.as_scalar().map(str::to_lowercase).as_deref()) {
                        (Value::Null, _) => {}
                        (_, Some("true" | "yes")) => marks.late = Some(true),
                        (_, Some("false" | "no")) => marks.late = Some(false),
                        _ => {
                            let message = format!("Whether {} is late is `true` or `false`.", quoted(id));
                            self.findings.report(Some(value.span), "marks.shape", message, None);
                        }
                    }
                }
                ("counts", _) => match &value.value {
                    Value::Null => {}
                    Value::Scalar(name) => {
                        file.counts.insert(identity(id), (name.trim().to_owned(), value.span.into()));
                    }
                    _ => {
                        let message = "Which file counts is said by its name.".to_owned();
                        self.findings.report(Some(value.span), "marks.shape", message, None);
                    }
                },
                _ => {
                    let known = ["observed", "items", "adjustments", "late", "counts"];
                    let known = known.into_iter().chain(self.allowed.cover.keys().copied());
                    self.findings.unknown(key, *span, known, "key");
                }
            }
        }
        marks
    }

    fn adjustments(&mut self, node: &Node) -> Vec<Adjustment> {
        let wanted = "`adjustments` is a list of `{points: -5, reason: \"why\"}`.";
        let entries = match &node.value {
            Value::Null => return Vec::new(),
            Value::Sequence(entries) => entries.as_slice(),
            _ => {
                self.findings.report(Some(node.span), "marks.shape", wanted.to_owned(), None);
                return Vec::new();
            }
        };
        let most = self.allowed.total;
        let read = entries.iter().filter_map(|entry| {
            let given =
                self.decision(entry, entry.span, (Points::ZERO - most, most), "adjustments", false)?;
            Some(Adjustment { points: Some(given.points), reason: given.reason })
        });
        read.collect()
    }

    fn item(&mut self, node: &Node, at: Span, most: Points, id: &str) -> Option<Override> {
        self.decision(node, at, (Points::ZERO, most), id, true)
    }

    /// Points with a reason, `None` while they are not given.
    fn decision(
        &mut self,
        node: &Node,
        at: Span,
        range: (Points, Points),
        id: &str,
        of_an_answer: bool,
    ) -> Option<Override> {
        let (mut points, mut reason, mut answers) = (None, None, Vec::new());
        let (mut is_there, mut is_open) = (false, false);
        for (key, span, value) in self.mapping(node, "A criterion takes `{points: 1.5, reason: \"why\"}`.") {
            match (key.as_str(), &value.value) {
                ("points", _) => {
                    is_there = true;
                    is_open = value.is_null();
                    points = self.points(value, range, id);
                }
                ("reason", Value::Scalar(text)) => reason = written(text),
                ("reason", _) => {}
                ("answer", Value::Null) if of_an_answer => {}
                ("answer", Value::Scalar(hash)) if of_an_answer => {
                    answers = self.findings.hashes(hash, value.span);
                }
                ("answer", Value::Sequence(hashes)) if of_an_answer => {
                    for hash in hashes {
                        answers.extend(self.findings.hashes(hash.as_scalar().unwrap_or("?"), hash.span));
                    }
                }
                ("answer", _) if of_an_answer => drop(self.findings.hashes("?", value.span)),
                _ => {
                    let known = ["points", "reason"].into_iter().chain(of_an_answer.then_some("answer"));
                    self.findings.unknown(key, *span, known, "key");
                }
            }
        }
        let is_mapping = matches!(node.value, Value::Mapping(_));
        if !is_there && is_mapping {
            let message = format!("The points for `{id}` are missing.");
            self.findings.report(Some(at), "marks.points_missing", message, Some("Write `points: 1.5`."));
        }
        if reason.is_none() && is_mapping && !is_open {
            let message = format!("The reason for the mark of `{id}` is missing; the student will read it.");
            self.findings.report(Some(at), "marks.reason_missing", message, Some("Write `reason: \"why\"`."));
        }
        Some(Override { points: points?, reason: reason?, answers })
    }

    /// `None` while they are not given, too.
    fn points(&mut self, node: &Node, range: (Points, Points), id: &str) -> Option<Points> {
        match &node.value {
            Value::Null => None,
            Value::Scalar(text) => self.findings.points(text, node.span, range, id),
            _ => {
                let message = format!("The points for `{id}` are a number.");
                self.findings.report(Some(node.span), "marks.points_unreadable", message, None);
                None
            }
        }
    }

    /// The entries of a mapping; nothing, with a finding, for anything else. An empty place is an empty mapping.
    fn mapping<'n>(&mut self, node: &'n Node, wanted: &str) -> &'n [(String, Span, Node)] {
        match &node.value {
            Value::Mapping(entries) => entries,
            Value::Null => &[],
            _ => {
                self.findings.report(Some(node.span), "marks.shape", wanted.to_owned(), None);
                &[]
            }
        }
    }
}

fn written(text: &str) -> Option<String> {
    Some(text.trim().to_owned()).filter(|text| !text.is_empty())
}
