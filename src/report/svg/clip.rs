/// The parts of a polyline inside the rectangle (x0..=x1) × (y0..=y1), cut exactly at its edges.
///
/// Infinite or undefined points end a part. Source: Liang & Barsky, ACM TOG 3(1), 1984.
pub fn clip(points: &[(f64, f64)], x: (f64, f64), y: (f64, f64)) -> Vec<Vec<(f64, f64)>> {
    let mut parts: Vec<Vec<(f64, f64)>> = Vec::new();
    let mut open = false;
    for pair in points.windows(2) {
        match segment(pair[0], pair[1], x, y) {
            Some((from, to, leaves)) => {
                match parts.last_mut() {
                    Some(part) if open => part.push(to),
                    _ => parts.push(vec![from, to]),
                }
                open = !leaves;
            }
            None => open = false,
        }
    }
    parts
}

type Point = (f64, f64);

/// The visible part of one segment, and whether it leaves the rectangle at its end.
fn segment(a: Point, b: Point, x: Point, y: Point) -> Option<(Point, Point, bool)> {
    let (dx, dy) = (b.0 - a.0, b.1 - a.1);
    if !(dx.is_finite() && dy.is_finite()) {
        return None;
    }
    let (mut t0, mut t1) = (0.0_f64, 1.0_f64);
    for (p, q) in [(-dx, a.0 - x.0), (dx, x.1 - a.0), (-dy, a.1 - y.0), (dy, y.1 - a.1)] {
        if p == 0.0 {
            if q < 0.0 {
                return None;
            }
        } else if p < 0.0 {
            t0 = t0.max(q / p);
        } else {
            t1 = t1.min(q / p);
        }
    }
    let at = |t: f64| (a.0 + t * dx, a.1 + t * dy);
    (t0 <= t1).then(|| (if t0 > 0.0 { at(t0) } else { a }, if t1 < 1.0 { at(t1) } else { b }, t1 < 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What it is, the polyline, its visible parts.
    type Row = (&'static str, &'static [Point], &'static [&'static [Point]]);

    #[track_caller]
    fn check(rows: &[Row]) {
        for (what, points, expected) in rows {
            let got = clip(points, (0.0, 10.0), (0.0, 10.0));
            assert_eq!(got, expected.iter().map(|p| p.to_vec()).collect::<Vec<_>>(), "{what}");
        }
    }

    #[test]
    fn curves_end_at_the_frame() {
        check(&[
            ("all inside", &[(1., 1.), (2., 3.), (3., 1.)], &[&[(1., 1.), (2., 3.), (3., 1.)]]),
            ("leaves at the top", &[(1., 5.), (2., 15.)], &[&[(1., 5.), (1.5, 10.)]]),
            (
                "leaves and returns",
                &[(1., 5.), (2., 15.), (3., 5.)],
                &[&[(1., 5.), (1.5, 10.)], &[(2.5, 10.), (3., 5.)]],
            ),
            ("passes through", &[(-5., 5.), (15., 5.)], &[&[(0., 5.), (10., 5.)]]),
            ("all outside", &[(-5., -5.), (-1., 20.)], &[]),
            ("one point", &[(1., 1.)], &[]),
            (
                "an infinite point",
                &[(1., 1.), (2., f64::INFINITY), (3., 1.), (4., 2.)],
                &[&[(3., 1.), (4., 2.)]],
            ),
        ]);
    }
}
