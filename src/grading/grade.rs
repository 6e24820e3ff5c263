use super::accepted::{Accepted, accepted, accepted_where, operating_point};
use super::conflicts::note_conflicts;
use super::follow_through::follow;
use super::known::Known;
use super::mark::{Mark, beginning};
use super::plot::{Demands, Target};
use super::same_mistake::spare;
use super::truth::Truth;
use super::{
    Catalogue, Given, HandMarks, ItemScore, Ledger, QuestionScore, Scorecard, Tally, Verdict, alike,
    concepts, cover, in_doubt, letters, nonlinearity, plot, poles, shape, stability, tangent,
    transfer_function, value,
};
use crate::lab::{Check, Criterion, Curve, Described, LabDefinition, Question, SystemRef};
use crate::model::LetterDerivation;
use crate::prose::Claim;
use crate::reference::{Reference, ResponseReference};
use crate::submission::{
    Answer, AnswerSheet, AnswerValue, AnsweredIn, Figure, Knowledge, Series, Submission, Unreadable,
    hash_of_fields,
};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Every mark of one submission, with its evidence, and with `catalogue` what may explain a wrong transfer function.
///
/// The same input gives the same scorecard. What cannot be judged is [`Verdict::Unmarked`], never silently a zero; what a
/// person decided in `hand` stands. An override whose points are out of range is ignored (reading the marks file reports it).
pub fn grade(
    lab: &LabDefinition,
    reference: &Reference,
    catalogue: &Catalogue,
    submission: &Submission,
    hand: Option<&HandMarks>,
) -> Scorecard {
    grade_knowing(&Known::NOTHING, lab, reference, catalogue, submission, hand)
}

/// The same, with what is `known` of earlier submissions marked by the same lab, reference and catalogue.
pub fn grade_knowing(
    known: &Known,
    lab: &LabDefinition,
    reference: &Reference,
    catalogue: &Catalogue,
    submission: &Submission,
    hand: Option<&HandMarks>,
) -> Scorecard {
    let grader = Grader { known, reference, catalogue, submission, sheet: &lab.sheet };
    scorecard(lab, submission, hand, marks(lab, &grader, hand))
}

/// The marks of each question's criteria before a person has a say.
pub(super) fn marks(lab: &LabDefinition, grader: &Grader<'_>, hand: Option<&HandMarks>) -> Vec<Vec<Mark>> {
    let mut marks: Vec<Vec<Mark>> = lab.questions.iter().map(|asked| grader.question(asked)).collect();
    let earned = |criterion: &Criterion, mark: &Mark| {
        let answer = || {
            let fields = criterion.fields();
            let hash =
                |field: &&str| Some(((*field).to_owned(), grader.submission.answers.get(*field)?.hash()));
            hash_of_fields(&fields.iter().filter_map(hash).collect(), &fields)
        };
        let given = hand.and_then(|hand| hand.given(&criterion.id, criterion.points, None, &answer));
        given.and_then(Given::applied).map_or(mark.earned, |given| given.points)
    };
    spare(lab, grader, &earned, &mut marks);
    follow(lab, grader, &earned, &mut marks);
    note_conflicts(lab, grader, &mut marks);
    in_doubt::leave_open(lab, grader, &mut marks);
    marks
}

/// Every criterion left to a person, for `reason`; what `hand` already gives counts.
pub fn leave_to_a_person(
    lab: &LabDefinition,
    submission: &Submission,
    hand: Option<&HandMarks>,
    reason: &str,
) -> Scorecard {
    let unmarked = |_: &Criterion| Mark::unmarked(String::new(), String::new(), reason);
    let marks = lab.questions.iter().map(|asked| asked.criteria.iter().map(unmarked).collect()).collect();
    scorecard(lab, submission, hand, marks)
}

