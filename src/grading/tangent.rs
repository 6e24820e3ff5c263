use super::Evidence;
use super::closeness::magnitude;
use super::mark::{Mark, share};
use crate::algebra::{Rational, significant, to_f64};
use crate::lab::{LineForm, Points, Tolerance};
use crate::reference::{LinearReference, OperatingPointReference};
use crate::submission::{LinePlace, StatedForm, StatedLine, TypedFormula};

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
    let mut best: Option<Mark> = None;
    for linear in &point.accepted {
        let Some(line) = Line::of(point, linear) else { continue };
        for mark in line.marks(points, point, asked, typed, linear) {
            if mark.earned == points {
                return mark;
            }
            if best.as_ref().is_none_or(|best| mark.earned > best.earned) {
                best = Some(mark);
            }
        }
    }
    best.unwrap_or_else(|| {
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

    /// A mark for each line that the formula can mean; at least one.
    fn marks(
        &self,
        points: Points,
        point: &OperatingPointReference,
        asked: &Asked<'_>,
        typed: &TypedFormula,
        linear: &LinearReference,
    ) -> Vec<Mark> {
        let expected = || expected(point, asked.form);
        let x = &point.input;
        let place = LinePlace {
            output: &point.output,
            input: x,
            x0: self.x0.clone(),
            y0: self.y0.clone(),
            values: &linear.values,
            at_rest: point.equilibrium.iter().map(|(name, _)| name.as_str()).collect(),
        };
        match typed.lines(&place) {
            Err(why) => {
                vec![Mark::unmarked(expected(), String::new(), format!("{why}; a person will mark it."))]
            }
            Ok(lines) if lines.is_empty() => vec![Mark::wrong(
                "tangent.not_linear",
                Evidence {
                    expected: expected(),
                    found: format!("a function that is not linear in {x}"),
                    reason: format!("A tangent is a straight line: a number times {x}, and a number."),
                    ..Evidence::default()
                },
            )],
            Ok(lines) => lines.iter().map(|line| self.mark(points, point, asked, line)).collect(),
        }
    }

    fn mark(
        &self,
        points: Points,
        point: &OperatingPointReference,
        asked: &Asked<'_>,
        stated: &StatedLine,
    ) -> Mark {
        let (x, y) = (&point.input, &point.output);
        let (x0, y0, k) = (shown(&self.x0), shown(&self.y0), shown(&self.slope));
        let StatedLine { slope, offset, form, has_point } = stated;
        let near = |value: &Rational, wanted: &Rational, scale: &Rational| {
            let width = (&asked.tolerance.relative * scale).max(asked.tolerance.absolute.clone());
            magnitude(&(value - wanted)) <= width
        };
        let right_slope = near(slope, &self.slope, &magnitude(&self.slope));
        let scale = magnitude(&self.y0).max(magnitude(&(&self.slope * &self.x0)));
        let right_point = if *has_point { near(offset, &Rational::ZERO, &scale) } else { offset.is_zero() };
        let has_form = match form {
            StatedForm::Line => asked.form == LineForm::Line,
            StatedForm::Deviations | StatedForm::Slope => asked.form == LineForm::Deviations,
            StatedForm::Both => true,
            StatedForm::Number => false,
        };
        let through = shown(&(&self.y0 + offset));
        let found = match form {
            StatedForm::Line | StatedForm::Both => {
                format!("a slope of {}, and {y} = {through} at {x} = {x0}", shown(slope))
            }
            StatedForm::Deviations => format!("a slope of {}, in deviations", shown(slope)),
            StatedForm::Slope | StatedForm::Number => format!("a slope of {}", shown(slope)),
        };
        let evidence = |reason: String| Evidence {
            expected: expected(point, asked.form),
            found,
            reason,
            ..Evidence::default()
        };
        let is_line = matches!(form, StatedForm::Line | StatedForm::Both);
        match (right_slope, right_point) {
            (true, true) if has_form => {
                Mark::right(points, evidence(format!("Yes: slope {k}, through {x} = {x0}, {y} = {y0}.")))
            }
            (true, true) => {
                let reason = match (form, asked.form) {
                    (StatedForm::Slope | StatedForm::Number, LineForm::Line) => format!(
                        "The slope is right. Where the line goes through is not said: asked for is the tangent itself, {y} as a \
                         function of {x}."
                    ),
                    (StatedForm::Number, LineForm::Deviations) => {
                        format!("The slope is right. Of what to what it is has to be said: δ{y} = {k}·δ{x}.")
                    }
                    (_, LineForm::Line) => format!(
                        "The slope is right. This is the model in deviations from {x} = {x0}, {y} = {y0}; asked for is the \
                         tangent itself, {y} as a function of {x}."
                    ),
                    (_, LineForm::Deviations) => format!(
                        "The tangent is right. Asked for is the model in deviations, δ{y} = {k}·δ{x}, a line through the \
                         origin: without the constant that the tangent has."
                    ),
                };
                Mark::partly("tangent.other_form", share(points, asked.other_form), evidence(reason))
            }
            (true, false) if !is_line => Mark::wrong(
                "tangent.point",
                evidence(
                    "The slope is right, but in deviations the line goes through the origin.".to_owned(),
                ),
            ),
            (true, false) => Mark::wrong(
                "tangent.point",
                evidence(format!(
                    "The slope is right, but the line does not touch the function: at {x} = {x0} it must be {y} = {y0}, not \
                     {through}."
                )),
            ),
            (false, true) if is_line => Mark::wrong(
                "tangent.slope",
                evidence(format!(
                    "The line goes through the right point, but the derivative there is {k}, not {}.",
                    shown(slope)
                )),
            ),
            (false, _) if !is_line => Mark::wrong(
                "tangent.slope",
                evidence(format!("The derivative at {x} = {x0} is {k}, not {}.", shown(slope))),
            ),
            (false, _) => Mark::wrong(
                "tangent.other",
                evidence(format!(
                    "The derivative at {x} = {x0} is {k}, and the line goes through {y} = {y0} there."
                )),
            ),
        }
    }
}

fn shown(value: &Rational) -> String {
    significant(to_f64(value), 6)
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
            of_scale: None,
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
                ("δy = 6 (x - 3)", 50, "tangent.other_form"),
                ("dy/dx = 6", 50, "tangent.other_form"),
                ("y' = 6", 50, "tangent.other_form"),
                ("6", 50, "tangent.other_form"),
                ("dy/dx = 3", 0, "tangent.slope"),
                ("3", 0, "tangent.other"),
                ("y = 9 + 6 δx", 100, "right"),
                ("9 + 6 Δx", 100, "right"),
                ("6x - 9 = y", 100, "right"),
                ("y - y_0 = 6 (x - x_0)", 100, "right"),
                ("y(t) = 6 x(t) - 9", 100, "right"),
                // what c is nobody knows
                ("y = c*x - 9", 0, "unmarked"),
            ],
        );
        check(
            0,
            LineForm::Deviations,
            &[
                ("δy = 6 δx", 100, "right"),
                ("δy = 6 (x - 3)", 100, "right"),
                ("6 (x - 3)", 100, "right"),
                ("δy = 6 (x - x_0)", 100, "right"),
                ("y - y_0 = 6 (x - x_0)", 100, "right"),
                ("y - 9 = 6 (x - 3)", 100, "right"),
                ("2(y - 9) = 12 (x - 3)", 100, "right"),
                ("δy/δx = 6", 100, "right"),
                (r"\frac{\delta y}{\delta x} = 6", 100, "right"),
                (r"\Delta y = 6 \Delta x", 100, "right"),
                (r"\tilde{y} = 6 \tilde{x}", 100, "right"),
                ("ỹ = 6 x̃", 100, "right"),
                ("dy = 6 dx", 100, "right"),
                ("dy = 6 (x - 3)", 100, "right"),
                ("y' = 6 x'", 100, "right"),
                ("y' = 6 (x - 3)", 100, "right"),
                ("y' = 6", 100, "right"),
                ("Δy ≈ 6 Δx", 100, "right"),
                ("δy(t) = 6 δx(t)", 100, "right"),
                ("δy(t) = 6·δx(t)/1", 100, "right"),
                ("delta_y = 6 delta_x", 100, "right"),
                ("δ_y = 6 δ_x", 100, "right"),
                ("dy = 2 x0 dx", 100, "right"),
                ("y = 6 dx", 100, "right"),
                ("y = 6x - 9", 50, "tangent.other_form"),
                ("y = 9 + 6 (x - 3)", 50, "tangent.other_form"),
                ("y = 9 + 6 dx", 50, "tangent.other_form"),
                ("6", 50, "tangent.other_form"),
                ("dy = 6 dx + 9", 0, "tangent.point"),
                ("dy = 6 x", 0, "tangent.point"),
                ("dy = 6 (x - 2)", 0, "tangent.point"),
                ("y - 9 = 6 x", 0, "tangent.point"),
                ("dy/dx = 2 x", 0, "tangent.not_linear"),
                ("dy = 3 (x - 3)", 0, "tangent.slope"),
                ("dy/dx = 3", 0, "tangent.slope"),
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
                ("y = k*sqrt(2)/2 + k*(x - pi/4)/sqrt(2)", 100, "right"),
                ("y = k*sin(x0) + k*cos(x_0)*(x - x_0)", 100, "right"),
                ("y = 1.41x + 0.31", 100, "right"),
            ],
        );
    }
}
