use super::*;
use crate::algebra::parse_decimal;
use crate::model::Coordinate;
use std::f64::consts::PI;

struct Plant {
    coordinates: &'static [&'static str],
    inputs: &'static [&'static str],
    parameters: &'static [(&'static str, &'static str)],
    equations: &'static [&'static str],
}

/// A ball of steel under a magnet: gravity against C (i/x)².
const MAGNET: Plant = Plant {
    coordinates: &["x"],
    inputs: &["i"],
    parameters: &[("m", "0.04"), ("g", "10"), ("C", "0.001")],
    equations: &["m*x'' = m*g - C*(i/x)^2"],
};

const TANK: Plant = Plant {
    coordinates: &["h"],
    inputs: &["q"],
    parameters: &[("A", "2"), ("k", "0.5")],
    equations: &["A*h' = q - k*sqrt(h)"],
};

const BALL_AND_BEAM: Plant = Plant {
    coordinates: &["r", "alpha"],
    inputs: &["tau"],
    parameters: &[("m", "0.11"), ("g", "9.8"), ("J", "0.02")],
    equations: &[
        "1.4*m*r'' + m*g*sin(alpha) - m*r*alpha'^2 = 0",
        "(J + m*r^2)*alpha'' + 2*m*r*r'*alpha' + m*g*r*cos(alpha) = tau",
    ],
};

const CAR: Plant = Plant {
    coordinates: &["v"],
    inputs: &["F"],
    parameters: &[("m", "1000"), ("c", "0.4"), ("r", "100")],
    equations: &["m*v' = F - c*v*abs(v) - r*sign(v)"],
};

const PENDULUM: Plant = Plant {
    coordinates: &["theta"],
    inputs: &["T"],
    parameters: &[("m", "0.2"), ("g", "10"), ("l", "0.5"), ("b", "0.1")],
    equations: &["m*l^2*theta'' + b*theta' + m*g*l*sin(theta) = T"],
};

const COUPLED: Plant = Plant {
    coordinates: &["h1", "h2"],
    inputs: &["q"],
    parameters: &[("A", "2"), ("k", "0.2")],
    equations: &["A*h1' = q - k*sqrt(h1 - h2)", "A*h2' = k*sqrt(h1 - h2) - k*sqrt(h2)"],
};

const CART: Plant = Plant {
    coordinates: &["x", "theta"],
    inputs: &["F"],
    parameters: &[("M", "0.5"), ("b", "0.1"), ("m", "0.2"), ("l", "0.3"), ("g", "9.81")],
    equations: &[
        "F = (M + m)*x'' + b*x' + m*l*theta''*cos(theta) - m*l*theta'^2*sin(theta)",
        "m*l^2*theta'' + m*g*l*sin(theta) + m*l*x''*cos(theta) = 0",
    ],
};

const SPRINGS: Plant = Plant {
    coordinates: &["p", "q"],
    inputs: &["F", "G"],
    parameters: &[("k", "3"), ("n", "0.5")],
    equations: &["p'' = G - k*(p - q)", "q'' = F - k*(q - p)"],
};

/// Two bodies on springs that stiffen, hung one below the other.
const STIFF: Plant = Plant {
    coordinates: &["a", "b"],
    inputs: &["F"],
    parameters: &[("k", "2"), ("w", "1")],
    equations: &["a'' = w - k*(a + a^3) + k*((b - a) + (b - a)^3)", "b'' = w - k*((b - a) + (b - a)^3) + F"],
};

impl Plant {
    fn rest(&self, at: &[(&str, &str)]) -> Result<Equilibrium, ModelError> {
        let coordinate =
            |n: &&str| Coordinate { name: (*n).into(), unit: String::new(), description: String::new() };
        let model = Model::new(
            self.coordinates.iter().map(coordinate).collect(),
            self.inputs.iter().map(|n| (*n).to_owned()).collect(),
            self.parameters.iter().map(|(n, _)| (*n).to_owned()).collect(),
            self.equations,
        )?;
        let parameters: BTreeMap<_, _> =
            self.parameters.iter().map(|(n, v)| ((*n).to_owned(), parse_decimal(v).unwrap())).collect();
        let pairs: Vec<_> = at.iter().map(|(n, t)| ((*n).to_owned(), (*t).to_owned())).collect();
        let at = Rest::parse(&model, &pairs)?.at(&model, &parameters)?;
        at.check(&model, &parameters)?;
        Ok(at)
    }
}

