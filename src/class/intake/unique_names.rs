use std::collections::{BTreeMap, BTreeSet};

/// Gives out names that are safe as file names everywhere and differ by more than case.
#[derive(Debug, Default)]
pub struct UniqueNames {
    taken: BTreeSet<String>,
    /// The last number given to each name: a whole class calls its files `lab.yaml`.
    last: BTreeMap<String, usize>,
}

impl UniqueNames {
    /// `wanted` reduced to letters, digits, `.`, `_`, `-`, at most 80 characters; numbered when taken.
    pub fn claim(&mut self, wanted: &str) -> String {
        let base = safe_file_name(wanted);
        let last = self.last.entry(base.to_lowercase()).or_insert(0);
        loop {
            *last += 1;
            let name = if *last == 1 { base.clone() } else { format!("{base}-{last}") };
            if self.taken.insert(name.to_lowercase()) {
                return name;
            }
        }
    }
}

fn safe_file_name(wanted: &str) -> String {
    let mut name = String::new();
    for character in wanted.chars().take(80) {
        let safe = character.is_ascii_alphanumeric() || matches!(character, '.' | '_' | '-');
        match (safe, name.ends_with('-')) {
            (true, _) => name.push(character),
            (false, false) => name.push('-'),
            (false, true) => {}
        }
    }
    let name = name.trim_matches(['.', '-']).to_owned();
    let device = name.split('.').next().unwrap_or_default().to_ascii_uppercase();
    let reserved = matches!(device.as_str(), "CON" | "PRN" | "AUX" | "NUL")
        || (device.len() == 4
            && (device.starts_with("COM") || device.starts_with("LPT"))
            && device.ends_with(|c: char| c.is_ascii_digit()));
    match (name.is_empty(), reserved) {
        (true, _) => "submission".to_owned(),
        (false, true) => format!("_{name}"),
        (false, false) => name,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_safe_on_every_system() {
        for (wanted, name) in [
            ("EE-001", "EE-001"),
            ("../../etc/passwd", "etc-passwd"),
            ("<script>", "script"),
            ("=cmd|' /C calc'!A0", "cmd-C-calc-A0"),
            ("", "submission"),
            ("…", "submission"),
            (".hidden", "hidden"),
            ("nul", "_nul"),
            ("com1.yaml", "_com1.yaml"),
            ("a\u{202e}b", "a-b"),
            (&"x".repeat(300), &"x".repeat(80)),
        ] {
            assert_eq!(safe_file_name(wanted), name, "from {wanted:?}");
        }
    }

    #[test]
    fn taken_names_are_numbered_whatever_their_case() {
        let mut names = UniqueNames::default();
        let given: Vec<String> = ["a", "A", "a", "a-2"].iter().map(|n| names.claim(n)).collect();
        assert_eq!(given, ["a", "A-2", "a-3", "a-2-2"]);
    }

    #[test]
    fn a_large_class_may_call_all_its_files_the_same() {
        let mut names = UniqueNames::default();
        let last = (0..100_000).map(|_| names.claim("lab")).last();
        assert_eq!(last.as_deref(), Some("lab-100000"));
    }
}
