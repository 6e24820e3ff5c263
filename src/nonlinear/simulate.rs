use super::motion::{Branch, Motion, Plan, Quantity, Side};
use super::run::{Piece, Run, halfway};
use super::{Block, Chain, ChainError, Nonlinearity};
use nalgebra::{DMatrix, DVector};

/// Runs `chain` for `duration_s`, from rest.
///
/// Between two switchings the whole chain, source included, is ż = A·z, and each step is the exact one, e^{A·h}. Steps
/// are so short that a quintic meets the output halfway to 1e-9 of its peak, and each quarter of them is searched
/// for a nonlinearity leaving its branch.
///
/// Accuracy: 1e-9 of the peak or better; switching instants about 1e-12 relative. An excursion past a corner that is
/// shorter than a quarter step and wiggles inside it could be missed.
/// Errors: see [`ChainError`]; the call always returns, whatever the numbers.
pub fn simulate(chain: &Chain, duration_s: f64) -> Result<Run, ChainError> {
    if !duration_s.is_finite() {
        return Err(ChainError::NotFinite { time_s: 0.0 });
    }
    let plan = Plan::new(chain)?;
    let branches = plan.resting_branches();
    let mut simulation = Simulation {
        motion: plan.motion(&branches),
        state: plan.rest(),
        scales: vec![[0.0; 2]; chain.blocks.len()],
        branches,
        plan,
        time: 0.0,
        edge: 0.0,
        quarter: None,
        steps: 0,
        switches: 0,
        switch_times: Vec::new(),
        kept: Vec::new(),
        output_scale: 0.0,
        peak: (0.0, 0.0),
        pieces: Vec::new(),
    };
    simulation.take_source_edge()?;
    let first = simulation.motion.output.in_state(&simulation.state)[0];

    let end = duration_s.max(0.0);
    let mut step = end / 64.0;
    while simulation.time < end {
        let next_edge = chain.source.next_break(simulation.time).filter(|&t| t < end);
        simulation.run_until(next_edge.unwrap_or(end), &mut step)?;
        if next_edge.is_some() {
            simulation.take_source_edge()?;
        }
    }
    if !simulation.peak.1.is_finite() {
        return Err(ChainError::NotFinite { time_s: simulation.time });
    }
    let Simulation { pieces, switch_times, peak, mut kept, .. } = simulation;
    kept.sort_by(f64::total_cmp);
    Ok(Run::new(pieces, first, switch_times, peak, &kept))
}

/// Steps, retries included: room for pulse trains of a kilohertz over ten seconds.
const STEPS_LIMIT: usize = 30_000;
/// More switchings than a figure can show.
const SWITCHES_LIMIT: usize = 2_000;
/// How far, as a share of the peak, a quintic over half a step may miss the output.
const OUTPUT_TOLERANCE: f64 = 1e-9;
/// The same for what is watched for switchings: there it only has to show whether a bound is passed.
const GUARD_TOLERANCE: f64 = 1e-6;
/// A guarded quantity has left its range when it is out by this share of the largest it is made of: more than rounding.
const NOISE: f64 = 1e-12;

struct Simulation<'a> {
    plan: Plan<'a>,
    branches: Vec<Option<Branch>>,
    motion: Motion,
    state: DVector<f64>,
    time: f64,
    /// The last source edge, 0 included.
    edge: f64,
    /// e^{A·h/4} of the last step length h.
    quarter: Option<(f64, DMatrix<f64>)>,
    /// For each block the largest the guarded value, and the guarded rate, have been made of.
    scales: Vec<[f64; 2]>,
    steps: usize,
    switches: usize,
    switch_times: Vec<f64>,
    kept: Vec<f64>,
    output_scale: f64,
    peak: (f64, f64),
    pieces: Vec<Piece>,
}

/// A guard found broken within a step: which, where, and the state there.
struct Event {
    guard: usize,
    side: Side,
    /// Quarter of the step, and seconds into it.
    quarter: usize,
    offset: f64,
    state: DVector<f64>,
}

