//! Whole units: bytes with jitter, wraps, losses and restarts in, samples with the right number and time out.
#![allow(clippy::unwrap_used)]

use frames::unit::{DEGREE, STANDARD_GRAVITY};
use frames::{Nav, Rot};
use wire::kvh::{Extra, Inertial};
use wire::stdbin::Telegram;
use wire::stim300::{self, Cluster, Datagram};
use wire::{Angle, Complaint, Device, Family, Heard, Rotation, Settings, TimeSource, Unit};

const INTERVAL_NS: i64 = 10_000_000;
const EPOCH_NS: i64 = 7_000_000_000_000;
const LATENCY_NS: i64 = 2_000_000;

const KVH: Device = Device::Kvh { rotation: Rotation::Delta, angle: Angle::Radians };
const STIM300: Device = Device::Stim300 { rotation: Rotation::Rate, force_exponent: 19 };

fn unit(device: Device) -> Unit {
    Unit::new(Settings {
        device,
        interval_ns: INTERVAL_NS,
        decimation: 1,
        time_source: TimeSource::Fitted,
        latency_ns: LATENCY_NS,
        unit: 1,
        run_id: 3,
        epoch_ns: EPOCH_NS,
    })
}

/// Sample `k` of each device; its clock is 50 ppm fast and reads `start` where the host reads the epoch.
type Encode = fn(k: i64, out: &mut Vec<u8>);

fn rate(k: i64) -> f32 {
    (k as f32 * 0.01).sin()
}

fn kvh(k: i64, extra: Extra, out: &mut Vec<u8>) {
    let sequence = k.rem_euclid(128) as u8;
    let frame =
        Inertial { rotation: [rate(k), 2.0, 3.0], acceleration: [0.0, 0.5, 1.0], extra, status: 0x77, sequence };
    frame.encode(out);
}

fn format_a(k: i64, out: &mut Vec<u8>) {
    kvh(k, Extra::Plain { temperature: 30 }, out);
}

/// Its counter of microseconds wraps 20 s after the start.
fn format_b(k: i64, out: &mut Vec<u8>) {
    let microseconds = (k * 10_000 - 20_000_000).rem_euclid(1 << 32) as u32;
    kvh(k, Extra::Stamped { microseconds, temperature: 30 }, out);
}

fn format_c(k: i64, out: &mut Vec<u8>) {
    kvh(k, Extra::Slow { value: 1.0 }, out);
}

/// Midnight comes 20 s after the start, and the samples lie between the ticks.
fn telegram(k: i64, out: &mut Vec<u8>) {
    let time = ((k as f64 * 100.003).round() as i64 - 200_000).rem_euclid(864_000_000) as u32;
    let told = Telegram {
        version: 3,
        time,
        counter: (k - 1500) as u32,
        attitude: Some([90.0, 5.0, -3.0]),
        attitude_deviation: Some([0.3, 0.1, 0.2]),
        rotation: Some([rate(k), 2.0, 3.0]),
        acceleration: Some([1.0, 2.0, 9.8]),
        ..Telegram::default()
    };
    told.encode(out);
}

fn datagram(k: i64, out: &mut Vec<u8>) {
    let gyro = Cluster { values: [(f64::from(rate(k)) / stim300::RATE_DEG_PER_S) as i32, 0, 0], status: 0 };
    let force = Cluster { values: [0, 0, 1 << 19], status: 0 };
    let counter = (k * 20).rem_euclid(256) as u8;
    Datagram { id: 0x91, gyro, acceleration: Some(force), counter, latency: 700, ..Datagram::default() }.encode(out);
    out.extend_from_slice(b"\r\n");
}

/// True end of sample `k`.
fn truth_ns(k: i64) -> i64 {
    EPOCH_NS + (k as f64 * INTERVAL_NS as f64 / (1.0 + 50e-6)) as i64
}

/// Delays of 0 to 200 us.
fn arrival_ns(k: i64) -> i64 {
    truth_ns(k) + LATENCY_NS + (k * 7919 % 201) * 1000
}

fn hear(unit: &mut Unit, encode: Encode, ks: impl Iterator<Item = i64>) -> Vec<Heard> {
    let (mut bytes, mut all) = (Vec::new(), Vec::new());
    for k in ks {
        bytes.clear();
        encode(k, &mut bytes);
        let delayed_ns = if encode as usize == datagram as Encode as usize { 700_000 } else { 0 };
        unit.push(arrival_ns(k) + delayed_ns, &bytes);
        all.extend(std::iter::from_fn(|| unit.next_sample()));
    }
    all
}

/// Asserts that numbers and times are right from a minute after the begin on; `best_us` is what the device's ticks allow.
fn assert_timed(heard: &[Heard], best_us: f64) {
    let errors: Vec<f64> = heard
        .iter()
        .filter(|heard| heard.sample.header.sequence > 6000)
        .map(|heard| {
            let header = heard.sample.header;
            let truth_ns = (0..3).map(|off| truth_ns(header.sequence as i64 + off - 1));
            let error_ns = truth_ns.map(|t| header.time_ns - t).min_by_key(|e| e.abs()).unwrap();
            error_ns as f64 / 1e3
        })
        .collect();
    let rms = (errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64).sqrt();
    assert!(errors.len() > 1000 && rms < best_us, "{rms} us");
}

