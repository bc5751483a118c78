//! The clock filter: how near its times come to the true ones.
#![allow(clippy::unwrap_used)]

use wire::Clock;

/// A small generator of its own, so that the numbers never change.
struct Random(u64);

impl Random {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn exponential(&mut self) -> f64 {
        -(1.0 - self.uniform()).ln()
    }
}

/// A unit at 100 Hz.
struct Line {
    skew: f64,
    /// Device ticks, ns.
    quantum: f64,
    /// Delay beyond the least one, ns.
    delay: fn(&mut Random) -> f64,
}

fn exponential(random: &mut Random) -> f64 {
    100e3 * random.exponential()
}

fn uniform(random: &mut Random) -> f64 {
    346e3 * random.uniform()
}

/// Now and then the host has something else to do.
fn busy(random: &mut Random) -> f64 {
    let rest = 50e3 * random.exponential();
    if random.uniform() < 0.1 { rest + 20e6 * random.uniform() } else { rest }
}

const LATENCY: f64 = 1.5e6;

/// Errors of the mapped times (ns) from `from_s` to `to_s`.
fn errors(line: &Line, seed: u64, from_s: f64, to_s: f64) -> Vec<f64> {
    let mut random = Random(seed);
    let mut clock = Clock::new(LATENCY as i64);
    let mut errors = Vec::new();
    for k in 0..(to_s * 100.0) as u64 {
        let device = k as f64 * 10e6 + 7_000.0;
        let stamp = (device / line.quantum).round() * line.quantum;
        let truth = 5e12 + device / (1.0 + line.skew);
        let arrival = truth + LATENCY + (line.delay)(&mut random);
        let mapped = clock.hear(stamp as i64, arrival as i64);
        if k as f64 / 100.0 >= from_s {
            errors.push(mapped as f64 - truth);
        }
    }
    errors
}

fn rms(values: &[f64]) -> f64 {
    (values.iter().map(|v| v * v).sum::<f64>() / values.len() as f64).sqrt()
}

#[test]
fn a_minute_is_enough_for_twenty_microseconds() {
    for (name, delay) in [("exponential", exponential as fn(&mut Random) -> f64), ("uniform", uniform), ("busy", busy)]
    {
        for skew in [50e-6, -50e-6] {
            let all: Vec<f64> =
                (1..=8).flat_map(|seed| errors(&Line { skew, quantum: 1000.0, delay }, seed, 60.0, 180.0)).collect();
            assert!(rms(&all) < 10e3, "{name}: {:.1} us", rms(&all) / 1e3);
        }
    }
}

#[test]
fn the_first_seconds_are_good_for_a_tenth_of_a_millisecond() {
    for seed in 1..=8 {
        let early = errors(&Line { skew: 50e-6, quantum: 1000.0, delay: exponential }, seed, 2.0, 10.0);
        assert!(rms(&early) < 60e3, "{:.1} us", rms(&early) / 1e3);
    }
}

#[test]
fn what_was_held_back_before_the_start_does_no_harm() {
    let mut clock = Clock::new(0);
    // a second of samples lay in a buffer, all of which come at once
    let mut worst = 0i64;
    for k in 0..2000i64 {
        let device = k * 10_000_000;
        let arrival = 1_000_000_000_000 + device.max(1_000_000_000) + 1000 * (k * 7919 % 100);
        let mapped = clock.hear(device, arrival);
        if clock.settled() {
            worst = worst.max((mapped - 1_000_000_000_000 - device).abs());
        }
    }
    assert!(worst < 60_000, "{worst} ns");
}

#[test]
fn a_longer_way_is_followed_and_a_stall_is_not() {
    let mut random = Random(3);
    let mut clock = Clock::new(0);
    let mut error = |from: u64, to: u64, extra: f64| {
        let mut last = 0.0;
        for k in from..to {
            let truth = k as f64 * 10e6;
            let arrival = truth + 3e6 * f64::from(u8::from(extra > 0.0)) * extra + exponential(&mut random);
            last = clock.hear(truth as i64, arrival as i64) as f64 - truth;
        }
        last
    };
    assert!(error(0, 6000, 0.0).abs() < 15e3);
    // three seconds at 3 ms more: a host that was busy
    assert!(error(6000, 6300, 1.0).abs() < 30e3);
    assert!(error(6300, 7000, 0.0).abs() < 30e3);
    // and half a minute: another route
    let moved = error(7000, 10_000, 1.0);
    assert!((moved - 3e6).abs() < 50e3, "{moved}");
    // back on the short way at once
    let back = error(10_000, 10_200, 0.0);
    assert!(back.abs() < 50e3, "{back}");
}
