use super::super::Rational;
use super::{Expression, NodeKind};
use dashu_int::UBig;
use std::fmt;

/// ASCII that [`Expression::parse`] reads back as the same tree.
impl fmt::Display for Expression {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.kind {
            NodeKind::Number(value) => f.write_str(&number_text(value)),
            NodeKind::Pi => f.write_str("pi"),
            NodeKind::Symbol { name, primes } => {
                write!(f, "{name}{}", "'".repeat(usize::from(*primes)))
            }
            NodeKind::Negate(a) => {
                f.write_str("-")?;
                operand(f, a, Level::Power)
            }
            NodeKind::Add(a, b) => binary(f, a, " + ", b, Level::Sum, Level::Product),
            NodeKind::Subtract(a, b) => binary(f, a, " - ", b, Level::Sum, Level::Product),
            NodeKind::Multiply(a, b) => binary(f, a, "*", b, Level::Product, Level::Power),
            NodeKind::Divide(a, b) => binary(f, a, "/", b, Level::Product, Level::Power),
            NodeKind::Power(a, b) => binary(f, a, "^", b, Level::Atom, Level::Sign),
            NodeKind::Call(function, a) => write!(f, "{}({a})", function.name()),
        }
    }
}

/// How tightly a printed node holds together, loosest first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Level {
    Sum,
    Product,
    Sign,
    Power,
    Atom,
}

impl Level {
    pub(super) fn of(node: &Expression) -> Self {
        match &node.kind {
            NodeKind::Add(..) | NodeKind::Subtract(..) => Self::Sum,
            NodeKind::Multiply(..) | NodeKind::Divide(..) => Self::Product,
            NodeKind::Negate(_) => Self::Sign,
            NodeKind::Power(..) => Self::Power,
            NodeKind::Number(value) if decimal(value).is_none() => Self::Product,
            NodeKind::Number(value) if *value < Rational::ZERO => Self::Sign,
            _ => Self::Atom,
        }
    }
}

fn binary(
    f: &mut fmt::Formatter<'_>,
    a: &Expression,
    sign: &str,
    b: &Expression,
    left: Level,
    right: Level,
) -> fmt::Result {
    operand(f, a, left)?;
    f.write_str(sign)?;
    operand(f, b, right)
}

/// In parentheses when it holds together less tightly than `least`.
fn operand(f: &mut fmt::Formatter<'_>, node: &Expression, least: Level) -> fmt::Result {
    if Level::of(node) < least { write!(f, "({node})") } else { write!(f, "{node}") }
}

/// The exact value: `0.0132`, `1e-9`, or `1/3` where no decimal ends.
pub(super) fn number_text(value: &Rational) -> String {
    decimal(value).unwrap_or_else(|| format!("{}/{}", value.numerator(), value.denominator()))
}

