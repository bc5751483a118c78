//! Flexure that follows the ship late or through a resonator, against its definition.
#![allow(clippy::unwrap_used)]

use frames::unit::{ARCSEC, DEGREE};
use frames::{Main, Nav, Rot, Vec3};
use simulation::*;
use std::f64::consts::TAU;

const SHARE: f64 = 0.5;
const SIGMA: f64 = 12.0 * ARCSEC;
const COURSE: f64 = 45.0 * DEGREE;

/// A ship whose deck bends with it and hardly by itself: 1e-9 of its model's deviation.
fn coupled(response: Response, seed: u64, rate_hz: f64) -> Scenario {
    let swing = |mu, b, sigma: f64| Swing::Random(RandomSwing { mu, b, sigma, band_limit_hz: Some(0.4) });
    let ship = Ship {
        pitch: swing(0.10, 1.1354, 2.2 * DEGREE),
        roll: swing(0.06, 0.4439, 3.4 * DEGREE),
        heading: swing(0.12, 0.3363, 0.8 * DEGREE),
        speed: 0.0,
        course: COURSE,
        ..Ship::default()
    };
    let area = Area {
        unit: Unit::ideal(),
        flexure: [GaussMarkov { mu: 1e-9, b: 1e-9, sigma: SIGMA }; 3],
        starts_at_rest: true,
        coupling: Some(Coupling { share: SHARE, response, in_phase_rotation: Vec3::ZERO }),
        ..Area::default()
    };
    Scenario { seed, rate_hz, ship, areas: vec![area], duration_s: None, ..Scenario::default() }
}

/// Flexure and swing of so many main samples.
fn run(scenario: &Scenario, count: usize) -> Vec<([f64; 3], [f64; 3])> {
    let mut simulator = Simulator::new(scenario);
    let mut step = || {
        let truth = simulator.step().unwrap().truth[0];
        let ship = Rot::<Nav, Main>::from_wxyz(truth.ship).euler();
        (truth.dynamic, [ship.pitch, ship.roll, COURSE - ship.heading])
    };
    (0..count).map(|_| step()).collect()
}

#[test]
fn a_delayed_flexure_is_the_swing_of_that_time_ago() {
    for (seed, axis) in [(1, 0), (2, 1), (3, 2)] {
        let mut scenario = coupled(Response::Delayed { delay_s: 1.3 }, seed, 20.0);
        let ship = &mut scenario.ship;
        let swings = [&mut ship.pitch, &mut ship.roll, &mut ship.heading];
        swings.into_iter().enumerate().filter(|(i, _)| *i != axis).for_each(|(_, swing)| *swing = Swing::STILL);
        let rows = run(&scenario, 4000);
        for k in 0..3 {
            let gain = rows[3000].0[k] / rows[3000 - 26].1[axis];
            // a single component has the whole share
            assert!(gain.abs() > 1e-4);
            for i in 26..4000 {
                let expected = gain * rows[i - 26].1[axis];
                assert!((rows[i].0[k] - expected).abs() < 1e-6 * SIGMA, "{seed} {k} {i}");
            }
        }
    }
}

/// The answer to a sine is known, and what the start added dies away.
#[test]
fn a_resonator_answers_a_sine_with_its_gain_and_phase() {
    let (mu, b) = (0.1, 1.4);
    for (seed, period) in [(1, 3.0), (2, 4.5), (3, 9.0)] {
        let w = TAU / period;
        let sine = Oscillation { amplitude: 0.1, period, phase: 0.3, random_phase: false };
        let mut scenario = coupled(Response::Resonant { mu, b }, seed, 10.0);
        scenario.ship = Ship { roll: Swing::Sine(sine), pitch: Swing::STILL, heading: Swing::STILL, ..scenario.ship };
        let rows = run(&scenario, 3000);
        let lag = (2.0 * mu * w).atan2(b * b - w * w);
        for k in 0..3 {
            let answer = |i: usize| 2f64.sqrt() * SHARE * SIGMA * (w * i as f64 * 0.1 + 0.3 - lag).sin();
            let sign = (rows[2500].0[k] * answer(2500)).signum();
            for i in 2200..3000 {
                assert!((rows[i].0[k] - sign * answer(i)).abs() < 1e-6 * SIGMA, "{seed} {k} {i}");
            }
        }
    }
}

#[test]
fn coherent_flexure_has_its_share() {
    let resonant = |hz: f64| Response::Resonant { mu: 0.05 * TAU * hz, b: TAU * hz };
    for response in [Response::Delayed { delay_s: 0.7 }, resonant(0.1), resonant(0.2), resonant(0.4)] {
        let (mut power, mut first) = ([0.0; 3], [0.0; 3]);
        for seed in 0..8 {
            let rows = run(&coupled(response, seed, 10.0), 60_000);
            for k in 0..3 {
                power[k] += rows.iter().map(|row| row.0[k].powi(2)).sum::<f64>() / rows.len() as f64 / 8.0;
                first[k] += rows[0].0[k].powi(2) / 8.0;
            }
        }
        // 48 000 s and a band of 0.03 rad/s are 450 independent values of the square
        for k in 0..3 {
            let ratio = power[k].sqrt() / (SHARE * SIGMA);
            assert!((ratio - 1.0).abs() < 0.1, "{response:?} {k}: {ratio}");
        }
        // it does not grow from nothing: 24 values
        let start = (first.iter().sum::<f64>() / 3.0).sqrt() / (SHARE * SIGMA);
        assert!((0.4..1.8).contains(&start), "{response:?}: {start}");
    }
}

#[test]
fn coherent_flexure_does_not_depend_on_the_sampling() {
    let resonant = Response::Resonant { mu: 0.08, b: 1.6 };
    for response in [Response::Delayed { delay_s: 1.5 }, resonant] {
        for seed in 1..4 {
            let [slow, fast] =
                [(10.0, 6000), (40.0, 24_000)].map(|(hz, count)| run(&coupled(response, seed, hz), count));
            for (a, b) in slow.iter().zip(fast.iter().step_by(4)) {
                assert!((0..3).all(|k| (a.0[k] - b.0[k]).abs() < 1e-9 * SIGMA), "{response:?} {seed} {a:?} {b:?}");
            }
        }
    }
}
