use super::Guard;
use crate::lab::Points;

/// Where each point was lost, in the order of the criteria, and what was not charged a second time.
///
/// The points under `lost` add up to what the submission did not earn.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct Ledger {
    pub lost: Vec<Loss>,
    pub spared: Vec<Spared>,
}

/// Points lost at one criterion.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Loss {
    /// The criterion's id.
    pub item: String,
    pub points: Points,
    pub cause: Cause,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Cause {
    /// The mistake was made here.
    Here,
    Blank,
    Unreadable,
    /// A person has yet to mark it.
    Unmarked,
    /// A person took them.
    ByHand,
    /// It follows from the mistake charged at the criterion `root`; the lab gives a part of the points for that.
    Part {
        root: String,
    },
    /// It would follow from the mistake charged at `root`, but that answer may not be followed.
    Refused {
        root: String,
        guard: Guard,
    },
}

/// Points earned at a criterion because its answer is right for an earlier one, charged at the criterion `root`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Spared {
    pub item: String,
    pub points: Points,
    pub root: String,
}
