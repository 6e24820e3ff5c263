use super::equations::{Coordinate, Equation};
use super::{Model, ModelError};
use crate::algebra::{Expression, ExpressionError};

impl Model {
    /// Adds an output: `output` becomes a coordinate with the equation `name = formula`.
    ///
    /// `formula` may have coordinates, their derivatives as far as the equations go, inputs and parameters; no output.
    /// Errors: [`ModelError::Value`] of a text that is no such formula; [`ModelError::OutputOrder`]; names as in [`Model::new`].
    pub fn add_output(&mut self, output: Coordinate, formula: &str) -> Result<(), ModelError> {
        let name = output.name.clone();
        self.read_output(&name, formula)?;
        // Read with its left side, so that every node knows its place in the text that is shown.
        let text = format!("{name} = {formula}");
        let (left, right) = Expression::parse_equation(&text).map_err(|error| in_value(&name, error))?;
        self.coordinates.push(output);
        self.outputs.push(name);
        self.equations.push(Equation { text, left, right });
        let checked = self.check_declared_names();
        if checked.is_err() {
            self.coordinates.pop();
            self.outputs.pop();
            self.equations.pop();
        }
        checked
    }

    /// The formula of an output `name` alone.
    fn read_output(&self, name: &str, text: &str) -> Result<(), ModelError> {
        let formula = Expression::parse(text).map_err(|error| in_value(name, error))?;
        let known: Vec<&str> = self.names().into_iter().filter(|name| !self.is_output(name)).collect();
        formula.check_names(&known).map_err(|error| in_value(name, error))?;
        for symbol in formula.symbols().into_iter().filter(|symbol| symbol.primes > 0) {
            if self.parameters.contains(&symbol.name) {
                return Err(in_value(
                    name,
                    ExpressionError {
                        start: symbol.start,
                        end: symbol.end,
                        message: format!("`{}` is a parameter, so it has no derivative", symbol.name),
                        help: Some(format!("write `{}` without primes", symbol.name)),
                    },
                ));
            }
            let order = self.order_of(&symbol.name);
            if symbol.primes > order {
                let primed = |primes: u8| format!("{}{}", symbol.name, "'".repeat(usize::from(primes)));
                return Err(ModelError::OutputOrder {
                    output: name.to_owned(),
                    symbol: primed(symbol.primes),
                    highest: primed(order),
                });
            }
        }
        Ok(())
    }

    pub fn is_output(&self, name: &str) -> bool {
        self.outputs.iter().any(|output| output == name)
    }

    /// The output that equation `index`, counted from 0, is the formula of.
    pub fn output_of(&self, index: usize) -> Option<&str> {
        let first = self.equations.len() - self.outputs.len().min(self.equations.len());
        self.outputs.get(index.checked_sub(first)?).map(String::as_str)
    }

    /// Each output with its formula.
    pub fn output_formulas(&self) -> impl Iterator<Item = (&str, &Expression)> {
        let first = self.equations.len() - self.outputs.len().min(self.equations.len());
        self.outputs.iter().map(String::as_str).zip(self.equations[first..].iter().map(|e| &e.right))
    }
}

fn in_value(name: &str, error: ExpressionError) -> ModelError {
    ModelError::Value {
        name: name.to_owned(),
        start: error.start,
        end: error.end,
        message: error.message,
        help: error.help,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::algebra::{Polynomial, Rational, parse_decimal};
    use crate::lti::TransferFunction;
    use crate::model::{Rest, linearize};
    use std::collections::BTreeMap;

    fn coordinate(name: &str) -> Coordinate {
        Coordinate { name: name.to_owned(), unit: String::new(), description: String::new() }
    }

    /// Two masses of m on springs of k, one after the other, pushed at the second.
    fn masses() -> Model {
        let names = |names: &[&str]| names.iter().map(|n| (*n).to_owned()).collect::<Vec<_>>();
        Model::new(
            vec![coordinate("p"), coordinate("q")],
            names(&["F"]),
            names(&["m", "k"]),
            &["m*p'' = k*(q - p) - k*p", "m*q'' = F - k*(q - p)"],
        )
        .unwrap()
    }

    fn polynomial(coefficients: &[i32]) -> Polynomial {
        Polynomial::new(coefficients.iter().map(|n| Rational::from(*n)).collect())
    }

    #[test]
    fn transfer_functions_to_outputs_by_hand() {
        // With m = k = 1: (s² + 2) p = q, (s² + 1) q = F + p; so p = F/D and q = (s² + 2) F/D with D = s⁴ + 3 s² + 1.
        let parameters: BTreeMap<_, _> =
            ["m", "k"].map(|name| (name.to_owned(), parse_decimal("1").unwrap())).into();
        let den = polynomial(&[1, 0, 3, 0, 1]);
        for (formula, num) in [
            ("q - p", polynomial(&[1, 0, 1])),
            ("p'", polynomial(&[1, 0])),
            ("2*k*p + m*q'", polynomial(&[1, 0, 2, 2])),
            ("q''", polynomial(&[1, 0, 2, 0, 0])),
            ("p^3 + p", polynomial(&[1])),
            ("F - p", polynomial(&[1, 0, 3, 0, 0])),
        ] {
            let mut model = masses();
            model.add_output(coordinate("y"), formula).unwrap();
            let at = Rest::default().at(&model, &parameters).unwrap();
            let linear = linearize(&model, &parameters, &at, "F", "y").unwrap();
            let expected = TransferFunction { num, den: den.clone() };
            assert!(linear.transfer_function.equals(&expected), "{formula}: {:?}", linear.transfer_function);
            assert!(linear.state_space.as_ref().unwrap().transfer_function().equals(&expected), "{formula}");
        }
    }

    #[test]
    fn an_output_rests_where_its_formula_says() {
        let parameters: BTreeMap<_, _> =
            [("m", "1"), ("k", "4")].map(|(n, v)| (n.to_owned(), parse_decimal(v).unwrap())).into();
        let mut model = masses();
        model.add_output(coordinate("y"), "q - p + p'").unwrap();
        let pairs = [("p", "1/4"), ("q", "1/2"), ("F", "k/4")].map(|(n, t)| (n.to_owned(), t.to_owned()));
        let at = Rest::parse(&model, &pairs).unwrap().at(&model, &parameters).unwrap();
        assert_eq!(at.values["y"].to_f64(), 0.25);
        assert!(at.check(&model, &parameters).is_ok());
        assert_eq!((model.output_of(1), model.output_of(2)), (None, Some("y")));
    }

    #[test]
    fn what_is_no_output() {
        for (name, formula, message) in [
            ("y", "q - r", "the value of `y`: `r` is not a name we know"),
            ("y", "q - ", "the value of `y`: "),
            ("y", "k'", "the value of `y`: `k` is a parameter"),
            ("y", "F'", "the output `y` is of `F'`, but the equations go no further than `F`"),
            ("y", "y", "the value of `y`: `y` is not a name we know"),
            ("y", "q'''", "the output `y` is of `q'''`, but the equations go no further than `q''`"),
            ("p", "q", "`p` is declared twice"),
        ] {
            let mut model = masses();
            let error = model.add_output(coordinate(name), formula).unwrap_err();
            assert!(error.to_string().starts_with(message), "{formula}: {error}");
            assert_eq!((model.coordinates.len(), model.equations.len()), (2, 2));
        }
    }
}
