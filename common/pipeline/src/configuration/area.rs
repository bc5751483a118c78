//! The main unit, and the deck areas with their units.

use super::estimator::EstimatorSettings;
use super::identifier::{IdentifierSettings, identifier};
use super::instrument::{Accel, Gyro, Source, mounting, source};
use super::{AlarmLimits, AreaSimulation, quantity, table};
use frames::{Case, Main, Rot, Sub, Vec3, unit};
use serde::Deserialize;
use serde::de::{Deserializer, Error};

/// The main inertial unit.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MainUnit {
    /// Where its samples come from.
    #[serde(deserialize_with = "source")]
    pub source: Source,
    /// The grade of its gyros.
    #[serde(deserialize_with = "table::one")]
    pub gyro: Gyro,
    /// The grade of its accelerometers; `None` if nothing is known of them.
    #[serde(default, deserialize_with = "table::optional")]
    pub accel: Option<Accel>,
    /// Body axes from case axes.
    #[serde(default = "Rot::identity", deserialize_with = "mounting")]
    pub mounting: Rot<Main, Case>,
}

/// A deck area and its sub unit.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Area {
    /// 1 to 32 characters of `a-z`, `0-9`, `_`, `-`; no two areas share it.
    #[serde(deserialize_with = "name")]
    pub name: String,
    /// Where its samples come from.
    #[serde(deserialize_with = "source")]
    pub source: Source,
    /// From the main to the sub unit, m.
    #[serde(rename = "lever_arm_m", default = "origin", deserialize_with = "quantity::lever_arm_m")]
    pub lever_arm: Vec3<Main>,
    /// The grade of its gyros.
    #[serde(deserialize_with = "table::one")]
    pub gyro: Gyro,
    /// The grade of its accelerometers; `None` if nothing is known of them.
    #[serde(default, deserialize_with = "table::optional")]
    pub accel: Option<Accel>,
    /// Body axes from case axes.
    #[serde(default = "Rot::identity", deserialize_with = "mounting")]
    pub mounting: Rot<Sub, Case>,
    /// How the unit was installed, if that is known.
    #[serde(default, deserialize_with = "table::optional")]
    pub installation: Option<Installation>,
    /// Rotation vector of the deformation that is to be told as none, rad; the same in m and in s.
    #[serde(rename = "zero_deg", default = "origin", deserialize_with = "quantity::zero_deg")]
    pub zero: Vec3<Main>,
    /// The fast stage.
    #[serde(default, deserialize_with = "table::one")]
    pub estimator: EstimatorSettings,
    /// The slow stage.
    #[serde(default, deserialize_with = "identifier")]
    pub identifier: IdentifierSettings,
    /// What is worth an alarm.
    #[serde(default, deserialize_with = "table::optional")]
    pub alarm: Option<AlarmLimits>,
    /// What the simulator makes of the area.
    #[serde(default, deserialize_with = "table::one")]
    pub simulation: AreaSimulation,
}

fn origin() -> Vec3<Main> {
    Vec3::ZERO
}

fn name<'de, D: Deserializer<'de>>(deserializer: D) -> Result<String, D::Error> {
    let name = String::deserialize(deserializer)?;
    let allowed = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_' || c == '-';
    if (1..=32).contains(&name.len()) && name.chars().all(allowed) {
        Ok(name)
    } else {
        Err(D::Error::custom("must be 1 to 32 characters of a-z, 0-9, _ and -"))
    }
}

/// The static deformation as the yard or an earlier voyage gave it.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(from = "InstallationTable")]
pub struct Installation {
    /// `C_s^m`.
    pub rotation: Rot<Main, Sub>,
    /// Standard deviation of its error about each axis, rad.
    pub sigma: f64,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct InstallationTable {
    #[serde(deserialize_with = "quantity::rotation_vector_deg")]
    rotation_vector_deg: Vec3<Main>,
    #[serde(default = "one_degree", deserialize_with = "quantity::sigma_deg")]
    sigma_deg: f64,
}

fn one_degree() -> f64 {
    unit::DEGREE
}

impl From<InstallationTable> for Installation {
    fn from(table: InstallationTable) -> Self {
        Self { rotation: Rot::exp(table.rotation_vector_deg), sigma: table.sigma_deg }
    }
}