/// The exact decimal; `None` when it never ends.
fn decimal(value: &Rational) -> Option<String> {
    let mut rest = value.denominator().clone();
    let mut places = 0;
    for prime in [2u8, 5] {
        let prime = UBig::from(prime);
        let mut count = 0;
        while &rest % &prime == UBig::ZERO {
            rest /= &prime;
            count += 1;
        }
        places = places.max(count);
    }
    if rest != UBig::ONE {
        return None;
    }
    let scaled = value * Rational::from(UBig::from(10u8).pow(places));
    let digits = scaled.numerator().to_string();
    let (sign, digits) = digits.strip_prefix('-').map_or(("", digits.as_str()), |d| ("-", d));
    let significant = digits.trim_end_matches('0');
    let zeros = digits.len() - significant.len();
    let text = if (places == 0 && zeros > 12) || places > digits.len() + 6 {
        let exponent = digits.len() as isize - 1 - places as isize;
        match significant.split_at(1) {
            (first, "") => format!("{first}e{exponent}"),
            (first, rest) => format!("{first}.{rest}e{exponent}"),
        }
    } else if places == 0 {
        digits.to_owned()
    } else {
        let padded = format!("{digits:0>width$}", width = places + 1);
        let (whole, fraction) = padded.split_at(padded.len() - places);
        format!("{whole}.{fraction}")
    };
    Some(format!("{sign}{text}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[track_caller]
    fn check(rows: &[(&str, &str)]) {
        for (text, expected) in rows {
            assert_eq!(Expression::parse(text).unwrap().to_string(), *expected, "{text}");
        }
    }

    #[test]
    fn only_the_parentheses_that_count() {
        check(&[
            ("((a)+(b*c))", "a + b*c"),
            ("(a+b)*c", "(a + b)*c"),
            ("a-(b-c)", "a - (b - c)"),
            ("(a-b)-c", "a - b - c"),
            ("a/(b/c)", "a/(b/c)"),
            ("a/b/c", "a/b/c"),
            ("-x^2", "-x^2"),
            ("(-x)^2", "(-x)^2"),
            ("(2^3)^2", "(2^3)^2"),
            ("2^3^2", "2^3^2"),
            ("-2^-2", "-2^-2"),
            ("a*-b", "a*(-b)"),
            ("--a", "-(-a)"),
            ("0.0132*x''", "0.0132*x''"),
            ("1e-9 + 2e20", "1e-9 + 2e20"),
            ("12e-10 + 0.00000005*x + 340e20", "1.2e-9 + 5e-8*x + 3.4e22"),
            ("0.001*1500", "0.001*1500"),
            ("sin((x))", "sin(x)"),
        ]);
    }

    /// The same tree with every place 0.
    fn placeless(node: &Expression) -> Expression {
        let inner = |a: &Expression| Box::new(placeless(a));
        let kind = match &node.kind {
            NodeKind::Negate(a) => NodeKind::Negate(inner(a)),
            NodeKind::Add(a, b) => NodeKind::Add(inner(a), inner(b)),
            NodeKind::Subtract(a, b) => NodeKind::Subtract(inner(a), inner(b)),
            NodeKind::Multiply(a, b) => NodeKind::Multiply(inner(a), inner(b)),
            NodeKind::Divide(a, b) => NodeKind::Divide(inner(a), inner(b)),
            NodeKind::Power(a, b) => NodeKind::Power(inner(a), inner(b)),
            NodeKind::Call(f, a) => NodeKind::Call(*f, inner(a)),
            leaf => leaf.clone(),
        };
        Expression::new(kind, 0, 0)
    }

    fn tree() -> impl Strategy<Value = Expression> {
        let number = (0i64..100_000, 0i32..6).prop_map(|(n, places)| {
            NodeKind::Number(Rational::from(n) / Rational::from(10i64.pow(places as u32)))
        });
        let symbol = ("[a-d]|theta|x_1", 0u8..3).prop_map(|(name, primes)| NodeKind::Symbol { name, primes });
        let leaf = prop_oneof![number, symbol, Just(NodeKind::Pi)].prop_map(|k| Expression::new(k, 0, 0));
        leaf.prop_recursive(5, 40, 2, |inner| {
            (inner.clone(), inner, 0..8).prop_map(|(a, b, which)| {
                let (a, b) = (Box::new(a), Box::new(b));
                let kind = match which {
                    0 => NodeKind::Negate(a),
                    1 => NodeKind::Add(a, b),
                    2 => NodeKind::Subtract(a, b),
                    3 => NodeKind::Multiply(a, b),
                    4 => NodeKind::Divide(a, b),
                    5 => NodeKind::Power(a, b),
                    6 => NodeKind::Call(super::super::Function::Sin, a),
                    _ => NodeKind::Call(super::super::Function::Sqrt, a),
                };
                Expression::new(kind, 0, 0)
            })
        })
    }

    proptest! {
        #[test]
        fn what_is_printed_reads_back_the_same(tree in tree()) {
            let text = tree.to_string();
            let back = Expression::parse(&text).map_err(|e| TestCaseError::fail(format!("{text}: {e}")))?;
            prop_assert_eq!(placeless(&back), tree, "{}", text);
            let typed = Expression::parse_typed(&text).map_err(|e| TestCaseError::fail(format!("{text}: {e}")))?;
            prop_assert_eq!(typed, back);
        }

        #[test]
        fn hostile_text_is_refused_not_crashed(text in "\\PC{0,60}|[-+*/^() s2.,e'\\\\{}=]{0,60}") {
            let _ = Expression::parse(&text);
            let _ = Expression::parse_typed(&text);
            let _ = Expression::parse_equation(&text);
        }
    }

    /// U+FE68 and U+FF3C are backslashes of three bytes.
    #[test]
    fn wide_backslashes_are_passed_whole() {
        for text in ["\u{fe68}", "s\u{fe68}x", "2\u{ff3c}s"] {
            assert!(Expression::parse_typed(text).is_err(), "{text}");
        }
        let fraction = Expression::parse_typed("\u{fe68}frac{1}{s}").map(|tree| tree.to_string());
        assert_eq!(fraction.as_deref(), Ok("1/s"));
    }
}
