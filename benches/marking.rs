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

    /// Once the first answer is looked at that no single mistake explains.
    #[divan::bench]
    fn follow_pairs_of_mistakes(bencher: Bencher<'_, '_>) {
        bencher
            .with_inputs(|| Catalogue::new(&LAB, &REFERENCE))
            .bench_refs(|catalogue| black_box(catalogue).follow_pairs());
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

    #[divan::bench]
    fn write_report(bencher: Bencher<'_, '_>) {
        LazyLock::force(&KIT);
        bencher.bench(|| KIT.student_page(black_box(&SUBMISSION), &CARD));
    }
}

#[divan::bench_group(name = "once a wrong transfer function")]
mod once_a_wrong_transfer_function {
    use super::*;
    use polemark::algebra::{Polynomial, parse_decimal};
    use polemark::lab::SystemRef;
    use polemark::lti::TransferFunction;

    fn search(bencher: Bencher<'_, '_>, num: &str, den: &str) {
        let polynomial = |text: &str| {
            let coefficients = text.split(' ').map(|c| parse_decimal(c).expect("a decimal"));
            Polynomial::new(coefficients.collect())
        };
        let typed = TransferFunction::new(polynomial(num), polynomial(den)).expect("a denominator");
        let of = SystemRef { model: "cart".to_owned(), operating_point: "hanging".to_owned() };
        CATALOGUE.follow_pairs();
        bencher.bench(|| CATALOGUE.diagnose(&of, black_box(&typed)));
    }

    #[divan::bench]
    fn one_mistake(bencher: Bencher<'_, '_>) {
        search(bencher, "-0.06 0", "0.0132 0.0024 -0.412 -0.0589");
    }

    #[divan::bench]
    fn a_mistake_and_a_slip(bencher: Bencher<'_, '_>) {
        search(bencher, "0.06 0", "-0.0132 -0.0024 0.4166 0.0588");
    }

    #[divan::bench]
    fn two_mistakes(bencher: Bencher<'_, '_>) {
        search(bencher, "-0.06 0", "0.0006 0.0006 -0.412 -0.0589");
    }

    #[divan::bench]
    fn nothing_explains_it(bencher: Bencher<'_, '_>) {
        search(bencher, "7.123 0", "1.234 2.345 3.456 4.567");
    }

    #[divan::bench]
    fn nearly_right_and_nothing_explains_it(bencher: Bencher<'_, '_>) {
        search(bencher, "-0.06 0", "0.0132 0.0077 0.41202 0.05886");
    }
}
