//! Attitude matching with a network in the place of every model of the deformation: Method B.
//!
//! Source: paper 002 eqs 17-26, with the network of paper 001 (`network`): `Z = g(input; W) - w tau + A_m^T psi`, `Z` the rotation vector of
//! `A_m^T A_s` in the axes of the installation. In products, as in `quaternion`: `D = Exp(w tau) A_m^T N A_s`, `D = Exp(g) R0`.
//!
//! | state | size | error | moves by |
//! |---|---|---|---|
//! | weights of the network | 38 | additive, output in units of 100 arcsec | random walks, one of their own for the offsets of the output |
//! | constant N | 3 | `N_true = Exp(-psi) N`, in the main unit's starting axes | relative gyro errors |
//! | relative gyro bias | 3 | additive, rad/s, in m | constant |
//! | rest of the delay | 1 | additive, s | constant |
//!
//! The paper hides what the network gets to see; paper 001 eq 34, by the same authors, shows that it is the measurement. With that
//! input `g = Z`, `psi = 0` explains everything, and where the weights can learn it the estimate is the raw difference of the attitudes,
//! whatever the covariance says: the measurement is used twice. With the time as input, or the last estimate, the offsets of the output do the work
//! and the method is a random walk of the deformation.
//!
//! Published is the deformation by the attitudes and `N`, which the network's output equals at every update.
//!
//! Corrections to the paper: those of `quaternion`.

use super::chain::{self, Chain, Link};
use super::grade::MATCHING_SIGMA;
use super::network::{Network, OFFSET, WEIGHTS};
use super::quaternion::DelayOptions;
use super::retiming::Together;
use super::{Matching, Model, Motion, Observation, Prediction, Start, View};
use crate::align::Lag;
use crate::flexure::Flexure;
use frames::{Main, Rot, Sub, Vec3, unit};
use nalgebra::{Matrix3, SMatrix, SVector, Vector3};
use serde::{Deserialize, Serialize};

/// Size of the error state.
pub const STATES: usize = WEIGHTS + 7;
const CONSTANT: usize = WEIGHTS;
const BIAS: usize = CONSTANT + chain::BIAS;

/// One unit of the network's input and output, rad.
const SCALE: f64 = 100.0 * unit::ARCSEC;
/// One unit of the network's input when that is the time, s.
const TIME_SCALE_S: f64 = 3600.0;
/// Standard deviation of a weight before anything is learnt.
const WEIGHT_SIGMA: f64 = 0.3;
/// The same of an offset of the output.
const OFFSET_SIGMA: f64 = 10.0;
/// Spread of the first weights of the hidden and of the output layer.
const FIRST_WEIGHTS: [f64; 2] = [0.5, 0.1];

/// What the network gets to see.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Input {
    /// The measurement.
    #[default]
    Measurement,
    /// The time.
    Time,
    /// Its last output.
    Previous,
}

/// Which use of the model.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Options {
    /// What the network gets to see.
    pub input: Input,
    /// Random walk of a weight, 1/sqrt(s).
    pub weight_walk: f64,
    /// Random walk of an offset of the output, rad/sqrt(s).
    pub offset_walk: f64,
    /// Of the first weights.
    pub seed: u64,
    /// What is known of the delay; the skew has no state here.
    pub delay: DelayOptions,
}

/// The nominal state.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct State {
    network: Network,
    link: Link,
}

/// The model.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct QuaternionNetwork {
    options: Options,
    installation: Rot<Main, Sub>,
    state: State,
    chain: Chain,
    time_s: f64,
    previous: Vector3<f64>,
}

impl QuaternionNetwork {
    fn input(&self, together: &Together) -> Vector3<f64> {
        match self.options.input {
            Input::Measurement => {
                let matched = together.a_m.inverse().relabel::<Main, Main>()
                    * self.installation
                    * together.a_s.relabel::<Sub, Sub>()
                    * self.installation.inverse();
                matched.log().column() / SCALE
            }
            Input::Time => Vector3::new(self.time_s / TIME_SCALE_S, 0.0, 0.0),
            Input::Previous => self.previous,
        }
    }

    fn deformation(&self, output: Vector3<f64>) -> Rot<Main, Sub> {
        Rot::<Main, Main>::exp(Vec3::from_column(output * SCALE)) * self.installation
    }

