use crate::{Header, message};
use serde::{Deserialize, Serialize};

/// The flexure model of an area, per axis of m: `x'' + 2 mu x' + b^2 x = 2 b sigma sqrt(mu) w`, w white of unit density; where the hull has a second mode about an
/// axis, the flexure is the sum of two such.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FlexureParams {
    /// `sequence` is the main sample number at the end of the window, `time_ns` its time.
    pub header: Header,
    /// Identity of the set: the main sample number at the end of the window, so it survives a restart; 0 is the prior.
    pub id: u64,
    /// Start of the window.
    pub window_begin_ns: i64,
    /// The data time from which the set is in force: end of the window plus lead.
    pub effective_from_ns: i64,
    /// Damping mu, 1/s.
    pub mu: [f64; 3],
    /// Natural frequency b, rad/s.
    pub b: [f64; 3],
    /// Standard deviation of the flexure, rad.
    pub sigma: [f64; 3],
    /// Standard deviations of `ln mu`.
    pub ln_mu_sd: [f64; 3],
    /// Standard deviations of `ln b`.
    pub ln_b_sd: [f64; 3],
    /// Standard deviations of `ln sigma`.
    pub ln_sigma_sd: [f64; 3],
    /// Damping of the second mode, 1/s.
    pub second_mu: [f64; 3],
    /// Its natural frequency, rad/s.
    pub second_b: [f64; 3],
    /// Its standard deviation, rad; 0 where there is no second mode.
    pub second_sigma: [f64; 3],
    /// Number of 10 Hz points in the window.
    pub points: u32,
    /// Index of the area.
    pub area: u32,
}

message!(FlexureParams, "deckflex/FlexureParams/2");
