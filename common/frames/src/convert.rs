//! The one place where glam's and nalgebra's types meet.

use crate::{Frame, Rot, Vec3};
use glam::{DMat3, DQuat, DVec3};
use nalgebra::{Matrix3, Vector3};

impl<F: Frame> Vec3<F> {
    /// As a nalgebra column.
    pub fn column(self) -> Vector3<f64> {
        Vector3::new(self.v.x, self.v.y, self.v.z)
    }

    /// From a nalgebra column.
    pub fn from_column(v: Vector3<f64>) -> Self {
        Self::wrap(DVec3::new(v.x, v.y, v.z))
    }

    /// The matrix `[v x]` of the vector product.
    pub fn skew(self) -> Matrix3<f64> {
        self.column().cross_matrix()
    }
}

impl<F: Frame> Vec3<F> {
    /// For a rotation vector `phi`: how `Log(Exp(e) Exp(phi))` depends on a small rotation `e`, the inverse of SO(3)'s left
    /// Jacobian.
    pub fn left_jacobian_inverse(self) -> Matrix3<f64> {
        let angle = self.norm();
        let skew = self.skew();
        let factor = if angle < 1e-3 {
            1.0 / 12.0 + angle * angle / 720.0
        } else {
            (1.0 - 0.5 * angle / (0.5 * angle).tan()) / (angle * angle)
        };
        Matrix3::identity() - skew * 0.5 + skew * skew * factor
    }
}

impl<A: Frame, B: Frame> Rot<A, B> {
    /// As a matrix `C_B^A`.
    pub fn matrix(self) -> Matrix3<f64> {
        Matrix3::from_column_slice(&DMat3::from_quat(self.q).to_cols_array())
    }

    /// From a rotation matrix; the matrix must be orthogonal with determinant 1.
    pub fn from_matrix(c: &Matrix3<f64>) -> Self {
        let mut columns = [0.0; 9];
        columns.copy_from_slice(c.as_slice());
        Self::wrap(DQuat::from_mat3(&DMat3::from_cols_array(&columns)).normalize())
    }
}
