use super::*;
use crate::algebra::parse_decimal;
use crate::model::{Coordinate, linearize};

/// A system and what a textbook derives for it.
struct Textbook {
    name: &'static str,
    coordinates: &'static [&'static str],
    inputs: &'static [&'static str],
    parameters: &'static [(&'static str, &'static str)],
    equations: &'static [&'static str],
    at: &'static [(&'static str, &'static str)],
    /// output, num, den: as they are shown.
    output: &'static str,
    num: &'static str,
    den: &'static str,
    cancelled: &'static str,
}

const CART: Textbook = Textbook {
    name: "pendulum on a cart, hanging",
    coordinates: &["x", "theta"],
    inputs: &["F"],
    parameters: &[("M", "0.5"), ("b", "0.1"), ("m", "0.2"), ("l", "0.3"), ("I", "0.006"), ("g", "9.81")],
    equations: &[
        "F = (M + m)*x'' + b*x' + m*l*theta''*cos(theta) - m*l*theta'^2*sin(theta)",
        "(I + m*l^2)*theta'' + m*g*l*sin(theta) + m*l*x''*cos(theta) = 0",
    ],
    at: &[],
    output: "theta",
    num: "-m*l*s",
    den: "((M + m)*(I + m*l^2) - m^2*l^2)*s^3 + b*(I + m*l^2)*s^2 + m*g*l*(M + m)*s + b*m*g*l",
    cancelled: "s",
};

#[track_caller]
fn check(book: &Textbook) {
    let coordinate =
        |n: &&str| Coordinate { name: (*n).into(), unit: String::new(), description: String::new() };
    let model = Model::new(
        book.coordinates.iter().map(coordinate).collect(),
        book.inputs.iter().map(|n| (*n).to_owned()).collect(),
        book.parameters.iter().map(|(n, _)| (*n).to_owned()).collect(),
        book.equations,
    )
    .unwrap();
    let parameters: BTreeMap<String, Rational> =
        book.parameters.iter().map(|(n, v)| ((*n).to_owned(), parse_decimal(v).unwrap())).collect();
    let pairs: Vec<_> = book.at.iter().map(|(n, t)| ((*n).to_owned(), (*t).to_owned())).collect();
    let at = Equilibrium::parse(&model, &parameters, &pairs).unwrap();
    let derivation = LetterDerivation::derive(&model, &parameters, &at, book.inputs[0], book.output).unwrap();
    assert_eq!(derivation.num.to_string(), book.num, "{}", book.name);
    assert_eq!(derivation.den.to_string(), book.den, "{}", book.name);
    let cancelled = derivation.cancelled.as_ref().map(ToString::to_string).unwrap_or_default();
    assert_eq!(cancelled, book.cancelled, "{}", book.name);
    let numeric = linearize(&model, &parameters, &at, book.inputs[0], book.output).unwrap();
    let agreement = derivation.agreement(&numeric.transfer_function);
    assert!(
        agreement == LetterAgreement::Exact
            || (!numeric.exact && matches!(agreement, LetterAgreement::Within(_))),
        "{}: {agreement:?}",
        book.name
    );
}

