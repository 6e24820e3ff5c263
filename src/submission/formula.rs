use super::beyond_formula::{fraction_rule, without_assignments, without_headings};
use super::called::call;
use super::comma_to_point::{Pointed, comma_in_list_text, commas_read, settled};
use super::decimal_commas::decimal_comma_between;
use super::letters::Letters;
use super::problem::{Problem, quote, sentence};
use super::wrapping::{unwrapped, without_unit};
use super::{AnswerSheet, AnswerValue, AnsweredIn, Decimal};
use crate::algebra::{Expression, ExpressionError, NodeKind, Polynomial, Rational};
use crate::lti::TransferFunction;
use crate::names::nearest;
use crate::source::{Finding, Node, Span, Value};
use std::borrow::Cow;
use std::collections::BTreeMap;

const CODE: &str = "transfer_function.unreadable";
const HELP: &str = "Write it like `0.5s / (s^2 + 2s + 5)`, or as coefficients, highest power first: `{num: [0.5, 0], den: [1, 2, 5]}`.";

/// Length of a formula as typed, what stands around it included.
const MOST_BYTES: usize = 4_000;
/// Degree of numerator and denominator.
const MAX_DEGREE: usize = 30;
/// Coefficients of one polynomial as a list.
const MAX_COEFFICIENTS: usize = MAX_DEGREE + 1;

type Symbols = BTreeMap<String, Rational>;

/// A transfer function as text, or as `{num: […], den: […]}`, and what is worth saying about it.
pub(super) fn read_transfer_function(
    node: &Node,
    sheet: &AnswerSheet,
    path: &str,
    source: &str,
) -> Result<(AnswerValue, Vec<Finding>), Box<Finding>> {
    let letters = Letters::new(sheet, path);
    let mut reader = Reader { letters: &letters, source, commas: Vec::new(), variable: None };
    let (transfer_function, formula) = match &node.value {
        Value::Scalar(text) if text.len() > MOST_BYTES => {
            let message = format!("This is longer than the {MOST_BYTES} bytes of a formula that are read.");
            return Err(Box::new(Finding::error(CODE, message).with_help(HELP).at(node.span)));
        }
        Value::Scalar(text) => reader.formula(node, text)?,
        Value::Mapping(entries) => reader.coefficients(node, entries)?,
        Value::Sequence(_) | Value::Null => {
            let message = format!("A transfer function is asked for here, and {} is given.", node.kind());
            return Err(Box::new(Finding::error(CODE, message).with_help(HELP).at(node.span)));
        }
    };
    let (num, den) = (transfer_function.num.degree(), transfer_function.den.degree());
    if num.max(den) > MAX_DEGREE {
        let message = format!(
            "The transfer function has degree {}, more than the {MAX_DEGREE} that are read.",
            num.max(den)
        );
        let help = "Cancel or divide what is common to numerator and denominator, and look for slips.";
        return Err(Box::new(
            Finding::error("transfer_function.degree", message).with_help(help).at(node.span),
        ));
    }
    let mut notes: Vec<Finding> = commas_read(&reader.commas, source).into_iter().collect();
    if num > den {
        let message = format!("As written, the numerator has degree {num} and the denominator only {den}.");
        let help = "If the denominator is a sum, put it in parentheses: `a / (b + c)`.";
        notes.push(Finding::warning("transfer_function.improper", message).with_help(help).at(node.span));
    }
    let asked = sheet.letters.get(path).map_or(AnsweredIn::Either, |own| own.answered_in);
    notes.extend(asked_otherwise(asked, formula.as_ref(), &letters.symbols, node));
    Ok((AnswerValue::TransferFunction { transfer_function, formula }, notes))
}

