use super::sheet::{AnswerSheet, FieldLetters};
use crate::algebra::{Expression, Function, NodeKind, Rational};
use std::collections::BTreeMap;

/// The letters that may stand in one field's formula, and how they may be spelled.
pub(super) struct Letters {
    /// By the lab's own name, with the lab's value.
    pub symbols: BTreeMap<String, Rational>,
    also: BTreeMap<String, String>,
}

impl Letters {
    pub fn new(sheet: &AnswerSheet, path: &str) -> Self {
        let none = FieldLetters::default();
        let own = sheet.letters.get(path).unwrap_or(&none);
        let mut symbols = own.symbols.clone();
        symbols.extend(sheet.symbols.clone());
        let mut also = own.also.clone();
        also.extend(sheet.also.clone());
        also.retain(|spelling, _| !symbols.contains_key(spelling));
        Self { symbols, also }
    }

    /// The formula with the lab's own names for its letters.
    ///
    /// `e^x` is exp(x) where `e` is no letter.
    pub fn named(&self, formula: Expression) -> Expression {
        let is_e =
            |node: &Expression| matches!(&node.kind, NodeKind::Symbol { name, primes: 0 } if name == "e");
        let mut formula = match self.known("e") {
            Some(_) => formula,
            None => formula.replaced(&|node| match &node.kind {
                NodeKind::Power(base, power) if is_e(base) => {
                    let kind = NodeKind::Call(Function::Exp, Box::new(self.named((**power).clone())));
                    Some(Expression { kind, start: node.start, end: node.end })
                }
                _ => None,
            }),
        };
        self.rename(&mut formula);
        formula
    }

    fn rename(&self, node: &mut Expression) {
        match &mut node.kind {
            NodeKind::Symbol { name, .. } => {
                if let Some(known) = self.known(name) {
                    *name = known;
                }
            }
            NodeKind::Number(_) | NodeKind::Pi => {}
            NodeKind::Negate(a) | NodeKind::Call(_, a) => self.rename(a),
            NodeKind::Add(a, b)
            | NodeKind::Subtract(a, b)
            | NodeKind::Multiply(a, b)
            | NodeKind::Divide(a, b)
            | NodeKind::Power(a, b) => {
                self.rename(a);
                self.rename(b);
            }
        }
    }

    /// The lab's name of what a student wrote: as it is, as the lab allows besides, without `_`, and with other capitals where
    /// only one letter can be meant. `s` stays the variable.
    fn known(&self, name: &str) -> Option<String> {
        if self.symbols.contains_key(name) {
            return Some(name.to_owned());
        }
        if let Some(known) = self.also.get(name) {
            return Some(known.clone());
        }
        if name.eq_ignore_ascii_case("s") {
            return None;
        }
        let folds: [fn(&str) -> String; 2] = [|n| n.replace('_', ""), |n| n.replace('_', "").to_lowercase()];
        for fold in folds {
            let wanted = fold(name);
            let own = self.symbols.keys().filter(|known| fold(known) == wanted);
            let also =
                self.also.iter().filter(|(spelling, _)| fold(spelling) == wanted).map(|(_, known)| known);
            let mut found: Vec<&String> = own.chain(also).collect();
            found.sort();
            found.dedup();
            match found.as_slice() {
                [] => {}
                [one] => return Some((*one).clone()),
                _ => return None,
            }
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_are_known_by_many_spellings() {
        let symbols =
            ["M", "m", "J_m", "K", "theta_0", "omega_n", "b"].map(|n| (n.to_owned(), Rational::ONE));
        let sheet = AnswerSheet {
            symbols: symbols.into(),
            also: [("K_t".to_owned(), "K".to_owned())].into(),
            ..AnswerSheet::default()
        };
        let letters = Letters::new(&sheet, "field");
        for (typed, known) in [
            ("M", "M"),
            ("m", "m"),
            ("Jm", "J_m"),
            ("J_m", "J_m"),
            ("J_{m}", "J_m"),
            ("Jₘ", "J_m"),
            ("jm", "J_m"),
            ("Kt", "K"),
            ("K_t", "K"),
            ("k", "K"),
            ("θ₀", "theta_0"),
            (r"\theta_0", "theta_0"),
            (r"\theta_{0}", "theta_0"),
            ("Theta0", "theta_0"),
            ("ω_n", "omega_n"),
            ("B", "b"),
            ("s", "s"),
            ("q", "q"),
            ("M e^{-b s} + e^x", "M*exp(-b*s) + exp(x)"),
        ] {
            let read = Expression::parse_typed(typed).unwrap_or_else(|e| panic!("{typed}: {e}"));
            assert_eq!(letters.named(read).to_string(), known, "{typed}");
        }
    }
}
