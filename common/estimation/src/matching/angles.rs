//! The 18 states that the attitude matchings by angles of paper 001 share.
//!
//! Source: paper 001 eqs 26-30. Its 39 states enter the measurement only by these, to first order:
//!
//! | state | size | moves by |
//! |---|---|---|
//! | static part, rad | 3 | its rate |
//! | rate of it, rad/s | 3 | white noise `q` |
//! | flexure, rad, its rate, rad/s | 3 + 3 | second-order Gauss-Markov, exact |
//! | `eta = theta1 - phi0 - R0 theta2`, rad, in the main unit's starting axes | 3 | relative gyro errors |
//! | relative gyro error `eps1 - R0 eps2`, rad/s, in m | 3 | constant |
//!
//! Corrections: eq 27's noise of unit variance means nothing, its density is a setting; eq 28's main frequency stands in table 1 in Hz and
//! counts as an angular frequency; eq 29 lacks the derivative's dot. The gyro's first-order Markov part is left to the constant's doubt.

use super::constant::Since;
use super::grade::{Grade, MATCHING_SIGMA};
use super::{Motion, Prediction, Start, Turn, View, rows_of, three};
use crate::flexure::Flexure;
use frames::{Main, MainStart, Rot, Sub, SubStart};
use nalgebra::{Matrix3, SMatrix, SVector, Vector3};
use serde::{Deserialize, Serialize};

/// Size of the error state.
pub const STATES: usize = 18;
/// Static part.
pub const STATIC: usize = 0;
/// Its rate.
pub const STATIC_RATE: usize = 3;
/// Flexure.
pub const FLEXURE: usize = 6;
/// Its rate.
pub const FLEXURE_RATE: usize = 9;
/// `eta`.
pub const CONSTANT: usize = 12;
/// Relative gyro error.
pub const BIAS: usize = 15;

/// Rows of something with three components.
pub type Rows = SMatrix<f64, 3, STATES>;
/// Covariance of the error state.
pub type Covariance = SMatrix<f64, STATES, STATES>;
/// Error state.
pub type State = SVector<f64, STATES>;

const TURN: Turn = Turn { fixed: STATIC, flexure: FLEXURE, rate: FLEXURE_RATE };

/// The states, and what has come in since they were last propagated.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Angles {
    grade: Grade,
    flexure: [Flexure; 3],
    /// What the total stands on: the registration, or nothing.
    pub base: Rot<Main, Sub>,
    /// The states.
    pub x: State,
    /// Accumulated attitude of the main unit.
    pub a_m: Rot<MainStart, Main>,
    /// Accumulated attitude of the sub unit.
    pub a_s: Rot<SubStart, Sub>,
    since: Since,
}

impl Angles {
    /// The states at the filter's start, with their covariance. `eta` is what makes the first measurement right: all of its doubt is
    /// that of static part and flexure.
    pub fn begin(start: &Start, base: Rot<Main, Sub>) -> (Self, Covariance) {
        let mut p = Covariance::zeros();
        p.fixed_view_mut::<3, 3>(STATIC, STATIC).copy_from(&start.covariance);
        for axis in 0..3 {
            p[(STATIC_RATE + axis, STATIC_RATE + axis)] = start.grade.static_rate_variance();
            start.flexure[axis].place_stationary(FLEXURE + axis, FLEXURE_RATE + axis, &mut p);
            p[(BIAS + axis, BIAS + axis)] = start.grade.bias_variance();
        }
        let mut link = Covariance::identity();
        link.fixed_view_mut::<3, 3>(CONSTANT, STATIC).copy_from(&-Matrix3::identity());
        link.fixed_view_mut::<3, 3>(CONSTANT, FLEXURE).copy_from(&-Matrix3::identity());
        let angles = Self {
            grade: start.grade,
            flexure: start.flexure,
            base,
            x: State::zeros(),
            a_m: Rot::identity(),
            a_s: Rot::identity(),
            since: Since::default(),
        };
        (angles, link * p * link.transpose())
    }

    /// Three states.
    pub fn three(&self, place: usize) -> Vector3<f64> {
        three(&self.x, place)
    }

    /// Static part and flexure.
    pub fn phi(&self) -> Vector3<f64> {
        self.three(STATIC) + self.three(FLEXURE)
    }

    /// How [`Angles::phi`] depends on the states.
    pub fn phi_rows() -> Rows {
        rows_of(STATIC) + rows_of(FLEXURE)
    }

    /// Covariance of a matching measurement, rad^2.
    pub fn measurement_noise() -> Matrix3<f64> {
        Matrix3::identity() * MATCHING_SIGMA.powi(2)
    }

    /// Replaces the flexure model from now on.
    pub fn set_flexure(&mut self, flexure: [Flexure; 3]) {
        self.flexure = flexure;
    }

