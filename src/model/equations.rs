use super::DerivedParameters;
use crate::algebra::{Expression, ExpressionError, NodeKind};
use crate::nonlinear::OdeError;

/// A generalized coordinate: `x` in m, say.
#[derive(Clone, Debug, PartialEq)]
pub struct Coordinate {
    pub name: String,
    pub unit: String,
    pub description: String,
}

/// One equation of motion, `left = right`, as printed.
#[derive(Clone, Debug, PartialEq)]
pub struct Equation {
    pub text: String,
    pub left: Expression,
    pub right: Expression,
}

impl Equation {
    /// As a textbook prints it: MathML without the `<math>` around it.
    pub fn to_mathml(&self) -> String {
        format!("<mrow>{}<mo>=</mo>{}</mrow>", self.left.to_mathml(), self.right.to_mathml())
    }
}

/// Equations of motion in coordinates, inputs and parameters; as many equations as coordinates.
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    pub coordinates: Vec<Coordinate>,
    pub inputs: Vec<String>,
    pub parameters: Vec<String>,
    /// Those of the parameters that follow from the others.
    pub derived: DerivedParameters,
    pub equations: Vec<Equation>,
    /// Those of the coordinates that are but outputs, the last ones: their equations, the last ones, are `name = formula`.
    pub outputs: Vec<String>,
}

fn counted(count: usize, noun: &str) -> String {
    format!("{count} {noun}{}", if count == 1 { "" } else { "s" })
}

#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ModelError {
    #[error(
        "{} for {}: there must be as many of one as of the other",
        counted(*.equations, "equation"),
        counted(*.coordinates, "coordinate")
    )]
    Count { equations: usize, coordinates: usize },
    #[error("`{name}` cannot be a name: use letters, digits and `_`, and neither `pi` nor a function's name")]
    InvalidName { name: String },
    #[error("`{name}` is declared twice")]
    DuplicateName { name: String },
    /// `equation` counts from 1; `start..end` are bytes of its text.
    #[error("equation {equation}: {message}")]
    Syntax { equation: usize, start: usize, end: usize, message: String, help: Option<String> },
    /// In the value of a coordinate or input at an operating point.
    #[error("the value of `{name}`: {message}")]
    Value { name: String, start: usize, end: usize, message: String, help: Option<String> },
    #[error("`{name}` is neither a coordinate nor an input of the model; {known}")]
    UnknownName { name: String, known: String },
    #[error("equation {equation} does not balance at this point: {left} on the left, {right} on the right")]
    NotAnEquilibrium { equation: usize, left: String, right: String },
    #[error("the formulas go in a circle: {}", in_a_row(names))]
    Circle { names: Vec<String> },
    #[error("the parameter `{name}`: {error}")]
    Parameter { name: String, error: Box<ModelError> },
    #[error("`{name}` at rest: {error}")]
    Rest { name: String, error: Box<ModelError> },
    #[error("{} does not enter the equations at rest, so any value of it balances them", quoted(name))]
    Free { name: String },
    #[error("the equations at rest do not say what {} are one by one", and(names))]
    Undetermined { names: Vec<String> },
    #[error("no value of {} was found at which the equations balance", and(names))]
    NotFound { names: Vec<String> },
    /// Each as `x = 2`, several unknowns with commas between.
    #[error("the equations balance at more than one place: {}", values.join("; "))]
    Several { names: Vec<String>, values: Vec<String> },
    #[error(
        "near {value} the equations balance, but hardly change with {}, so no single value can be told",
        and(names)
    )]
    Indistinct { names: Vec<String>, value: String },
    /// `primes` are those that the equations have.
    #[error("the output `{output}` is of `{symbol}`, but the equations go no further than `{highest}`")]
    OutputOrder { output: String, symbol: String, highest: String },
    #[error("the highest derivatives cannot be solved for: their matrix is singular at this point")]
    Singular,
    #[error(
        "equation {equation} {} of {} at this point, so {} cannot be solved for",
        if *is_silent { "says nothing" } else { "says the same as those before it" },
        and(symbols),
        if symbols.len() == 1 { "it" } else { "they" }
    )]
    Dependent { equation: usize, is_silent: bool, symbols: Vec<String> },
    #[error("the output follows a derivative of the input: its transfer function has more zeros than poles")]
    Improper,
    #[error("`{coordinate}` is differentiated {primes} times: two is the most we take")]
    OrderTooHigh { coordinate: String, primes: u8 },
    #[error("`{name}` has no value")]
    NoValue { name: String },
    #[error("`{function}` is not defined at this point")]
    Undefined { function: String },
    /// `equation` counts from 1.
    #[error(
        "equation {equation} is not linear in `{symbol}`, so the motion cannot be followed: solve it for `{symbol}` by hand, and put the result into the other equations"
    )]
    NotLinear { equation: usize, symbol: String },
    #[error("the equations cannot be followed after an impulse of {push}: {source}")]
    Simulation { push: f64, source: OdeError },
}

