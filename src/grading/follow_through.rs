/// How an answer stands to the student's own earlier answer, on which it rests.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FollowThrough {
    /// It is right for the earlier answer, and earns the lab's part of the points.
    pub credited: bool,
    pub guard: Guard,
    /// The criterion where the earlier answer lost its points.
    pub root: String,
    /// What it was held against, in words: `your own transfer function`.
    pub own: String,
}

/// Whether an earlier answer may be followed: it must not make the later parts easier than the reference does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Guard {
    Passed,
    /// Its numerator or denominator is not of the order asked for.
    Order,
    /// Hardly a model: too few terms, every coefficient ±1, all poles at one place.
    Trivial,
    /// It is what belongs to another operating point.
    OtherPoint,
}

impl Guard {
    /// The word tools read: `passed`, `order`, `trivial`, `other_point`.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Passed => "passed",
            Self::Order => "order",
            Self::Trivial => "trivial",
            Self::OtherPoint => "other_point",
        }
    }
}
