use crate::report::figure::{Look, Series, extent, padded};
use crate::report::numbers::quantity;
use crate::submission;

/// How far beyond the reference another curve may stretch the picture, in heights of the reference: as a whole, or to be seen
/// leaving when the whole does not fit.
const STRETCH: f64 = 1.6;
const GLIMPSE: f64 = 0.35;

/// The range shown: all of the reference and of 0, and as much of the other curves as leaves the reference readable.
pub fn frame(reference: &[(f64, f64)], others: &[&[(f64, f64)]]) -> (f64, f64) {
    let values = reference.iter().map(|p| p.1).chain([0.0]);
    let (mut low, mut high) = extent(values).unwrap_or((-1.0, 1.0));
    let height = if high > low { high - low } else { 1.0 };
    let around = |share: f64| (low - share * height, high + share * height);
    let (wide, glimpse) = (around(STRETCH), around(GLIMPSE));
    for other in others {
        let fits = other.iter().all(|(_, y)| (wide.0..=wide.1).contains(y));
        let (least, most) = if fits { wide } else { glimpse };
        for (_, y) in other.iter().filter(|(_, y)| y.is_finite()) {
            low = low.min(y.max(least));
            high = high.max(y.min(most));
        }
    }
    padded(low, high, 0.06)
}

/// When `points` first stands outside `range`.
pub fn leaves_at(points: &[(f64, f64)], range: (f64, f64)) -> Option<f64> {
    points.iter().find(|(_, y)| !(range.0..=range.1).contains(y)).map(|p| p.0)
}

/// `Your curve leaves the picture at t = 3.2 s.`, or nothing.
pub fn leaving_words(whose: &str, points: &[(f64, f64)], range: (f64, f64)) -> String {
    match leaves_at(points, range) {
        Some(t) if t > 0.0 => format!(" {whose} leaves the picture at t = {}.", quantity(t, 3, "s")),
        Some(_) => format!(" {whose} starts outside the picture."),
        None => String::new(),
    }
}

/// The student's columns as curves, at most three; rows without finite numbers are passed over.
pub fn data_series(data: &submission::Series, end_s: f64) -> Vec<Series> {
    let columns = data.headers.len().saturating_sub(1).min(3);
    (1..=columns)
        .map(|column| {
            let header: String =
                data.headers[column].trim().chars().filter(|c| !c.is_control()).take(24).collect();
            let name = match (columns, header.is_empty()) {
                (1, _) => "your data".to_owned(),
                (_, true) => format!("your data, column {}", column + 1),
                (_, false) => format!("your data: {header}"),
            };
            let point = |row: &Vec<f64>| Some((*row.first()?, *row.get(column)?));
            let points = data
                .rows
                .iter()
                .filter_map(point)
                .filter(|(t, y)| t.is_finite() && y.is_finite() && *t <= end_s)
                .collect();
            Series { name, look: [Look::Given, Look::Other, Look::Student][column - 1], points }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wild_curve_does_not_squash_the_reference() {
        let reference = [(0.0, -1.0), (1.0, 1.0)];
        let wild = [(0.0, 0.0), (1.0, 1e9), (2.0, f64::INFINITY)];
        let (low, high) = frame(&reference, &[&wild]);
        assert!((-1.6..-1.0).contains(&low) && (1.5..2.0).contains(&high), "{low}..{high}");
        let (_, high) = frame(&reference, &[&[(0.0, 0.0), (1.0, 3.0)]]);
        assert!((3.0..3.5).contains(&high), "a curve that fits is shown whole, up to {high}");
        let (low, high) = frame(&reference, &[&wild]);
        assert_eq!(leaves_at(&wild, (low, high)), Some(1.0));
        assert_eq!(
            leaving_words("Your curve", &wild, (low, high)),
            " Your curve leaves the picture at t = 1\u{a0}s."
        );
        assert_eq!(leaving_words("Your curve", &reference, (low, high)), "");
    }

    #[test]
    fn short_rows_and_odd_headers_do_no_harm() {
        let data = submission::Series {
            file_name: "a.csv".into(),
            headers: vec!["t".into(), "speed\u{1b}[31m".into(), String::new()],
            rows: vec![vec![0.0, 1.0, 2.0], vec![1.0], vec![2.0, f64::NAN, 3.0], vec![9.0, 1.0, 1.0]],
        };
        let series = data_series(&data, 5.0);
        assert_eq!(series.len(), 2);
        assert_eq!(series[0].points, [(0.0, 1.0)]);
        assert_eq!(series[1].points, [(0.0, 2.0), (2.0, 3.0)]);
        assert_eq!(series[0].name, "your data: speed[31m");
    }
}
