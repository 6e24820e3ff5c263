//! Relay, quantizer, rate limit and Coulomb friction in chains: closed forms, both routes, and the ends of what can be asked.

use super::Nonlinearity::{
    self, Backlash, CoulombFriction, DeadZone, Quantizer, RateLimit, Relay, Saturation,
};
use super::{Block, Chain, ChainError, Run, Signal, simulate, simulate_fixed_step};
use std::f64::consts::{FRAC_PI_6 as SIXTH, PI};

/// 8·sin t.
const SINE: Signal = Signal::Sine { amplitude: 8.0, frequency_rad_s: 1.0, phase_rad: 0.0, bias: 0.0 };

fn pulses(low: f64, high: f64, period_s: f64) -> Signal {
    Signal::Pulse { low, high, period_s, duty: 0.5, delay_s: 0.0 }
}

fn step(amplitude: f64) -> Signal {
    Signal::Step { amplitude, time_s: 0.0 }
}

fn linear(num: &[f64], den: &[f64]) -> Block {
    Block::Linear { num: num.to_vec(), den: den.to_vec() }
}

/// 1/(s + 1)
fn lag() -> Block {
    linear(&[1.0], &[1.0, 1.0])
}

/// 1/s
fn integrator() -> Block {
    linear(&[1.0], &[1.0, 0.0])
}

fn chain(source: Signal, blocks: impl IntoIterator<Item = Block>) -> Chain {
    Chain { source, blocks: blocks.into_iter().collect() }
}

fn block(nonlinearity: Nonlinearity) -> Block {
    Block::Nonlinearity(nonlinearity)
}

fn relay(amplitude: f64, hysteresis: f64, dead_zone: f64) -> Block {
    block(Relay { amplitude, hysteresis, dead_zone })
}

/// Switches there, and has these values; a value at a switching is the one after it.
#[track_caller]
fn check(name: &str, chain: &Chain, duration: f64, switch_times: &[f64], values: &[(f64, f64)]) -> Run {
    let run = simulate(chain, duration).unwrap();
    assert_eq!(run.switch_times.len(), switch_times.len(), "{name}: {:?}", run.switch_times);
    for (found, expected) in run.switch_times.iter().zip(switch_times) {
        assert!((found - expected).abs() < 1e-11 * expected.max(1.0), "{name}: {found}, not {expected}");
    }
    let scale = run.peak.1.max(1e-300);
    for &(t, y) in values {
        assert!((run.at(t) - y).abs() <= 1e-9 * scale, "{name}: {} at {t}, not {y}", run.at(t));
    }
    agrees(name, chain, duration, &run, 2e-5);
    run
}

/// The other route gives the same away from jumps.
#[track_caller]
fn agrees(name: &str, chain: &Chain, duration: f64, run: &Run, tolerance: f64) {
    const STEPS: usize = 20_000;
    let (jumps, near) = (run.jumps(), 3.0 * duration / STEPS as f64);
    let mut compared = 0;
    for (t, y) in simulate_fixed_step(chain, duration, STEPS).unwrap() {
        if jumps.iter().any(|jump| (jump - t).abs() < near) || t < near {
            continue;
        }
        compared += 1;
        let miss = (run.at(t) - y).abs();
        assert!(miss <= tolerance * run.peak.1, "{name}: {} at {t}, by fixed steps {y}", run.at(t));
    }
    assert!(compared > STEPS / 2, "{name}: only {compared} compared");
}

/// Just before and just after each of `times`.
#[track_caller]
fn sides(name: &str, run: &Run, times: &[(f64, f64, f64)]) {
    for &(t, before, after) in times {
        for (t, y) in [(t - 1e-9, before), (t + 1e-9, after)] {
            assert!((run.at(t) - y).abs() < 1e-7, "{name}: {} at {t}, not {y}", run.at(t));
        }
    }
}

