//! What was worked out for earlier submissions changes nothing for later ones.

use crate::bench::Bench;
use crate::class::Class;
use polemark::report::ReportKit;
use polemark::submission::{self, AttachmentError, Attachments, Submission};
use std::collections::BTreeMap;

/// Files that a generated student hands in.
struct Handed(Vec<(String, Vec<u8>)>);

impl Attachments for Handed {
    fn read(&self, name: &str) -> Result<Vec<u8>, AttachmentError> {
        let found = self.0.iter().find(|(known, _)| known == name);
        found.map(|(_, bytes)| bytes.clone()).ok_or(AttachmentError::NotFound)
    }
}

/// Marks and pages of a class, the last handed in first and the other way round; `Bench::grade` compares marks itself.
#[test]
fn who_came_before_makes_no_difference() {
    let bench = Bench::embedded();
    let generated = Class::new(&bench.lab, &bench.reference, 7);
    let generated = (0..24).map(|number| {
        let student = generated.student(number);
        let handed = Handed(student.attachments);
        submission::read(&student.id, "lab.yaml", student.answers.as_bytes(), &bench.lab.sheet, &handed)
    });
    let class: Vec<Submission> = bench.class().into_iter().chain(generated).collect();
    let pages = |order: &mut dyn Iterator<Item = &Submission>| -> BTreeMap<String, String> {
        let kit = ReportKit::new(&bench.lab, &bench.reference).unwrap();
        order.map(|one| (one.id.clone(), kit.student_page(one, &bench.grade(one)))).collect()
    };
    let (forwards, backwards) = (pages(&mut class.iter()), pages(&mut class.iter().rev()));
    for (id, page) in &forwards {
        assert!(backwards[id] == *page, "{id}");
    }
    let crosses = forwards.values().filter(|page| page.contains("your transfer function")).count();
    assert!(crosses > 20, "{crosses} pages have a curve of the student's own");
}
