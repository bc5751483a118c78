//! Stamps, sampling instants and the order of arrival.
#![allow(clippy::unwrap_used)]

use frames::{Rot, Vec3};
use messages::ImuSample;
use simulation::*;
use std::collections::HashMap;

fn scenario(seed: u64, duration: f64, wire: Wire) -> Scenario {
    let areas = vec![Area { wire, ..Area::default() }];
    Scenario { seed, duration_s: Some(duration), areas, ..Scenario::default() }
}

/// The sub unit's samples in order of arrival, each with the main instant (ns) at which it is handed out.
fn arrivals(scenario: &Scenario) -> Vec<(i64, ImuSample)> {
    let mut simulator = Simulator::new(scenario);
    let mut all = Vec::new();
    while let Some(epoch) = simulator.step() {
        all.extend(epoch.sub.iter().map(|sample| (epoch.main.header.time_ns, *sample)));
    }
    all
}

fn numbers(arrivals: &[(i64, ImuSample)]) -> Vec<u64> {
    arrivals.iter().map(|(_, sample)| sample.header.sequence).collect()
}

fn binomial(found: usize, n: usize, p: f64) {
    let sd = (n as f64 * p * (1.0 - p)).sqrt();
    assert!((found as f64 - n as f64 * p).abs() < 4.0 * sd, "{found} of {n} at {p}");
}

#[test]
fn an_ideal_wire_gives_each_sample_at_its_instant() {
    let all = arrivals(&scenario(1, 20.0, Wire::default()));
    assert_eq!(all.len(), 2001);
    for (j, (at, sample)) in (0..).zip(all) {
        let header = sample.header;
        assert_eq!((header.sequence as i64, header.time_ns, sample.interval_ns), (j, j * 10_000_000, 10_000_000));
        assert_eq!((at, sample.unit), (header.time_ns, 1));
    }
}

#[test]
fn delay_skew_and_jitter_change_the_stamps_alone() {
    for seed in 0..3 {
        let plain = arrivals(&scenario(seed, 100.0, Wire::default()));
        let wire = Wire { delay_s: 0.0123, skew: 50e-6, jitter_s: 1e-4, ..Wire::default() };
        let late = arrivals(&scenario(seed, 100.0, wire));
        assert_eq!(plain.len(), late.len());
        let mut noise = Vec::new();
        for ((_, a), (at, b)) in plain.iter().zip(&late) {
            assert_eq!((a.dtheta, a.dvel, a.interval_ns), (b.dtheta, b.dvel, b.interval_ns));
            assert_eq!(a.header.sequence, b.header.sequence);
            let shift = (b.header.time_ns - a.header.time_ns) as f64 / 1e9;
            noise.push(shift - 0.0123 - 50e-6 * a.header.time_ns as f64 / 1e9);
            assert!(*at >= b.header.time_ns || *at == 100_000_000_000);
        }
        let n = noise.len() as f64;
        let mean = noise.iter().sum::<f64>() / n;
        let sd = (noise.iter().map(|x| x * x).sum::<f64>() / n).sqrt();
        assert!(mean.abs() < 4.0 * 1e-4 / n.sqrt() && (sd / 1e-4 - 1.0).abs() < 4.0 / (2.0 * n).sqrt(), "{mean} {sd}");
    }
}

#[test]
fn a_sample_comes_with_the_first_main_instant_after_its_stamp_and_transit() {
    let wire = Wire { delay_s: 0.004, transit_s: 0.031, phase_s: 0.002, ..Wire::default() };
    let all = arrivals(&scenario(1, 10.0, wire));
    for (j, (at, sample)) in (0..).zip(&all) {
        let stamp = 2_000_000 + j * 10_000_000 + 4_000_000;
        assert_eq!(sample.header.time_ns, stamp);
        let due = (stamp + 31_000_000 + 9_999_999) / 10_000_000 * 10_000_000;
        assert_eq!(*at, due.min(10_000_000_000));
    }
    // the last one ends at 9.992 s and is still under way
    assert_eq!(all.len(), 1000);
}

