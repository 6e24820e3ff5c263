use super::{Guard, ItemScore, Verdict};
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

impl Cause {
    /// The word tools read: `here`, `blank`, `unreadable`, `unmarked`, `by_hand`, `part`, `refused`.
    pub fn as_str(&self) -> &'static str {
        match self {
            Self::Here => "here",
            Self::Blank => "blank",
            Self::Unreadable => "unreadable",
            Self::Unmarked => "unmarked",
            Self::ByHand => "by_hand",
            Self::Part { .. } => "part",
            Self::Refused { .. } => "refused",
        }
    }
}

/// Points earned at a criterion because its answer is right for an earlier one, charged at the criterion `root`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Spared {
    pub item: String,
    pub points: Points,
    pub root: String,
}

impl Ledger {
    /// Enters one criterion: `item` after a person had a say, `spared` and `withheld` by the mark before.
    pub(super) fn enter(&mut self, item: &ItemScore, spared: Points, withheld: Points) {
        let mut lost = |points: i64, cause: Cause| {
            if points != 0 {
                self.lost.push(Loss { item: item.id.clone(), points: Points(points), cause });
            }
        };
        let missing = item.possible.0 - item.earned.0;
        if item.override_reason.is_some() {
            return lost(missing, Cause::ByHand);
        }
        let followed = item.follow_through.as_ref();
        match (item.verdict, followed) {
            (Verdict::Blank, _) => lost(missing, Cause::Blank),
            (Verdict::Unreadable, _) => lost(missing, Cause::Unreadable),
            (Verdict::Unmarked, _) => lost(missing, Cause::Unmarked),
            (_, Some(followed)) if followed.credited => {
                lost(withheld.0, Cause::Part { root: followed.root.clone() });
                lost(missing - withheld.0, Cause::Here);
                self.spared.push(Spared {
                    item: item.id.clone(),
                    points: spared,
                    root: followed.root.clone(),
                });
            }
            (_, Some(followed)) if followed.guard != Guard::Passed => {
                lost(missing, Cause::Refused { root: followed.root.clone(), guard: followed.guard });
            }
            _ => lost(missing, Cause::Here),
        }
    }
}