#[test]
fn what_balances_is_found() {
    #[track_caller]
    fn check(plant: &Plant, at: &[(&str, &str)], expected: &[(&str, f64)], exact: bool) {
        let found = plant.rest(at).unwrap_or_else(|error| panic!("{at:?}: {error}"));
        for (name, expected) in expected {
            let value = &found.values[*name];
            let off = (value.to_f64() - expected).abs();
            assert!(off <= 1e-15 * expected.abs(), "{at:?}: {name} = {value:?}, not {expected}");
            assert_eq!(matches!(value, Exact::Known { .. }), exact, "{at:?}: {name} = {value:?}");
        }
    }
    // i = x √(m g/C) = 20 x by hand.
    check(&MAGNET, &[("x", "0.01"), ("i", "solve near 1")], &[("i", 0.2)], true);
    check(&MAGNET, &[("x", "0.01"), ("i", "solve near -0.001")], &[("i", -0.2)], true);
    check(&MAGNET, &[("x", "sqrt(2)/100"), ("i", "solve near 1")], &[("i", 0.2 * 2f64.sqrt())], false);
    check(&MAGNET, &[("x", "solve near 0.02"), ("i", "3")], &[("x", 0.15)], true);
    // √h = q/k.
    check(&TANK, &[("h", "solve"), ("q", "1")], &[("h", 4.0)], true);
    check(&TANK, &[("h", "solve"), ("q", "0.7")], &[("h", 1.96)], true);
    check(&TANK, &[("h", "solve near 1e6"), ("q", "pi/10")], &[("h", (PI / 5.0).powi(2))], false);
    check(&TANK, &[("h", "2.25"), ("q", "solve")], &[("q", 0.75)], true);
    check(&TANK, &[("h", "2"), ("q", "solve")], &[("q", 0.5 * 2f64.sqrt())], false);
    // The beam is level, and the motor holds the ball: tau = m g r.
    check(
        &BALL_AND_BEAM,
        &[("r", "0.25"), ("alpha", "solve near 0.1"), ("tau", "solve")],
        &[("alpha", 0.0), ("tau", 0.2695)],
        true,
    );
    // Nothing holds it but in the middle.
    check(
        &BALL_AND_BEAM,
        &[("r", "solve near 1"), ("alpha", "solve near 0.1")],
        &[("alpha", 0.0), ("r", 0.0)],
        true,
    );
    check(&CAR, &[("v", "30"), ("F", "solve")], &[("F", 460.0)], true);
    check(&CAR, &[("v", "solve"), ("F", "460")], &[("v", 30.0)], true);
    check(&CAR, &[("v", "solve"), ("F", "-500 - pi")], &[("v", -(1000.0 + 2.5 * PI).sqrt())], false);
    // m g l = 1: sin θ = T.
    check(&PENDULUM, &[("theta", "pi/6"), ("T", "solve")], &[("T", 0.5)], true);
    check(&PENDULUM, &[("theta", "solve near 0.3"), ("T", "0.5")], &[("theta", PI / 6.0)], true);
    check(&PENDULUM, &[("theta", "solve near 2"), ("T", "0.5")], &[("theta", 5.0 * PI / 6.0)], true);
    check(&PENDULUM, &[("theta", "solve near 0.3"), ("T", "0.3")], &[("theta", 0.3f64.asin())], false);
    check(&CART, &[("theta", "solve near 3"), ("F", "solve")], &[("theta", PI), ("F", 0.0)], true);
    // √h2 = q/k and √(h1 − h2) = q/k.
    check(&COUPLED, &[("h1", "solve"), ("h2", "solve"), ("q", "0.6")], &[("h1", 18.0), ("h2", 9.0)], true);
    check(
        &COUPLED,
        &[("h1", "solve near 3"), ("h2", "solve near 1"), ("q", "pi/20")],
        &[("h1", PI * PI / 8.0), ("h2", PI * PI / 16.0)],
        false,
    );
    check(&COUPLED, &[("h1", "2"), ("h2", "solve"), ("q", "solve")], &[("h2", 1.0), ("q", 0.2)], true);
    // Linear in both: p = q + G/k, F = −G.
    check(
        &SPRINGS,
        &[("p", "solve"), ("q", "1"), ("F", "solve"), ("G", "n")],
        &[("p", 7.0 / 6.0), ("F", -0.5)],
        true,
    );
    // a + a³ = 2 w/k = 1, (b − a) + (b − a)³ = w/k = 1/2: Cardano by hand.
    let cardano = |c: f64| {
        let root = (c * c / 4.0 + 1.0 / 27.0).sqrt();
        (c / 2.0 + root).cbrt() + (c / 2.0 - root).cbrt()
    };
    let a = cardano(1.0);
    check(&STIFF, &[("a", "solve"), ("b", "solve")], &[("a", a), ("b", a + cardano(0.5))], false);
}

