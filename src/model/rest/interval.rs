use crate::algebra::{Expression, Function, NodeKind, Rational, to_f64};
use crate::model::Exact;
use std::f64::consts::{FRAC_PI_2, PI};

/// All numbers of `low..=high`; NaN where a function is not defined.
///
/// Every operation holds all results of what its operands hold: sums, products, quotients and roots are rounded outward by one
/// unit in the last place, other functions by four, which is more than the mathematical library of any platform is off by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Interval {
    pub low: f64,
    pub high: f64,
}

const NOWHERE: Interval = Interval { low: f64::NAN, high: f64::NAN };

impl Interval {
    pub fn point(value: f64) -> Self {
        Self { low: value, high: value }
    }

    pub fn around(middle: f64, radius: f64) -> Self {
        Self { low: middle - radius, high: middle + radius }.wider(1)
    }

    /// What a value is: exactly, or within the rounding of its last place.
    pub fn of(value: &Exact) -> Self {
        let near = Self::point(value.to_f64());
        match value.as_rational() {
            Some(value) if is_whole_in_f64(value) => near,
            _ => near.wider(4),
        }
    }

    pub fn middle(self) -> f64 {
        self.low / 2.0 + self.high / 2.0
    }

    pub fn width(self) -> f64 {
        self.high - self.low
    }

    pub fn contains(self, value: f64) -> bool {
        self.low <= value && value <= self.high
    }

    /// Whether every number of it lies between the ends of `outer`, on none of them.
    pub fn inside(self, outer: Self) -> bool {
        outer.low < self.low && self.high < outer.high
    }

    fn wider(self, units: u32) -> Self {
        let mut wide = self;
        for _ in 0..units {
            wide = Self { low: wide.low.next_down(), high: wide.high.next_up() };
        }
        wide
    }

    pub fn negated(self) -> Self {
        Self { low: -self.high, high: -self.low }
    }

    pub fn plus(self, other: Self) -> Self {
        Self { low: self.low + other.low, high: self.high + other.high }.wider(1)
    }

    pub fn minus(self, other: Self) -> Self {
        self.plus(other.negated())
    }

    pub fn times(self, other: Self) -> Self {
        if self == Self::point(0.0) || other == Self::point(0.0) {
            return Self::point(0.0);
        }
        hull([self.low * other.low, self.low * other.high, self.high * other.low, self.high * other.high])
            .wider(1)
    }

    pub fn over(self, other: Self) -> Self {
        if !(other.low > 0.0 || other.high < 0.0) {
            return NOWHERE;
        }
        hull([self.low / other.low, self.low / other.high, self.high / other.low, self.high / other.high])
            .wider(1)
    }

    fn power(self, exponent: Self) -> Self {
        let n = exponent.low;
        if exponent == Self::point(n) && n.fract() == 0.0 && n.abs() <= 64.0 {
            return self.whole_power(n as i32);
        }
        if self.low.is_nan() || self.low <= 0.0 {
            return NOWHERE;
        }
        let corner = |base: f64, exponent: f64| base.powf(exponent);
        hull([
            corner(self.low, exponent.low),
            corner(self.low, exponent.high),
            corner(self.high, exponent.low),
            corner(self.high, exponent.high),
        ])
        .wider(4)
    }

    fn whole_power(self, n: i32) -> Self {
        if n < 0 {
            return Self::point(1.0).over(self.whole_power(-n));
        }
        if n == 0 {
            return Self::point(1.0);
        }
        // Even powers grow with the size, odd ones with the number; `powi` rounds by no more than a unit a factor.
        let base = if n % 2 == 0 { self.size() } else { self };
        Self { low: base.low.powi(n), high: base.high.powi(n) }.wider(n.unsigned_abs() + 2)
    }

    fn size(self) -> Self {
        if self.contains(0.0) {
            Self { low: 0.0, high: self.high.max(-self.low) }
        } else if self.high < 0.0 {
            self.negated()
        } else {
            self
        }
    }

    fn call(self, function: Function) -> Self {
        let ends = |f: fn(f64) -> f64| Self { low: f(self.low), high: f(self.high) };
        match function {
            // It grows between −π/2 and π/2, and near 0 loses no digit.
            Function::Sin if self.low >= -1.5 && self.high <= 1.5 => ends(f64::sin).wider(4),
            Function::Sin => self.minus(Self::point(FRAC_PI_2).wider(1)).cosine(),
            Function::Cos => self.cosine(),
            Function::Tan => {
                let cosine = self.cosine();
                if cosine.contains(0.0) || self.width() >= PI { NOWHERE } else { ends(f64::tan).wider(4) }
            }
            Function::Asin => ends(f64::asin).wider(4),
            Function::Acos => Self { low: self.high.acos(), high: self.low.acos() }.wider(4),
            Function::Atan => ends(f64::atan).wider(4),
            Function::Sinh => ends(f64::sinh).wider(4),
            Function::Cosh => {
                let size = self.size();
                Self { low: size.low.cosh(), high: size.high.cosh() }.wider(4)
            }
            Function::Tanh => ends(f64::tanh).wider(4),
            Function::Exp => ends(f64::exp).wider(4),
            Function::Ln => ends(f64::ln).wider(4),
            Function::Sqrt => ends(f64::sqrt).wider(1),
            Function::Abs => self.size(),
            Function::Sign => {
                let sign = |x: f64| Function::Sign.apply(x);
                ends(sign)
            }
        }
    }

