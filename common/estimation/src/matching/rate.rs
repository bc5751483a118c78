//! Angular rate matching.
//!
//! Source: paper 004 eqs 5-19, in the axes that the registered installation `R0` gives the sub unit: `w_s' = R0 w_s`, `C_s^m = Exp(phi0 + phi) R0`.
//!
//! | state | size | moves by |
//! |---|---|---|
//! | static part phi0, rad | 3 | random walk of the configured density |
//! | flexure phi, rad, its rate, rad/s | 3 + 3 | second-order Gauss-Markov, exact |
//! | relative gyro bias, sub minus main, rad/s | 3 | constant |
//!
//! Corrections: eq 19 lacks the identity at the rate of the flexure; with the mean of both units' rates instead of the sub unit's the measurement
//! is exact to second order. The mean rate over the interval stands for the rate at its end.

use super::grade::Grade;
use super::{Matching, Model, Motion, Observation, Prediction, Start, Turn, View, three};
use crate::flexure::Flexure;
use frames::{Main, Rot, Sub};
use nalgebra::{Matrix3, SMatrix, SVector, Vector3};
use serde::{Deserialize, Serialize};

/// Size of the error state.
pub const STATES: usize = 12;
const STATIC: usize = 0;
const FLEXURE: usize = 3;
const RATE: usize = 6;
const BIAS: usize = 9;
const TURN: Turn = Turn { fixed: STATIC, flexure: FLEXURE, rate: RATE };

/// Which use of rate matching.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub struct Options {
    /// Density of the random walk of the static part, rad^2/s.
    pub static_walk: f64,
}

/// The nominal state.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct RateMatching {
    options: Options,
    grade: Grade,
    flexure: [Flexure; 3],
    rotation: Rot<Main, Sub>,
    x: SVector<f64, STATES>,
    pending_s: f64,
    interval_s: f64,
    w_m: Vector3<f64>,
    /// The sub unit's rate in the axes that the registration gives it.
    w_s: Vector3<f64>,
}

impl RateMatching {
    /// How the measurement depends on the state.
    fn matrix(&self) -> SMatrix<f64, 3, STATES> {
        let turn = ((self.w_m + self.w_s) * 0.5).cross_matrix();
        let mut matrix = SMatrix::<f64, 3, STATES>::zeros();
        matrix.fixed_view_mut::<3, 3>(0, STATIC).copy_from(&turn);
        matrix.fixed_view_mut::<3, 3>(0, FLEXURE).copy_from(&turn);
        matrix.fixed_view_mut::<3, 3>(0, RATE).fill_with_identity();
        matrix.fixed_view_mut::<3, 3>(0, BIAS).fill_with_identity();
        matrix
    }
}

impl Matching<STATES, 3> for RateMatching {
    fn propagate(&mut self) -> Prediction<STATES> {
        let h = std::mem::take(&mut self.pending_s);
        let mut transition = SMatrix::<f64, STATES, STATES>::identity();
        let mut noise = SMatrix::<f64, STATES, STATES>::zeros();
        for axis in 0..3 {
            noise[(STATIC + axis, STATIC + axis)] = self.options.static_walk * h;
            self.flexure[axis].place(h, FLEXURE + axis, RATE + axis, &mut transition, &mut noise);
        }
        self.x = transition * self.x;
        Prediction { transition, noise }
    }

    // 004 eq 10
    fn observe(&self) -> Observation<STATES, 3> {
        let matrix = self.matrix();
        // what the mean of the flexure's rate over the interval differs from its value at the end
        let end = |axis: usize| self.flexure[axis].density() * self.interval_s / 3.0;
        let variance = Vector3::from_fn(|axis, _| self.grade.arw_density() / self.interval_s + end(axis));
        Observation {
            residual: self.w_s - self.w_m - matrix * self.x,
            matrix,
            noise: Matrix3::from_diagonal(&variance),
        }
    }

    fn inject(&mut self, error: &SVector<f64, STATES>) {
        self.x += error;
    }
}

impl Model<STATES, 3> for RateMatching {
    type Options = Options;

