use crate::report::figure::{Axis, Bar, Figure};
use crate::report::numbers::{counted, number};

/// How many submissions earned how much: `totals` in points, none beyond `possible`.
pub fn distribution(totals: &[f64], possible: f64) -> Figure {
    const BINS: usize = 15;
    let top = if possible > 0.0 { possible } else { 1.0 };
    let width = bin_width(top, BINS);
    let count = (top / width).ceil().max(1.0) as usize;
    let mut heights = vec![0_usize; count];
    for total in totals {
        let bin = (total / width).floor().clamp(0.0, (count - 1) as f64) as usize;
        heights[bin] += 1;
    }
    let highest = heights.iter().copied().max().unwrap_or(0).max(1);
    let mut figure = Figure::new(
        "Points earned in the questions",
        Axis::new("points", "", 0.0, width * count as f64),
        Axis::new("submissions", "", 0.0, highest as f64 * 1.08),
    );
    figure.bars = heights
        .iter()
        .enumerate()
        .filter(|(_, height)| **height > 0)
        .map(|(i, height)| Bar { from: i as f64 * width, to: (i + 1) as f64 * width, height: *height as f64 })
        .collect();
    let mut sorted: Vec<f64> = totals.to_vec();
    sorted.sort_by(f64::total_cmp);
    figure.summary = match sorted.len() {
        0 => "No submissions.".to_owned(),
        n => format!(
            "{}: lowest {}, median {}, highest {} of {} points.",
            counted(n, "submission"),
            number(sorted[0], 4),
            number((sorted[(n - 1) / 2] + sorted[n / 2]) / 2.0, 4),
            number(sorted[n - 1], 4),
            number(possible, 4)
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
        let figure = distribution(&[0.0, 45.0, 44.9, 20.0, 20.0], 45.0);
        assert!(figure.check().is_ok());
        assert_eq!(figure.bars.iter().map(|b| b.height).sum::<f64>(), 5.0);
        assert_eq!(figure.summary, "5 submissions: lowest 0, median 20, highest 45 of 45 points.");
        assert!(distribution(&[], 0.0).check().is_ok());
    }
}