#[test]
fn the_times_of_every_device_are_right_after_a_minute() {
    let all: [(Device, Encode, f64); 5] = [
        (KVH, format_a, 10.0),
        (KVH, format_b, 10.0),
        (KVH, format_c, 10.0),
        (Device::Stdbin, telegram, 40.0),
        (STIM300, datagram, 10.0),
    ];
    for (device, encode, best_us) in all {
        let mut unit = unit(device);
        let heard = hear(&mut unit, encode, 300..12_000);
        assert_timed(&heard, best_us);
        let numbers: Vec<u64> = heard.iter().map(|heard| heard.sample.header.sequence).collect();
        assert!(numbers.windows(2).all(|pair| pair[1] == pair[0] + 1));
        let tally = unit.tally();
        assert_eq!((tally.lost, tally.gaps, tally.disordered, tally.restarts, tally.invalid), (0, 0, 0, 0, 0));
        assert_eq!((tally.given + tally.unsettled, tally.frames.skipped), (11_700, 0));
        assert!((unit.clock().skew() + 50e-6).abs() < 5e-6 || device == Device::Stdbin, "{}", unit.clock().skew());
        assert_eq!(unit.complaint(), None);
    }
}

#[test]
fn values_are_in_si_and_in_the_axes_of_the_crate_frames() {
    let close = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-6 * (1.0 + b.abs()));
    let last = |device, encode: Encode| *hear(&mut unit(device), encode, 0..500).last().unwrap();
    let (g, interval) = (STANDARD_GRAVITY, 0.01);
    let x = f64::from(rate(499));
    let kvh = last(KVH, format_a);
    assert!(close(kvh.sample.dtheta, [x, 2.0, 3.0]) && close(kvh.sample.dvel, [0.0, 0.5 * g * interval, g * interval]));
    let degrees = Device::Kvh { rotation: Rotation::Rate, angle: Angle::Degrees };
    let kvh = last(degrees, format_b);
    assert!(close(kvh.sample.dtheta, [x, 2.0, 3.0].map(|v| v * DEGREE * interval)));
    // bow, port, up into starboard, bow, up
    let stdbin = last(Device::Stdbin, telegram);
    assert!(close(stdbin.sample.dtheta, [-2.0, x, 3.0].map(|v| v * DEGREE * interval)));
    assert!(close(stdbin.sample.dvel, [-2.0, 1.0, 9.8].map(|v| v * interval)));
    let attitude = stdbin.attitude.unwrap();
    assert_eq!(attitude.header, stdbin.sample.header);
    let euler = Rot::<Nav, Nav>::from_wxyz(attitude.q).euler();
    assert!(close([euler.heading, euler.roll, euler.pitch], [90.0, 5.0, 3.0].map(|v| v * DEGREE)));
    // with the bow to the east the error of roll is about east
    assert!(close(attitude.sigma, [0.1, 0.2, 0.3].map(|v| v * DEGREE)));
    let stim = last(STIM300, datagram);
    assert!((stim.sample.dtheta[0] - x * DEGREE * interval).abs() < DEGREE * interval * stim300::RATE_DEG_PER_S);
    assert!(close(stim.sample.dvel, [0.0, 0.0, g * interval]));
}

#[test]
fn lost_samples_leave_their_numbers_free() {
    for (device, encode) in
        [(KVH, format_a as Encode), (KVH, format_b), (Device::Stdbin, telegram), (STIM300, datagram)]
    {
        let mut unit = unit(device);
        // a hole of 30 ms, and one in which KVH's sequence and STIM300's counter wrap
        let kept = |k: &i64| !(2000..2003).contains(k) && !(4000..4300).contains(k);
        let heard = hear(&mut unit, encode, (0..12_000).filter(kept));
        let tally = unit.tally();
        assert_eq!((tally.gaps, tally.lost, tally.restarts), (2, 303, 0), "{device:?}");
        assert_timed(&heard, 40.0);
    }
}

#[test]
fn a_burst_after_a_stall_keeps_its_times() {
    for (device, encode) in [(KVH, format_a as Encode), (STIM300, datagram)] {
        let mut unit = unit(device);
        let mut heard = hear(&mut unit, encode, 0..6000);
        // the host stands still for 2 s and then finds everything in its buffer
        let mut bytes = Vec::new();
        (6000..6200).for_each(|k| encode(k, &mut bytes));
        unit.push(arrival_ns(6199), &bytes);
        heard.extend(std::iter::from_fn(|| unit.next_sample()));
        heard.extend(hear(&mut unit, encode, 6200..12_000));
        let after: Vec<Heard> = heard.iter().filter(|h| h.sample.header.time_ns > truth_ns(6400)).copied().collect();
        let late = after.iter().map(|h| h.arrival_ns - h.sample.header.time_ns - LATENCY_NS).max().unwrap();
        assert!(late < 1_300_000, "{device:?}: {late} ns");
        let numbers: Vec<u64> = heard.iter().map(|h| h.sample.header.sequence).collect();
        assert!(numbers.windows(2).all(|pair| pair[1] > pair[0]));
    }
}

