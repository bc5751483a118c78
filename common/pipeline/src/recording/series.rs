//! A recording of a unit at rest as evenly spaced rates, for statistics.

use super::rows::Rows;
use super::{Counts, RecordingError, head};
use frames::unit;
use std::ops::Range;
use std::path::Path;

/// Rows that are looked at for the usual interval.
const LOOK: usize = 60_000;
/// So many missing samples in a row are bridged by a straight line; at more the series breaks.
const BRIDGED: i64 = 10;

/// Rates and specific forces without a hole in each of the stretches.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Series {
    /// Mean time from one sample to the next, s.
    pub interval: f64,
    /// Rates about the case's axes, rad/s.
    pub gyro: [Vec<f64>; 3],
    /// Specific force along them, m/s^2; `None` without accelerometers.
    pub accel: Option<[Vec<f64>; 3]>,
    /// Indices of values that follow each other without a hole.
    pub stretches: Vec<Range<usize>>,
    /// Rows read, refused or not used.
    pub counts: Counts,
    /// Samples made up in holes that are short enough.
    pub bridged: u64,
    /// What looks wrong about the first rows, a sentence each.
    pub suspicions: Vec<String>,
}

/// The last row and where it stood in time.
struct Last {
    time_ns: i64,
    gyro: [f64; 3],
    accel: [f64; 3],
}

/// Reads a whole recording. Rows that cannot be read or hold a NaN are missing; a repeated time is passed over; a time that goes back
/// begins a new stretch.
///
/// # Errors
/// The file cannot be read, its header is not recognised, or it has no usable row.
pub fn series(path: &Path) -> Result<Series, RecordingError> {
    // the rate that is asked for matters to nothing but one of the suspicions
    let first = head(path, LOOK, 100.0)?;
    let first = if first.rate_hz.is_nan() { first } else { head(path, LOOK, first.rate_hz)? };
    let median_ns = if first.rate_hz.is_nan() { 1 } else { unit::nanoseconds(1.0 / first.rate_hz).max(1) };
    let mut rows = Rows::open(path)?;
    let mut series = Series { suspicions: first.suspicions, ..Series::default() };
    series.accel = rows.columns.accel.map(|_| Default::default());
    let mut last: Option<Last> = None;
    let (mut spanned_ns, mut steps) = (0, 0);
    while let Some(cells) = rows.next()? {
        let Some(cells) = cells else {
            series.counts.refused += 1;
            continue;
        };
        series.counts.rows += 1;
        let row = Last { time_ns: cells.time_ns, gyro: cells.gyro, accel: cells.accel.unwrap_or_default() };
        if !row.gyro.iter().chain(&row.accel).all(|v| v.is_finite()) {
            series.counts.not_finite += 1;
            continue;
        }
        let Some(before) = last else {
            series.begin(&row);
            last = Some(row);
            continue;
        };
        let step_ns = row.time_ns.saturating_sub(before.time_ns);
        // a stamp may come early by jitter, but no sample comes in no time
        let samples = (step_ns.saturating_add(median_ns / 2) / median_ns).max(1);
        match step_ns {
            0 => {
                series.counts.repeated += 1;
                last = Some(before);
                continue;
            }
            step if step < 0 || samples > 1 + BRIDGED => {
                series.counts.back += u64::from(step < 0);
                series.begin(&row);
            }
            _ => {
                (1..=samples).for_each(|k| series.push(&before, &row, k as f64 / samples as f64));
                series.bridged += samples as u64 - 1;
                spanned_ns += step_ns;
                steps += samples;
            }
        }
        last = Some(row);
    }
    series.interval = if steps > 0 { unit::seconds(spanned_ns) / steps as f64 } else { unit::seconds(median_ns) };
    let increments = [rows.columns.gyro.increments, rows.columns.accel.is_some_and(|triad| triad.increments)];
    series.make_rates(increments);
    Ok(series)
}

impl Series {
    fn begin(&mut self, row: &Last) {
        let at = self.gyro[0].len();
        self.stretches.push(at..at);
        self.push(row, row, 1.0);
    }

    fn push(&mut self, a: &Last, b: &Last, share: f64) {
        let between = |a: f64, b: f64| if share == 1.0 { b } else { a + share * (b - a) };
        for axis in 0..3 {
            self.gyro[axis].push(between(a.gyro[axis], b.gyro[axis]));
            if let Some(accel) = &mut self.accel {
                accel[axis].push(between(a.accel[axis], b.accel[axis]));
            }
        }
        if let Some(stretch) = self.stretches.last_mut() {
            stretch.end += 1;
        }
    }

    /// Increments are divided by the mean interval: by that of their own stamps the stamps' jitter would become noise.
    fn make_rates(&mut self, [gyro, accel]: [bool; 2]) {
        let interval = self.interval;
        let divide = |channels: &mut [Vec<f64>; 3]| channels.iter_mut().flatten().for_each(|v| *v /= interval);
        if gyro {
            divide(&mut self.gyro);
        }
        if accel {
            self.accel.iter_mut().for_each(divide);
        }
    }

    /// The stretches of one channel.
    pub fn cut<'a>(&self, channel: &'a [f64]) -> Vec<&'a [f64]> {
        self.stretches.iter().filter_map(|stretch| channel.get(stretch.clone())).collect()
    }
}