    fn begin(options: &Options, start: &Start) -> (Self, SMatrix<f64, STATES, STATES>) {
        let mut p = SMatrix::<f64, STATES, STATES>::zeros();
        p.fixed_view_mut::<3, 3>(STATIC, STATIC).copy_from(&start.covariance);
        for axis in 0..3 {
            start.flexure[axis].place_stationary(FLEXURE + axis, RATE + axis, &mut p);
            p[(BIAS + axis, BIAS + axis)] = start.grade.bias_variance();
        }
        let model = Self {
            options: *options,
            grade: start.grade,
            flexure: start.flexure,
            rotation: start.rotation,
            x: SVector::zeros(),
            pending_s: 0.0,
            interval_s: 0.0,
            w_m: Vector3::zeros(),
            w_s: Vector3::zeros(),
        };
        (model, p)
    }

    fn advance(&mut self, motion: &Motion) {
        self.pending_s += motion.interval_s;
        self.interval_s = motion.interval_s.max(f64::MIN_POSITIVE);
        self.w_m = motion.dtheta_m.column() / self.interval_s;
        self.w_s = (self.rotation * motion.dtheta_s).column() / self.interval_s;
    }

    fn set_flexure(&mut self, flexure: [Flexure; 3]) {
        self.flexure = flexure;
    }

    fn view(&self) -> View<STATES> {
        View::of_small_turn(self.rotation, &self.x, TURN, -three(&self.x, BIAS))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::matching::conformance::{Voyage, matrix_is_the_derivative};
    use frames::Vec3;
    use frames::unit::ARCSEC;

    const VOYAGE: Voyage =
        Voyage { installation: Rot::identity(), flexure: 20.0 * ARCSEC, delay_s: 0.0, lever_arm: Vec3::ZERO };

    fn at_truth(installation: Vec3<Main>, k: usize) -> RateMatching {
        bent(installation, VOYAGE.flexure, k)
    }

    fn bent(installation: Vec3<Main>, flexure: f64, k: usize) -> RateMatching {
        let voyage = Voyage { installation: Rot::exp(installation), flexure, ..VOYAGE };
        let start = Start {
            grade: Grade::default(),
            accel: Default::default(),
            lever_arm: Vec3::ZERO,
            flexure: [Flexure { mu: 0.1, b: 1.0, sigma: 20.0 * ARCSEC }; 3],
            rotation: Rot::identity(),
            covariance: Matrix3::identity() * 1e-8,
        };
        let (mut model, _) = RateMatching::begin(&Options::default(), &start);
        model.advance(&voyage.motion(k));
        let middle = (k as f64 - 0.5) * crate::matching::conformance::STEP_S;
        let (theta, rate) = voyage.theta(middle);
        model.x.fixed_rows_mut::<3>(STATIC).copy_from(&installation.column());
        model.x.fixed_rows_mut::<3>(FLEXURE).copy_from(&theta.column());
        model.x.fixed_rows_mut::<3>(RATE).copy_from(&rate.column());
        model
    }

    #[test]
    fn the_residual_vanishes_at_the_truth_to_second_order() {
        let installation = Vec3::new(60.0, -40.0, 80.0) * ARCSEC;
        for k in [1, 137, 522] {
            let size = at_truth(installation, k).observe().residual.norm();
            let double = at_truth(installation * 2.0, k).observe().residual.norm();
            let plain = (at_truth(installation, k).w_s - at_truth(installation, k).w_m).norm();
            assert!(size < 2e-3 * plain && double < 6.0 * size.max(1e-11), "{size:e} {double:e} {plain:e}");
        }
    }

    #[test]
    fn the_sub_units_rate_alone_leaves_more() {
        // the printed form, with w_s in place of the mean
        let model = bent(Vec3::new(600.0, -400.0, 800.0) * ARCSEC, 0.0, 137);
        let printed = Matching::<STATES, 3>::observe(&RateMatching { w_m: model.w_s, ..model.clone() }).matrix;
        let residual = model.w_s - model.w_m;
        assert!((residual - printed * model.x).norm() > 10.0 * model.observe().residual.norm());
    }

    #[test]
    fn without_the_rate_of_the_flexure_the_residual_is_of_its_size() {
        // 004 eq 19 as printed has nothing in the place of the rate
        let mut model = at_truth(Vec3::new(60.0, -40.0, 80.0) * ARCSEC, 137);
        let rate = three(&model.x, RATE).norm();
        model.x.fixed_rows_mut::<3>(RATE).fill(0.0);
        assert!(model.observe().residual.norm() > 0.9 * rate);
    }

    #[test]
    fn the_measurement_matrix_is_the_derivative() {
        matrix_is_the_derivative(&at_truth(Vec3::new(1e-4, 2e-4, -1e-4), 137), &SVector::repeat(1e-6), 1e-9);
    }
}