/// Adds up the marks of each question's criteria, a person's marks in place of ours.
pub(super) fn scorecard(
    lab: &LabDefinition,
    submission: &Submission,
    hand: Option<&HandMarks>,
    marks: Vec<Vec<Mark>>,
) -> Scorecard {
    let mut ledger = Ledger::default();
    let answers = submission.answer_hashes();
    let questions: Vec<QuestionScore> = lab
        .questions
        .iter()
        .zip(marks)
        .map(|(question, marks)| {
            let items: Vec<ItemScore> = question
                .criteria
                .iter()
                .zip(marks)
                .map(|(criterion, mark)| {
                    let (spared, withheld) = (mark.spared, mark.withheld);
                    let item = item_score(criterion, mark, submission, &answers, hand);
                    ledger.enter(&item, spared, withheld);
                    item
                })
                .collect();
            QuestionScore { id: question.id.clone(), tally: Tally::of(&items), items }
        })
        .collect();
    let total =
        questions.iter().map(|question| question.tally).fold(Tally::default(), |sum, next| sum + next);
    let unmarked =
        questions.iter().flat_map(|question| &question.items).any(|item| item.verdict == Verdict::Unmarked);
    let observed = cover::observed(&lab.observed, hand);
    let parts = cover::Parts::new(total, unmarked, &lab.observed, &observed);
    let boxes = cover::boxes(&lab.cover, &parts, hand);
    let so_far = cover::so_far(&lab.cover, total, &lab.observed, &observed, hand);
    let mut card = Scorecard {
        questions,
        total,
        observed,
        cover_total: cover::total(&boxes),
        so_far,
        cover: boxes,
        ledger,
        answers,
        adjustments: Vec::new(),
        mark: None,
    };
    let adjustments = hand.map_or_else(Vec::new, |hand| hand.adjustments_of(card.cover_total, false));
    card.adjust(adjustments, lab.cover.total);
    card
}

fn item_score(
    criterion: &Criterion,
    mark: Mark,
    submission: &Submission,
    answers: &BTreeMap<String, String>,
    hand: Option<&HandMarks>,
) -> ItemScore {
    let mark = Mark { alike: alike::group(criterion, &mark, submission), ..mark };
    let answer = hash_of_fields(answers, &criterion.fields());
    let of_answer = || answer.clone();
    let given =
        hand.and_then(|hand| hand.given(&criterion.id, criterion.points, mark.alike.as_deref(), &of_answer));
    let (applied, held) = (given.and_then(Given::applied), given.and_then(Given::held));
    let mark = match (applied, held) {
        (Some(given), _) => Mark { follow_through: None, ..given.apply(criterion.points, mark) },
        (None, Some(_)) => Mark { provisional: true, ..mark },
        (None, None) => mark,
    };
    ItemScore {
        id: criterion.id.clone(),
        title: criterion.title.clone(),
        earned: mark.earned,
        possible: criterion.points,
        verdict: mark.verdict,
        code: mark.code,
        evidence: mark.evidence,
        diagnosis: mark.diagnosis,
        follow_through: mark.follow_through,
        alike: mark.alike,
        provisional: mark.provisional,
        override_reason: applied.map(|given| given.reason.clone()),
        answer,
        held: held.cloned(),
        position: position(criterion, submission),
    }
}

/// Where the answer stands: for a plot, its data before its figure.
fn position(criterion: &Criterion, submission: &Submission) -> Option<crate::source::Position> {
    let data = match &criterion.check {
        Check::Plot { data: Some(data), .. } => submission.answers.get(data),
        _ => None,
    };
    let answer = data.or_else(|| submission.answers.get(&criterion.field))?;
    Some(submission.source.position(answer.span.start))
}

/// Judges the answers of one submission.
pub(super) struct Grader<'a> {
    pub known: &'a Known,
    pub reference: &'a Reference,
    pub(super) catalogue: &'a Catalogue,
    pub submission: &'a Submission,
    pub sheet: &'a AnswerSheet,
}

/// What stands in a field.
pub(super) enum Field<'a> {
    Blank,
    Unreadable(&'a Answer, &'a Unreadable),
    Value(&'a Answer, &'a AnswerValue),
}

