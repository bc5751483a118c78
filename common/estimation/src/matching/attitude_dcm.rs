//! Attitude matching by direction cosines.
//!
//! Source: paper 003 eqs 3-16, in the axes that the registered installation `R0` gives the sub unit: `A_s' = R0 A_s R0^T`,
//! `C_s^m = Exp(phi0 + theta) R0`. Both attitudes begin as the identity at the filter's start, so that what is matched is the change of
//! the deformation since then, `y = phi - A_m^T phi(0)`; the rest of the static part is to be a few mrad.
//!
//! | state | size | moves by |
//! |---|---|---|
//! | static part phi0, rad | 3 | random walk of the configured density |
//! | flexure theta, rad, its rate, rad/s | 3 + 3 | second-order Gauss-Markov, exact |
//! | attitude errors Psi of main and sub unit, rad, in their starting axes | 3 + 3 | `Psi' = -A eps`, angle random walk |
//! | gyro biases eps of main and sub unit, rad/s | 3 + 3 | constant |
//!
//! Corrections: the coefficient of phi0 is `I - A_m^T` (the paper's "I - C C" is not small: it is all that shows the static part);
//! phi(0) is phi0 + theta(0), and as theta(0) looks like an error of the sub unit's attitude from the start, Psi_s starts as theta
//! does; the flexure's noise of eq 14 drives its rate, and the angle random walk the attitudes. The paper does not say how noisy the
//! measurement is: [`Options::noise`] covers what its linear form leaves out.

use super::grade::Grade;
use super::{Matching, Model, Motion, Observation, Prediction, Start, Turn, View, three};
use crate::flexure::Flexure;
use frames::{Main, Rot, Sub};
use nalgebra::{Matrix3, SMatrix, SVector, Vector3};
use serde::{Deserialize, Serialize};

/// Size of the error state.
pub const STATES: usize = 21;
const STATIC: usize = 0;
const FLEXURE: usize = 3;
const RATE: usize = 6;
const ATTITUDE: [usize; 2] = [9, 12];
const BIAS: [usize; 2] = [15, 18];
const TURN: Turn = Turn { fixed: STATIC, flexure: FLEXURE, rate: RATE };

/// Which use of attitude matching.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct Options {
    /// Standard deviation of the white noise of the measurement, rad.
    pub noise: f64,
    /// Density of the random walk of the static part, rad^2/s.
    pub static_walk: f64,
}

/// The nominal state.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct AttitudeDcm {
    options: Options,
    grade: Grade,
    flexure: [Flexure; 3],
    rotation: Rot<Main, Sub>,
    x: SVector<f64, STATES>,
    /// Attitudes of main and sub unit since the filter's start.
    attitude: [Matrix3<f64>; 2],
    /// Their integrals since the last propagation, s.
    turned: [Matrix3<f64>; 2],
    pending_s: f64,
}

/// What direction cosines say about the difference of two attitudes: `phi - A_m^T phi(0)`, rad.
///
/// `attitude_m` and `attitude_s` are those since the same instant, the latter in the axes that the installation gives the sub unit.
pub fn difference(attitude_m: &Matrix3<f64>, attitude_s: &Matrix3<f64>) -> Vector3<f64> {
    let d = attitude_m.transpose() * attitude_s;
    // 003 eq 4, 5: B Z
    Vector3::new(d[(2, 1)], -d[(2, 0)], -d[(0, 1)])
}

impl AttitudeDcm {
    // 003 eq 16, from the left by B
    fn matrix(&self) -> SMatrix<f64, 3, STATES> {
        let [m, s] = self.attitude.map(|attitude| attitude.transpose());
        let mut matrix = SMatrix::<f64, 3, STATES>::zeros();
        matrix.fixed_view_mut::<3, 3>(0, STATIC).copy_from(&(Matrix3::identity() - m));
        matrix.fixed_view_mut::<3, 3>(0, FLEXURE).fill_with_identity();
        matrix.fixed_view_mut::<3, 3>(0, ATTITUDE[0]).copy_from(&m);
        matrix.fixed_view_mut::<3, 3>(0, ATTITUDE[1]).copy_from(&-s);
        matrix
    }
}

