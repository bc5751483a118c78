//! Compares the times that kept bytes are given with the true instants that `simulate --wire --truth` wrote.
//!
//!     cargo run -p deckflex-wire --example stamps -- main.raw truth/times_main.csv stdbin 100 1000
//!
//! The last two are the samples a second and the configured latency in microseconds. Each line is a minute.
#![allow(clippy::print_stdout)]

use std::error::Error;
use wire::{Angle, Device, Rotation, Settings, TimeSource, Unit};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [raw, times, kind, rate, latency] = arguments.as_slice() else {
        return Err("needs RAW TIMES kvh|stdbin|stim300 RATE_HZ LATENCY_US".into());
    };
    let device = match kind.as_str() {
        "kvh" => Device::Kvh { rotation: Rotation::Delta, angle: Angle::Radians },
        "stdbin" => Device::Stdbin,
        "stim300" => Device::Stim300 { rotation: Rotation::Rate, force_exponent: 19 },
        other => return Err(format!("there is no device {other}").into()),
    };
    let (contents, times) = (std::fs::read(raw)?, std::fs::read_to_string(times)?);
    let truths = times.lines().skip(1).filter_map(|line| line.split_once(',')?.1.parse::<i64>().ok());
    let truths: Vec<i64> = truths.collect();
    let interval_ns = (1e9 / rate.parse::<f64>()?).round() as i64;
    let latency_ns = (1e3 * latency.parse::<f64>()?) as i64;
    let time_source = TimeSource::Fitted;
    let (decimation, unit, run_id, epoch_ns) = (1, 0, 0, 0);
    let settings = Settings { device, interval_ns, decimation, latency_ns, time_source, unit, run_id, epoch_ns };
    let mut unit = Unit::new(settings);
    let mut minutes: Vec<Vec<f64>> = Vec::new();
    let mut begin_ns = None;
    for (arrival_ns, bytes) in wire::raw::pieces(&contents).ok_or("no file of raw bytes")? {
        unit.push(arrival_ns, bytes);
        while let Some(heard) = unit.next_sample() {
            let time_ns = heard.sample.header.time_ns;
            let after = truths.partition_point(|truth| *truth < time_ns);
            let near = truths[after.saturating_sub(1)..truths.len().min(after + 1)].iter().map(|truth| time_ns - truth);
            let minute = ((time_ns - *begin_ns.get_or_insert(time_ns)) / 60_000_000_000) as usize;
            minutes.resize(minutes.len().max(minute + 1), Vec::new());
            minutes[minute].extend(near.min_by_key(|error| error.abs()).map(|error| error as f64 / 1e3));
        }
    }
    println!("minute samples     mean us      rms us  rms about the mean us");
    for (minute, errors) in minutes.iter().enumerate() {
        let mean_of = |values: &dyn Fn(&f64) -> f64| errors.iter().map(values).sum::<f64>() / errors.len() as f64;
        let mean = mean_of(&|error| *error);
        let rms = mean_of(&|error| error * error).sqrt();
        let about = mean_of(&|error| (error - mean).powi(2)).sqrt();
        println!("{minute:>6} {:>7} {mean:>11.1} {rms:>11.1} {about:>11.1}", errors.len());
    }
    println!("{:?}", unit.tally());
    Ok(())
}
