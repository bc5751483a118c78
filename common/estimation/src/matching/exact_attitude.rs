//! Attitude matching at any angle that a rotation vector can bear, for an extended Kalman filter.
//!
//! Source: paper 001's identity behind eqs 11-13 and 37, `A_m D = N A_s`, kept as it is: `D = Exp(phi)`, `N = Exp(-eta)`, with the 18
//! states of [`super::angles`] started from zero. This is what "EKF" should have meant in table 4: eq 37 is linear and leaves nothing to
//! extend. The states are parameters of rotations and are corrected by addition, so the Jacobians carry those of the exponential, and the
//! filter fails where a rotation vector does, towards half a turn.

use super::angles::{Angles, BIAS, CONSTANT, Covariance, Rows, STATES, State};
use super::{Matching, Model, Motion, Observation, Prediction, Start, View};
use crate::flexure::Flexure;
use frames::{Main, MainStart, Rot, Sub, Vec3};
use nalgebra::{Matrix3, Vector3};

/// The nominal state.
#[derive(Clone, Debug)]
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

impl Matching<STATES, 3> for ExactAttitude {
    fn propagate(&mut self) -> Prediction<STATES> {
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

    fn observe(&self) -> Observation<STATES, 3> {
        let phi = self.angles.phi();
        let Angles { a_m, a_s, .. } = self.angles;
        let predicted: Rot<Main, Sub> = turn(phi);
        let measured: Rot<Main, Sub> = a_m.inverse() * self.constant() * a_s.relabel::<MainStart, Sub>();
        let mut matrix: Rows = left_jacobian(phi) * Angles::phi_rows();
        let by_constant = a_m.matrix().transpose() * left_jacobian(-self.angles.three(CONSTANT));
        matrix.fixed_view_mut::<3, 3>(0, CONSTANT).copy_from(&by_constant);
        Observation {
            residual: (measured * predicted.inverse()).log().column(),
            matrix,
            noise: Angles::measurement_noise(),
        }
    }

    fn inject(&mut self, error: &State) {
        self.angles.x += error;
    }
}

impl Model<STATES, 3> for ExactAttitude {
    type Options = ();

    fn begin(_: &(), start: &Start) -> (Self, Covariance) {
        let (angles, p) = Angles::begin(start, Rot::identity());
        (Self { angles }, p)
    }

    fn advance(&mut self, motion: &Motion) {
        self.angles.advance(motion);
    }

    fn set_flexure(&mut self, flexure: [Flexure; 3]) {
        self.angles.set_flexure(flexure);
    }

    fn view(&self) -> View<STATES> {
        let View { rows, noise, static_rows, rate, rate_rows, drift, deformation, static_part, .. } =
            self.angles.view();
        let by_phi = left_jacobian(deformation.log().column());
        View {
            rows: by_phi * rows,
            noise: by_phi * noise * by_phi.transpose(),
            static_rows: left_jacobian(static_part.log().column()) * static_rows,
            deformation,
            static_part,
            rate,
            rate_rows,
            drift,
            delay: None,
            skew: None,
        }
    }
}
