use super::catalogue::{Catalogue, System};
use super::likeness::{Mended, Row, Typed};
use super::transfer_function::{capitalized, without_residue};
use crate::algebra::significant;
use crate::lab::SystemRef;
use crate::lti::TransferFunction;
use crate::model::{Mistake, MistakeKind};
use crate::source::Span;
use std::cmp::Ordering;

/// What may have gone wrong on the way to a wrong transfer function. It gives no marks and takes none.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct Diagnosis {
    /// The likeliest first; each explains the answer by itself. Empty when nothing simple does.
    pub explanations: Vec<Explanation>,
    /// How many different wrong functions were looked at.
    pub searched: usize,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Explanation {
    /// Stable: `term.sign`, `slip.digit`, or both as `term.sign+slip.digit`.
    pub code: String,
    /// One sentence to the student; formulas and numbers stand in backticks.
    pub words: String,
    /// From what is right to what was written, each by itself: `g = 9.8`, `equation 1: b*x' -> 0`, `0.4116 -> 0.4166`.
    pub changes: Vec<String>,
    /// The same without the parameter values taken: what went wrong.
    pub mistakes: Vec<String>,
    /// Where in the lab's equations it happened; empty when it happened elsewhere.
    pub places: Vec<EquationPlace>,
}

/// A part of an equation of motion.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EquationPlace {
    /// The model's id.
    pub model: String,
    /// Which of its equations, from 0.
    pub equation: usize,
    /// Bytes of the equation as printed.
    pub span: Span,
}

/// More explanations than these are no explanation.
const MOST: usize = 5;

impl Catalogue {
    /// The smallest change to the derivation that leads to `typed`; `None` when that is right, or nothing is known of `of`.
    ///
    /// Single mistakes first: up to a common factor and within rounding as typed, else within the lab's tolerance. Then one
    /// slip of a digit in an otherwise right answer, then one on top of a single mistake. What fits much worse than the
    /// best is left out; the rest is ordered by [`MistakeKind`].
    pub fn diagnose(&self, of: &SystemRef, typed: &TransferFunction) -> Option<Diagnosis> {
        let system = self.systems.iter().find(|system| system.of == *of)?;
        let clean = without_residue(typed).unwrap_or_else(|| typed.clone());
        let searched = system.wrong.len();
        if clean.num.is_zero() {
            return Some(Diagnosis { explanations: Vec::new(), searched });
        }
        let typed = Typed::new(&clean.cancelled().0);
        let wide = typed.widened(system.tolerance);
        if system.choices.iter().any(|(_, row)| wide.misfit(row).is_some()) {
            return None;
        }
        let alone = |typed: &Typed, row: &Row| typed.misfit(row).map(|misfit| (misfit, None));
        let mended = |row: &Row| typed.misfit_but_for_a_slip(row).map(|(misfit, slip)| (misfit, Some(slip)));
        let mut found = system.mistakes(&|row| alone(&typed, row));
        if found.is_empty() {
            found = system.mistakes(&|row| alone(&wide, row));
        }
        if found.is_empty() {
            found = system.right(&mended);
        }
        if found.is_empty() {
            found = system.mistakes(&mended);
        }
        Some(Diagnosis { explanations: system.explanations(found), searched })
    }
}

/// One way to explain what was typed.
struct Candidate<'a> {
    misfit: f64,
    mistake: Option<&'a Mistake>,
    slip: Option<Mended>,
    /// Which accepted parameter values.
    choice: usize,
}

/// How far off, and the slip that must be mended, if any.
type Fit = (f64, Option<Mended>);

