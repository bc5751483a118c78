//! What the simulator makes of the ship, of each area and of the way of the data; the defaults are those of paper 000 section 5.

use super::instrument::{Accel, Gyro};
use super::{quantity, table};
use frames::unit::{ARCMIN, ARCSEC, DEGREE, KNOT};
use frames::{Main, Vec3};
use serde::Deserialize;
use serde::de::{Deserializer, Error};
use simulation::GaussMarkov;

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
    /// Sway in roll.
    #[serde(deserialize_with = "tilt")]
    pub roll: Sway,
    /// Sway in pitch.
    #[serde(deserialize_with = "tilt")]
    pub pitch: Sway,
    /// Sway in heading.
    #[serde(deserialize_with = "turn")]
    pub heading: Sway,
    /// Errors of the main unit's attitude.
    #[serde(deserialize_with = "table::one")]
    pub ins: Ins,
    /// The main unit's true gyros where they differ from the configured grade.
    #[serde(deserialize_with = "table::optional")]
    pub gyro: Option<Gyro>,
    /// The main unit's true accelerometers where they differ from the configured grade.
    #[serde(deserialize_with = "table::optional")]
    pub accel: Option<Accel>,
}

impl Default for Simulation {
    fn default() -> Self {
        Self {
            speed: 20.0 * KNOT,
            latitude: 45.0 * DEGREE,
            longitude: 126.0 * DEGREE,
            course: 45.0 * DEGREE,
            velocity_follows_heading: false,
            roll: TILT,
            pitch: TILT,
            heading: TURN,
            ins: Ins::default(),
            gyro: None,
            accel: None,
        }
    }
}

/// A sinusoidal motion of one Euler angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sway {
    /// Amplitude, rad.
    pub amplitude: f64,
    /// Period, s.
    pub period: f64,
    /// Phase at the start, rad.
    pub phase: f64,
}

const TILT: Sway = Sway { amplitude: 10.0 * DEGREE, period: 8.0, phase: 0.0 };
const TURN: Sway = Sway { amplitude: 10.0 * DEGREE, period: 10.0, phase: 0.0 };

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SwayTable {
    #[serde(default, deserialize_with = "quantity::amplitude_deg")]
    amplitude_deg: Option<f64>,
    #[serde(default, deserialize_with = "quantity::sway_period_s")]
    period_s: Option<f64>,
    #[serde(default, deserialize_with = "quantity::phase_deg")]
    phase_deg: Option<f64>,
}

impl SwayTable {
    fn or(self, other: Sway) -> Sway {
        Sway {
            amplitude: self.amplitude_deg.unwrap_or(other.amplitude),
            period: self.period_s.unwrap_or(other.period),
            phase: self.phase_deg.unwrap_or(other.phase),
        }
    }
}

fn tilt<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Sway, D::Error> {
    table::one(deserializer).map(|table: SwayTable| table.or(TILT))
}

fn turn<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Sway, D::Error> {
    table::one(deserializer).map(|table: SwayTable| table.or(TURN))
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

/// One area: its true installation and flexure, its true unit and the way of its data.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct AreaSimulation {
    /// Rotation vector of the true static deformation `C_s^m`, rad.
    #[serde(rename = "installation_rotation_vector_arcmin", deserialize_with = "quantity::rotation_vector_arcmin")]
    pub installation: Vec3<Main>,
    /// The true flexure, an axis of m each.
    #[serde(deserialize_with = "flexure")]
    pub flexure: [GaussMarkov; 3],
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
}

impl Default for AreaSimulation {
    fn default() -> Self {
        let critical = |tau: f64, arcmin: f64| GaussMarkov::critical(tau, arcmin * ARCMIN);
        Self {
            installation: Vec3::new(10.0 * ARCMIN, 10.0 * ARCMIN, 30.0 * ARCMIN),
            flexure: [critical(10.0, 6.0), critical(10.0, 6.0), critical(30.0, 10.0)],
            dynamic_lever_arm: 1.0,
            wire: Wire::default(),
            gyro: None,
            accel: None,
        }
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FlexureTable {
    #[serde(default, deserialize_with = "quantity::tau_s")]
    tau_s: Option<[f64; 3]>,
    #[serde(default, deserialize_with = "quantity::mu_per_s")]
    mu_per_s: Option<[f64; 3]>,
    #[serde(default, deserialize_with = "quantity::b_rad_per_s")]
    b_rad_per_s: Option<[f64; 3]>,
    #[serde(default, deserialize_with = "quantity::sigma_arcmin")]
    sigma_arcmin: Option<[f64; 3]>,
}

fn flexure<'de, D: Deserializer<'de>>(deserializer: D) -> Result<[GaussMarkov; 3], D::Error> {
    let table: FlexureTable = table::one(deserializer)?;
    let usual = AreaSimulation::default().flexure;
    let (mu, b) = match (table.tau_s, table.mu_per_s, table.b_rad_per_s) {
        (None, None, None) => (usual.map(|f| f.mu), usual.map(|f| f.b)),
        (Some(tau), None, None) => {
            let critical = tau.map(|tau| GaussMarkov::critical(tau, 0.0));
            (critical.map(|f| f.mu), critical.map(|f| f.b))
        }
        (None, Some(mu), Some(b)) => (mu, b),
        _ => {
            return Err(D::Error::custom("needs either `tau_s`, or `mu_per_s` and `b_rad_per_s`"));
        }
    };
    let sigma = table.sigma_arcmin.unwrap_or(usual.map(|f| f.sigma));
    Ok(std::array::from_fn(|i| GaussMarkov { mu: mu[i], b: b[i], sigma: sigma[i] }))
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