impl<'a> Grader<'a> {
    pub fn field(&self, path: &str) -> Field<'a> {
        match self.submission.answers.get(path) {
            None => Field::Blank,
            Some(answer) => match &answer.value {
                Ok(value) => Field::Value(answer, value),
                Err(why) => Field::Unreadable(answer, why),
            },
        }
    }

    /// One mark for each criterion, in order.
    fn question(&self, question: &Question) -> Vec<Mark> {
        let mut marks: Vec<Option<Mark>> = vec![None; question.criteria.len()];
        for (index, criterion) in question.criteria.iter().enumerate() {
            if marks[index].is_some() {
                continue;
            }
            match criterion.check.transfer_function() {
                None => {
                    let judge = || vec![self.criterion(criterion, Truth::Reference(self.reference))];
                    marks[index] = self.remembered(criterion, judge).pop();
                }
                Some(of) => {
                    // Criteria on one transfer function are judged together: they share one reading of it.
                    let same: Vec<usize> = (index..question.criteria.len())
                        .filter(|&other| {
                            let other = &question.criteria[other];
                            other.field == criterion.field && other.check.transfer_function() == Some(of)
                        })
                        .collect();
                    let criteria: Vec<&Criterion> =
                        same.iter().map(|&place| &question.criteria[place]).collect();
                    for (place, mark) in
                        same.iter().zip(self.remembered(criterion, || self.transfer_function(&criteria, of)))
                    {
                        marks[*place] = Some(mark);
                    }
                }
            }
        }
        let missing =
            || Mark::unmarked(String::new(), String::new(), "polemark did not judge this; a person will.");
        marks.into_iter().map(|mark| mark.unwrap_or_else(missing)).collect()
    }

    /// What `judge` says by the reference of the answer to `criterion` and those judged with it, now or earlier.
    fn remembered(&self, criterion: &Criterion, judge: impl Fn() -> Vec<Mark>) -> Vec<Mark> {
        match (&criterion.check, self.field(&criterion.field)) {
            // Of files only the name stands in the answer.
            (Check::Plot { .. }, _) => judge(),
            (_, Field::Value(_, AnswerValue::Figure(_) | AnswerValue::Data(_))) => judge(),
            (_, Field::Value(answer, value)) => self.known.marks(&criterion.id, &answer.text, value, judge),
            (_, Field::Blank | Field::Unreadable(..)) => judge(),
        }
    }

    /// What `prose` claims about the response it describes, in text order.
    pub(super) fn claims_of(&self, prose: &str, described: &Described) -> Arc<Vec<Claim>> {
        self.known.claims(prose, &described.of.to_string(), self.sheet)
    }

    fn transfer_function(&self, criteria: &[&Criterion], of: &SystemRef) -> Vec<Mark> {
        let accepted = accepted(self.reference, of, |one| &one.linearization.transfer_function);
        let Some(first) = criteria.first() else { return Vec::new() };
        if let Field::Value(answer, AnswerValue::TransferFunction { transfer_function: typed, formula }) =
            self.field(&first.field)
        {
            let numeric = transfer_function::judge(criteria, &accepted, typed);
            let mut marks = match self.derivation(&first.field, of) {
                Some(derivation) => letters::judge(criteria, derivation, formula.as_ref(), numeric),
                None => numeric,
            };
            let wrong = |mark: &&mut Mark| {
                matches!(mark.verdict, Verdict::Wrong | Verdict::Partly)
                    && mark.code != "letters.numbers_only"
            };
            if let Some(first) = marks.iter_mut().find(wrong) {
                first.diagnosis = self.catalogue.diagnose_as_typed(of, typed, &answer.text, formula.as_ref());
            }
            return marks;
        }
        let derivation = self.derivation(&first.field, of);
        let expected = |criterion: &Criterion| match derivation {
            Some(derivation) => letters::expected(&criterion.check, derivation),
            None => transfer_function::expected(&criterion.check, &accepted),
        };
        criteria.iter().map(|criterion| self.without_value(criterion, expected(criterion))).collect()
    }

    /// What a field asked for in letters is held against; `None` where either will do, or letters cannot be derived.
    fn derivation(&self, field: &str, of: &SystemRef) -> Option<&'a LetterDerivation> {
        let asked = self.sheet.letters.get(field).map_or(AnsweredIn::Either, |own| own.answered_in);
        let point = self.reference.operating_point(of).filter(|_| asked == AnsweredIn::Letters)?;
        point.letters.as_ref().ok().filter(|derivation| derivation.has_letters())
    }

    /// The marks of `criteria` on the function typed for `of`, held against what `mistakes` made in the derivation lead to;
    /// `None` when there is no such function, or nothing to hold.
    pub(super) fn with_mistakes(
        &self,
        criteria: &[&Criterion],
        of: &SystemRef,
        mistakes: &[&str],
    ) -> Option<Vec<Mark>> {
        let Field::Value(_, AnswerValue::TransferFunction { transfer_function: typed, .. }) =
            self.field(&criteria.first()?.field)
        else {
            return None;
        };
        let functions = self.known.led_to_by(self.catalogue, of, mistakes);
        let expected: Vec<_> = functions.iter().map(|what| Accepted { differs: &[], what }).collect();
        (!expected.is_empty()).then(|| transfer_function::judge(criteria, &expected, typed))
    }

    /// The mark of a criterion whose answer is not there, cannot be read, or is not of the kind it judges.
    pub(super) fn without_value(&self, criterion: &Criterion, expected: String) -> Mark {
        match self.field(&criterion.field) {
            Field::Blank if !self.submission.readable => unreadable_file(expected, self.submission),
            Field::Blank => Mark::blank(expected),
            Field::Unreadable(answer, why) => Mark::unreadable(expected, answer, why),
            Field::Value(answer, _) => Mark::unmarked(
                expected,
                beginning(&answer.text),
                "This answer is of another kind than the one that is judged here; a person will mark it.",
            ),
        }
    }

    /// The mark of a criterion on anything but a transfer function, by `truth`.
    pub fn criterion(&self, criterion: &Criterion, truth: Truth<'_>) -> Mark {
        let points = criterion.points;
        let value = match self.field(&criterion.field) {
            Field::Value(_, value) => Some(value),
            _ => None,
        };
        match &criterion.check {
            Check::Structure { .. } | Check::Numerator { .. } | Check::Denominator { .. } => {
                self.without_value(criterion, String::new())
            }
            Check::Poles { of, tolerance, coefficients } => {
                let accepted = truth.poles(of);
                let nearness = poles::Nearness { parts: tolerance, coefficients };
                match value {
                    Some(AnswerValue::Poles(typed)) => {
                        poles::judge(points, &accepted, truth.internal_poles(of), &nearness, typed)
                    }
                    _ => self.without_value(criterion, poles::expected(&accepted, &nearness)),
                }
            }
            Check::Stability { of } => {
                let accepted = truth.stability(of);
                match value {
                    Some(AnswerValue::Stability(typed)) => {
                        stability::judge(points, &accepted, truth.internal_stability(of), *typed)
                    }
                    _ => self.without_value(criterion, stability::expected(&accepted)),
                }
            }
            Check::Feature { of, response, feature, tolerance } => {
                let accepted: Vec<_> =
                    truth.responses(of, *response).iter().map(|one| one.pick(|it| &it.features)).collect();
                match value {
                    Some(AnswerValue::Value(typed)) => {
                        value::judge(points, &accepted, feature, tolerance, typed)
                    }
                    _ => self.without_value(criterion, value::expected(&accepted, feature, tolerance)),
                }
            }
            Check::Rest { of, asked, tolerance, tolerance_of_zero } => {
                let accepted = accepted_where(self.reference, of, |one| one.values.get(&asked.signal));
                let zero = accepted.first().is_some_and(|one| one.what.is_zero());
                let tolerance = if zero { tolerance_of_zero } else { tolerance };
                match value {
                    Some(AnswerValue::Value(typed)) => {
                        value::judge_at_rest(points, &accepted, asked, tolerance, typed)
                    }
                    _ => {
                        let expected = value::expected_at_rest(&accepted, asked, tolerance);
                        self.without_value(criterion, expected)
                    }
                }
            }
            Check::Shape { of, response } => {
                let accepted = truth.shapes(of, *response);
                match value {
                    Some(AnswerValue::Shape(typed)) => shape::judge(points, &accepted, *typed),
                    _ => self.without_value(criterion, shape::expected(&accepted)),
                }
            }
            Check::Tangent { of, tolerance, form, other_form } => {
                let asked = tangent::Asked { form: *form, other_form, tolerance };
                let point = operating_point(self.reference, of);
                match (point, value) {
                    (Some(point), Some(AnswerValue::Formula(typed))) => {
                        tangent::judge(points, point, &asked, typed)
                    }
                    (point, _) => {
                        let expected = point.map(|point| tangent::expected(point, *form));
                        self.without_value(criterion, expected.unwrap_or_default())
                    }
                }
            }
            Check::Nonlinearity { expected } => match value {
                Some(AnswerValue::Nonlinearity(typed)) => nonlinearity::judge(points, *expected, *typed),
                _ => self.without_value(criterion, nonlinearity::expected(*expected)),
            },
            Check::Concepts { concepts: wanted, needed, contradictions, .. } => match value {
                Some(AnswerValue::Prose(prose)) => {
                    concepts::judge(points, wanted, *needed, contradictions, prose)
                }
                _ => self.without_value(criterion, concepts::expected(wanted, *needed)),
            },
            Check::Plot { data, curve, tolerance, min_points, span_s } => {
                let span_s = truth.span_s(curve, *span_s);
                let demands = Demands { tolerance, min_points: *min_points, span_s };
                self.plot(criterion, data.as_deref(), curve, &demands, truth)
            }
        }
    }

    fn plot(
        &self,
        criterion: &Criterion,
        data: Option<&str>,
        curve: &Curve,
        demands: &Demands<'_>,
        truth: Truth<'_>,
    ) -> Mark {
        let expected = plot::expected(demands);
        if !self.submission.readable {
            return unreadable_file(expected, self.submission);
        }
        let figure: Option<&Figure> = match self.field(&criterion.field) {
            Field::Value(_, AnswerValue::Figure(figure)) => Some(figure),
            _ => None,
        };
        let data_field = data.map_or(Field::Blank, |data| self.field(data));
        let series: Option<&Series> = match &data_field {
            Field::Value(_, AnswerValue::Data(series)) => Some(series),
            _ => None,
        };
        if series.is_some() {
            return plot::judge(criterion.points, &self.targets(curve, truth), demands, series, figure);
        }
        match (figure, data_field) {
            // Data that cannot be read is a finding; the figure beside it still counts as a figure alone.
            (Some(figure), Field::Unreadable(_, why)) => {
                let why = format!("{} The figure beside it counts.", why.finding.message);
                plot::figure_alone(criterion.points, expected, figure, &why)
            }
            (Some(_), _) => plot::judge(criterion.points, &[], demands, None, figure),
            (None, Field::Unreadable(answer, why)) => Mark::unreadable(expected, answer, why),
            (None, _) => self.without_value(criterion, expected),
        }
    }

    fn targets<'t>(&self, curve: &Curve, truth: Truth<'t>) -> Vec<Target<'t>>
    where
        'a: 't,
    {
        let target = |one: Accepted<'t, ResponseReference>| {
            let known = one.what;
            Target {
                with: one.with(),
                at: Box::new(move |t| known.response.at(t)),
                turns: known.turning_points(),
                until_s: f64::INFINITY,
            }
        };
        match curve {
            Curve::Response { of, response } => {
                truth.responses(of, *response).into_iter().map(target).collect()
            }
            Curve::Simulation { id } => self
                .reference
                .simulations
                .iter()
                .filter(|simulation| simulation.id == *id)
                .map(|simulation| Target {
                    with: String::new(),
                    at: Box::new(move |t| simulation.with.at(t)),
                    turns: &simulation.with.samples,
                    until_s: simulation.with.samples.last().map_or(0.0, |(t, _)| *t),
                })
                .collect(),
        }
    }
}

