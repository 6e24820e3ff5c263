use super::Evidence;
use super::closeness::magnitude;
use super::mark::{Mark, share};
use crate::algebra::{Expression, NodeKind, Rational, significant, to_f64};
use crate::lab::{LineForm, Points, Tolerance};
use crate::lti::TransferFunction;
use crate::reference::{LinearReference, OperatingPointReference};
use crate::submission::TypedFormula;
use std::collections::BTreeMap;

/// What a criterion asks of a tangent.
pub(super) struct Asked<'a> {
    pub form: LineForm,
    /// What part of the points is left by the other form.
    pub other_form: &'a Rational,
    pub tolerance: &'a Tolerance,
}

/// The right line: output y0 and slope at the input x0.
struct Line {
    x0: Rational,
    y0: Rational,
    slope: Rational,
}

/// What a student's formula says.
enum Reading {
    Line {
        slope: Rational,
        offset: Rational,
    },
    Deviations {
        slope: Rational,
        offset: Rational,
    },
    NotLinear,
    /// A name that nobody knows, or a formula that cannot be worked out.
    Unknown(String),
}

pub(super) fn expected(point: &OperatingPointReference, form: LineForm) -> String {
    let (x, y) = (&point.input, &point.output);
    Line::of(point, point.main()).map_or_else(String::new, |line| {
        let k = shown(&line.slope);
        match form {
            LineForm::Line => {
                let (x0, y0) = (shown(&line.x0), shown(&line.y0));
                format!("{y} ≈ {y0} + {k}·({x} − {x0}).").replace("− -", "+ ").replace("+ -", "− ")
            }
            LineForm::Deviations => format!("δ{y} = {k}·δ{x}."),
        }
    })
}

pub(super) fn judge(
    points: Points,
    point: &OperatingPointReference,
    asked: &Asked<'_>,
    typed: &TypedFormula,
) -> Mark {
    let expected = expected(point, asked.form);
    let mut first = None;
    for linear in &point.accepted {
        let Some(line) = Line::of(point, linear) else { continue };
        let reading = read(typed, point, &linear.values);
        let mark = line.mark(points, point, asked, &reading, expected.clone());
        if mark.earned == points {
            return mark;
        }
        first.get_or_insert(mark);
    }
    first.unwrap_or_else(|| {
        Mark::unmarked(expected, String::new(), "There is no tangent to compare with; a person will mark it.")
    })
}

impl Line {
    fn of(point: &OperatingPointReference, linear: &LinearReference) -> Option<Self> {
        let g = &linear.linearization.transfer_function;
        let den = g.den.coefficient(0);
        Some(Self {
            x0: linear.values.get(&point.input)?.clone(),
            y0: linear.values.get(&point.output)?.clone(),
            slope: if den.is_zero() { return None } else { g.num.coefficient(0) / den },
        })
    }

