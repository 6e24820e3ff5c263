use super::parameters::Parameters;
use super::{Checker, Names, Unresponsive, span};
use crate::algebra::{Expression, ExpressionError, Rational};
use crate::lab::file::{ModelFile, Spanned, Text};
use crate::lab::linear_file::{
    LinearFile, QuotientFile, StateSpaceFile, TransferFunctionFile, ZerosPolesGainFile,
};
use crate::lab::{Check, FeatureKind, ModelDefinition};
use crate::model::{Coordinate, DerivedParameters, LinearForm, Model, Root, linearize};
use std::collections::BTreeMap;

type Rows = Vec<Vec<Expression>>;

/// The highest order of a linear model.
const MOST_ORDER: usize = 60;
/// Nodes from the top of an entry to its deepest leaf.
const MOST_HIGH: usize = 40;

impl Checker<'_> {
    /// How a linear model is given; `None` for one given by equations, and, with a finding, for a wrong one.
    pub(super) fn linear_form(&mut self, model: &ModelFile, letters: &[&str]) -> Option<LinearForm> {
        let linear = model.linear.as_ref()?;
        if model.operating_points.value.0.is_empty() {
            let message = "with several inputs or outputs it must be said which are meant";
            let help = "add `channels: {id: {title, input, output}}`".to_owned();
            self.error("lab.model", span(linear), message, Some(help));
        }
        match &linear.value {
            LinearFile::TransferFunction(file) => match &file.value {
                TransferFunctionFile::Formula(formula) => {
                    let text = Spanned { value: formula.clone(), defined: file.defined };
                    self.formula_of_s(&text, letters)
                }
                TransferFunctionFile::Quotient(quotient) => self.quotient(quotient, letters),
            },
            LinearFile::Zpk(file) => self.zeros_poles_gain(file, linear, letters),
            LinearFile::StateSpace(file) => {
                let form = self.state_space(file, model, letters);
                form.map(|[a, b, c, d]| LinearForm::StateSpace { a, b, c, d })
            }
        }
    }

    fn formula_of_s(&mut self, text: &Text, letters: &[&str]) -> Option<LinearForm> {
        let mut known = letters.to_vec();
        known.push("s");
        let formula = self.entry(text, &known)?;
        match LinearForm::of_formula(formula) {
            Ok(form) => Some(form),
            Err(error) => {
                self.expression_error("lab.model", text, error);
                None
            }
        }
    }

    fn quotient(&mut self, file: &QuotientFile, letters: &[&str]) -> Option<LinearForm> {
        let mut side = |list: &Spanned<Vec<Text>>| {
            let found: Vec<_> = list.value.iter().map(|text| self.entry(text, letters)).collect();
            if list.value.len() > MOST_ORDER + 1 {
                let message = format!("{MOST_ORDER} is the highest order that polemark takes");
                self.error("lab.model", span(list), message, None);
                return None;
            }
            let mut found = found.into_iter().collect::<Option<Vec<_>>>()?;
            let zeros = found.iter().take_while(|e| is_zero(e)).count();
            found.drain(..zeros);
            if found.is_empty() {
                self.error("lab.model", span(list), "this is zero", None);
            }
            (!found.is_empty()).then_some(found)
        };
        let (num, den) = (side(&file.num), side(&file.den));
        Some(LinearForm::TransferFunction { num: num?, den: den?, formula: None })
    }

    fn zeros_poles_gain(
        &mut self,
        file: &ZerosPolesGainFile,
        linear: &Spanned<LinearFile>,
        letters: &[&str],
    ) -> Option<LinearForm> {
        let mut roots = |list: &[Text]| {
            let roots: Vec<_> = list.iter().map(|text| self.root(text, letters)).collect();
            roots.into_iter().collect::<Option<Vec<_>>>()
        };
        let (zeros, poles) = (roots(&file.zeros), roots(&file.poles));
        let gain = match &file.gain {
            Some(text) => {
                let gain = self.entry(text, letters)?;
                if is_zero(&gain) {
                    self.error("lab.model", span(text), "a gain of 0 leaves nothing", None);
                    return None;
                }
                gain
            }
            None => Expression::of_number(Rational::ONE),
        };
        match LinearForm::of_roots(zeros?, poles?, gain) {
            Ok(form) => Some(form),
            Err(error) => {
                self.error("lab.model", span(linear), error.message, error.help);
                None
            }
        }
    }

    /// `-3`, `-1 ± 2j`, `-1 ± sqrt(2)`
    fn root(&mut self, text: &Text, letters: &[&str]) -> Option<Root> {
        let sign = ["±", "+/-", "+-"].into_iter().find_map(|sign| Some((text.value.find(sign)?, sign.len())));
        let part = |from: usize, to: usize, checker: &mut Self| {
            let inner = text.value.get(from..to).unwrap_or_default();
            match Expression::parse(inner).and_then(|e| e.check_names(letters).map(|()| e)) {
                Ok(e) => Some(e),
                Err(error) => {
                    let error = ExpressionError { start: error.start + from, end: error.end + from, ..error };
                    checker.expression_error("lab.model", text, error);
                    None
                }
            }
        };
        let end = text.value.len();
        let Some((at, width)) = sign else {
            if imaginary(&text.value, 0, end, letters).is_some() {
                let message = "a complex zero or pole comes with its conjugate";
                self.error("lab.model", span(text), message, Some("write `-1 ± 2j`".to_owned()));
                return None;
            }
            return part(0, end, self).map(Root::Real);
        };
        let middle = match text.value[..at].trim() {
            "" => Some(Expression::of_number(Rational::ZERO)),
            _ => part(0, at, self),
        };
        let from = at + width;
        match imaginary(&text.value, from, end, letters) {
            Some((_, to)) if text.value[from..to].trim().is_empty() => {
                let im = Expression::of_number(Rational::ONE);
                Some(Root::Conjugate { re: middle?, im })
            }
            Some((from, to)) => {
                let im = part(from, to, self);
                Some(Root::Conjugate { re: middle?, im: im? })
            }
            None => {
                let by = part(from, end, self);
                Some(Root::Pair { middle: middle?, by: by? })
            }
        }
    }

    fn state_space(
        &mut self,
        file: &StateSpaceFile,
        model: &ModelFile,
        letters: &[&str],
    ) -> Option<[Rows; 4]> {
        let (inputs, outputs) = (model.inputs.value.0.len(), file.C.value.len());
        let n = file.A.value.len();
        if n > MOST_ORDER {
            let message = format!("{MOST_ORDER} is the highest order that polemark takes");
            self.error("lab.model", span(&file.A), message, None);
            return None;
        }
        let coordinates = model.coordinates.value.0.len();
        if coordinates != n + outputs {
            let message = format!(
                "{n} rows of `A` and {outputs} of `C`, but the states and outputs named are {coordinates}"
            );
            self.error("lab.model", span(&file.C), message, None);
            return None;
        }
        let a =
            self.matrix("A", &file.A, (n, "a row for each state"), (n, "a column for each state"), letters);
        let input = (inputs, "a column for each input");
        let b = self.matrix("B", &file.B, (n, "a row for each state"), input, letters);
        let c = self.matrix(
            "C",
            &file.C,
            (outputs, "a row for each output"),
            (n, "a column for each state"),
            letters,
        );
        let d = match &file.D {
            Some(d) => self.matrix("D", d, (outputs, "a row for each output"), input, letters),
            None => Some(vec![vec![Expression::of_number(Rational::ZERO); inputs]; outputs]),
        };
        Some([a?, b?, c?, d?])
    }

    fn matrix(
        &mut self,
        name: &str,
        rows: &Spanned<Vec<Vec<Text>>>,
        (height, for_rows): (usize, &str),
        (width, for_columns): (usize, &str),
        letters: &[&str],
    ) -> Option<Rows> {
        let place = |row: Option<&Vec<Text>>| row.and_then(|row| row.first()).map_or(span(rows), span);
        if rows.value.len() != height {
            let message = format!("`{name}` has {} rows, but needs {height}: {for_rows}", rows.value.len());
            self.error("lab.model", place(rows.value.last()), message, None);
            return None;
        }
        let mut found = Some(Vec::new());
        for (i, row) in rows.value.iter().enumerate() {
            if row.len() != width {
                let message = format!(
                    "row {} of `{name}` has {} entries, but needs {width}: {for_columns}",
                    i + 1,
                    row.len()
                );
                self.error("lab.model", place(Some(row)), message, None);
                found = None;
                continue;
            }
            let entries: Vec<_> = row.iter().map(|text| self.entry(text, letters)).collect();
            match (entries.into_iter().collect::<Option<Vec<_>>>(), &mut found) {
                (Some(row), Some(found)) => found.push(row),
                _ => found = None,
            }
        }
        found
    }

    /// A number or a formula of `known` names.
    fn entry(&mut self, text: &Text, known: &[&str]) -> Option<Expression> {
        let read = Expression::parse(&text.value).and_then(|e| e.check_names(known).map(|()| e));
        let error = match read {
            Ok(e) if known.contains(&"s") || e.height() <= MOST_HIGH => return Some(e),
            Ok(_) => {
                self.error("lab.model", span(text), "this formula is too deep", None);
                return None;
            }
            Err(error) => error,
        };
        self.expression_error("lab.model", text, error);
        None
    }
}

