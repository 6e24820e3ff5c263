use super::*;
use crate::algebra::significant;
use crate::lti::{Limit, Pole};
use crate::model::Tangent;
use std::fmt::Write;

/// Figures shown of every number.
const FIGURES: usize = 6;

/// The answer key as plain text for a terminal.
pub fn to_text(reference: &Reference) -> String {
    let mut text = format!("Answer key of {}\n", reference.lab);
    for model in &reference.models {
        for point in &model.operating_points {
            operating_point(&mut text, &model.id, point);
        }
    }
    for simulation in &reference.simulations {
        let times: Vec<String> =
            simulation.with.switch_times.iter().map(|t| significant(*t, FIGURES)).collect();
        line(&mut text, format_args!(""));
        line(&mut text, format_args!("{} ({})", simulation.id, simulation.title));
        for (what, run) in [("without", &simulation.without), ("with", &simulation.with)] {
            line(
                &mut text,
                format_args!(
                    "  peak {what} the nonlinearity: {} at {} s",
                    significant(run.peak.1, FIGURES),
                    significant(run.peak.0, FIGURES)
                ),
            );
        }
        line(&mut text, format_args!("  switches at: {} s", times.join(", ")));
    }
    text
}

fn operating_point(text: &mut String, model: &str, point: &OperatingPointReference) {
    let at: Vec<String> =
        point.equilibrium_text.iter().map(|(name, value)| format!("{name} = {value}")).collect();
    line(text, format_args!(""));
    let rest = if at.is_empty() { String::new() } else { format!(": {}", at.join(", ")) };
    line(text, format_args!("{model}.{} ({}){rest}", point.id, point.title));
    let own = &point.main().linearization.transfer_function;
    for linear in &point.accepted {
        let choice: Vec<String> =
            linear.differs.iter().map(|(name, value, _)| format!("{name} = {value}")).collect();
        // A value of a parameter that this model does not have, or not in this function.
        if !choice.is_empty() && linear.linearization.transfer_function == *own {
            continue;
        }
        let label = if choice.is_empty() {
            String::new()
        } else {
            format!(" (also accepted, {})", choice.join(", "))
        };
        line(
            text,
            format_args!(
                "  {}/{} = {}{label}",
                point.output,
                point.input,
                linear.linearization.transfer_function.to_text(FIGURES)
            ),
        );
    }
    if let Some(tangent) = &point.tangent {
        static_function(text, point, tangent);
        return;
    }
    let main = point.main();
    let cancelled = &main.linearization.cancelled;
    if cancelled.degree() > 0 {
        let factor = crate::algebra::polynomial_text(cancelled, "s", FIGURES);
        line(
            text,
            format_args!("  cancelled: {factor}, from {}", main.linearization.uncancelled.to_text(FIGURES)),
        );
    }
    text.push_str(&super::letters::text(&point.letters));
    line(text, format_args!("  poles: {} rad/s", roots_text(&main.poles)));
    line(text, format_args!("  zeros: {} rad/s", roots_text(&main.zeros)));
    line(text, format_args!("  transfer function: {}", main.stability.words()));
    line(
        text,
        format_args!(
            "  whole state ({}): {}, eigenvalues {} rad/s",
            states_text(&main.linearization.states),
            main.internal_stability.words(),
            roots_text(&main.internal_poles)
        ),
    );
    if main.doubts.any() {
        line(text, format_args!("  inconclusive, since coefficients are rounded: {}", main.doubts.words()));
    }
    response(text, "impulse response", main.impulse.as_ref());
    response(text, "step response", main.step.as_ref());
    if let Some(comparison) = &point.comparison
        && let (Some(push), Some(amplitude)) = (comparison.parting_push, comparison.parting_amplitude)
    {
        line(
            text,
            format_args!(
                "  linear and nonlinear part at a push of {} {}·s, where the linear peak is {} {}",
                significant(push, 4),
                point.input_unit,
                significant(amplitude, 4),
                point.output_unit
            ),
        );
    }
}

