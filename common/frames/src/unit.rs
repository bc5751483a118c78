//! Units of measure of configurations and files, as factors into SI.

use std::f64::consts::PI;

/// One degree in rad.
pub const DEGREE: f64 = PI / 180.0;
/// One minute of arc in rad.
pub const ARCMIN: f64 = DEGREE / 60.0;
/// One second of arc in rad.
pub const ARCSEC: f64 = DEGREE / 3600.0;
/// One degree per hour in rad/s.
pub const DEG_PER_H: f64 = DEGREE / 3600.0;
/// One degree per square root of an hour in rad per square root of a second.
pub const DEG_PER_SQRT_H: f64 = DEGREE / 60.0;
/// Standard gravity in m/s^2.
pub const STANDARD_GRAVITY: f64 = 9.80665;
/// One millionth of standard gravity in m/s^2.
pub const MICRO_G: f64 = STANDARD_GRAVITY * 1e-6;
/// One part in a million.
pub const PPM: f64 = 1e-6;
/// One knot in m/s.
pub const KNOT: f64 = 1852.0 / 3600.0;
/// One nanosecond in s.
pub const NANOSECOND: f64 = 1e-9;

/// A time in nanoseconds as seconds; the division rounds once, so 10 ms is exactly the number 0.01.
pub fn seconds(nanoseconds: i64) -> f64 {
    nanoseconds as f64 / 1e9
}

/// Seconds as whole nanoseconds, rounded to the nearest.
pub fn nanoseconds(seconds: f64) -> i64 {
    (seconds * 1e9).round() as i64
}
