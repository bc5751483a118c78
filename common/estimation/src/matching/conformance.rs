//! What every matching model must pass: checks that the models' own tests call, and a voyage without noise to call them on.

use super::angles::{self, Angles};
use super::grade::Grade;
use super::{Model, Motion, Start};
use crate::flexure::Flexure;
use frames::{Inertial, Main, MainStart, Rot, Sub, SubStart, Vec3, unit};
use nalgebra::{Matrix3, SVector, Vector3};

/// A noise-free motion of both units at 100 Hz; everything is known exactly at every step.
pub struct Voyage {
    /// The static part.
    pub installation: Rot<Main, Sub>,
    /// Amplitude of the flexure about each axis, rad.
    pub flexure: f64,
    /// By how much the sub unit's data are late, s.
    pub delay_s: f64,
    /// From the main to the sub unit, m.
    pub lever_arm: Vec3<Main>,
}

pub const STEP_S: f64 = 0.01;
const GRAVITY: f64 = 9.8;

impl Voyage {
    /// The flexure and its rate, rad and rad/s.
    pub fn theta(&self, t: f64) -> (Vec3<Main>, Vec3<Main>) {
        let waves = [(1.1, 0.2), (0.9, 1.0), (1.4, 2.0)];
        let angle = waves.map(|(w, phase)| self.flexure * (w * t + phase).sin());
        let rate = waves.map(|(w, phase)| self.flexure * w * (w * t + phase).cos());
        (angle.into(), rate.into())
    }

    /// `C_s^m`.
    pub fn deformation(&self, t: f64) -> Rot<Main, Sub> {
        Rot::<Main, Main>::exp(self.theta(t).0) * self.installation
    }

    /// `C_m^i`.
    pub fn attitude(&self, t: f64) -> Rot<Inertial, Main> {
        let sway = |a: f64, period: f64, phase: f64| a * (std::f64::consts::TAU * t / period + phase).sin();
        let yaw = Rot::<Inertial, Inertial>::exp(Vec3::new(0.0, 0.0, sway(0.035, 6.0, 2.0)));
        let pitch = Rot::<Inertial, Inertial>::exp(Vec3::new(sway(0.05, 8.0, 0.3), 0.0, 0.0));
        yaw * pitch * Rot::<Inertial, Main>::exp(Vec3::new(0.0, sway(0.07, 7.0, 1.1), 0.0))
    }

    /// Rate of the ship, rad/s.
    pub fn rate(&self, t: f64) -> Vec3<Main> {
        let h = 1e-4;
        let turn: Rot<Main, Main> = self.attitude(t - h).inverse() * self.attitude(t + h);
        turn.log() / (2.0 * h)
    }

    fn sub_attitude(&self, t: f64) -> Rot<Inertial, Sub> {
        self.attitude(t - self.delay_s) * self.deformation(t - self.delay_s)
    }

    /// Velocity of the sub unit beside the main unit in inertial space, m/s, with an arm that bends with the deck.
    fn lever_velocity(&self, t: f64) -> Vec3<Inertial> {
        let (theta, rate) = self.theta(t);
        let arm = self.lever_arm + theta.cross(self.lever_arm);
        self.attitude(t) * (self.rate(t).cross(arm) + rate.cross(self.lever_arm))
    }

    /// What the units felt in the step that ends at step `k`, from a filter's start at step 0.
    pub fn motion(&self, k: usize) -> Motion {
        let (from, to) = ((k as f64 - 1.0) * STEP_S, k as f64 * STEP_S);
        let (m0, m1) = (self.attitude(from), self.attitude(to));
        let (s0, s1) = (self.sub_attitude(from), self.sub_attitude(to));
        let dtheta_m: Vec3<Main> = (m0.inverse() * m1).log();
        let dtheta_s: Vec3<Sub> = (s0.inverse() * s1).log();
        let dvel_i = Vec3::<Inertial>::new(0.0, 0.0, GRAVITY * STEP_S);
        let lever = self.lever_velocity(to - self.delay_s) - self.lever_velocity(from - self.delay_s);
        Motion {
            time_s: to,
            interval_s: STEP_S,
            a_m: (self.attitude(0.0).inverse() * m1).relabel::<MainStart, Main>(),
            a_s: (self.sub_attitude(0.0).inverse() * s1).relabel::<SubStart, Sub>(),
            dtheta_m,
            dtheta_s,
            dvel_m: (m0 * Rot::<Main, Main>::exp(dtheta_m * 0.5)).inverse() * dvel_i,
            dvel_s: (s0 * Rot::<Sub, Sub>::exp(dtheta_s * 0.5)).inverse() * (dvel_i + lever),
            disturbance: 0.0,
        }
    }
}

/// The measurement matrix is minus the derivative of the residual by the error state, for errors of size `step` per component.
pub fn matrix_is_the_derivative<M: Model<N, K>, const N: usize, const K: usize>(
    model: &M,
    step: &SVector<f64, N>,
    tolerance: f64,
) {
    let seen = model.observe();
    for i in 0..N {
        let mut error = SVector::<f64, N>::zeros();
        error[i] = step[i];
        let numeric = (model.residual_after(&-error) - model.residual_after(&error)) / (2.0 * step[i]);
        let difference = (numeric - seen.matrix.column(i)).norm();
        let size = seen.matrix.column(i).norm().max(numeric.norm());
        assert!(difference <= tolerance * size, "state {i}: {numeric} against {}", seen.matrix.column(i));
    }
}

/// What the angle matchings start from in their tests.
pub fn start(rotation: Rot<Main, Sub>) -> Start {
    Start {
        grade: Grade::default(),
        accel: Default::default(),
        lever_arm: Vec3::ZERO,
        flexure: [Flexure { mu: 0.1, b: 1.0, sigma: 20.0 * unit::ARCSEC }; 3],
        rotation,
        covariance: Matrix3::identity() * 1e-8,
    }
}

/// Puts the truth into the states: the static part, the total, and the constant.
pub fn at_constant(angles: &mut Angles, fixed: Vector3<f64>, total: Vector3<f64>, eta: Vector3<f64>) {
    angles.x.fixed_rows_mut::<3>(angles::STATIC).copy_from(&fixed);
    angles.x.fixed_rows_mut::<3>(angles::FLEXURE).copy_from(&(total - fixed));
    angles.x.fixed_rows_mut::<3>(angles::CONSTANT).copy_from(&eta);
}
