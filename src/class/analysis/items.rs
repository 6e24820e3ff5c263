use crate::class::Record;
use crate::lab::{LabDefinition, Points};
use crate::report::ItemStatistics;
use std::collections::BTreeMap;

/// Fewer submissions have no upper and lower group worth comparing.
const FEWEST_FOR_GROUPS: u64 = 10;

/// How hard each criterion and each question was, and how well it tells strong submissions from weak ones.
///
/// Sums of hundredths, exact and the same in any order.
pub struct ItemAnalysis {
    /// Place among `sums` by the criterion's id.
    places: BTreeMap<String, usize>,
    /// The criteria in the lab's order, then the questions.
    sums: Vec<Sums>,
    criteria: usize,
    /// By the total of a submission: how many have it, and what they earned of each of `sums`.
    by_total: BTreeMap<i64, (u64, Vec<i64>)>,
}

/// Of one criterion or question; x is what a submission earned of it, t its total, in hundredths.
#[derive(Clone, Default)]
struct Sums {
    id: String,
    possible: Points,
    x: i128,
    xx: i128,
    xt: i128,
    verdicts: BTreeMap<String, usize>,
    provisional: usize,
}

impl ItemAnalysis {
    pub fn new(lab: &LabDefinition) -> Self {
        let of = |id: &str, possible| Sums { id: id.to_owned(), possible, ..Sums::default() };
        let criteria = lab.questions.iter().flat_map(|question| &question.criteria);
        let mut sums: Vec<Sums> = criteria.map(|one| of(&one.id, one.points)).collect();
        let places = sums.iter().enumerate().map(|(place, sums)| (sums.id.clone(), place)).collect();
        let criteria = sums.len();
        sums.extend(lab.questions.iter().map(|question| of(&question.id, question.points)));
        Self { places, sums, criteria, by_total: BTreeMap::new() }
    }

    pub fn add(&mut self, record: &Record) {
        let t = record.total.earned.0;
        let mut earned = vec![0; self.sums.len()];
        for item in &record.items {
            let Some(&place) = self.places.get(&item.id) else { continue };
            earned[place] = item.earned.0;
            *self.sums[place].verdicts.entry(item.verdict.clone()).or_default() += 1;
            self.sums[place].provisional += usize::from(item.provisional);
        }
        for (place, question) in record.questions.iter().enumerate() {
            if let Some(earned) = earned.get_mut(self.criteria + place) {
                *earned = question.tally.earned.0;
            }
        }
        for (sums, x) in self.sums.iter_mut().zip(&earned) {
            let (x, t) = (i128::from(*x), i128::from(t));
            sums.x += x;
            sums.xx += x * x;
            sums.xt += x * t;
        }
        let (n, all) = self.by_total.entry(t).or_insert_with(|| (0, vec![0; earned.len()]));
        *n += 1;
        for (sum, x) in all.iter_mut().zip(earned) {
            *sum += x;
        }
    }

    /// Submissions so far.
    pub fn count(&self) -> u64 {
        self.by_total.values().map(|(n, _)| n).sum()
    }

    /// (total, how many submissions have it), the lowest first.
    pub fn totals(&self) -> Vec<(Points, u64)> {
        self.by_total.iter().map(|(total, (n, _))| (Points(*total), *n)).collect()
    }

    /// Mean of the totals, in points; `None` for nobody.
    pub fn mean(&self) -> Option<f64> {
        let (sum, n) = self.by_total.iter().fold((0_i128, 0_u64), |(sum, count), (total, (n, _))| {
            (sum + i128::from(*total) * i128::from(*n), count + n)
        });
        (n > 0).then(|| sum as f64 / 100.0 / n as f64)
    }

    /// Of each criterion, in the lab's order.
    pub fn criteria(&self) -> Vec<ItemStatistics> {
        (0..self.criteria).map(|place| self.statistics(place)).collect()
    }

    /// Of each question, in the lab's order.
    pub fn questions(&self) -> Vec<ItemStatistics> {
        (self.criteria..self.sums.len()).map(|place| self.statistics(place)).collect()
    }

    fn statistics(&self, place: usize) -> ItemStatistics {
        let sums = &self.sums[place];
        let verdict = |name: &str| sums.verdicts.get(name).copied().unwrap_or(0);
        let n = self.count();
        let mean = (n > 0).then(|| sums.x as f64 / 100.0 / n as f64);
        ItemStatistics {
            id: sums.id.clone(),
            possible: sums.possible,
            mean,
            facility: mean.map(|mean| mean / sums.possible.as_f64().max(0.01)),
            discrimination: self.discrimination(sums),
            upper_less_lower: self.upper_less_lower(place),
            right: verdict("right"),
            partly: verdict("partly"),
            wrong: verdict("wrong"),
            blank: verdict("blank"),
            open: verdict("unreadable") + verdict("unmarked"),
            provisional: sums.provisional,
        }
    }

    /// Correlation of x with the rest y = t − x of the points; `None` where x or y is the same for all.
    fn discrimination(&self, sums: &Sums) -> Option<f64> {
        let n = i128::from(self.count());
        let (mut t, mut tt) = (0, 0);
        for (total, (n, _)) in &self.by_total {
            let (total, n) = (i128::from(*total), i128::from(*n));
            t += n * total;
            tt += n * total * total;
        }
        let y = t - sums.x;
        let yy = tt - 2 * sums.xt + sums.xx;
        let xy = sums.xt - sums.xx;
        let spread_x = n * sums.xx - sums.x * sums.x;
        let spread_y = n * yy - y * y;
        if spread_x <= 0 || spread_y <= 0 {
            return None;
        }
        let r = (n * xy - sums.x * y) as f64 / ((spread_x as f64).sqrt() * (spread_y as f64).sqrt());
        Some(r.clamp(-1.0, 1.0))
    }