impl System {
    /// Each mistake that fits, with the parameter values it fits best with.
    fn mistakes(&self, fit: &dyn Fn(&Row) -> Option<Fit>) -> Vec<Candidate<'_>> {
        let mut found: Vec<Candidate<'_>> = Vec::new();
        for wrong in &self.wrong {
            let fits = wrong.rows.iter().filter_map(fit);
            let Some((misfit, slip)) = fits.min_by(|a, b| a.0.total_cmp(&b.0)) else { continue };
            for (mistake, choice) in &wrong.causes {
                let candidate =
                    Candidate { misfit, mistake: Some(mistake), slip: slip.clone(), choice: *choice };
                match found.iter_mut().find(|known| known.mistake == Some(mistake)) {
                    Some(known) if candidate.fits_better_than(known) => *known = candidate,
                    Some(_) => {}
                    None => found.push(candidate),
                }
            }
        }
        found
    }

    /// The right answer with the parameter values that fit best.
    fn right(&self, fit: &dyn Fn(&Row) -> Option<Fit>) -> Vec<Candidate<'_>> {
        let mut best: Option<Candidate<'_>> = None;
        for (choice, (_, row)) in self.choices.iter().enumerate() {
            let Some((misfit, slip)) = fit(row) else { continue };
            let candidate = Candidate { misfit, mistake: None, slip, choice };
            if best.as_ref().is_none_or(|best| candidate.fits_better_than(best)) {
                best = Some(candidate);
            }
        }
        best.into_iter().collect()
    }

    fn explanations(&self, mut found: Vec<Candidate<'_>>) -> Vec<Explanation> {
        let least = found.iter().map(|one| one.misfit).fold(f64::INFINITY, f64::min);
        found.retain(|one| one.misfit <= 4.0 * least + NEAR);
        found.sort_by(|a, b| a.kind().cmp(&b.kind()).then(nearly(a.misfit, b.misfit)));
        found.iter().take(MOST).map(|one| self.explanation(one)).collect()
    }

    fn explanation(&self, one: &Candidate<'_>) -> Explanation {
        let with = self.choices.get(one.choice).map_or(&[][..], |(words, _)| words.as_slice());
        let mut mistakes = Vec::new();
        let (mut codes, mut clauses) = (Vec::new(), Vec::new());
        if let Some(mistake) = one.mistake {
            codes.push(mistake.kind.code());
            clauses.push(mistake.words.clone());
            mistakes.push(mistake.change.clone());
        }
        if let Some(slip) = &one.slip {
            let (typed, meant) = (significant(slip.typed, 15), significant(slip.meant, 15));
            codes.push(slip.code);
            clauses.push(match slip.code {
                "slip.exchanged" => format!("`{typed}` was written for `{meant}`, two digits exchanged"),
                _ => format!("`{typed}` was written for `{meant}`, one digit off"),
            });
            mistakes.push(format!("{meant} -> {typed}"));
        }
        let clauses = clauses.join(", and ");
        let words = match with {
            [] => capitalized(&clauses),
            with => format!("With {}, {clauses}", with.join(", ")),
        };
        let places = one.mistake.iter().flat_map(|mistake| &mistake.places).map(|place| EquationPlace {
            model: self.of.model.clone(),
            equation: place.equation,
            span: Span { start: place.start, end: place.end },
        });
        Explanation {
            code: codes.join("+"),
            words: format!("{words}."),
            changes: with.iter().chain(&mistakes).cloned().collect(),
            places: places.collect(),
            mistakes,
        }
    }
}

/// A sum of relative deviations that rounding to four figures explains.
const NEAR: f64 = 1e-3;

impl Candidate<'_> {
    fn kind(&self) -> Option<MistakeKind> {
        self.mistake.map(|mistake| mistake.kind)
    }

    fn fits_better_than(&self, other: &Self) -> bool {
        nearly(self.misfit, other.misfit) == Ordering::Less
    }
}

