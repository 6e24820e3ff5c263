use crate::grading::{Catalogue, Known};
use crate::lab::{LabDefinition, StudentEdition, SystemRef, Variant, VariantRule};
use crate::memo::Memo;
use crate::reference::Reference;
use crate::report::{ReportError, ReportKit};
use crate::submission::{AnswerSheet, Submission};
use std::sync::Arc;

/// By whose numbers a submission is marked.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Numbers {
    /// Everyone has the lab's own.
    Lab,
    /// Those of its first student, and of other members of the group where they differ: (id, variant).
    Own { variant: Variant, members: Vec<(String, Variant)> },
    /// Whose it is is not known.
    Unknown,
}

impl Numbers {
    /// (parameter, value as typed); `None` where everyone has the lab's own, empty when it is not known whose it is.
    pub fn values(&self, lab: &LabDefinition) -> Option<Vec<(String, String)>> {
        self.values_by(lab.variants.as_ref())
    }

    fn values_by(&self, rule: Option<&VariantRule>) -> Option<Vec<(String, String)>> {
        let values = |variant: &Variant| -> Vec<(String, String)> {
            let pairs = rule.iter().flat_map(|rule| rule.values(variant));
            pairs.map(|(name, value)| (name.to_owned(), value.to_owned())).collect()
        };
        match self {
            Self::Lab => None,
            Self::Unknown => Some(Vec::new()),
            Self::Own { variant, .. } => Some(values(variant)),
        }
    }

    pub fn variant(&self) -> Option<&Variant> {
        match self {
            Self::Own { variant, .. } => Some(variant),
            _ => None,
        }
    }
}

/// By whose numbers `submission` is marked.
pub fn numbers(lab: &LabDefinition, submission: &Submission) -> Numbers {
    numbers_by(lab.variants.as_ref(), submission)
}

fn numbers_by(rule: Option<&VariantRule>, submission: &Submission) -> Numbers {
    let Some(rule) = rule else { return Numbers::Lab };
    let Some(variant) = first_id(submission).and_then(|id| rule.of(id)) else { return Numbers::Unknown };
    let members = submission.students.iter().skip(1).filter_map(|student| {
        let other = rule.of(&student.id).filter(|other| *other != variant)?;
        Some((student.id.clone(), other))
    });
    let members = members.collect();
    Numbers::Own { variant, members }
}

/// The id of the first student, when it stands in the file: the file's own name says nothing about numbers.
fn first_id(submission: &Submission) -> Option<&str> {
    let stands_in = ["student.missing", "student.id_missing"];
    let first = submission.students.first()?;
    let missing = submission.findings.iter().any(|finding| stands_in.contains(&finding.code));
    // Somebody without an id has the file's; who states the same id after them is not counted again, who did before is.
    let twice = submission.students.iter().filter(|student| student.id == submission.id).count() > 1;
    (!missing || twice || first.id != submission.id).then_some(first.id.as_str())
}

/// A lab with everything computed that marking needs.
pub struct Bench {
    pub lab: Arc<LabDefinition>,
    pub reference: Reference,
    pub catalogue: Catalogue,
    pub kit: ReportKit,
    pub known: Known,
}

impl Bench {
    /// `own` is the whole reference of the lab's own values. Errors: in words, what does not work with these numbers.
    fn new(lab: Arc<LabDefinition>, own: &Reference, kit: &ReportKit) -> Result<Self, String> {
        let reference = Reference::for_marking(&lab, own).map_err(|error| error.to_string())?;
        let catalogue = Catalogue::new(&lab, &reference);
        let kit = kit.with_numbers(&lab, &reference).map_err(|error| error.to_string())?;
        Ok(Self { lab, reference, catalogue, kit, known: Known::new() })
    }
}

/// Labs with the values of variants, and benches: made when they are needed.
pub struct Benches<'a> {
    lab: &'a LabDefinition,
    reference: &'a Reference,
    kit: &'a ReportKit,
    labs: Memo<Variant, Result<Arc<LabDefinition>, String>>,
    benches: Memo<Variant, Result<Bench, String>>,
}

/// Kept at a time. A bench takes a megabyte or a few, a lab a tenth of that; as many labs as are read before they are marked.
const MOST_BENCHES: usize = 24;
const MOST_LABS: usize = 96;

impl<'a> Benches<'a> {
    /// All of these are those of the lab's own values, the reference whole.
    pub fn new(lab: &'a LabDefinition, reference: &'a Reference, kit: &'a ReportKit) -> Self {
        Self { lab, reference, kit, labs: Memo::of(MOST_LABS), benches: Memo::of(MOST_BENCHES) }
    }

    /// Errors: in words, what does not work with these values.
    pub fn lab(&self, variant: &Variant) -> Arc<Result<Arc<LabDefinition>, String>> {
        self.labs.get(variant.clone(), |variant| {
            self.lab.with_variant(variant).map(Arc::new).map_err(|errors| errors.to_string())
        })
    }

    pub fn get(&self, variant: &Variant) -> Arc<Result<Bench, String>> {
        self.benches.get(variant.clone(), |variant| match &*self.lab(variant) {
            Ok(lab) => Bench::new(Arc::clone(lab), self.reference, self.kit),
            Err(why) => Err(why.clone()),
        })
    }
}

/// An answer file read by `read`, with its student's values for the letters, and these as [`Numbers::values`] gives them.
pub fn read_with_own_values(
    edition: &StudentEdition,
    read: &dyn Fn(&AnswerSheet) -> Submission,
) -> (Submission, AnswerSheet, Option<Vec<(String, String)>>) {
    let mut sheet = edition.sheet();
    let mut submission = read(&sheet);
    let own = numbers_by(edition.variants(), &submission);
    if let Some(variant) = own.variant() {
        sheet = edition.sheet_of(variant);
        submission = read(&sheet);
    }
    (submission, sheet, own.values_by(edition.variants()))
}

/// A lab with a variant's values, and the numbers that are right by them; `None` when it does not work with these values.
pub fn light_reference(lab: &LabDefinition, variant: &Variant) -> Option<(LabDefinition, Reference)> {
    let lab = lab.with_variant(variant).ok()?;
    let reference = Reference::numbers(&lab).ok()?;
    Some((lab, reference))
}

/// What is right whoever it is from: for submissions of which that is not known.
pub struct WithoutNumbers {
    own: Option<(Reference, ReportKit)>,
}

impl WithoutNumbers {
    /// Errors: a reference curve that cannot be drawn.
    pub fn new(lab: &LabDefinition, reference: &Reference, kit: &ReportKit) -> Result<Self, ReportError> {
        if lab.variants.is_none() {
            return Ok(Self { own: None });
        }
        let mut reference = reference.clone();
        for model in &mut reference.models {
            let of = |point: &str| SystemRef { model: model.id.clone(), operating_point: point.to_owned() };
            model.operating_points.retain(|point| !lab.is_varied(&of(&point.id)));
        }
        reference.simulations.retain(|simulation| !lab.is_simulation_varied(&simulation.id));
        let mut lab = lab.clone();
        lab.parameters.clear();
        let kit = kit.with_numbers(&lab, &reference)?;
        Ok(Self { own: Some((reference, kit)) })
    }

    pub fn reference<'a>(&'a self, whole: &'a Reference) -> &'a Reference {
        self.own.as_ref().map_or(whole, |(reference, _)| reference)
    }

    pub fn kit<'a>(&'a self, whole: &'a ReportKit) -> &'a ReportKit {
        self.own.as_ref().map_or(whole, |(_, kit)| kit)
    }
}
