//! Kongsberg's binary, version 1: 132 bytes, little endian, without a check sum.
//!
//! | offset | content | type |
//! |---|---|---|
//! | 0 | `#KMB` | 4 characters |
//! | 4 | length 132 | u16 |
//! | 6 | version 1 | u16 |
//! | 8 | seconds since 1970, UTC | u32 |
//! | 12 | nanoseconds | u32 |
//! | 16 | status | u32 |
//! | 20, 28, 36 | latitude, longitude, height: not known | f64, f64, f32 |
//! | 40, 44, 48 | roll (port side up), pitch (bow up), heading, degrees | f32 |
//! | 52 | heave: not known | f32 |
//! | 56, 60, 64 | rates of roll, pitch, heading, degrees a second | f32 |
//! | 68 | velocity: not known | 3 f32 |
//! | 80 | errors of the position: -1, not implemented | 3 f32 |
//! | 92, 96, 100 | sigmas of roll, pitch, heading, degrees | f32 |
//! | 104 | error of the heave: -1, not implemented | f32 |
//! | 108 | acceleration: not known | 3 f32 |
//! | 120 | delayed heave: not known | u32, u32, f32 |

use crate::{Axes, Report};
use frames::unit::DEGREE;

/// Bytes of the telegram.
pub const LENGTH: usize = 132;

/// Status bits: position, heave, acceleration and delayed heave are never known.
const NEVER_KNOWN: u32 = 1 << 0 | 1 << 3 | 1 << 4 | 1 << 5;
/// Status bits: roll and pitch, and heading, are invalid.
const INVALID: u32 = 1 << 1 | 1 << 2;
/// Status bits: roll and pitch, and heading, are of reduced performance.
const REDUCED: u32 = 1 << 17 | 1 << 18;

/// The telegram of a report; what is not known is zero, or -1 as the format has it for errors.
pub fn encode(report: &Report) -> [u8; LENGTH] {
    let mut bytes = [0; LENGTH];
    let mut put = |at: usize, field: &[u8]| bytes[at..at + field.len()].copy_from_slice(field);
    put(0, b"#KMB");
    put(4, &(LENGTH as u16).to_le_bytes());
    put(6, &1u16.to_le_bytes());
    // what lies outside the years 1970 to 2106 has no place in the field
    let seconds = u32::try_from(report.utc_ns.div_euclid(1_000_000_000)).unwrap_or(0);
    put(8, &seconds.to_le_bytes());
    put(12, &(report.utc_ns.rem_euclid(1_000_000_000) as u32).to_le_bytes());
    let validity = match (&report.attitude, report.reduced) {
        (None, _) => INVALID,
        (Some(_), true) => REDUCED,
        (Some(_), false) => 0,
    };
    put(16, &(NEVER_KNOWN | validity).to_le_bytes());
    for at in [80, 84, 88, 104] {
        put(at, &(-1f32).to_le_bytes());
    }
    let mut put_axes = |at: usize, axes: Axes| {
        for (i, radians) in [axes.roll, axes.pitch, axes.heading].into_iter().enumerate() {
            put(at + 4 * i, &((radians / DEGREE) as f32).to_le_bytes());
        }
    };
    match &report.attitude {
        Some(attitude) => {
            let angles = attitude.angles;
            put_axes(40, Axes { roll: angles.roll, pitch: angles.pitch, heading: heading(angles.heading) });
            put_axes(56, attitude.rate);
            put_axes(92, attitude.sigma);
        }
        None => [92, 96, 100].into_iter().for_each(|at| put(at, &(-1f32).to_le_bytes())),
    }
    bytes
}

/// The heading, unless the field's short number would round it up to a full turn.
fn heading(radians: f64) -> f64 {
    if (radians / DEGREE) as f32 >= 360.0 { 0.0 } else { radians }
}