fn quoted(name: &str) -> String {
    format!("`{name}`")
}

/// `a`, `b` and `c`.
fn and(names: &[String]) -> String {
    let names: Vec<String> = names.iter().map(|name| quoted(name)).collect();
    match names.split_last() {
        Some((last, [])) => last.clone(),
        Some((last, before)) => format!("{} and {last}", before.join(", ")),
        None => String::new(),
    }
}

/// `a` needs `b` needs `a`.
fn in_a_row(names: &[String]) -> String {
    names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(" needs ")
}

/// The most often a coordinate or an input is differentiated.
const HIGHEST_ORDER: u8 = 2;

impl Model {
    /// Reads the equations, `left = right`, and checks every name in them.
    ///
    /// Primes are time derivatives, of coordinates and inputs.
    pub fn new<T: AsRef<str>>(
        coordinates: Vec<Coordinate>,
        inputs: Vec<String>,
        parameters: Vec<String>,
        equations: &[T],
    ) -> Result<Self, ModelError> {
        if equations.len() != coordinates.len() {
            return Err(ModelError::Count { equations: equations.len(), coordinates: coordinates.len() });
        }
        let mut model = Self {
            coordinates,
            inputs,
            parameters,
            derived: DerivedParameters::default(),
            equations: Vec::new(),
            outputs: Vec::new(),
        };
        model.check_declared_names()?;
        for (i, text) in equations.iter().enumerate() {
            let equation = model.read(text.as_ref()).map_err(|e| match e {
                ReadError::Order(error) => error,
                ReadError::Text(e) => ModelError::Syntax {
                    equation: i + 1,
                    start: e.start,
                    end: e.end,
                    message: e.message,
                    help: e.help,
                },
            })?;
            model.equations.push(equation);
        }
        Ok(model)
    }

    /// Whether its equations stand on the handout: those of a transfer function are put together here, and have no text.
    pub fn is_printed(&self) -> bool {
        self.equations.iter().all(|equation| !equation.text.is_empty())
    }

    /// left − right of equation `index`, counted from 0; 0 beyond the last. Its nodes keep their places in the text.
    pub fn residual(&self, index: usize) -> Expression {
        match self.equations.get(index) {
            Some(Equation { left, right, .. }) => Expression {
                kind: NodeKind::Subtract(Box::new(left.clone()), Box::new(right.clone())),
                start: left.start,
                end: right.end,
            },
            None => Expression { kind: NodeKind::Number(crate::algebra::Rational::ZERO), start: 0, end: 0 },
        }
    }

    /// How often a coordinate or an input is differentiated at most in the equations; 0 when it never is.
    pub fn order_of(&self, name: &str) -> u8 {
        let sides = self.equations.iter().flat_map(|e| [&e.left, &e.right]);
        let uses = sides.flat_map(Expression::symbols);
        uses.filter(|symbol| symbol.name == name).map(|symbol| symbol.primes).max().unwrap_or(0)
    }

    /// The states, each a coordinate and its primes, in the order of the coordinates: all derivatives below the highest.
    pub fn states(&self) -> Vec<(String, u8)> {
        let orders = self.highest_derivatives();
        orders.into_iter().flat_map(|(name, order)| (0..order).map(move |k| (name.clone(), k))).collect()
    }

    /// The highest derivative of each coordinate: what the equations are solved for.
    pub fn highest_derivatives(&self) -> Vec<(String, u8)> {
        self.coordinates.iter().map(|c| (c.name.clone(), self.order_of(&c.name))).collect()
    }

    pub(super) fn names(&self) -> Vec<&str> {
        let coordinates = self.coordinates.iter().map(|c| c.name.as_str());
        let rest = self.inputs.iter().chain(&self.parameters).map(String::as_str);
        coordinates.chain(rest).collect()
    }

    pub(super) fn check_declared_names(&self) -> Result<(), ModelError> {
        let names = self.names();
        for (i, name) in names.iter().enumerate() {
            let is_name = matches!(
                Expression::parse(name),
                Ok(Expression { kind: NodeKind::Symbol { name: read, primes: 0 }, .. }) if read == *name
            );
            if !is_name {
                return Err(ModelError::InvalidName { name: (*name).to_owned() });
            }
            if names[..i].contains(name) {
                return Err(ModelError::DuplicateName { name: (*name).to_owned() });
            }
        }
        Ok(())
    }

