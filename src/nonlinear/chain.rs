use super::{Nonlinearity, Signal};

/// One block of a chain, in the order the signal passes.
#[derive(Clone, Debug, PartialEq)]
pub enum Block {
    Nonlinearity(Nonlinearity),
    /// Proper transfer function, coefficients highest power first.
    Linear {
        num: Vec<f64>,
        den: Vec<f64>,
    },
}

/// A source and the blocks behind it.
#[derive(Clone, Debug, PartialEq)]
pub struct Chain {
    pub source: Signal,
    pub blocks: Vec<Block>,
}

/// What a run of the chain gave: the output, and where something switched.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// (t, y): dense enough to draw; includes every switching instant.
    pub samples: Vec<(f64, f64)>,
    /// Instants (s) at which a nonlinearity changed its branch, located to about 1e-12 relative; source edges are not among them.
    pub switch_times: Vec<f64>,
    /// Largest |y| on 0..=duration, located between samples, and its time.
    pub peak: (f64, f64),
}

#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ChainError {
    #[error("block {index} is improper: numerator of degree {num} over denominator of degree {den}")]
    Improper { index: usize, num: usize, den: usize },
    #[error("the simulation left the range of numbers at t = {time_s} s")]
    NotFinite { time_s: f64 },
    #[error("more than {limit} switchings before t = {time_s} s")]
    TooManySwitches { limit: usize, time_s: f64 },
}

/// Runs `chain` for `duration_s`, from rest, at a relative accuracy of 1e-9 or better.
pub fn simulate(chain: &Chain, duration_s: f64) -> Result<Run, ChainError> {
    let _ = (chain, duration_s);
    todo!()
}
