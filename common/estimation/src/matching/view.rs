//! What a matching model has to say at an instant, and the rows that pick three of its states.

use frames::{Main, Rot, Sub, Vec3};
use nalgebra::{Matrix3, SMatrix, SVector, Vector3};
use serde::{Deserialize, Serialize};

/// What a model has to say at an instant; `rows` give the error of what stands beside them from the error state.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct View<const N: usize> {
    /// Total deformation.
    pub deformation: Rot<Main, Sub>,
    /// Of the error of the total, in m.
    pub rows: SMatrix<f64, 3, N>,
    /// Covariance that has entered the total since the last propagation, rad^2.
    pub noise: Matrix3<f64>,
    /// Static part.
    pub static_part: Rot<Main, Sub>,
    /// Of the error of the static part.
    pub static_rows: SMatrix<f64, 3, N>,
    /// Rate of the flexure, rad/s.
    pub rate: Vec3<Main>,
    /// Of the error of that rate.
    pub rate_rows: SMatrix<f64, 3, N>,
    /// Relative gyro bias, main minus sub unit, rad/s.
    pub drift: Vec3<Main>,
    /// By how much the sub unit's stamps are late, s, with the place of its state; `None` where it is not estimated.
    pub delay: Option<(f64, usize)>,
    /// By how much the delay grows in a second, with the place of its state.
    pub skew: Option<(f64, usize)>,
}

/// Where the states of a small turn stand.
#[derive(Clone, Copy, Debug)]
pub(super) struct Turn {
    /// Static part.
    pub fixed: usize,
    /// Flexure.
    pub flexure: usize,
    /// Rate of the flexure.
    pub rate: usize,
}

impl<const N: usize> View<N> {
    /// Of the states `x` of a model whose total is a small turn, static part and flexure, of the rotation `base`.
    pub(super) fn of_small_turn(base: Rot<Main, Sub>, x: &SVector<f64, N>, at: Turn, drift: Vector3<f64>) -> Self {
        let turned = |phi: Vector3<f64>| Rot::<Main, Main>::exp(Vec3::from_column(phi)) * base;
        Self {
            deformation: turned(three(x, at.fixed) + three(x, at.flexure)),
            rows: rows_of(at.fixed) + rows_of(at.flexure),
            noise: Matrix3::zeros(),
            static_part: turned(three(x, at.fixed)),
            static_rows: rows_of(at.fixed),
            rate: Vec3::from_column(three(x, at.rate)),
            rate_rows: rows_of(at.rate),
            drift: Vec3::from_column(drift),
            delay: None,
            skew: None,
        }
    }
}

/// Three states.
pub(super) fn three<const N: usize>(x: &SVector<f64, N>, place: usize) -> Vector3<f64> {
    x.fixed_rows::<3>(place).into()
}

/// How three states depend on the states.
pub(super) fn rows_of<const N: usize>(place: usize) -> SMatrix<f64, 3, N> {
    let mut rows = SMatrix::<f64, 3, N>::zeros();
    rows.fixed_view_mut::<3, 3>(0, place).fill_with_identity();
    rows
}
