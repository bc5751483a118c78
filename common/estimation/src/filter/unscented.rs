//! The unscented update, on the error state of any model: it asks the model for its residual away from the nominal state.
//!
//! Source: the textbook form that papers 001 and 002 call upon, `2 N + 1` points with all weights positive, so that no covariance can
//! lose its sign by the weights. The points are 20 lines; the public crates that have them bring their own matrices or filters, or are
//! no longer kept.
//!
//! Propagation is linear for every model here and needs no points.

use super::symmetrise;
use crate::matching::Matching;
use nalgebra::{SMatrix, SVector};

/// Weight of the middle point, in units of those of a pair of outer points.
const MIDDLE: f64 = 1.0;
/// What is added to the diagonal, relative to it, when the covariance has lost its definiteness by rounding.
const JITTER: [f64; 3] = [0.0, 1e-12, 1e-9];

/// The estimate of the error state with `p` replaced by the covariance after the update; `r` is the measurement's noise.
/// `None`, and `p` as it was, when the numbers do not allow it.
pub fn update<M: Matching<N, K>, const N: usize, const K: usize>(
    model: &M,
    p: &mut SMatrix<f64, N, N>,
    r: &SMatrix<f64, K, K>,
) -> Option<SVector<f64, N>> {
    let root = root(p)?;
    let spread = N as f64 + MIDDLE;
    let weight = 0.5 / spread;
    let middle = model.residual_after(&SVector::zeros());
    let mut pairs = [(SVector::<f64, K>::zeros(), SVector::<f64, K>::zeros()); N];
    let mut mean = middle * (MIDDLE / spread);
    for (i, pair) in pairs.iter_mut().enumerate() {
        let point = root.column(i) * spread.sqrt();
        *pair = (model.residual_after(&point), model.residual_after(&-point));
        mean += (pair.0 + pair.1) * weight;
    }
    let mut innovation = r + (middle - mean) * (middle - mean).transpose() * (MIDDLE / spread);
    let mut by_root = SMatrix::<f64, N, K>::zeros();
    for (i, (plus, minus)) in pairs.iter().enumerate() {
        let (a, b) = (plus - mean, minus - mean);
        innovation += (a * a.transpose() + b * b.transpose()) * weight;
        // a residual falls where the predicted measurement rises
        by_root.set_row(i, &((minus - plus) * (weight * spread.sqrt())).transpose());
    }
    let cross = root * by_root;
    let gain = innovation.cholesky()?.solve(&cross.transpose()).transpose();
    let mut after = *p - gain * cross.transpose();
    symmetrise(&mut after);
    let correction = gain * mean;
    if !correction.iter().chain(after.iter()).all(|x| x.is_finite()) {
        return None;
    }
    *p = after;
    Some(correction)
}

/// A root of the covariance.
fn root<const N: usize>(p: &SMatrix<f64, N, N>) -> Option<SMatrix<f64, N, N>> {
    let size = SVector::<f64, N>::from_fn(|i, _| p[(i, i)].max(0.0).sqrt());
    let unit = |i: usize| if size[i] > 0.0 { size[i] } else { 1.0 };
    // of the correlations: states of all sizes stand side by side
    let correlation = SMatrix::<f64, N, N>::from_fn(|i, j| p[(i, j)] / (unit(i) * unit(j)));
    JITTER.into_iter().find_map(|jitter| {
        let raised = SMatrix::<f64, N, N>::from_fn(|i, j| {
            let known = i == j && size[i] == 0.0;
            correlation[(i, j)]
                + if known {
                    f64::MIN_POSITIVE
                } else if i == j {
                    jitter
                } else {
                    0.0
                }
        });
        let mut root = raised.cholesky()?.l();
        for i in 0..N {
            root.row_mut(i).scale_mut(size[i]);
        }
        Some(root)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::filter::kalman;
    use crate::matching::{Observation, Prediction};
    use nalgebra::{Matrix1, Matrix2, Matrix3, Vector1, Vector2, Vector3};

    /// Measures `x + curve y^2` of the state `x, y`, or both of them.
    #[derive(Clone)]
    struct Bowl {
        x: Vector2<f64>,
        curve: f64,
        measured: f64,
    }

    impl Matching<2, 1> for Bowl {
        fn propagate(&mut self) -> Prediction<2> {
            Prediction { transition: Matrix2::identity(), noise: Matrix2::zeros() }
        }
        fn observe(&self) -> Observation<2, 1> {
            Observation {
                residual: Vector1::new(self.measured - self.x[0] - self.curve * self.x[1] * self.x[1]),
                matrix: [[1.0], [2.0 * self.curve * self.x[1]]].into(),
                noise: Matrix1::new(0.25),
            }
        }
        fn inject(&mut self, error: &SVector<f64, 2>) {
            self.x += error;
        }
    }

    const SPREAD: Matrix2<f64> = Matrix2::new(2.0, 0.6, 0.6, 1.5);

    #[test]
    fn of_a_linear_measurement_it_is_kalmans_update() {
        let model = Bowl { x: Vector2::new(0.3, 0.0), curve: 0.0, measured: 2.0 };
        let seen = model.observe();
        let (mut unscented, mut linear) = (SPREAD, SPREAD);
        let found = update(&model, &mut unscented, &seen.noise).expect("regular");
        let plain = kalman::update(&mut linear, &seen.residual, &seen.matrix, &seen.noise).expect("regular");
        assert!((found - plain).norm() < 1e-12 && (unscented - linear).norm() < 1e-12);
    }

    #[test]
    fn it_sees_the_mean_of_a_curved_measurement() {
        let model = Bowl { x: Vector2::zeros(), curve: 0.5, measured: 0.0 };
        let mut p = Matrix2::identity();
        let found = update(&model, &mut p, &Matrix1::new(0.25)).expect("regular");
        // the measurement's mean is curve var(y) = 0.5, its variance 1 + 0.25 + the curve's share, which three points a state give as
        // curve^2 (n + 1 - 1) = 0.5
        assert!((found[0] + 0.5 / 1.75).abs() < 1e-12 && found[1].abs() < 1e-12, "{found}");
    }

    #[test]
    fn a_covariance_without_definiteness_is_mended_a_state_without_doubt_stays() {
        let wrong = Matrix3::new(1.0, 1.0, 0.0, 1.0, 1.0 - 1e-13, 0.0, 0.0, 0.0, 0.0);
        let root = root(&wrong).expect("mended");
        assert!((root * root.transpose() - wrong).norm() < 1e-8 && root.row(2).norm() == 0.0);
        assert!(super::root(&Matrix3::from_diagonal(&Vector3::new(1.0, f64::NAN, 1.0))).is_none());
    }
}
