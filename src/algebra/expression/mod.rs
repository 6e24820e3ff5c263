//! Formulas as trees: read, differentiated, evaluated, printed.

mod build;
mod differentiate;
mod evaluate;
mod lexer;
mod mathml;
mod names;
mod parser;
mod rational_function;
mod simplify;
mod text;

use super::Rational;
pub use names::SymbolUse;

/// A formula as a tree; each node knows the bytes of the text it came from.
///
/// Trees from [`Expression::parse`] are at most 200 nodes high, so recursion over them is safe.
#[derive(Clone, Debug, PartialEq)]
pub struct Expression {
    pub kind: NodeKind,
    /// Byte offsets `start..end` into the parsed text, parentheses around the node included.
    pub start: usize,
    pub end: usize,
}

#[derive(Clone, Debug, PartialEq)]
pub enum NodeKind {
    Number(Rational),
    Pi,
    /// A name, and how many times it is differentiated by time: `x''` has 2 primes.
    Symbol {
        name: String,
        primes: u8,
    },
    Negate(Box<Expression>),
    Add(Box<Expression>, Box<Expression>),
    Subtract(Box<Expression>, Box<Expression>),
    Multiply(Box<Expression>, Box<Expression>),
    Divide(Box<Expression>, Box<Expression>),
    Power(Box<Expression>, Box<Expression>),
    Call(Function, Box<Expression>),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Function {
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Sinh,
    Cosh,
    Tanh,
    Exp,
    Ln,
    Sqrt,
    Abs,
    Sign,
}

/// Why a text is not a formula: where (bytes), what was found, what was wanted.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct ExpressionError {
    pub start: usize,
    pub end: usize,
    pub message: String,
    pub help: Option<String>,
}

impl Expression {
    pub(super) fn new(kind: NodeKind, start: usize, end: usize) -> Self {
        Self { kind, start, end }
    }

    /// The operands, left to right.
    pub fn children(&self) -> impl Iterator<Item = &Expression> {
        let (first, second) = match &self.kind {
            NodeKind::Number(_) | NodeKind::Pi | NodeKind::Symbol { .. } => (None, None),
            NodeKind::Negate(a) | NodeKind::Call(_, a) => (Some(&**a), None),
            NodeKind::Add(a, b)
            | NodeKind::Subtract(a, b)
            | NodeKind::Multiply(a, b)
            | NodeKind::Divide(a, b)
            | NodeKind::Power(a, b) => (Some(&**a), Some(&**b)),
        };
        first.into_iter().chain(second)
    }
}

impl Function {
    const ALL: [Self; 14] = [
        Self::Sin,
        Self::Cos,
        Self::Tan,
        Self::Asin,
        Self::Acos,
        Self::Atan,
        Self::Sinh,
        Self::Cosh,
        Self::Tanh,
        Self::Exp,
        Self::Ln,
        Self::Sqrt,
        Self::Abs,
        Self::Sign,
    ];

    /// As it is written in a formula: `sin`, `asin`, `sqrt`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Sin => "sin",
            Self::Cos => "cos",
            Self::Tan => "tan",
            Self::Asin => "asin",
            Self::Acos => "acos",
            Self::Atan => "atan",
            Self::Sinh => "sinh",
            Self::Cosh => "cosh",
            Self::Tanh => "tanh",
            Self::Exp => "exp",
            Self::Ln => "ln",
            Self::Sqrt => "sqrt",
            Self::Abs => "abs",
            Self::Sign => "sign",
        }
    }

    /// The function of a name, usual other spellings included: `arcsin`, `sgn`.
    pub fn named(name: &str) -> Option<Self> {
        match name {
            "arcsin" => Some(Self::Asin),
            "arccos" => Some(Self::Acos),
            "arctan" => Some(Self::Atan),
            "sgn" => Some(Self::Sign),
            _ => Self::ALL.into_iter().find(|f| f.name() == name),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    /// The highest trees the parser lets through, worked on with half a thread's usual stack.
    #[test]
    fn the_highest_trees_fit_a_small_stack() {
        let work = || {
            for text in [
                format!("{}s", "s+".repeat(198)),
                format!("{}s{}", "(s+1)*(".repeat(48), ")".repeat(48)),
                format!("{}s{}", "1/(s+".repeat(32), ")".repeat(32)),
                format!("{}s{}", "sin(".repeat(97), ")".repeat(97)),
                format!("{}s", "-".repeat(97)),
                format!("{}s", "s^".repeat(97)),
            ] {
                let tree = Expression::parse_typed(&text).unwrap_or_else(|e| panic!("{text}: {e}"));
                let slope = tree.differentiate("s", 0);
                assert!(!slope.to_mathml().is_empty() && !slope.to_string().is_empty());
                assert!(slope.eval_f64(&|_: &str, _| Some(0.5)).is_ok());
                let _ = tree.rational_function("s", &BTreeMap::new());
            }
        };
        let thread = std::thread::Builder::new().stack_size(1024 * 1024).spawn(work);
        thread.unwrap().join().unwrap();
    }
}
