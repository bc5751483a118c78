//! A look at the beginning of a recording: its rate, its gaps, and whether its units of measure are plausible.

use super::rows::Rows;
use super::{Counts, RecordingError};
use frames::unit;
use std::path::Path;

/// What the first rows of a recording show.
#[derive(Clone, Debug, PartialEq)]
pub struct Head {
    /// Rows looked at, refused ones among them not counted.
    pub rows: u64,
    /// Rows that cannot be parsed.
    pub refused: u64,
    /// Rate of the median interval, Hz; NaN with less than two different times.
    pub rate_hz: f64,
    /// Intervals longer than 1.5 times the median.
    pub gaps: u64,
    /// Rows with the time of the row before.
    pub repeated: u64,
    /// Rows with a time before that of the row before.
    pub back: u64,
    /// Rows with a NaN or an infinity.
    pub not_finite: u64,
    /// Least and greatest time, s.
    pub span_s: [f64; 2],
    /// Root mean square of the rate's length, rad/s; NaN without a finite row.
    pub gyro_rms: f64,
    /// Median length of the specific force, m/s^2, which shaking hardly changes; `None` without accelerometers.
    pub accel_norm: Option<f64>,
    /// Rows with an attitude.
    pub attitudes: u64,
    /// What looks wrong, a sentence each.
    pub suspicions: Vec<String>,
}

/// The columns that are looked at.
#[derive(Default)]
struct Look {
    counts: Counts,
    attitudes: u64,
    times_ns: Vec<i64>,
    gyro: Vec<[f64; 3]>,
    accel: Vec<[f64; 3]>,
}

/// Looks at the first `rows` rows of a recording that should have the rate `rate_hz`.
///
/// # Errors
/// The file cannot be read, its header is not recognised, or none of these rows can be used.
pub fn head(path: &Path, rows: usize, rate_hz: f64) -> Result<Head, RecordingError> {
    let mut file = Rows::open(path)?;
    let look = look(&mut file, rows)?;
    if look.times_ns.is_empty() {
        return Err(RecordingError::Empty { path: path.to_path_buf(), refused: look.counts.refused });
    }
    let steps: Vec<i64> = look.times_ns.windows(2).map(|pair| pair[1].saturating_sub(pair[0])).collect();
    let median_ns = median(steps.iter().copied().filter(|&step| step > 0).collect()).unwrap_or(0);
    let interval = if median_ns > 0 { unit::seconds(median_ns) } else { 1.0 / rate_hz };
    // means are divided by 1, increments by the interval that the file really has
    let divisor = |increments: bool| if increments { interval } else { 1.0 };
    let gyro: Vec<[f64; 3]> = look.gyro.iter().map(|v| v.map(|x| x / divisor(file.columns.gyro.increments))).collect();
    let accel = file.columns.accel.map(|triad| median_norm(&look.accel) / divisor(triad.increments));
    let seconds = |ns: Option<&i64>| unit::seconds(ns.copied().unwrap_or(0));
    let mut head = Head {
        rows: look.counts.rows,
        refused: look.counts.refused,
        rate_hz: if median_ns > 0 { 1.0 / unit::seconds(median_ns) } else { f64::NAN },
        gaps: steps.iter().filter(|&&step| step > median_ns.saturating_add(median_ns / 2) && median_ns > 0).count()
            as u64,
        repeated: steps.iter().filter(|&&step| step == 0).count() as u64,
        back: steps.iter().filter(|&&step| step < 0).count() as u64,
        not_finite: look.counts.not_finite,
        span_s: [seconds(look.times_ns.iter().min()), seconds(look.times_ns.iter().max())],
        gyro_rms: (gyro.iter().map(|v| norm(v).powi(2)).sum::<f64>() / gyro.len() as f64).sqrt(),
        accel_norm: accel.filter(|norm| norm.is_finite()),
        attitudes: look.attitudes,
        suspicions: Vec::new(),
    };
    head.suspicions.extend(rate(head.rate_hz, rate_hz));
    if gyro.is_empty() {
        head.suspicions.push("every row has a NaN or an infinity".into());
    }
    head.suspicions.extend(rotation(&gyro, file.columns.gyro.increments));
    let increments = file.columns.accel.is_some_and(|triad| triad.increments);
    head.suspicions.extend(head.accel_norm.and_then(|norm| force(norm, head.rate_hz, increments)));
    Ok(head)
}

