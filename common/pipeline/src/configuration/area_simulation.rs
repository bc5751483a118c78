//! What the simulator makes of an area; the defaults are those of paper 000 section 5.

use super::instrument::{Accel, Gyro};
use super::{Wire, events, flexure, quantity, table, unit_errors};
use estimation::flexure::{Flexure, Hull};
use frames::unit::ARCMIN;
use frames::{Main, Vec3};
use serde::Deserialize;
use simulation::{Coupling, Event, FlexureChange, GaussMarkov, Impulses, Outliers, QuasiStatic, Wander};

/// One area: its true installation and flexure, its true unit and the way of its data.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct AreaSimulation {
    /// Rotation vector of the installation `C_Phi`, rad.
    #[serde(rename = "installation_rotation_vector_arcmin", deserialize_with = "quantity::rotation_vector_arcmin")]
    pub installation: Vec3<Main>,
    /// How the static part drifts from there.
    #[serde(deserialize_with = "flexure::quasi_static")]
    pub quasi_static: QuasiStatic,
    /// Areas of one number bend alike; an area without one bends by itself.
    #[serde(deserialize_with = "quantity::hull")]
    pub hull: Option<u32>,
    /// The true flexure, an axis of m each.
    #[serde(deserialize_with = "flexure::models")]
    pub flexure: [GaussMarkov; 3],
    /// Flexure models from later times on.
    #[serde(deserialize_with = "flexure::changes")]
    pub flexure_changes: Vec<FlexureChange>,
    /// A second mode of the hull, added to the first.
    #[serde(deserialize_with = "flexure::second")]
    pub second_flexure: Option<[GaussMarkov; 3]>,
    /// Whether the flexure is zero at the start.
    pub starts_at_rest: bool,
    /// Impulsive waves.
    #[serde(deserialize_with = "flexure::impulses")]
    pub impulses: Option<Impulses>,
    /// Flexure in step with the ship's swing.
    #[serde(deserialize_with = "flexure::coupling")]
    pub coupling: Option<Coupling>,
    /// How much of the flexure moves the lever arm: 1 turns it with the deck, 0 keeps it.
    #[serde(deserialize_with = "quantity::gain")]
    pub dynamic_lever_arm: f64,
    /// The way from the unit to the host.
    #[serde(deserialize_with = "table::one")]
    pub wire: Wire,
    /// The unit's true gyros where they differ from the configured grade.
    #[serde(deserialize_with = "table::optional")]
    pub gyro: Option<Gyro>,
    /// The unit's true accelerometers where they differ from the configured grade.
    #[serde(deserialize_with = "table::optional")]
    pub accel: Option<Accel>,
    /// What the biases of the unit's gyros do beside their constant part.
    #[serde(deserialize_with = "unit_errors::bias_wander")]
    pub bias_wander: Wander,
    /// Samples of the unit that are far off.
    #[serde(deserialize_with = "unit_errors::outliers")]
    pub outliers: Outliers,
    /// What goes wrong with the unit and its wire.
    #[serde(deserialize_with = "events::events")]
    pub events: Vec<Event>,
}

impl AreaSimulation {
    /// The flexure model of the hull at the start, as a filter takes it.
    pub fn hull(&self) -> Hull {
        let mode = |axis: GaussMarkov| Flexure { mu: axis.mu, b: axis.b, sigma: axis.sigma };
        let second = self.second_flexure.map_or([None; 3], |modes| modes.map(|axis| Some(mode(axis))));
        Hull { modes: self.flexure.map(mode), second }
    }
}

impl Default for AreaSimulation {
    fn default() -> Self {
        let usual = simulation::Area::default();
        Self {
            installation: Vec3::new(10.0 * ARCMIN, 10.0 * ARCMIN, 30.0 * ARCMIN),
            quasi_static: usual.quasi_static,
            hull: None,
            flexure: usual.flexure,
            flexure_changes: Vec::new(),
            second_flexure: None,
            starts_at_rest: false,
            impulses: None,
            coupling: None,
            dynamic_lever_arm: usual.dynamic_lever_arm,
            wire: Wire::default(),
            gyro: None,
            accel: None,
            bias_wander: Wander::default(),
            outliers: Outliers::default(),
            events: Vec::new(),
        }
    }
}