fn unreadable_file(expected: String, submission: &Submission) -> Mark {
    let why = submission.findings.first().map_or("", |finding| finding.message.as_str());
    let reason = format!("The file as a whole could not be read. {why}").trim_end().to_owned();
    let mark = Mark::blank(expected);
    Mark {
        verdict: Verdict::Unreadable,
        code: "unreadable",
        evidence: super::Evidence { reason, ..mark.evidence },
        ..mark
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grading::Override;
    use crate::lab::{self, CoverSource, Points};
    use crate::submission::{NoFiles, read};
    use std::sync::OnceLock;

    fn lab() -> &'static (LabDefinition, Reference) {
        static LAB: OnceLock<(LabDefinition, Reference)> = OnceLock::new();
        LAB.get_or_init(|| {
            let lab = lab::load(lab::DEFAULT).unwrap();
            let reference = Reference::compute(&lab).unwrap();
            (lab, reference)
        })
    }

    fn submission(answers: &str) -> Submission {
        let text = format!("lab: ee361-lab3\nstudent: {{id: EE-001, name: A. Student}}\nanswers:\n{answers}");
        read("answers", "answers.yaml", text.as_bytes(), &lab().0.sheet, &NoFiles)
    }

    fn card(answers: &str, hand: Option<&HandMarks>) -> Scorecard {
        grade(&lab().0, &lab().1, &Catalogue::default(), &submission(answers), hand)
    }

    fn item<'a>(card: &'a Scorecard, id: &str) -> &'a ItemScore {
        card.questions.iter().flat_map(|question| &question.items).find(|item| item.id == id).unwrap()
    }

    #[track_caller]
    fn check(rows: &[(&str, &str, i64, &str)]) {
        for (answers, id, points, code) in rows {
            let card = card(answers, None);
            let item = item(&card, id);
            assert_eq!(
                (item.earned, item.code),
                (Points(*points), *code),
                "{answers}: {id}: {}",
                item.evidence.reason
            );
        }
    }

    /// When polemark fails on a submission, what a person gave must not be lost with it.
    #[test]
    fn what_is_left_to_a_person_keeps_the_marks_they_gave() {
        let given =
            Override { points: Points(100), reason: "marked on paper".to_owned(), answers: Vec::new() };
        let hand = HandMarks {
            cover: [("viva".to_owned(), Points(3000))].into(),
            items: [("speaker.nonlinearity.class".to_owned(), vec![given])].into(),
            ..HandMarks::default()
        };
        let card = leave_to_a_person(&lab().0, &submission(""), Some(&hand), "Our fault.");
        assert_eq!(card.total.earned, Points(100));
        assert_eq!(
            (
                item(&card, "speaker.nonlinearity.class").verdict,
                item(&card, "battery.nonlinearity.class").verdict
            ),
            (Verdict::Right, Verdict::Unmarked)
        );
        assert_eq!(item(&card, "battery.nonlinearity.class").evidence.reason, "Our fault.");
        assert!(card.cover.iter().any(|(id, _, points)| id == "viva" && *points == Some(Points(3000))));
        assert_eq!(card.cover_total, None);
        // 65 · 1 / 80 of the box that waits for the rest, and the viva.
        assert_eq!(card.so_far, Points(81 + 3000));
    }

    #[test]
    fn answers_meet_the_computed_reference() {
        let seed = "  hanging.transfer_function: 0.06s / (-0.0132s^3 - 0.0024s^2 + 0.4166s + 0.0588)\n";
        let up = "  upright.transfer_function: 0.06s / (0.0132s^3 + 0.0024s^2 - 0.4166s - 0.0588)\n";
        check(&[
            // answers, criterion, points, code
            (seed, "hanging.transfer_function.structure", 100, "right"),
            (seed, "hanging.transfer_function.numerator", 200, "right"),
            (seed, "hanging.transfer_function.denominator", 0, "denominator.sign"),
            (up, "upright.transfer_function.denominator", 100, "denominator.one_slip"),
            ("  hanging.response.poles: [-0.143, -0.0195 ± 5.59j]\n", "hanging.response.poles", 50, "right"),
            (
                "  hanging.response.poles: [-0.143, -0.0195 ± 5.59j, 0]\n",
                "hanging.response.poles",
                0,
                "poles.extra",
            ),
            ("  upright.response.poles: [5.57, -0.143, -5.61]\n", "upright.response.poles", 50, "right"),
            ("  upright.response.final_value: unbounded\n", "upright.response.final_value", 50, "right"),
            (
                "  upright.response.final_value: 0\n",
                "upright.response.final_value",
                0,
                "value.unbounded_given_number",
            ),
            ("  hanging.response.shape: damped sinusoid\n", "hanging.response.shape", 100, "right"),
            (
                "  hanging.response.stability: marginally stable\n",
                "hanging.response.stability",
                0,
                "stability.marginal",
            ),
            ("  hanging.response.stability: perhaps\n", "hanging.response.stability", 0, "unreadable"),
            ("  hanging.response.data: [1, 2]\n", "hanging.response.plot", 0, "unreadable"),
            ("  battery.nonlinearity: deadband\n", "battery.nonlinearity.class", 100, "right"),
            ("  expect_hanging: It swings.\n", "expect_hanging.oscillates", 100, "concepts.found"),
            ("  expect_hanging: ''\n", "expect_hanging.oscillates", 0, "blank"),
        ]);
    }

    #[test]
    fn letters_and_coefficients_are_the_same() {
        let forms = [
            "-0.06s / (0.0132s^3 + 0.0024s^2 + 0.412s + 0.0589)",
            "{num: [-0.06, 0], den: [0.0132, 0.0024, 0.412, 0.0589]}",
            "-m*l*s / (((M + m)*(I + m*l^2) - (m*l)^2)*s^3 + b*(I + m*l^2)*s^2 + (M + m)*m*g*l*s + b*m*g*l)",
        ];
        for form in forms {
            let card = card(&format!("  hanging.transfer_function: {form}\n"), None);
            let question =
                card.questions.iter().find(|question| question.id == "hanging.transfer_function").unwrap();
            assert_eq!(question.tally.earned, Points(500), "{form}: {:#?}", question.items);
        }
    }

    #[test]
    fn the_model_answer_earns_everything_and_a_blank_nothing() {
        let (lab, reference) = lab();
        let full = grade(lab, reference, &Catalogue::default(), &lab.model_answer, None);
        assert_eq!(full.total.earned, full.total.possible);
        let blank = card("  {}\n", None);
        assert_eq!(blank.total.earned, Points::ZERO);
        for item in blank.questions.iter().flat_map(|question| &question.items) {
            assert_eq!((item.code, item.provisional, item.position), ("blank", false, None), "{}", item.id);
            assert!(!item.evidence.expected.is_empty(), "{}", item.id);
        }
    }

    #[test]
    fn a_file_that_is_not_yaml_is_unreadable_throughout() {
        let (lab, reference) = lab();
        let broken = read("x", "x.yaml", b"answers: [", &lab.sheet, &NoFiles);
        let card = grade(lab, reference, &Catalogue::default(), &broken, None);
        for item in card.questions.iter().flat_map(|question| &question.items) {
            assert_eq!((item.verdict, item.earned), (Verdict::Unreadable, Points::ZERO), "{}", item.id);
        }
    }

    #[test]
    fn without_a_reference_a_person_decides() {
        let (lab, _) = lab();
        let nothing = Reference { lab: lab.id.clone(), models: Vec::new(), simulations: Vec::new() };
        let card = grade(lab, &nothing, &Catalogue::default(), &lab.model_answer, None);
        for id in ["hanging.transfer_function.numerator", "hanging.response.poles", "saturation.plot"] {
            assert_eq!((item(&card, id).code, item(&card, id).provisional), ("unmarked", true), "{id}");
        }
        assert!(card.cover.iter().all(|(_, _, earned)| earned.is_none()), "{:?}", card.cover);
    }

    #[test]
    fn a_person_has_the_last_word_and_fills_the_sheet() {
        let (lab, _) = lab();
        let given = |points| Override {
            points: Points(points),
            reason: "seen in the lab".into(),
            answers: Vec::new(),
        };
        let hand = HandMarks {
            cover: lab
                .cover
                .rows
                .iter()
                .filter(|row| row.from == CoverSource::ByHand)
                .map(|row| (row.id.clone(), row.points))
                .collect(),
            observed: lab.observed.iter().map(|row| (row.id.clone(), row.points)).collect(),
            items: [
                ("expect_hanging.settles".to_owned(), vec![given(75)]),
                ("saturation.plot".to_owned(), vec![given(9_999)]),
            ]
            .into(),
            ..HandMarks::default()
        };
        let card = card("  expect_hanging: It swings.\n", Some(&hand));
        let settles = item(&card, "expect_hanging.settles");
        assert_eq!(
            (settles.earned, settles.verdict, settles.provisional),
            (Points(75), Verdict::Partly, false)
        );
        assert_eq!(settles.override_reason.as_deref(), Some("seen in the lab"));
        // More than there is to get is not given.
        assert_eq!(item(&card, "saturation.plot").earned, Points::ZERO);
        assert_eq!((card.total.earned, card.total.provisional), (Points(175), Points(100)));
        // 65 · (1.75 + 35) / 80 = 29.859…, and the viva.
        assert_eq!(card.cover_total, Some(Points(2986 + 3500)));
    }

    #[test]
    fn a_mark_says_where_its_answer_stands() {
        let card = card("  battery.nonlinearity: dead zone\n", None);
        let position = item(&card, "battery.nonlinearity.class").position.unwrap();
        assert_eq!(position.line, 4);
    }
}
