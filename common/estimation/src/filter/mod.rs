//! Filters: how a measurement corrects a matching model.
//!
//! | filter | file |
//! |---|---|
//! | Kalman, and extended Kalman where the model's measurement is the exact one | [`kalman`] |
//! | unscented | [`unscented`] |

pub mod kalman;
pub mod unscented;

use crate::matching::Matching;
use nalgebra::SMatrix;

/// The filters that go with every matching model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Filter {
    /// Linear update at the nominal state.
    Kalman,
    /// Sigma points around the nominal state.
    Unscented,
}

impl Filter {
    /// Corrects a model whose error state has the covariance `p`, to which the last interval added `driven`. `None` when the
    /// numbers do not allow it.
    pub fn correct<M: Matching<N, K>, const N: usize, const K: usize>(
        &self,
        model: &mut M,
        p: &mut SMatrix<f64, N, N>,
        _driven: &SMatrix<f64, N, N>,
    ) -> Option<()> {
        let seen = model.observe();
        let error = match self {
            Self::Kalman => kalman::update(p, &seen.residual, &seen.matrix, &seen.noise)?,
            Self::Unscented => unscented::update(model, p, &seen.noise)?,
        };
        model.inject(&error);
        Some(())
    }
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
