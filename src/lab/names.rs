use crate::names::nearest;

/// Help for a name that is not known: the nearest one, or all of them.
pub(super) fn suggestion(name: &str, known: &[&str]) -> String {
    match nearest(name, known.iter().copied()) {
        Some(near) => format!("did you mean `{near}`?"),
        None if known.is_empty() => "there is none to choose from".to_owned(),
        None => format!("known: {}", list(known)),
    }
}

/// `a`, `b`, `c`.
pub(super) fn list(names: &[&str]) -> String {
    names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_name_is_suggested_or_all_are_listed() {
        let known = ["hanging", "upright"];
        assert_eq!(suggestion("hangin", &known), "did you mean `hanging`?");
        assert_eq!(suggestion("sideways", &known), "known: `hanging`, `upright`");
        assert_eq!(suggestion("x", &[]), "there is none to choose from");
    }
}
