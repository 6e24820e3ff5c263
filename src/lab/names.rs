/// The known name closest to `name`: smallest Damerau–Levenshtein distance of at most a third of the length, ties by Jaro–Winkler.
pub(super) fn nearest<'a>(name: &str, known: &[&'a str]) -> Option<&'a str> {
    let length = name.chars().count();
    let limit = (length / 3).max(1);
    known
        .iter()
        .map(|k| (strsim::damerau_levenshtein(name, k), strsim::jaro_winkler(name, k), *k))
        // Of a single letter, everything is one change away.
        .filter(|(distance, _, k)| *distance <= limit && *distance < length || name.eq_ignore_ascii_case(k))
        .min_by(|a, b| a.0.cmp(&b.0).then(b.1.total_cmp(&a.1)))
        .map(|(_, _, k)| k)
}

/// Help for a name that is not known: the nearest one, or all of them.
pub(super) fn suggestion(name: &str, known: &[&str]) -> String {
    match nearest(name, known) {
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
    fn the_nearest_name_is_suggested_when_it_is_near() {
        let known = ["hanging", "upright", "theta"];
        for (name, near) in [
            ("hangin", Some("hanging")),
            ("hnaging", Some("hanging")),
            ("uprigth", Some("upright")),
            ("thata", Some("theta")),
            ("sideways", None),
            ("x", None),
            ("THETA", Some("theta")),
            ("", None),
        ] {
            assert_eq!(nearest(name, &known), near, "{name}");
        }
        assert_eq!(suggestion("sideways", &known[..2]), "known: `hanging`, `upright`");
        assert_eq!(suggestion("x", &[]), "there is none to choose from");
    }
}
