use super::{Person, Summary, Why};
use crate::class::{Lms, name_words};
use crate::lab::folded_id;
use std::collections::BTreeMap;

/// Who is in which row of an LMS's file.
///
/// A student is found by the number that the LMS gave them, else by any other identifier (SIS id, login, ID number, e-mail
/// address), else by the full name where it is the only one. What leads to two rows leads to none.
#[derive(Debug, Default)]
pub struct Directory {
    rows: BTreeMap<(Key, String), Option<usize>>,
    names: BTreeMap<usize, String>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Key {
    /// The LMS's own number.
    Number,
    Identifier,
    Name,
}

/// Which student is in which row.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Matched {
    /// Row → place among the people.
    pub rows: BTreeMap<usize, usize>,
}

impl Directory {
    pub fn add(&mut self, row: usize, key: Key, value: &str) {
        let text = folded(key, value);
        if text.is_empty() {
            return;
        }
        if key == Key::Name {
            self.names.insert(row, value.to_owned());
        }
        let rows = self.rows.entry((key, text)).or_insert(Some(row));
        if *rows != Some(row) {
            *rows = None;
        }
    }

    /// Everyone whose row is certain; the others are named in `summary`, unless they are there for another reason.
    pub fn matched(&self, people: &[Person], lms: Lms, summary: &mut Summary) -> Matched {
        let found: Vec<Result<(usize, Key), Why>> =
            people.iter().map(|person| self.find(person, lms)).collect();
        let mut best: BTreeMap<usize, (Key, Vec<usize>)> = BTreeMap::new();
        for (person, (row, key)) in
            found.iter().enumerate().filter_map(|(at, one)| Some((at, *one.as_ref().ok()?)))
        {
            let (strongest, all) = best.entry(row).or_insert((key, Vec::new()));
            // Identifiers go before names, whoever comes first.
            let (by_name, were_by_name) = (key == Key::Name, *strongest == Key::Name);
            if were_by_name && !by_name {
                (*strongest, *all) = (key, vec![person]);
            } else if by_name == were_by_name {
                all.push(person);
            }
        }
        let mut matched = Matched::default();
        for (at, (person, found)) in people.iter().zip(&found).enumerate() {
            let why = match found {
                Ok((row, key)) => match best.get(row) {
                    Some((_, all)) if *all == [at] => {
                        matched.rows.insert(*row, at);
                        if *key == Key::Name && person.mark.is_ok() {
                            summary.by_name_alone.push(person.who());
                        }
                        continue;
                    }
                    _ => Why::SameRow,
                },
                Err(why) => why.clone(),
            };
            if person.mark.is_ok() {
                summary.leave_out(person.who(), why);
            }
        }
        matched
    }

    fn find(&self, person: &Person, lms: Lms) -> Result<(usize, Key), Why> {
        let mut keys: Vec<(Key, &str)> = Vec::new();
        let roster = person.roster.as_deref();
        let number = roster.and_then(|row| match lms {
            Lms::Canvas => row.canvas_id.as_deref(),
            Lms::Moodle => row.moodle_id.as_deref(),
        });
        keys.extend(number.map(|number| (Key::Number, number)));
        if let Some(row) = roster {
            let others =
                [Some(&row.id), row.sis_user_id.as_ref(), row.sis_login_id.as_ref(), row.email.as_ref()];
            keys.extend(others.into_iter().flatten().map(|text| (Key::Identifier, text.as_str())));
        }
        keys.push((Key::Identifier, &person.id));
        let mut rows: Vec<Option<usize>> = keys
            .iter()
            .filter_map(|(key, text)| self.rows.get(&(*key, folded(*key, text))).copied())
            .collect();
        rows.extend(self.by_file_name(person, lms).map(Some));
        match rows.first() {
            Some(Some(row)) if rows.iter().all(|other| *other == Some(*row)) => {
                return Ok((*row, Key::Identifier));
            }
            Some(_) => return Err(Why::SeveralRows),
            None => {}
        }
        let name = roster.map_or(person.name.as_str(), |row| row.name.as_str());
        match self.rows.get(&(Key::Name, folded(Key::Name, name))) {
            Some(Some(row)) => Ok((*row, Key::Name)),
            Some(None) => Err(Why::SeveralRows),
            None => Err(Why::NotThere),
        }
    }

