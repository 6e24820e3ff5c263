//! A curve as polynomials, one for each stretch of time.

use std::f64::consts::PI;

/// Points of a piece: Chebyshev's, both ends among them.
pub(super) const NODES: usize = 33;

/// What a rate may be by rounding alone, of the size of its polynomial.
const ROUNDING: f64 = 1e-12;
/// A change by this within a piece, of the largest value of all, is rounding.
const SMALLEST: f64 = 1e-16;

/// Piecewise polynomials from t = 0 on, close together where much happens.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Pieces {
    pieces: Vec<Piece>,
    /// For each piece, the largest |y − constant| there and in all that follow.
    bounds: Vec<f64>,
    constant: f64,
    /// The real part of the rightmost term that moves.
    rightmost: f64,
}

/// Value, rate and curvature on `from`..`from + width`, as sums of Chebyshev's polynomials on −1..1.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Piece {
    from: f64,
    width: f64,
    series: [Vec<f64>; 3],
}

/// Where the points of a piece lie, 0..=1.
pub(super) fn nodes() -> Vec<f64> {
    let last = (NODES - 1) as f64;
    (0..NODES).map(|j| (0.5 * PI * j as f64 / last).sin().powi(2)).collect()
}

impl Piece {
    /// The polynomial through `values` at [`nodes`].
    pub fn through(from: f64, width: f64, values: &[f64]) -> Self {
        let last = NODES - 1;
        let mut series = Vec::with_capacity(NODES);
        for k in 0..NODES {
            // Node j stands at −cos(πj/last).
            let sum: f64 = (0..NODES)
                .map(|j| {
                    let end = if j == 0 || j == last { 0.5 } else { 1.0 };
                    // A whole number of turns is taken off before the cosine.
                    let turn = (k * j) % (2 * last);
                    let sign = if k % 2 == 1 { -1.0 } else { 1.0 };
                    end * sign * values[j] * (PI * turn as f64 / last as f64).cos()
                })
                .sum();
            let half = if k == 0 || k == last { 1.0 } else { 2.0 };
            series.push(half * sum / last as f64);
        }
        let rate = derivative(&series, width);
        let curvature = derivative(&rate, width);
        Self { from, width, series: [series, rate, curvature] }
    }

    fn jet(&self, t: f64) -> [f64; 3] {
        let x = (2.0 * (t - self.from) / self.width - 1.0).clamp(-1.0, 1.0);
        [0, 1, 2].map(|order| clenshaw(&self.series[order], x))
    }

    fn size(&self, order: usize) -> f64 {
        self.series[order].iter().map(|c| c.abs()).sum()
    }
}

/// Of a Chebyshev series over a stretch `width` long.
fn derivative(series: &[f64], width: f64) -> Vec<f64> {
    let n = series.len();
    let mut slope = vec![0.0; n];
    for k in (1..n).rev() {
        let above = if k + 1 < n { slope[k + 1] } else { 0.0 };
        slope[k - 1] = above + 2.0 * k as f64 * series[k];
    }
    slope[0] *= 0.5;
    slope.iter_mut().for_each(|c| *c *= 2.0 / width);
    slope
}

/// The value at x of a Chebyshev series.
fn clenshaw(series: &[f64], x: f64) -> f64 {
    let (mut one, mut two) = (0.0, 0.0);
    for c in series.iter().skip(1).rev() {
        (one, two) = (c + 2.0 * x * one - two, one);
    }
    series.first().copied().unwrap_or(0.0) + x * one - two
}

impl Pieces {
    pub fn new(pieces: Vec<Piece>, constant: f64, rightmost: f64) -> Self {
        let mut bounds = Vec::with_capacity(pieces.len());
        let mut bound: f64 = 0.0;
        for piece in pieces.iter().rev() {
            let about = (piece.series[0][0] - constant).abs();
            let rest: f64 = piece.series[0].iter().skip(1).map(|c| c.abs()).sum();
            bound = bound.max(about + rest);
            bounds.push(bound);
        }
        bounds.reverse();
        Self { pieces, bounds, constant, rightmost }
    }

    /// Where the last piece ends.
    pub fn end(&self) -> f64 {
        self.pieces.last().map_or(0.0, |piece| piece.from + piece.width)
    }

    fn place(&self, t: f64) -> usize {
        self.pieces.partition_point(|piece| piece.from <= t).saturating_sub(1)
    }

    /// Value, rate and curvature; beyond the end what decays has decayed, and `None` for what does not.
    pub fn jet(&self, t: f64) -> Option<[f64; 3]> {
        if t > self.end() {
            return (self.rightmost < 0.0).then_some([self.constant, 0.0, 0.0]);
        }
        self.pieces.get(self.place(t)).map(|piece| piece.jet(t))
    }

    /// The largest |y − constant| can be from t on.
    pub fn bound_from(&self, t: f64) -> f64 {
        match self.rightmost < 0.0 {
            true if t > self.end() => 0.0,
            true => self.bounds.get(self.place(t)).copied().unwrap_or(0.0),
            false => f64::INFINITY,
        }
    }

    /// The largest |y − constant| on the pieces.
    pub fn highest(&self) -> f64 {
        self.bounds.first().copied().unwrap_or(0.0)
    }

    /// From when on |y − constant| is no more than `band`.
    pub fn within(&self, band: f64) -> f64 {
        let outside = self.bounds.partition_point(|bound| *bound > band);
        outside.checked_sub(1).and_then(|last| self.pieces.get(last)).map_or(0.0, |p| p.from + p.width)
    }

    /// How far one may step at t, and what a rate there may be by rounding alone.
    pub fn step_and_rounding(&self, t: f64) -> (f64, f64) {
        match self.pieces.get(self.place(t)) {
            Some(piece) => {
                let of_all = SMALLEST * self.highest() / piece.width;
                (piece.width / 64.0, ROUNDING * piece.size(1) + of_all)
            }
            None => (1.0, 0.0),
        }
    }
}
