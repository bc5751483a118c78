//! How the simulated hull bends.

use super::{quantity, table};
use frames::{Main, Vec3};
use serde::Deserialize;
use serde::de::{Deserializer, Error};
use simulation::{Area, Coupling, FlexureChange, GaussMarkov, Impulses, QuasiStatic, Response};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FlexureTable {
    #[serde(default, deserialize_with = "quantity::change_s")]
    at_s: Option<f64>,
    #[serde(default, deserialize_with = "quantity::tau_s")]
    tau_s: Option<[f64; 3]>,
    #[serde(default, deserialize_with = "quantity::mu_per_s")]
    mu_per_s: Option<[f64; 3]>,
    #[serde(default, deserialize_with = "quantity::b_rad_per_s")]
    b_rad_per_s: Option<[f64; 3]>,
    #[serde(default, deserialize_with = "quantity::frequency_hz")]
    frequency_hz: Option<[f64; 3]>,
    #[serde(default, deserialize_with = "quantity::sigma_arcmin")]
    sigma_arcmin: Option<[f64; 3]>,
    #[serde(default, deserialize_with = "quantity::flexure_arcsec")]
    sigma_arcsec: Option<[f64; 3]>,
    #[serde(default, deserialize_with = "quantity::flexure_mrad")]
    sigma_mrad: Option<[f64; 3]>,
}

impl FlexureTable {
    fn models(&self) -> Result<[GaussMarkov; 3], &'static str> {
        let usual = Area::default().flexure;
        let sigma = match (self.sigma_arcmin, self.sigma_arcsec, self.sigma_mrad) {
            (None, None, None) => usual.map(|f| f.sigma),
            (Some(sigma), None, None) | (None, Some(sigma), None) | (None, None, Some(sigma)) => sigma,
            _ => return Err("needs only one of `sigma_arcmin`, `sigma_arcsec` and `sigma_mrad`"),
        };
        let each = |model: &dyn Fn(usize) -> GaussMarkov| Ok([model(0), model(1), model(2)]);
        match (self.tau_s, self.mu_per_s, self.b_rad_per_s, self.frequency_hz) {
            (None, None, None, None) => each(&|i| GaussMarkov { sigma: sigma[i], ..usual[i] }),
            (Some(tau), None, None, None) => each(&|i| GaussMarkov::critical(tau[i], sigma[i])),
            (None, Some(mu), Some(b), None) => each(&|i| GaussMarkov { mu: mu[i], b: b[i], sigma: sigma[i] }),
            (None, Some(mu), None, Some(hz)) => each(&|i| GaussMarkov::damped(mu[i], hz[i], sigma[i])),
            _ => Err("needs either `tau_s`, or `mu_per_s` and `b_rad_per_s`, or `mu_per_s` and `frequency_hz`"),
        }
    }
}

/// The flexure from the start on.
pub(super) fn models<'de, D: Deserializer<'de>>(deserializer: D) -> Result<[GaussMarkov; 3], D::Error> {
    let table: FlexureTable = table::one(deserializer)?;
    match table.at_s {
        None => table.models().map_err(D::Error::custom),
        Some(_) => Err(D::Error::custom("`at_s` belongs to `flexure_changes`: this is the model from the start on")),
    }
}

/// A second mode, all of which is told: the usual flexure once more would be no second one.
pub(super) fn second<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<[GaussMarkov; 3]>, D::Error> {
    let table: FlexureTable = table::one(deserializer)?;
    let [told, size] = [
        table.tau_s.is_some() || table.mu_per_s.is_some(),
        table.sigma_arcmin.is_some() || table.sigma_arcsec.is_some() || table.sigma_mrad.is_some(),
    ];
    match table.at_s {
        None if told && size => table.models().map(Some).map_err(D::Error::custom),
        None => Err(D::Error::custom(
            "needs `tau_s` or `mu_per_s`, and one of `sigma_arcmin`, `sigma_arcsec`, `sigma_mrad`",
        )),
        Some(_) => {
            Err(D::Error::custom("`at_s` belongs to `flexure_changes`: a second mode is there from the start on"))
        }
    }
}

