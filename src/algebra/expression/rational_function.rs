use super::super::clip::clip;
use super::super::{Polynomial, Rational, exact_root, from_f64, to_f64};
use super::{Expression, ExpressionError, Function, NodeKind, names, text::number_text};
use dashu_int::ops::{Abs, BitTest};
use std::collections::BTreeMap;

impl Expression {
    /// Numerator and denominator in `variable`, exact and as typed: nothing is cancelled.
    ///
    /// `symbols` gives the values of the other names. `pi` is its nearest `f64`. Constants in a denominator are
    /// divided into the numerator.
    /// Errors: unknown names, functions of the variable, division by zero, powers that are not whole, and results
    /// beyond degree 60 or 2048 bits a coefficient.
    pub fn rational_function(
        &self,
        variable: &str,
        symbols: &BTreeMap<String, Rational>,
    ) -> Result<(Polynomial, Polynomial), ExpressionError> {
        self.worked_out(variable, symbols, false)
    }

    /// The same, where a root or a function of numbers that is irrational counts as its nearest `f64`.
    pub fn rational_function_nearly(
        &self,
        variable: &str,
        symbols: &BTreeMap<String, Rational>,
    ) -> Result<(Polynomial, Polynomial), ExpressionError> {
        self.worked_out(variable, symbols, true)
    }

    fn worked_out(
        &self,
        variable: &str,
        symbols: &BTreeMap<String, Rational>,
        nearly: bool,
    ) -> Result<(Polynomial, Polynomial), ExpressionError> {
        let mut work = Work { variable, symbols, multiplications: 0, nearly };
        let quotient = work.quotient(self)?;
        Ok((quotient.num, quotient.den))
    }
}

const MOST_DEGREE: usize = 60;
const MOST_BITS: usize = 2048;
/// Products of coefficients, in all.
const MOST_MULTIPLICATIONS: usize = 100_000;

struct Work<'a> {
    variable: &'a str,
    symbols: &'a BTreeMap<String, Rational>,
    multiplications: usize,
    /// Irrational numbers may be rounded.
    nearly: bool,
}

struct Quotient {
    num: Polynomial,
    /// Never zero.
    den: Polynomial,
}

impl Quotient {
    fn polynomial(num: Polynomial) -> Self {
        Self { num, den: Polynomial::one() }
    }

    fn constant(value: Rational) -> Self {
        Self::polynomial(Polynomial::constant(value))
    }

    fn negated(self) -> Self {
        Self { num: -&self.num, den: self.den }
    }

    fn as_constant(&self) -> Option<Rational> {
        (self.num.degree() == 0 && self.den == Polynomial::one()).then(|| self.num.coefficient(0))
    }
}