    fn read(&self, text: &str) -> Result<Equation, ReadError> {
        let (left, right) = Expression::parse_equation(text)?;
        let names = self.names();
        left.check_names(&names)?;
        right.check_names(&names)?;
        for symbol in left.symbols().into_iter().chain(right.symbols()) {
            if symbol.primes == 0 {
                continue;
            }
            if self.parameters.contains(&symbol.name) {
                return Err(ReadError::Text(ExpressionError {
                    start: symbol.start,
                    end: symbol.end,
                    message: format!("`{}` is a parameter and cannot be differentiated by time", symbol.name),
                    help: Some("only coordinates and inputs have primes".to_owned()),
                }));
            }
            if symbol.primes > HIGHEST_ORDER {
                let error = ModelError::OrderTooHigh { coordinate: symbol.name, primes: symbol.primes };
                return Err(ReadError::Order(error));
            }
        }
        Ok(Equation { text: text.to_owned(), left, right })
    }
}

enum ReadError {
    Text(ExpressionError),
    Order(ModelError),
}

impl From<ExpressionError> for ReadError {
    fn from(error: ExpressionError) -> Self {
        Self::Text(error)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn coordinate(name: &str) -> Coordinate {
        Coordinate { name: name.to_owned(), unit: String::new(), description: String::new() }
    }

    fn strings(names: &[&str]) -> Vec<String> {
        names.iter().map(|n| (*n).to_owned()).collect()
    }

    fn model(coordinates: &[&str], equations: &[&str]) -> Result<Model, ModelError> {
        let coordinates = coordinates.iter().map(|n| coordinate(n)).collect();
        Model::new(coordinates, strings(&["F", "d"]), strings(&["m", "k"]), equations)
    }

    #[test]
    fn states_stop_below_the_highest_derivative() {
        let mixed = model(&["x", "h", "y"], &["m*x'' = F", "h' = k*x", "y = h + x'"]).unwrap();
        assert_eq!(mixed.states(), [("x".into(), 0), ("x".into(), 1), ("h".into(), 0)]);
        assert_eq!(mixed.highest_derivatives(), [("x".into(), 2), ("h".into(), 1), ("y".into(), 0)]);
        assert_eq!(mixed.residual(0).to_string(), "m*x'' - F");
        assert_eq!(mixed.residual(2).to_string(), "y - (h + x')");
        let residual = mixed.residual(1);
        assert_eq!(&mixed.equations[1].text[residual.start..residual.end], "h' = k*x");
    }

    #[track_caller]
    fn check_errors(rows: &[(&[&str], &[&str], &str, &str)]) {
        for (coordinates, equations, message, help) in rows {
            let error = model(coordinates, equations).unwrap_err();
            let found = match &error {
                ModelError::Syntax { help: Some(help), .. } => help.as_str(),
                _ => "",
            };
            assert!(error.to_string().contains(message), "{equations:?}: {error}");
            assert!(found.contains(help), "{equations:?}: {error:?}");
        }
    }

    #[test]
    fn what_is_wrong_with_a_model() {
        check_errors(&[
            (&["x"], &[], "0 equations for 1 coordinate:", ""),
            (&["x"], &["m*x'' + k*X = F"], "equation 1: `X` is not a name", "did you mean `x`?"),
            (&["theta"], &["m*thta'' = F"], "`thta`", "did you mean `theta`?"),
            (&["x"], &["m*x''' = F"], "`x` is differentiated 3 times", ""),
            (&["x"], &["m*x'' = F'''"], "`F` is differentiated 3 times", ""),
            (&["x"], &["m'*x'' = F"], "`m` is a parameter", "only coordinates and inputs"),
            (&["x"], &["m*x''"], "no `=`", "left = right"),
            (&["sin"], &["sin = 1"], "`sin` cannot be a name", ""),
            (&["pi"], &["pi = 1"], "`pi` cannot be a name", ""),
            (&["x y"], &["x = 1"], "`x y` cannot be a name", ""),
            (&["m"], &["m = 1"], "`m` is declared twice", ""),
        ]);
    }

    #[test]
    fn equations_print_as_mathml() {
        let m = model(&["x"], &["m*x'' = F"]).unwrap();
        assert!(m.equations[0].to_mathml().contains("<mo>=</mo>"));
    }
}