    // 002 eq 17
    fn residual(&self, state: &State, together: &Together) -> Vector3<f64> {
        let output = state.network.output(&self.input(together));
        (state.link.seen(together, state.link.delay) * self.deformation(output).inverse()).log().column()
    }

    fn moved(&self, error: &SVector<f64, STATES>) -> State {
        let mut state = self.state.clone();
        state.network.weights += error.fixed_rows::<WEIGHTS>(0);
        state.link = state.link.moved(error, CONSTANT);
        state
    }

    /// The constant by the network's output.
    fn begin_constant(&mut self, together: &Together, prediction: &mut Prediction<STATES>) {
        let input = self.input(together);
        let deformation = self.deformation(self.state.network.output(&input));
        let by_weights = self.state.network.by_weights(&input);
        let mut made_of = SMatrix::<f64, STATES, STATES>::identity();
        made_of.fixed_view_mut::<3, WEIGHTS>(CONSTANT, 0).copy_from(&(-together.a_m.matrix() * by_weights * SCALE));
        self.chain.set(&mut self.state.link, together, deformation, made_of, prediction);
    }
}

impl Matching<STATES, 3> for QuaternionNetwork {
    fn propagate(&mut self) -> Prediction<STATES> {
        let since = std::mem::take(&mut self.chain.since);
        let h = since.time_s;
        let mut transition = SMatrix::<f64, STATES, STATES>::identity();
        let mut noise = SMatrix::<f64, STATES, STATES>::zeros();
        for i in 0..WEIGHTS {
            let step = if i < OFFSET { self.options.weight_walk } else { self.options.offset_walk / SCALE };
            noise[(i, i)] = step * step * h;
        }
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
        if let Some(together) = self.chain.together() {
            residual = self.residual(&self.state, &together);
            let by_weights = self.state.network.by_weights(&self.input(&together));
            matrix.fixed_view_mut::<3, WEIGHTS>(0, 0).copy_from(&(by_weights * SCALE));
            self.chain.observe(&together, &mut matrix);
        }
        Observation { residual, matrix, noise: Matrix3::identity() * MATCHING_SIGMA.powi(2) }
    }

    fn inject(&mut self, error: &SVector<f64, STATES>) {
        self.state = self.moved(error);
        if let Some(together) = self.chain.together() {
            self.previous = self.state.network.output(&self.input(&together));
        }
        self.chain.attitudes.absorb(&mut self.state.link.delay);
    }

    fn residual_after(&self, error: &SVector<f64, STATES>) -> Vector3<f64> {
        self.chain.together().map_or(Vector3::zeros(), |together| self.residual(&self.moved(error), &together))
    }
}

impl Model<STATES, 3> for QuaternionNetwork {
    type Options = Options;

    fn begin(options: &Options, start: &Start) -> (Self, SMatrix<f64, STATES, STATES>) {
        let mut p = SMatrix::<f64, STATES, STATES>::zeros();
        for i in 0..WEIGHTS {
            p[(i, i)] = if i < OFFSET { WEIGHT_SIGMA } else { OFFSET_SIGMA }.powi(2);
        }
        let (chain, link) = Chain::begin(CONSTANT, &options.delay, start.grade, &mut p);
        let [inner, outer] = FIRST_WEIGHTS;
        let state = State { network: Network::random(options.seed, inner, outer), link };
        let model = Self {
            options: *options,
            installation: start.rotation,
            state,
            chain,
            time_s: 0.0,
            previous: Vector3::zeros(),
        };
        (model, p)
    }

    fn delayed(&mut self, lag: &Lag, p: &mut SMatrix<f64, STATES, STATES>) {
        self.chain.delayed(&mut self.state.link, lag, p);
    }

    fn advance(&mut self, motion: &Motion) {
        self.chain.advance(&mut self.state.link, motion);
        self.time_s = motion.time_s;
    }

    /// There is no model to replace.
    fn set_flexure(&mut self, _flexure: [Flexure; 3]) {}