#[test]
fn what_cannot_be_found_says_why() {
    #[track_caller]
    fn check(plant: &Plant, at: &[(&str, &str)], message: &str) {
        let found = plant.rest(at).map_err(|error| error.to_string());
        assert_eq!(found.map(|at| at.values), Err(message.to_owned()), "{at:?}");
    }
    check(
        &MAGNET,
        &[("x", "0.01"), ("i", "solve")],
        "the equations balance at more than one place: i = -0.2; i = 0.2",
    );
    check(
        &CART,
        &[("x", "solve")],
        "`x` does not enter the equations at rest, so any value of it balances them",
    );
    check(
        &SPRINGS,
        &[("p", "solve"), ("q", "solve")],
        "the equations at rest do not say what `p` and `q` are one by one",
    );
    check(
        &PENDULUM,
        &[("theta", "solve"), ("T", "1.1")],
        "no value of `theta` was found at which the equations balance",
    );
    check(
        &PENDULUM,
        &[("theta", "solve near 1.5"), ("T", "1")],
        "near theta = 1.5708 the equations balance, but hardly change with `theta`, so no single value can be told",
    );
    check(&TANK, &[("h", "solve"), ("q", "-1")], "no value of `h` was found at which the equations balance");
    check(
        &SPRINGS,
        &[("F", "solve"), ("G", "1")],
        "equation 1 does not balance at this point: 0 on the left, 1 on the right",
    );
    check(&TANK, &[("h", "solve nera 3")], "the value of `h`: `nera 3` cannot stand after `solve`");
    check(&TANK, &[("h", "solve near")], "the value of `h`: `near` cannot stand after `solve`");
    check(&TANK, &[("h", "solve near h0")], "the value of `h`: `h0` is not a name we know");
}

#[test]
fn solve_is_read_with_and_without_a_place() {
    for (text, near) in [
        ("solve", None),
        (" solve ", None),
        ("solve near 0.3", Some("0.3")),
        ("solve near -k/2", Some("-k/2")),
        ("solve near(pi)", Some("(pi)")),
    ] {
        match RestValue::parse(text, &["k"]) {
            Ok(RestValue::Solve { near: found }) => {
                assert_eq!(
                    found.map(|e| e.to_string()),
                    near.map(|n| Expression::parse(n).unwrap().to_string()),
                    "{text}"
                );
            }
            other => panic!("{text}: {other:?}"),
        }
    }
    assert!(matches!(RestValue::parse("solver + 1", &["solver"]), Ok(RestValue::Formula(_))));
    let error = RestValue::parse("solve near k + b", &["k"]).unwrap_err();
    assert_eq!((error.start, error.end), (15, 16));
}