impl Work<'_> {
    /// Only dispatches: with the work done elsewhere, a high tree needs little stack.
    fn quotient(&mut self, node: &Expression) -> Result<Quotient, ExpressionError> {
        match &node.kind {
            NodeKind::Number(value) => Ok(Quotient::constant(value.clone())),
            NodeKind::Pi => Ok(Quotient::constant(from_f64(std::f64::consts::PI).unwrap_or(Rational::ZERO))),
            NodeKind::Symbol { name, primes } => self.symbol(node, name, *primes),
            NodeKind::Negate(a) => self.quotient(a).map(Quotient::negated),
            NodeKind::Call(function, a) => {
                let argument = self.quotient(a)?;
                self.call(node, *function, &argument)
            }
            NodeKind::Add(a, b)
            | NodeKind::Subtract(a, b)
            | NodeKind::Multiply(a, b)
            | NodeKind::Divide(a, b)
            | NodeKind::Power(a, b) => {
                let left = self.quotient(a)?;
                let right = self.quotient(b)?;
                self.combine(node, a, b, (left, right))
            }
        }
    }

    fn combine(
        &mut self,
        node: &Expression,
        a: &Expression,
        b: &Expression,
        (left, right): (Quotient, Quotient),
    ) -> Result<Quotient, ExpressionError> {
        match &node.kind {
            NodeKind::Add(..) => self.sum(node, left, right),
            NodeKind::Subtract(..) => self.sum(node, left, right.negated()),
            NodeKind::Divide(..) => {
                let inverse = self.inverse(b, right)?;
                self.product(node, &left, &inverse)
            }
            NodeKind::Power(..) => self.power(node, (a, left), (b, right)),
            _ => self.product(node, &left, &right),
        }
    }

    fn symbol(&self, node: &Expression, name: &str, primes: u8) -> Result<Quotient, ExpressionError> {
        if primes > 0 {
            return Err(error(
                node,
                format!("`{}` is primed, but this is no equation of motion", clip(name)),
            ));
        }
        if name == self.variable {
            return Ok(Quotient::polynomial(Polynomial::monomial(Rational::ONE, 1)));
        }
        match self.symbols.get(name) {
            Some(value) => Ok(Quotient::constant(value.clone())),
            None => {
                let mut known = vec![self.variable];
                known.extend(self.symbols.keys().map(String::as_str));
                Err(names::unknown(name, node.start, node.end, &known))
            }
        }
    }

    fn sum(&mut self, node: &Expression, a: Quotient, b: Quotient) -> Result<Quotient, ExpressionError> {
        let (left, right, den) = if a.den == b.den {
            (a.num, b.num, a.den)
        } else {
            let left = self.multiply(node, &a.num, &b.den)?;
            let right = self.multiply(node, &b.num, &a.den)?;
            (left, right, self.multiply(node, &a.den, &b.den)?)
        };
        let num = &left + &right;
        within_budget(node, &num)?;
        Ok(Quotient { num, den })
    }

    fn product(
        &mut self,
        node: &Expression,
        a: &Quotient,
        b: &Quotient,
    ) -> Result<Quotient, ExpressionError> {
        let num = self.multiply(node, &a.num, &b.num)?;
        let den = self.multiply(node, &a.den, &b.den)?;
        Ok(Quotient { num, den })
    }

    /// 1 / `quotient`, a constant denominator divided into the numerator.
    fn inverse(&mut self, node: &Expression, quotient: Quotient) -> Result<Quotient, ExpressionError> {
        match quotient.num.leading() {
            None => Err(error(node, "this is zero, and cannot be divided by".to_owned())),
            Some(value) if quotient.num.degree() == 0 => {
                let num = quotient.den.scale(&(Rational::ONE / value));
                within_budget(node, &num)?;
                Ok(Quotient::polynomial(num))
            }
            Some(_) => Ok(Quotient { num: quotient.den, den: quotient.num }),
        }
    }

    fn power(
        &mut self,
        node: &Expression,
        (a, base): (&Expression, Quotient),
        (b, exponent): (&Expression, Quotient),
    ) -> Result<Quotient, ExpressionError> {
        let Some(exponent) = exponent.as_constant() else {
            return Err(error(b, format!("a power with `{}` in it is no transfer function", self.variable)));
        };
        if !exponent.is_int() {
            if let Some(value) = base.as_constant()
                && exponent == Rational::ONE / Rational::from(2)
                && let Some(root) = exact_root(&value, 2)
            {
                return Ok(Quotient::constant(root));
            }
            if self.nearly
                && let Some(value) = base.as_constant()
                && let Some(value) = from_f64(to_f64(&value).powf(to_f64(&exponent)))
            {
                return Ok(Quotient::constant(value));
            }
            let shown = number_text(&exponent);
            return Err(error(b, format!("`{}` is not a whole power", clip(&shown))));
        }
        let base = if exponent < Rational::ZERO { self.inverse(a, base)? } else { base };
        let times = usize::try_from(exponent.numerator().clone().abs()).unwrap_or(usize::MAX);
        if let Some(value) = base.as_constant() {
            return self.number_power(node, &value, times);
        }
        if base.num.degree().max(base.den.degree()).saturating_mul(times) > MOST_DEGREE {
            return Err(too_large(node, &format!("has a degree beyond {MOST_DEGREE}")));
        }
        let mut result = Quotient::polynomial(Polynomial::one());
        for _ in 0..times {
            result = self.product(node, &result, &base)?;
        }
        Ok(result)
    }

    fn number_power(
        &self,
        node: &Expression,
        value: &Rational,
        times: usize,
    ) -> Result<Quotient, ExpressionError> {
        let trivial = value.is_zero() || *value == Rational::ONE || *value == Rational::NEG_ONE;
        let times = if trivial && times > 1 { 2 - times % 2 } else { times };
        if bits(value).saturating_sub(1).saturating_mul(times) > MOST_BITS {
            return Err(too_large(node, "has a number too long to hold"));
        }
        let result = (0..times).fold(Rational::ONE, |product, _| product * value);
        Ok(Quotient::constant(result))
    }

    fn call(
        &self,
        node: &Expression,
        function: Function,
        argument: &Quotient,
    ) -> Result<Quotient, ExpressionError> {
        let name = function.name();
        let Some(value) = argument.as_constant() else {
            let message = format!("`{name}` of `{}` is no ratio of polynomials", self.variable);
            return Err(error(node, message));
        };
        let exact = match function {
            Function::Sqrt => exact_root(&value, 2),
            Function::Abs => Some(if value < Rational::ZERO { -value.clone() } else { value.clone() }),
            _ => None,
        };
        let near = || from_f64(function.apply(to_f64(&value))).filter(|_| self.nearly);
        match exact.or_else(near) {
            Some(value) => Ok(Quotient::constant(value)),
            None => Err(ExpressionError {
                help: Some("write its value as a decimal number".to_owned()),
                ..error(node, format!("`{name}` has no exact value here"))
            }),
        }
    }

    fn multiply(
        &mut self,
        node: &Expression,
        a: &Polynomial,
        b: &Polynomial,
    ) -> Result<Polynomial, ExpressionError> {
        if a.degree() + b.degree() > MOST_DEGREE {
            return Err(too_large(node, &format!("has a degree beyond {MOST_DEGREE}")));
        }
        self.multiplications += (a.degree() + 1) * (b.degree() + 1);
        if self.multiplications > MOST_MULTIPLICATIONS {
            return Err(too_large(node, "takes more work than we do"));
        }
        let product = a * b;
        within_budget(node, &product)?;
        Ok(product)
    }
}

