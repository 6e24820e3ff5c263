use crate::algebra::Rational;
use crate::class::Record;
use crate::lab::{LabDefinition, Points};
use crate::report::Attainment;

/// How far students reach the lab's outcomes.
///
/// Of an outcome count the questions and observed rows that name it, each with all its points. A row that waits for a person is
/// left out of what could be earned. Members of a group are a student each.
pub struct Attainments {
    outcomes: Vec<Assessed>,
}

struct Assessed {
    /// Places of the questions and the observed rows that assess it.
    questions: Vec<usize>,
    observed: Vec<usize>,
    target: Option<Rational>,
    result: Attainment,
    /// Sum over students of what each earned of the points assessing it, 0 to 1.
    shares: f64,
}

impl Attainments {
    pub fn new(lab: &LabDefinition) -> Self {
        let outcomes = lab.outcomes.iter().map(|outcome| {
            let assesses = |ids: &[String]| ids.contains(&outcome.id);
            let questions = lab.questions.iter().enumerate().filter(|(_, one)| assesses(&one.outcomes));
            let observed = lab.observed.iter().enumerate().filter(|(_, one)| assesses(&one.outcomes));
            let possible = questions.clone().map(|(_, one)| one.points).sum::<Points>()
                + observed.clone().map(|(_, one)| one.points).sum();
            Assessed {
                questions: questions.map(|(place, _)| place).collect(),
                observed: observed.map(|(place, _)| place).collect(),
                target: outcome.target.clone(),
                result: Attainment {
                    id: outcome.id.clone(),
                    text: outcome.text.clone(),
                    target: outcome.target.clone(),
                    possible,
                    students: 0,
                    reached: 0,
                    waiting: 0,
                    mean_share: None,
                },
                shares: 0.0,
            }
        });
        Self { outcomes: outcomes.collect() }
    }

    pub fn add(&mut self, record: &Record) {
        let students = record.students.len().max(1);
        for outcome in &mut self.outcomes {
            let (mut earned, mut possible, mut waits) = (Points::ZERO, Points::ZERO, false);
            for question in outcome.questions.iter().filter_map(|place| record.questions.get(*place)) {
                earned += question.tally.earned;
                possible += question.tally.possible;
                waits |= question.tally.provisional > Points::ZERO;
            }
            for row in outcome.observed.iter().filter_map(|place| record.observed.get(*place)) {
                let Some(given) = row.earned else {
                    waits = true;
                    continue;
                };
                earned += given;
                possible += row.possible;
            }
            outcome.result.waiting += if waits { students } else { 0 };
            if possible <= Points::ZERO {
                continue;
            }
            let reached = outcome.target.as_ref().is_some_and(|target| {
                Rational::from(earned.0) >= target.clone() * Rational::from(possible.0)
            });
            outcome.result.students += students;
            outcome.result.reached += if reached { students } else { 0 };
            outcome.shares += students as f64 * earned.as_f64() / possible.as_f64();
        }
    }

    /// In the lab's order; outcomes that nothing assesses are left out.
    pub fn list(&self) -> Vec<Attainment> {
        let assessed = self.outcomes.iter().filter(|one| one.result.possible > Points::ZERO);
        let list = assessed.map(|one| Attainment {
            mean_share: (one.result.students > 0).then(|| one.shares / one.result.students as f64),
            ..one.result.clone()
        });
        list.collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::algebra::parse_decimal;
    use crate::class::analysis::samples::{record_of, worth};

    #[test]
    fn the_share_is_of_the_points_that_could_be_earned_and_the_target_itself_is_reached() {
        let target = parse_decimal("0.6").ok();
        let result = Attainment {
            id: "a".into(),
            text: String::new(),
            target: target.clone(),
            possible: Points(1500),
            students: 0,
            reached: 0,
            waiting: 0,
            mean_share: None,
        };
        let assessed = Assessed { questions: vec![0], observed: vec![0], target, result, shares: 0.0 };
        let mut attainments = Attainments { outcomes: vec![assessed] };
        // (earned of 10 in the question, of 5 in the observed row): exactly 60 %, below, and a row that waits.
        for (earned, seen, group) in [(400, Some(500), 1), (500, Some(300), 2), (700, None, 1)] {
            let mut record = record_of(&[worth("q.a", "partly", earned)]);
            record.questions[0].tally.possible = Points(1000);
            record.students = vec![record.students[0].clone(); group];
            record.observed.push(crate::class::record::BoxRecord {
                id: "o".into(),
                earned: seen.map(Points),
                possible: Points(500),
            });
            attainments.add(&record);
        }
        let got = &attainments.list()[0];
        assert_eq!((got.students, got.reached, got.waiting), (4, 2, 1));
        // (0.6 + 2·0.5333 + 0.7) / 4
        assert!((got.mean_share.unwrap() - (0.6 + 2.0 * 8.0 / 15.0 + 0.7) / 4.0).abs() < 1e-12);

        // All of it waits: nobody's share is known, and that is said.
        attainments.outcomes[0].questions.clear();
        let mut record = record_of(&[worth("q.a", "partly", 100)]);
        let row = crate::class::record::BoxRecord { id: "o".into(), earned: None, possible: Points(500) };
        record.observed.push(row);
        attainments.add(&record);
        let got = &attainments.list()[0];
        assert_eq!((got.students, got.waiting), (4, 2));
    }
}
