use super::frame::{data_series, frame, leaving_words};
use crate::english::capitalized;
use crate::lab::SimulationDefinition;
use crate::nonlinear::{Block, Nonlinearity, Signal};
use crate::reference::SimulationReference;
use crate::report::figure::{Axis, Figure, Look, Series, extent, padded};
use crate::report::numbers::{number, quantity};
use crate::submission;

/// A simulation in time, as far as it does not depend on a student.
#[derive(Clone, Debug)]
pub struct PreparedSimulation {
    figure: Figure,
    with: Vec<(f64, f64)>,
    without: Vec<(f64, f64)>,
    drive: Vec<(f64, f64)>,
}

impl PreparedSimulation {
    pub fn new(definition: &SimulationDefinition, reference: &SimulationReference) -> Self {
        let without: Vec<_> = reference.samples.iter().map(|s| (s.0, s.1)).collect();
        let with: Vec<_> = reference.samples.iter().map(|s| (s.0, s.2)).collect();
        let unit = &definition.output_unit;
        let both: Vec<_> = with.iter().chain(&without).copied().collect();
        let range = frame(&both, &[]);
        let kind = definition.nonlinearity.kind_name();

        let drive = signal_points(&definition.chain.source, definition.duration_s);
        let reach = |points: &[(f64, f64)]| points.iter().map(|p| p.1.abs()).fold(0.0, f64::max);
        let (factor, words) = scale(reach(&drive), reach(&both));
        let scaled = drive.into_iter().map(|(t, y)| (t, y * factor)).collect::<Vec<_>>();
        let drive_name = format!("{}{words} ({})", definition.input, definition.input_unit);

        let mut figure = Figure::new(
            definition.title.clone(),
            Axis::new("time t", "s", 0.0, definition.duration_s),
            Axis::new(&definition.output, unit, range.0, range.1),
        );
        figure.zero_lines = true;
        figure.summary = format!(
            "Without {kind} the {} goes as far as {} (at {}), with it as far as {} (at {}).{}",
            definition.output,
            quantity(reference.without.peak.1, 4, unit),
            quantity(reference.without.peak.0, 4, "s"),
            quantity(reference.with.peak.1, 4, unit),
            quantity(reference.with.peak.0, 4, "s"),
            switch_words(&reference.with.switch_times),
        );
        let curves = [
            (drive_name, Look::Faint, scaled.clone()),
            (format!("without {kind}"), Look::Other, without.clone()),
            (format!("with {kind}"), Look::Reference, with.clone()),
        ];
        figure.series.extend(curves.map(|(name, look, points)| Series { name, look, points }));
        Self { figure, with, without, drive: scaled }
    }

    /// The figure, with the numbers the student handed in on top.
    pub fn figure(&self, data: Option<&submission::Series>) -> Figure {
        let mut figure = self.figure.clone();
        let Some(data) = data else { return figure };
        let curves = data_series(data, figure.x.to);
        let both: Vec<_> = self.with.iter().chain(&self.without).copied().collect();
        let mut others: Vec<&[(f64, f64)]> = curves.iter().map(|s| s.points.as_slice()).collect();
        others.push(&self.drive);
        (figure.y.from, figure.y.to) = frame(&both, &others);
        let range = (figure.y.from, figure.y.to);
        for curve in curves {
            figure.caption += &leaving_words("The curve of your data", &curve.points, range);
            // The green of a fourth curve is taken by the one without nonlinearity.
            let look = if curve.look == Look::Other { Look::Student } else { curve.look };
            figure.series.push(Series { look, ..curve });
        }
        figure.caption = figure.caption.trim().to_owned();
        figure
    }
}

