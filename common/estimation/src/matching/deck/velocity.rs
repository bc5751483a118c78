//! The relative velocity of the two units: by the accelerometers through the constant, and by the lever arm.

use super::{Grade, Rows, place};
use crate::matching::Accel;
use crate::matching::increment::{Increment, Velocities};
use frames::{Main, MainStart, Rot, Sub, SubStart, Vec3, unit};
use nalgebra::{Matrix3, SMatrix, Vector3};
use serde::{Deserialize, Serialize};

/// Noise of the comparison: coning and sculling of single samples, m/s. From 1 to 30 mm/s the results are the same.
const SIGMA: f64 = 3e-3;
/// The rate at a sample's end comes from a polynomial through four, with so many times the variance of a mean rate.
const END_RATE: f64 = 4.83;
/// Standard deviation of the velocity where it starts, m/s.
const START_SIGMA: f64 = 3.0;
/// The least angle between a unit's triads, rad.
const LEAST_TRIAD: f64 = 5.0 * unit::ARCSEC;
/// How much of the flexure bends the lever arm: nothing is known.
const GAIN: (f64, f64) = (0.5, 0.5);

/// What is known of accelerometers and lever arm.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct Lever {
    /// Figures of both units' accelerometers.
    pub accel: Accel,
    /// From the main to the sub unit, m.
    pub arm: Vec3<Main>,
    /// Standard deviation of that, m.
    pub sigma: f64,
}

/// The nominal state.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Velocity {
    lever: Lever,
    /// Whether `u` has started.
    begun: bool,
    u: Vec3<MainStart>,
    bias: Vec3<Sub>,
    triad: Vec3<Sub>,
    gain: Vector3<f64>,
    arm: Vec3<Main>,
    /// What the main unit's accelerometers and the turning of a stiff lever arm make of the sub unit's mean specific force over the interval of the last
    /// propagation, m/s^2, in the main unit's starting axes. What the sub unit felt would be the force together with the flexure's own noise, which is in the
    /// comparison too: the two would look like a delay. With a flexure of 0.2 Hz and a lever arm of 35 m that was 6 ms, and 120 arcsec of deformation.
    force: Vector3<f64>,
    /// Velocity by a stiff lever arm at the last propagation, m/s, in the main unit's starting axes.
    stiff: Vector3<f64>,
    /// Duration of the last increment, s.
    sample_s: f64,
    since: Since,
}

/// What has come in since the last propagation.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
struct Since {
    time_s: f64,
    /// With spikes, s.
    spiked_s: f64,
    /// What the sub unit's accelerometers gained, and what the main unit's, m/s.
    gained: Vector3<f64>,
    gained_m: Vector3<f64>,
    /// How the velocity depends on the errors of constant, bias and scale of the gyros, bias and triad of the accelerometers.
    by_gyro_bias: Matrix3<f64>,
    by_gyro_scale: SMatrix<f64, 3, 6>,
    by_bias: Matrix3<f64>,
    by_triad: Matrix3<f64>,
}

/// What the velocity is compared under.
#[derive(Clone, Copy, Debug)]
pub struct Scene {
    /// The main unit's attitude.
    pub a_m: Rot<MainStart, Main>,
    /// Its rate, rad/s.
    pub w_m: Vector3<f64>,
    /// Flexure, rad.
    pub theta: Vector3<f64>,
    /// Its rate, rad/s.
    pub theta_rate: Vector3<f64>,
    /// Rest of the delay, s.
    pub delay: f64,
    /// Density of the noise that drives the flexure, rad^2/s^3.
    pub liveliest: f64,
}

impl Velocity {
    /// A state that has seen nothing.
    pub fn new(lever: Lever) -> Self {
        Self {
            lever,
            begun: false,
            u: Vec3::ZERO,
            bias: Vec3::ZERO,
            triad: Vec3::ZERO,
            gain: Vector3::repeat(GAIN.0),
            arm: lever.arm,
            force: Vector3::zeros(),
            stiff: Vector3::zeros(),
            sample_s: f64::INFINITY,
            since: Since::default(),
        }
    }