/// The model of a linear form whose parts are right.
pub(super) fn linear_model(
    linear: &LinearForm,
    file: &ModelFile,
    letters: &[&str],
    derived: DerivedParameters,
) -> Model {
    let coordinates: Vec<Coordinate> = file
        .coordinates
        .value
        .0
        .iter()
        .map(|(name, quantity)| Coordinate {
            name: name.value.clone(),
            unit: quantity.unit.clone(),
            description: quantity.description.trim().to_owned(),
        })
        .collect();
    let inputs: Vec<String> = file.inputs.value.0.iter().map(|(name, _)| name.value.clone()).collect();
    let names: Vec<String> = coordinates.iter().map(|coordinate| coordinate.name.clone()).collect();
    let equations = linear.equations(&inputs, &names);
    let parameters = letters.iter().map(|&name| name.to_owned()).collect();
    let outputs = names[names.len().saturating_sub(linear.output_count())..].to_vec();
    Model { coordinates, inputs, parameters, derived, equations, outputs }
}

/// The systems that have no responses: static functions, and improper transfer functions.
pub(super) fn unresponsive(
    models: &[ModelDefinition],
    parameters: &Parameters,
) -> Vec<(String, Unresponsive)> {
    let values: BTreeMap<_, _> = parameters.list.iter().map(|p| (p.name.clone(), p.value.clone())).collect();
    let mut found = Vec::new();
    for model in models {
        for point in &model.operating_points {
            let path = format!("{}.{}", model.id, point.id);
            if model.model.is_static() {
                found.push((path, Unresponsive::Static));
            } else if model.linear.is_some()
                && let Ok(linear) = linearize(&model.model, &values, &point.at, &point.input, &point.output)
                && linear.transfer_function.relative_degree() < 0
            {
                found.push((path, Unresponsive::Improper));
            }
        }
    }
    found
}