#[test]
fn as_textbooks_derive_them() {
    check(&CART);
    check(&Textbook {
        name: "upright",
        at: &[("theta", "pi")],
        num: "m*l*s",
        den: "((M + m)*(I + m*l^2) - m^2*l^2)*s^3 + b*(I + m*l^2)*s^2 - m*g*l*(M + m)*s - b*m*g*l",
        ..CART
    });
    check(&Textbook {
        name: "DC motor, position",
        coordinates: &["theta", "i"],
        inputs: &["V"],
        parameters: &[("J", "0.01"), ("b", "0.1"), ("K", "0.01"), ("R", "1"), ("L", "0.5")],
        equations: &["J*theta'' + b*theta' = K*i", "L*i' + R*i = V - K*theta'"],
        at: &[],
        output: "theta",
        num: "K",
        den: "J*L*s^3 + (J*R + b*L)*s^2 + (b*R + K^2)*s",
        cancelled: "",
    });
    check(&Textbook {
        name: "tank with a free outflow",
        coordinates: &["h"],
        inputs: &["q"],
        parameters: &[("A", "2"), ("k", "0.5")],
        equations: &["A*h' = q - k*sqrt(h)"],
        at: &[("h", "4"), ("q", "1")],
        output: "h",
        num: "2*sqrt(h_0)",
        den: "2*A*sqrt(h_0)*s + k",
        cancelled: "",
    });
    check(&Textbook {
        name: "magnetic levitation",
        coordinates: &["x", "i"],
        inputs: &["V"],
        parameters: &[("m", "0.05"), ("g", "9.81"), ("K", "0.0001"), ("L", "0.01"), ("R", "1")],
        equations: &["m*x'' = m*g - K*(i/x)^2", "V = R*i + L*i'"],
        at: &[("x", "0.01"), ("i", "0.01*sqrt(0.05*9.81/0.0001)"), ("V", "0.01*sqrt(0.05*9.81/0.0001)")],
        output: "x",
        num: "-2*K*x_0*i_0",
        den: "m*L*x_0^3*s^3 + m*R*x_0^3*s^2 - 2*K*L*i_0^2*s - 2*K*R*i_0^2",
        cancelled: "",
    });
    check(&Textbook {
        name: "two tanks",
        coordinates: &["h1", "h2"],
        inputs: &["q"],
        parameters: &[("A1", "2"), ("A2", "1"), ("k1", "0.5"), ("k2", "0.5")],
        equations: &["A1*h1' = q - k1*sqrt(h1 - h2)", "A2*h2' = k1*sqrt(h1 - h2) - k2*sqrt(h2)"],
        at: &[("h1", "8"), ("h2", "4"), ("q", "1")],
        output: "h2",
        num: "2*k1*sqrt(h2_0)",
        den: "4*A1*A2*sqrt(h2_0)*sqrt(h1_0 - h2_0)*s^2 + 2*(k1*sqrt(h2_0)*(A1 + A2) + A1*k2*sqrt(h1_0 - h2_0))*s + k1*k2",
        cancelled: "sqrt(h1_0 - h2_0)",
    });
    check(&Textbook {
        name: "ball and beam",
        coordinates: &["r"],
        inputs: &["theta"],
        parameters: &[
            ("J", "0.00001"),
            ("R", "0.015"),
            ("m", "0.11"),
            ("g", "9.8"),
            ("d", "0.03"),
            ("L", "1"),
        ],
        equations: &["(J/R^2 + m)*r'' = -m*g*sin(d/L*theta)"],
        at: &[],
        output: "r",
        num: "-R^2*m*g*d",
        den: "L*(J + R^2*m)*s^2",
        cancelled: "",
    });
    check(&Textbook {
        name: "series RLC",
        coordinates: &["v", "i"],
        inputs: &["u"],
        parameters: &[("R", "10"), ("L", "0.1"), ("C", "0.001")],
        equations: &["L*i' + R*i + v = u", "C*v' = i"],
        at: &[],
        output: "v",
        num: "1",
        den: "L*C*s^2 + R*C*s + 1",
        cancelled: "",
    });
    check(&Textbook {
        name: "suspension of two masses",
        coordinates: &["x1", "x2"],
        inputs: &["F"],
        parameters: &[
            ("m1", "2500"),
            ("m2", "320"),
            ("k1", "80000"),
            ("k2", "500000"),
            ("c1", "350"),
            ("c2", "15020"),
        ],
        equations: &[
            "m1*x1'' = -k1*(x1 - x2) - c1*(x1' - x2') + F",
            "m2*x2'' = k1*(x1 - x2) + c1*(x1' - x2') - k2*x2 - c2*x2' - F",
        ],
        at: &[],
        output: "x1",
        num: "m2*s^2 + c2*s + k2",
        den: "m1*m2*s^4 + (m1*(c1 + c2) + m2*c1)*s^3 + (m1*(k1 + k2) + m2*k1 + c1*c2)*s^2 + (k1*c2 + k2*c1)*s + k1*k2",
        cancelled: "",
    });
    check(&Textbook {
        name: "cruise control with drag",
        coordinates: &["v"],
        inputs: &["F"],
        parameters: &[("m", "1000"), ("rho", "1.2"), ("C_d", "0.3"), ("A", "2"), ("b", "50")],
        equations: &["m*v' = F - b*v - 1/2*rho*C_d*A*v*abs(v)"],
        at: &[("v", "20"), ("F", "50*20 + 0.5*1.2*0.3*2*400")],
        output: "v",
        num: "1",
        den: "m*s + b + rho*C_d*A*v_0",
        cancelled: "",
    });
    check(&Textbook {
        name: "pendulum held at an angle",
        coordinates: &["theta"],
        inputs: &["T"],
        parameters: &[("m", "1"), ("g", "9.81"), ("l", "0.5"), ("c", "0.1")],
        equations: &["m*l^2*theta'' + c*theta' + m*g*l*sin(theta) = T"],
        at: &[("theta", "0.5"), ("T", "1*9.81*0.5*sin(0.5)")],
        output: "theta",
        num: "1",
        den: "m*l^2*s^2 + c*s + m*g*l*cos(theta_0)",
        cancelled: "",
    });
    check(&Textbook {
        name: "pendulum held at 30 degrees",
        coordinates: &["theta"],
        inputs: &["T"],
        parameters: &[("m", "1"), ("g", "9.81"), ("l", "0.5"), ("c", "0.1")],
        equations: &["m*l^2*theta'' + c*theta' + m*g*l*sin(theta) = T"],
        at: &[("theta", "pi/6"), ("T", "9.81*0.25")],
        output: "theta",
        num: "2",
        den: "2*m*l^2*s^2 + 2*c*s + m*g*l*sqrt(3)",
        cancelled: "",
    });
    check(&Textbook {
        name: "orifice",
        coordinates: &["h"],
        inputs: &["q"],
        parameters: &[("A", "1"), ("a", "0.01"), ("g", "9.81")],
        equations: &["A*h' = q - a*sqrt(2*g*h)"],
        at: &[("h", "2"), ("q", "0.01*sqrt(2*9.81*2)")],
        output: "h",
        num: "sqrt(2*g*h_0)",
        den: "A*sqrt(2*g*h_0)*s + a*g",
        cancelled: "",
    });
}

