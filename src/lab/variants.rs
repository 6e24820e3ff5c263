use super::{Check, Criterion, Curve, LabDefinition, LabErrors, SystemRef};
use crate::algebra::{Expression, Rational};
use crate::source::Span;
use crate::submission::AnsweredIn;
use sha2::{Digest, Sha256};
use std::collections::{BTreeMap, BTreeSet};
use unicode_normalization::UnicodeNormalization;

/// A lab may have this many different variants: all of them are gone through when it proves itself.
pub const MOST_VARIANTS: usize = 4096;

/// Which parameters differ from student to student, and who gets which of their values.
#[derive(Clone, Debug, PartialEq)]
pub struct VariantRule {
    pub seed: String,
    /// At least one, in file order.
    pub parameters: Vec<VariedParameter>,
}

/// A parameter that is not the same for everyone.
#[derive(Clone, Debug, PartialEq)]
pub struct VariedParameter {
    pub name: String,
    /// At least two, no two equal: each as typed, and its value.
    pub values: Vec<(String, Rational)>,
    /// Where the lab file lists them.
    pub span: Span,
}

/// One choice of a value for every varied parameter: places in their lists, in the order of the rule.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Variant(Vec<usize>);

impl Variant {
    /// Places of the parameters in which two variants of one lab differ.
    pub fn differing(&self, other: &Self) -> Vec<usize> {
        let pairs = self.0.iter().zip(&other.0).enumerate();
        pairs.filter(|(_, (one, two))| one != two).map(|(place, _)| place).collect()
    }
}

impl VariantRule {
    /// The variant of a student: a function of the seed, the parameters' names and lists, and the folded id, nothing else.
    ///
    /// The place in a list of n values is the first 8 bytes, big-endian, of SHA-256 of `seed`, a line feed, the parameter's
    /// name, a line feed and the folded id, all in UTF-8, modulo n. Other parameters play no part in it. `None` when nothing
    /// is left of the id.
    pub fn of(&self, id: &str) -> Option<Variant> {
        let id = folded_id(id);
        let place = |one: &VariedParameter| place(&self.seed, &one.name, &id, one.values.len());
        (!id.is_empty()).then(|| Variant(self.parameters.iter().map(place).collect()))
    }

    /// How many variants there are.
    pub fn count(&self) -> usize {
        self.parameters.iter().fold(1, |count: usize, one| count.saturating_mul(one.values.len()))
    }

    /// Every variant, at most [`MOST_VARIANTS`]; the last parameter changes fastest.
    pub fn all(&self) -> impl Iterator<Item = Variant> {
        (0..self.count().min(MOST_VARIANTS)).map(|number| {
            let mut rest = number;
            let mut places = vec![0; self.parameters.len()];
            for (place, one) in places.iter_mut().zip(&self.parameters).rev() {
                *place = rest % one.values.len();
                rest /= one.values.len();
            }
            Variant(places)
        })
    }

    /// (parameter, its value as typed) of a variant.
    pub fn values<'a>(&'a self, variant: &Variant) -> Vec<(&'a str, &'a str)> {
        let pairs = self.parameters.iter().zip(&variant.0);
        pairs
            .filter_map(|(one, place)| Some((one.name.as_str(), one.values.get(*place)?.0.as_str())))
            .collect()
    }

    /// `M = 0.4, l = 0.25`
    pub fn words(&self, variant: &Variant) -> String {
        let values = self.values(variant).into_iter().map(|(name, value)| format!("{name} = {value}"));
        values.collect::<Vec<_>>().join(", ")
    }
}

impl LabDefinition {
    /// The lab with a variant's values in place of its own, everything worked out anew.
    ///
    /// Errors: what these values make wrong, such as an operating point that no longer balances.
    pub fn with_variant(&self, variant: &Variant) -> Result<Self, LabErrors> {
        let values: BTreeMap<String, String> = match &self.variants {
            Some(rule) => {
                let values = rule.values(variant).into_iter();
                values.map(|(name, value)| (name.to_owned(), value.to_owned())).collect()
            }
            None => BTreeMap::new(),
        };
        Self::parse_with(self.text.clone(), &values)
    }

    /// Whether what is right for a system differs from student to student: a letter that varies stands in its equations or in
    /// what is said of its rest, or a parameter there follows from one.
    pub fn is_varied(&self, of: &SystemRef) -> bool {
        let Some(definition) = self.models.iter().find(|model| model.id == of.model) else { return false };
        let sides = definition.model.equations.iter().flat_map(|equation| [&equation.left, &equation.right]);
        let points = definition.operating_points.iter().filter(|point| point.id == of.operating_point);
        let rest =
            points.flat_map(|point| &point.at_text).filter_map(|(_, text)| Expression::parse(text).ok());
        self.vary(sides.cloned().chain(rest).flat_map(letters_of).collect())
    }

    /// Whether a simulation differs from student to student.
    pub fn is_simulation_varied(&self, id: &str) -> bool {
        let mut own = self.simulations.iter().filter(|simulation| simulation.id == id);
        own.any(|simulation| self.vary(simulation.letters.clone()))
    }