impl Checker<'_> {
    /// A criterion on poles or responses of what has none.
    pub(super) fn has_what_is_asked(&mut self, check: &Check, text: &Text, names: &Names<'_>) -> bool {
        let Some(of) = check.system() else { return true };
        let path = of.to_string();
        let Some((_, why)) = names.unresponsive.iter().find(|(known, _)| *known == path) else { return true };
        let (what, help) = match (why, check) {
            (
                _,
                Check::Structure { .. }
                | Check::Numerator { .. }
                | Check::Denominator { .. }
                | Check::Rest { .. }
                | Check::Tangent { .. },
            ) => {
                return true;
            }
            (Unresponsive::Static, Check::Feature { feature, .. }) if feature.kind == FeatureKind::DcGain => {
                return true;
            }
            (Unresponsive::Static, _) => (
                "is a static function: nothing in it is differentiated, so it has no poles and no responses",
                "ask for its `dc_gain` (the slope), its `transfer_function` or its `tangent`",
            ),
            (Unresponsive::Improper, Check::Poles { .. } | Check::Stability { .. }) => return true,
            (Unresponsive::Improper, _) => (
                "has an improper transfer function: its impulse and step responses are no ordinary functions",
                "ask for its `transfer_function`, `poles` or `stability`",
            ),
        };
        self.error("lab.criterion", span(text), format!("`{path}` {what}"), Some(help.to_owned()));
        false
    }
}

/// What stands beside the j (or i) of an imaginary part, as bytes of `text`; `None` when there is none.
fn imaginary(text: &str, from: usize, to: usize, letters: &[&str]) -> Option<(usize, usize)> {
    let part = text.get(from..to)?;
    let inner = part.trim_end();
    let unit = |c: char| matches!(c, 'j' | 'i') && !letters.contains(&c.to_string().as_str());
    if let Some(rest) = inner.strip_suffix(unit) {
        let before = rest.trim_end();
        let rest = before.strip_suffix('*').unwrap_or(before);
        let alone = !rest.ends_with(|c: char| c.is_alphabetic() || c == '_');
        return alone.then_some((from, from + rest.len()));
    }
    let begin = part.len() - part.trim_start().len();
    let rest = part.trim_start().strip_prefix(unit)?;
    let after = rest.trim_start();
    let number = after.strip_prefix('*').unwrap_or(after);
    let alone = after.len() < number.len() || after.starts_with(|c: char| c.is_ascii_digit());
    (alone && begin < part.len()).then(|| (to - number.len(), to))
}

