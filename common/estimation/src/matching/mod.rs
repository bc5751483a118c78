//! Matching models: what the difference of two units' attitudes, rates or velocities says about the deformation.

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::fmt::Debug;

pub mod angle_model;
pub mod angles;
pub mod attitude_dcm;
mod chain;
#[cfg(test)]
pub(crate) mod conformance;
mod constant;
pub mod deck;
pub mod exact_attitude;
mod grade;
pub mod increment;
pub mod network;
pub mod neural;
pub mod quaternion;
pub mod quaternion_network;
pub mod rate;
pub mod residual_attitude;
pub mod retiming;
pub mod rodrigues;
pub mod small_angle;
pub mod so3;
mod view;

pub use view::View;

use crate::align::Lag;
use crate::flexure::Flexure;
use frames::{Main, MainStart, Rot, Sub, SubStart, Vec3};
use grade::Grade;
use nalgebra::{Matrix3, SMatrix, SVector};
use view::{Turn, rows_of, three};

/// Transition and noise of an error state over one filter interval.
#[derive(Clone, Copy, Debug)]
pub struct Prediction<const N: usize> {
    /// Transition matrix.
    pub transition: SMatrix<f64, N, N>,
    /// Covariance of what the interval added.
    pub noise: SMatrix<f64, N, N>,
}

/// A measurement of an error state.
#[derive(Clone, Copy, Debug)]
pub struct Observation<const N: usize, const K: usize> {
    /// Residual at the nominal state.
    pub residual: SVector<f64, K>,
    /// Its derivative by the error state.
    pub matrix: SMatrix<f64, K, N>,
    /// Covariance of its own noise.
    pub noise: SMatrix<f64, K, K>,
}

/// A nominal state with an error state of `N` components and measurements of `K`.
pub trait Matching<const N: usize, const K: usize>: Clone {
    /// Moves the nominal state on over everything taken in since the last call, and says what the error state did meanwhile.
    fn propagate(&mut self) -> Prediction<N>;
    /// Compares the nominal state with the units' data.
    fn observe(&self) -> Observation<N, K>;
    /// Moves an estimated error from the error state into the nominal state.
    fn inject(&mut self, error: &SVector<f64, N>);
    /// The residual as it would be after an error had been moved into the nominal state, for filters that ask away from it.
    fn residual_after(&self, error: &SVector<f64, N>) -> SVector<f64, K> {
        let mut other = self.clone();
        other.inject(error);
        other.observe().residual
    }
}

/// What the two units felt since the pair before; the attitudes are those since the filter's start.
#[derive(Clone, Copy, Debug)]
pub struct Motion {
    /// Since the filter's start, s.
    pub time_s: f64,
    /// The interval, s.
    pub interval_s: f64,
    /// The main unit's axes from where they stood at the filter's start, by its gyros.
    pub a_m: Rot<MainStart, Main>,
    /// The same of the sub unit.
    pub a_s: Rot<SubStart, Sub>,
    /// Angle increment of the main unit, rad.
    pub dtheta_m: Vec3<Main>,
    /// Angle increment of the sub unit, rad.
    pub dtheta_s: Vec3<Sub>,
    /// Velocity increment of the main unit, m/s.
    pub dvel_m: Vec3<Main>,
    /// Velocity increment of the sub unit, m/s.
    pub dvel_s: Vec3<Sub>,
    /// Standard deviation of further angle errors in the interval, rad.
    pub disturbance: f64,
}

/// What a model starts from.
#[derive(Clone, Copy, Debug)]
pub struct Start {
    /// Figures of the gyros.
    pub grade: Grade,
    /// Figures of the accelerometers.
    pub accel: Accel,
    /// From the main to the sub unit, m.
    pub lever_arm: Vec3<Main>,
    /// The flexure model until a better one is adopted.
    pub flexure: [Flexure; 3],
    /// The registered or surveyed installation `C_s^m`.
    pub rotation: Rot<Main, Sub>,
    /// Covariance of its error, rad^2, in m.
    pub covariance: Matrix3<f64>,
}

/// Figures of the accelerometers of both units, one standard deviation each.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub struct Accel {
    /// Relative velocity random walk, m/s/sqrt(s).
    pub vrw: f64,
    /// Relative bias, m/s^2.
    pub bias: f64,
}

/// A matching model that an estimator can run.
pub trait Model<const N: usize, const K: usize>:
    Matching<N, K> + Send + Serialize + DeserializeOwned + 'static
{
    /// What distinguishes one use of the model from another.
    type Options: Clone + Debug + Send;
    /// The state at the filter's start, with its covariance.
    fn begin(options: &Self::Options, start: &Start) -> (Self, SMatrix<f64, N, N>);
    /// Starts from what registration has found out about the delay; a model without one lets it be.
    fn delayed(&mut self, _lag: &Lag, _p: &mut SMatrix<f64, N, N>) {}
    /// Takes in what both units felt since the pair before.
    fn advance(&mut self, motion: &Motion);
    /// Replaces the flexure model from now on.
    fn set_flexure(&mut self, flexure: [Flexure; 3]);
    /// The state at the last pair taken in.
    fn view(&self) -> View<N>;
}