fn look(file: &mut Rows, rows: usize) -> Result<Look, RecordingError> {
    let mut look = Look::default();
    while look.counts.rows + look.counts.refused < rows as u64 {
        let Some(cells) = file.next()? else { break };
        let Some(cells) = cells else {
            look.counts.refused += 1;
            continue;
        };
        look.counts.rows += 1;
        look.attitudes += u64::from(cells.attitude.is_some());
        look.times_ns.push(cells.time_ns);
        if cells.gyro.iter().chain(cells.accel.iter().flatten()).all(|v| v.is_finite()) {
            look.gyro.push(cells.gyro);
            look.accel.extend(cells.accel);
        } else {
            look.counts.not_finite += 1;
        }
    }
    Ok(look)
}

fn norm(v: &[f64; 3]) -> f64 {
    v.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// NaN without vectors.
fn median_norm(vectors: &[[f64; 3]]) -> f64 {
    let mut norms: Vec<f64> = vectors.iter().map(norm).collect();
    norms.sort_unstable_by(f64::total_cmp);
    norms.get(norms.len() / 2).copied().unwrap_or(f64::NAN)
}

fn median(mut values: Vec<i64>) -> Option<i64> {
    values.sort_unstable();
    values.get(values.len() / 2).copied()
}

fn rate(found: f64, wanted: f64) -> Option<String> {
    if found.is_nan() {
        return Some("there are not two different times".into());
    }
    let ratio = found / wanted;
    if (ratio - 1.0).abs() <= 0.01 {
        return None;
    }
    let unit = [(1e-3, "milliseconds"), (1e-6, "microseconds"), (1e-9, "nanoseconds")];
    let unit = unit.iter().find(|(factor, _)| (ratio / factor - 1.0).abs() < 0.05);
    let guess = unit.map_or(String::new(), |(_, unit)| format!(": t_s looks like {unit}"));
    Some(format!("the rate is {found:.4} Hz, but rate_hz is {wanted}{guess}"))
}

/// No rate gyro of the usual kinds measures more (2000 deg/s).
const FASTEST: f64 = 35.0;
/// No ship turns like this half of the time (57 deg/s); in deg/s it is a calm sea.
const TUMBLING: f64 = 1.0;

fn rotation(gyro: &[[f64; 3]], increments: bool) -> Option<String> {
    let largest = gyro.iter().flatten().fold(0.0_f64, |a, v| a.max(v.abs()));
    let middle = median_norm(gyro);
    let what = if middle > TUMBLING {
        format!("half of the rates are above {middle:.3} rad/s")
    } else if largest > FASTEST {
        format!("rates reach {largest:.1} rad/s")
    } else {
        return None;
    };
    let reason = if increments {
        "dtheta looks like degrees or rates, not increments in rad"
    } else {
        "they look like degrees, not rad"
    };
    Some(format!("{what}: {reason}"))
}

/// Lengths of the specific force that have a likely reason; gravity is right.
fn force(norm: f64, rate_hz: f64, increments: bool) -> Option<String> {
    let near = |value: f64| (norm / value - 1.0).abs() < 0.1;
    let g = unit::STANDARD_GRAVITY;
    if near(g) {
        return None;
    }
    let reason = if near(1.0) {
        "it looks like g, not m/s^2"
    } else if near(g / 0.3048) {
        "it looks like ft/s^2, not m/s^2"
    } else if increments && near(g * rate_hz) {
        "dvel looks like accelerations, not increments"
    } else if !increments && near(g / rate_hz) {
        "accel looks like increments, not accelerations"
    } else if near(100.0 * g) {
        "it looks like cm/s^2, not m/s^2"
    } else if near(1000.0) {
        "it looks like thousandths of g, not m/s^2"
    } else {
        "gravity is about 9.8"
    };
    Some(format!("the usual specific force is {norm:.4} m/s^2: {reason}"))
}
