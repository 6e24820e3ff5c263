use super::{Nonlinearity, Signal};
use crate::algebra::significant;

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

#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ChainError {
    #[error("block {index} is improper: numerator of degree {num} over denominator of degree {den}")]
    Improper { index: usize, num: usize, den: usize },
    #[error("block {index} has a denominator of zero")]
    ZeroDenominator { index: usize },
    #[error("the simulation left the range of numbers at t = {} s", significant(*time_s, 6))]
    NotFinite { time_s: f64 },
    #[error("more than {limit} switchings before t = {} s", significant(*time_s, 6))]
    TooManySwitches { limit: usize, time_s: f64 },
    #[error("more than {limit} steps before t = {} s", significant(*time_s, 6))]
    TooManySteps { limit: usize, time_s: f64 },
}

/// The chain with every nonlinearity taken out.
pub fn without_nonlinearities(chain: &Chain) -> Chain {
    let blocks = chain.blocks.iter().filter(|block| matches!(block, Block::Linear { .. })).cloned().collect();
    Chain { source: chain.source, blocks }
}