#[test]
fn an_ideal_relay_has_the_sign_of_its_input() {
    let run = check("sign", &chain(SINE, [relay(5.0, 0.0, 0.0)]), 7.0, &[PI, 2.0 * PI], &[(0.0, 5.0)]);
    sides("sign", &run, &[(PI, 5.0, -5.0), (2.0 * PI, -5.0, 5.0)]);
    assert_eq!(run.peak, (0.0, 5.0));
    assert_eq!(run.jumps(), run.switch_times);

    // Charging towards ±5 with time constant 1.
    let top = 5.0 * (1.0 - (-PI).exp());
    let low = -5.0 + (top + 5.0) * (-PI).exp();
    let run = check(
        "sign, then a lag",
        &chain(SINE, [relay(5.0, 0.0, 0.0), lag()]),
        7.0,
        &[PI, 2.0 * PI],
        &[
            (1.0, 5.0 * (1.0 - (-1f64).exp())),
            (PI, top),
            (2.0 * PI, low),
            (7.0, 5.0 + (low - 5.0) * (2.0 * PI - 7.0).exp()),
        ],
    );
    assert!((run.peak.0 - PI).abs() < 1e-9 && (run.peak.1 - top).abs() < 1e-9);
    // The input starts flat: 0, and rate 0, and so on, and still goes up at once.
    for order in 1..6 {
        let mut den = vec![0.0; order + 1];
        den[0] = 1.0;
        check(
            "flat start",
            &chain(step(1.0), [linear(&[1.0], &den), relay(5.0, 0.0, 0.0)]),
            1.0,
            &[],
            &[(0.5, 5.0)],
        );
    }
}

#[test]
fn an_input_of_exactly_0_switches_an_ideal_relay_off() {
    let pulsed = chain(pulses(0.0, 3.0, 2.0), [relay(5.0, 0.0, 0.0)]);
    check("pulses", &pulsed, 4.0, &[], &[(0.5, 5.0), (1.0, 0.0), (1.5, 0.0), (2.0, 5.0), (3.5, 0.0)]);
    // The dead zone gives exactly 0 within ±4.
    let behind = chain(SINE, [block(DeadZone { threshold: 4.0 }), relay(5.0, 0.0, 0.0)]);
    let times = [1.0, 5.0, 7.0, 11.0].map(|n| n * SIXTH);
    let run = check(
        "behind a dead zone",
        &behind,
        6.0,
        &times,
        &[(0.1, 0.0), (1.0, 5.0), (PI, 0.0), (4.0, -5.0), (5.9, 0.0)],
    );
    sides("behind a dead zone", &run, &[(times[0], 0.0, 5.0), (times[1], 5.0, 0.0), (times[2], 0.0, -5.0)]);
}

#[test]
fn relays_with_hysteresis_and_dead_zone() {
    // 8·sin t passes ±4 at odd multiples of π/6.
    let run = check(
        "hysteresis",
        &chain(SINE, [relay(5.0, 4.0, 0.0)]),
        14.0,
        &[1.0, 7.0, 13.0, 19.0, 25.0].map(|n| n * SIXTH),
        &[(0.5, 0.0), (3.3, 5.0), (4.0, -5.0)],
    );
    sides("hysteresis", &run, &[(SIXTH, 0.0, 5.0), (7.0 * SIXTH, 5.0, -5.0), (13.0 * SIXTH, -5.0, 5.0)]);
    let times = [SIXTH, 5.0 * SIXTH, 7.0 * SIXTH, 11.0 * SIXTH];
    let run = check("dead zone", &chain(SINE, [relay(5.0, 0.0, 4.0)]), 6.0, &times, &[(0.0, 0.0)]);
    sides(
        "dead zone",
        &run,
        &[(times[0], 0.0, 5.0), (times[1], 5.0, 0.0), (times[2], 0.0, -5.0), (times[3], -5.0, 0.0)],
    );
    // On at 5, off at 3.
    let (on, off) = (0.625f64.asin(), 0.375f64.asin());
    let times = [on, PI - off, PI + on, 2.0 * PI - off];
    let run = check("both", &chain(SINE, [relay(5.0, 1.0, 4.0)]), 6.2, &times, &[(0.0, 0.0)]);
    sides(
        "both",
        &run,
        &[(times[0], 0.0, 5.0), (times[1], 5.0, 0.0), (times[2], 0.0, -5.0), (times[3], -5.0, 0.0)],
    );
    // Pulses from side to side pass the zone at once; exactly at a switching point nothing happens.
    for (low, high, on_low, on_high) in [
        (-6.0, 6.0, -5.0, 5.0),
        (-4.0, 6.0, 0.0, 5.0),
        (4.0, 6.0, 5.0, 5.0),
        (3.0, 6.0, 5.0, 5.0),
        (2.9, 6.0, 0.0, 5.0),
        (2.0, 5.0, 0.0, 0.0),
    ] {
        let jumping = chain(pulses(low, high, 2.0), [relay(5.0, 1.0, 4.0)]);
        check("jumps", &jumping, 4.0, &[], &[(0.5, on_high), (1.5, on_low), (2.5, on_high)]);
    }
}