/// Output over input of the nonlinearity.
pub fn characteristic_figure(definition: &SimulationDefinition, reference: &SimulationReference) -> Figure {
    let kind = definition.nonlinearity.kind_name();
    // What leaves the chain is the nonlinearity's own output when it stands last.
    let last = matches!(definition.chain.blocks.last(), Some(Block::Nonlinearity(n)) if *n == definition.nonlinearity);
    let first = matches!(definition.chain.blocks.first(), Some(Block::Nonlinearity(n)) if *n == definition.nonlinearity);
    let (input, unit) = match (last, first) {
        (true, _) => (definition.output.as_str(), definition.output_unit.as_str()),
        (_, true) => (definition.input.as_str(), definition.input_unit.as_str()),
        _ => ("signal", ""),
    };
    if let Some(figure) = own_units_figure(definition, first, last) {
        return figure;
    }
    let knee = match definition.nonlinearity {
        Nonlinearity::Saturation { limit: knee }
        | Nonlinearity::DeadZone { threshold: knee }
        | Nonlinearity::Backlash { width: knee }
        | Nonlinearity::Quantizer { interval: knee } => knee,
        _ => 1.0,
    };
    let travelled: Vec<_> = reference.samples.iter().map(|s| (s.1, s.2)).collect();
    let loops = last && matches!(definition.nonlinearity, Nonlinearity::Backlash { .. });
    let reach = if loops {
        travelled.iter().map(|p| p.0.abs()).fold(knee, f64::max)
    } else {
        let drive = signal_points(&definition.chain.source, definition.duration_s);
        let driven = drive.iter().map(|p| p.1.abs()).fold(0.0, f64::max);
        let steps = if matches!(definition.nonlinearity, Nonlinearity::Quantizer { .. }) { 4.0 } else { 1.5 };
        (steps * knee).max(if first { 1.15 * driven } else { 0.0 })
    };
    let points = if loops { travelled } else { definition.nonlinearity.characteristic(reach) };
    let values = |part: fn(&(f64, f64)) -> f64| extent(points.iter().map(part)).unwrap_or((-1.0, 1.0));
    let (xs, ys) = (values(|p| p.0), values(|p| p.1));
    let ((left, right), (low, high)) =
        (padded(xs.0, xs.1, 0.06), padded(ys.0.min(xs.0), ys.1.max(xs.1), 0.06));
    let mut figure = Figure::new(
        format!("{}: output over input", capitalized(kind)),
        Axis::new(format!("{input} going in"), unit, left, right),
        Axis::new(format!("{input} coming out"), unit, low, high),
    );
    figure.zero_lines = true;
    let ideal = vec![(left, left), (right, right)];
    figure.series.push(Series { name: "without it".into(), look: Look::Faint, points: ideal });
    figure.series.push(Series { name: kind.to_owned(), look: Look::Reference, points });
    figure.summary = match definition.nonlinearity {
        Nonlinearity::Saturation { limit } => {
            format!("What comes out equals what goes in, but never exceeds ±{}.", quantity(limit, 4, unit))
        }
        Nonlinearity::DeadZone { threshold } => format!(
            "Nothing comes out while the input stays within ±{}; beyond that, the input less this threshold.",
            quantity(threshold, 4, unit)
        ),
        Nonlinearity::Backlash { width } => format!(
            "A loop: what comes out trails by half the gap of {} and stands still while the input crosses the gap.",
            quantity(width, 4, unit)
        ),
        Nonlinearity::Quantizer { interval } => format!(
            "A staircase: what comes out is the nearest multiple of {}, so that it is off by half of that at most.",
            quantity(interval, 4, unit)
        ),
        _ => String::new(),
    };
    figure
}

/// The picture of a nonlinearity whose output is another quantity than its input, or that is about rates.
fn own_units_figure(definition: &SimulationDefinition, first: bool, last: bool) -> Option<Figure> {
    let drive = signal_points(&definition.chain.source, definition.duration_s);
    let driven = drive.iter().map(|p| p.1.abs()).fold(0.0, f64::max);
    let (input, input_unit) =
        if first { (definition.input.as_str(), definition.input_unit.as_str()) } else { ("signal", "") };
    let (output, output_unit) =
        if last { (definition.output.as_str(), definition.output_unit.as_str()) } else { ("signal", "") };
    let seen = if first { 1.15 * driven } else { 0.0 };
    let (reach, summary) = match definition.nonlinearity {
        Nonlinearity::Relay { amplitude, hysteresis, dead_zone } => {
            let on = dead_zone + hysteresis;
            let when = match (dead_zone > 0.0, hysteresis > 0.0) {
                (false, false) => "with the sign of the input; 0 where that is 0".to_owned(),
                (false, true) => format!(
                    "a loop: it goes over to the other side only where the input is {} beyond 0",
                    quantity(hysteresis, 4, input_unit)
                ),
                (true, false) => {
                    format!("0 while the input stays within ±{}", quantity(dead_zone, 4, input_unit))
                }
                (true, true) => format!(
                    "on where the input goes beyond ±{}, off where it comes back to ±{}",
                    quantity(on, 4, input_unit),
                    quantity(dead_zone - hysteresis, 4, input_unit)
                ),
            };
            let words = format!("What comes out is ±{}, {when}.", quantity(amplitude, 4, output_unit));
            ((2.0 * on).max(seen), words)
        }
        Nonlinearity::CoulombFriction { coulomb, viscous } => {
            let grows = if viscous > 0.0 { ", and grows with the input from there" } else { "" };
            let words = format!(
                "What comes out has the sign of the input: it jumps between ±{} where the input passes 0{grows}.",
                quantity(coulomb, 4, output_unit)
            );
            (
                if viscous > 0.0 { (3.0 * coulomb / viscous).min(1e3 * seen.max(1.0)) } else { 0.0 }
                    .max(seen),
                words,
            )
        }
        Nonlinearity::RateLimit { rising, falling } => {
            let words = format!(
                "What comes out follows what goes in, but rises by no more than {} and falls by no more than {} in a second.",
                quantity(rising, 4, output_unit),
                quantity(-falling, 4, output_unit)
            );
            (1.5 * rising.max(-falling), words)
        }
        _ => return None,
    };
    let kind = definition.nonlinearity.kind_name();
    let rates = matches!(definition.nonlinearity, Nonlinearity::RateLimit { .. });
    let name = |signal: &str, unit: &str, way: &str| match (rates, unit) {
        (false, _) => (format!("{signal} {way}"), unit.to_owned()),
        (true, "") => (format!("rate of the {signal} {way}"), "1/s".to_owned()),
        (true, _) => (format!("rate of the {signal} {way}"), format!("({unit})/s")),
    };
    let points = definition.nonlinearity.characteristic(if reach > 0.0 { reach } else { 1.0 });
    let values = |part: fn(&(f64, f64)) -> f64| extent(points.iter().map(part)).unwrap_or((-1.0, 1.0));
    let (xs, ys) = (values(|p| p.0), values(|p| p.1));
    let ((left, right), (low, high)) = (padded(xs.0, xs.1, 0.06), padded(ys.0, ys.1, 0.1));
    let ((x, x_unit), (y, y_unit)) =
        (name(input, input_unit, "going in"), name(output, output_unit, "coming out"));
    let mut figure = Figure::new(
        format!("{}: output over input", capitalized(kind)),
        Axis::new(x, &x_unit, left, right),
        Axis::new(y, &y_unit, low, high),
    );
    figure.zero_lines = true;
    figure.series.push(Series { name: kind.to_owned(), look: Look::Reference, points });
    figure.summary = summary;
    Some(figure)
}

