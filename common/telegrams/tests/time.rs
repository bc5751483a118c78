//! Which samples are sent, and which UTC they carry.
#![allow(clippy::unwrap_used)]

use rand::{RngExt, SeedableRng};
use telegrams::{Cadence, UtcMap, time_of_day};

const SECOND: i64 = 1_000_000_000;

fn taken(cadence: &mut Cadence, times: impl Iterator<Item = i64>) -> Vec<i64> {
    times.filter(|time_ns| cadence.takes(*time_ns)).collect()
}

#[test]
fn each_rate_is_held_on_data_time() {
    for rate in [1u32, 3, 10, 25, 30, 50, 99, 100] {
        let hour = (0..360_000).map(|k| k * SECOND / 100);
        let sent = taken(&mut Cadence::new(f64::from(rate), 100.0), hour);
        assert!((sent.len() as i64 - 3600 * i64::from(rate)).abs() <= 1, "{rate} Hz: {}", sent.len());
        let period = SECOND / i64::from(rate);
        for pair in sent.windows(2) {
            assert!((pair[1] - pair[0] - period).abs() <= 10_000_000, "{rate} Hz: {}", pair[1] - pair[0]);
        }
    }
}

/// Jitter of a millisecond, a unit's clock that is off by 50 ppm, and any phase.
#[test]
fn jitter_and_a_strange_clock_lose_nothing() {
    let mut random = rand_pcg::Pcg64::seed_from_u64(4);
    for (samples_hz, rate_hz) in [(100.005, 100.0), (99.995, 100.0), (100.005, 50.0), (99.995, 10.0)] {
        let phase = random.random_range(0..10_000_000);
        let stream: Vec<i64> = (0..200_000)
            .map(|k| phase + (f64::from(k) * 1e9 / samples_hz) as i64 + random.random_range(-1_000_000..1_000_000))
            .collect();
        let sent = taken(&mut Cadence::new(rate_hz, 100.0), stream.iter().copied());
        let seconds = 200_000.0 / samples_hz;
        let wanted = rate_hz.min(samples_hz) * seconds;
        assert!(
            (sent.len() as f64 - wanted).abs() <= 3.0 + 1e-4 * wanted,
            "{rate_hz} of {samples_hz} Hz: {}",
            sent.len()
        );
    }
}

#[test]
fn after_a_gap_or_a_jump_back_it_goes_on_without_a_burst() {
    let mut cadence = Cadence::new(10.0, 100.0);
    let before = taken(&mut cadence, (0..1000).map(|k| k * SECOND / 100));
    assert_eq!(before.len(), 100);
    let after = taken(&mut cadence, (5000..6000).map(|k| k * SECOND / 100));
    assert!((99..=101).contains(&after.len()), "{}", after.len());
    let back = taken(&mut cadence, (0..1000).map(|k| k * SECOND / 100));
    assert!((99..=101).contains(&back.len()), "{}", back.len());
}

#[test]
fn utc_follows_and_never_runs_backwards() {
    let mut map = UtcMap::default();
    assert_eq!(map.utc_ns(0), None);
    map.measure(0, 1000 * SECOND);
    assert_eq!(map.utc_ns(5), Some(1000 * SECOND + 5));
    map.measure(SECOND, 1003 * SECOND);
    assert_eq!(map.utc_ns(SECOND), Some(1004 * SECOND), "a step forward is taken at once");
    let mut last = map.utc_ns(2 * SECOND).unwrap();
    // set back by two seconds: caught up with after four
    for tenth in 20..100 {
        let now_ns = tenth * SECOND / 10;
        if tenth % 10 == 0 {
            map.measure(now_ns, 1001 * SECOND);
        }
        let utc_ns = map.utc_ns(now_ns + SECOND / 10).unwrap();
        assert!(utc_ns >= last + SECOND / 20, "{tenth}: {} ns", utc_ns - last);
        last = utc_ns;
        assert_eq!(map.ahead_ns(now_ns) == 0, tenth >= 60, "{tenth}: {}", map.ahead_ns(now_ns));
    }
    assert_eq!(map.utc_ns(10 * SECOND), Some(1011 * SECOND));
}

#[test]
fn the_time_of_day_is_cut_off_and_wraps() {
    let midnight = 1_695_168_000 * SECOND;
    for (utc_ns, text) in [
        (midnight, "000000.000"),
        (midnight - 1, "235959.999"),
        (midnight + 1_999_999, "000000.001"),
        (midnight + (12 * 3600 + 38 * 60 + 16) * SECOND + 805_400_000, "123816.805"),
    ] {
        assert_eq!(time_of_day(utc_ns).to_string(), text);
    }
}
