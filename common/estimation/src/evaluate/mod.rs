//! Error ranges: how far the published deformation may be off.
//!
//! | range | file |
//! |---|---|
//! | so many standard deviations | [`Deviations`] |
//! | covariance of flexure rate and static part, with a coefficient (004) | [`ErrorRange`] |
//! | assumed coherence of flexure and ship, unit-consistent | [`Coherence`] |
//! | the coherence that the data show | [`Observed`] |
//!
//! And how far it was off, where a reference is known: [`against`]. What a recording of it shows afterwards: [`Stretch`], [`Spectrum`].

pub mod against;
mod coherence;
mod error_range;
mod kept;
mod observed;
mod spectrum;
mod stretch;
mod window;

pub use coherence::Coherence;
pub use error_range::ErrorRange;
pub use kept::Kept;
pub use observed::Observed;
pub use spectrum::{Band, Spectrum};
pub use stretch::Stretch;

use frames::{Main, Vec3};
use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

/// Deviations that hold 95 % of a normal error.
pub const NORMAL_95: f64 = 1.96;

/// What a range is made of, at one instant.
#[derive(Clone, Copy, Debug)]
pub struct Evidence {
    /// Time since the filter's start, s.
    pub time_s: f64,
    /// Time since the evidence before, s.
    pub interval_s: f64,
    /// Rate of the ship, rad/s.
    pub w_im_m: Vec3<Main>,
    /// Covariance of the error of the total deformation, rad^2.
    pub covariance: Matrix3<f64>,
    /// Covariance of the error of the static part, rad^2.
    pub static_covariance: Matrix3<f64>,
    /// Rate of the flexure as estimated, rad/s.
    pub rate: Vec3<Main>,
    /// Covariance of its error, rad^2/s^2.
    pub rate_covariance: Matrix3<f64>,
    /// Covariance of the error of the rate (row) with that of the static part (column), rad^2/s.
    pub rate_with_static: Matrix3<f64>,
}

/// A kind of range.
pub trait Evaluate: Send {
    /// Half width of the range about each axis of m, rad.
    fn range(&mut self, evidence: &Evidence) -> [f64; 3];

    /// What the waves may hide from any filter, as standard deviations about each axis of m, rad; `None` where the range does not reckon with it.
    fn hidden(&self) -> Option<Vector3<f64>> {
        None
    }
    /// All that it has seen.
    fn kept(&self) -> Kept;
}

/// So many standard deviations of the total: [`NORMAL_95`], or 3 for the naive range of paper 004.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct Deviations(pub f64);

impl Evaluate for Deviations {
    fn range(&mut self, evidence: &Evidence) -> [f64; 3] {
        evidence.covariance.diagonal().map(|variance| self.0 * variance.sqrt()).into()
    }

    fn kept(&self) -> Kept {
        Kept::Deviations(*self)
    }
}
