use crate::lab::Points;
use crate::report::figure::{Axis, Bar, Figure};
use crate::report::numbers::{counted, number};

/// Where a class stands: the numbers of a list of (points, how many earned them), the lowest first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Middle {
    pub lowest: f64,
    pub highest: f64,
    pub median: f64,
    pub mean: f64,
    /// Of a sample, so over n − 1; `None` for one submission.
    pub deviation: Option<f64>,
}

impl Middle {
    /// `None` for nobody.
    pub fn of(totals: &[(Points, u64)]) -> Option<Self> {
        let (first, last) = (totals.first()?, totals.last()?);
        let n: u64 = totals.iter().map(|(_, n)| n).sum();
        let (mut sum, mut squares) = (0_i128, 0_i128);
        for (points, n) in totals {
            let (points, n) = (i128::from(points.0), i128::from(*n));
            sum += n * points;
            squares += n * points * points;
        }
        let at = |rank: u64| {
            let mut left = rank;
            let found = totals.iter().find(|(_, n)| {
                let here = left < *n;
                left = left.saturating_sub(*n);
                here
            });
            found.map_or(0.0, |(points, _)| points.as_f64())
        };
        let (whole, n) = (i128::from(n), n);
        Some(Self {
            lowest: first.0.as_f64(),
            highest: last.0.as_f64(),
            median: (at((n - 1) / 2) + at(n / 2)) / 2.0,
            mean: sum as f64 / 100.0 / n as f64,
            deviation: (n > 1).then(|| {
                let squared = (whole * squares - sum * sum) as f64 / (whole * (whole - 1)) as f64;
                squared.max(0.0).sqrt() / 100.0
            }),
        })
    }
}

/// How many submissions have how much, of `totals` as [`Middle::of`] takes them; none beyond `possible`.
pub fn distribution(title: &str, totals: &[(Points, u64)], possible: Points) -> Figure {
    const BINS: usize = 15;
    let top = if possible > Points::ZERO { possible.as_f64() } else { 1.0 };
    let width = bin_width(top, BINS);
    let count = (top / width).ceil().max(1.0) as usize;
    let mut heights = vec![0_u64; count];
    for (points, n) in totals {
        let bin = (points.as_f64() / width).floor().clamp(0.0, (count - 1) as f64) as usize;
        heights[bin] += n;
    }
    let highest = heights.iter().copied().max().unwrap_or(0).max(1);
    let mut figure = Figure::new(
        title,
        Axis::new("points", "", 0.0, width * count as f64),
        Axis::new("submissions", "", 0.0, highest as f64 * 1.08),
    );
    figure.bars = heights
        .iter()
        .enumerate()
        .filter(|(_, height)| **height > 0)
        .map(|(i, height)| Bar { from: i as f64 * width, to: (i + 1) as f64 * width, height: *height as f64 })
        .collect();
    figure.summary = match Middle::of(totals) {
        None => "No submissions.".to_owned(),
        Some(middle) => format!(
            "{}: lowest {}, median {}, highest {} of {possible} points.",
            counted(totals.iter().map(|(_, n)| n).sum::<u64>(), "submission"),
            number(middle.lowest, 4),
            number(middle.median, 4),
            number(middle.highest, 4),
        ),
    };
    figure
}

/// A round width that cuts `top` into about `bins`.
fn bin_width(top: f64, bins: usize) -> f64 {
    let rough = top / bins as f64;
    let decade = 10_f64.powf(rough.log10().floor());
    [1.0, 2.0, 2.5, 5.0, 10.0].into_iter().map(|k| k * decade).find(|w| *w >= rough).unwrap_or(rough)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_submission_is_in_one_bar() {
        let totals = [(0, 1), (2000, 2), (4490, 1), (4500, 1)].map(|(points, n)| (Points(points), n));
        let figure = distribution("Marks", &totals, Points(4500));
        assert!(figure.check().is_ok());
        assert_eq!(figure.bars.iter().map(|b| b.height).sum::<f64>(), 5.0);
        assert_eq!(figure.summary, "5 submissions: lowest 0, median 20, highest 45 of 45 points.");
        assert!(distribution("Marks", &[], Points::ZERO).check().is_ok());
    }

    #[track_caller]
    fn check(totals: &[(i64, u64)], median: f64, mean: f64, deviation: Option<f64>) {
        let totals: Vec<_> = totals.iter().map(|(points, n)| (Points(*points), *n)).collect();
        let got = Middle::of(&totals).unwrap();
        assert_eq!((got.median, got.mean), (median, mean), "{totals:?}");
        let near = |got: f64| deviation.is_some_and(|want| (got - want).abs() < 1e-12);
        assert_eq!(got.deviation.is_some(), deviation.is_some());
        assert!(got.deviation.is_none_or(near), "{totals:?}: {:?}", got.deviation);
    }

    #[test]
    fn the_middle_of_a_class_by_hand() {
        check(&[(150, 1)], 1.5, 1.5, None);
        check(&[(100, 1), (200, 1)], 1.5, 1.5, Some(0.5_f64.sqrt()));
        check(&[(100, 3), (500, 1)], 1.0, 2.0, Some(2.0));
        check(&[(200, 4)], 2.0, 2.0, Some(0.0));
        assert_eq!(Middle::of(&[]), None);
    }
}