/// The length of the longer of numerator and denominator.
fn bits(value: &Rational) -> usize {
    value.numerator().bit_len().max(value.denominator().bit_len())
}

fn within_budget(node: &Expression, p: &Polynomial) -> Result<(), ExpressionError> {
    if p.coefficients().iter().any(|c| bits(c) > MOST_BITS) {
        return Err(too_large(node, "has a number too long to hold"));
    }
    Ok(())
}

fn too_large(node: &Expression, what: &str) -> ExpressionError {
    error(node, format!("multiplied out, this {what}"))
}

fn error(node: &Expression, message: String) -> ExpressionError {
    ExpressionError { start: node.start, end: node.end, message, help: None }
}

#[cfg(test)]
mod tests {
    use super::super::super::{parse_decimal, polynomial_text};
    use super::*;

    fn parameters() -> BTreeMap<String, Rational> {
        let pairs = [("M", "0.5"), ("m", "0.2"), ("b", "0.1"), ("I", "0.006"), ("g", "9.81"), ("l", "0.3")];
        pairs.into_iter().map(|(n, v)| (n.to_owned(), parse_decimal(v).unwrap())).collect()
    }

    fn read(text: &str) -> Result<(Polynomial, Polynomial), ExpressionError> {
        Expression::parse_typed(text)?.rational_function("s", &parameters())
    }

    #[track_caller]
    fn check(rows: &[(&str, &str, &str)]) {
        for (text, num, den) in rows {
            let (n, d) = read(text).unwrap_or_else(|e| panic!("{text}: {e} {:?}", e.help));
            let shown = (polynomial_text(&n, "s", 12), polynomial_text(&d, "s", 12));
            assert_eq!((shown.0.as_str(), shown.1.as_str()), (*num, *den), "{text}");
        }
    }

    #[test]
    fn as_students_type_them() {
        let hanging = ("-0.06s", "0.0132s^3 + 0.0024s^2 + 0.412s + 0.0589");
        check(&[
            ("-0.06s / (0.0132s^3 + 0.0024s^2 + 0.412s + 0.0589)", hanging.0, hanging.1),
            ("−0.06·s/[0.0132·s³ + 0.0024·s² + 0.412·s + 0.0589]", hanging.0, hanging.1),
            ("-0.06*s/(0.0132*s**3+0.0024*s**2+0.412*s+0.0589)", hanging.0, hanging.1),
            ("\\frac{-0.06 s}{0.0132 s^{3} + 0.0024 s^2 + 0.412 s + 0.0589}", hanging.0, hanging.1),
            ("-0.06𝑠/(0.0132𝑠^3+0.0024𝑠²+0.412𝑠+0.0589)", hanging.0, hanging.1),
            ("2e-3s", "0.002s", "1"),
            ("2(s+1)(s - 1)", "2s^2 - 2", "1"),
            ("1/(s+1)^2", "1", "s^2 + 2s + 1"),
            ("s^2/s", "s^2", "s"),
            ("s⁻¹", "1", "s"),
            ("1/s + 1/(s+1)", "2s + 1", "s^2 + s"),
            ("1/(s+1) - 3/(s+1)", "-2", "s + 1"),
            ("(s/2)/(s/4 + 1)", "0.5s", "0.25s + 1"),
            ("sqrt(4)/s", "2", "s"),
            ("4^0.5 s", "2s", "1"),
            ("1/(1/(s+1))", "s + 1", "1"),
            ("0/(s+1)", "0", "s + 1"),
            ("(s+1)^0", "1", "1"),
            ("5", "5", "1"),
        ]);
    }