    /// Takes in a pair.
    pub fn advance(&mut self, motion: &Motion) {
        self.since.advance(motion, &self.grade);
        (self.a_m, self.a_s) = (motion.a_m, motion.a_s);
    }

    /// What the states do over the time since the last propagation.
    fn ahead(&self) -> Prediction<STATES> {
        let h = self.since.time_s;
        let mut transition = Covariance::identity();
        let mut noise = Covariance::zeros();
        for axis in 0..3 {
            // 001 eq 27
            self.grade.place_static(h, STATIC + axis, STATIC_RATE + axis, &mut transition, &mut noise);
            // 001 eq 28
            self.flexure[axis].place(h, FLEXURE + axis, FLEXURE_RATE + axis, &mut transition, &mut noise);
        }
        // 001 eq 29
        self.since.place(CONSTANT, BIAS, &mut transition, &mut noise);
        Prediction { transition, noise }
    }

    /// Moves the states on.
    pub fn propagate(&mut self) -> Prediction<STATES> {
        let prediction = self.ahead();
        self.x = prediction.transition * self.x;
        self.since = Since::default();
        prediction
    }

    /// The states carried on to the last pair taken in.
    pub fn now(&self) -> State {
        self.ahead().transition * self.x
    }

    /// The total at the last pair taken in.
    pub fn view(&self) -> View<STATES> {
        let Prediction { transition, noise } = self.ahead();
        let now = transition * self.x;
        let view = View::of_small_turn(self.base, &now, TURN, three(&now, BIAS));
        View {
            rows: view.rows * transition,
            noise: view.rows * noise * view.rows.transpose(),
            static_rows: view.static_rows * transition,
            rate_rows: view.rate_rows * transition,
            ..view
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::matching::conformance::Voyage;
    use frames::Vec3;
    use frames::unit::ARCSEC;

    fn voyage() -> Voyage {
        Voyage { installation: Rot::identity(), flexure: 0.0, delay_s: 0.0, lever_arm: Vec3::ZERO }
    }

    fn angles() -> (Angles, Covariance) {
        let start = Start {
            grade: Grade { static_noise: 1e-4 * ARCSEC * ARCSEC, ..Grade::default() },
            accel: Default::default(),
            lever_arm: Vec3::ZERO,
            flexure: [Flexure { mu: 0.1, b: 1.0, sigma: 2.0 * ARCSEC }; 3],
            rotation: Rot::identity(),
            covariance: Matrix3::identity() * (100.0 * ARCSEC).powi(2),
        };
        Angles::begin(&start, start.rotation)
    }

    #[test]
    fn the_first_measurement_is_in_no_doubt() {
        let (_, p) = angles();
        let rows = Angles::phi_rows() + rows_of(CONSTANT);
        assert!((rows * p * rows.transpose()).norm() < 1e-12 * p.norm());
    }

    #[test]
    fn the_transition_is_the_derivative_of_the_propagation() {
        let (mut angles, _) = angles();
        (1..=10).for_each(|k| angles.advance(&voyage().motion(k)));
        for i in 0..STATES {
            let moved = |by: f64| {
                let mut other = angles.clone();
                other.x[i] += by;
                other.propagate();
                other.x
            };
            let transition = angles.clone().propagate().transition;
            let numeric = (moved(1e-5) - moved(-1e-5)) / 2e-5;
            assert!((numeric - transition.column(i)).norm() < 1e-9, "state {i}");
        }
    }

    #[test]
    fn the_constant_drifts_by_the_gyros_error_as_the_attitude_does() {
        // the main unit's gyro shows eps too much: its attitude runs ahead by A_m eps dt, and eta back by as much
        let eps = Vec3::<Main>::new(3e-6, -2e-6, 4e-6);
        let (mut angles, _) = angles();
        angles.x.fixed_rows_mut::<3>(BIAS).copy_from(&eps.column());
        let mut wrong = Rot::<MainStart, Main>::identity();
        for k in 1..=2000 {
            let motion = voyage().motion(k);
            wrong = wrong * Rot::<Main, Main>::exp(motion.dtheta_m + eps * motion.interval_s);
            angles.advance(&motion);
        }
        angles.propagate();
        let ahead = (wrong * angles.a_m.inverse()).log().column();
        assert!((angles.three(CONSTANT) + ahead).norm() < 1e-3 * ahead.norm(), "{ahead}");
    }

    #[test]
    fn the_noise_of_two_halves_is_that_of_the_whole() {
        let (angles, _) = angles();
        let carried = |steps: std::ops::RangeInclusive<usize>| {
            let mut other = angles.clone();
            steps.for_each(|k| other.advance(&voyage().motion(k)));
            other.propagate()
        };
        let (first, second, whole) = (carried(1..=50), carried(51..=100), carried(1..=100));
        let joined = second.transition * first.noise * second.transition.transpose() + second.noise;
        assert!((joined - whole.noise).norm() < 1e-9 * whole.noise.norm());
    }
}
