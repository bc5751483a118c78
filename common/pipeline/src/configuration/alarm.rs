//! Limits of an area.

use super::quantity;
use serde::Deserialize;

/// What is worth an alarm.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AlarmLimits {
    /// Greatest deformation about x, y, z, rad.
    #[serde(rename = "deformation_arcmin", default, deserialize_with = "quantity::limit_arcmin")]
    pub deformation: Option<[f64; 3]>,
    /// Greatest half width of the 95 % range about x, y, z, rad.
    #[serde(rename = "range_arcmin", default, deserialize_with = "quantity::limit_arcmin")]
    pub range: Option<[f64; 3]>,
    /// Longest time without a valid solution, s.
    #[serde(default, deserialize_with = "quantity::invalid_s")]
    pub invalid_s: Option<f64>,
    /// A deformation or a range has to be beyond its limit for so long before the alarm is raised, and within it for as long before it
    /// ends, s.
    #[serde(default = "one", deserialize_with = "quantity::hold_s")]
    pub hold_s: f64,
}

fn one() -> f64 {
    1.0
}
