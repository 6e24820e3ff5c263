use super::accepted::{accepted, operating_point};
use super::mark::Mark;
use super::plot::{Demands, Target};
use super::{
    HandMarks, ItemScore, QuestionScore, Scorecard, Tally, Verdict, concepts, cover, nonlinearity, plot,
    poles, shape, stability, transfer_function, value,
};
use crate::lab::{Check, Criterion, Curve, LabDefinition, Question, SystemRef};
use crate::lti::InputKind;
use crate::reference::{LinearReference, Reference, ResponseReference};
use crate::submission::{Answer, AnswerValue, Figure, Series, Submission, Unreadable};

/// Every mark of one submission, with its evidence.
///
/// The same input gives the same scorecard. What cannot be judged is [`Verdict::Unmarked`], never silently a zero; what a
/// person decided in `hand` stands. An override whose points are out of range is ignored (reading the marks file reports it).
pub fn grade(
    lab: &LabDefinition,
    reference: &Reference,
    submission: &Submission,
    hand: Option<&HandMarks>,
) -> Scorecard {
    let grader = Grader { reference, submission };
    let questions: Vec<QuestionScore> = lab
        .questions
        .iter()
        .map(|question| {
            let marks = grader.question(question);
            let items: Vec<ItemScore> = question
                .criteria
                .iter()
                .zip(marks)
                .map(|(criterion, mark)| item_score(criterion, mark, submission, hand))
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
    Scorecard { questions, total, observed, cover_total: cover::total(&boxes), cover: boxes }
}

fn item_score(
    criterion: &Criterion,
    mark: Mark,
    submission: &Submission,
    hand: Option<&HandMarks>,
) -> ItemScore {
    let given = hand
        .and_then(|hand| hand.items.get(&criterion.id))
        .filter(|given| (crate::lab::Points::ZERO..=criterion.points).contains(&given.points));
    let mark = match given {
        Some(given) => given.apply(criterion.points, mark),
        None => mark,
    };
    ItemScore {
        id: criterion.id.clone(),
        title: criterion.title.clone(),
        earned: mark.earned,
        possible: criterion.points,
        verdict: mark.verdict,
        code: mark.code,
        evidence: mark.evidence,
        provisional: mark.provisional,
        override_reason: given.map(|given| given.reason.clone()),
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

struct Grader<'a> {
    reference: &'a Reference,
    submission: &'a Submission,
}

/// What stands in a field.
enum Field<'a> {
    Blank,
    Unreadable(&'a Answer, &'a Unreadable),
    Value(&'a Answer, &'a AnswerValue),
}

impl<'a> Grader<'a> {
    fn field(&self, path: &str) -> Field<'a> {
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
            match transfer_function_of(criterion) {
                None => marks[index] = Some(self.criterion(criterion)),
                Some(of) => {
                    // Criteria on one transfer function are judged together: they share one reading of it.
                    let same: Vec<usize> = (index..question.criteria.len())
                        .filter(|&other| {
                            let other = &question.criteria[other];
                            other.field == criterion.field && transfer_function_of(other) == Some(of)
                        })
                        .collect();
                    let criteria: Vec<&Criterion> =
                        same.iter().map(|&place| &question.criteria[place]).collect();
                    for (place, mark) in same.iter().zip(self.transfer_function(&criteria, of)) {
                        marks[*place] = Some(mark);
                    }
                }
            }
        }
        let missing =
            || Mark::unmarked(String::new(), String::new(), "polemark did not judge this; a person will.");
        marks.into_iter().map(|mark| mark.unwrap_or_else(missing)).collect()
    }

    fn transfer_function(&self, criteria: &[&Criterion], of: &SystemRef) -> Vec<Mark> {
        let accepted = accepted(self.reference, of, |one| &one.linearization.transfer_function);
        let Some(first) = criteria.first() else { return Vec::new() };
        if let Field::Value(_, AnswerValue::TransferFunction { transfer_function: typed, .. }) =
            self.field(&first.field)
        {
            return transfer_function::judge(criteria, &accepted, typed);
        }
        let expected = |criterion: &Criterion| transfer_function::expected(&criterion.check, &accepted);
        criteria.iter().map(|criterion| self.without_value(criterion, expected(criterion))).collect()
    }

    /// The mark of a criterion whose answer is not there, cannot be read, or is not of the kind it judges.
    fn without_value(&self, criterion: &Criterion, expected: String) -> Mark {
        match self.field(&criterion.field) {
            Field::Blank if !self.submission.readable => unreadable_file(expected, self.submission),
            Field::Blank => Mark::blank(expected),
            Field::Unreadable(answer, why) => Mark::unreadable(expected, answer, why),
            Field::Value(answer, _) => Mark::unmarked(
                expected,
                answer.text.clone(),
                "This answer is of another kind than the one that is judged here; a person will mark it.",
            ),
        }
    }

    fn criterion(&self, criterion: &Criterion) -> Mark {
        let points = criterion.points;
        let value = match self.field(&criterion.field) {
            Field::Value(_, value) => Some(value),
            _ => None,
        };
        match &criterion.check {
            Check::Structure { .. } | Check::Numerator { .. } | Check::Denominator { .. } => {
                self.without_value(criterion, String::new())
            }
            Check::Poles { of, tolerance } => {
                let accepted = accepted(self.reference, of, |one| one.poles.as_slice());
                match value {
                    Some(AnswerValue::Poles(typed)) => {
                        let internal = operating_point(self.reference, of)
                            .and_then(|point| point.accepted.first())
                            .map_or(&[][..], |one| one.internal_poles.as_slice());
                        poles::judge(points, &accepted, internal, tolerance, typed)
                    }
                    _ => self.without_value(criterion, poles::expected(&accepted, tolerance)),
                }
            }
            Check::Stability { of } => {
                let accepted = accepted(self.reference, of, |one| &one.stability);
                match value {
                    Some(AnswerValue::Stability(typed)) => {
                        let whole = operating_point(self.reference, of)
                            .and_then(|point| point.accepted.first())
                            .map(|one| one.internal_stability);
                        stability::judge(points, &accepted, whole, *typed)
                    }
                    _ => self.without_value(criterion, stability::expected(&accepted)),
                }
            }
            Check::Feature { of, response, feature, tolerance } => {
                let accepted = accepted(self.reference, of, |one| &response_of(one, *response).features);
                match value {
                    Some(AnswerValue::Value(typed)) => {
                        value::judge(points, &accepted, *feature, tolerance, typed)
                    }
                    _ => self.without_value(criterion, value::expected(&accepted, *feature, tolerance)),
                }
            }
            Check::Shape { of, response } => {
                let accepted =
                    accepted(self.reference, of, |one| &response_of(one, *response).features.shape);
                match value {
                    Some(AnswerValue::Shape(typed)) => shape::judge(points, &accepted, *typed),
                    _ => self.without_value(criterion, shape::expected(&accepted)),
                }
            }
            Check::Nonlinearity { expected } => match value {
                Some(AnswerValue::Nonlinearity(typed)) => nonlinearity::judge(points, *expected, *typed),
                _ => self.without_value(criterion, nonlinearity::expected(*expected)),
            },
            Check::Concepts { concepts: wanted, needed, contradictions } => match value {
                Some(AnswerValue::Prose(prose)) => {
                    concepts::judge(points, wanted, *needed, contradictions, prose)
                }
                _ => self.without_value(criterion, concepts::expected(wanted, *needed)),
            },
            Check::Plot { data, curve, tolerance, min_points, span_s } => {
                let demands = Demands { tolerance, min_points: *min_points, span_s: *span_s };
                self.plot(criterion, data.as_deref(), curve, &demands)
            }
        }
    }

    fn plot(&self, criterion: &Criterion, data: Option<&str>, curve: &Curve, demands: &Demands<'_>) -> Mark {
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
            return plot::judge(criterion.points, &self.targets(curve), demands, series, figure);
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

    fn targets(&self, curve: &Curve) -> Vec<Target<'a>> {
        match curve {
            Curve::Response { of, response } => {
                accepted(self.reference, of, |one| response_of(one, *response))
                    .into_iter()
                    .map(|one| {
                        let known = one.what;
                        Target {
                            with: one.with(),
                            at: Box::new(move |t| known.response.at(t)),
                            samples: &known.samples,
                            until_s: f64::INFINITY,
                        }
                    })
                    .collect()
            }
            Curve::Simulation { id } => self
                .reference
                .simulations
                .iter()
                .filter(|simulation| simulation.id == *id)
                .map(|simulation| Target {
                    with: String::new(),
                    at: Box::new(move |t| simulation.with.at(t)),
                    samples: &simulation.with.samples,
                    until_s: simulation.with.samples.last().map_or(0.0, |(t, _)| *t),
                })
                .collect(),
        }
    }
}

fn transfer_function_of(criterion: &Criterion) -> Option<&SystemRef> {
    match &criterion.check {
        Check::Structure { of } | Check::Numerator { of, .. } | Check::Denominator { of, .. } => Some(of),
        _ => None,
    }
}

fn response_of(linear: &LinearReference, response: InputKind) -> &ResponseReference {
    match response {
        InputKind::Impulse => &linear.impulse,
        InputKind::Step => &linear.step,
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
