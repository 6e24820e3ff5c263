use super::catalogue::{Catalogue, System};
use super::chance::{all_of, by_chance, in_question};
use super::digits::Written;
use super::likeness::{Mended, Row, Typed};
use super::transfer_function::without_residue;
use crate::algebra::{Expression, significant};
use crate::english::capitalized;
use crate::lab::SystemRef;
use crate::lti::TransferFunction;
use crate::model::{Mistake, MistakeKind};
use crate::source::Span;
use std::cmp::{Ordering, Reverse};
use std::collections::BTreeSet;

/// What may have gone wrong on the way to a wrong transfer function. It takes no marks; the same again at a later one is spared.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct Diagnosis {
    /// The likeliest first; each explains the answer by itself. Empty when nothing simple does.
    pub explanations: Vec<Explanation>,
    /// How many different wrong functions were looked at; pairs of mistakes count when they had to be.
    pub searched: usize,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Explanation {
    /// Stable: `term.sign`, `slip.digit`, or two as `term.sign+slip.digit`.
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

/// As likely as this to agree by chance, two things at once are no explanation.
const CHANCE: f64 = 0.01;

/// More pairs than these are not followed exactly for one answer.
const MOST_FOLLOWED: usize = 24;

impl Catalogue {
    /// [`diagnose_as_typed`](Self::diagnose_as_typed) with every number taken to have as few digits as it can have.
    pub fn diagnose(&self, of: &SystemRef, typed: &TransferFunction) -> Option<Diagnosis> {
        self.diagnosed(of, typed, &Written::default())
    }

    /// The smallest change to the derivation that leads to `typed`; `None` when that is right, or nothing is known of `of`.
    ///
    /// `text` is what was typed, and `formula` what it was read as when it was a formula. Single mistakes first: up to a common
    /// factor and within rounding as typed (in letters nothing is rounded), else within the lab's tolerance; the right one
    /// rounded too coarsely. Then one slip of a digit in an otherwise right answer, one on top of a single mistake, a single
    /// mistake rounded too coarsely, and two mistakes. What fits much worse than the best is left out; the likeliest is first.
    pub fn diagnose_as_typed(
        &self,
        of: &SystemRef,
        typed: &TransferFunction,
        text: &str,
        formula: Option<&Expression>,
    ) -> Option<Diagnosis> {
        self.diagnosed(of, typed, &Written::new(text, formula))
    }

    fn diagnosed(&self, of: &SystemRef, typed: &TransferFunction, written: &Written) -> Option<Diagnosis> {
        let system = self.systems.iter().find(|system| system.of == *of)?;
        let clean = without_residue(typed).unwrap_or_else(|| typed.clone());
        let mut searched = system.wrong.len();
        let Some(typed) = Typed::new(&clean.cancelled().0, written) else {
            return Some(Diagnosis { explanations: Vec::new(), searched });
        };
        let wide = typed.widened(system.tolerance);
        if system.choices.iter().any(|(_, row)| wide.misfit(row).is_some()) {
            return None;
        }
        let alone = |typed: &Typed, row: &Row| typed.misfit(row).map(|misfit| (misfit, After::Nothing));
        let mended = |row: &Row| {
            let fit = typed.misfit_but_for_a_slip(row);
            fit.filter(|(_, slip)| system.weight_of(slip.code) > 0)
                .map(|(misfit, slip)| (misfit, After::Slip(slip)))
        };
        let coarse = typed.coarse();
        let rounded = |row: &Row| {
            let misfit = coarse.misfit(row).filter(|_| system.weight_of(COARSE) > 0)?;
            let off = coarse.rounded(row, system.tolerance);
            let farthest = off.iter().map(|(typed, meant)| (typed / meant - 1.0).abs()).fold(0.0, f64::max);
            (farthest <= FARTHEST_ROUNDED).then_some((misfit, After::Rounded(off)))
        };
        let mut found = system.mistakes(&|row| alone(&typed, row));
        if !written.is_exact() {
            found.extend(system.rounded(system.right(&rounded), &coarse));
            if found.is_empty() {
                found = system.mistakes(&|row| alone(&wide, row));
            }
            if found.is_empty() {
                found = system.right(&mended);
            }
            // A mistake that only moves the coefficient that is off, mended there by a digit, would explain anything.
            if found.is_empty() && !system.is_one_off(&wide) {
                found = system.mistakes(&mended);
            }
            if found.is_empty() {
                found = system.rounded(system.mistakes(&rounded), &coarse);
            }
        }
        if found.is_empty() && system.may_be_two(&clean) {
            searched += system.pairs().functions;
            found = system.two_mistakes(&typed);
        }
        Some(Diagnosis { explanations: system.explanations(found), searched })
    }
}

const COARSE: &str = "rounding.coarse";

/// What is farther off was not rounded: 2 for 1.5 is a third.
const FARTHEST_ROUNDED: f64 = 0.34;

/// One way to explain what was typed.
#[derive(Clone)]
struct Candidate {
    misfit: f64,
    /// None, one or two, by their places in the catalogue.
    mistakes: Vec<usize>,
    after: After,
    /// Which accepted parameter values.
    choice: usize,
}

/// What happened when the function was written down.
#[derive(Clone)]
enum After {
    Nothing,
    Slip(Mended),
    /// Coefficients outside the tolerance, each as typed and as meant.
    Rounded(Vec<(f64, f64)>),
}

/// How far off, and what happened afterwards.
type Fit = (f64, After);

impl System {
    fn weight_of(&self, code: &str) -> u32 {
        self.afterwards.get(code).copied().unwrap_or(0)
    }

    /// Whether all coefficients but one agree with the right answer.
    fn is_one_off(&self, typed: &Typed) -> bool {
        let right = self.choices.iter().map(|(_, row)| row);
        in_question(right, typed).iter().any(|places| places.count_ones() == 1)
    }

    /// Each mistake that fits, with the parameter values it fits best with.
    fn mistakes(&self, fit: &dyn Fn(&Row) -> Option<Fit>) -> Vec<Candidate> {
        let mut found: Vec<Candidate> = Vec::new();
        for wrong in &self.wrong {
            let fits = wrong.rows.iter().filter_map(fit);
            let Some((misfit, after)) = fits.min_by(|a, b| a.0.total_cmp(&b.0)) else { continue };
            for (mistake, choice) in &wrong.causes {
                let candidate =
                    Candidate { misfit, mistakes: vec![*mistake], after: after.clone(), choice: *choice };
                keep_best(&mut found, candidate);
            }
        }
        found
    }

    /// The right answer with the parameter values that fit best.
    fn right(&self, fit: &dyn Fn(&Row) -> Option<Fit>) -> Vec<Candidate> {
        let mut found = Vec::new();
        for (choice, (_, row)) in self.choices.iter().enumerate() {
            if let Some((misfit, after)) = fit(row) {
                keep_best(&mut found, Candidate { misfit, mistakes: Vec::new(), after, choice });
            }
        }
        found
    }

    /// Nothing when numbers of so few figures agree with this or that anyway.
    fn rounded(&self, found: Vec<Candidate>, typed: &Typed) -> Vec<Candidate> {
        let alike = |row: &&Row| row.form == typed.form;
        let functions = match found.first() {
            Some(one) if !one.mistakes.is_empty() => {
                self.wrong.iter().flat_map(|wrong| &wrong.rows).filter(alike).count()
            }
            _ => self.choices.len(),
        };
        let tells = found.len() <= MOST && by_chance(functions, typed, all_of(typed)) <= CHANCE;
        if tells { found } else { Vec::new() }
    }

    /// Two mistakes at once, where that cannot well be chance.
    fn two_mistakes(&self, typed: &Typed) -> Vec<Candidate> {
        let mut hits = self.pairs().like(typed);
        let simpler = self.choices.iter().map(|(_, row)| row);
        let simpler = simpler.chain(self.wrong.iter().flat_map(|wrong| &wrong.rows));
        if !hits.is_empty() {
            let questions = in_question(simpler, typed);
            // Others that are less likely would not have been believed.
            hits.retain(|hit| {
                let rivals = |open| self.pairs().agreeing(typed, open, hit.weight);
                questions.iter().all(|open| by_chance(rivals(*open), typed, *open) <= CHANCE)
            });
        }
        let least = hits.iter().map(|hit| hit.misfit).fold(f64::INFINITY, f64::min);
        hits.retain(|hit| is_near(hit.misfit, least));
        let mut ways: Vec<Candidate> = hits
            .iter()
            .flat_map(|hit| hit.pairs.iter().map(move |pair| (hit.misfit, pair)))
            .map(|(misfit, pair)| Candidate {
                misfit,
                mistakes: vec![pair.first, pair.second],
                after: After::Nothing,
                choice: pair.choice,
            })
            .collect();
        ways.sort_by(|a, b| self.likelier(a, b));
        let mut found: Vec<Candidate> = Vec::new();
        for way in ways.into_iter().take(MOST_FOLLOWED) {
            let exact = self.exactly(&way.mistakes, way.choice);
            let misfits = exact.iter().filter_map(|row| typed.misfit(row));
            if let Some(misfit) = misfits.min_by(f64::total_cmp) {
                keep_best(&mut found, Candidate { misfit, ..way });
            }
        }
        // So many different ways are none.
        let different: BTreeSet<_> = found.iter().map(|one| one.misfit.to_bits() >> 20).collect();
        if different.len() > MOST { Vec::new() } else { found }
    }

    fn explanations(&self, mut found: Vec<Candidate>) -> Vec<Explanation> {
        let least = found.iter().map(|one| one.misfit).fold(f64::INFINITY, f64::min);
        found.retain(|one| is_near(one.misfit, least));
        found.sort_by(|a, b| self.likelier(a, b));
        found.iter().take(MOST).map(|one| self.explanation(one)).collect()
    }

    /// The likelier first: by the product of the weights, then by kind, how well it fits, and how little of the equations it
    /// changes.
    fn likelier(&self, a: &Candidate, b: &Candidate) -> Ordering {
        let kinds = |one: &Candidate| -> Vec<MistakeKind> {
            one.mistakes.iter().filter_map(|place| Some(self.mistake(*place)?.kind)).collect()
        };
        let rank = |one: &Candidate| (Reverse(self.weight(one)), kinds(one));
        let places = |one: &Candidate| -> usize {
            let all = one.mistakes.iter().filter_map(|place| self.mistake(*place));
            all.flat_map(|mistake| &mistake.places).map(|place| place.end - place.start).sum()
        };
        let order = rank(a).cmp(&rank(b)).then(nearly(a.misfit, b.misfit));
        let order = order.then_with(|| places(a).cmp(&places(b)));
        order.then_with(|| (&a.mistakes, a.choice).cmp(&(&b.mistakes, b.choice)))
    }

    fn weight(&self, one: &Candidate) -> u64 {
        let mistakes = one.mistakes.iter().filter_map(|place| self.weights.get(*place));
        let after = match &one.after {
            After::Nothing => 1,
            After::Slip(slip) => self.weight_of(slip.code),
            After::Rounded(_) => self.weight_of(COARSE),
        };
        mistakes.fold(u64::from(after), |product, weight| product.saturating_mul(u64::from(*weight)))
    }

    fn explanation(&self, one: &Candidate) -> Explanation {
        let with = self.choices.get(one.choice).map_or(&[][..], |(words, _)| words.as_slice());
        let done: Vec<&Mistake> = one.mistakes.iter().filter_map(|place| self.mistake(*place)).collect();
        let mut codes: Vec<&str> = done.iter().map(|mistake| mistake.kind.code()).collect();
        let mut clauses: Vec<String> = done.iter().map(|mistake| mistake.words.clone()).collect();
        let mut mistakes: Vec<String> = done.iter().map(|mistake| mistake.change.clone()).collect();
        match &one.after {
            After::Nothing => {}
            After::Slip(slip) => {
                let (typed, meant) = (significant(slip.typed, 15), significant(slip.meant, 15));
                codes.push(slip.code);
                clauses.push(match slip.code {
                    "slip.exchanged" => format!("`{typed}` was written for `{meant}`, two digits exchanged"),
                    _ => format!("`{typed}` was written for `{meant}`, one digit off"),
                });
                mistakes.push(format!("{meant} -> {typed}"));
            }
            After::Rounded(coefficients) => {
                let pairs: Vec<(String, String)> = coefficients
                    .iter()
                    .map(|(typed, meant)| (significant(typed.abs(), 15), significant(meant.abs(), 5)))
                    .collect();
                let list: Vec<String> =
                    pairs.iter().map(|(typed, meant)| format!("`{meant}` to `{typed}`")).collect();
                codes.push(COARSE);
                clauses.push(format!("the coefficients are rounded too coarsely ({})", list.join(", ")));
                mistakes.extend(pairs.iter().map(|(typed, meant)| format!("{meant} -> {typed}")));
            }
        }
        let clauses = clauses.join(", and ");
        let words = match with {
            [] => capitalized(&clauses),
            with => format!("With {}, {clauses}", with.join(", ")),
        };
        let places = done.iter().flat_map(|mistake| &mistake.places).map(|place| EquationPlace {
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

/// The same mistakes with other parameter values are the same explanation: the one that fits best is kept.
fn keep_best(found: &mut Vec<Candidate>, candidate: Candidate) {
    match found.iter_mut().find(|known| known.mistakes == candidate.mistakes) {
        Some(known) if nearly(candidate.misfit, known.misfit) == Ordering::Less => *known = candidate,
        Some(_) => {}
        None => found.push(candidate),
    }
}

/// A sum of relative deviations that rounding to four figures explains.
const NEAR: f64 = 1e-3;

/// What is left of a sum of relative deviations between equal functions.
const EXACT: f64 = 1e-8;

/// Not much farther off than the least; where that is exact, nothing else is near.
fn is_near(misfit: f64, least: f64) -> bool {
    misfit <= if least < EXACT { EXACT } else { 4.0 * least + NEAR }
}

/// By size, but equal when only the last bits differ.
fn nearly(a: f64, b: f64) -> Ordering {
    if (a - b).abs() < 1e-9 { Ordering::Equal } else { a.total_cmp(&b) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::algebra::{Polynomial, parse_decimal, to_f64};
    use crate::lab::{self, LabDefinition};
    use crate::reference::Reference;
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

    /// In letters: text, and the first explanation's code.
    #[test]
    fn letters_are_followed_exactly() {
        let symbols = LAB.parameters.iter().map(|p| (p.name.clone(), p.value.clone())).collect();
        for (text, code) in [
            // gravity's sign
            ("-m*l*s/(((M+m)*(I+m*l^2)-m^2*l^2)*s^3+b*(I+m*l^2)*s^2-(M+m)*m*g*l*s-b*m*g*l)", "term.sign"),
            // m·l² left out, and l for l²
            ("-m*l*s/(((M+m)*I-m^2*l^2)*s^3+b*I*s^2+(M+m)*m*g*l*s+b*m*g*l)", "term.dropped"),
            ("-m*l*s/(((M+m)*(I+m*l)-m^2*l^2)*s^3+b*(I+m*l)*s^2+(M+m)*m*g*l*s+b*m*g*l)", "factor.power"),
            // gravity's sign, and no friction
            ("-m*l/(((M+m)*(I+m*l^2)-m^2*l^2)*s^2-(M+m)*m*g*l)", "term.dropped+term.sign"),
            // m²l² left out, as without the coupling in equation 1
            ("-m*l*s/((M+m)*(I+m*l^2)*s^3+b*(I+m*l^2)*s^2+(M+m)*m*g*l*s+b*m*g*l)", "term.dropped"),
            // within rounding of what is right with g = 9.80665 but for a sign, and yet not it
            ("-m*l*s/(((M+m)*(I+m*l^2)-m^2*l^2)*s^3+b*(I+m*l^2)*s^2-(M+m)*m*g*l*s-b*(m*g*l+m^12))", ""),
        ] {
            let formula = Expression::parse_typed(text).unwrap();
            let (num, den) = formula.rational_function("s", &symbols).unwrap();
            let typed = TransferFunction::new(num, den).unwrap();
            let found = CATALOGUE.diagnose_as_typed(&at("hanging"), &typed, text, Some(&formula)).unwrap();
            let first = found.explanations.first().map_or("", |first| first.code.as_str());
            assert_eq!(first, code, "{text}: {:#?}", found.explanations);
        }
    }

    #[test]
    fn two_mistakes_and_coarse_rounding_by_hand() {
        check(&[
            (
                "hanging",
                "-0.06 0",
                "0.0006 0.0006 -0.412 -0.0589",
                "term.dropped+term.sign",
                &["equation 2: m*l^2 -> 0", GRAVITY],
            ),
            (
                "hanging",
                "-0.06 0",
                "0.0132 -0.0024 -0.412 0.0589",
                "term.sign+term.sign",
                &[FRICTION, GRAVITY],
            ),
            ("hanging", "-0.06 0", "0.013 0.0024 0.41 0.059", "rounding.coarse", &["0.0132 -> 0.013"]),
            (
                "hanging",
                "-0.06 0",
                "0.013 0.0024 -0.41 -0.059",
                "term.sign+rounding.coarse",
                &[GRAVITY, "0.0132 -> 0.013"],
            ),
            ("hanging", "-3.438 0", "0.0132 0.0024 0.412 0.0589", "units.degrees", &["theta in degrees"]),
            (
                "hanging",
                "-0.06",
                "0.0132 0.0024 0.412",
                "function.cancelled",
                &["s cancelled, and a constant lost"],
            ),
            ("hanging", "-0.06 0", "0.051 0.0078 0.412 0.0589", "parameter.scaled", &["I -> 10*I"]),
            ("hanging", "-0.06 0", "0.0258 0.0042 0.412 0.0589", "parameter.mistaken", &["I -> 0.024"]),
        ]);
    }

    /// A single coefficient that is off is explained by itself, or not at all: a mistake that moves only that one, mended by
    /// a digit there, would explain anything.
    #[test]
    fn a_single_coefficient_that_is_off_is_no_two_things_at_once() {
        let question = "questions:
  function:
    number: Question 0
    title: X(s)/F(s)
    points: 1
    about: spring.rest
    answer: {kind: transfer_function, prompt: X(s)/F(s)}
    criteria: {denominator: {title: Denominator, points: 1, check: denominator}}
    model_answer: 1/(2s^2 + 12s + 50)
";
        let lab = include_str!("../../tests/it/oscillator.yaml").replacen("questions:\n", question, 1);
        let lab = lab.replace("total: 15", "total: 16").replace("points: 15", "points: 16");
        let lab = LabDefinition::parse(crate::source::SourceText::new("oscillator.yaml", &lab)).unwrap();
        let catalogue = Catalogue::new(&lab, &Reference::compute(&lab).unwrap());
        let of = SystemRef { model: "spring".into(), operating_point: "rest".into() };
        for (text, codes) in [
            ("1 / 2 8 50", &[][..]),
            ("1 / 2 12 58", &["slip.digit"]),
            ("1 / 2 21 50", &["slip.exchanged"]),
            // The denominator was divided by 2, the numerator was not: that is no rounding of 0.5.
            ("1 / 1 6 25", &[]),
        ] {
            let (num, den) = text.split_once('/').unwrap();
            let found = catalogue.diagnose_as_typed(&of, &function(num, den), text, None).unwrap();
            let found: Vec<_> = found.explanations.iter().map(|one| one.code.as_str()).collect();
            assert_eq!(found, codes, "{text}");
        }
    }

    /// A lab may say what is likelier, and leave mistakes out.
    #[test]
    fn a_lab_weighs_mistakes() {
        let text = lab::embedded()[0].1;
        let weighed = |weights: &str| {
            let text = text.replacen("mistakes:\n", &format!("mistakes:\n  weights: {{{weights}}}\n"), 1);
            let lab = LabDefinition::parse(crate::source::SourceText::new("lab.yaml", text)).unwrap();
            let catalogue = Catalogue::new(&lab, &Reference::compute(&lab).unwrap());
            // sin(π + φ) as +φ is the term with its sign turned.
            let found = catalogue.diagnose(&at("upright"), &function("0.06 0", "0.0132 0.0024 0.412 0.0589"));
            found.unwrap().explanations.into_iter().map(|one| one.code).collect::<Vec<_>>()
        };
        assert_eq!(weighed("term.sign: 32"), ["term.sign", "point.sign", "point.sign"]);
        assert_eq!(weighed("term.sign: 20"), ["point.sign", "point.sign", "term.sign"]);
        assert_eq!(weighed("point.sign: 0"), ["term.sign"]);
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

    /// Each system with the derivation of its transfer function by the lab's own values.
    fn derivations() -> Vec<(&'static System, crate::model::Derivation)> {
        let definition = &LAB.models[0];
        let point = |system: &System| {
            let mut points = definition.operating_points.iter();
            points.find(|point| point.id == system.of.operating_point).unwrap()
        };
        let with = |system| definition.derivation(point(system), &LAB.parameters);
        CATALOGUE.systems.iter().map(|system| (system, with(system))).collect()
    }

    /// Whether an explanation, followed exactly, leads to `function`.
    fn leads_to(
        one: &Explanation,
        derivation: &crate::model::Derivation,
        mistakes: &[Mistake],
        function: &TransferFunction,
    ) -> bool {
        let named = |change: &String| mistakes.iter().find(|mistake| mistake.change == *change);
        let made: Option<Vec<&Mistake>> = one.changes.iter().map(named).collect();
        made.and_then(|made| derivation.function(&made)).is_some_and(|found| found.equals(function))
    }

    #[test]
    fn every_single_mistake_is_found_again() {
        let mut distinct = 0;
        for (system, derivation) in derivations() {
            let mistakes = derivation.mistakes();
            let right = derivation.function(&[]).unwrap();
            let mut known: Vec<TransferFunction> = Vec::new();
            for mistake in &mistakes {
                let Some(function) = derivation.function(&[mistake]) else { continue };
                let function = function.cancelled().0;
                let found = CATALOGUE.diagnose(&system.of, &rounded(&function));
                if function.equals(&right) {
                    assert_eq!(found, None, "{mistake:?}");
                    continue;
                }
                if !known.iter().any(|other| other.equals(&function)) {
                    known.push(function.clone());
                }
                let found = found.unwrap_or_else(|| panic!("{mistake:?} is taken for right"));
                assert!(
                    found.explanations.iter().any(|one| leads_to(one, &derivation, &mistakes, &function)),
                    "{mistake:?} at {:?}: {:#?}",
                    system.of,
                    found.explanations
                );
            }
            distinct += known.len();
        }
        assert!(distinct >= 120, "{distinct}");
    }

    /// Pairs picked by a fixed generator.
    #[test]
    fn nine_of_ten_pairs_of_mistakes_are_found_again() {
        let mut next = generator(7);
        let (mut tried, mut missed) = (0, Vec::new());
        for (system, derivation) in derivations() {
            let mistakes = derivation.mistakes();
            let right = derivation.function(&[]).unwrap();
            for _ in 0..150 {
                let (a, b) = (next(mistakes.len() as u64), next(mistakes.len() as u64));
                let pair = [&mistakes[a as usize], &mistakes[b as usize]];
                let Some(function) = (a != b).then(|| derivation.function(&pair)).flatten() else { continue };
                let function = function.cancelled().0;
                if function.equals(&right) {
                    continue;
                }
                // Not told from what is right: not wrong.
                let Some(found) = CATALOGUE.diagnose(&system.of, &rounded(&function)) else { continue };
                tried += 1;
                if !found.explanations.iter().any(|one| leads_to(one, &derivation, &mistakes, &function)) {
                    let found = found.explanations.into_iter().map(|one| one.changes.join("; "));
                    missed.push((pair.map(|one| one.change.clone()), found.collect::<Vec<_>>()));
                }
            }
        }
        assert!(tried > 200, "{tried}");
        assert!(10 * missed.len() <= tried, "{} of {tried}: {missed:#?}", missed.len());
    }

    /// The same numbers each time.
    fn generator(seed: u64) -> impl FnMut(u64) -> u64 {
        let mut state = seed;
        move |below| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) % below
        }
    }

    /// Random coefficients of the right form in place of some of the right ones (a bit each): how many of the answers, in a
    /// thousand, are explained at all, and how many by two mistakes.
    fn explained_by_chance(figures: u32, replaced: u32, tries: u64) -> (usize, usize) {
        let mut next = generator(1);
        let least = 10u64.pow(figures - 1);
        let right = ["-0.06", "0.0132", "0.0024", "0.41202", "0.05886"];
        let (mut explained, mut by_two) = (0, 0);
        for _ in 0..tries {
            let mut one = |place: usize| {
                let size = -(figures as i64) - [1, 1, 2, 0, 1][place] as i64;
                let drawn = format!("{}{}e{size}", ["", "-"][next(2) as usize], least + next(9 * least));
                if replaced & (1 << place) != 0 { drawn } else { right[place].to_owned() }
            };
            let num = format!("{} 0", one(0));
            let den = [one(1), one(2), one(3), one(4)].join(" ");
            let Some(found) = CATALOGUE.diagnose(&at("hanging"), &function(&num, &den)) else { continue };
            explained += usize::from(!found.explanations.is_empty());
            let two = |one: &Explanation| {
                !one.code.contains("slip") && !one.code.contains("rounding") && one.mistakes.len() == 2
            };
            by_two += usize::from(found.explanations.iter().any(two));
        }
        let in_a_thousand = |count: usize| count * 1000 / tries as usize;
        (in_a_thousand(explained), in_a_thousand(by_two))
    }

    /// Coefficients of any figures and sign, all of them or some: chance explains few, and hardly any by two mistakes.
    #[test]
    fn chance_explains_little() {
        for (what, figures, replaced, explained, by_two) in [
            // at most, in a thousand: explained at all, and by two mistakes; the rest are slips of a digit
            ("all, four figures", 4, 0b11111, 3, 0),
            ("all, three figures", 3, 0b11111, 3, 0),
            ("all, two figures", 2, 0b11111, 3, 0),
            ("two, four figures", 4, 0b01010, 3, 3),
            ("two, three figures", 3, 0b10100, 3, 3),
            ("one, four figures", 4, 0b00010, 30, 5),
            ("one, three figures", 3, 0b01000, 30, 5),
            ("one, two figures", 2, 0b00100, 80, 5),
        ] {
            let found = explained_by_chance(figures, replaced, 400);
            assert!(found.0 <= explained && found.1 <= by_two, "{what}: {found:?}");
        }
    }
}
