//! What marking costs, stage by stage, on the embedded lab's model answer. Compare lines of one run with each other:
//! absolute times are the machine's.
//!
//! ```text
//! cargo bench
//! ```

use divan::{Bencher, black_box};
use polemark::grading::{Catalogue, Scorecard, grade};
use polemark::lab::{self, LabDefinition};
use polemark::reference::Reference;
use polemark::report::ReportKit;
use polemark::submission::{NoFiles, Submission, read, self_check};
use std::sync::LazyLock;

fn main() {
    divan::main();
}

static LAB: LazyLock<LabDefinition> =
    LazyLock::new(|| lab::load(lab::DEFAULT).expect("the embedded lab parses"));
static REFERENCE: LazyLock<Reference> =
    LazyLock::new(|| Reference::compute(&LAB).expect("the embedded lab has a reference"));
static CATALOGUE: LazyLock<Catalogue> = LazyLock::new(|| Catalogue::new(&LAB, &REFERENCE));
static KIT: LazyLock<ReportKit> =
    LazyLock::new(|| ReportKit::new(&LAB, &REFERENCE).expect("the embedded lab's figures can be drawn"));
static SUBMISSION: LazyLock<Submission> = LazyLock::new(|| {
    let text = include_bytes!("../submissions/letters.yaml");
    read("letters", "letters.yaml", text, &LAB.sheet, &NoFiles)
});
static CARD: LazyLock<Scorecard> = LazyLock::new(|| grade(&LAB, &REFERENCE, &CATALOGUE, &SUBMISSION, None));

#[divan::bench_group(name = "once a lab")]
mod once_a_lab {
    use super::*;

    #[divan::bench]
    fn parse_lab() -> LabDefinition {
        lab::load(black_box(lab::DEFAULT)).expect("the embedded lab parses")
    }

    #[divan::bench]
    fn compute_reference(bencher: Bencher<'_, '_>) {
        bencher.bench(|| Reference::compute(black_box(&LAB)));
    }

    #[divan::bench]
    fn list_mistakes(bencher: Bencher<'_, '_>) {
        LazyLock::force(&REFERENCE);
        bencher.bench(|| Catalogue::new(black_box(&LAB), &REFERENCE));
    }

    #[divan::bench]
    fn draw_shared_figures(bencher: Bencher<'_, '_>) {
        LazyLock::force(&REFERENCE);
        bencher.bench(|| ReportKit::new(black_box(&LAB), &REFERENCE));
    }
}

#[divan::bench_group(name = "once a student")]
mod once_a_student {
    use super::*;

    #[divan::bench]
    fn read_answers() -> Submission {
        let text = include_bytes!("../submissions/letters.yaml");
        read("letters", "letters.yaml", black_box(text), &LAB.sheet, &NoFiles)
    }

    #[divan::bench]
    fn check_answers(bencher: Bencher<'_, '_>) {
        LazyLock::force(&SUBMISSION);
        bencher.bench(|| self_check(black_box(&SUBMISSION), &LAB.sheet));
    }

    #[divan::bench]
    fn grade_answers(bencher: Bencher<'_, '_>) {
        LazyLock::force(&CATALOGUE);
        bencher.bench(|| grade(&LAB, &REFERENCE, &CATALOGUE, black_box(&SUBMISSION), None));
    }

    /// The longest search: nothing explains it.
    #[divan::bench]
    fn grade_a_transfer_function_nothing_explains(bencher: Bencher<'_, '_>) {
        let text = b"answers: {hanging.transfer_function: 7.123s / (1.234s^3 + 2.345s^2 + 3.456s + 4.567)}";
        let wrong = read("wrong", "wrong.yaml", text, &LAB.sheet, &NoFiles);
        LazyLock::force(&CATALOGUE);
        bencher.bench(|| grade(&LAB, &REFERENCE, &CATALOGUE, black_box(&wrong), None));
    }

    #[divan::bench]
    fn write_report(bencher: Bencher<'_, '_>) {
        LazyLock::force(&KIT);
        bencher.bench(|| KIT.student_page(black_box(&SUBMISSION), &CARD));
    }
}
