//! Attitude matching with the time delay as a state.
//!
//! Source: paper 002 eqs 7-21 in the product form of its reworking. The units' accumulated attitudes obey `A_m D = N A_s` when they are of
//! one moment; the sub unit's stamps are late by `tau`, of which the attitudes' re-timing (`retiming`) takes out the known part and a state
//! the rest: `D = Exp(w tau) A_m^T N A_s`, `D = C_s^m = Exp(theta) S`.
//!
//! | state | size | error | moves by |
//! |---|---|---|---|
//! | static part S | 3 | `S_true = Exp(s) S`, in m | its rate, and a random walk |
//! | rate of S | 3 | additive, rad/s | white noise |
//! | flexure theta, its rate | 3 + 3 | additive, rad, rad/s | second-order Gauss-Markov, exact |
//! | constant N | 3 | `N_true = Exp(-psi) N`, in the main unit's starting axes | relative gyro errors |
//! | relative gyro bias | 3 | additive, rad/s, in m | constant |
//! | rest of the delay | 1 | additive, s | the skew |
//! | skew | 1 | additive | constant |
//!
//! Static part and flexure are those of the moment that the sub unit felt, `t - tau`. What is published at `t` is the attitudes' deformation
//! of that moment carried on over `tau` by the models of static part and flexure: gyros cannot carry it, for the sub unit's of that time
//! have not come. Whenever the rest of the delay exceeds 1 ms it goes into the re-timing, for the neglected `w' tau^2 / 2` is 0.006 arcsec
//! then; not re-timed, it is 0.6 arcsec at 10 ms and 232 at 200 ms.
//!
//! One model serves many uses: without random walk, rate noise and delay it is the paper's Method A; with a random walk and no flexure it
//! is free of any model of the deformation; without delay alone it leaves a delay in the data as it is.
//!
//! Corrections to the paper: its 21 to 27 states collapse to these, for the units' single errors and the first misalignment cannot be told
//! apart; the constant must not be tied to the first deformation alone, for the delay shifts the frames' start too; the elements (1,2), (3,1),
//! (3,2) of the matching matrix give way to the rotation vector. Static part and flexure share one Jacobian, see `so3`.

use super::chain::{self, Chain, Link};
use super::grade::MATCHING_SIGMA;
use super::retiming::Together;
use super::{Matching, Model, Motion, Observation, Prediction, Start, View};
use crate::align::Lag;
use crate::flexure::Flexure;
use frames::{Main, Rot, Sub, Vec3};
use nalgebra::{Matrix3, SMatrix, SVector, Vector3};
use serde::{Deserialize, Serialize};

/// Size of the error state.
pub const STATES: usize = 20;
const STATIC: usize = 0;
const STATIC_RATE: usize = 3;
const FLEXURE: usize = 6;
const FLEXURE_RATE: usize = 9;
const CONSTANT: usize = 12;
const BIAS: usize = CONSTANT + chain::BIAS;
const DELAY: usize = CONSTANT + chain::DELAY;
const SKEW: usize = 19;

/// Which use of the model.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Options {
    /// Density of the random walk of the static part, rad^2/s.
    pub static_walk: f64,
    /// Whether there is no flexure but in the static part.
    pub rigid: bool,
    /// What is known of the delay.
    pub delay: DelayOptions,
}

/// What is known of the delay before the filter starts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct DelayOptions {
    /// Standard deviation of the delay, s; 0 if there is none.
    pub sigma: f64,
    /// Standard deviation of the skew; 0 if there is none.
    pub skew_sigma: f64,
    /// Whether the attitudes are re-timed by the delay as it is known.
    pub retimed: bool,
}

/// The nominal state.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
struct State {
    static_part: Rot<Main, Sub>,
    static_rate: Vec3<Main>,
    theta: Vector3<f64>,
    theta_rate: Vector3<f64>,
    link: Link,
    skew: f64,
}

impl State {
    fn moved(mut self, error: &SVector<f64, STATES>) -> Self {
        let three = |place: usize| Vec3::<Main>::from_column(error.fixed_rows::<3>(place).into());
        self.static_part = Rot::<Main, Main>::exp(three(STATIC)) * self.static_part;
        self.static_rate += three(STATIC_RATE);
        self.theta += error.fixed_rows::<3>(FLEXURE);
        self.theta_rate += error.fixed_rows::<3>(FLEXURE_RATE);
        self.link = self.link.moved(error, CONSTANT);
        self.skew += error[SKEW];
        self
    }