/// The tank with numbers for all letters such that it is at rest.
fn tank() -> LetterDerivation {
    let coordinate = Coordinate { name: "h".into(), unit: String::new(), description: String::new() };
    let names = ["A", "k"].map(str::to_owned).to_vec();
    let model = Model::new(vec![coordinate], vec!["q".into()], names, &["A*h' = q - k*sqrt(h)"]).unwrap();
    let parameters =
        [("A", "2"), ("k", "0.5")].map(|(n, v)| (n.to_owned(), parse_decimal(v).unwrap())).into();
    let pairs = [("h", "4"), ("q", "1")].map(|(n, v)| (n.to_owned(), v.to_owned()));
    let at = Equilibrium::parse(&model, &parameters, &pairs).unwrap();
    LetterDerivation::derive(&model, &parameters, &at, "q", "h").unwrap()
}

/// Whether a formula is the derived function at several places; `None` where it is irrational or too much.
fn agrees(derivation: &LetterDerivation, text: &str) -> Option<bool> {
    let formula = Expression::parse_typed(text).ok()?;
    let mut all = true;
    for nth in 0..3 {
        let place = derivation.place(nth).unwrap();
        all &= place.function_of(&formula, "s")?.equals(&place.function);
    }
    Some(all)
}

#[test]
fn formulas_are_held_against_it_where_the_equations_at_rest_hold() {
    let tank = tank();
    assert_eq!(tank.letters(), ["A", "k", "h_0", "q_0"]);
    for (text, expected) in [
        ("1/(A*s + k/(2*sqrt(h_0)))", Some(true)),
        ("2*sqrt(h_0)/(2*A*sqrt(h_0)*s + k)", Some(true)),
        ("2*h_0/(2*A*h_0*s + q_0)", Some(true)),
        ("2*q_0/(2*A*q_0*s + k^2)", Some(true)),
        ("1/(A*s + k/(2*sqrt(h_0)))*exp(k)/exp(k)", Some(true)),
        ("1/(A*s + k/(2*sqrt(h_0)))*(sin(k)^2 + cos(k)^2)", Some(true)),
        ("1/(A*s + k/sqrt(h_0))", Some(false)),
        ("1/(2*s + 0.125)", Some(false)),
        ("1/(A*s + 0.125)", Some(false)),
        ("1/(A*s + k/4)", Some(false)),
        ("1/(A*s + k/(2*sqrt(2*h_0)))", None),
    ] {
        assert_eq!(agrees(&tank, text), expected, "{text}");
    }
}

/// Multiplied out, some of these have more terms than fit into memory.
#[test]
fn hostile_formulas_end() {
    let tank = tank();
    for text in [
        "1/(A*s + k/(2*sqrt(h_0))) + (A+k+h_0+q_0)^60".to_owned(),
        "((A+k+h_0)^60 + s)^60".to_owned(),
        format!("{}1{}", "(A+k+s*".repeat(45), ")^2".repeat(45)),
        format!("1/(A*s + {}k{})", "(k+".repeat(60), "*h_0)".repeat(60)),
        format!("1/(A*s + {}k{})", "sqrt(".repeat(60), ")".repeat(60)),
        format!("1/(A*s + {}k{})", "exp(".repeat(60), ")".repeat(60)),
        "(A+k*s)^30*(h_0+q_0*s)^30/(A*s+k)^60".to_owned(),
        "1/(A*s + k^60^60)".to_owned(),
        "(s+A/7)^20/((s+k/11)^20*(s+h_0/13)^20)".to_owned(),
    ] {
        let _ = agrees(&tank, &text);
    }
}

#[test]
fn a_system_too_large_for_a_page_says_so() {
    let names: Vec<String> = (0..9).map(|i| format!("x{i}")).collect();
    let parameters: Vec<String> = (0..9).flat_map(|i| (0..9).map(move |j| format!("a{i}_{j}"))).collect();
    let equations: Vec<String> = (0..9)
        .map(|i| {
            let terms: Vec<String> = (0..9).map(|j| format!("a{i}_{j}*x{j}")).collect();
            format!("x{i}' = {} + u", terms.join(" + "))
        })
        .collect();
    let coordinate =
        |n: &String| Coordinate { name: n.clone(), unit: String::new(), description: String::new() };
    let model =
        Model::new(names.iter().map(coordinate).collect(), vec!["u".into()], parameters.clone(), &equations);
    let model = model.unwrap();
    let values = parameters.iter().map(|n| (n.clone(), Rational::from(n.len()))).collect();
    let at = Equilibrium::parse(&model, &values, &[]).unwrap();
    let derived = LetterDerivation::derive(&model, &values, &at, "u", "x0");
    assert_eq!(derived.err(), Some(LettersError::OverBudget));
}
