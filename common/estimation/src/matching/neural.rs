//! A matching by angles with a neural network beside it, whose weights are states too.
//!
//! Source: paper 001 eqs 24-34, over eq 23 (Q-NNKF) and over eq 37 (NNKF). State: the 18 of [`super::angles`], then the 38 weights of
//! [`super::network`], which walk at random (eq 32). The network's input is the measurement itself (eq 34).
//!
//! | form | measurement | deformation |
//! |---|---|---|
//! | [`Form::Literal`] | `Z = eta-part + g(Z)` as printed: static part and flexure measure nothing | `g` |
//! | [`Form::Additive`] | the model's own, plus `g(Z)` | the model's, plus `g` |
//!
//! Corrections: none that help. In the printed form `g = Z - c, eta = c` leaves no residual whatever `c` is, so nothing tells deformation from
//! gyro drift; only the model of a static part that is slow in the deck's axes, and a drift that is slow in inertial space, can, and eq 34
//! takes that model out. Beside the full model the network is one more name for the same two things. After a registration there is no
//! nonlinearity left to learn (under 0.3 arcsec). Both forms are here to be measured. Scales, first weights, their doubt and their walk are
//! ours: the paper publishes none of them. With a doubt of 0.01 its table 5 comes out; the more the network may do, the worse it gets.

use super::angle_model::AngleModel;
use super::angles::{self, Angles, Rows};
use super::network::{Network, WEIGHTS};
use super::{Matching, Model, Motion, Observation, Prediction, Start, View};
use crate::flexure::Flexure;
use frames::{Main, Rot, Sub, unit};
use nalgebra::{Matrix3, SMatrix, SVector, Vector3};
use serde::{Deserialize, Serialize};

/// Size of the error state.
pub const STATES: usize = angles::STATES + WEIGHTS;
type Wide = SMatrix<f64, STATES, STATES>;

/// Standard deviation of the first weights of the hidden layer.
const HIDDEN_SIGMA: f64 = 0.3;
/// Random walk of a weight in the square root of a second, by its first doubt.
const WALK: f64 = 1e-4;
/// The least scale of inputs and outputs, rad.
const LEAST_SCALE: f64 = 100.0 * unit::ARCSEC;

/// A linear matching by angles that a network can stand beside.
pub trait AngleMatching: AngleModel {
    /// What is measured, rad.
    fn measured(&self) -> Vector3<f64>;
    /// How the measurement depends on the deformation.
    fn by_deformation(&self) -> Matrix3<f64>;
    /// The total of a deformation vector.
    fn total(&self, phi: Vector3<f64>) -> Rot<Main, Sub>;
}

/// How the network enters the measurement.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Form {
    /// In place of the deformation, as printed.
    Literal,
    /// Beside it.
    #[default]
    Additive,
}

/// Which network.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub struct Options {
    /// How it enters the measurement.
    pub form: Form,
    /// Draws its first weights.
    pub seed: u64,
    /// The doubt of all weights, and the size of the output layer's first ones, one standard deviation: how much the network may do.
    pub sigma: f64,
}

/// The nominal state.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Neural<M> {
    inner: M,
    form: Form,
    network: Network,
    /// Inputs and outputs of the network are in this unit, rad.
    scale: f64,
    /// Variance that a weight's walk adds in a second.
    walk: f64,
    pending_s: f64,
}

impl<M: AngleMatching> Neural<M> {
    fn input(&self) -> Vector3<f64> {
        self.inner.measured() / self.scale
    }

    /// What the network says of the measurement, rad.
    fn said(&self) -> Vector3<f64> {
        self.network.output(&self.input()) * self.scale
    }

    /// How the measurement depends on the 18 states.
    fn own(&self) -> Rows {
        let mut own = self.inner.matrix();
        if self.form == Form::Literal {
            own.fixed_view_mut::<3, 3>(0, angles::STATIC).fill(0.0);
            own.fixed_view_mut::<3, 3>(0, angles::FLEXURE).fill(0.0);
        }
        own
    }

    fn widen(rows: &Rows) -> SMatrix<f64, 3, STATES> {
        let mut wide = SMatrix::<f64, 3, STATES>::zeros();
        wide.fixed_view_mut::<3, { angles::STATES }>(0, 0).copy_from(rows);
        wide
    }
}

impl<M: AngleMatching> Matching<STATES, 3> for Neural<M> {
    fn propagate(&mut self) -> Prediction<STATES> {
        let inner = self.inner.propagate();
        let h = std::mem::take(&mut self.pending_s);
        let mut transition = Wide::identity();
        let mut noise = Wide::zeros();
        transition.fixed_view_mut::<{ angles::STATES }, { angles::STATES }>(0, 0).copy_from(&inner.transition);
        noise.fixed_view_mut::<{ angles::STATES }, { angles::STATES }>(0, 0).copy_from(&inner.noise);
        for weight in angles::STATES..STATES {
            noise[(weight, weight)] = self.walk * h; // 001 eq 32
        }
        Prediction { transition, noise }
    }

    // 001 eq 34
    fn observe(&self) -> Observation<STATES, 3> {
        let own = self.own();
        let mut matrix = Self::widen(&own);
        let by_weights = self.network.by_weights(&self.input()) * self.scale;
        matrix.fixed_view_mut::<3, WEIGHTS>(0, angles::STATES).copy_from(&by_weights);
        Observation {
            residual: self.inner.measured() - own * self.inner.angles().x - self.said(),
            matrix,
            noise: Angles::measurement_noise(),
        }
    }

