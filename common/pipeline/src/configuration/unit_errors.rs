//! Errors of simulated units that no data sheet names.

use super::{quantity, table};
use serde::Deserialize;
use serde::de::Deserializer;
use simulation::{Outliers, Wander};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct WanderTable {
    #[serde(deserialize_with = "quantity::bias_deg_per_h")]
    sigma_deg_per_h: f64,
    #[serde(deserialize_with = "quantity::wander_s")]
    tau_s: f64,
}

/// A first-order Gauss-Markov bias.
pub(super) fn bias_wander<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Wander, D::Error> {
    table::one(deserializer).map(|table: WanderTable| Wander { sigma: table.sigma_deg_per_h, tau: table.tau_s })
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct OutlierTable {
    #[serde(deserialize_with = "quantity::ratio")]
    probability: f64,
    #[serde(deserialize_with = "quantity::factor")]
    size_sigmas: f64,
    #[serde(default)]
    one_sided: bool,
}

/// Contaminated noise.
pub(super) fn outliers<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Outliers, D::Error> {
    table::one(deserializer).map(|table: OutlierTable| Outliers {
        probability: table.probability,
        size: table.size_sigmas,
        one_sided: table.one_sided,
    })
}
