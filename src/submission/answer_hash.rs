use super::{Answer, AnswerValue, Submission};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;

/// Hexadecimal digits: two different answers of a class share a hash with a chance below one in 10^12.
const DIGITS: usize = 16;

impl Answer {
    /// Tells whether an answer is what it was: 16 hexadecimal digits of SHA-256 over the answer as typed and what was read from
    /// the file it names (a picture's bytes, a table's headers and numbers, or why it could not be read).
    pub fn hash(&self) -> String {
        let mut parts = Parts::default();
        parts.add(self.text.as_bytes());
        match &self.value {
            Ok(AnswerValue::Figure(figure)) => parts.add(&figure.bytes),
            Ok(AnswerValue::Data(series)) => {
                series.headers.iter().for_each(|header| parts.add(header.as_bytes()));
                for row in &series.rows {
                    let bytes: Vec<u8> = row.iter().flat_map(|value| value.to_bits().to_le_bytes()).collect();
                    parts.add(&bytes);
                }
            }
            Err(why) if why.finding.code.starts_with("figure.") || why.finding.code.starts_with("data.") => {
                parts.add(why.finding.message.as_bytes());
            }
            _ => {}
        }
        parts.digits()
    }
}

impl Submission {
    /// The hash of every answer, by field.
    pub fn answer_hashes(&self) -> BTreeMap<String, String> {
        self.answers.iter().map(|(field, answer)| (field.clone(), answer.hash())).collect()
    }
}

/// The hash of what is judged by the answers to several fields; `None` when all of them are blank.
///
/// Of one field it is that answer's own hash.
pub fn hash_of_fields(answers: &BTreeMap<String, String>, fields: &[&str]) -> Option<String> {
    match fields {
        [only] => answers.get(*only).cloned(),
        _ if fields.iter().all(|field| !answers.contains_key(*field)) => None,
        _ => {
            let mut parts = Parts::default();
            for field in fields {
                parts.add(answers.get(*field).map_or(&[], |hash| hash.as_bytes()));
            }
            Some(parts.digits())
        }
    }
}

/// Parts, each with its length before it, so that they cannot run together.
#[derive(Default)]
struct Parts(Sha256);

impl Parts {
    fn add(&mut self, part: &[u8]) {
        self.0.update((part.len() as u64).to_le_bytes());
        self.0.update(part);
    }

    fn digits(self) -> String {
        self.0.finalize().iter().take(DIGITS / 2).map(|byte| format!("{byte:02x}")).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::{Finding, Span};
    use crate::submission::{Figure, Series, Unreadable};

    fn answer(text: &str, value: Result<AnswerValue, Unreadable>) -> String {
        Answer { path: "a".to_owned(), span: Span { start: 0, end: 0 }, text: text.to_owned(), value }.hash()
    }

    #[test]
    fn what_was_typed_and_attached_tells_answers_apart() {
        let prose = |text: &str| answer(text, Ok(AnswerValue::Prose(text.to_owned())));
        let figure = |bytes: &[u8]| {
            let figure = Figure {
                file_name: "a.png".to_owned(),
                media_type: "image/png",
                bytes: bytes.to_vec(),
                width: 1,
                height: 1,
            };
            answer("a.png", Ok(AnswerValue::Figure(figure)))
        };
        let series = |y: f64| {
            let rows = vec![vec![0.0, y]];
            let series = Series { file_name: "a.csv".to_owned(), headers: vec![String::new(); 2], rows };
            answer("a.csv", Ok(AnswerValue::Data(series)))
        };
        let broken = |code: &'static str, message: &str| {
            answer("a.png", Err(Unreadable { finding: Finding::error(code, message) }))
        };
        assert_eq!(prose("It swings."), prose("It swings."));
        assert_eq!(prose("It swings.").len(), DIGITS);
        for (one, other, same) in [
            (prose("It swings."), prose("It swings"), false),
            (figure(b"one"), figure(b"one"), true),
            (figure(b"one"), figure(b"two"), false),
            (series(1.0), series(1.0), true),
            (series(1.0), series(2.0), false),
            (broken("figure.not_read", "gone"), broken("figure.not_read", "too large"), false),
            (broken("poles.unreadable", "in these words"), broken("poles.unreadable", "in others"), true),
        ] {
            assert_eq!(one == other, same);
        }
    }

    #[test]
    fn several_fields_have_one_hash() {
        let answers: BTreeMap<String, String> =
            [("a", "1"), ("b", "2")].map(|(field, hash)| (field.to_owned(), hash.to_owned())).into();
        let of = |fields: &[&str]| hash_of_fields(&answers, fields);
        assert_eq!(of(&["a"]).as_deref(), Some("1"));
        assert_eq!((of(&["c"]), of(&["c", "d"])), (None, None));
        assert!(
            of(&["a", "b"]).is_some()
                && of(&["a", "b"]) != of(&["a", "c"])
                && of(&["a", "c"]) != of(&["c", "a"])
        );
    }
}