    fn mark(
        &self,
        points: Points,
        point: &OperatingPointReference,
        asked: &Asked<'_>,
        reading: &Reading,
        expected: String,
    ) -> Mark {
        let (x, y) = (&point.input, &point.output);
        let (x0, y0, k) = (shown(&self.x0), shown(&self.y0), shown(&self.slope));
        let evidence = |found: String, reason: String| Evidence {
            expected: expected.clone(),
            found,
            reason,
            ..Evidence::default()
        };
        let near = |value: &Rational, wanted: &Rational, scale: &Rational| {
            let width = (&asked.tolerance.relative * scale).max(asked.tolerance.absolute.clone());
            magnitude(&(value - wanted)) <= width
        };
        match reading {
            Reading::Unknown(why) => {
                Mark::unmarked(expected.clone(), String::new(), format!("{why}; a person will mark it."))
            }
            Reading::NotLinear => Mark::wrong(
                "tangent.not_linear",
                evidence(
                    format!("a function that is not linear in {x}"),
                    format!("A tangent is a straight line: a number times {x}, and a number."),
                ),
            ),
            Reading::Line { slope, offset } | Reading::Deviations { slope, offset } => {
                let deviations = matches!(reading, Reading::Deviations { .. });
                let right_slope = near(slope, &self.slope, &magnitude(&self.slope));
                let through = if deviations { offset.clone() } else { slope * &self.x0 + offset };
                let wanted = if deviations { Rational::ZERO } else { self.y0.clone() };
                let scale = magnitude(&self.y0).max(magnitude(&(&self.slope * &self.x0)));
                let right_point =
                    if deviations { through.is_zero() } else { near(&through, &wanted, &scale) };
                let found = match deviations {
                    true => format!("a slope of {}, in deviations", shown(slope)),
                    false => {
                        format!("a slope of {}, and {y} = {} at {x} = {x0}", shown(slope), shown(&through))
                    }
                };
                match (right_slope, right_point) {
                    (true, true) if deviations == (asked.form == LineForm::Deviations) => Mark::right(
                        points,
                        evidence(found, format!("Yes: slope {k}, through {x} = {x0}, {y} = {y0}.")),
                    ),
                    (true, true) => {
                        let earned = share(points, asked.other_form);
                        let reason = if deviations {
                            format!(
                                "The slope is right. This is the model in deviations from {x} = {x0}, {y} = {y0}; asked for is the \
                                 tangent itself, {y} as a function of {x}."
                            )
                        } else {
                            format!(
                                "The tangent is right. Asked for is the model in deviations, δ{y} = {k}·δ{x}, a line through the \
                                 origin: without the constant that the tangent has."
                            )
                        };
                        Mark::partly("tangent.other_form", earned, evidence(found, reason))
                    }
                    (true, false) if deviations => Mark::wrong(
                        "tangent.point",
                        evidence(
                            found,
                            "The slope is right, but in deviations the line goes through the origin."
                                .to_owned(),
                        ),
                    ),
                    (true, false) => Mark::wrong(
                        "tangent.point",
                        evidence(
                            found,
                            format!(
                                "The slope is right, but the line does not touch the function: at {x} = {x0} it must be {y} = {y0}, \
                                 not {}.",
                                shown(&through)
                            ),
                        ),
                    ),
                    (false, true) if !deviations => Mark::wrong(
                        "tangent.slope",
                        evidence(
                            found,
                            format!(
                                "The line goes through the right point, but the derivative there is {k}, not {}.",
                                shown(slope)
                            ),
                        ),
                    ),
                    (false, _) if deviations => Mark::wrong(
                        "tangent.slope",
                        evidence(
                            found,
                            format!("The derivative at {x} = {x0} is {k}, not {}.", shown(slope)),
                        ),
                    ),
                    (false, _) => Mark::wrong(
                        "tangent.other",
                        evidence(
                            found,
                            format!(
                                "The derivative at {x} = {x0} is {k}, and the line goes through {y} = {y0} there."
                            ),
                        ),
                    ),
                }
            }
        }
    }
}

fn shown(value: &Rational) -> String {
    significant(to_f64(value), 6)
}

/// The line a formula means: `output` solved for, as a function of `input`; all other names at their values.
fn read(
    typed: &TypedFormula,
    point: &OperatingPointReference,
    known: &BTreeMap<String, Rational>,
) -> Reading {
    let (output, input) = (point.output.as_str(), point.input.as_str());
    let mut values = known.clone();
    for (name, value) in point.equilibrium.iter().filter_map(|(name, _)| known.get_key_value(name)) {
        for spelled in [format!("{name}0"), format!("{name}_0"), format!("{name}o"), format!("{name}_e")] {
            values.entry(spelled).or_insert_with(|| value.clone());
        }
    }
    let used = |name: &str| {
        let sides = typed.left.iter().chain([&typed.right]);
        sides.flat_map(Expression::symbols).any(|symbol| symbol.name == name)
    };
    let (dy, dx) = (format!("d{output}"), format!("d{input}"));
    let deviations = [&dy, &dx].into_iter().any(|name| used(name) && !values.contains_key(name));
    let (y, x) = if deviations { (dy.as_str(), dx.as_str()) } else { (output, input) };
    values.remove(x);
    let solved_for = typed.left.as_ref().filter(|left| left.symbols().iter().any(|symbol| symbol.name == y));
    let result = match solved_for {
        Some(left) => {
            let difference = Expression {
                kind: NodeKind::Subtract(Box::new(left.clone()), Box::new(typed.right.clone())),
                start: 0,
                end: 0,
            };
            let at = |value: i64| {
                let mut values = values.clone();
                values.insert(y.to_owned(), Rational::from(value));
                straight(&difference, x, &values)
            };
            match (at(0), at(1), at(2)) {
                (Ok(zero), Ok(one), Ok(two)) => solved(zero, one, two),
                (Err(why), _, _) | (_, Err(why), _) | (_, _, Err(why)) => return Reading::Unknown(why),
            }
        }
        None => {
            values.remove(y);
            match straight(&typed.right, x, &values) {
                Ok(line) => line,
                Err(why) => return Reading::Unknown(why),
            }
        }
    };
    match result {
        None => Reading::NotLinear,
        Some((slope, offset)) if deviations => Reading::Deviations { slope, offset },
        Some((slope, offset)) => Reading::Line { slope, offset },
    }
}

type Straight = Option<(Rational, Rational)>;

/// Slope and offset of a formula in `x`; none when it is not linear.
fn straight(formula: &Expression, x: &str, values: &BTreeMap<String, Rational>) -> Result<Straight, String> {
    let (num, den) = formula
        .rational_function(x, values)
        .map_err(|error| format!("This formula cannot be worked out: {}", error.message))?;
    let g = match TransferFunction::new(num, den) {
        Some(g) => g.cancelled().0,
        None => return Ok(None),
    };
    if g.den.degree() > 0 || g.num.degree() > 1 {
        return Ok(None);
    }
    let scale = g.den.coefficient(0);
    Ok(Some((g.num.coefficient(1) / &scale, g.num.coefficient(0) / &scale)))
}

