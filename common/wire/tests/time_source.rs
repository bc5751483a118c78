//! The times of a device that is told UTC: against its own word, the arrivals, and a word that is wrong.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use wire::stdbin::Telegram;
use wire::{Device, Settings, Tally, TimeSource, Unit};

const INTERVAL_NS: i64 = 10_000_000;
const EPOCH_NS: i64 = 7_000_000_000_000;
/// UTC minus the host's monotonic clock: five minutes before a midnight in 2026.
const OFFSET_NS: i64 = 20_500 * 86_400_000_000_000 - 300_000_000_000 - EPOCH_NS;
/// From the sample to its least delayed arrival; the configuration does not know of it.
const LATENCY_NS: i64 = 1_300_000;

fn truth_ns(k: i64) -> i64 {
    // between the ticks, now here and now there
    EPOCH_NS + k * (INTERVAL_NS + 300) + 3_456_789
}

/// Errors of the times from a minute on, us: mean and root mean square; the device's word is off by `wrong_ns`.
fn errors(time_source: TimeSource, host_ns: Option<i64>, wrong_ns: i64) -> ([f64; 2], Tally) {
    let mut unit = Unit::new(Settings {
        device: Device::Stdbin,
        interval_ns: INTERVAL_NS,
        decimation: 1,
        latency_ns: 0,
        time_source,
        unit: 0,
        run_id: 0,
        epoch_ns: EPOCH_NS,
    });
    unit.tell_host_utc(host_ns);
    let (mut bytes, mut errors) = (Vec::new(), Vec::new());
    // over midnight
    for k in 0..40_000_i64 {
        bytes.clear();
        let told = Telegram { version: 3, counter: k as u32, rotation: Some([1.0; 3]), ..Telegram::default() };
        // a device rounds to its tick
        told.at_utc(truth_ns(k) + OFFSET_NS + wrong_ns + 50_000).encode(&mut bytes);
        // up to 200 us late, and a tenth of them by up to 20 ms
        let late_ns = (k * 7919 % 201) * 1000 + if k % 10 == 3 { k * 104_729 % 20_000_000 } else { 0 };
        unit.push(truth_ns(k) + LATENCY_NS + late_ns, &bytes);
        while let Some(heard) = unit.next_sample() {
            if k > 6000 {
                errors.push((heard.sample.header.time_ns - truth_ns(k)) as f64 * 1e-3);
            }
        }
    }
    assert_eq!((unit.complaint(), unit.tally().restarts), (None, 0));
    let mean = errors.iter().sum::<f64>() / errors.len() as f64;
    let square = errors.iter().map(|error| error * error).sum::<f64>() / errors.len() as f64;
    ([mean, square.sqrt()], unit.tally())
}

#[test]
fn a_disciplined_device_knows_what_no_arrival_tells() {
    let device = TimeSource::Device { bound_ns: 2_000_000 };
    let ([mean, rms], tally) = errors(device, Some(OFFSET_NS), 0);
    println!("by the device: mean {mean:.1} us, rms {rms:.1} us");
    assert!(rms < 40.0, "{mean} {rms}");
    assert_eq!((tally.by_device, tally.disagreeing), (tally.given, 0));
    // the constant latency that nobody told
    let ([mean, rms], tally) = errors(TimeSource::Fitted, Some(OFFSET_NS), 0);
    println!("fitted: mean {mean:.1} us, rms {rms:.1} us");
    assert!((mean - LATENCY_NS as f64 * 1e-3).abs() < 60.0 && rms > 1200.0, "{mean} {rms}");
    assert_eq!((tally.by_device, tally.disagreeing), (0, 0));
}

#[test]
fn what_cannot_be_believed_is_not_taken() {
    let device = TimeSource::Device { bound_ns: 2_000_000 };
    let fitted = errors(TimeSource::Fitted, None, 0).0;
    // the host's clock is nobody's, and the device is a second off
    let (unknown, tally) = errors(device, None, 0);
    assert_eq!((unknown, tally.by_device, tally.disagreeing), (fitted, 0, 0));
    let (wrong, tally) = errors(device, Some(OFFSET_NS), 1_000_000_000);
    assert_eq!((tally.by_device, tally.disagreeing), (0, tally.given));
    assert!(wrong.iter().zip(fitted).all(|(wrong, fitted)| (wrong - fitted).abs() < 60.0), "{wrong:?} {fitted:?}");
}
