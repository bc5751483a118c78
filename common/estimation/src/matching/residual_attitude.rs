//! Attitude matching of what a registration has left over.
//!
//! Source: paper 001 eqs 10-23. With the registration `R0` the total is `D = Exp(phi) R0`, and
//! `Z = Log(R0 A_s R0^T A_m^T) = A_m phi + eta` to first order, linear in the 18 states of [`super::angles`].
//!
//! Corrections: the matrices printed at eqs 14 and 17 are symmetric, the text's `I + [phi x]` holds; eq 22's arcsin of a quotient is an
//! arctangent, and the rotation vector leaves less than any Euler angles; eq 35 adds Euler angles, which is off by 23 arcsec at
//! 4.5 degrees, and is a product of rotations here; eq 34 drops the state that is wanted and gives it to a network, for which see
//! [`super::neural`].

use super::angles::{Angles, CONSTANT, Covariance, FLEXURE, Rows, STATES, STATIC, State};
use super::{Matching, Model, Motion, Observation, Prediction, Start, View};
use crate::flexure::Flexure;
use nalgebra::Vector3;

/// The nominal state.
#[derive(Clone, Debug)]
pub struct ResidualAttitude {
    /// The states.
    pub angles: Angles,
}

impl ResidualAttitude {
    /// What is measured, rad.
    // 001 eqs 20-22
    pub fn measured(&self) -> Vector3<f64> {
        let Angles { base, a_m, a_s, .. } = self.angles;
        let r0 = base.relabel::<frames::MainStart, frames::SubStart>();
        (r0 * a_s * base.inverse() * a_m.inverse()).log().column()
    }

    /// How that depends on the states.
    // 001 eq 23
    pub fn matrix(&self) -> Rows {
        let a = self.angles.a_m.matrix();
        let mut matrix = Angles::rows_of(CONSTANT);
        matrix.fixed_view_mut::<3, 3>(0, STATIC).copy_from(&a);
        matrix.fixed_view_mut::<3, 3>(0, FLEXURE).copy_from(&a);
        matrix
    }
}

impl Matching<STATES, 3> for ResidualAttitude {
    fn propagate(&mut self) -> Prediction<STATES> {
        self.angles.propagate()
    }

    fn observe(&self) -> Observation<STATES, 3> {
        let matrix = self.matrix();
        Observation { residual: self.measured() - matrix * self.angles.x, matrix, noise: Angles::measurement_noise() }
    }

    fn inject(&mut self, error: &State) {
        self.angles.x += error;
    }
}

impl Model<STATES, 3> for ResidualAttitude {
    type Options = ();

    fn begin(_: &(), start: &Start) -> (Self, Covariance) {
        let (angles, p) = Angles::begin(start, start.rotation);
        (Self { angles }, p)
    }

    fn advance(&mut self, motion: &Motion) {
        self.angles.advance(motion);
    }

    fn set_flexure(&mut self, flexure: [Flexure; 3]) {
        self.angles.set_flexure(flexure);
    }

    fn view(&self) -> View<STATES> {
        self.angles.view()
    }
}
