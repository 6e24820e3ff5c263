//! Which straight line a typed formula states about a point.

use super::TypedFormula;
use crate::algebra::{Expression, NodeKind, Rational};
use crate::lti::TransferFunction;
use std::collections::BTreeMap;

/// Where a tangent touches, and which names may stand in its formula.
pub struct LinePlace<'a> {
    pub output: &'a str,
    pub input: &'a str,
    /// The input and the output there.
    pub x0: Rational,
    pub y0: Rational,
    /// Every other name, and coordinates and inputs at rest.
    pub values: &'a BTreeMap<String, Rational>,
    /// Names of `values` that may also have an index: `h` as `h_0`.
    pub at_rest: Vec<&'a str>,
}

/// output − y0 = slope·(input − x0) + offset
#[derive(Clone, Debug, PartialEq)]
pub struct StatedLine {
    pub slope: Rational,
    pub offset: Rational,
    pub form: StatedForm,
    /// Whether x or y is in it: of deviations alone no offset can be by rounding x0 or y0.
    pub has_point: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StatedForm {
    /// y = 6x − 9
    Line,
    /// δy = 6 δx, δy = 6 (x − 3)
    Deviations,
    /// y − 9 = 6 (x − 3): the line, with its deviations.
    Both,
    /// dy/dx = 6, y′ = 6
    Slope,
    /// 6
    Number,
}

/// What x, y and their deviations are called while a formula is looked at; nobody's names are written so.
const X: &str = " x";
const Y: &str = " y";
const DX: &str = " dx";
const DY: &str = " dy";

type Values = BTreeMap<String, Rational>;

impl TypedFormula {
    /// The lines that the formula can mean, the likeliest first; none when it is not linear.
    ///
    /// A deviation is `dx`, `x'`, `delta_x` and their like, where that is no name of the lab's. Without a left side it can be
    /// the tangent or its deviation.
    /// Errors: why it cannot be worked out, in words.
    pub fn lines(&self, place: &LinePlace<'_>) -> Result<Vec<StatedLine>, String> {
        let values = &place.with_indices();
        let left = self.left.as_ref().map(|left| place.renamed(left, values));
        let right = place.renamed(&self.right, values);
        let has = |name: &str| left.iter().chain([&right]).any(|side| uses(side, name));
        let is_primed =
            matches!(self.left.as_ref().map(|l| &l.kind), Some(NodeKind::Symbol { primes: 1, .. }));
        let is_slope = |left: &Expression| match &left.kind {
            NodeKind::Divide(a, b) => is(a, DY) && is(b, DX),
            _ => is_primed && is(left, DY) && !has(X) && !has(DX),
        };
        let has_point = has(X) || has(Y);
        let solved = |relation: &Expression| place.solved(relation, values);
        let equals = |name: &str| minus(Expression::of_symbol(name, 0), right.clone());
        let mut found = Vec::new();
        match &left {
            Some(left) if is_slope(left) => {
                let constant = straight(&right, X, values)?.filter(|(slope, _)| slope.is_zero());
                found.push((constant.map(|(_, value)| (value, Rational::ZERO)), StatedForm::Slope));
            }
            Some(left) if has(Y) || has(DY) => {
                let relation = minus(left.clone(), right.clone());
                let form = match (has(Y), has(DY)) {
                    (false, true) => StatedForm::Deviations,
                    _ if place.is_apart(left, &right, values) => StatedForm::Both,
                    _ => StatedForm::Line,
                };
                found.push((solved(&relation)?, form));
                // y for its deviation, beside that of x.
                if has(DX) && !has(X) && !has(DY) {
                    let sloppy = relation.replaced(&|node| is(node, Y).then(|| symbol(DY)));
                    found.push((solved(&sloppy)?, StatedForm::Deviations));
                }
            }
            Some(_) => found.push((solved(&equals(Y))?, StatedForm::Line)),
            None if has_point || has(DX) || has(DY) => {
                found.push((solved(&equals(Y))?, StatedForm::Line));
                found.push((solved(&equals(DY))?, StatedForm::Deviations));
            }
            None => {
                let number = straight(&right, X, values)?.map(|(_, value)| (value, Rational::ZERO));
                found.push((solved(&equals(Y))?, StatedForm::Line));
                found.push((number, StatedForm::Number));
            }
        }
        let at_origin = place.x0.is_zero() && place.y0.is_zero();
        let lines = found.into_iter().filter_map(|(line, form)| {
            let (slope, offset) = line?;
            let is_both = at_origin && matches!(form, StatedForm::Line | StatedForm::Deviations);
            Some(StatedLine { slope, offset, form: if is_both { StatedForm::Both } else { form }, has_point })
        });
        Ok(lines.collect())
    }
}

impl LinePlace<'_> {
    /// What is known, with the spellings of values at rest.
    fn with_indices(&self) -> Values {
        let mut values = self.values.clone();
        for name in &self.at_rest {
            let Some(value) = self.values.get(*name) else { continue };
            for index in ["0", "_0", "o", "_o", "_e", "_s", "_ss", "_eq", "_op"] {
                values.entry(format!("{name}{index}")).or_insert_with(|| value.clone());
            }
        }
        values
    }

