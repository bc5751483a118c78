//! The fast stage: registration, then a matching model with its filter, with an output at every pair.

mod adoption;
pub mod deck;
mod matched;
mod zero;

pub use deck::{DeckEstimator, DeckSettings};
pub use matched::{MakeRegister, Matched, MatchedSettings};
pub use zero::Zeroed;

pub(crate) use zero::static_part;

use crate::flexure::{Flexure, Hull};
use crate::matching::so3::Grade;
use frames::{Main, Nav, Rot, Sub, unit};
use messages::{FlexureParams, ImuPair, Solution};
use nalgebra::{Matrix3, Vector3};

/// The registration's covariance is widened: its windows see the flexure as if it were noise.
const REGISTRATION_DOUBT: f64 = 9.0;
/// The broad guess: damping and natural frequency, and how much wider than the residual rate the flexure may be.
const GUESS: (f64, f64, f64) = (0.3, 0.6, 2.0);
/// The least flexure of the broad guess.
const LEAST_GUESS: f64 = 1.0 * unit::ARCSEC;

/// A surveyed installation to fall back to.
#[derive(Clone, Copy, Debug)]
pub struct Installation {
    /// `C_s^m`.
    pub rotation: Rot<Main, Sub>,
    /// Standard deviation of its error about each axis, rad.
    pub sigma: f64,
}

/// Settings of the estimator of one area.
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// Index of the area.
    pub area: u32,
    /// Figures of both units, and how restless the static part is.
    pub grade: Grade,
    /// Nominal sampling interval, s.
    pub interval_s: f64,
    /// Rate of the filter, Hz; the output comes at every pair all the same.
    pub filter_hz: f64,
    /// How long to wait for the motion to show the installation before the surveyed one is taken, s.
    pub registration_s: f64,
    /// The surveyed installation, if there is one.
    pub installation: Option<Installation>,
    /// A flexure model known beforehand; otherwise a broad guess is made at registration.
    pub hull: Option<Hull>,
}

/// The flexure model of a parameter set.
pub fn model(params: &FlexureParams) -> Hull {
    let FlexureParams { mu, b, sigma, second_mu, second_b, second_sigma, .. } = params;
    Hull {
        modes: std::array::from_fn(|i| Flexure { mu: mu[i], b: b[i], sigma: sigma[i] }),
        second: std::array::from_fn(|i| {
            let second = Flexure { mu: second_mu[i], b: second_b[i], sigma: second_sigma[i] };
            (second.sigma != 0.0).then_some(second)
        }),
    }
}

fn row_major(m: &Matrix3<f64>) -> [f64; 9] {
    std::array::from_fn(|i| m[(i / 3, i % 3)])
}

/// Fills in the attitude of the deck where the main unit's is known.
fn attitude_of_deck(solution: &mut Solution, pair: &ImuPair, deformation: Rot<Main, Sub>, covariance: &Matrix3<f64>) {
    if pair.ins != [0.0; 4] {
        let ship = Rot::<Nav, Main>::from_wxyz(pair.ins);
        let c = ship.matrix();
        let turned = (c * covariance * c.transpose()).diagonal();
        solution.deck = (ship * deformation).quaternion();
        solution.deck_sigma = std::array::from_fn(|i| (turned[i] + pair.ins_sigma[i].powi(2)).sqrt());
    }
}

/// The broad guess of the flexure from the relative rate that a constant rotation leaves.
fn guess(residual_rate: &Vector3<f64>) -> [Flexure; 3] {
    let (mu, b, wider) = GUESS;
    std::array::from_fn(|axis| Flexure { mu, b, sigma: (wider * residual_rate[axis] / b).max(LEAST_GUESS) })
}
