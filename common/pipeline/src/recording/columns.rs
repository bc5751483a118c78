//! The columns of a recording, recognised by their names.

use csv::ByteRecord;
use frames::{Euler, Main, Nav, Rot, unit};

/// Where a triad stands, and what it holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Triad {
    at: [usize; 3],
    /// Increments over the interval, or else means over it.
    pub(super) increments: bool,
}

impl Triad {
    /// The increments over an interval (s).
    pub(super) fn increment(&self, cells: [f64; 3], interval: f64) -> [f64; 3] {
        if self.increments { cells } else { cells.map(|v| v * interval) }
    }
}

/// The columns of one file.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Columns {
    count: usize,
    time: usize,
    pub(super) gyro: Triad,
    pub(super) accel: Option<Triad>,
    pub(super) attitude: Option<[usize; 3]>,
}

/// The numbers of one row, as they stand in the file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cells {
    pub(super) time_ns: i64,
    pub(super) gyro: [f64; 3],
    pub(super) accel: Option<[f64; 3]>,
    pub(super) attitude: Option<Rot<Nav, Main>>,
}

const GYRO_MEANS: [&str; 3] = ["gyro_x_rad_s", "gyro_y_rad_s", "gyro_z_rad_s"];
const GYRO_INCREMENTS: [&str; 3] = ["dtheta_x_rad", "dtheta_y_rad", "dtheta_z_rad"];
const ACCEL_MEANS: [&str; 3] = ["accel_x_m_s2", "accel_y_m_s2", "accel_z_m_s2"];
const ACCEL_INCREMENTS: [&str; 3] = ["dvel_x_m_s", "dvel_y_m_s", "dvel_z_m_s"];
const ATTITUDE: [&str; 3] = ["roll_deg", "pitch_deg", "heading_deg"];

/// Beyond it the time in nanoseconds no longer fits its integer.
const LAST_SECOND: f64 = 9e9;

impl Columns {
    /// Columns of other names are ignored. The error says what is missing.
    pub(super) fn of(header: &ByteRecord) -> Result<Self, String> {
        let names: Vec<String> = header.iter().map(|name| String::from_utf8_lossy(name).trim().to_string()).collect();
        let time = names.iter().position(|name| name == "t_s").ok_or("the column t_s is missing")?;
        let gyro = triad(&names, GYRO_MEANS, GYRO_INCREMENTS)?.ok_or_else(|| {
            format!("the columns {} (or {}) are missing", GYRO_MEANS.join(", "), GYRO_INCREMENTS.join(", "))
        })?;
        let accel = triad(&names, ACCEL_MEANS, ACCEL_INCREMENTS)?;
        let attitude = all_or_none(&names, ATTITUDE)?;
        Ok(Self { count: names.len(), time, gyro, accel, attitude })
    }

    /// `None` for a row that is cut, too long, or holds anything but numbers.
    pub(super) fn parse(&self, record: &ByteRecord) -> Option<Cells> {
        if record.len() != self.count {
            return None;
        }
        let time = number(record, self.time)?;
        if time.is_nan() || time.abs() > LAST_SECOND {
            return None;
        }
        let accel = match &self.accel {
            Some(triad) => Some(numbers(record, triad.at)?),
            None => None,
        };
        Some(Cells {
            time_ns: unit::nanoseconds(time),
            gyro: numbers(record, self.gyro.at)?,
            accel,
            attitude: self.attitude(record)?,
        })
    }

    /// The outer `None` refuses the row, the inner one says that the row has no attitude.
    fn attitude(&self, record: &ByteRecord) -> Option<Option<Rot<Nav, Main>>> {
        let Some(at) = self.attitude else { return Some(None) };
        if at.iter().any(|&i| record.get(i).is_some_and(|cell| cell.trim_ascii().is_empty())) {
            return Some(None);
        }
        let [roll, pitch, heading] = numbers(record, at)?.map(|v| v * unit::DEGREE);
        let finite = roll.is_finite() && pitch.is_finite() && heading.is_finite();
        Some(finite.then(|| Euler { roll, pitch, heading }.rotation()))
    }
}

fn number(record: &ByteRecord, i: usize) -> Option<f64> {
    std::str::from_utf8(record.get(i)?).ok()?.trim().parse().ok()
}

fn numbers(record: &ByteRecord, at: [usize; 3]) -> Option<[f64; 3]> {
    Some([number(record, at[0])?, number(record, at[1])?, number(record, at[2])?])
}

fn triad(names: &[String], means: [&str; 3], increments: [&str; 3]) -> Result<Option<Triad>, String> {
    match (all_or_none(names, means)?, all_or_none(names, increments)?) {
        (None, None) => Ok(None),
        (Some(at), None) => Ok(Some(Triad { at, increments: false })),
        (None, Some(at)) => Ok(Some(Triad { at, increments: true })),
        (Some(_), Some(_)) => {
            Err(format!("has both {} and {}: one kind is wanted", means.join(", "), increments.join(", ")))
        }
    }
}

fn all_or_none(names: &[String], wanted: [&str; 3]) -> Result<Option<[usize; 3]>, String> {
    let found = wanted.map(|name| names.iter().position(|n| n == name));
    match found {
        [Some(x), Some(y), Some(z)] => Ok(Some([x, y, z])),
        [None, None, None] => Ok(None),
        _ => {
            let missing: Vec<&str> = (0..3).filter(|&i| found[i].is_none()).map(|i| wanted[i]).collect();
            Err(format!("of {} it lacks {}", wanted.join(", "), missing.join(", ")))
        }
    }
}
