use super::file::LabFile;
use super::template::quoted;
use super::{LabDefinition, Points};
use crate::source::{Node, Span, Value};
use crate::submission::{NoFiles, Submission, read};

/// An answer that is not quite right, and what it must earn.
#[derive(Clone, Debug, PartialEq)]
pub struct NearMiss {
    /// The question it answers.
    pub question: String,
    /// What its question earns with it, every other answer being the model answer's.
    pub points: Points,
    /// Why, in the author's words.
    pub why: String,
    /// Where it stands in the lab file.
    pub span: Span,
    /// A whole answer file, with the model answer everywhere else.
    file: String,
}

impl NearMiss {
    /// Read like any submission.
    pub fn submission(&self, lab: &LabDefinition) -> Submission {
        read("near-miss", "near miss", self.file.as_bytes(), &lab.sheet, &NoFiles)
    }
}

/// What stands under `near_misses`, by question; `points` and `why` of each are read with the types of the file.
pub(super) fn near_misses(file: &LabFile, tree: &Node, points: &[(String, Points, String)]) -> Vec<NearMiss> {
    let questions = tree.get("questions").and_then(Node::as_mapping).unwrap_or_default();
    let listed = questions.iter().flat_map(|(id, _, question)| {
        let items = question.get("near_misses").and_then(Node::as_sequence).unwrap_or_default();
        items.iter().filter_map(move |item| Some((id, item.entry("answer")?)))
    });
    listed
        .zip(points)
        .map(|((question, (key, answer)), (_, points, why))| {
            let mut text =
                format!("lab: {}\nstudent: {{id: near-miss, name: Near miss}}\nanswers:\n", file.lab.value);
            for (id, _, node) in questions {
                let model = node.get("model_answer");
                let written = match model {
                    _ if id != question => model.map(written),
                    Some(model) if node.get("fields").is_some() => Some(merged(model, answer)),
                    _ => Some(written(answer)),
                };
                text.extend(written.map(|answer| format!("  {id}: {answer}\n")));
            }
            NearMiss { question: question.clone(), points: *points, why: why.clone(), span: key, file: text }
        })
        .collect()
}

/// The fields of `model`, with those of `answer` in place of theirs.
fn merged(model: &Node, answer: &Node) -> String {
    let (Some(model), Some(own)) = (model.as_mapping(), answer.as_mapping()) else { return written(answer) };
    let kept = model.iter().filter(|(key, _, _)| own.iter().all(|(other, _, _)| other != key));
    let all = kept.chain(own).map(|(key, _, node)| format!("{}: {}", quoted(key), written(node)));
    format!("{{{}}}", all.collect::<Vec<_>>().join(", "))
}

/// On one line; what is text and what is a number makes no difference in an answer.
fn written(node: &Node) -> String {
    match &node.value {
        Value::Null => "\"\"".to_owned(),
        Value::Scalar(text) if text.is_empty() => "\"\"".to_owned(),
        Value::Scalar(text) => quoted(text),
        Value::Sequence(items) => {
            format!("[{}]", items.iter().map(written).collect::<Vec<_>>().join(", "))
        }
        Value::Mapping(entries) => {
            let entries = entries.iter().map(|(key, _, node)| format!("{}: {}", quoted(key), written(node)));
            format!("{{{}}}", entries.collect::<Vec<_>>().join(", "))
        }
    }
}
