use crate::algebra::Polynomial;

/// `num` over `den` in s, exact; nothing is cancelled unasked. `den` is never zero.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TransferFunction {
    pub num: Polynomial,
    pub den: Polynomial,
}
