//! Coarse registration: the installation of a sub unit, at any angle, from the first seconds of data.
//!
//! | registration | file |
//! |---|---|
//! | by motion, windows of 0.1 s without their means, scale errors taken out | [`Registrar`] |
//! | quaternion optimisation, as printed and in windows | [`quaternion`] |
//! | least squares for a small rotation | [`least_squares`] |
//! | analytic, with accelerometers | [`analytic`] |

use serde::{Deserialize, Serialize};

pub mod analytic;
mod delay;
pub mod least_squares;
mod moments;
mod motion;
pub mod quaternion;
#[cfg(test)]
mod tests;

pub use delay::DelayRegistrar;
pub use motion::Registrar;

use frames::{Main, Rot, Sub, Vec3, unit};
use messages::ImuPair;
use nalgebra::{Matrix3, Vector3};

/// Collects pairs until they show the installation.
pub trait Register: Send {
    /// Takes a pair.
    fn add(&mut self, pair: &ImuPair);
    /// The registration so far; `None` with too little data or motion.
    fn solve(&self) -> Option<Registration>;
    /// By how much the sub unit's stamps are late, for a registration that finds it.
    fn lag(&self) -> Option<Lag> {
        None
    }
    /// The pairs so far, for a registration that lets the filter run over them from the first one on.
    fn held(&self) -> &[ImuPair] {
        &[]
    }
}

/// By how much the sub unit's stamps are late.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Lag {
    /// s.
    pub delay: f64,
    /// Its standard deviation, s.
    pub sigma: f64,
}

/// Largest standard deviation of a registered axis.
const LARGEST_SIGMA: f64 = 2.0 * unit::DEGREE;
/// Least ratio of the second to the first singular value: below, the motion has one axis only.
const LEAST_RATIO: f64 = 1e-3;
/// A registered installation.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct Registration {
    /// `C_s^m`, averaged over the windows.
    pub rotation: Rot<Main, Sub>,
    /// Covariance of its error, rad^2, in m.
    pub covariance: Matrix3<f64>,
    /// Relative gyro bias, rad/s, in m.
    pub bias: Vec3<Main>,
    /// Its standard deviation per axis, rad/s.
    pub bias_sigma: Vector3<f64>,
    /// Standard deviation of the relative rate that the constant rotation leaves, per axis, rad/s.
    pub residual_rate: Vector3<f64>,
    /// Ratio of the second to the first singular value of the matching matrix.
    pub ratio: f64,
}

impl Registration {
    /// Whether the motion shows the installation on every axis.
    pub fn is_observable(&self) -> bool {
        self.ratio >= LEAST_RATIO && self.largest_sigma() <= LARGEST_SIGMA
    }

    /// The largest standard deviation of an axis, rad.
    pub fn largest_sigma(&self) -> f64 {
        self.covariance.diagonal().max().sqrt()
    }
}
