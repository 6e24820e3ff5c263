use super::thinning::Thinning;

/// What a run of a chain gave: the output, and where something switched.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// (t, y) for drawing: straight lines between them stay within 0.1 % of the peak of the curve. Every switching
    /// instant, source edge and extremum is among them; where the output jumps there are two at one t.
    pub samples: Vec<(f64, f64)>,
    /// Instants (s), ascending, at which a nonlinearity changed its branch, located to about 1e-12 relative; source edges are not among them.
    pub switch_times: Vec<f64>,
    /// Largest |y| on 0..=duration, located between samples, and the time of the first of such: (t, |y|).
    pub peak: (f64, f64),
    pieces: Vec<Piece>,
}

/// A stretch of the output between two instants, with value, rate and second rate at both.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Piece {
    pub from: f64,
    pub to: f64,
    pub start: [f64; 3],
    pub end: [f64; 3],
}

/// Share of the peak by which the lines between samples may miss the curve.
const DRAWING_TOLERANCE: f64 = 1e-3;
/// The part of it spent on looking at points instead of the curve; the rest is for points left out.
const LOOKING: f64 = 0.1;
/// Samples at most, beyond the instants that must be among them.
const SAMPLES_LIMIT: usize = 20_000;

impl Run {
    /// `kept` (ascending) are instants that must be among the samples.
    pub(super) fn new(
        pieces: Vec<Piece>,
        first: f64,
        switch_times: Vec<f64>,
        peak: (f64, f64),
        kept: &[f64],
    ) -> Self {
        let mut tolerance = DRAWING_TOLERANCE * peak.1;
        let mut samples = draw(&pieces, tolerance, kept);
        for _ in 0..8 {
            if samples.len() <= SAMPLES_LIMIT.max(4 * kept.len()) {
                break;
            }
            tolerance *= 2.0;
            samples = draw(&pieces, tolerance, kept);
        }
        if samples.is_empty() {
            samples.push((0.0, first));
        }
        Self { samples, switch_times, peak, pieces }
    }

    /// The output at time `t` s; before 0 and beyond the end, what it is there. At a jump, the value after it.
    ///
    /// Accuracy: 1e-9 of the peak (a quintic through values, rates and second rates of the exact solution).
    pub fn at(&self, t: f64) -> f64 {
        let after = self.pieces.partition_point(|piece| piece.from <= t);
        match self.pieces.get(after.saturating_sub(1)) {
            Some(piece) => piece.at(t),
            None => self.samples.first().map_or(0.0, |sample| sample.1),
        }
    }

    /// As [`at`](Self::at), but at a jump the value before it.
    pub fn just_before(&self, t: f64) -> f64 {
        let after = self.pieces.partition_point(|piece| piece.from < t);
        match self.pieces.get(after.saturating_sub(1)) {
            Some(piece) => piece.at(t),
            None => self.samples.first().map_or(0.0, |sample| sample.1),
        }
    }

    /// The instants at which the output jumps, ascending.
    pub fn jumps(&self) -> Vec<f64> {
        let jumps = self
            .pieces
            .windows(2)
            .filter(|pair| (pair[1].start[0] - pair[0].end[0]).abs() > 1e-9 * self.peak.1);
        jumps.map(|pair| pair[1].from).collect()
    }
}

impl Piece {
    /// The quintic that meets values, rates and second rates at both ends; within the ends.
    fn at(&self, t: f64) -> f64 {
        let length = self.to - self.from;
        let x = ((t - self.from) / length).clamp(0.0, 1.0);
        let [c0, r0, s0] = self.start;
        let [y1, r1, s1] = self.end;
        let (c1, c2) = (length * r0, length * length * s0 / 2.0);
        let value = y1 - (c0 + c1 + c2);
        let rate = length * r1 - (c1 + 2.0 * c2);
        let second = length * length * s1 - 2.0 * c2;
        let c3 = 10.0 * value - 4.0 * rate + second / 2.0;
        let c4 = -15.0 * value + 7.0 * rate - second;
        let c5 = 6.0 * value - 3.0 * rate + second / 2.0;
        c0 + x * (c1 + x * (c2 + x * (c3 + x * (c4 + x * c5))))
    }
}

/// What the quintic over `length` gives halfway.
pub(super) fn halfway(start: [f64; 3], end: [f64; 3], length: f64) -> f64 {
    (start[0] + end[0]) / 2.0
        + length * (start[1] - end[1]) * 5.0 / 32.0
        + length * length * (start[2] + end[2]) / 64.0
}

/// Points along `pieces`, so few that lines between them still stay within `tolerance` of the curve.
fn draw(pieces: &[Piece], tolerance: f64, kept: &[f64]) -> Vec<(f64, f64)> {
    let mut thinning = Thinning::new([tolerance * (1.0 - LOOKING)]);
    let mut previous_end = None;
    for piece in pieces {
        let keep = |t: f64| kept.binary_search_by(|instant| instant.total_cmp(&t)).is_ok();
        let jumps = previous_end.is_some_and(|end: f64| (end - piece.start[0]).abs() > tolerance * 1e-3);
        if jumps || previous_end.is_none() || keep(piece.from) {
            thinning.add_kept((piece.from, [piece.start[0]]));
        }
        // A line across h misses a curve by h²/8 of its second rate.
        let length = piece.to - piece.from;
        let bulge = length * length / 8.0 * piece.start[2].abs().max(piece.end[2].abs());
        let parts = (bulge / (tolerance * LOOKING)).sqrt().ceil().clamp(1.0, 64.0);
        let parts = if parts.is_nan() { 1.0 } else { parts };
        for part in 1..parts as usize {
            let t = piece.from + length * part as f64 / parts;
            thinning.add((t, [piece.at(t)]));
        }
        thinning.add((piece.to, [piece.end[0]]));
        previous_end = Some(piece.end[0]);
    }
    thinning.finish().into_iter().map(|(t, [y])| (t, y)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sine(from: f64, to: f64) -> Piece {
        let ends = |t: f64| [t.sin(), t.cos(), -t.sin()];
        Piece { from, to, start: ends(from), end: ends(to) }
    }

    #[test]
    fn a_piece_is_met_between_its_ends() {
        let piece = sine(0.3, 0.5);
        for t in [0.3, 0.33, 0.4, 0.47, 0.5] {
            assert!((piece.at(t) - t.sin()).abs() < 1.5e-9 * t.sin(), "at {t}");
        }
        assert!((halfway(piece.start, piece.end, 0.2) - piece.at(0.4)).abs() < 1e-15);
    }

    #[test]
    fn lines_between_samples_stay_close() {
        let pieces: Vec<Piece> =
            (0..200).map(|i| sine(f64::from(i) / 10.0, f64::from(i + 1) / 10.0)).collect();
        let run = Run::new(pieces, 0.0, vec![], (std::f64::consts::FRAC_PI_2, 1.0), &[7.0]);
        assert!(run.samples.len() < 300, "{}", run.samples.len());
        assert!(run.samples.contains(&(7.0, 7f64.sin())));
        for pair in run.samples.windows(2) {
            for part in 1..10 {
                let x = f64::from(part) / 10.0;
                let t = pair[0].0 + x * (pair[1].0 - pair[0].0);
                let line = pair[0].1 + x * (pair[1].1 - pair[0].1);
                assert!((line - t.sin()).abs() < DRAWING_TOLERANCE, "{t}: {line}");
            }
        }
    }
}