#[test]
fn a_quantizer_rounds_to_multiples() {
    let times = [0.25, 0.75, 1.25, 1.75];
    let run = check(
        "ramp",
        &chain(step(1.0), [integrator(), block(Quantizer { interval: 0.5 })]),
        2.0,
        &times,
        &[(0.1, 0.0), (2.0, 2.0)],
    );
    sides("ramp", &run, &[(0.25, 0.0, 0.5), (0.75, 0.5, 1.0), (1.25, 1.0, 1.5), (1.75, 1.5, 2.0)]);
    check(
        "down",
        &chain(step(-1.0), [integrator(), block(Quantizer { interval: 0.5 })]),
        2.0,
        &times,
        &[(0.1, 0.0), (2.0, -2.0)],
    );
    // 0.5·(0.5 + 1 + 1.5) and 2 for a quarter of a second.
    check(
        "integrated",
        &chain(step(1.0), [integrator(), block(Quantizer { interval: 0.5 }), integrator()]),
        2.0,
        &times,
        &[(0.25, 0.0), (0.75, 0.25), (1.25, 0.75), (2.0, 2.0)],
    );
    // Halves go away from zero, whatever the fractions round to.
    for (input, interval, output) in [
        (0.75, 0.5, 1.0),
        (-0.75, 0.5, -1.0),
        (0.15, 0.1, 0.2),
        (0.35, 0.1, 0.4),
        (-0.25, 0.5, -0.5),
        (0.249, 0.5, 0.0),
        (1e6, 0.3, 999_999.9),
    ] {
        check("halves", &chain(step(input), [block(Quantizer { interval })]), 1.0, &[], &[(0.5, output)]);
    }
    // A half that is reached and kept.
    let held = chain(
        step(0.75),
        [block(RateLimit { rising: 1.0, falling: -1.0 }), block(Quantizer { interval: 0.5 })],
    );
    check("kept", &held, 2.0, &[0.25, 0.75], &[(0.1, 0.0), (0.5, 0.5), (1.5, 1.0)]);
    // A jump over many levels is one switching, and no more than that is counted.
    let wide = chain(pulses(-5.0, 5.0, 1.0), [block(Quantizer { interval: 1e-6 })]);
    check("many levels at once", &wide, 20.0, &[], &[(0.25, 5.0), (0.75, -5.0)]);
}

