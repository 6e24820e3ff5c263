use super::HandMarks;
use crate::algebra::Rational;
use crate::grading::Scorecard;
use crate::grading::mark::share;
use crate::lab::Points;

/// Points given or taken beside the cover sheet, and why.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Adjustment {
    /// `None` while it is a part of a sum that waits for a person.
    pub points: Option<Points>,
    pub reason: String,
}

/// What it costs to hand in late.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LateRule {
    pub cost: LateCost,
    pub reason: String,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LateCost {
    /// So many points, as a number that is not negative.
    Points(Points),
    /// So many hundredths of a percent of what was earned.
    Percent(Points),
}

impl HandMarks {
    /// What changes the sum of the cover sheet, `total`, for work that came late or not: lateness first, as the LMS says it unless a
    /// person says otherwise.
    pub fn adjustments_of(&self, total: Option<Points>, late: bool) -> Vec<Adjustment> {
        let rule = self.late_rule.as_ref().filter(|_| self.late.unwrap_or(late));
        let lateness = rule.map(|rule| Adjustment {
            points: match rule.cost {
                LateCost::Points(points) => Some(Points::ZERO - points),
                LateCost::Percent(percent) => total.map(|total| {
                    let part = Rational::from(percent.0) / Rational::from(10_000);
                    Points::ZERO - share(total, &part)
                }),
            },
            reason: rule.reason.clone(),
        });
        lateness.into_iter().chain(self.adjustments.iter().cloned()).collect()
    }
}

impl Scorecard {
    /// Enters adjustments and works out the mark: the sum of the cover sheet with them, within 0 and `possible`.
    pub fn adjust(&mut self, adjustments: Vec<Adjustment>, possible: Points) {
        let by: Option<Points> = adjustments.iter().map(|one| one.points).sum();
        let sum = self.cover_total.zip(by).map(|(total, by)| total + by);
        self.mark = sum.map(|sum| sum.clamp(Points::ZERO, possible.max(Points::ZERO)));
        self.adjustments = adjustments;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grading::{Ledger, Tally};

    #[track_caller]
    fn check(hand: &HandMarks, total: Option<i64>, late: bool, by: &[Option<i64>], mark: Option<i64>) {
        let total = total.map(Points);
        let mut card = Scorecard {
            questions: Vec::new(),
            total: Tally::default(),
            observed: Vec::new(),
            cover: Vec::new(),
            cover_total: total,
            so_far: Points::ZERO,
            ledger: Ledger::default(),
            answers: Default::default(),
            adjustments: Vec::new(),
            mark: None,
        };
        card.adjust(hand.adjustments_of(total, late), Points(10_000));
        let found: Vec<_> = card.adjustments.iter().map(|one| one.points.map(|points| points.0)).collect();
        assert_eq!((found.as_slice(), card.mark.map(|points| points.0)), (by, mark));
    }

    #[test]
    fn the_mark_is_the_sum_with_adjustments_within_its_bounds() {
        let rule = |cost| Some(LateRule { cost, reason: "late".to_owned() });
        let by = |points| Adjustment { points: Some(Points(points)), reason: "because".to_owned() };
        let none = HandMarks::default();
        check(&none, Some(8000), true, &[], Some(8000));
        check(&none, None, true, &[], None);
        let five = HandMarks { late_rule: rule(LateCost::Points(Points(500))), ..none.clone() };
        check(&five, Some(8000), true, &[Some(-500)], Some(7500));
        check(&five, Some(8000), false, &[], Some(8000));
        check(&five, Some(300), true, &[Some(-500)], Some(0));
        check(&five, None, true, &[Some(-500)], None);
        check(&HandMarks { late: Some(false), ..five.clone() }, Some(8000), true, &[], Some(8000));
        check(&HandMarks { late: Some(true), ..five.clone() }, Some(8000), false, &[Some(-500)], Some(7500));
        let tenth = HandMarks { late_rule: rule(LateCost::Percent(Points(1000))), ..none };
        check(&tenth, Some(8125), true, &[Some(-813)], Some(7312));
        check(&tenth, None, true, &[None], None);
        let both = HandMarks { adjustments: vec![by(-500), by(200)], ..tenth };
        check(&both, Some(8000), true, &[Some(-800), Some(-500), Some(200)], Some(6900));
        check(&both, Some(9900), false, &[Some(-500), Some(200)], Some(9600));
        check(
            &HandMarks { adjustments: vec![by(900)], ..both },
            Some(9900),
            false,
            &[Some(900)],
            Some(10_000),
        );
    }
}
