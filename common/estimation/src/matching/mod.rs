//! Matching models: what the difference of two units' attitudes says about the deformation.

pub mod so3;

use nalgebra::{SMatrix, SVector};

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
pub trait Matching<const N: usize, const K: usize> {
    /// Moves the nominal state on over everything taken in since the last call, and says what the error state did meanwhile.
    fn propagate(&mut self) -> Prediction<N>;
    /// Compares the nominal state with the units' attitudes.
    fn observe(&self) -> Observation<N, K>;
    /// Moves an estimated error from the error state into the nominal state.
    fn inject(&mut self, error: &SVector<f64, N>);
}
