/// Curves over one time axis, drawn with few points: those a straight line passes close to are dropped.
///
/// Lines between what is left stay within `tolerance` of every point added, curve by curve.
/// Source: the cone (or "fan") algorithm; Reumann & Witkam 1974, with the cone open at every dropped point.
#[derive(Clone, Debug)]
pub(crate) struct Thinning<const N: usize> {
    tolerance: [f64; N],
    samples: Vec<Sample<N>>,
    /// The last point seen, and for each curve the slopes from the last sample that miss nothing dropped so far.
    pending: Option<(Sample<N>, [(f64, f64); N])>,
}

/// t, and the curves' values there.
pub(crate) type Sample<const N: usize> = (f64, [f64; N]);

impl<const N: usize> Thinning<N> {
    pub fn new(tolerance: [f64; N]) -> Self {
        Self { tolerance, samples: Vec::new(), pending: None }
    }

    /// The next point; times do not fall.
    pub fn add(&mut self, point: Sample<N>) {
        if self.samples.is_empty() {
            return self.keep(point);
        }
        let mut slopes = [(f64::NEG_INFINITY, f64::INFINITY); N];
        if let Some((last, allowed)) = self.pending {
            let fits = (0..N).all(|curve| {
                let slope = self.slope(curve, point.0, point.1[curve]);
                (allowed[curve].0..=allowed[curve].1).contains(&slope)
            });
            if fits {
                slopes = allowed;
            } else {
                self.keep(last);
            }
        }
        for (curve, (low, high)) in slopes.iter_mut().enumerate() {
            *low = low.max(self.slope(curve, point.0, point.1[curve] - self.tolerance[curve]));
            *high = high.min(self.slope(curve, point.0, point.1[curve] + self.tolerance[curve]));
        }
        self.pending = Some((point, slopes));
    }

    /// The next point, which must stay.
    pub fn add_kept(&mut self, point: Sample<N>) {
        self.add(point);
        self.flush();
    }

    pub fn finish(mut self) -> Vec<Sample<N>> {
        self.flush();
        self.samples
    }

    fn keep(&mut self, point: Sample<N>) {
        if self.samples.last() != Some(&point) {
            self.samples.push(point);
        }
        self.pending = None;
    }

    fn flush(&mut self) {
        if let Some((point, _)) = self.pending {
            self.keep(point);
        }
    }

    /// From the last sample to (t, y); at the same t, straight up or down.
    fn slope(&self, curve: usize, t: f64, y: f64) -> f64 {
        let Some((anchor_t, anchor)) = self.samples.last() else { return 0.0 };
        let (rise, run) = (y - anchor[curve], t - anchor_t);
        if rise == 0.0 { 0.0 } else { rise / run }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn thin<const N: usize>(tolerance: [f64; N], points: &[Sample<N>]) -> Vec<Sample<N>> {
        let mut thinning = Thinning::new(tolerance);
        points.iter().for_each(|point| thinning.add(*point));
        thinning.finish()
    }

    #[test]
    fn straight_runs_keep_their_ends() {
        let corner: Vec<Sample<1>> = (0..=10).map(|i| (f64::from(i), [f64::from(5 - i).abs()])).collect();
        assert_eq!(thin([0.01], &corner), [(0.0, [5.0]), (5.0, [0.0]), (10.0, [5.0])]);
        assert_eq!(thin([0.01], &corner[..1]), corner[..1]);
        assert_eq!(thin::<1>([0.01], &[]), []);
    }

    #[test]
    fn a_jump_stays_a_jump() {
        let step = [(0.0, [0.0]), (0.5, [0.0]), (1.0, [0.0]), (1.0, [2.0]), (1.5, [2.0]), (2.0, [2.0])];
        assert_eq!(thin([0.1], &step), [(0.0, [0.0]), (1.0, [0.0]), (1.0, [2.0]), (2.0, [2.0])]);
    }

    #[test]
    fn every_curve_is_kept_within_its_tolerance() {
        let curves = |t: f64| [t.sin(), (3.0 * t).cos()];
        let points: Vec<Sample<2>> =
            (0..=2000).map(|i| f64::from(i) / 100.0).map(|t| (t, curves(t))).collect();
        let thinned = thin([0.01, 0.002], &points);
        assert!(thinned.len() < 450, "{}", thinned.len());
        for pair in thinned.windows(2) {
            for (t, values) in points.iter().filter(|(t, _)| (pair[0].0..=pair[1].0).contains(t)) {
                let x = (t - pair[0].0) / (pair[1].0 - pair[0].0);
                for (curve, tolerance) in [0.01, 0.002].into_iter().enumerate() {
                    let line = pair[0].1[curve] + x * (pair[1].1[curve] - pair[0].1[curve]);
                    assert!((line - values[curve]).abs() <= tolerance * 1.0001, "curve {curve} at {t}");
                }
            }
        }
    }
}
