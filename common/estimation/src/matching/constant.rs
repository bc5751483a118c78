//! What becomes of the constant `N` of `A_m D = N A_s` and of its error between two updates of a filter.

use super::Motion;
use super::grade::Grade;
use frames::{Main, MainStart, Rot, SubStart, Vec3};
use nalgebra::{Matrix3, SMatrix};
use serde::{Deserialize, Serialize};

/// What has come in since the last propagation.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
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

    /// Writes what became of the error of the constant at `constant` into transition and noise of a state with the bias at `bias`.
    pub fn place<const N: usize>(
        &self,
        constant: usize,
        bias: usize,
        transition: &mut SMatrix<f64, N, N>,
        noise: &mut SMatrix<f64, N, N>,
    ) {
        transition.fixed_view_mut::<3, 3>(constant, bias).copy_from(&-self.by_bias);
        noise.fixed_view_mut::<3, 3>(constant, constant).fill_diagonal(self.walk);
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