/// A sub unit at the main unit's place must feel what a main unit of its rate feels.
#[test]
fn a_wrong_rate_moves_the_true_instants() {
    for rate_error in [1e-3, -2e-4, 0.5] {
        let wire = Wire { rate_error, ..Wire::default() };
        let mut own = scenario(3, 50.0, wire);
        own.main = Unit::ideal();
        own.areas[0].unit = Unit::ideal();
        own.areas[0].lever_arm = Vec3::ZERO;
        own.areas[0].installation = Rot::identity();
        own.areas[0].flexure.iter_mut().for_each(|axis| axis.sigma = 0.0);
        let sub = arrivals(&own);
        let mut main = Simulator::new(&Scenario { rate_hz: 100.0 * (1.0 + rate_error), areas: vec![], ..own });
        assert_eq!(sub.len(), (5000.0 * (1.0f64 + rate_error)).round() as usize + 1);
        for (_, sample) in sub {
            let expected = main.step().unwrap().main;
            assert_eq!(sample.header, expected.header);
            assert_eq!(sample.interval_ns, expected.interval_ns);
            assert_eq!((sample.dtheta, sample.dvel), (expected.dtheta, expected.dvel));
        }
    }
}

#[test]
fn losses_leave_holes_in_the_numbers() {
    for seed in 0..3 {
        let wire = Wire { loss: 0.03, ..Wire::default() };
        let all = numbers(&arrivals(&scenario(seed, 200.0, wire)));
        assert!(all.windows(2).all(|w| w[0] < w[1]));
        binomial(20_001 - all.len(), 20_001, 0.03);
    }
}

#[test]
fn duplicates_repeat_number_and_contents() {
    for seed in 0..3 {
        let wire = Wire { duplicate: 0.05, ..Wire::default() };
        let all = arrivals(&scenario(seed, 200.0, wire));
        binomial(all.len() - 20_001, 20_001, 0.05);
        for pair in all.windows(2) {
            match pair[1].1.header.sequence - pair[0].1.header.sequence {
                0 => assert_eq!(pair[0], pair[1]),
                step => assert_eq!(step, 1),
            }
        }
    }
}

#[test]
fn swaps_exchange_neighbours() {
    for (seed, p) in [(0, 0.02), (1, 0.1), (2, 1.0)] {
        let wire = Wire { swap: p, ..Wire::default() };
        let mut all = numbers(&arrivals(&scenario(seed, 200.0, wire)));
        let n = all.len() as f64;
        let swapped = all.windows(2).filter(|w| w[1] < w[0]).count() as f64;
        // a sample that has been waited for starts no swap of its own: a renewal process
        let sd = (n * p * (1.0 - p) / (1.0 + p).powi(3)).sqrt();
        assert!((swapped - n * p / (1.0 + p)).abs() <= 4.0 * sd + 1.0, "{swapped} of {n} at {p}");
        assert!((0..).zip(&all).all(|(place, number)| number.abs_diff(place) <= 1));
        all.sort_unstable();
        assert!(all.iter().copied().eq(0..20_001));
    }
}

#[test]
fn everything_together_arrives_in_the_end() {
    for seed in 0..5 {
        let wire = Wire {
            delay_s: 0.013,
            skew: 1e-4,
            jitter_s: 2e-3,
            phase_s: 0.0037,
            rate_error: -3e-4,
            loss: 0.1,
            duplicate: 0.1,
            swap: 0.2,
            transit_s: 0.05,
        };
        let all = arrivals(&scenario(seed, 30.0, wire));
        let lossless = arrivals(&scenario(seed, 30.0, Wire { loss: 0.0, duplicate: 0.0, swap: 0.0, ..wire }));
        let sent: HashMap<u64, ImuSample> = lossless.into_iter().map(|(_, s)| (s.header.sequence, s)).collect();
        let mut count = HashMap::new();
        for (_, sample) in &all {
            assert_eq!(sent[&sample.header.sequence], *sample, "draws of one kind must not shift those of another");
            *count.entry(sample.header.sequence).or_insert(0) += 1;
        }
        assert!(all.windows(2).all(|w| w[0].0 <= w[1].0));
        binomial(sent.len() - count.len(), sent.len(), 0.1);
        binomial(count.values().filter(|c| **c == 2).count(), count.len(), 0.1);
        assert!(count.values().all(|c| *c <= 2));
    }
}