    /// Whether one of these letters differs from student to student, or follows from one that does.
    fn vary(&self, mut letters: BTreeSet<String>) -> bool {
        let Some(rule) = &self.variants else { return false };
        // A derived parameter may follow from derived ones, but from each of them once.
        for _ in 0..self.parameters.len() {
            let derived = self.parameters.iter().filter(|one| letters.contains(&one.name));
            let formulas = derived.filter_map(|one| one.formula.as_ref());
            let more: Vec<String> = formulas.flat_map(|(_, formula)| letters_of(formula.clone())).collect();
            letters.extend(more);
        }
        rule.parameters.iter().any(|one| letters.contains(&one.name))
    }

    /// Whether a transfer function is asked for in letters.
    pub fn is_asked_in_letters(&self, of: &SystemRef) -> bool {
        let mut criteria = self.questions.iter().flat_map(|question| &question.criteria);
        criteria.any(|criterion| {
            let letters = self.sheet.letters.get(&criterion.field);
            criterion.check.transfer_function() == Some(of)
                && letters.is_some_and(|field| field.answered_in == AnsweredIn::Letters)
        })
    }

    /// Whether a criterion judges by numbers that may differ from student to student.
    pub fn judges_varied(&self, criterion: &Criterion) -> bool {
        match &criterion.check {
            Check::Plot { curve: Curve::Simulation { id }, .. } => self.is_simulation_varied(id),
            check => check.system().is_some_and(|of| self.is_varied(of)),
        }
    }

    /// The variant of a student; `None` when the lab has none, or the id says nothing.
    pub fn variant_of(&self, id: &str) -> Option<Variant> {
        self.variants.as_ref()?.of(id)
    }
}

fn letters_of(formula: Expression) -> Vec<String> {
    formula.symbols().into_iter().map(|symbol| symbol.name).collect()
}

/// An answer file holds so many characters of an id.
const MOST_OF_AN_ID: usize = 100;

/// An id without what people type differently: compatibility forms made one (NFKC), lower case, letters and digits only. Of a
/// longer id the first 100 characters count, blanks before it aside.
pub fn folded_id(id: &str) -> String {
    let lower = id.trim().chars().take(MOST_OF_AN_ID).nfkc().collect::<String>().to_lowercase();
    lower.chars().filter(|letter| letter.is_alphanumeric()).collect()
}

fn place(seed: &str, name: &str, id: &str, count: usize) -> usize {
    let hash = Sha256::digest(format!("{seed}\n{name}\n{id}"));
    let first = hash.iter().take(8).fold(0_u64, |number, byte| number << 8 | u64::from(*byte));
    usize::try_from(first % (count.max(1) as u64)).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rule(seed: &str, parameters: &[(&str, &[&str])]) -> VariantRule {
        let parameters = parameters.iter().map(|(name, values)| VariedParameter {
            name: (*name).to_owned(),
            values: values
                .iter()
                .map(|text| ((*text).to_owned(), crate::algebra::parse_decimal(text).unwrap()))
                .collect(),
            span: Span { start: 0, end: 0 },
        });
        VariantRule { seed: seed.to_owned(), parameters: parameters.collect() }
    }

    /// By Python: `int.from_bytes(sha256(f"{seed}\n{name}\n{id}".encode()).digest()[:8], "big") % count`.
    #[test]
    fn another_program_finds_the_same_place() {
        for (seed, name, id, count, want) in [
            ("spring", "M", "ee001", 3, 2),
            ("spring", "M", "ee002", 3, 2),
            ("spring 2027", "l", "ünal7", 1000, 703),
            ("w", "b", "42", 7, 0),
        ] {
            assert_eq!(place(seed, name, id, count), want, "{seed} {name} {id}");
        }
    }

    #[test]
    fn another_parameter_changes_nothing_for_the_first() {
        let values: &[&str] = &["0.4", "0.5", "0.6"];
        let (one, two) =
            (rule("spring", &[("M", values)]), rule("spring", &[("b", &["1", "2"]), ("M", values)]));
        for number in 0..50 {
            let id = format!("EE-{number:03}");
            let (first, second) = (one.of(&id).unwrap(), two.of(&id).unwrap());
            assert_eq!(one.values(&first)[0], two.values(&second)[1], "{id}");
        }
        let spread: std::collections::BTreeSet<_> =
            (0..50).filter_map(|number| one.of(&format!("EE-{number:03}"))).collect();
        assert_eq!(spread.len(), 3, "every value is given to somebody");
    }

    #[test]
    fn ids_are_the_same_however_they_are_typed() {
        for (typed, folded) in [
            ("EE-001", "ee001"),
            (" ee 001 ", "ee001"),
            ("ＥＥ－００１", "ee001"),
            ("Ünal.7", "ünal7"),
            ("…", ""),
        ] {
            assert_eq!(folded_id(typed), folded, "{typed}");
        }
        let rule = rule("x", &[("M", &["1", "2"])]);
        assert_eq!(rule.of("EE-001"), rule.of("ee001"));
        assert_eq!(rule.of("--"), None);
        assert_eq!(
            folded_id(&format!(" {}", "7".repeat(300))),
            "7".repeat(100),
            "as an answer file holds it"
        );
    }

    #[test]
    fn all_variants_are_each_there_once() {
        let rule = rule("x", &[("M", &["1", "2"]), ("b", &["1", "2", "3"])]);
        let all: Vec<String> = rule.all().map(|variant| rule.words(&variant)).collect();
        assert_eq!(all.len(), rule.count());
        assert_eq!(all[..4], ["M = 1, b = 1", "M = 1, b = 2", "M = 1, b = 3", "M = 2, b = 1"]);
    }
}
