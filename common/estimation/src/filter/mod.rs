//! Filters: how a measurement corrects a matching model.
//!
//! | filter | file |
//! |---|---|
//! | Kalman, and extended Kalman where the model's measurement is the exact one | [`kalman`] |
//! | the same one value at a time | [`sequential`] |
//! | unscented | [`unscented`] |
//! | maximum correntropy | [`correntropy`] |
//! | model predictive, before either of them | [`predictive`] |

pub mod correntropy;
pub mod kalman;
pub mod predictive;
pub mod sequential;
pub mod unscented;

use crate::matching::{Matching, Observation};
use correntropy::Kernel;
use nalgebra::{SMatrix, SVector};
use predictive::Weight;

/// The filters that go with every matching model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Filter {
    /// Linear update at the nominal state.
    Kalman,
    /// Sigma points around the nominal state.
    Unscented,
    /// Linear update with each measurement weighed by its residual.
    Correntropy(Kernel),
    /// The model's error is predicted and compensated first; then comes a linear update, weighed where a kernel is given.
    Predictive(Weight, Option<Kernel>),
}

impl Filter {
    /// Corrects a model whose error state has the covariance `p`, to which the last interval added `driven`. `None` when the
    /// numbers do not allow it.
    pub fn correct<M: Matching<N, K>, const N: usize, const K: usize>(
        &self,
        model: &mut M,
        p: &mut SMatrix<f64, N, N>,
        driven: &SMatrix<f64, N, N>,
    ) -> Option<()> {
        let error = match *self {
            Self::Kalman => linear(model, p, None)?,
            Self::Unscented => unscented::update(model, p, &model.observe().noise)?,
            Self::Correntropy(kernel) => linear(model, p, Some(kernel))?,
            Self::Predictive(weight, kernel) => {
                let seen = model.observe();
                let moved = predictive::compensation(weight, p, driven, &seen.residual, &seen.matrix, &seen.noise)?;
                model.inject(&moved);
                linear(model, p, kernel)?
            }
        };
        model.inject(&error);
        Some(())
    }
}

/// Kalman's update, the measurements weighed where a kernel is given.
fn linear<M: Matching<N, K>, const N: usize, const K: usize>(
    model: &M,
    p: &mut SMatrix<f64, N, N>,
    kernel: Option<Kernel>,
) -> Option<SVector<f64, N>> {
    let Observation { residual, matrix, noise } = model.observe();
    let noise = kernel.map_or(noise, |kernel| kernel.noise(p, &residual, &matrix, &noise));
    kalman::update(p, &residual, &matrix, &noise)
}

/// Makes a covariance exactly symmetric.
pub fn symmetrise<const N: usize>(p: &mut SMatrix<f64, N, N>) {
    for i in 0..N {
        for j in 0..i {
            let mean = 0.5 * (p[(i, j)] + p[(j, i)]);
            p[(i, j)] = mean;
            p[(j, i)] = mean;
        }
    }
}
