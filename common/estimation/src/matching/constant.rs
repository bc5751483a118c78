//! What becomes of the constant `N` of `A_m D = N A_s` and of its error between two updates of a filter.

use super::Motion;
use super::grade::Grade;
use frames::{Main, MainStart, Rot, SubStart, Vec3};
use nalgebra::Matrix3;

/// What has come in since the last propagation.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Since {
    /// Its duration, s.
    pub time_s: f64,
    /// `sum A_m dt`: how a bias error turns the constant.
    pub by_bias: Matrix3<f64>,
    /// Variance per axis that random walk and disturbances added to the constant.
    pub walk: f64,
}

impl Since {
    /// Takes in what both units felt.
    pub fn advance(&mut self, motion: &Motion, grade: &Grade) {
        self.time_s += motion.interval_s;
        self.by_bias += middle(motion).matrix() * motion.interval_s;
        self.walk += grade.arw_density() * motion.interval_s + motion.disturbance.powi(2);
    }
}

fn middle(motion: &Motion) -> Rot<MainStart, Main> {
    motion.a_m * Rot::<Main, Main>::exp(motion.dtheta_m * -0.5)
}

/// The constant after the units' relative gyro bias has turned it.
pub(super) fn drifted(
    constant: Rot<MainStart, SubStart>,
    bias: Vec3<Main>,
    motion: &Motion,
) -> Rot<MainStart, SubStart> {
    let drift = middle(motion) * (bias * motion.interval_s);
    (Rot::<MainStart, MainStart>::exp(drift) * constant).normalised()
}