/// F(y) = a·y + b(x) from F at 0, 1 and 2, solved for y.
fn solved(zero: Straight, one: Straight, two: Straight) -> Straight {
    let ((k0, b0), (k1, b1), (k2, b2)) = (zero?, one?, two?);
    let a = &b1 - &b0;
    // The factor of y must be a number: the same everywhere.
    let even = k0 == k1 && k1 == k2 && &b2 - &b1 == a;
    (even && !a.is_zero()).then(|| (-(k0 / &a), -(b0 / &a)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::LabDefinition;
    use crate::reference::Reference;
    use crate::source::SourceText;

    const LAB: &str = "lab: t\nparameters: {k: {value: 2}}\nmodels:\n  m:\n    inputs: {x: {}}\n    outputs: {y: {formula: x^2}}\n    \
        operating_points: {p: {at: {x: 3}, input: x, output: y}}\n  angle:\n    inputs: {x: {}}\n    outputs: {y: {formula: k*sin(x)}}\n    \
        operating_points: {p: {at: {x: pi/4}, input: x, output: y}}\nquestions:\n  q:\n    points: 1\n    about: m.p\n    answer: {kind: formula}\n";

    /// Model, form asked for, then rows of answer, points of 100, code.
    #[track_caller]
    fn check(model: usize, form: LineForm, rows: &[(&str, i64, &str)]) {
        let lab = LabDefinition::parse(SourceText::new("lab.yaml", LAB)).unwrap();
        let reference = Reference::compute(&lab).unwrap();
        let point = &reference.models[model].operating_points[0];
        let tolerance = Tolerance {
            absolute: Rational::ZERO,
            relative: Rational::from_parts(1.into(), 200u8.into()),
            figures: None,
        };
        let half = crate::grading::mark::half();
        let asked = Asked { form, other_form: &half, tolerance: &tolerance };
        for (text, earned, code) in rows {
            let typed = crate::submission::read_formula(text).unwrap();
            let mark = judge(Points(100), point, &asked, &typed);
            assert_eq!(
                (mark.earned, mark.code),
                (Points(*earned), *code),
                "{text}: {}",
                mark.evidence.reason
            );
            assert!(!mark.evidence.reason.is_empty(), "{text}");
        }
    }

    #[test]
    fn the_tangent_of_a_parabola() {
        check(
            0,
            LineForm::Line,
            &[
                ("y = 6x - 9", 100, "right"),
                ("y ≈ 9 + 6(x - 3)", 100, "right"),
                ("6*(x-3)+9", 100, "right"),
                ("y = x0^2 + 2*x0*(x - x0)", 100, "right"),
                ("y - 9 = 6(x - 3)", 100, "right"),
                ("2y = 12x - 18", 100, "right"),
                ("f(x) = 6x - 9", 100, "right"),
                ("y - 6x + 9 = 0", 100, "right"),
                // both sides of the tolerance of 0.5 %
                ("y = 6.03x - 9.09", 100, "right"),
                ("y = 6.031x - 9.093", 0, "tangent.slope"),
                ("y = 6x - 8.91", 100, "right"),
                ("y = 6x - 8.90", 0, "tangent.point"),
                // deviations where the tangent itself was asked
                ("Δy = 6Δx", 50, "tangent.other_form"),
                ("dy = 6 dx", 50, "tangent.other_form"),
                ("δy = 2 x0 δx", 50, "tangent.other_form"),
                ("dy = 3 dx", 0, "tangent.slope"),
                ("y = 6x", 0, "tangent.point"),
                ("y = 3x", 0, "tangent.slope"),
                ("y = 2x", 0, "tangent.other"),
                ("y = x^2", 0, "tangent.not_linear"),
                ("x*y = 3", 0, "tangent.not_linear"),
                // what c is nobody knows
                ("y = c*x - 9", 0, "unmarked"),
            ],
        );
        check(
            0,
            LineForm::Deviations,
            &[
                ("δy = 6 δx", 100, "right"),
                ("y = 6x - 9", 50, "tangent.other_form"),
                ("dy = 6 dx + 9", 0, "tangent.point"),
            ],
        );
    }

    #[test]
    fn an_irrational_tangent_is_rounded() {
        check(
            1,
            LineForm::Line,
            &[
                ("y = 1.414 + 1.414(x - 0.785)", 100, "right"),
                ("y = k*sqrt(2)/2 + k*(x - pi/4)/sqrt(2)", 0, "unmarked"),
                ("y = 1.41x + 0.31", 100, "right"),
            ],
        );
    }
}