    /// Variances of the states at the start, but for the velocity's, which comes when it starts.
    pub fn doubt(&self, grade: &Grade, p: &mut super::Covariance) {
        let misaligned = grade.main.misalignment.hypot(grade.sub.misalignment);
        let triad = LEAST_TRIAD.max(misaligned) * std::f64::consts::SQRT_2;
        let sigmas = [
            (place::ACCEL_BIAS, self.lever.accel.bias),
            (place::TRIAD, triad),
            (place::GAIN, GAIN.1),
            (place::ARM, self.lever.sigma),
        ];
        for (first, sigma) in sigmas {
            (first..first + 3).for_each(|i| p[(i, i)] = sigma * sigma);
        }
    }

    /// Forgets the velocity.
    pub fn restart(&mut self) {
        self.begun = false;
        self.since = Since::default();
    }

    /// The velocity between other moments of the two units.
    pub fn retime(&mut self, before: Velocities, now: Velocities, constant: Rot<MainStart, SubStart>) {
        self.u += constant * (now.s - before.s) - (now.m - before.m);
    }

    /// Takes in what both units felt, with what bias and scale of the gyros have turned the constant by so far.
    pub fn advance(
        &mut self,
        step: &Increment,
        constant: Rot<MainStart, SubStart>,
        by_gyro: (Matrix3<f64>, SMatrix<f64, 3, 6>),
    ) {
        let Some(Velocities { m, s }) = step.velocities else {
            self.restart();
            return;
        };
        let a_s = step.a_s.matrix();
        let felt = s.column() - a_s * self.bias.column() * step.time_s + (a_s * self.triad.column()).cross(&s.column());
        let n = constant.matrix();
        let gained = n * felt;
        self.u += Vec3::from_column(gained) - m;
        let force = gained.cross_matrix();
        self.sample_s = step.time_s;
        let since = &mut self.since;
        since.time_s += step.time_s;
        since.spiked_s += step.spiked_s;
        since.gained += gained;
        since.gained_m += m.column();
        since.by_gyro_bias -= force * by_gyro.0;
        since.by_gyro_scale -= force * by_gyro.1;
        since.by_bias -= n * a_s * step.time_s;
        since.by_triad -= force * n * a_s;
    }

    /// Writes what the velocity did since the last call; where it starts, it starts from what the lever arm gives.
    pub fn propagate(&mut self, scene: &Scene, transition: &mut super::Covariance, noise: &mut super::Covariance) {
        let since = std::mem::take(&mut self.since);
        let stiff = scene.a_m.matrix() * scene.w_m.cross(&self.arm.column());
        let before = std::mem::replace(&mut self.stiff, stiff);
        if !self.begun {
            self.force = Vector3::zeros();
            transition.fixed_view_mut::<3, { super::STATES }>(place::VELOCITY, 0).fill(0.0);
            noise.fixed_view_mut::<3, 3>(place::VELOCITY, place::VELOCITY).fill_diagonal(START_SIGMA * START_SIGMA);
            self.u = scene.a_m * Vec3::from_column(self.swing(scene));
            self.begun = true;
            return;
        }
        self.force = (since.gained_m + stiff - before) / since.time_s.max(f64::MIN_POSITIVE);
        let force = since.gained.cross_matrix();
        let mut put = |column: usize, block: &Matrix3<f64>| {
            transition.fixed_view_mut::<3, 3>(place::VELOCITY, column).copy_from(block);
        };
        put(place::CONSTANT, &force);
        put(place::BIAS, &since.by_gyro_bias);
        put(place::WANDER, &since.by_gyro_bias);
        put(place::ACCEL_BIAS, &since.by_bias);
        put(place::TRIAD, &since.by_triad);
        transition.fixed_view_mut::<3, 6>(place::VELOCITY, place::SCALE).copy_from(&since.by_gyro_scale);
        // where an increment was replaced, the lever arm's true movement in that sample is lost
        let lost = scene.liveliest * since.spiked_s * self.arm.column().norm_squared();
        let walk = self.lever.accel.vrw.powi(2) * since.time_s + lost;
        noise.fixed_view_mut::<3, 3>(place::VELOCITY, place::VELOCITY).fill_diagonal(walk);
    }

