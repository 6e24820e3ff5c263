//! Criterion → Evidence → Verdict → Scorecard. Knows no HTML, no file and no clock; points come from the lab.
//!
//! One file a kind of criterion. How each of them decides, with examples, is in `docs/marking.md`.

mod accepted;
mod alike;
mod catalogue;
mod chance;
mod closeness;
mod concepts;
mod conflicts;
mod cover;
mod diagnosis;
mod digits;
mod follow_through;
#[cfg(test)]
mod follow_through_tests;
mod grade;
mod guard;
mod hand_marks;
mod in_doubt;
mod known;
mod ledger;
mod letters;
mod likeness;
mod mark;
mod nonlinearity;
pub mod other_variant;
mod own;
mod own_claims;
mod own_poles;
mod pairs;
mod plot;
mod poles;
mod same_mistake;
mod scale;
mod scorecard;
mod shape;
mod stability;
mod tangent;
mod transfer_function;
mod truth;
mod value;
mod whose_numbers;

pub use catalogue::Catalogue;
pub use diagnosis::{Diagnosis, EquationPlace, Explanation};
pub use follow_through::FollowThrough;
pub use grade::{grade, grade_knowing, leave_to_a_person};
pub use guard::Guard;
pub use hand_marks::{
    Adjustment, AlikeMarks, Contradiction, Given, HandMarks, HandMarksFile, LateCost, LateRule, NO_ANSWER,
    Override,
};
pub use known::Known;
pub use ledger::{Cause, Ledger, Loss, Spared};
pub use scorecard::*;
pub use whose_numbers::{MemberCard, grade_beside_members, grade_without_numbers};

#[cfg(test)]
mod tests {
    /// `"poles.mirrored"` and its like in a source text.
    fn codes(source: &str) -> Vec<&str> {
        const FAMILIES: &[&str] = &[
            "structure",
            "numerator",
            "denominator",
            "poles",
            "stability",
            "tangent",
            "shape",
            "value",
            "plot",
            "concepts",
            "nonlinearity",
            "marks",
            "point",
            "term",
            "factor",
            "parameter",
            "output",
            "input",
            "function",
            "slip",
            "units",
            "rounding",
            "letters",
            "variant",
        ];
        source
            .split('"')
            .filter(|text| {
                text.split_once('.').is_some_and(|(family, rest)| {
                    FAMILIES.contains(&family)
                        && !rest.is_empty()
                        && rest.chars().all(|letter| letter.is_ascii_lowercase() || letter == '_')
                })
            })
            .filter(|code| !["marks.yaml", "marks.csv"].contains(code))
            .collect()
    }

    #[test]
    fn every_code_is_documented() {
        let manual = include_str!("../../docs/marking.md");
        let sources = [
            include_str!("concepts.rs"),
            include_str!("diagnosis.rs"),
            include_str!("digits.rs"),
            include_str!("follow_through.rs"),
            include_str!("hand_marks/allowed.rs"),
            include_str!("hand_marks/mod.rs"),
            include_str!("hand_marks/table.rs"),
            include_str!("hand_marks/yaml.rs"),
            include_str!("letters.rs"),
            include_str!("nonlinearity.rs"),
            include_str!("plot.rs"),
            include_str!("poles/mod.rs"),
            include_str!("same_mistake.rs"),
            include_str!("shape.rs"),
            include_str!("stability.rs"),
            include_str!("tangent.rs"),
            include_str!("transfer_function.rs"),
            include_str!("value.rs"),
            include_str!("whose_numbers.rs"),
            include_str!("../model/mistakes/mod.rs"),
        ];
        let all: Vec<_> = sources.iter().flat_map(|source| codes(source)).collect();
        assert!(all.len() > 50, "{all:?}");
        for code in all {
            assert!(manual.contains(&format!("`{code}`")), "docs/marking.md does not list `{code}`");
        }
    }
}