#[test]
fn a_device_that_starts_anew_is_taken_up_again() {
    let mut unit = unit(Device::Stdbin);
    let mut heard = hear(&mut unit, telegram, 0..3000);
    // four seconds of silence, then its clock and its counter begin at 0
    for k in 0..9000i64 {
        let told = Telegram {
            version: 5,
            time: (k * 100) as u32,
            counter: k as u32,
            rotation: Some([1.0; 3]),
            acceleration: Some([0.0; 3]),
            ..Telegram::default()
        };
        let mut bytes = Vec::new();
        told.encode(&mut bytes);
        unit.push(arrival_ns(3400 + k), &bytes);
        heard.extend(std::iter::from_fn(|| unit.next_sample()));
    }
    assert_eq!(unit.tally().restarts, 1);
    assert_timed(&heard, 60.0);
    let wrong = heard
        .iter()
        .filter(|h| (h.sample.header.time_ns - truth_ns(h.sample.header.sequence as i64)).abs() > 20_000_000);
    assert_eq!(wrong.count(), 0, "numbers go on with the time");
}

#[test]
fn repeated_and_swapped_telegrams_are_dropped() {
    let mut unit = unit(Device::Stdbin);
    let order = (0..4000).flat_map(|k| match k % 100 {
        50 => vec![k, k],
        70 => vec![k + 1, k],
        71 => vec![],
        _ => vec![k],
    });
    let mut bytes = Vec::new();
    let mut given = Vec::new();
    for (place, k) in order.enumerate() {
        bytes.clear();
        telegram(k, &mut bytes);
        unit.push(arrival_ns(k).max(arrival_ns(place as i64 - 60)), &bytes);
        given.extend(std::iter::from_fn(|| unit.next_sample()));
    }
    let tally = unit.tally();
    assert_eq!((tally.disordered, tally.lost, tally.restarts), (80, 40, 0));
    assert!(given.windows(2).all(|pair| pair[1].sample.header.time_ns > pair[0].sample.header.time_ns));
}

#[test]
fn what_the_device_calls_invalid_is_left_out() {
    let mut unit = unit(KVH);
    let mut heard = Vec::new();
    for k in 0..1000i64 {
        let status = match k {
            500..510 => 0x70,
            600..620 => 0x07,
            _ => 0x77,
        };
        let mut bytes = Vec::new();
        let extra = Extra::Plain { temperature: 30 };
        let frame = Inertial { rotation: [0.0; 3], acceleration: [1.0; 3], extra, status, sequence: (k % 128) as u8 };
        frame.encode(&mut bytes);
        unit.push(arrival_ns(k), &bytes);
        heard.extend(std::iter::from_fn(|| unit.next_sample()));
    }
    assert_eq!(unit.tally().invalid, 10);
    let accel = heard.iter().filter(|h| h.sample.flags == messages::Flags::ACCEL_STUCK).count();
    assert_eq!(accel, 20);
    assert!(heard.iter().all(|h| !(500..510).contains(&h.sample.header.sequence)));
}

#[test]
fn a_stream_that_is_not_the_configured_one_is_named() {
    let mut told = unit(KVH);
    assert!(hear(&mut told, telegram, 0..20).is_empty());
    assert_eq!(told.complaint(), Some(Complaint::OtherDevice { told: Family::Kvh, found: Family::Stdbin }));
    let words = told.complaint().unwrap().to_string();
    assert_eq!(words, "the configuration says \"kvh\", but the stream looks like iXblue STDBIN (\"stdbin\")");
    let mut fast = unit(KVH);
    hear(&mut fast, format_a, 0..6000);
    assert_eq!(fast.complaint(), None);
    let mut slow = Unit::new(Settings {
        device: KVH,
        interval_ns: INTERVAL_NS / 2,
        decimation: 1,
        time_source: TimeSource::Fitted,
        latency_ns: 0,
        unit: 0,
        run_id: 0,
        epoch_ns: EPOCH_NS,
    });
    hear(&mut slow, format_b, 0..1000);
    assert!(
        matches!(slow.complaint(), Some(Complaint::Rate { told, found }) if told == 200.0 && (found - 100.0).abs() < 2.0)
    );
    let mut without = unit(Device::Stdbin);
    for k in 0..200i64 {
        let mut bytes = Vec::new();
        Telegram {
            version: 2,
            time: (k * 100) as u32,
            counter: k as u32,
            attitude: Some([0.0; 3]),
            ..Telegram::default()
        }
        .encode(&mut bytes);
        without.push(arrival_ns(k), &bytes);
        assert!(without.next_sample().is_none());
    }
    assert_eq!(without.complaint(), Some(Complaint::NoRotation));
}