fn response(text: &mut String, name: &str, response: Option<&ResponseReference>) {
    let Some(response) = response else {
        line(text, format_args!("  {name}: none, the transfer function is improper"));
        return;
    };
    let f = &response.features;
    let mut facts =
        vec![f.shape.words().to_owned(), format!("starts at {}", significant(f.initial_value, FIGURES))];
    facts.push(match f.final_value {
        Limit::Value(value) => format!("tends to {}", significant(value, FIGURES)),
        other => other.words().to_owned(),
    });
    if let Some(peak) = &f.peak {
        let (value, time) = (significant(peak.value, FIGURES), significant(peak.time_s, FIGURES));
        facts.push(format!("largest magnitude {value} at {time} s"));
    }
    if let (Some(period), Some(zeta)) = (f.period_s, f.damping_ratio) {
        facts.push(format!(
            "period {} s, damping ratio {}",
            significant(period, FIGURES),
            significant(zeta, FIGURES)
        ));
    }
    if let Some(settling) = f.settling_time_2_percent_s {
        facts.push(format!("within 2 % after {} s", significant(settling, FIGURES)));
    }
    line(text, format_args!("  {name}: {}", facts.join("; ")));
}

fn static_function(text: &mut String, point: &OperatingPointReference, tangent: &Tangent) {
    let (x, y) = (&point.input, &point.output);
    let shown = |value: f64| significant(value, FIGURES);
    line(
        text,
        format_args!(
            "  static: d{y} = {} d{x} about {x} = {}, {y} = {}",
            shown(tangent.slope),
            shown(tangent.at.0),
            shown(tangent.at.1)
        ),
    );
    if tangent.slope == 0.0 {
        line(text, format_args!("  no linear part: the slope is 0"));
        return;
    }
    let end = |value: Option<f64>| value.map_or("as far as is shown".to_owned(), shown);
    line(
        text,
        format_args!(
            "  tangent within {} % of the change it foretells: from {} to {}",
            shown(100.0 * tangent.rule.departure),
            end(tangent.good_from),
            end(tangent.good_to)
        ),
    );
}

/// The first few of many.
fn states_text(states: &[String]) -> String {
    match states.len() {
        0 => "no states".to_owned(),
        1..=6 => states.join(", "),
        n => format!("{}, …, {n} in all", states[..3].join(", ")),
    }
}

fn roots_text(roots: &[Pole]) -> String {
    let mut words = Vec::new();
    for root in roots.iter().filter(|root| root.im >= 0.0) {
        let (re, im) = (significant(root.re, FIGURES), significant(root.im, FIGURES));
        let value = if root.im > 0.0 { format!("{re} ± {im}j") } else { re };
        words.push(match root.multiplicity {
            1 => value,
            m => format!("{value} (×{m})"),
        });
    }
    if words.is_empty() { "none".to_owned() } else { words.join(", ") }
}

fn line(text: &mut String, words: std::fmt::Arguments<'_>) {
    // Writing to a String cannot fail.
    let _ = writeln!(text, "{words}");
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::LabDefinition;
    use crate::source::SourceText;

    const TWO_CARTS: &str = r#"
lab: carts
parameters:
  m: {value: 2}
  g: {value: 9.8, accepted: [10]}
models:
  level:
    coordinates: {x: {}}
    inputs: {u: {}}
    equations: ["m*x'' = u"]
    operating_points: {rest: {input: u, output: x}}
  hanging:
    coordinates: {x: {}}
    inputs: {u: {}}
    equations: ["m*x'' + m*g*x = u"]
    operating_points: {rest: {input: u, output: x}}
questions:
  level: {points: 1, about: level.rest, answer: stability}
"#;

    #[test]
    fn accepted_values_are_told_where_they_matter() {
        let lab = LabDefinition::parse(SourceText::new("lab.yaml", TWO_CARTS))
            .unwrap_or_else(|e| panic!("{}", e.render(false)));
        let text = to_text(&Reference::compute(&lab).unwrap());
        let told: Vec<&str> = text.lines().filter(|line| line.contains("also accepted")).collect();
        assert_eq!(told, ["  x/u = 1 / (2s^2 + 20) (also accepted, g = 10)"]);
    }
}
