use super::realization::Realization;
use super::{Block, Chain, ChainError, Nonlinearity, Signal};
use nalgebra::{DMatrix, DVector, RowDVector};

/// Which straight branch of its characteristic a nonlinearity is on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Branch {
    /// Saturation or dead zone: beyond the corner on the negative side.
    Low,
    /// Saturation or dead zone: between the corners.
    Middle,
    /// Saturation or dead zone: beyond the corner on the positive side.
    High,
    /// Backlash: somewhere in the gap, output held.
    Free,
    /// Backlash: pushed towards greater values.
    Up,
    /// Backlash: pushed towards smaller values.
    Down,
    /// Relay, quantizer, Coulomb friction: on this level.
    Level(f64),
    /// Rate limit: the output is the input.
    Follow,
    /// Rate limit: the input is above the output, which rises as fast as it may.
    Rise,
    /// Rate limit: the input is below the output, which falls as fast as it may.
    Fall,
}

/// Which end of its range a guarded quantity has left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Side {
    Below,
    Above,
}

/// A quantity as weights on the state, with its first and second time derivatives.
#[derive(Clone, Debug)]
pub(super) struct Quantity {
    value: DVector<f64>,
    rate: DVector<f64>,
    second: DVector<f64>,
}

impl Quantity {
    fn new(row: &RowDVector<f64>, a: &DMatrix<f64>) -> Self {
        let value = row.transpose();
        let rate = a.tr_mul(&value);
        let second = a.tr_mul(&rate);
        Self { value, rate, second }
    }

    /// Value, rate and second rate in `state`.
    pub fn in_state(&self, state: &DVector<f64>) -> [f64; 3] {
        [self.value.dot(state), self.rate.dot(state), self.second.dot(state)]
    }

    /// Which way it is going, whatever the first derivative that is not 0: `Above` for up, `None` when it stands still.
    pub fn direction(&self, state: &DVector<f64>, a: &DMatrix<f64>) -> Option<Side> {
        /// Less than this share of what it is made of is rounding.
        const ROUNDING: f64 = 1e-9;
        let mut row = self.rate.clone();
        for _ in 0..a.nrows() {
            let (value, terms) = row
                .iter()
                .zip(state.iter())
                .fold((0.0, 0.0), |(value, terms), (c, x)| (value + c * x, terms + f64::abs(c * x)));
            if f64::abs(value) > ROUNDING * terms {
                return Some(if value > 0.0 { Side::Above } else { Side::Below });
            }
            row = a.tr_mul(&row);
        }
        None
    }

    /// The size of what is added up to make the value: how far it can be off is some `f64::EPSILON` of this.
    pub fn terms(&self, state: &DVector<f64>) -> f64 {
        self.value.iter().zip(state.iter()).map(|(c, x)| (c * x).abs()).sum()
    }
}

/// As long as `quantity` stays within `low..=high`, nonlinearity `block` stays on its branch.
#[derive(Clone, Debug)]
pub(super) struct Guard {
    pub block: usize,
    /// Whether `quantity` is the rate of the block's input: backlash while it is pushed, a rate limit that follows.
    pub on_rate: bool,
    pub quantity: Quantity,
    pub low: f64,
    pub high: f64,
}

/// The chain while every nonlinearity stays on its branch: ż = a·z, everything in it a row on z.
///
/// z holds the states of the linear blocks, one output for each backlash and rate limit, two states of the source
/// (sine and cosine, or its level), and a 1.
#[derive(Clone, Debug)]
pub(super) struct Motion {
    pub a: DMatrix<f64>,
    pub output: Quantity,
    pub guards: Vec<Guard>,
    /// Input and output of every backlash and rate limit, with its block.
    pub holders: Vec<(usize, Quantity, Quantity)>,
}

/// What does not change with the branches: realizations, and where in z each block keeps its states.
pub(super) struct Plan<'a> {
    chain: &'a Chain,
    realizations: Vec<Option<Realization>>,
    offsets: Vec<usize>,
    source: usize,
}

impl<'a> Plan<'a> {
    pub fn new(chain: &'a Chain) -> Result<Self, ChainError> {
        let mut realizations = Vec::with_capacity(chain.blocks.len());
        let mut offsets = Vec::with_capacity(chain.blocks.len());
        let mut states = 0;
        for (index, block) in chain.blocks.iter().enumerate() {
            offsets.push(states);
            match block {
                Block::Linear { num, den } => {
                    let realization = Realization::new(index, num, den)?;
                    states += realization.order();
                    realizations.push(Some(realization));
                }
                Block::Nonlinearity(nonlinearity) => {
                    if !nonlinearity.parameters().iter().all(|parameter| parameter.is_finite()) {
                        return Err(ChainError::NotFinite { time_s: 0.0 });
                    }
                    states += usize::from(matches!(
                        nonlinearity,
                        Nonlinearity::Backlash { .. } | Nonlinearity::RateLimit { .. }
                    ));
                    realizations.push(None);
                }
            }
        }
        Ok(Self { chain, realizations, offsets, source: states })
    }

