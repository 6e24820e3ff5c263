use super::Rational;

/// A formula as a tree; each node knows the bytes of the text it came from.
#[derive(Clone, Debug, PartialEq)]
pub struct Expression {
    pub kind: NodeKind,
    /// Byte offsets `start..end` into the parsed text.
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
