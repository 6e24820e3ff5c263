use super::super::Rational;
use super::{Expression, NodeKind, simplify};

/// Trees put together by hand: they come from no text, so their nodes stand at 0..0.
impl Expression {
    pub fn of_number(value: Rational) -> Self {
        Self::new(NodeKind::Number(value), 0, 0)
    }

    /// A name, so many times differentiated by time.
    pub fn of_symbol(name: &str, primes: u8) -> Self {
        Self::new(NodeKind::Symbol { name: name.to_owned(), primes }, 0, 0)
    }

    /// self + other; a 0 is left out, numbers are added, and a negative summand is subtracted.
    pub fn plus(self, other: Self) -> Self {
        match (simplify::value(&self), other.without_sign()) {
            (None, Some(size)) => simplify::subtract(self, size, &nowhere()),
            _ => simplify::add(self, other, &nowhere()),
        }
    }

    /// −self where self begins with a minus.
    fn without_sign(&self) -> Option<Self> {
        match &self.kind {
            NodeKind::Number(value) if *value < Rational::ZERO => Some(Self::of_number(-value)),
            NodeKind::Negate(a) => Some((**a).clone()),
            NodeKind::Multiply(a, b) => Some(a.without_sign()?.times((**b).clone())),
            NodeKind::Divide(a, b) => Some(a.without_sign()?.over((**b).clone())),
            _ => None,
        }
    }

    /// self · other; a 1 is left out, numbers are multiplied.
    pub fn times(self, other: Self) -> Self {
        simplify::multiply(self, other, &nowhere())
    }

    /// self / other; a 1 is left out, numbers are divided.
    pub fn over(self, other: Self) -> Self {
        simplify::divide(self, other, &nowhere())
    }

    /// −self
    pub fn negated(self) -> Self {
        simplify::negate(self, &nowhere())
    }

    /// selfⁿ
    pub fn to_power(self, n: usize) -> Self {
        simplify::power(self, Self::of_number(Rational::from(n)), &nowhere())
    }

    /// The sum of all, 0 of none: a tree no higher than need be, so that many summands do no harm.
    pub fn sum(mut terms: Vec<Self>) -> Self {
        match terms.len() {
            0 => Self::of_number(Rational::ZERO),
            1 => terms.remove(0),
            n => {
                let rest = terms.split_off(n / 2);
                Self::sum(terms).plus(Self::sum(rest))
            }
        }
    }

    /// The same tree with other nodes where `with` has one; what is below a new node stays as it is.
    pub fn replaced(&self, with: &dyn Fn(&Self) -> Option<Self>) -> Self {
        if let Some(new) = with(self) {
            return new;
        }
        let of = |a: &Self| Box::new(a.replaced(with));
        let kind = match &self.kind {
            NodeKind::Number(_) | NodeKind::Pi | NodeKind::Symbol { .. } => self.kind.clone(),
            NodeKind::Negate(a) => NodeKind::Negate(of(a)),
            NodeKind::Add(a, b) => NodeKind::Add(of(a), of(b)),
            NodeKind::Subtract(a, b) => NodeKind::Subtract(of(a), of(b)),
            NodeKind::Multiply(a, b) => NodeKind::Multiply(of(a), of(b)),
            NodeKind::Divide(a, b) => NodeKind::Divide(of(a), of(b)),
            NodeKind::Power(a, b) => NodeKind::Power(of(a), of(b)),
            NodeKind::Call(function, a) => NodeKind::Call(*function, of(a)),
        };
        Self::new(kind, self.start, self.end)
    }

    /// Nodes from here to the deepest leaf: 1 for a leaf.
    pub fn height(&self) -> usize {
        1 + self.children().map(Self::height).max().unwrap_or(0)
    }
}

fn nowhere() -> Expression {
    Expression::new(NodeKind::Number(Rational::ZERO), 0, 0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_does_not_count_is_left_out() {
        let number = |n: i64| Expression::of_number(Rational::from(n));
        let k = || Expression::of_symbol("k", 0);
        let shown = |e: Expression| e.to_string();
        assert_eq!(shown(number(0).plus(k()).times(number(1))), "k");
        assert_eq!(shown(number(2).times(number(3)).plus(k().over(number(1)))), "6 + k");
        assert_eq!(shown(k().to_power(2).times(number(-1))), "-k^2");
        assert_eq!(shown(Expression::of_symbol("z", 2)), "z''");
        assert_eq!(shown(k().plus(number(-3).times(k()))), "k - 3*k");
        assert_eq!(shown(k().plus(number(-3))), "k - 3");
        assert_eq!(Expression::sum(vec![k(); 64]).height(), 7);
        assert_eq!(shown(Expression::sum(vec![])), "0");
        assert_eq!(k().over(number(0)).to_string(), "k/0");
    }
}
