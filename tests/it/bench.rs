//! A lab with all that marking needs, and the class that answers it.

use polemark::grading::{self, Catalogue, ItemScore, Scorecard};
use polemark::lab::{self, Criterion, LabDefinition};
use polemark::reference::Reference;
use polemark::source::SourceText;
use polemark::submission::{self, Folder, Submission};
use std::fs;
use std::path::PathBuf;
use std::sync::LazyLock;

pub struct Bench {
    pub lab: LabDefinition,
    pub reference: Reference,
    pub catalogue: Catalogue,
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

    fn of(name: &str, text: &str) -> Self {
        let lab = LabDefinition::parse(SourceText::new(name, text));
        Self::new(lab.unwrap_or_else(|errors| panic!("{name}: {errors:#?}")))
    }

    fn new(lab: LabDefinition) -> Self {
        let reference = Reference::compute(&lab).expect("the lab has a reference");
        let catalogue = Catalogue::new(&lab, &reference);
        Self { lab, reference, catalogue }
    }

    /// What an answer file has below `answers:`; files are those of `submissions/`.
    pub fn read(&self, answers: &str) -> Submission {
        let file = format!("answers:\n{answers}");
        submission::read("example", "example.yaml", file.as_bytes(), &self.lab.sheet, &Folder(folder()))
    }

    pub fn grade(&self, submission: &Submission) -> Scorecard {
        grading::grade(&self.lab, &self.reference, &self.catalogue, submission, None)
    }

    /// The marks of what an answer file has below `answers:`.
    pub fn mark(&self, answers: &str) -> Vec<ItemScore> {
        items(self.grade(&self.read(answers)))
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
