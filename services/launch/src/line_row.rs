use messages::LineHealth;
use serde::Serialize;
use std::fmt;

/// What became of the bytes of a unit on a wire.
#[derive(Clone, Debug, Serialize)]
pub struct LineRow {
    /// `main`, or the name of the area.
    pub unit: String,
    /// Frames with a right check.
    pub frames: u64,
    /// Frames with a wrong check.
    pub damaged: u64,
    /// Bytes that belong to no good frame.
    pub skipped_bytes: u64,
    /// Samples that the device counted and that never came.
    pub lost: u64,
    /// Samples that came again or out of order.
    pub disordered: u64,
    /// Samples that the device itself called invalid.
    pub invalid: u64,
    /// How often the device's clock started anew.
    pub restarts: u64,
    /// How often the port was opened.
    pub opened: u64,
    /// By how much the host's clock is faster than the device's, ppm.
    pub skew_ppm: f64,
    /// Standard deviation of the arrivals' delay, us.
    pub jitter_us: f64,
    /// Standard deviation of the error of the mapped times as the clock filter knows it, us.
    pub sigma_us: f64,
}

impl LineRow {
    /// The row of a unit.
    pub fn new(unit: String, last: &LineHealth) -> Self {
        Self {
            unit,
            frames: last.good,
            damaged: last.damaged,
            skipped_bytes: last.skipped,
            lost: last.lost,
            disordered: last.disordered,
            invalid: last.invalid,
            restarts: last.restarts,
            opened: last.opened,
            skew_ppm: last.skew * 1e6,
            jitter_us: last.jitter * 1e6,
            sigma_us: last.sigma * 1e6,
        }
    }
}

impl fmt::Display for LineRow {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { unit, frames, damaged, skipped_bytes, lost, skew_ppm, jitter_us, sigma_us, restarts, .. } = self;
        write!(
            f,
            "unit {unit}: {frames} frames, {damaged} damaged, {skipped_bytes} bytes skipped, {lost} samples lost, \
             {restarts} restarts of its clock, skew {skew_ppm:+.2} ppm, jitter {jitter_us:.0} us, times known to {sigma_us:.1} us"
        )
    }
}
