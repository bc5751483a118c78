//! Attitude matching at any angle that a rotation vector can bear, for an extended Kalman filter.
//!
//! Source: paper 001's identity behind eqs 11-13 and 37, `A_m D = N A_s`, kept as it is: `D = Exp(phi)`, `N = Exp(-eta)`, with the 18
//! states of [`super::angles`] started from zero. This is what "EKF" should have meant in table 4: eq 37 is linear and leaves nothing to
//! extend. The states are parameters of rotations and are corrected by addition, so the Jacobians carry those of the exponential, and the
//! filter fails where a rotation vector does, towards half a turn.

use super::angle_model::AngleModel;
use super::angles::{Angles, BIAS, CONSTANT, Rows, STATES};
use super::{Prediction, View};
use frames::{Main, MainStart, Rot, Sub, Vec3};
use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

/// The nominal state.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct ExactAttitude {
    angles: Angles,
}

/// How `Exp(phi + e)` differs from `Exp(phi)`: by `Exp(J e)` from the left.
fn left_jacobian(phi: Vector3<f64>) -> Matrix3<f64> {
    let square = phi.norm_squared();
    let skew = phi.cross_matrix();
    let (first, second) = if square < 1e-6 {
        (0.5 - square / 24.0, 1.0 / 6.0 - square / 120.0)
    } else {
        let angle = square.sqrt();
        ((1.0 - angle.cos()) / square, (angle - angle.sin()) / (square * angle))
    };
    Matrix3::identity() + skew * first + skew * skew * second
}

fn turn(phi: Vector3<f64>) -> Rot<Main, Sub> {
    Rot::exp(Vec3::from_column(phi))
}

impl ExactAttitude {
    fn constant(&self) -> Rot<MainStart, MainStart> {
        Rot::exp(Vec3::from_column(-self.angles.three(CONSTANT)))
    }
}

impl AngleModel for ExactAttitude {
    fn new(angles: Angles) -> Self {
        Self { angles }
    }

    fn angles(&self) -> &Angles {
        &self.angles
    }

    fn angles_mut(&mut self) -> &mut Angles {
        &mut self.angles
    }

    fn residual(&self) -> Vector3<f64> {
        let Angles { a_m, a_s, .. } = self.angles;
        let predicted: Rot<Main, Sub> = turn(self.angles.phi());
        let measured: Rot<Main, Sub> = a_m.inverse() * self.constant() * a_s.relabel::<MainStart, Sub>();
        (measured * predicted.inverse()).log().column()
    }

    fn matrix(&self) -> Rows {
        let mut matrix: Rows = left_jacobian(self.angles.phi()) * Angles::phi_rows();
        let by_constant = self.angles.a_m.matrix().transpose() * left_jacobian(-self.angles.three(CONSTANT));
        matrix.fixed_view_mut::<3, 3>(0, CONSTANT).copy_from(&by_constant);
        matrix
    }

    fn carry(&mut self) -> Prediction<STATES> {
        let before = self.angles.three(CONSTANT);
        let Prediction { mut transition, mut noise } = self.angles.propagate();
        // the gyros' error turns N from the left; eta is minus its rotation vector
        let by_turn = Vec3::<Main>::from_column(-before).left_jacobian_inverse();
        let drift = by_turn * transition.fixed_view::<3, 3>(CONSTANT, BIAS);
        transition.fixed_view_mut::<3, 3>(CONSTANT, BIAS).copy_from(&drift);
        let walk = by_turn * noise.fixed_view::<3, 3>(CONSTANT, CONSTANT) * by_turn.transpose();
        noise.fixed_view_mut::<3, 3>(CONSTANT, CONSTANT).copy_from(&walk);
        let after = before + drift * self.angles.three(BIAS);
        self.angles.x.fixed_rows_mut::<3>(CONSTANT).copy_from(&after);
        Prediction { transition, noise }
    }

    fn total_view(&self) -> View<STATES> {
        let view = self.angles.view();
        let by_phi = left_jacobian(view.deformation.log().column());
        View {
            rows: by_phi * view.rows,
            noise: by_phi * view.noise * by_phi.transpose(),
            static_rows: left_jacobian(view.static_part.log().column()) * view.static_rows,
            ..view
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::matching::conformance::{STEP_S, Voyage, at_constant, matrix_is_the_derivative, start};
    use crate::matching::{Matching, Model};
    use frames::unit::ARCSEC;
    use nalgebra::SVector;

    fn at_truth(installation: Vec3<Main>, k: usize) -> ExactAttitude {
        let installation = Rot::<Main, Sub>::exp(installation);
        let voyage = Voyage { installation, flexure: 10.0 * ARCSEC, delay_s: 0.0, lever_arm: Vec3::ZERO };
        let (mut model, _) = ExactAttitude::begin(&(), &start(Rot::identity()));
        model.advance(&voyage.motion(k));
        model.angles.propagate();
        let phi = |t: f64| voyage.deformation(t).log().column();
        at_constant(&mut model.angles, installation.log().column(), phi(k as f64 * STEP_S), -phi(0.0));
        model
    }

    #[test]
    fn the_residual_vanishes_at_the_truth_at_any_angle() {
        for size in [1e-4, 0.1, 1.0, 2.5] {
            for k in [1, 137, 522] {
                let residual = at_truth(Vec3::new(0.5, 0.6, -0.62) * size, k).observe().residual.norm();
                assert!(residual < 1e-11, "{size} {k} {residual:e}");
            }
        }
    }

    #[test]
    fn the_measurement_matrix_is_the_derivative() {
        for size in [1e-4, 0.1, 1.0, 2.5] {
            let model = at_truth(Vec3::new(0.5, 0.6, -0.62) * size, 137);
            matrix_is_the_derivative(&model, &SVector::repeat(1e-5), 1e-6);
        }
    }

    #[test]
    fn the_drift_is_the_derivative_of_the_turned_constant() {
        let mut model = at_truth(Vec3::new(0.5, 0.6, -0.62), 137);
        let voyage = Voyage { installation: Rot::identity(), flexure: 0.0, delay_s: 0.0, lever_arm: Vec3::ZERO };
        (1..=10).for_each(|k| model.advance(&voyage.motion(k)));
        for axis in 0..3 {
            let drifted = |by: f64| {
                let mut other = model.clone();
                other.angles.x[BIAS + axis] += by;
                other.propagate();
                other.angles.three(CONSTANT)
            };
            let numeric = (drifted(1e-4) - drifted(-1e-4)) / 2e-4;
            let transition = model.clone().propagate().transition;
            assert!((numeric - transition.fixed_view::<3, 1>(CONSTANT, BIAS + axis)).norm() < 1e-6 * numeric.norm());
        }
    }
}
