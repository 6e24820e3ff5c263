use super::super::Rational;
use super::simplify::{add, divide, multiply, negate, number, one, power, subtract, value, zero};
use super::{Expression, Function, NodeKind};

impl Expression {
    /// The partial derivative by `name` with that many primes, other derivatives of it held fixed; simplified.
    ///
    /// |u| becomes sign(u), and sign(u) becomes 0/u, which has no value where u is 0.
    pub fn differentiate(&self, name: &str, primes: u8) -> Self {
        let d = |node: &Expression| node.differentiate(name, primes);
        let at = self;
        match &self.kind {
            NodeKind::Number(_) | NodeKind::Pi => zero(at),
            NodeKind::Symbol { name: n, primes: p } => {
                if n == name && *p == primes {
                    one(at)
                } else {
                    zero(at)
                }
            }
            NodeKind::Negate(a) => negate(d(a), at),
            NodeKind::Add(a, b) => add(d(a), d(b), at),
            NodeKind::Subtract(a, b) => subtract(d(a), d(b), at),
            NodeKind::Multiply(a, b) => {
                let left = multiply(d(a), (**b).clone(), at);
                let right = multiply((**a).clone(), d(b), at);
                add(left, right, at)
            }
            NodeKind::Divide(a, b) => {
                let (da, db) = (d(a), d(b));
                if value(&db).is_some_and(Rational::is_zero) {
                    return divide(da, (**b).clone(), at);
                }
                let top = subtract(multiply(da, (**b).clone(), at), multiply((**a).clone(), db, at), at);
                divide(top, power((**b).clone(), number(Rational::from(2), at), at), at)
            }
            NodeKind::Power(a, b) => {
                let (da, db) = (d(a), d(b));
                let base_moves = multiply(
                    multiply((**b).clone(), power((**a).clone(), subtract((**b).clone(), one(b), b), at), at),
                    da,
                    at,
                );
                if value(&db).is_some_and(Rational::is_zero) {
                    return base_moves;
                }
                let exponent_moves = multiply(multiply(self.clone(), call(Function::Ln, a), at), db, at);
                add(base_moves, exponent_moves, at)
            }
            NodeKind::Call(function, a) => {
                let inner = d(a);
                if value(&inner).is_some_and(Rational::is_zero) {
                    return inner;
                }
                outer(*function, a, inner, self)
            }
        }
    }
}

/// The chain rule: `inner` is the derivative of the argument `u`.
fn outer(function: Function, u: &Expression, inner: Expression, at: &Expression) -> Expression {
    let square = |node: Expression| power(node, number(Rational::from(2), at), at);
    let u_squared = || square(u.clone());
    match function {
        Function::Sin => multiply(call(Function::Cos, u), inner, at),
        Function::Cos => negate(multiply(call(Function::Sin, u), inner, at), at),
        Function::Tan => divide(inner, square(call(Function::Cos, u)), at),
        Function::Asin => divide(inner, sqrt(subtract(one(at), u_squared(), at)), at),
        Function::Acos => negate(divide(inner, sqrt(subtract(one(at), u_squared(), at)), at), at),
        Function::Atan => divide(inner, add(one(at), u_squared(), at), at),
        Function::Sinh => multiply(call(Function::Cosh, u), inner, at),
        Function::Cosh => multiply(call(Function::Sinh, u), inner, at),
        Function::Tanh => divide(inner, square(call(Function::Cosh, u)), at),
        Function::Exp => multiply(call(Function::Exp, u), inner, at),
        Function::Ln => divide(inner, u.clone(), at),
        Function::Sqrt => {
            let twice = multiply(number(Rational::from(2), at), call(Function::Sqrt, u), at);
            divide(inner, twice, at)
        }
        Function::Abs => multiply(call(Function::Sign, u), inner, at),
        Function::Sign => {
            Expression::new(NodeKind::Divide(Box::new(zero(at)), Box::new(u.clone())), at.start, at.end)
        }
    }
}

fn call(function: Function, argument: &Expression) -> Expression {
    let kind = NodeKind::Call(function, Box::new(argument.clone()));
    Expression::new(kind, argument.start, argument.end)
}

fn sqrt(argument: Expression) -> Expression {
    call(Function::Sqrt, &argument)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check(rows: &[(&str, &str, u8, &str)]) {
        for (text, name, primes, expected) in rows {
            let derivative = Expression::parse(text).unwrap().differentiate(name, *primes);
            assert_eq!(derivative.to_string(), *expected, "d({text})/d{name}");
        }
    }

    #[test]
    fn rules() {
        check(&[
            ("3", "x", 0, "0"),
            ("x", "x", 0, "1"),
            ("x'", "x", 0, "0"),
            ("a*x + b", "x", 0, "a"),
            ("x^3", "x", 0, "3*x^2"),
            ("x*y", "x", 0, "y"),
            ("a/x", "x", 0, "-(a/x^2)"),
            ("x/a", "x", 0, "1/a"),
            ("sin(2*x)", "x", 0, "2*cos(2*x)"),
            ("cos(x)", "x", 0, "-sin(x)"),
            ("sqrt(h)", "h", 0, "1/(2*sqrt(h))"),
            ("exp(-x)", "x", 0, "-exp(-x)"),
            ("abs(x)*x", "x", 0, "sign(x)*x + abs(x)"),
            ("sign(x)", "x", 0, "0/x"),
            ("2^x", "x", 0, "2^x*ln(2)"),
            ("m*l*theta'^2*sin(theta)", "theta", 1, "m*l*(2*theta')*sin(theta)"),
            ("m*l*theta'^2*sin(theta)", "theta", 0, "m*l*theta'^2*cos(theta)"),
            ("(M + m)*x''", "x", 2, "M + m"),
        ]);
    }

    #[test]
    fn agrees_with_central_differences() {
        let formulas = [
            "sin(x)*cos(x)/(2 + tan(x/3))",
            "asin(x/3) - acos(x/4) + atan(x)",
            "sinh(x) + cosh(x)*tanh(x)",
            "exp(-x^2/2)*ln(3 + x)",
            "sqrt(2 + x)*abs(x - 2)",
            "x^x + (1 + x)^(1/3) - x^-2",
            "-x^2/(x*(x + 1) - 3)",
        ];
        for text in formulas {
            let f = Expression::parse(text).unwrap();
            let slope = f.differentiate("x", 0);
            for x in [0.31, 0.77, 1.2] {
                let at = |x: f64| f.eval_f64(&|_: &str, _| Some(x)).unwrap();
                let h = 1e-5;
                let numeric = (at(x + h) - at(x - h)) / (2.0 * h);
                let exact = slope.eval_f64(&|_: &str, _| Some(x)).unwrap();
                assert!(
                    (exact - numeric).abs() < 1e-8 * (1.0 + exact.abs()),
                    "{text} at {x}: {exact}, {numeric}"
                );
            }
        }
    }
}