    #[test]
    fn letters_are_the_parameters() {
        check(&[(
            "-m*l*s/((M+m)*(I+m*l^2)*s^3 - (m*l)^2*s^3 + b*(I + m*l^2)*s^2 + (M+m)*m*g*l*s + b*m*g*l)",
            "-0.06s",
            "0.0132s^3 + 0.0024s^2 + 0.41202s + 0.05886",
        )]);
    }

    #[track_caller]
    fn check_errors(rows: &[(&str, &str, &str)]) {
        for (text, message, help) in rows {
            let e = read(text).expect_err(text);
            assert!(e.message.contains(message), "{text}: {}", e.message);
            assert!(e.help.as_deref().unwrap_or("").contains(help), "{text}: {:?}", e.help);
            assert!(e.start <= e.end && e.end <= text.len(), "{text}: {}..{}", e.start, e.end);
        }
    }

    #[test]
    fn what_cannot_be_read_says_how_to_write_it() {
        check_errors(&[
            ("", "no formula", ""),
            ("0,0132s^3", "comma", "`0.0132`"),
            ("s，1", "`,` has no meaning", ""),
            ("1,000s", "comma", "`1000` for thousands"),
            ("2e-3s + z", "`z` is not a name", "the names are `s`"),
            ("mls", "`mls`", "did you mean `m*l*s`?"),
            ("s2 + 1", "`s2`", "did you mean `s^2`?"),
            ("0.0132s 3", "right after a factor", "`^`"),
            ("2 3", "two numbers", "operator"),
            ("1/2s", "two ways", "parentheses"),
            ("s/(s+1)(s+2)", "two ways", "parentheses"),
            ("1/0", "zero", ""),
            ("1/(s - s)", "zero", ""),
            ("sin(s)", "`sin`", ""),
            ("s^s", "power", ""),
            ("s^0.5", "whole power", ""),
            ("sin^2(s)", "power before its argument", "sin(x)^2"),
            ("sqrt(2)s", "no exact value", "decimal"),
            ("(s+1", "never closed", ""),
            ("s+1)", "closes nothing", ""),
            ("s*/2", "missing between `*` and `/`", ""),
            ("s+", "breaks off after `+`", ""),
            ("= s", "cannot begin with `=`", ""),
            ("s = 1", "`=`", ""),
            ("1.2.3", "two decimal points", ""),
            ("s $ 1", "`$` has no meaning", ""),
            ("\u{1b}[31m", "\\u{1b}", ""),
            ("s'", "primed", ""),
        ]);
    }

    /// Multiplied out, any of these would take minutes or all memory.
    #[test]
    fn hostile_sizes_are_refused() {
        for text in [
            "(s+1)^99999",
            "(s+1)^-99999",
            "((2^999)^999)",
            "2^99999999999999999999",
            "1e400^9",
            "(1e-400+s)^60",
            &"(".repeat(100_000),
            &"(".repeat(3_000),
            &"-".repeat(3_000),
            &"2^".repeat(1_500),
            &"s+".repeat(1_900),
            &"sin(".repeat(900),
            &"(s+1)*".repeat(600),
            &"1/(s+1.234567)^60 + ".repeat(190),
            &format!("{}1", "(0.777777s+1.234567)^30*(0.7s+1.2)^30 + ".repeat(90)),
            &format!("1{}", "⁹".repeat(1_000)),
        ] {
            let refused = read(text).expect_err("too large");
            assert!(refused.message.len() < 300);
        }
        assert!(read("1^99999999999 + (-1)^3").is_ok());
    }
}