    /// The deformation by the models.
    fn predicted(&self) -> Rot<Main, Sub> {
        Rot::<Main, Main>::exp(Vec3::from_column(self.theta)) * self.static_part
    }

    // 002 eq 16
    fn residual(&self, together: &Together) -> Vector3<f64> {
        (self.link.seen(together, self.link.delay) * self.predicted().inverse()).log().column()
    }
}

/// The model.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Quaternion {
    options: Options,
    flexure: [Flexure; 3],
    state: State,
    chain: Chain,
}

impl Quaternion {
    /// Turn of the flexure from the moment of the state, over `time_s`, by its model, and how it depends on angle and rate.
    fn ahead(&self, axis: usize, from_s: f64, time_s: f64) -> (f64, [f64; 2]) {
        let (near, far) = (self.flexure[axis].transition(from_s), self.flexure[axis].transition(from_s + time_s));
        let row = [far[(0, 0)] - near[(0, 0)], far[(0, 1)] - near[(0, 1)]];
        (row[0] * self.state.theta[axis] + row[1] * self.state.theta_rate[axis], row)
    }

    /// By how much the sub unit's data are older than their stamps, s.
    fn delay(&self) -> f64 {
        self.chain.delay(&self.state.link) + self.state.skew * self.chain.since.time_s
    }

    /// The constant by the deformation as it is believed to be.
    fn begin_constant(&mut self, together: &Together, prediction: &mut Prediction<STATES>) {
        let minus_a = -together.a_m.matrix();
        let mut made_of = SMatrix::<f64, STATES, STATES>::identity();
        made_of.fixed_view_mut::<3, 3>(CONSTANT, STATIC).copy_from(&minus_a);
        made_of.fixed_view_mut::<3, 3>(CONSTANT, FLEXURE).copy_from(&minus_a);
        let deformation = self.state.predicted();
        self.chain.set(&mut self.state.link, together, deformation, made_of, prediction);
    }

    /// Turn of the deformation from the moment that the sub unit felt to now, written into its rows and noise.
    fn carry(&self, rows: &mut SMatrix<f64, 3, STATES>, noise: &mut Matrix3<f64>) -> Vec3<Main> {
        let late_s = self.delay().max(0.0);
        let mut turn = self.state.static_rate.column() * late_s;
        if late_s == 0.0 {
            return Vec3::ZERO;
        }
        for axis in 0..3 {
            rows[(axis, STATIC_RATE + axis)] -= late_s;
            if !self.options.rigid {
                let (ahead, by) = self.ahead(axis, self.chain.since.time_s, late_s);
                turn[axis] += ahead;
                rows[(axis, FLEXURE + axis)] -= by[0];
                rows[(axis, FLEXURE_RATE + axis)] -= by[1];
                noise[(axis, axis)] += self.flexure[axis].noise(late_s)[(0, 0)];
            }
            rows[(axis, DELAY)] -= self.state.theta_rate[axis];
        }
        Vec3::from_column(turn)
    }
}

impl Matching<STATES, 3> for Quaternion {
    fn propagate(&mut self) -> Prediction<STATES> {
        let since = std::mem::take(&mut self.chain.since);
        let h = since.time_s;
        let mut transition = SMatrix::<f64, STATES, STATES>::identity();
        let mut noise = SMatrix::<f64, STATES, STATES>::zeros();
        let state = &mut self.state;
        state.static_part = (Rot::<Main, Main>::exp(state.static_rate * h) * state.static_part).normalised();
        for axis in 0..3 {
            let s = STATIC + axis;
            self.chain.grade.place_static(h, s, STATIC_RATE + axis, &mut transition, &mut noise);
            noise[(s, s)] += self.options.static_walk * h;
            if self.options.rigid {
                continue;
            }
            let (x, v) = (FLEXURE + axis, FLEXURE_RATE + axis);
            self.flexure[axis].place(h, x, v, &mut transition, &mut noise);
            let (theta, rate) = (state.theta[axis], state.theta_rate[axis]);
            state.theta[axis] = transition[(x, x)] * theta + transition[(x, v)] * rate;
            state.theta_rate[axis] = transition[(v, x)] * theta + transition[(v, v)] * rate;
        }
        state.link.delay += state.skew * h;
        transition[(DELAY, SKEW)] = h;
        since.place(CONSTANT, BIAS, &mut transition, &mut noise);
        let mut prediction = Prediction { transition, noise };
        if let Some(together) = self.chain.first() {
            self.begin_constant(&together, &mut prediction);
        }
        prediction
    }

