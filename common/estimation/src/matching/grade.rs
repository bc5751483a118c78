//! Figures of both units' gyros, and what a filter makes of them.

use super::so3::symmetric;
use frames::{Main, Rot, Sub, unit};
use nalgebra::{Matrix3, Matrix6, SMatrix, SVector};
use serde::{Deserialize, Serialize};

/// Regularises a measurement that has no noise of its own, rad: the random walk of integrated rates is that of the constant.
pub(super) const MATCHING_SIGMA: f64 = 0.05 * unit::ARCSEC;
/// To it comes the random walk of so many seconds. With less, the covariance of a coarse unit and this variance lie too far apart for a
/// double.
const MATCHING_S: f64 = 0.1;
/// Standard deviation of the rate of a static part that moves, at the start, rad/s.
const STATIC_RATE_SIGMA: f64 = 0.5 * unit::ARCSEC;
/// So much of the scale and misalignment figures is not constant: nonlinearity, asymmetry, sensitivity to acceleration.
const INCONSTANT: f64 = 0.1;
/// For how long that part keeps its sign, s: about one turn of the ship, or one movement by hand.
const INCONSTANT_S: f64 = 1.0;

/// The figures of one unit's gyros.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub struct Gyro {
    /// Angular random walk, rad/sqrt(s).
    pub arw: f64,
    /// Bias, rad/s, one standard deviation.
    pub bias: f64,
    /// By how much the bias varies in the run, rad/s, one standard deviation.
    pub instability: f64,
    /// Scale factor error, one standard deviation.
    pub scale: f64,
    /// Misalignment of a sensitive axis, rad, one standard deviation.
    pub misalignment: f64,
    /// White error of the stamps, s.
    pub stamp_jitter: f64,
}

/// What the model takes as given.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub struct Grade {
    /// Main unit.
    pub main: Gyro,
    /// Sub unit.
    pub sub: Gyro,
    /// Density of the white noise that drives the static part's rate, rad^2/s^3; without any the static part never moves.
    pub static_noise: f64,
}

impl Grade {
    /// Density of the relative angular random walk, rad^2/s.
    pub fn arw_density(&self) -> f64 {
        self.main.arw.powi(2) + self.sub.arw.powi(2)
    }

    /// Variance of the relative gyro bias before anything is known of it, rad^2/s^2.
    pub fn bias_variance(&self) -> f64 {
        self.main.bias.powi(2) + self.sub.bias.powi(2)
    }

    /// Variance of the static part's rate at the start, rad^2/s^2.
    pub fn static_rate_variance(&self) -> f64 {
        if self.static_noise > 0.0 { STATIC_RATE_SIGMA.powi(2) } else { 0.0 }
    }

    /// Writes transition and noise over the time `t` of a static part whose rate white noise drives into those of a larger state with
    /// the static part of one axis at `x` and its rate at `v`.
    pub fn place_static<const N: usize>(
        &self,
        t: f64,
        x: usize,
        v: usize,
        transition: &mut SMatrix<f64, N, N>,
        noise: &mut SMatrix<f64, N, N>,
    ) {
        let q = self.static_noise;
        transition[(x, v)] = t;
        noise[(x, x)] = q * t * t * t / 3.0;
        noise[(x, v)] = q * t * t / 2.0;
        noise[(v, x)] = noise[(x, v)];
        noise[(v, v)] = q * t;
    }

    /// Variance of the angle that a whole triad may be turned by its misalignments, which no data show, rad^2.
    pub fn triad_variance(&self) -> f64 {
        0.5 * (self.main.misalignment.powi(2) + self.sub.misalignment.powi(2))
    }

    /// Variance, per second and per squared rate of turn, that the inconstant part of scale and misalignment adds.
    pub(super) fn turning_variance(&self) -> f64 {
        INCONSTANT * INCONSTANT * INCONSTANT_S * self.scale_variance()
    }

    /// Variance of a relative scale error, whether along an axis or across.
    pub fn scale_variance(&self) -> f64 {
        let square = |gyro: &Gyro| gyro.scale.powi(2) + gyro.misalignment.powi(2);
        square(&self.main) + square(&self.sub)
    }

    /// Variance of a matching measurement, rad^2.
    pub(super) fn matching_variance(&self) -> f64 {
        MATCHING_SIGMA.powi(2) + self.arw_density() * MATCHING_S
    }

    /// The least standard deviation of a flexure that these gyros can tell from their own errors, rad: what the relative random walk
    /// adds up to in ten seconds and the bias's variation in two. Less must not be believed.
    pub fn least_flexure(&self) -> f64 {
        let walk = self.main.arw.hypot(self.sub.arw) * f64::sqrt(10.0);
        walk.hypot(self.wander_variance().sqrt() * 2.0)
    }

    /// Variance of the relative bias's variation in the run, rad^2/s^2.
    pub fn wander_variance(&self) -> f64 {
        self.main.instability.powi(2) + self.sub.instability.powi(2)
    }

    /// Covariance of the relative scale states for an installation `d`, from the units' figures.
    pub fn scale_covariance(&self, d: Rot<Main, Sub>) -> Matrix6<f64> {
        let own = |gyro: &Gyro| {
            let (scale, skew) = (gyro.scale.powi(2), 0.5 * gyro.misalignment.powi(2));
            Matrix6::from_diagonal(&[scale, scale, scale, skew, skew, skew].into())
        };
        let c = d.matrix();
        let mut turn = Matrix6::zeros();
        for column in 0..6 {
            let mut unit = SVector::<f64, 6>::zeros();
            unit[column] = 1.0;
            turn.set_column(column, &components(&(c * symmetric(&unit) * c.transpose())));
        }
        own(&self.main) + turn * own(&self.sub) * turn.transpose()
    }
}

/// The components of a symmetric matrix.
fn components(m: &Matrix3<f64>) -> SVector<f64, 6> {
    [m[(0, 0)], m[(1, 1)], m[(2, 2)], m[(0, 1)], m[(0, 2)], m[(1, 2)]].into()
}
