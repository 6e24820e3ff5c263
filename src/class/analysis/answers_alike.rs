use crate::class::Record;
use crate::class::record::ItemRecord;
use crate::lab::LabDefinition;
use crate::report::{AnswersShared, People, SharedAnswer};
use crate::submission::FieldKind;
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;

/// Different wrong answers that are remembered; later ones are counted only.
const MOST: usize = 100_000;
/// Fewer digits are written alike by chance.
const FEWEST_DIGITS: usize = 4;
/// Up to so many, or one in ten of the wrong answers to a field, are unusual; more have a common cause.
const FEW: usize = 2;
const ONE_IN: usize = 10;

/// Wrong answers that several submissions have to the letter, and that nothing known explains.
///
/// Looked at are transfer functions, poles and values that are wrong for no reason polemark can name: not explained by a
/// mistake, not right for an earlier answer, in another unit or by another convention.
pub struct AnswersAlike {
    fields: Vec<Field>,
    /// By field and fingerprint of the answer.
    answers: BTreeMap<(u16, u64), Seen>,
    not_remembered: usize,
}

struct Field {
    path: String,
    prompt: String,
    question: String,
    criteria: Vec<String>,
    /// Wrong answers that nothing explains.
    wrong: usize,
}

/// Who gave an answer, by row. `text` is kept once there are two.
struct Seen {
    rows: Vec<u32>,
    count: usize,
    text: String,
}

impl AnswersAlike {
    pub fn new(lab: &LabDefinition) -> Self {
        let fields = lab.questions.iter().flat_map(|question| {
            let kinds = [FieldKind::TransferFunction, FieldKind::Poles, FieldKind::Value];
            let fields = question.fields.iter().filter(move |field| kinds.contains(&field.kind));
            fields.map(move |field| Field {
                path: field.path.clone(),
                prompt: field.prompt.trim().trim_end_matches('.').to_owned(),
                question: question.number.clone(),
                criteria: question
                    .criteria
                    .iter()
                    .filter(|criterion| criterion.field == field.path)
                    .map(|criterion| criterion.id.clone())
                    .collect(),
                wrong: 0,
            })
        });
        Self { fields: fields.collect(), answers: BTreeMap::new(), not_remembered: 0 }
    }

    /// `row` is the record's place on the class page.
    pub fn add(&mut self, record: &Record, row: usize) {
        let Ok(row) = u32::try_from(row) else { return };
        for (place, field) in self.fields.iter_mut().enumerate() {
            let Ok(place) = u16::try_from(place) else { break };
            let items = record.items.iter().filter(|item| field.criteria.contains(&item.id));
            let Some(answer) = unexplained(&items.collect::<Vec<_>>()) else { continue };
            field.wrong += 1;
            let key = (place, hash(answer));
            if self.answers.len() >= MOST && !self.answers.contains_key(&key) {
                self.not_remembered += 1;
                continue;
            }
            let none = || Seen { rows: Vec::new(), count: 0, text: String::new() };
            let seen = self.answers.entry(key).or_insert_with(none);
            seen.count += 1;
            if seen.rows.len() < People::MOST {
                seen.rows.push(row);
            }
            if seen.count == 2 {
                seen.text = answer.chars().take(200).collect();
            }
        }
    }

    /// Those who share several first; `who` names a row and links to it.
    ///
    /// Answers of exactly the same submissions stand together. With it how many answers could not be compared.
    pub fn list(&self, who: impl Fn(usize) -> (String, String)) -> (Vec<AnswersShared>, usize) {
        let mut shared: BTreeMap<&[u32], Vec<SharedAnswer>> = BTreeMap::new();
        for ((place, _), seen) in &self.answers {
            let field = &self.fields[usize::from(*place)];
            if seen.count < 2 || seen.count > FEW.max(field.wrong / ONE_IN) {
                continue;
            }
            shared.entry(&seen.rows).or_default().push(SharedAnswer {
                question: field.question.clone(),
                prompt: field.prompt.clone(),
                field: field.path.clone(),
                answer: seen.text.clone(),
                count: seen.count,
                wrong: field.wrong,
            });
        }
        let groups = shared.into_iter().map(|(rows, answers)| {
            let mut people = People::default();
            for row in rows {
                let (name, link) = who(*row as usize);
                people.add(&name, &link);
            }
            people.count = answers.iter().map(|answer| answer.count).max().unwrap_or(0);
            AnswersShared { people, answers }
        });
        let mut groups: Vec<AnswersShared> = groups.collect();
        groups.sort_by_key(|group| (std::cmp::Reverse(group.answers.len()), group.people.count));
        (groups, self.not_remembered)
    }
}

