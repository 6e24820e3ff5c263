/// A polyline with the fewest of its points that stays within `tolerance` of it; a dense oscillation becomes the
/// lowest and highest point of each pixel column.
///
/// Units: tenths of a pixel. Source: Douglas & Peucker, Cartographica 10(2), 1973, without recursion.
pub fn simplify(points: &[(i32, i32)], tolerance: f64) -> Vec<(i32, i32)> {
    let points = columns(points);
    if points.len() < 3 {
        return points;
    }
    let mut keep = vec![false; points.len()];
    keep[0] = true;
    keep[points.len() - 1] = true;
    let mut pending = vec![(0, points.len() - 1)];
    while let Some((first, last)) = pending.pop() {
        let farthest = (first + 1..last)
            .map(|i| (i, distance(points[i], points[first], points[last])))
            .max_by(|a, b| a.1.total_cmp(&b.1).then(b.0.cmp(&a.0)));
        if let Some((i, d)) = farthest
            && d > tolerance
        {
            keep[i] = true;
            pending.push((first, i));
            pending.push((i, last));
        }
    }
    points.into_iter().zip(keep).filter_map(|(p, keep)| keep.then_some(p)).collect()
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

/// Distance of `p` from the segment `a`–`b`.
fn distance(p: (i32, i32), a: (i32, i32), b: (i32, i32)) -> f64 {
    let to_f64 = |v: (i32, i32)| (f64::from(v.0), f64::from(v.1));
    let ((px, py), (ax, ay), (bx, by)) = (to_f64(p), to_f64(a), to_f64(b));
    let (dx, dy) = (bx - ax, by - ay);
    let length2 = dx * dx + dy * dy;
    let t = if length2 > 0.0 { (((px - ax) * dx + (py - ay) * dy) / length2).clamp(0.0, 1.0) } else { 0.0 };
    (px - ax - t * dx).hypot(py - ay - t * dy)
}

#[cfg(test)]
mod tests {
    use super::*;

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
        for &p in &curve {
            let d = simple.windows(2).map(|w| distance(p, w[0], w[1])).fold(f64::INFINITY, f64::min);
            assert!(d <= 1.5, "{p:?} is {d} away");
        }
    }

    #[test]
    fn a_dense_oscillation_keeps_its_height_in_every_column() {
        let curve: Vec<_> = (0..40_000).map(|i| (i / 10, (1000.0 * f64::from(i).sin()) as i32)).collect();
        let simple = simplify(&curve, 1.5);
        assert!(simple.len() < 2200, "{} points", simple.len());
        assert!(simple.iter().any(|p| p.1 > 990) && simple.iter().any(|p| p.1 < -990));
    }
}