    pub fn block(&self, index: usize) -> Option<&Block> {
        self.chain.blocks.get(index)
    }

    /// Everything at rest.
    pub fn rest(&self) -> DVector<f64> {
        let mut state = DVector::zeros(self.source + 3);
        state[self.source + 2] = 1.0;
        state
    }

    /// Sets the source's states to what they are at time `t`.
    pub fn drive(&self, state: &mut DVector<f64>, t: f64) {
        match self.chain.source {
            Signal::Sine { frequency_rad_s, phase_rad, .. } => {
                let angle = frequency_rad_s * t + phase_rad;
                (state[self.source], state[self.source + 1]) = angle.sin_cos();
            }
            Signal::Pulse { .. } | Signal::Step { .. } => state[self.source] = self.chain.source.at(t),
        }
    }

    /// Sets a source without edges to exactly what it is at time `t`, against the drift of many steps.
    pub fn drive_smoothly(&self, state: &mut DVector<f64>, t: f64) {
        if matches!(self.chain.source, Signal::Sine { .. }) {
            self.drive(state, t);
        }
    }

    /// Where in z the backlash or rate limit `block` keeps its output.
    pub fn held(&self, block: usize) -> usize {
        self.offsets[block]
    }

    /// The branches at rest, before the source is looked at; `None` for a linear block.
    pub fn resting_branches(&self) -> Vec<Option<Branch>> {
        self.chain
            .blocks
            .iter()
            .map(|block| match block {
                Block::Linear { .. } => None,
                Block::Nonlinearity(Nonlinearity::Backlash { .. }) => Some(Branch::Free),
                Block::Nonlinearity(Nonlinearity::RateLimit { .. }) => Some(Branch::Follow),
                Block::Nonlinearity(
                    Nonlinearity::Relay { .. }
                    | Nonlinearity::Quantizer { .. }
                    | Nonlinearity::CoulombFriction { .. },
                ) => Some(Branch::Level(0.0)),
                Block::Nonlinearity(Nonlinearity::Saturation { .. } | Nonlinearity::DeadZone { .. }) => {
                    Some(Branch::Middle)
                }
            })
            .collect()
    }