#[test]
fn a_rate_limit_trails_what_is_too_fast() {
    let limit = block(RateLimit { rising: 8.0, falling: -4.0 });
    let run = check(
        "pulses",
        &chain(pulses(-1.0, 1.0, 2.0), [limit.clone()]),
        3.0,
        &[0.125, 1.5, 2.25],
        &[
            (0.0, 0.0),
            (0.1, 0.8),
            (0.5, 1.0),
            (1.0, 1.0),
            (1.25, 0.0),
            (1.75, -1.0),
            (2.125, 0.0),
            (3.0, 1.0),
        ],
    );
    assert!(run.jumps().is_empty());
    // Behind from the start until sin t = t/2; let go where 8·cos t = -4, met again while the input rises too fast: by
    // bisection.
    let (caught, left, met) = (1.895494267033981, 2.0 * PI / 3.0, 5.387598242887767f64);
    let slow = RateLimit { rising: 4.0, falling: -4.0 };
    check(
        "sine",
        &chain(SINE, [block(slow)]),
        6.0,
        &[caught, left, met],
        &[
            (1.0, 4.0),
            (caught, 4.0 * caught),
            (2.0, 8.0 * 2f64.sin()),
            (4.0, 8.0 * left.sin() - 4.0 * (4.0 - left)),
            (6.0, 8.0 * met.sin() + 4.0 * (6.0 - met)),
        ],
    );
    check(
        "slow enough",
        &chain(SINE, [block(RateLimit { rising: 8.1, falling: -8.1 })]),
        7.0,
        &[],
        &[(1.0, 8.0 * 1f64.sin())],
    );
    // A bias is climbed from 0.
    let biased = Signal::Sine { amplitude: 0.0, frequency_rad_s: 1.0, phase_rad: 0.0, bias: 2.0 };
    check("bias", &chain(biased, [block(slow)]), 1.0, &[0.5], &[(0.25, 1.0), (0.75, 2.0)]);
    // Turned back before it arrives.
    check(
        "triangle",
        &chain(pulses(-9.0, 9.0, 2.0), [block(slow)]),
        4.0,
        &[],
        &[(0.5, 2.0), (1.0, 4.0), (2.0, 0.0), (3.0, 4.0)],
    );
}

#[test]
fn coulomb_friction_has_the_sign_of_the_speed() {
    let dry = block(CoulombFriction { coulomb: 1.0, viscous: 0.5 });
    let run = check(
        "sine",
        &chain(SINE, [dry.clone()]),
        4.0,
        &[PI],
        &[(1.0, 4.0 * 1f64.sin() + 1.0), (4.0, 4.0 * 4f64.sin() - 1.0)],
    );
    sides("sine", &run, &[(PI, 1.0, -1.0)]);
    let y = |t: f64| 2.0 * (t.sin() - t.cos() + (-t).exp()) + 1.0 - (-t).exp();
    let after = |t: f64| y(t) - 2.0 * (1.0 - (PI - t).exp());
    check(
        "then a lag",
        &chain(SINE, [dry.clone(), lag()]),
        4.0,
        &[PI],
        &[(1.0, y(1.0)), (PI, y(PI)), (4.0, after(4.0))],
    );
    check(
        "rest between",
        &chain(pulses(0.0, 2.0, 2.0), [dry]),
        4.0,
        &[],
        &[(0.5, 2.0), (1.5, 0.0), (2.5, 2.0)],
    );
}