/// A factor 1, 2 or 5 times a power of ten that brings `drive` near `shown`, and how to write it.
fn scale(drive: f64, shown: f64) -> (f64, String) {
    let ratio = drive / shown;
    if !(ratio.is_finite() && ratio > 0.0) {
        return (1.0, String::new());
    }
    let nice = |r: f64| {
        let decade = 10_f64.powf(r.log10().floor());
        [1.0, 2.0, 5.0, 10.0].into_iter().map(|k| k * decade).find(|v| *v >= r * 0.999).unwrap_or(r)
    };
    if ratio > 1.0 {
        let divisor = nice(ratio);
        (1.0 / divisor, format!(" ÷ {}", number(divisor, 3)))
    } else if ratio < 0.4 {
        let factor = 1.0 / nice(ratio);
        (factor, format!(" × {}", number(factor, 3)))
    } else {
        (1.0, String::new())
    }
}

/// A signal for drawing, its jumps as vertical lines.
fn signal_points(signal: &Signal, end_s: f64) -> Vec<(f64, f64)> {
    const STEPS: usize = 400;
    let mut instants: Vec<f64> = match signal {
        Signal::Sine { .. } => (0..=STEPS).map(|i| end_s * i as f64 / STEPS as f64).collect(),
        _ => vec![0.0, end_s],
    };
    // A jump at the very end belongs to what is not shown any more.
    let sliver = end_s * 1e-9;
    if let Some(last) = instants.last_mut() {
        *last -= sliver;
    }
    for t in signal.breaks(end_s).into_iter().take(2_000) {
        instants.extend([t - sliver, t + sliver]);
    }
    instants.sort_by(f64::total_cmp);
    instants.into_iter().map(|t| (t, signal.at(t))).collect()
}

fn switch_words(times: &[f64]) -> String {
    let shown: Vec<_> = times.iter().take(4).map(|t| number(*t, 4)).collect();
    match (times.len(), shown.join(", ")) {
        (0, _) => String::new(),
        (1, first) => format!(" It switches once, at {first}\u{a0}s."),
        (n, first) if n <= 4 => format!(" It switches {n} times, at {first}\u{a0}s."),
        (n, first) => format!(" It switches {n} times, first at {first}\u{a0}s."),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_drive_is_scaled_by_a_round_factor() {
        for (drive, shown, factor, words) in [
            (8.0, 0.84, 0.1, " ÷ 10"),
            (5.0, 4.0, 0.5, " ÷ 2"),
            (1.0, 1.5, 1.0, ""),
            (0.1, 4.0, 20.0, " × 20"),
        ] {
            let got = scale(drive, shown);
            assert!((got.0 - factor).abs() < 1e-12 && got.1 == words, "{drive} {shown}: {got:?}");
        }
        assert_eq!(scale(0.0, 0.0).0, 1.0);
    }

    #[test]
    fn pulses_have_upright_edges() {
        let pulses = Signal::Pulse { low: 0.0, high: 5.0, period_s: 3.0, duty: 0.5, delay_s: 0.0 };
        let points = signal_points(&pulses, 6.0);
        let edge = points.windows(2).find(|w| w[0].1 == 5.0 && w[1].1 == 0.0).unwrap();
        assert!((edge[0].0 - 1.5).abs() < 1e-6 && edge[1].0 - edge[0].0 < 1e-6);
        assert_eq!(points.last().unwrap().1, 0.0, "the pulse that begins at the end is not shown");
    }
}