impl Simulation<'_> {
    /// Advances to `end`, through switchings, starting with steps of `step` and leaving there what suited last.
    fn run_until(&mut self, end: f64, step: &mut f64) -> Result<(), ChainError> {
        // Below this a step would not move the clock reliably.
        let shortest = 1e-13 * end;
        while self.time < end {
            self.steps += 1;
            if self.steps > STEPS_LIMIT {
                return Err(ChainError::TooManySteps { limit: STEPS_LIMIT, time_s: self.time });
            }
            let rest = end - self.time;
            let last = *step * 1.0001 >= rest;
            let h = if last { rest } else { step.max(shortest) };
            let states = self.quarter_states(h)?;
            let roughness = self.roughness(&states, h);
            if roughness > 1.0 && h > shortest {
                *step = h / 2.0;
                continue;
            }
            let (committed, event) = match self.first_event(&states, h) {
                Some(event) => (event.quarter, Some(event)),
                None => (4, None),
            };
            let start = self.time;
            for quarter in 0..committed {
                let to = if last && quarter == 3 { end } else { start + h * (quarter + 1) as f64 / 4.0 };
                self.commit(to, &states[quarter], &states[quarter + 1]);
            }
            let Some(event) = event else {
                self.state.copy_from(&states[4]);
                self.plan.drive_smoothly(&mut self.state, self.time);
                if roughness < 1.0 / 128.0 {
                    *step = (2.0 * h).max(*step);
                }
                continue;
            };
            let to = (start + h * event.quarter as f64 / 4.0 + event.offset).min(end);
            self.commit(to, &states[event.quarter], &event.state);
            self.state = event.state;
            self.plan.drive_smoothly(&mut self.state, self.time);
            let before = self.held();
            let block = self.motion.guards[event.guard].block;
            self.switch(event.guard, event.side)?;
            self.settle(&before, Some((block, event.side)))?;
        }
        Ok(())
    }

    /// The states at the start of a step of `h` and at its four quarters.
    fn quarter_states(&mut self, h: f64) -> Result<[DVector<f64>; 5], ChainError> {
        let exponential = match self.quarter.take() {
            // Lengths that differ by the rounding of the clock are the same.
            Some((length, exponential)) if (length - h).abs() <= 4.0 * f64::EPSILON * self.time => {
                exponential
            }
            _ => (&self.motion.a * (h / 4.0)).exp(),
        };
        let mut states = [const { None::<DVector<f64>> }; 5].map(|_| self.state.clone());
        for quarter in 0..4 {
            states[quarter + 1] = &exponential * &states[quarter];
        }
        self.quarter = Some((h, exponential));
        if states[4].iter().all(|value| value.is_finite()) {
            Ok(states)
        } else {
            Err(ChainError::NotFinite { time_s: self.time })
        }
    }

    /// How far quintics over the halves of the step miss the quarters, in units of what is allowed.
    fn roughness(&mut self, states: &[DVector<f64>; 5], h: f64) -> f64 {
        let miss = |quantity: &Quantity| {
            let values = states.each_ref().map(|state| quantity.in_state(state));
            let halves = [(0, 1, 2), (2, 3, 4)];
            let miss = halves.map(|(from, middle, to)| {
                (halfway(values[from], values[to], h / 2.0) - values[middle][0]).abs()
            });
            (miss[0].max(miss[1]), values.iter().map(|value| value[0].abs()).fold(0.0, f64::max))
        };
        let (output_miss, output_size) = miss(&self.motion.output);
        self.output_scale = self.output_scale.max(output_size);
        let mut worst = ratio(output_miss, OUTPUT_TOLERANCE * self.output_scale);
        for guard in &self.motion.guards {
            let (miss, _) = miss(&guard.quantity);
            let scale = &mut self.scales[guard.block][usize::from(guard.on_rate)];
            for state in states {
                *scale = scale.max(guard.quantity.terms(state));
            }
            worst = worst.max(ratio(miss, GUARD_TOLERANCE * *scale));
        }
        worst
    }

    /// The earliest instant in the step at which a guard is broken.
    fn first_event(&self, states: &[DVector<f64>; 5], h: f64) -> Option<Event> {
        let length = h / 4.0;
        for quarter in 0..4 {
            let (from, to) = (&states[quarter], &states[quarter + 1]);
            let mut first: Option<Event> = None;
            for (index, guard) in self.motion.guards.iter().enumerate() {
                let noise = NOISE * self.scales[guard.block][usize::from(guard.on_rate)];
                for (side, sign) in [(Side::Below, -1.0), (Side::Above, 1.0)] {
                    let [start_value, start_rate, _] = guard.quantity.in_state(from);
                    let [end_value, end_rate, _] = guard.quantity.in_state(to);
                    // Out at the end of the quarter, or out at an extremum within it; twice the first slope cannot
                    // be passed by a curve that bends back.
                    let reach = guard.excess(side, start_value) + 2.0 * length * start_rate.abs();
                    let until = if guard.excess(side, end_value) > noise {
                        length
                    } else if reach > noise && sign * start_rate > 0.0 && sign * end_rate < 0.0 {
                        let extremum = root(length, |offset| {
                            let [_, rate, second] = guard.quantity.in_state(&self.state_after(from, offset));
                            (sign * rate, sign * second)
                        });
                        let [value, ..] = guard.quantity.in_state(&self.state_after(from, extremum));
                        if guard.excess(side, value) <= noise {
                            continue;
                        }
                        extremum
                    } else {
                        continue;
                    };
                    let offset = root(until, |offset| {
                        let [value, rate, _] = guard.quantity.in_state(&self.state_after(from, offset));
                        (-guard.excess(side, value), -sign * rate)
                    });
                    // Of two at one instant the one farther up the chain decides what the other gets to see.
                    let instant = NOISE * (self.time + h);
                    if first.as_ref().is_none_or(|event| offset + instant < event.offset) {
                        let state = self.state_after(from, offset);
                        first = Some(Event { guard: index, side, quarter, offset, state });
                    }
                }
            }
            if first.is_some() {
                return first;
            }
        }
        None
    }

    fn state_after(&self, state: &DVector<f64>, seconds: f64) -> DVector<f64> {
        (&self.motion.a * seconds).exp() * state
    }

    /// Moves the clock to `to` and records the output on the way there, split at its extremum if it has one.
    fn commit(&mut self, to: f64, start: &DVector<f64>, end: &DVector<f64>) {
        let from = self.time;
        if to <= from {
            return;
        }
        let [starts, ends] = [start, end].map(|state| self.motion.output.in_state(state));
        if starts[1] * ends[1] < 0.0 {
            let offset = root(to - from, |offset| {
                let [_, rate, second] = self.motion.output.in_state(&self.state_after(start, offset));
                (starts[1].signum() * rate, starts[1].signum() * second)
            });
            let middle = from + offset;
            if from < middle && middle < to {
                let values = self.motion.output.in_state(&self.state_after(start, offset));
                self.note_peak(middle, values[0]);
                self.kept.push(middle);
                self.pieces.push(Piece { from, to: middle, start: starts, end: values });
                self.pieces.push(Piece { from: middle, to, start: values, end: ends });
                self.note_peak(to, ends[0]);
                self.time = to;
                return;
            }
        }
        self.pieces.push(Piece { from, to, start: starts, end: ends });
        self.note_peak(to, ends[0]);
        self.time = to;
    }

    fn note_peak(&mut self, t: f64, value: f64) {
        // Equal peaks differ by rounding; the first is the one to name.
        if value.abs() > self.peak.1 * (1.0 + 1e-12) {
            self.peak = (t, value.abs());
        }
    }

    /// Puts the nonlinearity behind a broken guard on its next branch.
    fn switch(&mut self, guard: usize, side: Side) -> Result<(), ChainError> {
        self.count_switch()?;
        let block = self.motion.guards[guard].block;
        let Some(branch) = self.branches[block] else { return Ok(()) };
        // A level is found when its block settles.
        if !matches!(branch, Branch::Level(_)) {
            self.change_branch(block, branch.after(side));
        }
        self.note_switch();
        Ok(())
    }

    fn count_switch(&mut self) -> Result<(), ChainError> {
        self.switches += 1;
        if self.switches > SWITCHES_LIMIT {
            return Err(ChainError::TooManySwitches { limit: SWITCHES_LIMIT, time_s: self.time });
        }
        Ok(())
    }

    fn note_switch(&mut self) {
        // What switches together with the source is the source's doing.
        if self.time - self.edge > NOISE * self.time && self.switch_times.last() != Some(&self.time) {
            self.switch_times.push(self.time);
            self.kept.push(self.time);
        }
    }

    fn change_branch(&mut self, block: usize, branch: Branch) {
        if matches!(branch, Branch::Free | Branch::Rise | Branch::Fall)
            && let Some((_, _, output)) = self.motion.holders.iter().find(|holder| holder.0 == block)
        {
            let held = output.in_state(&self.state)[0];
            self.state[self.plan.held(block)] = held;
        }
        self.branches[block] = Some(branch);
        self.motion = self.plan.motion(&self.branches);
        self.quarter = None;
    }

    /// What every backlash and rate limit takes in and gives out.
    fn held(&self) -> Vec<Held> {
        let value = |quantity: &Quantity| quantity.in_state(&self.state)[0];
        let holders = self.motion.holders.iter();
        holders.map(|(block, input, output)| (*block, value(input), value(output))).collect()
    }

    /// Switches, down the chain, whatever is not where it may be in the present state.
    ///
    /// `before` is what was held when the signals last were continuous, `crossed` the block whose guard has just been
    /// broken.
    fn settle(&mut self, before: &[Held], crossed: Option<(usize, Side)>) -> Result<(), ChainError> {
        for block in 0..self.branches.len() {
            self.carry(block, before);
            if matches!(self.branches[block], Some(Branch::Level(_))) {
                let side = crossed.filter(|(index, _)| *index == block).map(|(_, side)| side);
                self.settle_level(block, side)?;
            } else {
                self.settle_block(block)?;
            }
        }
        self.note_peak(self.time, self.motion.output.in_state(&self.state)[0]);
        Ok(())
    }

    /// A jump carries a backlash from wherever it was, as if its gap had been free at the output it had, and leaves a rate
    /// limit behind at the output it had.
    fn carry(&mut self, block: usize, before: &[Held]) {
        let Some((_, input_before, output_before)) = before.iter().find(|held| held.0 == block).copied()
        else {
            return;
        };
        let Some((_, input, _)) = self.motion.holders.iter().find(|holder| holder.0 == block) else { return };
        let value = input.in_state(&self.state)[0];
        let noise = NOISE * input.terms(&self.state).max(output_before.abs());
        if (value - input_before).abs() <= noise {
            return;
        }
        let branch = match self.branches[block] {
            Some(Branch::Follow | Branch::Rise | Branch::Fall) => {
                if value - output_before > noise {
                    Branch::Rise
                } else if value - output_before < -noise {
                    Branch::Fall
                } else {
                    Branch::Follow
                }
            }
            _ => Branch::Free,
        };
        self.change_branch(block, branch);
        self.state[self.plan.held(block)] = output_before;
    }

    fn settle_block(&mut self, block: usize) -> Result<(), ChainError> {
        // From one end of a characteristic to the other takes two switchings.
        for _ in 0..3 {
            let Some(index) = self.motion.guards.iter().position(|guard| guard.block == block) else { break };
            let guard = &self.motion.guards[index];
            let scale = &mut self.scales[block][usize::from(guard.on_rate)];
            *scale = scale.max(guard.quantity.terms(&self.state));
            let noise = NOISE * *scale;
            let [value, ..] = guard.quantity.in_state(&self.state);
            let broken =
                [Side::Below, Side::Above].into_iter().find(|&side| guard.excess(side, value) > noise);
            let Some(side) = broken else { break };
            self.switch(index, side)?;
        }
        Ok(())
    }

    /// Puts a block on the level its input is on, or is going to: to the one on `side` if its guard was broken there.
    fn settle_level(&mut self, block: usize, side: Option<Side>) -> Result<(), ChainError> {
        let (Some(Branch::Level(level)), Some(Block::Nonlinearity(nonlinearity))) =
            (self.branches[block], self.plan.block(block))
        else {
            return Ok(());
        };
        let nonlinearity: Nonlinearity = *nonlinearity;
        let Some(guard) = self.motion.guards.iter().find(|guard| guard.block == block) else { return Ok(()) };
        let scale = &mut self.scales[block][0];
        *scale = scale.max(guard.quantity.terms(&self.state));
        let [input, ..] = guard.quantity.in_state(&self.state);
        let next = match nonlinearity.edge_near(input, NOISE * *scale) {
            None => nonlinearity.level(input, level),
            Some(edge) => match side.or_else(|| guard.quantity.direction(&self.state, &self.motion.a)) {
                Some(side) => nonlinearity.level_beside(edge, side == Side::Above, level),
                None => nonlinearity.level(edge, level),
            },
        };
        if next != level {
            if side.is_none() {
                self.count_switch()?;
                self.note_switch();
            }
            self.change_branch(block, Branch::Level(next));
        }
        Ok(())
    }

    /// Lets the source jump (or start) at the present time, and everything behind it with it.
    fn take_source_edge(&mut self) -> Result<(), ChainError> {
        self.edge = self.time;
        self.kept.push(self.time);
        let mut before = self.held();
        if self.time == 0.0 {
            // At rest nothing goes in or out, whatever the source is about to start from.
            before.iter_mut().for_each(|held| (held.1, held.2) = (0.0, 0.0));
        }
        self.plan.drive(&mut self.state, self.time);
        self.settle(&before, None)
    }
}

