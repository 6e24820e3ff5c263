//! What the README shows is true: its lab is proven, its answers can be read.

use polemark::lab::{self, LabDefinition};
use polemark::proof::prove;
use polemark::reference::Reference;
use polemark::source::SourceText;
use polemark::submission::{AttachmentError, Attachments, read};

const README: &str = include_str!("../../README.md");

/// The YAML block that begins with `first_line`.
fn block(first_line: &str) -> &'static str {
    let start =
        README.find(&format!("```yaml\n{first_line}")).expect("the block is there") + "```yaml\n".len();
    let length = README[start..].find("```").expect("the block ends");
    &README[start..start + length]
}

#[test]
fn the_lab_is_proven() {
    let lab = LabDefinition::parse(SourceText::new("README.md", block("lab: tank"))).expect("it parses");
    let reference = Reference::compute(&lab).expect("it has a reference");
    let failed: Vec<_> = prove(&lab, &reference).into_iter().filter(|check| !check.holds).collect();
    assert!(failed.is_empty(), "{failed:#?}");
}

/// Every file that is asked for.
struct Exported;

impl Attachments for Exported {
    fn read(&self, _: &str) -> Result<Vec<u8>, AttachmentError> {
        Ok(b"t,y\n0,0\n1,0.5\n2,0.1\n".to_vec())
    }
}

#[test]
fn the_answers_can_be_read() {
    let lab = lab::load(lab::DEFAULT).expect("the embedded lab parses");
    let answers = read("readme", "README.md", block("lab: ee361-lab3").as_bytes(), &lab.sheet, &Exported);
    assert!(answers.findings.is_empty(), "{:#?}", answers.findings);
    assert_eq!(answers.answers.len(), 8);
}
