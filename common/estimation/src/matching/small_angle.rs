//! Attitude matching without a registration, for small angles.
//!
//! Source: paper 001 eq 37, the measurement of its rivals: `Z`, the Euler angles of `A_m^T A_s`, is `A_m^T eta + phi` to first order in the
//! 18 states of [`super::angles`], and `phi` is the total's Euler angles in eq 22's order. What it leaves out is of the size of the sway
//! times the square of the angle: 14 arcsec at a degree, of which a filter that takes it for deformation makes 50. Being linear, it gives an extended Kalman filter nothing to
//! linearise: for that there is [`super::exact_attitude`].
//!
//! Corrections: eq 22's arcsin of a quotient is an arctangent.

use super::angle_model::AngleModel;
use super::angles::{Angles, CONSTANT, Rows, STATES, STATIC};
use super::neural::AngleMatching;
use super::{View, rows_of};
use frames::{Main, Rot, Sub, Vec3};
use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

/// The nominal state.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct SmallAngle {
    /// The states.
    pub angles: Angles,
}

impl AngleModel for SmallAngle {
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
        self.measured() - self.matrix() * self.angles.x
    }

    // 001 eq 37
    fn matrix(&self) -> Rows {
        let mut matrix = Angles::phi_rows();
        matrix.fixed_view_mut::<3, 3>(0, CONSTANT).copy_from(&self.angles.a_m.matrix().transpose());
        matrix
    }

    fn total_view(&self) -> View<STATES> {
        let now = self.angles.now();
        View {
            deformation: rotation(Angles::phi_rows() * now),
            static_part: rotation(rows_of(STATIC) * now),
            ..self.angles.view()
        }
    }
}

impl AngleMatching for SmallAngle {
    fn measured(&self) -> Vector3<f64> {
        let turned: Rot<Main, Sub> = self.angles.a_m.relabel::<Main, Main>().inverse() * self.angles.a_s.relabel();
        euler(&turned.matrix())
    }

    fn by_deformation(&self) -> Matrix3<f64> {
        Matrix3::identity()
    }

    fn total(&self, phi: Vector3<f64>) -> Rot<Main, Sub> {
        rotation(phi)
    }
}

/// The Euler angles about x, y, z of `Rz Rx Ry`.
// 001 eq 22
pub(super) fn euler(c: &Matrix3<f64>) -> Vector3<f64> {
    let x = c[(2, 1)].clamp(-1.0, 1.0).asin();
    Vector3::new(x, (-c[(2, 0)]).atan2(c[(2, 2)]), (-c[(0, 1)]).atan2(c[(1, 1)]))
}

/// The rotation of Euler angles about x, y, z.
fn rotation(phi: Vector3<f64>) -> Rot<Main, Sub> {
    let about = |axis: Vec3<Main>| Rot::<Main, Main>::exp(axis);
    let turned = about(Vec3::new(0.0, 0.0, phi.z)) * about(Vec3::new(phi.x, 0.0, 0.0));
    (turned * about(Vec3::new(0.0, phi.y, 0.0))).relabel()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::matching::conformance::{STEP_S, Voyage, at_constant, matrix_is_the_derivative, start};
    use crate::matching::{Matching, Model};
    use frames::unit::{ARCSEC, DEGREE};
    use nalgebra::SVector;

    fn at_truth(installation: Vec3<Main>, k: usize) -> SmallAngle {
        let installation = Rot::<Main, Sub>::exp(installation);
        let voyage = Voyage { installation, flexure: 10.0 * ARCSEC, delay_s: 0.0, lever_arm: Vec3::ZERO };
        let (mut model, _) = SmallAngle::begin(&(), &start(Rot::identity()));
        model.advance(&voyage.motion(k));
        model.angles.propagate();
        let angles = |t: f64| euler(&voyage.deformation(t).matrix());
        at_constant(&mut model.angles, euler(&installation.matrix()), angles(k as f64 * STEP_S), -angles(0.0));
        model
    }

    #[test]
    fn euler_angles_and_their_rotation_are_inverse() {
        let phi = Vector3::new(0.4, -2.0, 1.3);
        assert!((euler(&rotation(phi).matrix()) - phi).norm() < 1e-12);
    }

    #[test]
    fn the_residual_vanishes_at_the_truth_to_second_order() {
        let installation = Vec3::new(60.0, -40.0, 80.0) * ARCSEC;
        for k in [1, 137, 522] {
            let size = at_truth(installation, k).observe().residual.norm();
            let double = at_truth(installation * 2.0, k).observe().residual.norm();
            assert!(size < 0.2 * ARCSEC && double < 6.0 * size.max(1e-2 * ARCSEC), "{size:e} {double:e}");
        }
    }

    #[test]
    fn at_large_angles_the_square_is_left() {
        let worst = |degrees: f64| {
            let installation = Vec3::new(1.0, 1.0, 1.0) * (degrees * DEGREE);
            (1..20).map(|i| at_truth(installation, i * 50).observe().residual.norm()).fold(0.0, f64::max)
        };
        assert!(worst(1.0) > 10.0 * ARCSEC && (3.5..4.5).contains(&(worst(2.0) / worst(1.0))));
    }

    #[test]
    fn the_measurement_matrix_is_the_derivative() {
        matrix_is_the_derivative(&at_truth(Vec3::new(1e-4, 2e-4, -1e-4), 137), &SVector::repeat(1e-6), 1e-7);
    }
}