fn is_zero(e: &Expression) -> bool {
    matches!(&e.kind, crate::algebra::NodeKind::Number(value) if value.is_zero())
}

#[cfg(test)]
mod tests {
    use crate::lab::LabDefinition;
    use crate::source::SourceText;

    /// A lab with one model.
    fn lab(model: &str) -> String {
        format!(
            "lab: l\ntitle: L\nparameters:\n  K: {{value: 2}}\n  T: {{value: 0.5}}\nmodels:\n  m:\n    title: M\n{model}\
             total: 1\nquestions:\n  q:\n    number: 1\n    title: Q\n    points: 1\n    about: m.linear\n    answer: {{kind: stability, prompt: P}}\n\
             \x20   criteria:\n      w: {{title: W, points: 1, check: stability}}\n\
             cover: {{total: 1, rows: {{q: {{title: Q, points: 1, from: questions}}}}}}\n"
        )
    }

    /// Model, what is marked in the file, message, help.
    #[track_caller]
    fn check(rows: &[(&str, &str, &str, &str)]) {
        for (model, place, message, help) in rows {
            let text = lab(model);
            let errors = LabDefinition::parse(SourceText::new("lab.yaml", &text)).expect_err(model);
            let found = &errors.findings[0];
            let span = found.span.unwrap_or_else(|| panic!("{model}: {found:?}"));
            assert!(found.message.contains(message), "{model}: {}", found.message);
            assert_eq!(&text[span.start..span.end], *place, "{model}: {}", found.message);
            assert!(found.help.as_deref().unwrap_or_default().contains(help), "{model}: {:?}", found.help);
        }
    }

    #[test]
    fn what_is_wrong_with_a_linear_model() {
        check(&[
            ("    linear: {transfer_function: \"K/(s*(Tau*s + 1))\"}\n", "Tau", "`Tau` is not a name", ""),
            ("    linear: {transfer_function: \"K/(s*(T*s + 1)\"}\n", "(", "", ""),
            (
                "    linear: {transfer_function: \"exp(-T*s)/(s + 1)\"}\n",
                "exp(-T*s)",
                "no transfer function of finite order",
                "",
            ),
            ("    linear: {transfer_function: \"K - K\"}\n", "K - K", "zero", ""),
            ("    linear: {transfer_function: {num: [0, K], den: [0]}}\n", "[", "this is zero", ""),
            ("    linear: {transfer_function: {num: [k], den: [1, 2]}}\n", "k", "`k`", "`K`"),
            ("    linear: {transfer_function: {nom: [1], den: [1]}}\n", "nom", "no key `nom`", "`num`"),
            ("    linear: {transferfunction: 1}\n", "transferfunction", "not known", "`transfer_function`"),
            ("    linear: {zpk: {poles: [-1 + 2j]}}\n", "-1 + 2j", "with its conjugate", "±"),
            ("    linear: {zpk: {poles: [-1 ± sqrt(x)j]}}\n", "(x)", "`x`", ""),
            ("    linear: {zpk: {poles: [-1], gain: 0}}\n", "0", "gain of 0", ""),
            (
                "    linear: {state_space: {A: [[1, 2]], B: [[1]], C: [[1]]}}\n",
                "1",
                "row 1 of `A` has 2 entries, but needs 1",
                "",
            ),
            (
                "    linear: {state_space: {A: [[1]], B: [[1], [2]], C: [[1]]}}\n",
                "2",
                "`B` has 2 rows, but needs 1",
                "",
            ),
            (
                "    linear: {state_space: {A: [[1]], B: [[1, 2]], C: [[1]]}}\n",
                "{",
                "several inputs or outputs",
                "channels",
            ),
            (
                "    linear: {zpk: {poles: [-1]}}\n    equations: [\"x = 1\"]\n",
                "[",
                "`equations` cannot stand beside `linear`",
                "",
            ),
            ("    inputs: {u: {}}\n", "m", "the key `coordinates` is missing", ""),
            ("    inputs: {K: {}}\n    linear: {zpk: {poles: [-1]}}\n", "K", "name of something else", ""),
        ]);
    }

    #[test]
    fn an_order_of_fifty_is_no_burden() {
        let poles: Vec<String> = (1..=50).map(|i| format!("-{i}")).collect();
        let text = lab(&format!("    linear: {{zpk: {{poles: [{}], gain: K}}}}\n", poles.join(", ")));
        let lab = LabDefinition::parse(SourceText::new("lab.yaml", text)).unwrap();
        assert_eq!(lab.models[0].model.order_of("z"), 50);
    }
}