/// The answer that `items` judge, if it is wrong for no reason that is known.
fn unexplained<'a>(items: &[&'a ItemRecord]) -> Option<&'a str> {
    const UNNAMED: [&str; 2] = ["poles.value", "value.differs"];
    let explained = |item: &&ItemRecord| {
        item.follow_through.is_some()
            || item.code.ends_with(".same_mistake")
            || item.diagnosis.as_ref().is_some_and(|diagnosis| !diagnosis.explanations.is_empty())
    };
    if items.iter().any(explained) {
        return None;
    }
    let of_function =
        |code: &str| ["structure.", "numerator.", "denominator."].iter().any(|part| code.starts_with(part));
    let is_wrong = |item: &&&ItemRecord| {
        item.verdict == "wrong" && (UNNAMED.contains(&item.code.as_str()) || of_function(&item.code))
    };
    let found = items.iter().find(is_wrong)?.evidence.found.as_str();
    (found.chars().filter(char::is_ascii_digit).count() >= FEWEST_DIGITS).then_some(found)
}

fn hash(text: &str) -> u64 {
    let digest = Sha256::digest(text.as_bytes());
    digest.iter().take(8).fold(0, |all, byte| all << 8 | u64::from(*byte))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::class::analysis::samples::{item, record_of};
    use serde_json::json;

    fn answers() -> AnswersAlike {
        let field = |name: &str| Field {
            path: format!("q.{name}"),
            prompt: name.to_owned(),
            question: "1".to_owned(),
            criteria: vec![format!("q.{name}")],
            wrong: 0,
        };
        AnswersAlike { fields: vec![field("a"), field("b")], answers: BTreeMap::new(), not_remembered: 0 }
    }

    fn groups(answers: &AnswersAlike) -> Vec<(Vec<String>, Vec<String>)> {
        let who = |row: usize| (format!("S{row}"), String::new());
        let (groups, _) = answers.list(who);
        let names = |group: &AnswersShared| group.people.first.iter().map(|one| one.name.clone()).collect();
        let fields = |group: &AnswersShared| group.answers.iter().map(|one| one.field.clone()).collect();
        groups.iter().map(|group| (names(group), fields(group))).collect()
    }

    #[test]
    fn those_who_share_wrong_answers_stand_together() {
        let mut answers = answers();
        for (row, a, b) in
            [(0, "1.2345", "6.789"), (1, "1.2345", "6.789"), (2, "1.2346", "6.789"), (3, "1.0", "1.0")]
        {
            answers.add(&record_of(&[item("q.a", "wrong", a), item("q.b", "wrong", b)]), row);
        }
        // 6.789 is what three of three gave: more than unusual. 1.0 has too few digits.
        let owned = |list: &[&str]| list.iter().map(|one| (*one).to_owned()).collect::<Vec<_>>();
        assert_eq!(groups(&answers), [(owned(&["S0", "S1"]), owned(&["q.a"]))]);
    }

    #[test]
    fn what_is_explained_is_not_unusual() {
        let diagnosis =
            json!({"explanations": [{"code": "term.sign", "words": "w", "changes": []}], "searched": 9});
        let follow = json!({"credited": false, "guard": "passed", "root": "q.b"});
        for (key, value) in [
            ("diagnosis", diagnosis),
            ("follow_through", follow),
            ("code", json!("value.other_unit")),
            ("verdict", json!("right")),
        ] {
            let mut answers = answers();
            let mut one = item("q.a", "wrong", "1.2345");
            one[key] = value;
            (0..2).for_each(|row| answers.add(&record_of(std::slice::from_ref(&one)), row));
            assert_eq!(groups(&answers), [], "{key}");
        }
    }
}