    /// How flexure and its rate make velocity, were the gain 1.
    fn bends(&self, w_m: &Vector3<f64>) -> (Matrix3<f64>, Matrix3<f64>) {
        let arm = -self.arm.skew();
        (w_m.cross_matrix() * arm, arm)
    }

    /// Velocity of the sub unit about the main unit by the lever arm, m/s, in m.
    fn swing(&self, scene: &Scene) -> Vector3<f64> {
        let (by_angle, by_rate) = self.bends(&scene.w_m);
        let bent = by_angle * scene.theta + by_rate * scene.theta_rate;
        scene.w_m.cross(&self.arm.column()) + self.gain.component_mul(&bent)
    }

    /// Whether there is a velocity to compare.
    pub fn is_begun(&self) -> bool {
        self.begun
    }

    /// The velocity by the accelerometers, less that by the lever arm, m/s, in m; the sub unit's is that of a moment ago.
    pub fn residual(&self, scene: &Scene) -> Vector3<f64> {
        let back = scene.a_m.matrix().transpose();
        back * (self.u.column() + self.force * scene.delay) - self.swing(scene)
    }

    /// Derivative of minus that by the error states.
    pub fn matrix(&self, scene: &Scene) -> Rows {
        let mut matrix = Rows::zeros();
        let gain = Matrix3::from_diagonal(&self.gain);
        let back = scene.a_m.matrix().transpose();
        let (by_angle, by_rate) = self.bends(&scene.w_m);
        let mut put = |column: usize, block: Matrix3<f64>| {
            matrix.fixed_view_mut::<3, 3>(0, column).copy_from(&block);
        };
        put(place::VELOCITY, -back);
        for (angle, rate) in [(place::FLEXURE, place::FLEXURE_RATE), (place::SECOND, place::SECOND_RATE)] {
            put(angle, gain * by_angle);
            put(rate, gain * by_rate);
        }
        put(place::GAIN, Matrix3::from_diagonal(&(by_angle * scene.theta + by_rate * scene.theta_rate)));
        put(place::ARM, scene.w_m.cross_matrix());
        matrix.set_column(place::DELAY, &-(back * self.force));
        matrix
    }

    /// Variance of each velocity by the product of the errors of gain and flexure, which a comparison that is linear in its errors leaves out, m^2/s^2.
    pub fn left_out(&self, scene: &Scene, p: &super::Covariance) -> Vector3<f64> {
        let (by_angle, by_rate) = self.bends(&scene.w_m);
        let mut bent = Rows::zeros();
        for (angle, rate) in [(place::FLEXURE, place::FLEXURE_RATE), (place::SECOND, place::SECOND_RATE)] {
            bent.fixed_view_mut::<3, 3>(0, angle).copy_from(&by_angle);
            bent.fixed_view_mut::<3, 3>(0, rate).copy_from(&by_rate);
        }
        let with = bent * p;
        Vector3::from_fn(|axis, _| {
            let gain = place::GAIN + axis;
            let variance = (with.row(axis) * bent.row(axis).transpose())[0];
            p[(gain, gain)] * variance + with[(axis, gain)].powi(2)
        })
    }

    /// Variance of the comparison's own noise, m^2/s^2.
    pub fn variance(&self, grade: &Grade) -> f64 {
        let end = END_RATE * grade.main.arw.powi(2) / self.sample_s;
        SIGMA * SIGMA + end * self.arm.column().norm_squared()
    }

    /// The velocity, m/s.
    #[cfg(test)]
    pub fn velocity(&self) -> Vec3<MainStart> {
        self.u
    }

    /// Moves an estimated error into the state.
    pub fn inject(&mut self, error: &super::ErrorState) {
        let three = |first: usize| -> Vector3<f64> { error.fixed_rows::<3>(first).into() };
        self.u += Vec3::from_column(three(place::VELOCITY));
        self.bias += Vec3::from_column(three(place::ACCEL_BIAS));
        self.triad += Vec3::from_column(three(place::TRIAD));
        self.gain += three(place::GAIN);
        self.arm += Vec3::from_column(three(place::ARM));
    }
}