/// A backlash or rate limit with its input and output.
type Held = (usize, f64, f64);

fn ratio(miss: f64, allowed: f64) -> f64 {
    if miss == 0.0 { 0.0 } else { miss / allowed.max(f64::MIN_POSITIVE) }
}

/// Where `f` (value and slope), positive or zero at 0 and negative at `length`, passes zero; to rounding.
///
/// Newton's method, kept within a bracket that is halved when a step leaves it.
fn root(length: f64, f: impl Fn(f64) -> (f64, f64)) -> f64 {
    let (mut low, mut high) = (0.0, length);
    let mut x = length / 2.0;
    for _ in 0..80 {
        let (value, slope) = f(x);
        if value >= 0.0 {
            low = x;
        } else {
            high = x;
        }
        let newton = x - value / slope;
        let next = if low < newton && newton < high { newton } else { (low + high) / 2.0 };
        if (next - x).abs() <= 1e-15 * length || high - low <= 1e-15 * length {
            return next;
        }
        x = next;
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::nonlinear::{Block, Nonlinearity, Signal, simulate_fixed_step, without_nonlinearities};
    use Nonlinearity::{Backlash, DeadZone, Saturation};
    use std::f64::consts::{PI, TAU};

    const SINE: Signal = Signal::Sine { amplitude: 8.0, frequency_rad_s: 1.0, phase_rad: 0.0, bias: 0.0 };

    fn pulses(low: f64, high: f64, period_s: f64) -> Signal {
        Signal::Pulse { low, high, period_s, duty: 0.5, delay_s: 0.0 }
    }

    fn linear(num: &[f64], den: &[f64]) -> Block {
        Block::Linear { num: num.to_vec(), den: den.to_vec() }
    }

    /// Volts to rad/s, and to rad.
    fn motor() -> Block {
        linear(&[0.2083], &[1.0, 1.71])
    }

    fn motor_position() -> Block {
        linear(&[0.2083], &[1.0, 1.71, 0.0])
    }

    fn chain(source: Signal, blocks: impl IntoIterator<Item = Block>) -> Chain {
        Chain { source, blocks: blocks.into_iter().collect() }
    }

    struct Expected<'a> {
        switch_times: &'a [f64],
        peak: (f64, f64),
        values: &'a [(f64, f64)],
    }

    #[track_caller]
    fn check(name: &str, chain: &Chain, duration: f64, expected: &Expected) -> Run {
        let run = simulate(chain, duration).unwrap();
        assert_eq!(run.switch_times.len(), expected.switch_times.len(), "{name}: {:?}", run.switch_times);
        for (found, expected) in run.switch_times.iter().zip(expected.switch_times) {
            assert!(
                (found - expected).abs() < 1e-11 * expected.max(1.0),
                "{name}: switch at {found}, not {expected}"
            );
            assert!(run.samples.iter().any(|(t, _)| t == found), "{name}: no sample at {found}");
        }
        assert!((run.peak.1 - expected.peak.1).abs() <= 1e-11 * expected.peak.1, "{name}: {:?}", run.peak);
        assert!((run.peak.0 - expected.peak.0).abs() < 1e-6, "{name}: {:?}", run.peak);
        for &(t, y) in expected.values {
            let error = (run.at(t) - y).abs();
            assert!(error <= 1e-9 * expected.peak.1, "{name}: {} at {t}, not {y}", run.at(t));
        }
        agrees_with_fixed_step(name, chain, duration, &run);
        run
    }

    /// The other route gives the same curve, and the samples drawn lie on it.
    #[track_caller]
    fn agrees_with_fixed_step(name: &str, chain: &Chain, duration: f64, run: &Run) {
        let scale = run.peak.1.max(1e-300);
        for (t, y) in simulate_fixed_step(chain, duration, 20_000).unwrap() {
            // At a jump there are two values at one instant.
            let near = (run.at(t) - y).abs().min((run.at(t.next_down()) - y).abs());
            assert!(near < 1e-5 * scale, "{name}: {} at {t}, by fixed steps {y}", run.at(t));
        }
        for pair in run.samples.windows(2) {
            assert!(pair[0].0 <= pair[1].0, "{name}: samples out of order at {}", pair[0].0);
            if pair[0].0 < pair[1].0 {
                let middle = (pair[0].0 + pair[1].0) / 2.0;
                let miss = (run.at(middle) - (pair[0].1 + pair[1].1) / 2.0).abs();
                assert!(miss < 1e-3 * scale, "{name}: a line misses the curve by {miss} at {middle}");
            }
        }
    }

    // Values in the next four tests: closed form between switchings, mpmath 1.3 with 30 digits.

    #[test]
    fn motor_under_a_sine() {
        check(
            "linear",
            &chain(SINE, [motor()]),
            20.0,
            &Expected {
                switch_times: &[],
                peak: (2.07512423817287, 0.853176762483421),
                values: &[(1.0, 0.458409212367661), (7.3, 0.394155936723695), (20.0, 0.489653605599647)],
            },
        );
    }

    #[test]
    fn motor_behind_a_saturation() {
        let corner = (5.0f64 / 8.0).asin();
        let mut corners: Vec<f64> =
            (0..7).flat_map(|n| [f64::from(n) * PI + corner, f64::from(n + 1) * PI - corner]).collect();
        corners.pop();
        let run = check(
            "saturation",
            &chain(SINE, [Block::Nonlinearity(Saturation { limit: 5.0 }), motor()]),
            20.0,
            &Expected {
                switch_times: &corners,
                peak: (2.48757338798472, 0.592869239891208),
                values: &[(1.0, 0.406610564042502), (7.3, 0.348696131553355), (20.0, 0.401882709297249)],
            },
        );
        assert!(run.samples.len() < 600, "{} samples", run.samples.len());
    }

    #[test]
    fn motor_behind_a_dead_zone() {
        let corner = (1.0f64 / 8.0).asin();
        let mut corners: Vec<f64> =
            (0..7).flat_map(|n| [f64::from(n) * PI + corner, f64::from(n + 1) * PI - corner]).collect();
        corners.pop();
        let run = check(
            "dead zone",
            &chain(SINE, [Block::Nonlinearity(DeadZone { threshold: 1.0 }), motor()]),
            20.0,
            &Expected {
                switch_times: &corners,
                peak: (2.06670172359459, 0.735299737780495),
                values: &[
                    (0.1, 0.0),
                    (1.0, 0.361163562807893),
                    (7.3, 0.315285661504051),
                    (20.0, 0.402011402245222),
                ],
            },
        );
        assert_eq!(run.at(corner / 2.0), 0.0);
    }

    #[test]
    fn backlash_behind_a_motor() {
        let play = Block::Nonlinearity(Backlash { width: 0.15 });
        // Never reversed: half the width is lost, once and for good.
        let forward = chain(pulses(0.0, 5.0, 3.0), [motor_position(), play.clone()]);
        let run = check(
            "0/5 V",
            &forward,
            12.0,
            &Expected {
                switch_times: &[0.42538612208024],
                peak: (12.0, 3.55394587777861),
                values: &[(0.4, 0.0), (2.0, 0.698771436502445), (12.0, 3.55394587777861)],
            },
        );
        let without = simulate(&without_nonlinearities(&forward), 12.0).unwrap();
        for t in [0.5, 1.5, 3.2, 9.9, 11.9] {
            assert!((without.at(t) - run.at(t) - 0.075).abs() < 1e-9, "at {t}");
        }

        let reversing = chain(pulses(-5.0, 5.0, 3.0), [motor_position(), play]);
        let run = check(
            "-5/+5 V",
            &reversing,
            12.0,
            &Expected {
                switch_times: &[
                    0.42538612208024,
                    1.88241432342389,
                    2.51535813716423,
                    3.36041424482652,
                    3.99335805856685,
                    4.86213616914574,
                    5.49507998288608,
                    6.36200389998558,
                    6.99494771372591,
                    7.86201407508326,
                    8.49495788882359,
                    9.36201329242936,
                    9.99495710616969,
                    10.8620133526305,
                    11.4949571663708,
                ],
                peak: (10.8620133526305, 0.618107072067452),
                values: &[(3.36041424482652, 0.294515459641416), (12.0, 0.380297794585886)],
            },
        );
        // Held while the gap is crossed.
        for (from, to) in [(1.88241432342389, 2.51535813716423), (3.36041424482652, 3.99335805856685)] {
            let held = run.at((from + to) / 2.0);
            assert!((run.at(from) - held).abs() < 1e-12 && (run.at(to) - held).abs() < 1e-12);
        }
    }

    #[test]
    fn a_triangle_goes_round_the_loop_of_the_gap() {
        // Speed ±2 turns at 0.5, 1.5, 2.5 …: a triangle between 0 and 1 that turns at source edges.
        let triangle = chain(
            Signal::Pulse { low: -2.0, high: 2.0, period_s: 1.0, duty: 0.5, delay_s: 0.0 },
            [linear(&[1.0], &[1.0, 0.0]), Block::Nonlinearity(Backlash { width: 0.4 })],
        );
        check(
            "triangle",
            &triangle,
            2.0,
            &Expected {
                // 0.2 passed at 0.1; from the top, 0.4 crossed in 0.2 s; from the bottom the same.
                switch_times: &[0.1, 0.7, 1.2, 1.7],
                peak: (0.5, 0.8),
                values: &[
                    (0.05, 0.0),
                    (0.3, 0.4),
                    (0.6, 0.8),
                    (0.9, 0.4),
                    (1.1, 0.2),
                    (1.4, 0.6),
                    (2.0, 0.2),
                ],
            },
        );
    }

    #[test]
    fn a_sine_straight_into_the_gap() {
        let sine = Signal::Sine { amplitude: 2.0, frequency_rad_s: TAU, phase_rad: 0.0, bias: 0.0 };
        let back = 1.0; // the top, 2, less the width
        let down = 0.5 - (back / 2.0f64).asin() / TAU;
        check(
            "sine",
            &chain(sine, [Block::Nonlinearity(Backlash { width: 1.0 })]),
            1.25,
            &Expected {
                switch_times: &[(0.25f64).asin() / TAU, 0.25, down, 0.75, 0.5 + down],
                peak: (0.25, 1.5),
                values: &[(0.3, 1.5), (0.5, 0.5), (0.8, -1.5), (1.25, 1.5)],
            },
        );
    }

    #[test]
    fn jumps_pass_through_what_has_no_inertia() {
        let run = check(
            "saturated pulses",
            &chain(pulses(-5.0, 5.0, 2.0), [Block::Nonlinearity(Saturation { limit: 3.0 })]),
            3.0,
            &Expected { switch_times: &[], peak: (0.0, 3.0), values: &[(0.5, 3.0), (1.0, -3.0), (2.0, 3.0)] },
        );
        assert_eq!(run.samples, [(0.0, 3.0), (1.0, 3.0), (1.0, -3.0), (2.0, -3.0), (2.0, 3.0), (3.0, 3.0)]);
        check(
            "pulses through a gap",
            &chain(pulses(-5.0, 5.0, 2.0), [Block::Nonlinearity(Backlash { width: 4.0 })]),
            3.0,
            &Expected { switch_times: &[], peak: (0.0, 3.0), values: &[(0.5, 3.0), (1.0, -3.0), (2.0, 3.0)] },
        );
        check(
            "pulses lost in a gap",
            &chain(pulses(-1.0, 1.0, 2.0), [Block::Nonlinearity(Backlash { width: 4.0 })]),
            3.0,
            &Expected { switch_times: &[], peak: (0.0, 0.0), values: &[(0.5, 0.0), (1.0, 0.0)] },
        );
        // (s + 2)/(s + 1) jumps to 1 and creeps to 2, so the limit of 1.5 is met when e^-t = 1/2.
        check(
            "lead, then saturation",
            &chain(
                Signal::Step { amplitude: 1.0, time_s: 1.0 },
                [linear(&[1.0, 2.0], &[1.0, 1.0]), Block::Nonlinearity(Saturation { limit: 1.5 })],
            ),
            4.0,
            &Expected {
                switch_times: &[1.0 + 2f64.ln()],
                peak: (1.0 + 2f64.ln(), 1.5),
                values: &[(0.5, 0.0), (1.0, 1.0), (1.5, 2.0 - (-0.5f64).exp()), (3.0, 1.5)],
            },
        );
        // (2s + 1)/(s + 1) jumps to 2 and falls to 1: the peak is the jump.
        check(
            "lag that overshoots at once",
            &chain(Signal::Step { amplitude: 1.0, time_s: 1.0 }, [linear(&[2.0, 1.0], &[1.0, 1.0])]),
            4.0,
            &Expected {
                switch_times: &[],
                peak: (1.0, 2.0),
                values: &[(0.5, 0.0), (2.0, 1.0 + (-1.0f64).exp())],
            },
        );
    }

    #[test]
    fn long_chains_agree_with_fixed_steps() {
        let every_kind = [
            Block::Nonlinearity(DeadZone { threshold: 1.0 }),
            linear(&[40.0], &[1.0, 3.0, 40.0]),
            Block::Nonlinearity(Saturation { limit: 5.0 }),
            motor_position(),
            Block::Nonlinearity(Backlash { width: 0.15 }),
            linear(&[1.0, 0.0], &[0.2, 1.0]),
            Block::Nonlinearity(Saturation { limit: 0.3 }),
            Block::Nonlinearity(DeadZone { threshold: 0.05 }),
            linear(&[2.0], &[1.0, 2.0]),
        ];
        let sources = [
            SINE,
            pulses(-5.0, 6.0, 3.0),
            Signal::Sine { amplitude: 6.0, frequency_rad_s: 0.7, phase_rad: 1.0, bias: 2.0 },
            Signal::Step { amplitude: 7.0, time_s: 2.0 },
        ];
        for source in sources {
            let chain = chain(source, every_kind.clone());
            let run = simulate(&chain, 12.0).unwrap();
            let scale = run.peak.1;
            assert!(scale > 0.0 && run.switch_times.len() > 3, "{source:?}: {:?}", run.switch_times);
            for (t, y) in simulate_fixed_step(&chain, 12.0, 50_000).unwrap() {
                assert!((run.at(t) - y).abs() < 5e-5 * scale, "{source:?}: {} at {t}, {y}", run.at(t));
            }
        }
    }

    #[test]
    fn two_gaps_in_series_are_one_as_wide_as_both() {
        let gaps = |widths: &[f64]| {
            let blocks = [motor_position()];
            let gaps = widths.iter().map(|&width| Block::Nonlinearity(Backlash { width }));
            simulate(&chain(pulses(-5.0, 5.0, 3.0), blocks.into_iter().chain(gaps)), 12.0).unwrap()
        };
        let (two, one) = (gaps(&[0.1, 0.05]), gaps(&[0.15]));
        for i in 0..=1200 {
            let t = f64::from(i) / 100.0;
            assert!((two.at(t) - one.at(t)).abs() < 1e-9, "at {t}");
        }
    }

    #[test]
    fn zero_width_means_nothing_there() {
        for (nonlinearity, same) in [
            (DeadZone { threshold: 0.0 }, true),
            (Backlash { width: 0.0 }, true),
            (Saturation { limit: 1e9 }, true),
            (Saturation { limit: 0.0 }, false),
            (DeadZone { threshold: 1e9 }, false),
        ] {
            let run = simulate(&chain(SINE, [Block::Nonlinearity(nonlinearity), motor()]), 7.0).unwrap();
            assert_eq!(run.switch_times, [0.0; 0], "{nonlinearity:?}");
            let expected = if same { 0.853176762483421 } else { 0.0 };
            assert!((run.peak.1 - expected).abs() < 1e-12, "{nonlinearity:?}: {:?}", run.peak);
        }
    }

    #[test]
    fn fast_modes_die_out_without_holding_up_the_rest() {
        // A microsecond of inductance before a motor of seconds.
        let stiff = chain(
            SINE,
            [linear(&[1e6], &[1.0, 1e6]), Block::Nonlinearity(Saturation { limit: 5.0 }), motor()],
        );
        let run = simulate(&stiff, 20.0).unwrap();
        assert_eq!(run.switch_times.len(), 13);
        assert!((run.switch_times[0] - (0.625f64).asin() - 1e-6).abs() < 1e-9, "{}", run.switch_times[0]);
        assert!((run.peak.1 - 0.592869239891208).abs() < 1e-6);
    }

    #[test]
    fn a_touch_of_the_corner_is_not_missed() {
        // Over the limit by one part in 1e9, for 28 µs in each half period.
        let limit = 8.0 * (1.0 - 1e-9);
        let run = simulate(&chain(SINE, [Block::Nonlinearity(Saturation { limit })]), 3.0).unwrap();
        let corner = (limit / 8.0).asin();
        assert_eq!(run.switch_times.len(), 2);
        assert!(
            (run.switch_times[0] - corner).abs() < 1e-10
                && (run.switch_times[1] - (PI - corner)).abs() < 1e-10
        );
        assert!((run.peak.1 - limit).abs() < 1e-12);
    }

    #[test]
    fn every_chain_comes_back() {
        let unstable = linear(&[1.0], &[1.0, -50.0]);
        let saturation = Block::Nonlinearity(Saturation { limit: 1.0 });
        let fast = Signal::Sine { amplitude: 5.0, frequency_rad_s: 1e5, phase_rad: 0.0, bias: 0.0 };
        type Test = fn(&Result<Run, ChainError>) -> bool;
        let rows: [(&str, Chain, f64, Test); 11] = [
            ("no time", chain(SINE, [motor()]), 0.0, |r| {
                r.as_ref().is_ok_and(|run| run.samples == [(0.0, 0.0)])
            }),
            ("negative time", chain(SINE, [motor()]), -1.0, |r| {
                r.as_ref().is_ok_and(|run| run.at(3.0) == 0.0)
            }),
            ("endless time", chain(SINE, [motor()]), f64::INFINITY, |r| {
                matches!(r, Err(ChainError::NotFinite { .. }))
            }),
            ("no blocks", chain(SINE, []), 4.0, |r| {
                r.as_ref().is_ok_and(|run| (run.peak.1 - 8.0).abs() < 1e-12)
            }),
            ("pulses of 1 ns", chain(pulses(0.0, 5.0, 1e-9), [motor()]), 10.0, |r| {
                matches!(r, Err(ChainError::TooManySteps { .. }))
            }),
            ("period of 0", chain(pulses(0.0, 5.0, 0.0), [motor()]), 10.0, |r| r.is_ok()),
            ("thousands of switchings", chain(fast, [saturation.clone(), motor()]), 10.0, |r| {
                matches!(r, Err(ChainError::TooManySwitches { .. } | ChainError::TooManySteps { .. }))
            }),
            ("explosion", chain(SINE, [unstable]), 100.0, |r| matches!(r, Err(ChainError::NotFinite { .. }))),
            (
                "limit not a number",
                chain(SINE, [Block::Nonlinearity(Saturation { limit: f64::NAN })]),
                1.0,
                |r| r.is_err(),
            ),
            ("improper", chain(SINE, [linear(&[1.0, 0.0], &[1.0])]), 1.0, |r| {
                *r == Err(ChainError::Improper { index: 0, num: 1, den: 0 })
            }),
            (
                "amplitude not a number",
                chain(Signal::Step { amplitude: f64::NAN, time_s: 0.0 }, [motor()]),
                1.0,
                |r| r.is_err(),
            ),
        ];
        for (name, chain, duration, test) in rows {
            let result = simulate(&chain, duration);
            assert!(test(&result), "{name}: {:?}", result.map(|run| (run.peak, run.samples.len())));
            // The other route returns as well.
            let _ = simulate_fixed_step(&chain, duration, 100);
        }
    }
}