    /// The equations that hold on `branches`.
    pub fn motion(&self, branches: &[Option<Branch>]) -> Motion {
        let size = self.source + 3;
        let one = size - 1;
        let mut a = DMatrix::zeros(size, size);
        let mut signal = RowDVector::zeros(size);
        match self.chain.source {
            Signal::Sine { amplitude, frequency_rad_s, bias, .. } => {
                a[(self.source, self.source + 1)] = frequency_rad_s;
                a[(self.source + 1, self.source)] = -frequency_rad_s;
                signal[self.source] = amplitude;
                signal[one] = bias;
            }
            Signal::Pulse { .. } | Signal::Step { .. } => signal[self.source] = 1.0,
        }

        // Rates need the whole of `a`, so what is guarded is collected first.
        let mut guarded: Vec<(usize, RowDVector<f64>, bool, f64, f64)> = Vec::new();
        let mut holders = Vec::new();
        for (index, block) in self.chain.blocks.iter().enumerate() {
            let at = self.offsets[index];
            let nonlinearity = match (block, &self.realizations[index]) {
                (Block::Nonlinearity(nonlinearity), _) => nonlinearity,
                (Block::Linear { .. }, Some(realization)) => {
                    let order = realization.order();
                    a.view_mut((at, at), (order, order)).copy_from(&realization.a);
                    let mut rows = a.view_mut((at, 0), (order, size));
                    rows += &realization.b * &signal;
                    signal *= realization.d;
                    let mut states = signal.columns_mut(at, order);
                    states += &realization.c;
                    continue;
                }
                (Block::Linear { .. }, None) => continue,
            };
            let input = signal.clone();
            let branch = branches[index].unwrap_or(Branch::Middle);
            match *nonlinearity {
                Nonlinearity::Saturation { limit } if limit <= 0.0 => signal.fill(0.0),
                Nonlinearity::Saturation { limit } => {
                    if branch != Branch::Middle {
                        signal.fill(0.0);
                        signal[one] = if branch == Branch::High { limit } else { -limit };
                    }
                    guarded.push(corner_guard(index, input, branch, limit));
                }
                // A zone without width, like a shaft without play, passes everything.
                Nonlinearity::DeadZone { threshold } if threshold <= 0.0 => {}
                Nonlinearity::Backlash { width } if width <= 0.0 => {}
                Nonlinearity::DeadZone { threshold } => {
                    match branch {
                        Branch::High => signal[one] -= threshold,
                        Branch::Low => signal[one] += threshold,
                        _ => signal.fill(0.0),
                    }
                    guarded.push(corner_guard(index, input, branch, threshold));
                }
                Nonlinearity::Backlash { width } => {
                    let half = width / 2.0;
                    match branch {
                        Branch::Up => {
                            signal[one] -= half;
                            guarded.push((index, input.clone(), true, 0.0, f64::INFINITY));
                        }
                        Branch::Down => {
                            signal[one] += half;
                            guarded.push((index, input.clone(), true, f64::NEG_INFINITY, 0.0));
                        }
                        _ => {
                            signal.fill(0.0);
                            signal[at] = 1.0;
                            guarded.push((index, &input - &signal, false, -half, half));
                        }
                    }
                    holders.push((index, input, signal.clone()));
                }
                Nonlinearity::RateLimit { rising, falling } => {
                    let (rising, falling) = (rising.max(0.0), falling.min(0.0));
                    if branch == Branch::Rise || branch == Branch::Fall {
                        signal.fill(0.0);
                        signal[at] = 1.0;
                        let behind = &input - &signal;
                        if branch == Branch::Rise {
                            a[(at, one)] = rising;
                            guarded.push((index, behind, false, 0.0, f64::INFINITY));
                        } else {
                            a[(at, one)] = falling;
                            guarded.push((index, behind, false, f64::NEG_INFINITY, 0.0));
                        }
                    } else {
                        guarded.push((index, input.clone(), true, falling, rising));
                    }
                    holders.push((index, input, signal.clone()));
                }
                Nonlinearity::Relay { .. }
                | Nonlinearity::Quantizer { .. }
                | Nonlinearity::CoulombFriction { .. } => {
                    let level = if let Branch::Level(level) = branch { level } else { 0.0 };
                    let (gain, offset) = nonlinearity.on_level(level);
                    signal *= gain;
                    signal[one] += offset;
                    let (low, high) = nonlinearity.level_range(level);
                    guarded.push((index, input, false, low, high));
                }
            }
        }

        let guards = guarded
            .into_iter()
            .map(|(block, row, on_rate, low, high)| {
                let row = if on_rate { row * &a } else { row };
                Guard { block, on_rate, quantity: Quantity::new(&row, &a), low, high }
            })
            .collect();
        let holders = holders
            .into_iter()
            .map(|(block, input, output)| (block, Quantity::new(&input, &a), Quantity::new(&output, &a)))
            .collect();
        Motion { output: Quantity::new(&signal, &a), guards, holders, a }
    }
}

/// Saturation and dead zone stay on a branch while the input stays between its corners.
fn corner_guard(
    block: usize,
    input: RowDVector<f64>,
    branch: Branch,
    corner: f64,
) -> (usize, RowDVector<f64>, bool, f64, f64) {
    let (low, high) = match branch {
        Branch::Low => (f64::NEG_INFINITY, -corner),
        Branch::High => (corner, f64::INFINITY),
        _ => (-corner, corner),
    };
    (block, input, false, low, high)
}

impl Branch {
    /// The branch that follows when the guarded quantity leaves its range on `side`; levels are the nonlinearity's matter.
    pub fn after(self, side: Side) -> Self {
        match (self, side) {
            (Self::Low, _) | (Self::High, _) => Self::Middle,
            (Self::Middle, Side::Below) => Self::Low,
            (Self::Middle, Side::Above) => Self::High,
            (Self::Free, Side::Below) => Self::Down,
            (Self::Free, Side::Above) => Self::Up,
            (Self::Up | Self::Down, _) => Self::Free,
            (Self::Level(level), _) => Self::Level(level),
            (Self::Rise | Self::Fall, _) => Self::Follow,
            (Self::Follow, Side::Below) => Self::Fall,
            (Self::Follow, Side::Above) => Self::Rise,
        }
    }
}

impl Guard {
    /// How far `value` lies outside on `side`; negative inside.
    pub fn excess(&self, side: Side, value: f64) -> f64 {
        match side {
            Side::Below => self.low - value,
            Side::Above => value - self.high,
        }
    }
}