/// A note where letters are asked for and none are given, or the other way round.
fn asked_otherwise(
    asked: AnsweredIn,
    formula: Option<&Expression>,
    symbols: &Symbols,
    node: &Node,
) -> Option<Finding> {
    let has_letters = formula.is_some_and(|formula| in_letters(formula, symbols));
    match asked {
        AnsweredIn::Letters if !has_letters && !symbols.is_empty() => {
            let names: Vec<String> = symbols.keys().map(|name| format!("`{name}`")).collect();
            let message = "This is asked for in letters, and there are only numbers in it.";
            let help = format!("The letters that can be used are {}.", names.join(", "));
            Some(Finding::warning("transfer_function.numbers", message).with_help(help).at(node.span))
        }
        AnsweredIn::Numbers if has_letters => {
            let message = "This is asked for in numbers: the lab's own values are put in for your letters.";
            let help = "Put the numbers in yourself, and look whether they come out as you expect.";
            Some(Finding::warning("transfer_function.letters", message).with_help(help).at(node.span))
        }
        _ => None,
    }
}

fn in_letters(formula: &Expression, symbols: &Symbols) -> bool {
    formula.symbols().iter().any(|symbol| symbols.contains_key(&symbol.name))
}

/// `G(s) = -0.06s / (…)`, also in letters, also MATLAB's `tf([…], […])`.
fn parse_formula(text: &str, letters: &Letters) -> Result<(TransferFunction, Option<Expression>), Problem> {
    let start = after_name(text);
    let body = &text[start..];
    if let Some(call) = call(body) {
        return call.read(CODE, (start, text.len()), coefficient_words).map(|g| (g, None));
    }
    let symbols = &letters.symbols;
    let read = |expression: Expression| {
        let expression = letters.named(expression);
        let variable = variable(&expression, symbols).unwrap_or("s");
        let (num, den) = expression.rational_function_nearly(variable, symbols)?;
        Ok((num, den, expression))
    };
    let (num, den, formula) =
        Expression::parse_typed(body).and_then(read).map_err(|error| formula_problem(error, start))?;
    match TransferFunction::new(num, den) {
        Some(g) => Ok((g, Some(formula))),
        None => Err(Problem::new(CODE, start, text.len(), "The denominator is zero.").help(HELP)),
    }
}

/// `S` where it can only be meant for `s`; `None` when neither is there.
fn variable(expression: &Expression, symbols: &Symbols) -> Option<&'static str> {
    let used = expression.symbols();
    let has = |name: &str| used.iter().any(|symbol| symbol.name == name);
    if has("s") { Some("s") } else { (has("S") && !symbols.contains_key("S")).then_some("S") }
}

/// Without marks of mathematics, a full stop and a unit around it; byte for byte as long as it was.
fn bare<'t>(text: &'t str, symbols: &Symbols) -> Cow<'t, str> {
    let known = |letter: &str| symbols.contains_key(letter);
    let outer = unwrapped(text).into_owned();
    let outer = unwrapped(&without_unit(&outer, known)).into_owned();
    let from = after_name(&outer);
    let body = unwrapped(&outer[from..]).into_owned();
    let body = without_unit(&body, known).into_owned();
    let bare = format!("{}{}", &outer[..from], unwrapped(&body));
    if bare == text { Cow::Borrowed(text) } else { Cow::Owned(bare) }
}

/// Where the formula begins: what stands before the last `=` is a name.
fn after_name(text: &str) -> usize {
    text.rfind(['=', '≈']).map_or(0, |i| i + text[i..].chars().next().map_or(1, char::len_utf8))
}

fn formula_problem(error: ExpressionError, offset: usize) -> Problem {
    let help = error.help.as_deref().map_or_else(|| HELP.to_owned(), sentence);
    let message = format!("The formula cannot be read here: {}.", error.message);
    Problem::new(CODE, error.start + offset, error.end + offset, message).help(help)
}

/// Decimals separated by commas, semicolons or spaces.
fn coefficient_words(text: &str) -> Option<Vec<Rational>> {
    let text = text.trim().trim_start_matches('[').trim_end_matches(']');
    let words: Vec<&str> =
        text.split(|c: char| c.is_whitespace() || matches!(c, ',' | ';')).filter(|w| !w.is_empty()).collect();
    if words.is_empty() || words.len() > MAX_COEFFICIENTS {
        return None;
    }
    words.into_iter().map(|word| Decimal::parse(word).ok().map(|d| d.value)).collect()
}

type Entry = (String, Span, Node);

