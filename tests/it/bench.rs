//! A lab with all that marking needs, and the class that answers it.

use polemark::grading::{self, Catalogue, ItemScore, Known, MemberCard, Scorecard};
use polemark::lab::{self, Criterion, LabDefinition};
use polemark::reference::Reference;
use polemark::source::SourceText;
use polemark::submission::{self, Folder, Student, Submission};
use std::fs;
use std::path::PathBuf;
use std::sync::LazyLock;

pub struct Bench {
    pub lab: LabDefinition,
    pub reference: Reference,
    pub catalogue: Catalogue,
    /// Of everything that was marked by this bench.
    known: Known,
}

impl Bench {
    /// The lab that ships inside the program.
    pub fn embedded() -> &'static Self {
        static EMBEDDED: LazyLock<Bench> =
            LazyLock::new(|| Bench::new(lab::load(lab::DEFAULT).expect("the embedded lab is right")));
        &EMBEDDED
    }

    /// `small.yaml`: systems to be solved in the head.
    pub fn small() -> &'static Self {
        static SMALL: LazyLock<Bench> = LazyLock::new(|| Bench::of("small.yaml", include_str!("small.yaml")));
        &SMALL
    }

    /// `oscillator.yaml`: every feature of a response, with units.
    pub fn oscillator() -> &'static Self {
        static OSCILLATOR: LazyLock<Bench> =
            LazyLock::new(|| Bench::of("oscillator.yaml", include_str!("oscillator.yaml")));
        &OSCILLATOR
    }

    /// `tangent.yaml`: functions and their tangents.
    pub fn tangents() -> &'static Self {
        static TANGENTS: LazyLock<Bench> =
            LazyLock::new(|| Bench::of("tangent.yaml", include_str!("tangent.yaml")));
        &TANGENTS
    }

    /// `letters.yaml`: transfer functions asked for in letters.
    pub fn letters() -> &'static Self {
        static LETTERS: LazyLock<Bench> =
            LazyLock::new(|| Bench::of("letters.yaml", include_str!("letters.yaml")));
        &LETTERS
    }

    /// `variants.yaml`: a lab whose parameters differ from student to student.
    pub fn variants() -> &'static Self {
        static VARIANTS: LazyLock<Bench> =
            LazyLock::new(|| Bench::of("variants.yaml", include_str!("variants.yaml")));
        &VARIANTS
    }

    /// `rest.yaml`: values at rest.
    pub fn rest() -> &'static Self {
        static REST: LazyLock<Bench> = LazyLock::new(|| Bench::of("rest.yaml", include_str!("rest.yaml")));
        &REST
    }

    fn of(name: &str, text: &str) -> Self {
        let lab = LabDefinition::parse(SourceText::new(name, text));
        Self::new(lab.unwrap_or_else(|errors| panic!("{name}: {errors:#?}")))
    }

    fn new(lab: LabDefinition) -> Self {
        let reference = Reference::compute(&lab).expect("the lab has a reference");
        let catalogue = Catalogue::new(&lab, &reference);
        Self { lab, reference, catalogue, known: Known::new() }
    }

    /// What an answer file has below `answers:`; files are those of `submissions/`.
    pub fn read(&self, answers: &str) -> Submission {
        let file = format!("answers:\n{answers}");
        submission::read("example", "example.yaml", file.as_bytes(), &self.lab.sheet, &Folder(folder()))
    }

    /// What is known of earlier submissions makes no difference.
    pub fn grade(&self, submission: &Submission) -> Scorecard {
        let Self { lab, reference, catalogue, known } = self;
        let scorecard = grading::grade(lab, reference, catalogue, submission, None);
        let in_class = || grading::grade_knowing(known, lab, reference, catalogue, submission, None);
        assert_eq!([in_class(), in_class()], [scorecard.clone(), scorecard.clone()], "{}", submission.id);
        scorecard
    }

    /// The marks of what an answer file has below `answers:`.
    pub fn mark(&self, answers: &str) -> Vec<ItemScore> {
        items(self.grade(&self.read(answers)))
    }

    /// The marks of what these students have below `answers:`, by their own values where those differ.
    pub fn mark_of(&self, students: &[String], answers: &str) -> Vec<ItemScore> {
        let Some(rule) = &self.lab.variants else { return self.mark(answers) };
        let Some((first, others)) = students.split_first() else {
            let (lab, reference, catalogue) = (&self.lab, &self.reference, &self.catalogue);
            let submission = self.read(answers);
            return items(grading::grade_without_numbers(
                &Known::NOTHING,
                lab,
                reference,
                catalogue,
                &submission,
                None,
            ));
        };
        let own = |id: &String| {
            let variant = rule.of(id).expect("an id");
            Bench::new(self.lab.with_variant(&variant).expect("a variant"))
        };
        let student = |id: &String| Student { id: id.clone(), name: String::new() };
        let bench = own(first);
        let submission =
            Submission { students: students.iter().map(student).collect(), ..bench.read(answers) };
        let card = |id: &String| MemberCard { id: id.clone(), scorecard: own(id).grade(&submission) };
        let members: Vec<MemberCard> = others.iter().map(card).collect();
        let Bench { lab, reference, catalogue, .. } = &bench;
        items(grading::grade_beside_members(
            &Known::NOTHING,
            lab,
            reference,
            catalogue,
            &submission,
            None,
            &members,
        ))
    }

    pub fn all_criteria(&self) -> impl Iterator<Item = &Criterion> {
        self.lab.questions.iter().flat_map(|question| &question.criteria)
    }

    /// The criteria that `target` names: a criterion, or a field.
    pub fn criteria(&self, target: &str) -> Vec<&Criterion> {
        let exact: Vec<_> = self.all_criteria().filter(|criterion| criterion.id == target).collect();
        if !exact.is_empty() {
            return exact;
        }
        self.all_criteria().filter(|criterion| criterion.field == target).collect()
    }

    /// The files of `submissions/`, by name.
    pub fn class(&self) -> Vec<Submission> {
        let mut names: Vec<String> = fs::read_dir(folder())
            .unwrap()
            .map(|entry| entry.unwrap().path())
            .filter(|path| path.extension().is_some_and(|extension| extension == "yaml"))
            .map(|path| path.file_stem().unwrap().to_string_lossy().into_owned())
            .collect();
        names.sort();
        names.iter().map(|name| self.handed_in(name)).collect()
    }

    /// `submissions/<name>.yaml`
    pub fn handed_in(&self, name: &str) -> Submission {
        let file = format!("{name}.yaml");
        let bytes = fs::read(folder().join(&file)).unwrap_or_else(|error| panic!("{file}: {error}"));
        submission::read(name, &file, &bytes, &self.lab.sheet, &Folder(folder()))
    }
}

/// All marks of a scorecard, in the order of the criteria.
pub fn items(scorecard: Scorecard) -> Vec<ItemScore> {
    scorecard.questions.into_iter().flat_map(|question| question.items).collect()
}

fn folder() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("submissions")
}
