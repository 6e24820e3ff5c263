//! Which known name a mistyped one is nearest to. Knows only names.

/// The known name that `name` was likely meant to be: capitals aside, at most a third of the letters differ.
///
/// Damerau–Levenshtein distance, ties by Jaro–Winkler likeness, then by the order of `known`. One letter may differ in a
/// name of two, none in a name of one. `None` for a name of more than 100 bytes.
pub(crate) fn nearest<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    const LONGEST: usize = 100;
    if name.len() > LONGEST {
        return None;
    }
    let name = name.to_lowercase();
    let length = name.chars().count();
    known
        .into_iter()
        .filter_map(|candidate| {
            let lower = candidate.to_lowercase();
            let distance = strsim::damerau_levenshtein(&name, &lower);
            let limit = (length.max(lower.chars().count()) / 3).max(1);
            (distance <= limit && distance < length)
                .then(|| (distance, strsim::jaro_winkler(&name, &lower), candidate))
        })
        .min_by(|a, b| a.0.cmp(&b.0).then(b.1.total_cmp(&a.1)))
        .map(|(_, _, candidate)| candidate)
}

#[cfg(test)]
mod tests {
    use super::nearest;

    #[test]
    fn the_nearest_name_is_found_when_it_is_near() {
        let known = ["hanging", "upright", "theta", "unstable", "stable", "l"];
        for (name, expected) in [
            ("hangin", Some("hanging")),
            ("hnaging", Some("hanging")),
            ("uprigth", Some("upright")),
            ("thata", Some("theta")),
            ("THETA", Some("theta")),
            ("stabel", Some("stable")),
            ("Unstabel", Some("unstable")),
            ("L", Some("l")),
            ("ll", Some("l")),
            ("sideways", None),
            ("banana", None),
            ("x", None),
            ("", None),
        ] {
            assert_eq!(nearest(name, known), expected, "{name}");
        }
        assert_eq!(nearest(&"x".repeat(100_000), known), None);
    }
}
