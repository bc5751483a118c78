//! How the simulated ship moves.

use super::{quantity, table};
use frames::unit::DEGREE;
use serde::Deserialize;
use serde::de::{Deserializer, Error};
use simulation::{GaussMarkov, Oscillation, RandomSwing, SeaChange, Swing, Tones, Turns};

const fn sine(period: f64) -> Oscillation {
    Oscillation { amplitude: 10.0 * DEGREE, period, phase: 0.0, random_phase: false }
}

/// Roll and pitch as in 000 eq 79.
pub(super) const TILT: Swing = Swing::Sine(sine(8.0));
/// Heading as in 000 eq 79.
pub(super) const YAW: Swing = Swing::Sine(sine(10.0));

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SwingTable {
    #[serde(default, deserialize_with = "quantity::amplitude_deg")]
    amplitude_deg: Option<f64>,
    #[serde(default, deserialize_with = "quantity::sway_period_s")]
    period_s: Option<f64>,
    #[serde(default, deserialize_with = "quantity::phase_deg")]
    phase_deg: Option<f64>,
    random_phase: Option<bool>,
    #[serde(default, deserialize_with = "quantity::tones")]
    tones: Option<usize>,
    #[serde(default, deserialize_with = "quantity::amplitude_deg")]
    sigma_deg: Option<f64>,
    #[serde(default, deserialize_with = "quantity::frequency_hz")]
    frequency_hz: Option<f64>,
    #[serde(default, deserialize_with = "quantity::mu_per_s")]
    mu_per_s: Option<f64>,
    #[serde(default, deserialize_with = "quantity::band_limit_hz")]
    band_limit_hz: Option<f64>,
}

impl SwingTable {
    fn swing(self, usual: Oscillation) -> Result<Swing, &'static str> {
        let amplitude = self.amplitude_deg.unwrap_or(usual.amplitude);
        let period = self.period_s.unwrap_or(usual.period);
        let waves = self.amplitude_deg.is_some() || self.period_s.is_some();
        let phases = self.phase_deg.is_some() || self.random_phase.is_some();
        match (self.sigma_deg, self.frequency_hz, self.mu_per_s, self.tones) {
            (None, None, None, None) if self.band_limit_hz.is_none() => Ok(Swing::Sine(Oscillation {
                amplitude,
                period,
                phase: self.phase_deg.unwrap_or(usual.phase),
                random_phase: self.random_phase.unwrap_or(false),
            })),
            (None, None, None, Some(count)) if !phases && self.band_limit_hz.is_none() => {
                Ok(Swing::Tones(Tones { rms: amplitude / 2f64.sqrt(), period, count }))
            }
            (Some(sigma), Some(frequency_hz), Some(mu), None) if !phases && !waves => {
                let GaussMarkov { mu, b, sigma } = GaussMarkov::damped(mu, frequency_hz, sigma);
                Ok(Swing::Random(RandomSwing { mu, b, sigma, band_limit_hz: self.band_limit_hz }))
            }
            _ => Err("needs either `amplitude_deg` and `period_s` with `phase_deg`, `random_phase` or `tones`, \
                      or else `sigma_deg`, `frequency_hz` and `mu_per_s` with `band_limit_hz`"),
        }
    }
}

/// Roll or pitch.
pub(super) fn tilt<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Swing, D::Error> {
    table::one::<D, SwingTable>(deserializer)?.swing(sine(8.0)).map_err(D::Error::custom)
}

/// Heading.
pub(super) fn yaw<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Swing, D::Error> {
    table::one::<D, SwingTable>(deserializer)?.swing(sine(10.0)).map_err(D::Error::custom)
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct TurnsTable {
    #[serde(deserialize_with = "quantity::turn_deg_per_s")]
    rate_deg_per_s: f64,
    #[serde(deserialize_with = "quantity::turn_s")]
    length_s: f64,
    #[serde(deserialize_with = "quantity::turn_s")]
    every_s: f64,
    #[serde(default = "ten_seconds", deserialize_with = "quantity::turn_s")]
    ramp_s: f64,
}

fn ten_seconds() -> f64 {
    10.0
}

/// Turns of the course.
pub(super) fn turns<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Turns>, D::Error> {
    let TurnsTable { rate_deg_per_s, length_s, every_s, ramp_s } = table::one(deserializer)?;
    if length_s + ramp_s > every_s || ramp_s > length_s {
        return Err(D::Error::custom("needs `ramp_s` up to `length_s`, and `every_s` from `length_s` + `ramp_s` on"));
    }
    Ok(Some(Turns { rate: rate_deg_per_s, length_s, every_s, ramp_s }))
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SeaChangeTable {
    #[serde(deserialize_with = "quantity::change_s")]
    at_s: f64,
    #[serde(deserialize_with = "quantity::sea_factor")]
    factor: f64,
    #[serde(default = "one_minute", deserialize_with = "quantity::turn_s")]
    ramp_s: f64,
}

fn one_minute() -> f64 {
    60.0
}

/// A sea that grows or calms down.
pub(super) fn sea_change<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<SeaChange>, D::Error> {
    let SeaChangeTable { at_s, factor, ramp_s } = table::one(deserializer)?;
    Ok(Some(SeaChange { at_s, factor, ramp_s }))
}