/// Reads one transfer function, and remembers its decimal commas.
struct Reader<'a> {
    letters: &'a Letters,
    source: &'a str,
    commas: Vec<(Span, String)>,
    /// What numerator and denominator were written in so far.
    variable: Option<&'static str>,
}

impl Reader<'_> {
    fn place(&self, problem: Problem, node: &Node) -> Box<Finding> {
        Box::new(problem.into_finding(node, self.source))
    }

    /// The text with points for decimal commas after byte `from`; see [`Pointed::read`].
    fn pointed(
        &mut self,
        node: &Node,
        text: &str,
        from: usize,
        settled: bool,
    ) -> Result<String, Box<Finding>> {
        let pointed = Pointed::read(text, from, settled).map_err(|problem| self.place(problem, node))?;
        self.commas.extend(pointed.places(node, self.source));
        Ok(pointed.text.into_owned())
    }

    fn formula(
        &mut self,
        node: &Node,
        text: &str,
    ) -> Result<(TransferFunction, Option<Expression>), Box<Finding>> {
        let text = &without_headings(text);
        let (text, left_out) = without_assignments(text, &self.letters.symbols, CODE)
            .map_err(|problem| self.place(problem, node))?;
        match fraction_rule(&text) {
            Ok(None) => {}
            Ok(Some(rule)) => return Ok((self.over_a_rule(node, &text, rule)?, None)),
            Err((start, end)) => {
                let message = "There is a second rule of a fraction here.";
                return Err(self.place(Problem::new(CODE, start, end, message).help(HELP), node));
            }
        }
        let read = self.one_formula(node, &text)?;
        if left_out && read.1.as_ref().is_some_and(|formula| in_letters(formula, &self.letters.symbols)) {
            let message = "A value is set behind a formula in letters, where the lab's own value is used.";
            let problem =
                Problem::new(CODE, 0, text.len(), message).help("Put the numbers into the formula.");
            return Err(self.place(problem, node));
        }
        Ok(read)
    }

    /// Numerator and denominator above and below a rule, as programs print them.
    fn over_a_rule(
        &mut self,
        node: &Node,
        text: &str,
        (start, end): (usize, usize),
    ) -> Result<TransferFunction, Box<Finding>> {
        let below = text[end..].find("Continuous-time").map_or(text.len(), |at| end + at);
        let (above, _) = self.one_formula(node, text[..start].trim_end())?;
        // As far from the beginning as it was, so that places stay right.
        let (below, _) = self.one_formula(node, &(" ".repeat(end) + &text[end..below]))?;
        let (num, den) = (&above.num * &below.den, &above.den * &below.num);
        TransferFunction::new(num, den).ok_or_else(|| {
            self.place(Problem::new(CODE, end, text.len(), "The denominator is zero.").help(HELP), node)
        })
    }

    fn one_formula(
        &mut self,
        node: &Node,
        text: &str,
    ) -> Result<(TransferFunction, Option<Expression>), Box<Finding>> {
        let text = &bare(text, &self.letters.symbols);
        let from = after_name(text);
        // In MATLAB's lists commas separate.
        let from = if call(&text[from..]).is_some() { text.len() } else { from };
        let pointed = self.pointed(node, text, from, settled([&text[from..]]))?;
        parse_formula(&pointed, self.letters).map_err(|problem| self.place(problem, node))
    }

    /// With a formula where there are letters in it.
    fn coefficients(
        &mut self,
        node: &Node,
        entries: &[Entry],
    ) -> Result<(TransferFunction, Option<Expression>), Box<Finding>> {
        const NUM: &[&str] = &["num", "numerator", "n"];
        const DEN: &[&str] = &["den", "denominator", "denom", "d"];
        let texts = entries.iter().flat_map(|(_, _, value)| match &value.value {
            Value::Sequence(items) => items.as_slice(),
            _ => std::slice::from_ref(value),
        });
        let settled = settled(texts.filter_map(Node::as_scalar));
        let (mut num, mut den) = (None, None);
        for (key, span, value) in entries {
            let name = key.trim().to_lowercase();
            let part = if NUM.contains(&name.as_str()) {
                &mut num
            } else if DEN.contains(&name.as_str()) {
                &mut den
            } else {
                let near = nearest(&name, ["num", "den", "numerator", "denominator"]);
                let help = near.map_or_else(|| HELP.to_owned(), |near| format!("Did you mean `{near}`?"));
                let message = format!("{} is not a part of a transfer function.", quote(key));
                return Err(Box::new(Finding::error(CODE, message).with_help(help).at(*span)));
            };
            if part.is_some() {
                let message = format!("{} is given twice.", quote(key));
                return Err(Box::new(Finding::error(CODE, message).with_help(HELP).at(*span)));
            }
            *part = Some(self.polynomial(value, settled)?);
        }
        let missing = |part: &str| {
            Box::new(
                Finding::error(CODE, format!("The {part} of the transfer function is missing."))
                    .with_help(HELP)
                    .at(node.span),
            )
        };
        let (num, den) =
            (num.ok_or_else(|| missing("numerator"))?, den.ok_or_else(|| missing("denominator"))?);
        let formula = tree(NodeKind::Divide(Box::new(num.1), Box::new(den.1)));
        match TransferFunction::new(num.0, den.0) {
            Some(g) => Ok((g, in_letters(&formula, &self.letters.symbols).then_some(formula))),
            None => {
                Err(Box::new(Finding::error(CODE, "The denominator is zero.").with_help(HELP).at(node.span)))
            }
        }
    }

    /// A polynomial as a list of coefficients, as text with such a list, or as a formula in `s`; and the formula of it.
    fn polynomial(&mut self, node: &Node, settled: bool) -> Result<(Polynomial, Expression), Box<Finding>> {
        match &node.value {
            Value::Sequence(items) => {
                if let Some(finding) = decimal_comma_between(items, self.source, false) {
                    return Err(Box::new(finding));
                }
                if items.is_empty() || items.len() > MAX_COEFFICIENTS {
                    let message = format!(
                        "A list of 1 to {MAX_COEFFICIENTS} coefficients is asked for here, and {} are given.",
                        items.len()
                    );
                    return Err(Box::new(Finding::error(CODE, message).with_help(HELP).at(node.span)));
                }
                let read: Vec<(Rational, Expression)> =
                    items.iter().map(|item| self.coefficient(item, settled)).collect::<Result<_, _>>()?;
                let (values, formulas): (Vec<_>, Vec<_>) = read.into_iter().unzip();
                Ok((Polynomial::new(values), by_powers(formulas)))
            }
            Value::Scalar(text) => {
                if let Some(words) = coefficient_words(text) {
                    return match Pointed::as_typed(text).err().or_else(|| comma_in_list_text(text)) {
                        Some(problem) => Err(self.place(problem, node)),
                        None => {
                            let numbers = words.iter().map(|word| tree(NodeKind::Number(word.clone())));
                            Ok((Polynomial::new(words.clone()), by_powers(numbers.collect())))
                        }
                    };
                }
                let text = self.pointed(node, &unwrapped(text), 0, settled)?;
                let expression = Expression::parse_typed(&text)
                    .map(|expression| self.letters.named(expression))
                    .map_err(|error| self.place(formula_problem(error, 0), node))?;
                // `s` and `S` in one answer are two letters.
                self.variable = self.variable.or(variable(&expression, &self.letters.symbols));
                let (num, den) = expression
                    .rational_function_nearly(self.variable.unwrap_or("s"), &self.letters.symbols)
                    .map_err(|error| self.place(formula_problem(error, 0), node))?;
                match den.leading() {
                    Some(divisor) if den.degree() == 0 => {
                        Ok((num.scale(&(Rational::ONE / divisor)), expression))
                    }
                    _ => Err(Box::new(
                        Finding::error(CODE, "Numerator and denominator have to be polynomials in `s`.")
                            .with_help(HELP)
                            .at(node.span),
                    )),
                }
            }
            Value::Null | Value::Mapping(_) => {
                let message =
                    format!("A list of coefficients is asked for here, and {} is given.", node.kind());
                Err(Box::new(Finding::error(CODE, message).with_help(HELP).at(node.span)))
            }
        }
    }

    /// A decimal or letters: `0.0132`, `m*l`, `-1/3`.
    fn coefficient(&mut self, node: &Node, settled: bool) -> Result<(Rational, Expression), Box<Finding>> {
        let Some(text) = node.as_scalar() else {
            let message = format!("A coefficient is asked for here, and {} is given.", node.kind());
            return Err(Box::new(Finding::error(CODE, message).with_help(HELP).at(node.span)));
        };
        let text = self.pointed(node, text, 0, settled)?;
        if let Ok(decimal) = Decimal::parse(&text) {
            let number = tree(NodeKind::Number(decimal.value.clone()));
            return Ok((decimal.value, number));
        }
        let (num, den, expression) = Expression::parse_typed(&text)
            .and_then(|expression| {
                let expression = self.letters.named(expression);
                let (num, den) = expression.rational_function_nearly("s", &self.letters.symbols)?;
                Ok((num, den, expression))
            })
            .map_err(|error| self.place(formula_problem(error, 0), node))?;
        match den.leading() {
            Some(divisor) if num.degree() == 0 && den.degree() == 0 => {
                Ok((num.coefficient(0) / divisor, expression))
            }
            _ => {
                let message = format!("{} is not a number: coefficients stand without `s`.", quote(&text));
                Err(Box::new(Finding::error(CODE, message).with_help(HELP).at(node.span)))
            }
        }
    }
}