    /// The formula with one name each for x, y and their deviations; `(t)` behind one of them says nothing.
    fn renamed(&self, node: &Expression, values: &Values) -> Expression {
        let is_time = |node: &Expression| is(node, "t") && self.input != "t" && !values.contains_key("t");
        node.replaced(&|node| match &node.kind {
            NodeKind::Symbol { name, primes } => self.own_name(name, *primes, values),
            NodeKind::Multiply(a, b) if is_time(b) => match &a.kind {
                NodeKind::Symbol { .. } => Some(self.renamed(a, values)),
                // 6·δx(t) is (6·δx)·t
                NodeKind::Multiply(_, last) if matches!(last.kind, NodeKind::Symbol { .. }) => {
                    Some(self.renamed(a, values))
                }
                _ => None,
            },
            _ => None,
        })
    }

    fn own_name(&self, name: &str, primes: u8, values: &Values) -> Option<Expression> {
        const BEFORE: [&str; 6] = ["d", "delta", "delta_", "Delta", "Delta_", "D"];
        const BEHIND: [&str; 4] = ["_d", "_delta", "_Delta", "_dev"];
        if primes == 0 && name == self.output {
            return Some(symbol(Y));
        }
        if primes == 0 && name == self.input {
            return Some(symbol(X));
        }
        // δ_e was read as a deviation, and is a name of the lab's.
        let greek = name.strip_prefix('d').map(|rest| format!("delta_{rest}"));
        if let Some(greek) = greek.filter(|_| primes == 0 && !values.contains_key(name)) {
            match () {
                () if greek == self.output => return Some(symbol(Y)),
                () if greek == self.input => return Some(symbol(X)),
                () if values.contains_key(&greek) => return Some(symbol(&greek)),
                () => {}
            }
        }
        let deviates = |of: &str| match primes {
            0 if values.contains_key(name) => false,
            0 => {
                BEFORE.iter().any(|mark| name.strip_prefix(mark) == Some(of))
                    || BEHIND.iter().any(|mark| name.strip_suffix(mark) == Some(of))
            }
            1 => name == of,
            _ => false,
        };
        if deviates(self.output) {
            return Some(symbol(DY));
        }
        deviates(self.input).then(|| symbol(DX))
    }

    /// Whether the left side is y without what it is at the point, and the right side has the rest: y − 9 = ….
    fn is_apart(&self, left: &Expression, right: &Expression, values: &Values) -> bool {
        let only_y = uses(left, Y) && ![X, DX, DY].iter().any(|name| uses(left, name));
        let at_point = || {
            let moved = left.replaced(&|node| is(node, Y).then(|| Expression::of_number(self.y0.clone())));
            straight(&moved, X, values).ok().flatten().map(|(_, rest)| rest)
        };
        let size = |value: Rational| if value < Rational::ZERO { -value } else { value };
        let is_small = |rest: Rational| size(rest) * Rational::from(100) <= size(self.y0.clone());
        only_y && !uses(right, Y) && !uses(right, DY) && at_point().is_some_and(is_small)
    }

    /// Slope and offset of 0 = `relation`, solved for the deviation of y.
    fn solved(&self, relation: &Expression, values: &Values) -> Result<Straight, String> {
        let at = |deviation: i64| {
            let number = |value: Rational| Some(Expression::of_number(value));
            let moved = relation.replaced(&|node| match &node.kind {
                NodeKind::Symbol { name, .. } => match name.as_str() {
                    X => Some(symbol(DX).plus(Expression::of_number(self.x0.clone()))),
                    Y => number(&self.y0 + Rational::from(deviation)),
                    DY => number(Rational::from(deviation)),
                    _ => None,
                },
                _ => None,
            });
            straight(&moved, DX, values)
        };
        let (Some((k0, b0)), Some((k1, b1)), Some((k2, b2))) = (at(0)?, at(1)?, at(2)?) else {
            return Ok(None);
        };
        let a = &b1 - &b0;
        // The factor of y must be a number: the same everywhere.
        let even = k0 == k1 && k1 == k2 && &b2 - &b1 == a;
        Ok((even && !a.is_zero()).then(|| (-(k0 / &a), -(b0 / &a))))
    }
}

type Straight = Option<(Rational, Rational)>;

/// Slope and offset of a formula in `x`; none when it is not linear.
fn straight(formula: &Expression, x: &str, values: &Values) -> Result<Straight, String> {
    let (num, den) = formula
        .rational_function_nearly(x, values)
        .map_err(|error| format!("This formula cannot be worked out: {}", error.message))?;
    let Some(g) = TransferFunction::new(num, den) else { return Ok(None) };
    let g = g.cancelled().0;
    if g.den.degree() > 0 || g.num.degree() > 1 {
        return Ok(None);
    }
    let scale = g.den.coefficient(0);
    Ok(Some((g.num.coefficient(1) / &scale, g.num.coefficient(0) / &scale)))
}

fn uses(node: &Expression, name: &str) -> bool {
    is(node, name) || node.children().any(|child| uses(child, name))
}

fn is(node: &Expression, wanted: &str) -> bool {
    matches!(&node.kind, NodeKind::Symbol { name, primes: 0 } if name == wanted)
}

fn symbol(name: &str) -> Expression {
    Expression::of_symbol(name, 0)
}

fn minus(a: Expression, b: Expression) -> Expression {
    Expression { kind: NodeKind::Subtract(Box::new(a), Box::new(b)), start: 0, end: 0 }
}