    fn view(&self) -> View<STATES> {
        let mut rows = SMatrix::<f64, 3, STATES>::zeros();
        let mut noise = Matrix3::zeros();
        let deformation = match self.chain.together() {
            Some(together) => {
                self.chain.view(&together, &mut rows, &mut noise);
                self.state.link.seen(&together, self.state.link.delay)
            }
            None => {
                rows.fixed_view_mut::<3, 3>(0, OFFSET).fill_diagonal(-SCALE);
                self.installation
            }
        };
        View {
            deformation,
            rows,
            noise,
            // it tells no static part from a flexure
            static_part: deformation,
            static_rows: rows,
            rate: Vec3::ZERO,
            rate_rows: SMatrix::zeros(),
            drift: self.state.link.bias,
            delay: self.chain.told(self.chain.delay(&self.state.link)),
            skew: None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::filter::{Filter, symmetrise};
    use crate::matching::conformance::{STEP_S, Voyage, matrix_is_the_derivative};
    use crate::matching::grade::Grade;
    use frames::unit::ARCSEC;

    fn voyage() -> Voyage {
        let installation = Rot::exp(Vec3::new(150.0, -200.0, 250.0) * ARCSEC);
        Voyage { installation, flexure: 2.0 * ARCSEC, delay_s: 0.0, lever_arm: Vec3::ZERO }
    }

    fn begun(options: Options) -> (QuaternionNetwork, SMatrix<f64, STATES, STATES>) {
        let start = Start {
            grade: Grade::default(),
            accel: Default::default(),
            lever_arm: Vec3::ZERO,
            flexure: [Flexure { mu: 0.1, b: 1.0, sigma: 2.0 * ARCSEC }; 3],
            rotation: Rot::identity(),
            covariance: Matrix3::identity() * 1e-6,
        };
        QuaternionNetwork::begin(&options, &start)
    }

    fn at_truth(input: Input, k: usize) -> QuaternionNetwork {
        let voyage = voyage();
        let (mut model, _) = begun(Options { input, ..Options::default() });
        (1..=k).for_each(|k| model.advance(&voyage.motion(k)));
        model.chain.begun = true;
        model.state.link.constant = voyage.deformation(0.0).relabel();
        let together = model.chain.together().expect("no delay");
        let truth = voyage.deformation(k as f64 * STEP_S).log().column() / SCALE;
        let rest = truth - model.state.network.output(&model.input(&together));
        let mut weights = model.state.network.weights.fixed_rows_mut::<3>(OFFSET);
        weights += rest;
        model
    }

    #[test]
    fn the_residual_vanishes_at_the_truth() {
        for input in [Input::Measurement, Input::Time, Input::Previous] {
            let residual = at_truth(input, 137).observe().residual.norm();
            assert!(residual < 1e-6 * ARCSEC, "{input:?}: {residual:e}");
        }
    }

    #[test]
    fn the_measurement_matrix_is_the_derivative() {
        let mut step = SVector::<f64, STATES>::repeat(1e-5);
        step.fixed_rows_mut::<3>(CONSTANT).fill(1e-6);
        for input in [Input::Measurement, Input::Time, Input::Previous] {
            matrix_is_the_derivative(&at_truth(input, 137), &step, 2e-3);
        }
    }

    /// Error of the published deformation after ten minutes, over that of the raw difference of the attitudes.
    fn error_share(options: Options) -> f64 {
        let voyage = voyage();
        let (mut model, mut p) = begun(options);
        for k in 1..=12_000 {
            model.advance(&Motion { interval_s: 5.0 * STEP_S, ..voyage.motion(k * 5) });
            if k % 4 == 0 {
                let Prediction { transition, noise } = model.propagate();
                p = transition * p * transition.transpose() + noise;
                symmetrise(&mut p);
                Filter::Kalman.correct(&mut model, &mut p, &noise).expect("regular");
            }
        }
        let truth = voyage.deformation(600.0);
        (model.view().deformation * truth.inverse()).log().norm() / voyage.deformation(0.0).angle()
    }

    #[test]
    fn it_separates_the_static_part_only_where_it_is_a_random_walk() {
        let walk = Options { input: Input::Time, offset_walk: 3.6 * ARCSEC, ..Options::default() };
        assert!(error_share(walk) < 0.1, "{}", error_share(walk));
        // the measurement as input explains itself
        let own = Options { weight_walk: 1e-3, offset_walk: 1.2 * ARCSEC, ..Options::default() };
        assert!(error_share(own) > 0.3, "{}", error_share(own));
    }
}