    /// Facility among the best 27 % less that among the weakest 27 %, by total; those who share the border's total count each
    /// for the same part. `None` for fewer than ten submissions, or when all have the same total.
    fn upper_less_lower(&self, place: usize) -> Option<f64> {
        let n = self.count();
        if n < FEWEST_FOR_GROUPS || self.by_total.len() < 2 {
            return None;
        }
        let group = (27 * n).div_ceil(100);
        let points = |totals: &mut dyn Iterator<Item = &(u64, Vec<i64>)>| {
            let (mut left, mut sum) = (group, 0.0);
            for (n, earned) in totals {
                let taken = left.min(*n);
                sum += earned[place] as f64 * taken as f64 / *n as f64;
                left -= taken;
                if left == 0 {
                    break;
                }
            }
            sum
        };
        let upper = points(&mut self.by_total.values().rev());
        let lower = points(&mut self.by_total.values());
        let possible = self.sums[place].possible.0.max(1) as f64;
        Some((upper - lower) / (group as f64 * possible))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::class::analysis::samples::{record_of, worth};

    /// Criteria a and b of one question with 100 hundredths each; rows are what each submission earned.
    fn analysis(rows: &[(i64, i64)]) -> ItemAnalysis {
        let of = |id: &str, possible| Sums { id: id.to_owned(), possible, ..Sums::default() };
        let mut analysis = ItemAnalysis {
            places: [("q.a".to_owned(), 0), ("q.b".to_owned(), 1)].into(),
            sums: vec![of("q.a", Points(100)), of("q.b", Points(100)), of("q", Points(200))],
            criteria: 2,
            by_total: BTreeMap::new(),
        };
        for (a, b) in rows {
            analysis.add(&record_of(&[worth("q.a", "right", *a), worth("q.b", "wrong", *b)]));
        }
        analysis
    }

    #[track_caller]
    fn check(rows: &[(i64, i64)], facility: Option<f64>, discrimination: Option<f64>) {
        let statistics = analysis(rows).statistics(0);
        let near = |got: Option<f64>, want: Option<f64>| match (got, want) {
            (Some(got), Some(want)) => (got - want).abs() < 1e-12,
            (got, want) => got == want,
        };
        assert!(near(statistics.facility, facility), "{rows:?}: facility {:?}", statistics.facility);
        assert!(
            near(statistics.discrimination, discrimination),
            "{rows:?}: discrimination {:?}",
            statistics.discrimination
        );
    }

    #[test]
    fn facility_and_discrimination_by_hand() {
        check(&[], None, None);
        check(&[(50, 0)], Some(0.5), None);
        // a: 1 1 0 0, rest b: 1 0 1 0: independent.
        check(&[(100, 100), (100, 0), (0, 100), (0, 0)], Some(0.5), Some(0.0));
        // The rest goes with it, and against it.
        check(&[(100, 100), (0, 0)], Some(0.5), Some(1.0));
        check(&[(100, 0), (0, 100)], Some(0.5), Some(-1.0));
        // a: 1 1 1 0, b: 1 1 0 0. cov = 1/8, var a = 3/16, var b = 1/4: r = (1/8) / sqrt(3/64) = 1/sqrt(3).
        check(&[(100, 100), (100, 100), (100, 0), (0, 0)], Some(0.75), Some(1.0 / 3.0_f64.sqrt()));
        // No spread: of the criterion, of the rest.
        check(&[(100, 100), (100, 0)], Some(1.0), None);
        check(&[(100, 0), (0, 0)], Some(0.5), None);
        // Parts of points: a: 1 0.5 0, b: 1 0 0. cov = 1/6, var a = 1/6, var b = 2/9: r = sqrt(3)/2.
        check(&[(100, 100), (50, 0), (0, 0)], Some(0.5), Some(3.0_f64.sqrt() / 2.0));
    }

    #[test]
    fn the_best_and_the_weakest_27_per_cent() {
        // Totals 0, 1 … 10 in tenths of a point; groups of ceil(2.97) = 3. The best earned a, the weakest did not.
        let ten: Vec<(i64, i64)> = (0..11).map(|i| (if i >= 8 { 100 } else { 0 }, 10 * i)).collect();
        assert_eq!(analysis(&ten).statistics(0).upper_less_lower, Some(1.0));
        assert_eq!(analysis(&ten[..9]).statistics(0).upper_less_lower, None, "too few");
        assert_eq!(analysis(&[(50, 50); 12]).statistics(0).upper_less_lower, None, "no spread");
        // Ten with total 1 and two with 2: the best four are the two, and two of the ten shared between them.
        let mut shared = vec![(100, 0); 5];
        shared.extend([(0, 100); 5]);
        shared.extend([(100, 100); 2]);
        // upper: 2 + 2·½ = 3 of 4; lower: 4·½ = 2 of 4.
        assert_eq!(analysis(&shared).statistics(0).upper_less_lower, Some(0.25));
    }

    #[test]
    fn a_question_is_held_against_the_rest_of_the_points() {
        let analysis = analysis(&[(100, 100), (0, 0)]);
        let question = &analysis.questions()[0];
        assert_eq!((question.mean, question.facility), (Some(1.0), Some(0.5)));
        assert_eq!(question.discrimination, None, "it is all there is");
        assert_eq!(analysis.totals(), [(Points(0), 1), (Points(200), 1)]);
        assert_eq!((analysis.criteria()[0].right, analysis.criteria()[1].wrong), (2, 2));
    }
}