impl Matching<STATES, 3> for AttitudeDcm {
    fn propagate(&mut self) -> Prediction<STATES> {
        let h = std::mem::take(&mut self.pending_s);
        let turned = std::mem::replace(&mut self.turned, [Matrix3::zeros(); 2]);
        let walk = [self.grade.main.arw, self.grade.sub.arw].map(|arw| arw * arw * h);
        let mut transition = SMatrix::<f64, STATES, STATES>::identity();
        let mut noise = SMatrix::<f64, STATES, STATES>::zeros();
        for axis in 0..3 {
            noise[(STATIC + axis, STATIC + axis)] = self.options.static_walk * h;
            // 003 eq 12, 14
            self.flexure[axis].place(h, FLEXURE + axis, RATE + axis, &mut transition, &mut noise);
        }
        for unit in 0..2 {
            // 003 eq 13
            transition.fixed_view_mut::<3, 3>(ATTITUDE[unit], BIAS[unit]).copy_from(&-turned[unit]);
            for axis in ATTITUDE[unit]..ATTITUDE[unit] + 3 {
                noise[(axis, axis)] = walk[unit];
            }
        }
        self.x = transition * self.x;
        Prediction { transition, noise }
    }

    // 003 eq 15
    fn observe(&self) -> Observation<STATES, 3> {
        let matrix = self.matrix();
        let [m, s] = &self.attitude;
        Observation {
            residual: difference(m, s) - matrix * self.x,
            matrix,
            noise: Matrix3::identity() * self.options.noise.powi(2),
        }
    }

    fn inject(&mut self, error: &SVector<f64, STATES>) {
        self.x += error;
    }
}

impl Model<STATES, 3> for AttitudeDcm {
    type Options = Options;

    fn begin(options: &Options, start: &Start) -> (Self, SMatrix<f64, STATES, STATES>) {
        let mut p = SMatrix::<f64, STATES, STATES>::zeros();
        p.fixed_view_mut::<3, 3>(STATIC, STATIC).copy_from(&start.covariance);
        for axis in 0..3 {
            start.flexure[axis].place_stationary(FLEXURE + axis, RATE + axis, &mut p);
            // Psi_s starts as theta
            let (place, variance) = (ATTITUDE[1] + axis, p[(FLEXURE + axis, FLEXURE + axis)]);
            p[(place, place)] = variance;
            p[(place, FLEXURE + axis)] = variance;
            p[(FLEXURE + axis, place)] = variance;
            for (place, unit) in BIAS.into_iter().zip([start.grade.main, start.grade.sub]) {
                p[(place + axis, place + axis)] = unit.bias * unit.bias;
            }
        }
        let model = Self {
            options: *options,
            grade: start.grade,
            flexure: start.flexure,
            rotation: start.rotation,
            x: SVector::zeros(),
            attitude: [Matrix3::identity(); 2],
            turned: [Matrix3::zeros(); 2],
            pending_s: 0.0,
        };
        (model, p)
    }

    fn advance(&mut self, motion: &Motion) {
        let main = motion.a_m.matrix();
        let installation = self.rotation.matrix();
        let sub = installation * motion.a_s.matrix() * installation.transpose();
        for (unit, attitude) in [main, sub].into_iter().enumerate() {
            self.turned[unit] += (self.attitude[unit] + attitude) * (0.5 * motion.interval_s);
        }
        self.attitude = [main, sub];
        self.pending_s += motion.interval_s;
    }

    fn set_flexure(&mut self, flexure: [Flexure; 3]) {
        self.flexure = flexure;
    }

    fn view(&self) -> View<STATES> {
        let drift = three(&self.x, BIAS[0]) - three(&self.x, BIAS[1]);
        View::of_small_turn(self.rotation, &self.x, TURN, drift)
    }
}

#[cfg(test)]
mod tests;