    fn observe(&self) -> Observation<STATES, 3> {
        let mut matrix = SMatrix::<f64, 3, STATES>::zeros();
        let mut residual = Vector3::zeros();
        // without attitudes of one moment there is nothing to compare
        if let Some(together) = self.chain.together() {
            residual = self.state.residual(&together);
            matrix.fixed_view_mut::<3, 3>(0, STATIC).fill_with_identity();
            matrix.fixed_view_mut::<3, 3>(0, FLEXURE).fill_with_identity();
            self.chain.observe(&together, &mut matrix);
        }
        Observation { residual, matrix, noise: Matrix3::identity() * MATCHING_SIGMA.powi(2) }
    }

    fn inject(&mut self, error: &SVector<f64, STATES>) {
        self.state = self.state.moved(error);
        self.chain.attitudes.absorb(&mut self.state.link.delay);
    }

    fn residual_after(&self, error: &SVector<f64, STATES>) -> Vector3<f64> {
        let together = self.chain.together();
        together.map_or(Vector3::zeros(), |together| self.state.moved(error).residual(&together))
    }
}

impl Model<STATES, 3> for Quaternion {
    type Options = Options;

    fn begin(options: &Options, start: &Start) -> (Self, SMatrix<f64, STATES, STATES>) {
        let mut p = SMatrix::<f64, STATES, STATES>::zeros();
        p.fixed_view_mut::<3, 3>(STATIC, STATIC).copy_from(&start.covariance);
        for axis in 0..3 {
            p[(STATIC_RATE + axis, STATIC_RATE + axis)] = start.grade.static_rate_variance();
            if !options.rigid {
                start.flexure[axis].place_stationary(FLEXURE + axis, FLEXURE_RATE + axis, &mut p);
            }
        }
        let (chain, link) = Chain::begin(CONSTANT, &options.delay, start.grade, &mut p);
        p[(SKEW, SKEW)] = options.delay.skew_sigma.powi(2);
        let state = State {
            static_part: start.rotation,
            static_rate: Vec3::ZERO,
            theta: Vector3::zeros(),
            theta_rate: Vector3::zeros(),
            link,
            skew: 0.0,
        };
        (Self { options: *options, flexure: start.flexure, state, chain }, p)
    }

    fn delayed(&mut self, lag: &Lag, p: &mut SMatrix<f64, STATES, STATES>) {
        self.chain.delayed(&mut self.state.link, lag, p);
    }

    fn advance(&mut self, motion: &Motion) {
        self.chain.advance(&mut self.state.link, motion);
    }

    fn set_flexure(&mut self, flexure: [Flexure; 3]) {
        self.flexure = flexure;
    }

    fn view(&self) -> View<STATES> {
        let mut static_rows = SMatrix::<f64, 3, STATES>::zeros();
        static_rows.fixed_view_mut::<3, 3>(0, STATIC).fill_diagonal(-1.0);
        let mut rate_rows = SMatrix::<f64, 3, STATES>::zeros();
        rate_rows.fixed_view_mut::<3, 3>(0, FLEXURE_RATE).fill_diagonal(-1.0);
        let mut rows = SMatrix::<f64, 3, STATES>::zeros();
        let mut noise = Matrix3::zeros();
        let seen = match self.chain.together() {
            Some(together) => {
                self.chain.view(&together, &mut rows, &mut noise);
                rows.set_column(SKEW, &(-together.w_m.column() * self.chain.since.time_s));
                self.state.link.seen(&together, self.delay() - self.chain.attitudes.shift())
            }
            None => {
                rows.copy_from(&static_rows);
                rows.fixed_view_mut::<3, 3>(0, FLEXURE).fill_diagonal(-1.0);
                self.state.predicted()
            }
        };
        let turn = self.carry(&mut rows, &mut noise);
        View {
            deformation: Rot::<Main, Main>::exp(turn) * seen,
            rows,
            noise,
            static_part: self.state.static_part,
            static_rows,
            rate: Vec3::from_column(self.state.theta_rate) + self.state.static_rate,
            rate_rows,
            drift: self.state.link.bias,
            delay: self.chain.told(self.delay()),
            skew: (self.options.delay.skew_sigma > 0.0).then_some((self.state.skew, SKEW)),
        }
    }
}

#[cfg(test)]
mod tests;
