use super::ModelError;
use crate::algebra::{Expression, Function, NodeKind, to_f64};
use std::f64::consts::PI;

/// An expression made ready to be evaluated many times: no names are looked up any more, constants are worked out.
#[derive(Clone, Debug)]
pub(super) struct Program {
    steps: Vec<Step>,
    /// Whether sin π is 0.
    snaps: bool,
}

/// What a name stands for.
#[derive(Clone, Copy, Debug)]
pub(super) enum Meaning {
    Constant(f64),
    /// A place in the values given to [`Program::run`].
    Slot(usize),
}

/// One step on a stack of numbers.
#[derive(Clone, Copy, Debug)]
enum Step {
    Push(f64),
    Load(usize),
    Negate,
    Add,
    Subtract,
    Multiply,
    Divide,
    WholePower(i32),
    Power,
    Call(Function),
    /// What is nothing but the rounding of an angle becomes 0.
    Snap,
}

/// A sin or cos below this is 0.
const NOTHING: f64 = 1e-12;

impl Program {
    /// `meaning` tells what each name, with that many primes, stands for.
    pub fn new(
        expression: &Expression,
        meaning: &dyn Fn(&str, u8) -> Option<Meaning>,
    ) -> Result<Self, ModelError> {
        let mut program = Self { steps: Vec::new(), snaps: false };
        program.append(expression, meaning)?;
        Ok(program)
    }

    /// The same, but sin π is 0 and not 1.2e-16: for telling what vanishes from what does not.
    pub fn with_zeros(
        expression: &Expression,
        meaning: &dyn Fn(&str, u8) -> Option<Meaning>,
    ) -> Result<Self, ModelError> {
        let mut program = Self { steps: Vec::new(), snaps: true };
        program.append(expression, meaning)?;
        Ok(program)
    }

    /// The value; NaN or infinite outside a function's domain. `stack` is only working space.
    pub fn run(&self, values: &[f64], stack: &mut Vec<f64>) -> f64 {
        stack.clear();
        for step in &self.steps {
            step.take(values, stack);
        }
        stack.pop().unwrap_or(f64::NAN)
    }

    fn append(
        &mut self,
        node: &Expression,
        meaning: &dyn Fn(&str, u8) -> Option<Meaning>,
    ) -> Result<(), ModelError> {
        let start = self.steps.len();
        let operation = match &node.kind {
            NodeKind::Number(value) => Step::Push(to_f64(value)),
            NodeKind::Pi => Step::Push(PI),
            NodeKind::Symbol { name, primes } => match meaning(name, *primes) {
                Some(Meaning::Constant(value)) => Step::Push(value),
                Some(Meaning::Slot(slot)) => Step::Load(slot),
                None => {
                    return Err(ModelError::NoValue {
                        name: format!("{name}{}", "'".repeat(usize::from(*primes))),
                    });
                }
            },
            NodeKind::Negate(_) => Step::Negate,
            NodeKind::Add(..) => Step::Add,
            NodeKind::Subtract(..) => Step::Subtract,
            NodeKind::Multiply(..) => Step::Multiply,
            NodeKind::Divide(..) => Step::Divide,
            NodeKind::Power(..) => Step::Power,
            NodeKind::Call(function, _) => Step::Call(*function),
        };
        for child in node.children() {
            self.append(child, meaning)?;
        }
        let operation = match (operation, self.steps.last()) {
            (Step::Power, Some(Step::Push(n))) if n.fract() == 0.0 && n.abs() <= 64.0 => {
                let n = *n as i32;
                self.steps.pop();
                Step::WholePower(n)
            }
            (operation, _) => operation,
        };
        let constant = self.steps[start..].iter().all(|step| matches!(step, Step::Push(_)));
        self.steps.push(operation);
        if self.snaps && matches!(operation, Step::Call(Function::Sin | Function::Cos | Function::Tan)) {
            self.steps.push(Step::Snap);
        }
        if constant && !matches!(operation, Step::Load(_)) {
            let mut stack = Vec::new();
            self.steps.drain(start..).for_each(|step| step.take(&[], &mut stack));
            self.steps.extend(stack.pop().map(Step::Push));
        }
        Ok(())
    }
}

impl Step {
    fn take(self, values: &[f64], stack: &mut Vec<f64>) {
        let mut top = || stack.pop().unwrap_or(f64::NAN);
        let value = match self {
            Self::Push(value) => value,
            Self::Load(slot) => values.get(slot).copied().unwrap_or(f64::NAN),
            Self::Negate => -top(),
            Self::WholePower(n) => top().powi(n),
            Self::Call(function) => function.apply(top()),
            Self::Snap => {
                let value = top();
                if value.abs() < NOTHING { 0.0 } else { value }
            }
            Self::Add | Self::Subtract | Self::Multiply | Self::Divide | Self::Power => {
                let (right, left) = (top(), top());
                match self {
                    Self::Add => left + right,
                    Self::Subtract => left - right,
                    Self::Multiply => left * right,
                    Self::Divide => left / right,
                    _ => left.powf(right),
                }
            }
        };
        stack.push(value);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_same_as_the_tree() {
        let values = [0.7, -1.3];
        for text in [
            "2*x - 3*v/4",
            "(M + 1)*cos(x) - v^2*sin(x)",
            "-x^2 + 2^-2 + M^0.5",
            "x^v",
            "x^M^2",
            "exp(-abs(v))*sqrt(M) + sign(v)*tanh(x) + pi",
            "3",
            "(x)",
        ] {
            let tree = Expression::parse(text).unwrap();
            let program = Program::new(&tree, &|name, _| match name {
                "x" => Some(Meaning::Slot(0)),
                "v" => Some(Meaning::Slot(1)),
                _ => Some(Meaning::Constant(2.5)),
            });
            let lookup = |name: &str, _: u8| match name {
                "x" => Some(values[0]),
                "v" => Some(values[1]),
                _ => Some(2.5),
            };
            let (found, expected) =
                (program.unwrap().run(&values, &mut Vec::new()), tree.eval_f64(&lookup).unwrap());
            assert!((found - expected).abs() <= 1e-15 * expected.abs(), "{text}: {found}, {expected}");
        }
    }

    #[test]
    fn constants_are_worked_out_before() {
        let tree = Expression::parse("(M + m)*2^3*sin(pi/2)*x").unwrap();
        let program = Program::new(&tree, &|name, _| {
            Some(if name == "x" { Meaning::Slot(0) } else { Meaning::Constant(0.5) })
        });
        assert_eq!(program.unwrap().steps.len(), 3);
    }

    #[test]
    fn what_vanishes_is_zero_when_asked_for() {
        let tree = Expression::parse("k*sin(x) + cos(x/2) + tan(pi)").unwrap();
        let meaning =
            |name: &str, _: u8| Some(if name == "x" { Meaning::Slot(0) } else { Meaning::Constant(3.0) });
        let run = |program: Program| program.run(&[PI], &mut Vec::new());
        assert_eq!(run(Program::with_zeros(&tree, &meaning).unwrap()), 0.0);
        assert_ne!(run(Program::new(&tree, &meaning).unwrap()), 0.0);
    }

    #[test]
    fn a_name_without_meaning() {
        let tree = Expression::parse("x''*k").unwrap();
        let error = Program::new(&tree, &|name, _| (name == "k").then_some(Meaning::Constant(1.0)));
        assert_eq!(error.unwrap_err(), ModelError::NoValue { name: "x''".to_owned() });
    }
}