fn tree(kind: NodeKind) -> Expression {
    Expression { kind, start: 0, end: 0 }
}

/// Coefficients, highest power first, as a polynomial in s.
fn by_powers(coefficients: Vec<Expression>) -> Expression {
    let highest = coefficients.len().saturating_sub(1);
    let terms = coefficients.into_iter().enumerate().map(|(i, coefficient)| {
        let s = tree(NodeKind::Symbol { name: "s".to_owned(), primes: 0 });
        let power = tree(NodeKind::Number(Rational::from(highest - i)));
        let power = tree(NodeKind::Power(Box::new(s), Box::new(power)));
        tree(NodeKind::Multiply(Box::new(coefficient), Box::new(power)))
    });
    let sum = terms.reduce(|sum, term| tree(NodeKind::Add(Box::new(sum), Box::new(term))));
    sum.unwrap_or_else(|| tree(NodeKind::Number(Rational::ZERO)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::algebra::parse_decimal;
    use crate::source::{Severity, parse};

    fn sheet() -> AnswerSheet {
        let symbols = [("M", "0.5"), ("b", "0.1"), ("m", "0.2"), ("l", "0.3"), ("I", "0.006"), ("g", "9.81")]
            .map(|(name, value)| (name.to_owned(), parse_decimal(value).unwrap()));
        AnswerSheet { symbols: symbols.into(), ..AnswerSheet::default() }
    }

    fn read(yaml: &str) -> Result<(TransferFunction, Vec<Finding>), Finding> {
        let text = format!("g: {yaml}");
        let tree = parse(&text).unwrap_or_else(|e| panic!("{yaml:?}: {e:?}"));
        match read_transfer_function(tree.get("g").unwrap(), &sheet(), "g", &text) {
            Ok((AnswerValue::TransferFunction { transfer_function, .. }, notes)) => {
                Ok((transfer_function, notes))
            }
            Ok(other) => panic!("{other:?}"),
            Err(finding) => Err(*finding),
        }
    }

    #[test]
    fn every_spelling_is_the_same_transfer_function() {
        let list =
            |texts: &[&str]| Polynomial::new(texts.iter().map(|t| parse_decimal(t).unwrap()).collect());
        let expected =
            TransferFunction::new(list(&["-0.06", "0"]), list(&["0.0132", "0.0024", "0.41202", "0.05886"]))
                .unwrap();
        for yaml in [
            "-0.06s / (0.0132s^3 + 0.0024s^2 + 0.41202s + 0.05886)",
            "-0.06*s/(0.0132*s^3 + 0.0024*s^2 + 0.41202*s + 0.05886)",
            "−0.06 s / (0.0132 s³ + 0.0024 s² + 0.41202 s + 0.05886)",
            "G(s) = -0.06s / (0.0132s^3 + 0.0024s^2 + 0.41202s + 0.05886)",
            "\"G₀(s) = Θ(s)/F(s) = -0.06s / (0.0132s^3 + 0.0024s^2 + 0.41202s + 0.05886)\"",
            "= -0.06s / (0.0132s^3 + 0.0024s^2 + 0.41202s + 0.05886)",
            "(-0.06 s) / (1.32e-2 s**3 + 2.4e-3 s**2 + 0.41202 s + 0.05886)",
            "-m*l*s / (((M+m)*(I+m*l^2) - m^2*l^2)*s^3 + b*(I+m*l^2)*s^2 + (M+m)*m*g*l*s + b*m*g*l)",
            "'{num: [x]}'",
            "{num: [-0.06, 0], den: [0.0132, 0.0024, 0.41202, 0.05886]}",
            "{numerator: [-0.06, 0], denominator: [0.0132, 0.0024, 0.41202, 0.05886]}",
            "{num: [-m*l, 0], den: [0.0132, 0.0024, (M+m)*m*g*l, b*m*g*l]}",
            "{num: -0.06s, den: 0.0132s^3 + 0.0024s^2 + 0.41202s + 0.05886}",
            "{num: '[-0.06 0]', den: '0.0132 0.0024 0.41202 0.05886'}",
            "{num: [0, −0.06, 0], den: ['0.0132', 0.0024, 4.1202e-1, 0.05886]}",
            "tf([-0.06 0], [0.0132 0.0024 0.41202 0.05886])",
            "tf([-0.06, 0], [0.0132, 0.0024, 0.41202, 0.05886]);",
            "G = ct.tf([-0.06, 0], [0.0132, 0.0024, 0.41202, 0.05886])",
            "$G(s) = -0.06s / (0.0132s^3 + 0.0024s^2 + 0.41202s + 0.05886)$",
            r"$$\frac{-0.06 s}{0.0132 s^3 + 0.0024 s^2 + 0.41202 s + 0.05886}$$",
            r"G(s) = \(-0.06s / (0.0132s^3 + 0.0024s^2 + 0.41202s + 0.05886)\).",
            r"'\[-0.06s / (0.0132s^3 + 0.0024s^2 + 0.41202s + 0.05886)\]'",
            "'`-0.06s / (0.0132s^3 + 0.0024s^2 + 0.41202s + 0.05886)`'",
            "-0.06s / (0.0132s^3 + 0.0024s^2 + 0.41202s + 0.05886).",
            "-0.06s / (0.0132s^3 + 0.0024s^2 + 0.41202s + 0.05886) rad/N",
            "-0.06s / (0.0132s^3 + 0.0024s^2 + 0.41202s + 0.05886) rad/(N)",
            "G(s) = -0.06s / (0.0132s^3 + 0.0024s^2 + 0.41202s + 0.05886) (rad/N).",
            "$-0.06s / (0.0132s^3 + 0.0024s^2 + 0.41202s + 0.05886)$ rad/N",
            "G(s) = -0.06S / (0.0132S^3 + 0.0024S^2 + 0.41202S + 0.05886)",
            "{num: -0.06S, den: 0.0132S^3 + 0.0024S^2 + 0.41202S + 0.05886}",
        ] {
            if yaml == "'{num: [x]}'" {
                assert!(read(yaml).is_err());
                continue;
            }
            let found = read(yaml);
            assert_eq!(found.as_ref().map(|(g, _)| g), Ok(&expected), "{yaml:?}");
            assert!(found.unwrap().1.is_empty(), "{yaml:?}");
        }
    }

    #[test]
    fn what_cannot_be_read_says_where_and_how() {
        for (yaml, marked, words) in [
            ("-1,006s / (s + 1)", "1,006", "may be 1.006 or 1006"),
            ("{num: ['1,006', 0], den: [1, 1]}", "1,006", "may be 1.006 or 1006"),
            ("tf([-0,06 0], [1 1])", "tf([-0,06 0], [1 1])", "`0,06`"),
            ("{num: '0,5', den: [1, 1]}", "0,5", "`0,5`"),
            ("1/(s^31 + 1)", "1/(s^31 + 1)", "degree 31"),
            (
                "{num: [1], den: [1, 1111111111111111111111111111111111111111111111111111111111111]}",
                "1111111111111111111111111111111111111111111111111111111111111",
                "61 digits",
            ),
            (
                "1/(s + 1111111111111111111111111111111111111111111111111111111111111)",
                "1111111111111111111111111111111111111111111111111111111111111",
                "61 digits",
            ),
            ("1/(s + q)", "q", "`q`"),
            ("1/(s + S)", "S", "`S`"),
            ("{num: s, den: S + 1}", "S", "`S`"),
            ("$1$ / $(s + 1)$", "$", "`$`"),
            ("1/(s + 1) deg/N", "1/(s + 1) deg", "two ways"),
            ("1/(s + 1) m/N", "1/(s + 1) m", "two ways"),
            ("1/(s + 1", "(", "never closed"),
            ("{num: [1], den: [0, 0]}", "{num: [1], den: [0, 0]}", "zero"),
            ("{num: [1]}", "{num: [1]}", "denominator of the transfer function is missing"),
            ("{num: [1], dem: [1]}", "dem", "not a part"),
            ("{num: [1s], den: [1, 1]}", "1s", "without `s`"),
            ("{num: [[1]], den: [1, 1]}", "[1]", "a list"),
            ("{num: {a: 1}, den: [1, 1]}", "{a: 1}", "a mapping"),
            ("{num: [-0,06, 0], den: [1, 1]}", "-0,06", "comma"),
            ("[1, 2]", "[1, 2]", "a list"),
            ("unknown words here", "unknown", "`unknown`"),
        ] {
            let finding = read(yaml).unwrap_err();
            let span = finding.span.unwrap();
            assert_eq!(&format!("g: {yaml}")[span.start..span.end], marked, "{yaml:?}: {finding:?}");
            assert!(finding.message.contains(words), "{yaml:?}: {finding:?}");
            assert!(finding.message.ends_with('.') && finding.help.is_some(), "{yaml:?}: {finding:?}");
        }
    }

    #[test]
    fn decimal_commas_are_read_and_said() {
        let expected = read("-0.06s / (5.568s + 0.05)").unwrap().0;
        for (yaml, words) in [
            (
                "-0,06s / (5,568s + 0,05)",
                "`-0,06` is read as -0.06. So are the 2 other decimal commas in this answer.",
            ),
            ("G_1,2(s) = -0,06s / (5,568s + 0,05)", "`-0,06` is read as -0.06."),
            ("{num: '-0,06s', den: '5,568s + 0,05'}", "So are the 2 other"),
            ("{num: ['-0,06', 0], den: ['5,568', '0,05']}", "So are the 2 other"),
            ("{num: [-0.06, 0], den: [5.568, \"5,00e-2\"]}", "`5,00`"),
        ] {
            let (found, notes) = read(yaml).unwrap_or_else(|finding| panic!("{yaml}: {finding:?}"));
            assert_eq!(found, expected, "{yaml}");
            let [note] = notes.as_slice() else { panic!("{yaml}: {notes:?}") };
            assert_eq!((note.severity, note.code), (Severity::Warning, "number.comma_read"));
            assert!(note.message.contains(words), "{yaml}: {note:?}");
        }
    }

    #[test]
    fn a_forgotten_parenthesis_is_suspected() {
        let (_, notes) = read("0.06*s/0.0132*s^3 + 0.0024*s^2 + 0.412*s + 0.0589").unwrap();
        assert_eq!(notes.iter().map(|n| n.code).collect::<Vec<_>>(), ["transfer_function.improper"]);
    }

    #[test]
    fn what_programs_print_is_read() {
        let expected = read("2s / (s^2 + 3s + 5)").unwrap().0;
        for yaml in [
            "|\n    2 s\n    -------------\n    s^2 + 3 s + 5\n",
            "|\n    G =\n\n      2 s\n    -------------\n    s^2 + 3 s + 5\n\n    Continuous-time transfer function.\n",
            "2 s\n  -------------\n  s^2 + 3 s + 5",
            "2s ───── s^2 + 3s + 5",
            "2s / (s^2 + 3s + 5), g = 9.81",
            "G(s) = 2s / (s^2 + 3s + 5) where g = 9.81",
            "s = tf('s'); G = 2s / (s^2 + 3s + 5)",
        ] {
            let found = read(yaml).unwrap_or_else(|finding| panic!("{yaml:?}: {}", finding.message));
            assert!(found.0.equals(&expected), "{yaml:?}: {:?}", found.0);
        }
    }

    #[test]
    fn calls_of_programs_are_read() {
        for (yaml, same) in [
            ("tf(1,[1000 50])", "1 / (1000s + 50)"),
            ("tf(0.001, [1 0.05])", "0.001 / (s + 0.05)"),
            ("tf([1],[1 2])", "1 / (s + 2)"),
            ("G = tf([1 2], 5)", "(s + 2) / 5"),
            ("zpk([],[-1 -2],5)", "5 / ((s + 1)*(s + 2))"),
            ("zpk([], -0.05, 0.001)", "0.001 / (s + 0.05)"),
            ("zpk([-3], [-1+2i, -1-2i, 0], 2)", "2*(s + 3) / (s*(s^2 + 2s + 5))"),
            ("zpk(-3, [-1+2i -1-2i], 2);", "2*(s + 3) / (s^2 + 2s + 5)"),
            (
                "|\n    <TransferFunction>: sys[0]\n    Inputs (1): ['u[0]']\n    Outputs (1): ['y[0]']\n\n          1\n    -------------\n    1000 s + 50\n",
                "1 / (1000s + 50)",
            ),
            (
                "|\n    sys =\n\n           5\n      -----------\n      (s+1) (s+2)\n\n    Continuous-time zero/pole/gain model.\n",
                "5 / ((s + 1)*(s + 2))",
            ),
            ("|\n    Transfer function:\n        1\n    --------\n    s + 2\n", "1 / (s + 2)"),
        ] {
            let (found, notes) = read(yaml).unwrap_or_else(|finding| panic!("{yaml:?}: {}", finding.message));
            assert!(found.equals(&read(same).unwrap().0), "{yaml:?}: {found:?}");
            assert!(
                notes.iter().all(|note| note.code == "transfer_function.improper"),
                "{yaml:?}: {notes:?}"
            );
        }
        for (yaml, words) in [
            ("ss([0 1; -2 -3], [0; 1], [1 0], 0)", "state-space model"),
            ("zpk([], [-1+2i], 1)", "with their conjugates"),
            ("zpk([], [-1])", "three parts"),
            ("zpk([], [-1], K)", "gain"),
            ("tf([1], [1 2], 0.1)", "two lists"),
            ("tf(1, x)", "cannot be read"),
            ("tf(1, 0)", "zero"),
            ("tf(1,5,[1 2])", "two lists"),
            ("tf([1,5 2], [1 2])", "`1,5`"),
        ] {
            let finding = read(yaml).expect_err(yaml);
            assert!(finding.message.contains(words), "{yaml:?}: {finding:?}");
        }
    }

    /// What stands behind the last `=` would be another formula than the student's answer.
    #[test]
    fn what_is_set_beside_a_formula_is_never_the_answer() {
        for yaml in [
            "K*s/(s^2 + 3s + 5), K = 2",
            "-m*l*s/(q*s^3 + b), q = (M + m)*(I + m*l^2) - (m*l)^2",
            "|\n    m*l*s/(q*s^3 + b)\n    q = (M + m)*(I + m*l^2) = 0.0168\n",
            "num = 2s; den = s^2 + 3s + 5",
            "m*g/(s + b), g = 10",
            "1\n  ---\n  s\n  ---\n  2",
        ] {
            let finding = read(yaml).expect_err(yaml);
            assert_eq!(finding.code, CODE, "{yaml:?}: {}", finding.message);
        }
    }
}
