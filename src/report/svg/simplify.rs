use std::f64::consts::PI;

/// A polyline with few of its points that stays within `tolerance` of it; a dense oscillation becomes the lowest and highest
/// point of each pixel column.
///
/// Units: tenths of a pixel. Time grows with the number of points alone. Source: the cone of Sklansky & Gonzalez, Pattern
/// Recognition 12(5), 1980: a point is left out while one line from the last kept point passes all left out within `tolerance`.
pub fn simplify(points: &[(i32, i32)], tolerance: f64) -> Vec<(i32, i32)> {
    let points = columns(points);
    let (Some(&first), Some(&last)) = (points.first(), points.last()) else { return points };
    let mut kept = vec![first];
    let mut previous = first;
    let mut cone = Cone::from(first);
    for &p in &points[1..] {
        if !cone.narrow(p, tolerance) {
            kept.push(previous);
            cone = Cone::from(previous);
            cone.narrow(p, tolerance);
        }
        previous = p;
    }
    if kept.last() != Some(&last) || kept.len() < points.len().min(2) {
        kept.push(last);
    }
    kept
}

/// The directions from a kept point that pass all points since within the tolerance.
struct Cone {
    apex: (f64, f64),
    /// The two bounds as angles; `None` until a point is far enough from the apex to set one.
    bounds: Option<(f64, f64)>,
    /// Distance of the farthest point so far.
    reach: f64,
}

impl Cone {
    fn from(apex: (i32, i32)) -> Self {
        Self { apex: (f64::from(apex.0), f64::from(apex.1)), bounds: None, reach: 0.0 }
    }

    /// Takes `p` in, or refuses it: it lies outside the cone, or the line would turn back.
    fn narrow(&mut self, p: (i32, i32), tolerance: f64) -> bool {
        let (dx, dy) = (f64::from(p.0) - self.apex.0, f64::from(p.1) - self.apex.1);
        let distance = dx.hypot(dy);
        if distance <= tolerance {
            return self.reach <= tolerance;
        }
        let angle = dy.atan2(dx);
        let half = (tolerance / distance).asin();
        if let Some((low, high)) = self.bounds {
            // Angles are compared on the turn nearest to the cone.
            let middle = 0.5 * (low + high);
            let angle = middle + (angle - middle + PI).rem_euclid(2.0 * PI) - PI;
            if angle < low || angle > high || distance < self.reach - tolerance {
                return false;
            }
            self.bounds = Some((low.max(angle - half), high.min(angle + half)));
        } else {
            self.bounds = Some((angle - half, angle + half));
        }
        self.reach = self.reach.max(distance);
        true
    }
}

/// Tenths of a pixel that share one column.
const COLUMN: i32 = 8;

/// For a curve that runs left to right: of all points in a column only the first, lowest, highest and last.
fn columns(points: &[(i32, i32)]) -> Vec<(i32, i32)> {
    let mut distinct = points.to_vec();
    distinct.dedup();
    let dense = distinct.len() > 400 && distinct.windows(2).all(|w| w[0].0 <= w[1].0);
    if !dense {
        return distinct;
    }
    let mut out: Vec<(i32, i32)> = Vec::new();
    for column in distinct.chunk_by(|a, b| a.0.div_euclid(COLUMN) == b.0.div_euclid(COLUMN)) {
        let lowest = (0..column.len()).min_by_key(|&i| column[i].1).unwrap_or(0);
        let highest = (0..column.len()).max_by_key(|&i| column[i].1).unwrap_or(0);
        let mut kept = [0, lowest, highest, column.len() - 1];
        kept.sort_unstable();
        out.extend(kept.iter().map(|&i| column[i]));
    }
    out.dedup();
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Distance of `p` from the segment `a`–`b`.
    fn distance(p: (i32, i32), a: (i32, i32), b: (i32, i32)) -> f64 {
        let to_f64 = |v: (i32, i32)| (f64::from(v.0), f64::from(v.1));
        let ((px, py), (ax, ay), (bx, by)) = (to_f64(p), to_f64(a), to_f64(b));
        let (dx, dy) = (bx - ax, by - ay);
        let length2 = dx * dx + dy * dy;
        let t =
            if length2 > 0.0 { (((px - ax) * dx + (py - ay) * dy) / length2).clamp(0.0, 1.0) } else { 0.0 };
        (px - ax - t * dx).hypot(py - ay - t * dy)
    }

    #[test]
    fn straight_stretches_need_two_points() {
        let line: Vec<_> = (0..100).map(|i| (i, 2 * i)).collect();
        assert_eq!(simplify(&line, 1.0), [(0, 0), (99, 198)]);
    }

    #[test]
    fn the_curve_stays_within_the_tolerance() {
        let curve: Vec<_> =
            (0..300).map(|i| (i * 10, (800.0 * (f64::from(i) / 20.0).sin()) as i32)).collect();
        let simple = simplify(&curve, 1.5);
        assert!(simple.len() < curve.len() / 2, "{} points", simple.len());
        assert_eq!((simple.first(), simple.last()), (curve.first(), curve.last()));
        for &p in &curve {
            let d = simple.windows(2).map(|w| distance(p, w[0], w[1])).fold(f64::INFINITY, f64::min);
            assert!(d <= 2.0, "{p:?} is {d} away");
        }
    }

    #[test]
    fn corners_loops_and_dots_survive() {
        let corner = [(0, 0), (50, 0), (100, 0), (100, 50), (100, 100)];
        assert_eq!(simplify(&corner, 1.5), [(0, 0), (100, 0), (100, 100)]);
        let there_and_back = [(0, 0), (100, 0), (30, 0)];
        assert_eq!(simplify(&there_and_back, 1.5), there_and_back);
        let square = [(0, 0), (100, 0), (100, 100), (0, 100), (0, 0)];
        assert_eq!(simplify(&square, 1.5), square);
        assert_eq!(simplify(&[(5, 5)], 1.5), [(5, 5)]);
        assert_eq!(simplify(&[], 1.5), []);
    }

    #[test]
    fn a_dense_oscillation_keeps_its_height_in_every_column() {
        let curve: Vec<_> = (0..40_000).map(|i| (i / 10, (1000.0 * f64::from(i).sin()) as i32)).collect();
        let simple = simplify(&curve, 1.5);
        assert!(simple.len() < 2200, "{} points", simple.len());
        assert!(simple.iter().any(|p| p.1 > 990) && simple.iter().any(|p| p.1 < -990));
    }
}
