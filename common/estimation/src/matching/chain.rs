//! The units' attitudes with the constant between them: `D = Exp(w tau) A_m^T N A_s`, where the sub unit's stamps may be late.

use super::constant::{Since, drifted};
use super::grade::Grade;
use super::quaternion::DelayOptions;
use super::retiming::{Retimed, Together};
use super::{Motion, Prediction};
use crate::align::Lag;
use frames::{Main, MainStart, Rot, Sub, SubStart, Vec3};
use nalgebra::{Matrix3, SMatrix, SVector, Vector3};
use serde::{Deserialize, Serialize};

/// Place of the bias behind that of the constant.
pub(super) const BIAS: usize = 3;
/// Place of the rest of the delay behind that of the constant.
pub(super) const DELAY: usize = 6;

/// What is estimated of a chain.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(super) struct Link {
    /// `N`.
    pub constant: Rot<MainStart, SubStart>,
    /// Relative gyro bias, rad/s.
    pub bias: Vec3<Main>,
    /// Rest of the delay, s.
    pub delay: f64,
}

impl Link {
    /// With an error moved into it whose constant stands at `at`.
    pub fn moved<const N: usize>(self, error: &SVector<f64, N>, at: usize) -> Self {
        let psi = Vec3::<MainStart>::from_column(error.fixed_rows::<3>(at).into());
        Self {
            constant: Rot::<MainStart, MainStart>::exp(-psi) * self.constant,
            bias: self.bias + Vec3::from_column(error.fixed_rows::<3>(at + BIAS).into()),
            delay: self.delay + error[at + DELAY],
        }
    }

    /// The deformation by the attitudes of the moment that the sub unit felt.
    pub fn seen(&self, together: &Together, delay: f64) -> Rot<Main, Sub> {
        Rot::<Main, Main>::exp(together.w_m * delay) * together.a_m.inverse() * self.constant * together.a_s
    }
}

/// Both units' attitudes, and what has come in since the last propagation.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Chain {
    /// Place of the constant in the error state.
    at: usize,
    delay_sigma: f64,
    pub grade: Grade,
    pub attitudes: Retimed,
    /// Whether the constant has been set from attitudes of one moment.
    pub begun: bool,
    pub since: Since,
}

impl Chain {
    /// One that has seen nothing, with its part of the covariance written into `p`.
    pub fn begin<const N: usize>(
        at: usize,
        options: &DelayOptions,
        grade: Grade,
        p: &mut SMatrix<f64, N, N>,
    ) -> (Self, Link) {
        p.fixed_view_mut::<3, 3>(at + BIAS, at + BIAS).fill_diagonal(grade.bias_variance());
        p[(at + DELAY, at + DELAY)] = options.sigma.powi(2);
        let attitudes = Retimed::new(options.retimed);
        let chain = Self { at, delay_sigma: options.sigma, grade, attitudes, begun: false, since: Since::default() };
        (chain, Link { constant: Rot::identity(), bias: Vec3::ZERO, delay: 0.0 })
    }

    /// Starts from the delay that registration has found, if there is to be one.
    pub fn delayed<const N: usize>(&mut self, link: &mut Link, lag: &Lag, p: &mut SMatrix<f64, N, N>) {
        if self.delay_sigma > 0.0 {
            link.delay = lag.delay;
            self.attitudes.absorb(&mut link.delay);
            p[(self.at + DELAY, self.at + DELAY)] = lag.sigma.powi(2);
        }
    }

    /// Takes in what both units felt.
    pub fn advance(&mut self, link: &mut Link, motion: &Motion) {
        if self.begun {
            link.constant = drifted(link.constant, link.bias, motion);
        }
        self.since.advance(motion, &self.grade);
        self.attitudes.advance(motion);
    }

    /// Both units at one moment, once the constant is known.
    pub fn together(&self) -> Option<Together> {
        self.attitudes.together().filter(|_| self.begun)
    }

    /// Both units at one moment while the constant is not known.
    pub fn first(&self) -> Option<Together> {
        self.attitudes.together().filter(|_| !self.begun)
    }

    /// By how much the sub unit's data were older than their stamps at the last propagation, s.
    pub fn delay(&self, link: &Link) -> f64 {
        self.attitudes.shift() + link.delay
    }

    /// The delay with its place, where it is estimated.
    pub fn told(&self, delay: f64) -> Option<(f64, usize)> {
        (self.delay_sigma > 0.0).then_some((delay, self.at + DELAY))
    }

    /// Sets the constant by a deformation as it is believed to be; its error is that of what it is made of, of which `made_of` tells the
    /// states of the deformation.
    pub fn set<const N: usize>(
        &mut self,
        link: &mut Link,
        together: &Together,
        deformation: Rot<Main, Sub>,
        mut made_of: SMatrix<f64, N, N>,
        prediction: &mut Prediction<N>,
    ) {
        self.begun = true;
        let turned = Rot::<Main, Main>::exp(together.w_m * link.delay);
        link.constant = together.a_m * turned.inverse() * deformation * together.a_s.inverse();
        let by_delay: Vector3<f64> = together.a_m.matrix() * together.w_m.column();
        made_of.fixed_view_mut::<3, 3>(self.at, self.at).fill(0.0);
        made_of.fixed_view_mut::<3, 1>(self.at, self.at + DELAY).copy_from(&by_delay);
        prediction.transition = made_of * prediction.transition;
        prediction.noise = made_of * prediction.noise * made_of.transpose();
    }

    /// Writes how the measurement depends on the link.
    pub fn observe<const N: usize>(&self, together: &Together, matrix: &mut SMatrix<f64, 3, N>) {
        matrix.fixed_view_mut::<3, 3>(0, self.at).copy_from(&together.a_m.inverse().matrix());
        matrix.set_column(self.at + DELAY, &-together.w_m.column());
    }

    /// The same of the deformation now, with what has entered it since the last propagation.
    pub fn view<const N: usize>(&self, together: &Together, rows: &mut SMatrix<f64, 3, N>, noise: &mut Matrix3<f64>) {
        self.observe(together, rows);
        let by_bias = -together.a_m.inverse().matrix() * self.since.by_bias;
        rows.fixed_view_mut::<3, 3>(0, self.at + BIAS).copy_from(&by_bias);
        noise.fill_diagonal(self.since.walk);
    }
}
