//! What the simulator makes of the ship and of the way of the data; the defaults are those of paper 000 section 5.

use super::instrument::{Accel, Gyro};
use super::{quantity, swing, table, unit_errors};
use frames::unit::{ARCSEC, DEGREE, KNOT};
use serde::Deserialize;
use simulation::{SeaChange, Swing, Turns, Wander};

/// The ship and its main unit.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Simulation {
    /// Speed over ground, m/s.
    #[serde(rename = "speed_knots", deserialize_with = "quantity::speed_knots")]
    pub speed: f64,
    /// Latitude, rad, north positive.
    #[serde(rename = "latitude_deg", deserialize_with = "quantity::latitude_deg")]
    pub latitude: f64,
    /// Longitude, rad, east positive.
    #[serde(rename = "longitude_deg", deserialize_with = "quantity::longitude_deg")]
    pub longitude: f64,
    /// Course and mean heading, rad, clockwise from north.
    #[serde(rename = "course_deg", deserialize_with = "quantity::course_deg")]
    pub course: f64,
    /// Whether the velocity turns with the heading, or else keeps the course.
    pub velocity_follows_heading: bool,
    /// What the sea does to the roll.
    #[serde(deserialize_with = "swing::tilt")]
    pub roll: Swing,
    /// What the sea does to the pitch.
    #[serde(deserialize_with = "swing::tilt")]
    pub pitch: Swing,
    /// What the sea does to the heading.
    #[serde(deserialize_with = "swing::yaw")]
    pub heading: Swing,
    /// Turns of the course.
    #[serde(deserialize_with = "swing::turns")]
    pub turns: Option<Turns>,
    /// The sea as it grows or calms down.
    #[serde(deserialize_with = "swing::sea_change")]
    pub sea_change: Option<SeaChange>,
    /// Errors of the main unit's attitude.
    #[serde(deserialize_with = "table::one")]
    pub ins: Ins,
    /// The main unit's true gyros where they differ from the configured grade.
    #[serde(deserialize_with = "table::optional")]
    pub gyro: Option<Gyro>,
    /// The main unit's true accelerometers where they differ from the configured grade.
    #[serde(deserialize_with = "table::optional")]
    pub accel: Option<Accel>,
    /// What the biases of the main unit's gyros do beside their constant part.
    #[serde(deserialize_with = "unit_errors::bias_wander")]
    pub bias_wander: Wander,
}

impl Default for Simulation {
    fn default() -> Self {
        Self {
            speed: 20.0 * KNOT,
            latitude: 45.0 * DEGREE,
            longitude: 126.0 * DEGREE,
            course: 45.0 * DEGREE,
            velocity_follows_heading: false,
            roll: swing::TILT,
            pitch: swing::TILT,
            heading: swing::YAW,
            turns: None,
            sea_change: None,
            ins: Ins::default(),
            gyro: None,
            accel: None,
            bias_wander: Wander::default(),
        }
    }
}

/// Errors of the attitude that the main unit's INS gives: one standard deviation each.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Ins {
    /// Constant error about east and north, rad.
    #[serde(rename = "level_arcsec", deserialize_with = "quantity::ins_arcsec")]
    pub level: f64,
    /// Constant error about up, rad.
    #[serde(rename = "heading_arcsec", deserialize_with = "quantity::ins_arcsec")]
    pub heading: f64,
    /// Noise of each sample about each axis, rad.
    #[serde(rename = "noise_arcsec", deserialize_with = "quantity::ins_arcsec")]
    pub noise: f64,
}

impl Default for Ins {
    fn default() -> Self {
        Self { level: 20.0 * ARCSEC, heading: 60.0 * ARCSEC, noise: 2.0 * ARCSEC }
    }
}

/// The way of a unit's data to the host, and its clock.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Wire {
    /// How much too late the stamps are, s.
    #[serde(rename = "delay_ms", deserialize_with = "quantity::delay_ms")]
    pub delay: f64,
    /// How much too fast the clock of the stamps runs, a ratio.
    #[serde(rename = "skew_ppm", deserialize_with = "quantity::clock_ppm")]
    pub skew: f64,
    /// Jitter of the stamps, s; `None` is what the configured grade says.
    #[serde(rename = "jitter_us", deserialize_with = "quantity::jitter_us")]
    pub jitter: Option<f64>,
    /// How much later than the main unit the unit samples, s.
    #[serde(rename = "phase_ms", deserialize_with = "quantity::milliseconds")]
    pub phase: f64,
    /// How much too fast the unit samples, a ratio.
    #[serde(rename = "rate_error_ppm", deserialize_with = "quantity::clock_ppm")]
    pub rate_error: f64,
    /// Probability that a sample is lost.
    #[serde(deserialize_with = "quantity::ratio")]
    pub loss: f64,
    /// Probability that a sample comes twice.
    #[serde(deserialize_with = "quantity::ratio")]
    pub duplicate: f64,
    /// Probability that a sample changes places with the next.
    #[serde(deserialize_with = "quantity::ratio")]
    pub swap: f64,
    /// How long a sample is on its way, s.
    #[serde(rename = "transit_ms", deserialize_with = "quantity::milliseconds")]
    pub transit: f64,
}