/// The flexure from later times on, in their order.
pub(super) fn changes<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<FlexureChange>, D::Error> {
    let change = |table: &FlexureTable| match table.at_s {
        Some(at_s) => table.models().map(|flexure| FlexureChange { at_s, flexure }),
        None => Err("each change needs `at_s`"),
    };
    let tables: Vec<FlexureTable> = table::many(deserializer)?;
    let changes = tables.iter().map(change).collect::<Result<Vec<_>, _>>().map_err(D::Error::custom)?;
    if changes.windows(2).any(|pair| pair[0].at_s >= pair[1].at_s) {
        return Err(D::Error::custom("the changes must stand in the order of their times"));
    }
    Ok(changes)
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct QuasiStaticTable {
    #[serde(deserialize_with = "quantity::quasi_static_arcsec")]
    amplitude_arcsec: [f64; 3],
    #[serde(deserialize_with = "quantity::quasi_static_s")]
    period_s: f64,
    #[serde(default, deserialize_with = "quantity::phase_deg")]
    phase_deg: [f64; 3],
}

/// A slow sinusoid of the static part.
pub(super) fn quasi_static<'de, D: Deserializer<'de>>(deserializer: D) -> Result<QuasiStatic, D::Error> {
    table::one(deserializer).map(|table: QuasiStaticTable| QuasiStatic {
        amplitude: table.amplitude_arcsec,
        period: table.period_s,
        phase: table.phase_deg,
    })
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ImpulsesTable {
    #[serde(deserialize_with = "quantity::factor")]
    factor: f64,
    #[serde(deserialize_with = "quantity::ratio")]
    probability: f64,
    #[serde(deserialize_with = "quantity::cell_ms")]
    cell_ms: f64,
}

/// Impulsive waves.
pub(super) fn impulses<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Impulses>, D::Error> {
    let ImpulsesTable { factor, probability, cell_ms } = table::one(deserializer)?;
    Ok(Some(Impulses { factor, probability, cell_s: cell_ms }))
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct CouplingTable {
    #[serde(default, deserialize_with = "quantity::factor")]
    share: f64,
    #[serde(default, deserialize_with = "quantity::percent")]
    wander_percent: Option<f64>,
    #[serde(default, deserialize_with = "quantity::wander_h")]
    wander_tau_h: Option<f64>,
    #[serde(default, deserialize_with = "quantity::lag_s")]
    delay_s: Option<f64>,
    #[serde(default, deserialize_with = "quantity::resonance_hz")]
    resonance_hz: Option<f64>,
    #[serde(default, deserialize_with = "quantity::damping_percent")]
    damping_percent: Option<f64>,
    #[serde(default = "none", deserialize_with = "quantity::quasi_static_arcsec")]
    in_phase_rotation_arcsec: Vec3<Main>,
}

/// s.
const USUAL_WANDER: f64 = 9000.0;

fn none() -> Vec3<Main> {
    Vec3::ZERO
}

impl CouplingTable {
    fn response(&self) -> Result<Response, &'static str> {
        let wanders = self.wander_percent.is_some() || self.wander_tau_h.is_some();
        match (wanders, self.delay_s, self.resonance_hz, self.damping_percent) {
            (_, None, None, None) => Ok(Response::Phase {
                wander: self.wander_percent.unwrap_or(0.0),
                wander_tau: self.wander_tau_h.unwrap_or(USUAL_WANDER),
            }),
            (false, Some(delay_s), None, None) => Ok(Response::Delayed { delay_s }),
            (false, None, Some(b), Some(damping)) => Ok(Response::Resonant { mu: damping * b, b }),
            _ => Err("needs only one of `wander_percent`, `delay_s`, and `resonance_hz` with `damping_percent`"),
        }
    }
}

/// Flexure in step with the ship's swing.
pub(super) fn coupling<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Coupling>, D::Error> {
    let table: CouplingTable = table::one(deserializer)?;
    let response = table.response().map_err(D::Error::custom)?;
    Ok(Some(Coupling { share: table.share, response, in_phase_rotation: table.in_phase_rotation_arcsec }))
}