    fn inject(&mut self, error: &SVector<f64, STATES>) {
        self.inner.inject(&error.fixed_rows::<{ angles::STATES }>(0).into());
        self.network.weights += error.fixed_rows::<WEIGHTS>(angles::STATES);
    }
}

impl<M: AngleMatching> Model<STATES, 3> for Neural<M> {
    type Options = Options;

    fn begin(options: &Options, start: &Start) -> (Self, Wide) {
        let (inner, own) = M::begin(&(), start);
        let mut p = Wide::zeros();
        p.fixed_view_mut::<{ angles::STATES }, { angles::STATES }>(0, 0).copy_from(&own);
        for weight in angles::STATES..STATES {
            p[(weight, weight)] = options.sigma * options.sigma;
        }
        let network = Network::random(options.seed, HIDDEN_SIGMA, options.sigma);
        let scale = (start.covariance.trace() / 3.0).sqrt().max(LEAST_SCALE);
        let walk = (WALK * options.sigma).powi(2);
        (Self { inner, form: options.form, network, scale, walk, pending_s: 0.0 }, p)
    }

    fn advance(&mut self, motion: &Motion) {
        self.pending_s += motion.interval_s;
        self.inner.advance(motion);
    }

    fn set_flexure(&mut self, flexure: [Flexure; 3]) {
        self.inner.set_flexure(flexure);
    }

    fn view(&self) -> View<STATES> {
        let View { rows, noise, static_part, static_rows, rate, rate_rows, drift, delay, skew, .. } = self.inner.view();
        let back = self.inner.by_deformation().transpose();
        let said = back * self.said();
        let (phi, rows) = match self.form {
            Form::Literal => (said, Rows::zeros()),
            Form::Additive => (Angles::phi_rows() * self.inner.angles().now() + said, rows),
        };
        let mut wide = Self::widen(&rows);
        let by_weights = back * self.network.by_weights(&self.input()) * self.scale;
        wide.fixed_view_mut::<3, WEIGHTS>(0, angles::STATES).copy_from(&by_weights);
        View {
            deformation: self.inner.total(phi),
            rows: wide,
            noise,
            static_part,
            static_rows: Self::widen(&static_rows),
            rate,
            rate_rows: Self::widen(&rate_rows),
            drift,
            delay,
            skew,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::matching::conformance::{Voyage, matrix_is_the_derivative, start};
    use crate::matching::residual_attitude::ResidualAttitude;
    use crate::matching::small_angle::SmallAngle;
    use frames::Vec3;
    use frames::unit::ARCSEC;

    fn at<M: AngleMatching>(form: Form, seed: u64) -> Neural<M> {
        let installation = Rot::exp(Vec3::new(80.0, -60.0, 90.0) * ARCSEC);
        let voyage = Voyage { installation, flexure: 10.0 * ARCSEC, delay_s: 0.0, lever_arm: Vec3::ZERO };
        let (mut model, _) = Neural::<M>::begin(&Options { form, seed, sigma: 0.3 }, &start(Rot::identity()));
        (1..=137).for_each(|k| model.advance(&voyage.motion(k)));
        model.propagate();
        model
    }

    /// Steps that move the measurement by about as much each: the weights' unit is not the radian.
    fn steps() -> SVector<f64, STATES> {
        SVector::from_fn(|i, _| if i < angles::STATES { 1e-6 } else { 1e-4 })
    }

    #[test]
    fn the_measurement_matrix_is_the_derivative() {
        for seed in 1..4 {
            for form in [Form::Literal, Form::Additive] {
                matrix_is_the_derivative(&at::<ResidualAttitude>(form, seed), &steps(), 1e-6);
                matrix_is_the_derivative(&at::<SmallAngle>(form, seed), &steps(), 1e-6);
            }
        }
    }

    #[test]
    fn the_networks_rows_are_the_derivative_of_the_total() {
        let model = at::<ResidualAttitude>(Form::Additive, 1);
        let view = model.view();
        for i in [angles::STATIC, angles::FLEXURE + 1, angles::STATES, angles::STATES + 17, STATES - 1] {
            let mut error = SVector::<f64, STATES>::zeros();
            error[i] = steps()[i];
            let moved = |error: SVector<f64, STATES>| {
                let mut other = model.clone();
                other.inject(&error);
                other.view().deformation
            };
            let numeric = (moved(error) * moved(-error).inverse()).log().column() / (2.0 * steps()[i]);
            assert!((numeric - view.rows.column(i)).norm() < 1e-3 * (1e-9 + numeric.norm()), "state {i}");
        }
    }

    #[test]
    fn as_printed_any_split_of_drift_and_deformation_leaves_the_same_residual() {
        let model = at::<ResidualAttitude>(Form::Literal, 2);
        let shift = Vector3::new(50.0, -30.0, 70.0) * ARCSEC;
        let mut error = SVector::<f64, STATES>::zeros();
        error.fixed_rows_mut::<3>(angles::CONSTANT).copy_from(&shift);
        error.fixed_rows_mut::<3>(STATES - 3).copy_from(&(-shift / model.scale));
        let mut other = model.clone();
        other.inject(&error);
        assert!((other.observe().residual - model.observe().residual).norm() < 1e-15);
        assert!((other.observe().matrix - model.observe().matrix).norm() < 1e-12, "nor does it show later");
        let apart = (other.view().deformation * model.view().deformation.inverse()).angle();
        assert!((apart - shift.norm()).abs() < 1e-6 * shift.norm());
    }
}
