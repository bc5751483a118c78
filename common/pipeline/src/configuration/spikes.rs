//! The threshold of the spike test.

use super::quantity;
use serde::de::{Deserializer, Error};

/// The least threshold: below it, a test of each sample would replace ordinary noise.
const LEAST: f64 = 3.0;

/// 0 for no test, or else a multiple of the scale of a unit's roughness; beyond 5 are four ordinary samples in a million.
pub(super) fn threshold<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    let threshold: f64 = quantity::spike_threshold(deserializer)?;
    if threshold == 0.0 || threshold >= LEAST {
        Ok(threshold)
    } else {
        Err(D::Error::custom("must be 0 for no test, or within 3 to 1000"))
    }
}