    fn cosine(self) -> Self {
        if !self.low.is_finite() || !self.high.is_finite() {
            return NOWHERE;
        }
        // Far from 0 the multiples of pi are not told apart well enough.
        if self.width() >= 2.0 * PI || self.low.abs().max(self.high.abs()) > 1e6 {
            return Self { low: -1.0, high: 1.0 };
        }
        let ends = [self.low.cos(), self.high.cos()];
        let mut result = hull([ends[0], ends[1], ends[0], ends[1]]).wider(4);
        // An extremum at k·pi within it, or nearly so.
        let (from, to) = ((self.low / PI - 1e-9).ceil() as i64, (self.high / PI + 1e-9).floor() as i64);
        for k in from..=to {
            if k % 2 == 0 {
                result.high = 1.0;
            } else {
                result.low = -1.0;
            }
        }
        Self { low: result.low.max(-1.0), high: result.high.min(1.0) }
    }
}

/// The value of `expression` for all that the names hold; `None` for a name that `lookup` does not know.
pub(super) fn evaluate(
    expression: &Expression,
    lookup: &dyn Fn(&str, u8) -> Option<Interval>,
) -> Option<Interval> {
    let of = |child: &Expression| evaluate(child, lookup);
    Some(match &expression.kind {
        NodeKind::Number(value) => Interval::of(&Exact::rational(value.clone())),
        NodeKind::Pi => Interval::point(PI).wider(1),
        NodeKind::Symbol { name, primes } => lookup(name, *primes)?,
        NodeKind::Negate(a) => of(a)?.negated(),
        NodeKind::Add(a, b) => of(a)?.plus(of(b)?),
        NodeKind::Subtract(a, b) => of(a)?.minus(of(b)?),
        NodeKind::Multiply(a, b) => of(a)?.times(of(b)?),
        NodeKind::Divide(a, b) => of(a)?.over(of(b)?),
        NodeKind::Power(a, b) => of(a)?.power(of(b)?),
        NodeKind::Call(function, a) => of(a)?.call(*function),
    })
}

fn is_whole_in_f64(value: &Rational) -> bool {
    crate::algebra::from_f64(to_f64(value)).is_some_and(|held| held == *value)
}

/// From the least to the largest; nowhere when one is not a number.
fn hull(values: [f64; 4]) -> Interval {
    if values.iter().any(|value| value.is_nan()) {
        return NOWHERE;
    }
    Interval {
        low: values.into_iter().fold(f64::INFINITY, f64::min),
        high: values.into_iter().fold(f64::NEG_INFINITY, f64::max),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every value of `text` at points of an interval lies in what is computed for all of it, and that is no wider than needed.
    #[test]
    fn what_is_held_is_all_of_it() {
        #[track_caller]
        fn check(text: &str, low: f64, high: f64, most: f64) {
            let expression = Expression::parse(text).unwrap();
            let found = evaluate(&expression, &|_, _| Some(Interval { low, high })).unwrap();
            let (mut least, mut largest) = (f64::INFINITY, f64::NEG_INFINITY);
            for step in 0..=1000 {
                let x = low + (high - low) * f64::from(step) / 1000.0;
                let value = expression.eval_f64(&|_: &str, _: u8| Some(x)).unwrap();
                (least, largest) = (least.min(value), largest.max(value));
                assert!(found.contains(value), "{text} at {x}: {value} is not in {found:?}");
            }
            assert!(
                found.width() <= most * (largest - least) + 1e-9,
                "{text}: {found:?} for {least}..{largest}"
            );
        }
        check("x^2", -1.0, 2.0, 1.01);
        check("x^3", -2.0, 1.0, 1.01);
        check("x^-2", 1.0, 2.0, 1.01);
        check("x^1.5 + sqrt(x)", 0.5, 2.0, 1.01);
        check("sin(x)", 1.0, 2.0, 1.01);
        check("sin(x)", -7.0, 7.0, 1.01);
        check("cos(x)", 3.0, 3.5, 1.01);
        check("tan(x)", -1.0, 1.0, 1.01);
        // Each factor by itself takes all of its values.
        check("exp(-x)*tanh(x)", 0.5, 1.0, 20.0);
        check("1/(2 + x)", -1.0, 1.0, 1.01);
        check("abs(x) + cosh(x)", -1.0, 2.0, 1.01);
        check("asin(x) + acos(x)", -0.5, 0.5, f64::INFINITY);
        check("sign(x) + ln(x + 3) + atan(x) + sinh(x)", -1.0, 1.0, 1.01);
    }

    #[test]
    fn where_nothing_is_defined_nothing_is_held() {
        for text in ["1/x", "sqrt(x)", "ln(x)", "tan(pi/2 + x)", "x^0.5", "asin(x + 1.5)"] {
            let expression = Expression::parse(text).unwrap();
            let found = evaluate(&expression, &|_, _| Some(Interval { low: -0.5, high: 1.0 })).unwrap();
            assert!(
                !found.contains(0.0) && !found.inside(Interval { low: -1e9, high: 1e9 }),
                "{text}: {found:?}"
            );
        }
    }
}