#[test]
fn jumps_go_through_what_stands_behind() {
    // ±1 with jumps at every π.
    let square = relay(1.0, 0.0, 0.0);
    let run = check(
        "rate limit behind a relay",
        &chain(SINE, [square.clone(), block(RateLimit { rising: 2.0, falling: -2.0 })]),
        7.0,
        &[0.5, PI, PI + 1.0, 2.0 * PI],
        &[(0.25, 0.5), (2.0, 1.0), (PI + 0.5, 0.0), (5.0, -1.0), (2.0 * PI + 0.5, 0.0)],
    );
    assert!(run.jumps().is_empty());
    check(
        "gap behind a relay",
        &chain(SINE, [square.clone(), block(Backlash { width: 0.5 })]),
        7.0,
        &[PI, 2.0 * PI],
        &[(0.0, 0.75), (2.0, 0.75), (4.0, -0.75), (6.9, 0.75)],
    );
    check(
        "saturation and relay behind a relay",
        &chain(SINE, [square.clone(), block(Saturation { limit: 0.5 }), relay(3.0, 0.2, 0.0)]),
        7.0,
        &[PI, 2.0 * PI],
        &[(1.0, 3.0), (4.0, -3.0)],
    );
    // Both switch where 8·sin t comes back to 4: the force goes from 2 to exactly 0, and never to -2 on the way. The gap lets
    // go of 1, and of the 1 it then holds only 0 - 1.
    let after_a_zone = [
        block(DeadZone { threshold: 4.0 }),
        block(CoulombFriction { coulomb: 2.0, viscous: 0.25 }),
        block(Backlash { width: 2.0 }),
    ];
    check(
        "two at one instant",
        &chain(SINE, after_a_zone),
        6.0,
        &[SIXTH, PI / 2.0, 5.0 * SIXTH, 7.0 * SIXTH, 1.5 * PI, 11.0 * SIXTH],
        &[
            (0.1, 0.0),
            (PI / 2.0, 2.0),
            (2.0, 2.0),
            (3.0, 1.0),
            (4.0, 2.0 * 4f64.sin()),
            (5.0, -2.0),
            (6.0, -1.0),
        ],
    );
    // (s + 2)/(s + 1) lets the jump through: u = 2 - e^-t, at 1.5 when e^-t = 1/2.
    check(
        "lead between",
        &chain(SINE, [square, linear(&[1.0, 2.0], &[1.0, 1.0]), block(Quantizer { interval: 1.0 })]),
        3.0,
        &[2f64.ln()],
        &[(0.0, 1.0), (0.5, 1.0), (1.0, 2.0)],
    );
}

#[test]
fn long_chains_agree_with_fixed_steps() {
    let every_kind = [
        block(CoulombFriction { coulomb: 1.0, viscous: 0.7 }),
        linear(&[40.0], &[1.0, 3.0, 40.0]),
        block(RateLimit { rising: 9.0, falling: -7.0 }),
        block(Quantizer { interval: 1.5 }),
        linear(&[0.2083], &[1.0, 1.71]),
        relay(2.0, 0.1, 0.3),
        block(RateLimit { rising: 4.0, falling: -5.0 }),
        block(Backlash { width: 0.5 }),
        linear(&[2.0], &[1.0, 2.0]),
    ];
    for source in [
        SINE,
        pulses(-5.0, 6.0, 3.0),
        Signal::Sine { amplitude: 6.0, frequency_rad_s: 0.7, phase_rad: 1.0, bias: 2.0 },
        Signal::Step { amplitude: 7.0, time_s: 2.0 },
    ] {
        let chain = chain(source, every_kind.clone());
        let run = simulate(&chain, 12.0).unwrap();
        assert!(run.peak.1 > 0.0 && run.switch_times.len() > 3, "{source:?}: {:?}", run.switch_times);
        agrees("long", &chain, 12.0, &run, 3e-4);
    }
}

#[test]
fn chattering_and_tiny_intervals_end_in_an_error() {
    let fast = Signal::Sine { amplitude: 5.0, frequency_rad_s: 1e5, phase_rad: 0.0, bias: 0.0 };
    for (name, source, nonlinearity) in [
        ("relay", fast, Relay { amplitude: 1.0, hysteresis: 0.0, dead_zone: 0.0 }),
        ("fine quantizer", SINE, Quantizer { interval: 1e-12 }),
        ("finest quantizer", SINE, Quantizer { interval: f64::MIN_POSITIVE }),
        ("interval not a number", SINE, Quantizer { interval: f64::NAN }),
        ("endless", SINE, Relay { amplitude: f64::INFINITY, hysteresis: 0.0, dead_zone: 0.0 }),
        ("not a rate", SINE, RateLimit { rising: f64::NAN, falling: -1.0 }),
    ] {
        let chain = chain(source, [block(nonlinearity), lag()]);
        let run = simulate(&chain, 10.0);
        assert!(
            matches!(
                run,
                Err(ChainError::TooManySwitches { .. }
                    | ChainError::TooManySteps { .. }
                    | ChainError::NotFinite { .. })
            ),
            "{name}: {:?}",
            run.map(|run| run.switch_times.len())
        );
        let _ = simulate_fixed_step(&chain, 10.0, 1000);
    }
}
