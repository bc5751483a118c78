//! A unit that samples twenty times faster than the run: bytes in, sums out.
#![allow(clippy::unwrap_used)]

use frames::unit::DEGREE;
use messages::Flags;
use wire::stim300::{ANGLE_DEG, Cluster, Datagram};
use wire::{Complaint, Device, Heard, Rotation, Settings, TimeSource, Unit};

const INTERVAL_NS: i64 = 500_000;
const EPOCH_NS: i64 = 7_000_000_000_000;
const LATENCY_NS: i64 = 3_700_000;
const FACTOR: i64 = 20;

fn unit(decimation: u32) -> Unit {
    let device = Device::Stim300 { rotation: Rotation::Delta, force_exponent: 19 };
    let interval_ns = INTERVAL_NS * FACTOR / i64::from(decimation);
    Unit::new(Settings {
        device,
        interval_ns,
        decimation,
        time_source: TimeSource::Fitted,
        latency_ns: LATENCY_NS,
        unit: 1,
        run_id: 3,
        epoch_ns: EPOCH_NS,
    })
}

/// The increment of sample `k`, in the device's unit.
fn increment(k: i64) -> i32 {
    (k * 37 % 1001) as i32
}

/// Hears samples at 2000 Hz of a clock that is 50 ppm fast, each up to 200 us late, but for the lost ones.
fn hear(unit: &mut Unit, ks: std::ops::Range<i64>, is_lost: impl Fn(i64) -> bool) -> Vec<Heard> {
    let mut all = Vec::new();
    for k in ks.filter(|k| !is_lost(*k)) {
        let gyro = Cluster { values: [increment(k), 0, 0], status: 0 };
        let mut bytes = Vec::new();
        let force = Some(Cluster { values: [0, 0, 1 << 19], status: 0 });
        let counter = k.rem_euclid(256) as u8;
        Datagram { id: 0x91, gyro, acceleration: force, counter, ..Datagram::default() }.encode(&mut bytes);
        bytes.extend_from_slice(b"\r\n");
        unit.push(truth_ns(k) + LATENCY_NS + (k * 7919 % 201) * 1000, &bytes);
        all.extend(std::iter::from_fn(|| unit.next_sample()));
    }
    all
}

fn truth_ns(k: i64) -> i64 {
    EPOCH_NS + (k as f64 * INTERVAL_NS as f64 / (1.0 + 50e-6)) as i64
}

#[test]
fn two_thousand_samples_a_second_become_a_hundred_and_no_increment_is_lost() {
    let mut unit = unit(FACTOR as u32);
    let heard = hear(&mut unit, 300..140_000, |_| false);
    assert_eq!((unit.complaint(), unit.tally().lost, unit.tally().given as usize), (None, 0, heard.len()));
    let numbers: Vec<i64> = heard.iter().map(|heard| heard.sample.header.sequence as i64).collect();
    assert!(numbers.windows(2).all(|pair| pair[1] == pair[0] + 1) && numbers.len() > 6800, "{}", numbers.len());
    let felt: f64 = heard.iter().map(|heard| heard.sample.dtheta[0]).sum();
    // which sample is number 0 the first arrivals tell to a sample or two
    let told = |off: i64| {
        let end = |number: i64| number * FACTOR + off;
        let (from, to) = (end(numbers[0] - 1), end(*numbers.last().unwrap()));
        let sum: i64 = (from + 1..=to).map(|k| i64::from(increment(k))).sum();
        let errors = heard.iter().filter(|heard| heard.sample.header.sequence > 3000);
        let errors =
            errors.map(|heard| heard.sample.header.time_ns - truth_ns(end(heard.sample.header.sequence as i64)));
        let largest = errors.map(i64::abs).max().unwrap();
        ((sum as f64 * ANGLE_DEG * DEGREE - felt).abs() < 1e-9).then_some(largest)
    };
    let [largest_ns] = (-3..=3).filter_map(told).collect::<Vec<i64>>()[..] else { panic!("{felt} rad") };
    assert!(largest_ns < 20_000, "{largest_ns} ns");
    assert!(heard.iter().all(|heard| heard.sample.interval_ns == 10_000_000 && heard.sample.flags == Flags::empty()));
}

#[test]
fn a_lost_datagram_is_bridged_and_said() {
    let mut unit = unit(FACTOR as u32);
    let heard = hear(&mut unit, 0..20_000, |k| k % 1000 == 7 && k > 5000);
    assert_eq!(unit.tally().lost, 15, "{:?}", unit.tally());
    let bridged = heard.iter().filter(|heard| heard.sample.flags == Flags::BRIDGED).count();
    assert_eq!(bridged, 15);
    assert!(heard.windows(2).all(|pair| pair[1].sample.header.sequence == pair[0].sample.header.sequence + 1));
}

#[test]
fn a_unit_that_is_too_fast_for_its_configuration_is_named() {
    let mut unit = unit(1);
    hear(&mut unit, 0..20_000, |_| false);
    assert!(matches!(unit.complaint(), Some(Complaint::Rate { told, .. }) if told == 100.0), "{:?}", unit.complaint());
}
