use super::super::clip::clip;
use super::{Expression, ExpressionError, NodeKind};
use crate::names::nearest;

/// A name in a formula, and where it stands.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SymbolUse {
    pub name: String,
    pub primes: u8,
    pub start: usize,
    pub end: usize,
}

impl Expression {
    /// Every use of a name, in the order of the text.
    pub fn symbols(&self) -> Vec<SymbolUse> {
        let mut found = Vec::new();
        collect(self, &mut found);
        found
    }

    /// Errors at the first name that is not among `declared`, with the nearest one that is.
    pub fn check_names(&self, declared: &[&str]) -> Result<(), ExpressionError> {
        match self.symbols().into_iter().find(|symbol| !declared.contains(&symbol.name.as_str())) {
            None => Ok(()),
            Some(symbol) => Err(unknown(&symbol.name, symbol.start, symbol.end, declared)),
        }
    }
}

fn collect(node: &Expression, found: &mut Vec<SymbolUse>) {
    if let NodeKind::Symbol { name, primes } = &node.kind {
        found.push(SymbolUse { name: name.clone(), primes: *primes, start: node.start, end: node.end });
    }
    for child in node.children() {
        collect(child, found);
    }
}

/// The error about a name nobody declared.
pub(super) fn unknown(name: &str, start: usize, end: usize, declared: &[&str]) -> ExpressionError {
    let list: Vec<String> = declared.iter().map(|n| format!("`{n}`")).collect();
    let names = format!("the names are {}", list.join(", "));
    let meant = power_for(name, declared)
        .or_else(|| product_of(name, declared))
        .or_else(|| nearest(name, declared.iter().copied()).map(str::to_owned));
    let help = match meant {
        Some(meant) => format!("did you mean `{meant}`? {names}"),
        None if declared.is_empty() => "write numbers only".to_owned(),
        None => names,
    };
    let message = format!("`{}` is not a name we know", clip(name));
    ExpressionError { start, end, message, help: Some(help) }
}

/// `s2` → `s^2` when `s` is known.
fn power_for(name: &str, declared: &[&str]) -> Option<String> {
    let base = name.trim_end_matches(|c: char| c.is_ascii_digit());
    let exponent = &name[base.len()..];
    (declared.contains(&base) && !exponent.is_empty()).then(|| format!("{base}^{exponent}"))
}

/// `mls` → `m*l*s` when each is known.
fn product_of(name: &str, declared: &[&str]) -> Option<String> {
    let mut rest = name;
    let mut factors = Vec::new();
    while !rest.is_empty() {
        let fitting = declared.iter().filter(|d| !d.is_empty() && rest.starts_with(**d));
        let factor = fitting.max_by_key(|d| d.len())?;
        factors.push(*factor);
        rest = &rest[factor.len()..];
    }
    Some(factors.join("*"))
}