/// By size, but equal when only the last bits of `f64` differ.
fn nearly(a: f64, b: f64) -> Ordering {
    if (a - b).abs() < 1e-9 { Ordering::Equal } else { a.total_cmp(&b) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::algebra::{Polynomial, parse_decimal, to_f64};
    use crate::lab::{self, LabDefinition};
    use crate::reference::Reference;
    use std::collections::BTreeMap;
    use std::sync::LazyLock;

    static LAB: LazyLock<LabDefinition> = LazyLock::new(|| lab::load(lab::DEFAULT).unwrap());
    static CATALOGUE: LazyLock<Catalogue> =
        LazyLock::new(|| Catalogue::new(&LAB, &Reference::compute(&LAB).unwrap()));

    fn at(point: &str) -> SystemRef {
        SystemRef { model: "cart".into(), operating_point: point.into() }
    }

    fn function(num: &str, den: &str) -> TransferFunction {
        let polynomial = |text: &str| {
            Polynomial::new(text.split_whitespace().map(|c| parse_decimal(c).unwrap()).collect())
        };
        TransferFunction::new(polynomial(num), polynomial(den)).unwrap()
    }

    /// Operating point, numerator, denominator; the first explanation's code and changes, nothing when there is none.
    #[track_caller]
    fn check(rows: &[(&str, &str, &str, &str, &[&str])]) {
        for (point, num, den, code, changes) in rows {
            let found = CATALOGUE.diagnose(&at(point), &function(num, den)).unwrap();
            let list = &found.explanations;
            let first = list.first().map_or(("", &[][..]), |first| (first.code.as_str(), &first.changes[..]));
            assert_eq!(first.0, *code, "{num}/({den}) {point}: {list:#?}");
            assert_eq!(first.1, *changes, "{num}/({den}) {point}: {list:#?}");
        }
    }

    const GRAVITY: &str = "equation 2: m*g*l*sin(theta) -> -m*g*l*sin(theta)";
    const FRICTION: &str = "equation 1: b*x' -> -b*x'";

    #[test]
    fn the_touchstones() {
        check(&[
            (
                "hanging",
                "0.06 0",
                "-0.0132 -0.0024 0.4166 0.0588",
                "term.sign+slip.digit",
                &["g = 9.8", GRAVITY, "0.4116 -> 0.4166"],
            ),
            (
                "upright",
                "0.06 0",
                "0.0132 0.0024 -0.4166 -0.0588",
                "slip.digit",
                &["g = 9.8", "0.4116 -> 0.4166"],
            ),
        ]);
        let seed = CATALOGUE.diagnose(&at("hanging"), &function("0.06 0", "-0.0132 -0.0024 0.4166 0.0588"));
        assert_eq!(seed.unwrap().explanations.len(), 1);
    }

    #[test]
    fn single_mistakes_by_hand() {
        check(&[
            ("hanging", "-0.06 0", "0.0132 0.0024 -0.412 -0.0589", "term.sign", &[GRAVITY]),
            ("hanging", "-0.06 0", "0.0132 0.0024 -0.4116 -0.0588", "term.sign", &["g = 9.8", GRAVITY]),
            ("hanging", "0.06 0", "0.0132 0.0024 -0.412 -0.0589", "point.other", &["at: Balanced upright"]),
            (
                "upright",
                "-0.06 0",
                "0.0132 0.0024 0.412 0.0589",
                "point.other",
                &["at: Hanging straight down"],
            ),
            ("hanging", "0.06 0", "0.0132 0.0024 0.41202 0.05886", "function.sign", &["G -> -G"]),
            // (M + m) I − (m l)² = 0.0042 − 0.0036, and b I = 0.0006
            (
                "hanging",
                "-0.06 0",
                "0.0006 0.0006 0.41202 0.05886",
                "term.dropped",
                &["equation 2: m*l^2 -> 0"],
            ),
            ("hanging", "-0.06 0", "0.0132 -0.0024 0.412 -0.0589", "term.sign", &[FRICTION]),
            // Without friction s cancels twice.
            ("hanging", "-0.06", "0.0132 0 0.41202", "term.dropped", &["equation 1: b*x' -> 0"]),
            ("hanging", "-0.06", "0.0132 0.0024 0.41202 0.05886", "function.origin", &["G -> G/s"]),
            ("hanging", "0.0132 0.0024 0.412 0.0589", "-0.06 0", "function.inverted", &["G -> 1/G"]),
            // x is less than its second derivative by s², and keeps the pole at the origin.
            ("hanging", "0.024 0 0.5886", "0.0132 0.0024 0.41202 0.05886 0", "output.other", &["output: x"]),
            ("hanging", "-0.06 0", "0.0132 0.0042 0.412 0.0589", "slip.exchanged", &["0.0024 -> 0.0042"]),
            // sin(π + φ) as +φ comes to the same.
            ("upright", "0.06 0", "0.0132 0.0024 0.412 0.0589", "term.sign", &[GRAVITY]),
            ("hanging", "7 0", "1 2 3 4", "", &[]),
            ("hanging", "0", "1 2 3 4", "", &[]),
            ("hanging", "1", "1 1", "", &[]),
        ]);
    }

    /// Where in the equations, as printed there; and what went wrong without the parameter values taken.
    #[test]
    fn the_place_in_the_equations_is_told() {
        for (num, den, places, mistakes) in [
            ("-0.06 0", "0.0132 0.0024 -0.4116 -0.0588", &["m*g*l*sin(theta)"][..], &[GRAVITY][..]),
            ("-0.06 0", "0.0006 0.0006 0.41202 0.05886", &["m*l^2"], &["equation 2: m*l^2 -> 0"]),
            ("0.06 0", "0.0132 0.0024 0.41202 0.05886", &[], &["G -> -G"]),
        ] {
            let found = CATALOGUE.diagnose(&at("hanging"), &function(num, den)).unwrap();
            let first = &found.explanations[0];
            let shown: Vec<&str> = first
                .places
                .iter()
                .map(|place| {
                    assert_eq!(place.model, "cart");
                    &LAB.models[0].model.equations[place.equation].text[place.span.start..place.span.end]
                })
                .collect();
            assert_eq!(shown, places, "{num}/({den})");
            assert_eq!(first.mistakes, mistakes, "{num}/({den})");
        }
    }

    #[test]
    fn what_is_right_is_not_diagnosed() {
        for (num, den) in [
            ("-0.06 0", "0.0132 0.0024 0.41202 0.05886"),
            ("0.06 0", "-0.0132 -0.0024 -0.412 -0.0589"),
            ("-0.06 0", "0.0132 0.0024 0.4116 0.0588"),
            ("-0.06 0 0", "0.0132 0.0024 0.42 0.06 0"),
            ("-4.55 0", "1 0.182 31.2 4.46"),
        ] {
            assert_eq!(CATALOGUE.diagnose(&at("hanging"), &function(num, den)), None, "{num}/({den})");
        }
        let unknown = at("sideways");
        assert_eq!(CATALOGUE.diagnose(&unknown, &function("7", "1 2")), None);
        assert_eq!(Catalogue::default().diagnose(&at("hanging"), &function("7", "1 2")), None);
    }

    /// Each coefficient to four figures.
    fn rounded(function: &TransferFunction) -> TransferFunction {
        let round = |polynomial: &Polynomial| {
            let figures = polynomial.coefficients().iter().map(|c| significant(to_f64(c), 4));
            Polynomial::new(figures.map(|text| parse_decimal(&text).unwrap()).collect())
        };
        TransferFunction::new(round(&function.num), round(&function.den)).unwrap()
    }

    #[test]
    fn every_single_mistake_is_found_again() {
        let reference = Reference::compute(&LAB).unwrap();
        let parameters: BTreeMap<_, _> =
            LAB.parameters.iter().map(|p| (p.name.clone(), p.value.clone())).collect();
        let units = LAB.parameters.iter().map(|p| (p.name.clone(), p.unit.clone())).collect();
        let (definition, mut distinct) = (&LAB.models[0], 0);
        for system in &CATALOGUE.systems {
            distinct +=
                system.wrong.iter().filter(|wrong| wrong.causes.iter().any(|(_, own)| *own == 0)).count();
            let is = |id: &str| id == system.of.operating_point;
            let point = definition.operating_points.iter().find(|p| is(&p.id)).unwrap();
            let others: Vec<_> = definition.operating_points.iter().filter(|p| !is(&p.id)).collect();
            let others: Vec<_> = others.iter().map(|p| (p.title.clone(), &p.at)).collect();
            let derivation = crate::model::Derivation {
                model: &definition.model,
                parameters: &parameters,
                units: &units,
                at: &point.at,
                others: &others,
                input: &point.input,
                output: &point.output,
            };
            let right =
                &reference.operating_point(&system.of).unwrap().main().linearization.transfer_function;
            for (mistake, function) in crate::model::mistakes(&derivation) {
                let cancelled = function.cancelled().0;
                let found = CATALOGUE.diagnose(&system.of, &rounded(&cancelled));
                if cancelled.equals(right) {
                    assert_eq!(found, None, "{mistake:?}");
                    continue;
                }
                let equals: Vec<&str> = system
                    .wrong
                    .iter()
                    .filter(|wrong| wrong.causes.iter().any(|(known, _)| *known == mistake))
                    .flat_map(|wrong| wrong.causes.iter().map(|(known, _)| known.change.as_str()))
                    .collect();
                let found = found.unwrap_or_else(|| panic!("{mistake:?} is taken for right"));
                let by_equal = found
                    .explanations
                    .iter()
                    .any(|one| one.changes.len() == 1 && equals.contains(&one.changes[0].as_str()));
                assert!(by_equal, "{mistake:?} at {:?}: {:#?}", system.of, found.explanations);
            }
        }
        assert!(distinct >= 60, "{distinct}");
    }

    /// Coefficients of four figures and any sign, of the right form: chance explains few of them.
    #[test]
    fn chance_explains_little() {
        let mut state = 1u64;
        let mut next = |below: u64| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) % below
        };
        let (mut explained, tries) = (Vec::new(), 300);
        for _ in 0..tries {
            let mut number = || format!("{}{}e-4", ["", "-"][next(2) as usize], 1_000 + next(9_000));
            let num = format!("{} 0", number());
            let den = [number(), number(), number(), number()].join(" ");
            let found = CATALOGUE.diagnose(&at("hanging"), &function(&num, &den)).unwrap();
            if !found.explanations.is_empty() {
                explained.push((num, den, found.explanations));
            }
        }
        assert!(explained.len() <= tries / 100, "{explained:#?}");
    }
}
