//! What paper 002's methods are told beyond the other matchings: the delay and the network.

use super::quantity;
use estimation::matching::quaternion::DelayOptions;
use estimation::matching::quaternion_network::Input;
use frames::unit;
use serde::Deserialize;

/// What is known of the sub unit's delay before the filter starts.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct DelaySettings {
    /// Standard deviation of the delay, s.
    #[serde(rename = "sigma_ms", deserialize_with = "quantity::milliseconds")]
    pub sigma: f64,
    /// Standard deviation of the skew of the sub unit's clock; 0 takes it as exact.
    #[serde(rename = "skew_ppm", deserialize_with = "quantity::scale_ppm")]
    pub skew_sigma: f64,
    /// Whether the attitudes are re-timed by the delay as it is known; otherwise its linear term is all there is.
    pub retime: bool,
}

impl Default for DelaySettings {
    fn default() -> Self {
        Self { sigma: 50e-3, skew_sigma: 0.0, retime: true }
    }
}

impl DelaySettings {
    /// As the matchings take it.
    pub fn options(&self) -> DelayOptions {
        DelayOptions { sigma: self.sigma, skew_sigma: self.skew_sigma, retimed: self.retime }
    }
}

/// What the network gets to see.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum NetworkInput {
    /// The measurement.
    #[default]
    Measurement,
    /// The time.
    Time,
    /// Its last output.
    Previous,
}

impl NetworkInput {
    /// As the matching takes it.
    pub fn input(self) -> Input {
        match self {
            Self::Measurement => Input::Measurement,
            Self::Time => Input::Time,
            Self::Previous => Input::Previous,
        }
    }
}

/// A network beside a model of the deformation or in its place.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct NetworkSettings {
    /// What it gets to see.
    pub input: NetworkInput,
    /// Random walk of a weight, 1/sqrt(s).
    #[serde(rename = "weight_walk_per_sqrt_s", deserialize_with = "quantity::weight_walk_per_sqrt_s")]
    pub weight_walk: f64,
    /// Random walk of an offset of the output, rad/sqrt(s).
    #[serde(rename = "offset_walk_arcsec_per_sqrt_s", deserialize_with = "quantity::offset_walk_arcsec_per_sqrt_s")]
    pub offset_walk: f64,
    /// Doubt of the first weights of a network that stands beside a model, one standard deviation: how much it may do.
    #[serde(deserialize_with = "quantity::weight_sigma")]
    pub weight_sigma: f64,
    /// Of its first weights.
    pub seed: u64,
}

impl Default for NetworkSettings {
    fn default() -> Self {
        Self {
            input: NetworkInput::Measurement,
            weight_walk: 1e-3,
            offset_walk: 1.2 * unit::ARCSEC,
            weight_sigma: 0.01,
            seed: 1,
        }
    }
}