    /// By the number in the name of the file that the LMS gave out, where the name in front of it is of that row: in group work
    /// the number is the group's, and may be that of a stranger.
    fn by_file_name(&self, person: &Person, lms: Lms) -> Option<usize> {
        let handed_in = person.handed_in.as_ref().filter(|one| one.lms == Some(lms))?;
        if handed_in.anonymous && lms == Lms::Canvas {
            return None;
        }
        let number = folded(Key::Number, handed_in.lms_id.as_deref()?);
        let row = (*self.rows.get(&(Key::Number, number))?)?;
        let letters = |name: &str| {
            let mut letters: Vec<char> = name_words(name).concat().chars().collect();
            letters.sort_unstable();
            letters
        };
        let owner = handed_in.owner.as_deref().unwrap_or_default();
        let name = self.names.get(&row).map_or("", String::as_str);
        (letters(owner) == letters(name)).then_some(row)
    }
}

fn folded(key: Key, text: &str) -> String {
    match key {
        // `Participant 123`, in the language of the site, and `123` are the same number.
        Key::Number => {
            let text = text.trim();
            let digits = text.len() - text.trim_end_matches(|c: char| c.is_ascii_digit()).len();
            text[text.len() - digits..].trim_start_matches('0').to_owned()
        }
        Key::Identifier if text.contains('@') => text.trim().to_lowercase(),
        Key::Identifier => folded_id(text),
        Key::Name => {
            let mut words = name_words(text);
            words.sort();
            words.join(" ")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::class::{HandedIn, RosterStudent};
    use crate::lab::Points;

    fn person(id: &str, name: &str) -> Person {
        Person {
            id: id.to_owned(),
            name: name.to_owned(),
            roster: None,
            handed_in: None,
            file: String::new(),
            mark: Ok(Points(100)),
            by_question: String::new(),
        }
    }

    fn with_number(number: &str, person: Person) -> Person {
        let row = RosterStudent { moodle_id: Some(number.to_owned()), ..RosterStudent::default() };
        Person { roster: Some(Box::new(row)), ..person }
    }

    fn handed_in(owner: &str, number: &str, person: Person) -> Person {
        let said = HandedIn {
            lms: Some(Lms::Moodle),
            owner: Some(owner.to_owned()),
            lms_id: Some(number.to_owned()),
            ..HandedIn::default()
        };
        Person { handed_in: Some(said), ..person }
    }

    /// The rows of `people`, `-` for none, and how many were found by the name alone.
    #[track_caller]
    fn check(what: &str, people: &[Person], rows: &str) {
        let mut directory = Directory::default();
        for (row, (number, id, mail, name)) in [
            ("Participant 7", "EE-001", "jane@x.edu", "Jane Doe"),
            ("Participant 8", "EE-002", "john@x.edu", "John Smith"),
            ("Participant 9", "", "twin1@x.edu", "Alex Twin"),
            ("Participant 10", "", "twin2@x.edu", "Alex Twin"),
        ]
        .into_iter()
        .enumerate()
        {
            directory.add(row, Key::Number, number);
            directory.add(row, Key::Identifier, id);
            directory.add(row, Key::Identifier, mail);
            directory.add(row, Key::Name, name);
        }
        let mut summary = Summary::default();
        let matched = directory.matched(people, Lms::Moodle, &mut summary);
        let row = |at| matched.rows.iter().find(|(_, person)| **person == at).map(|(row, _)| row.to_string());
        let shown: Vec<String> = (0..people.len()).map(|at| row(at).unwrap_or("-".to_owned())).collect();
        let shown = format!("{} {}", shown.join(""), summary.by_name_alone.len());
        assert_eq!(shown, rows, "{what}: {summary:?}");
        assert_eq!(summary.left_out.len(), people.len() - matched.rows.len(), "{what}");
    }

    #[test]
    fn everyone_is_found_once_or_not_at_all() {
        check("by ID number, however typed", &[person("ee001", ""), person("EE 002", "")], "01 0");
        check("by e-mail address", &[person("Jane@X.edu", "")], "0 0");
        check("by the LMS's number", &[with_number("8", person("z", ""))], "1 0");
        check("by name, in any order", &[person("?", "Doe, Jane")], "0 1");
        check("two of a name", &[person("?", "Alex Twin")], "- 0");
        check("two of a name, one known", &[person("twin2@x.edu", "Alex Twin")], "3 0");
        check("nobody", &[person("EE-009", "No One")], "- 0");
        check("no name, no id", &[person("", "")], "- 0");
        check("number and id of different rows", &[with_number("8", person("EE-001", ""))], "- 0");
        check("an identifier goes before a name", &[person("?", "Jane Doe"), person("EE-001", "X")], "-0 0");
        check("two by the same name", &[person("?", "Jane Doe"), person("!", "Doe Jane")], "-- 0");
        check("two by the same identifier", &[person("EE-001", ""), person("jane@x.edu", "")], "-- 0");
        check("by the name of the file", &[handed_in("Jane Doe", "7", person("?", ""))], "0 0");
        check(
            "a group's number in the name of the file",
            &[handed_in("Group A", "7", person("?", ""))],
            "- 0",
        );
    }
}
