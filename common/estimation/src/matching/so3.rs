//! Attitude matching on SO(3), at any installation angle.
//!
//! Source: paper 001 eqs 11-30 reworked in product form. The units' accumulated attitudes obey `A_m D = N A_s` exactly, with
//! `D = C_s^m = Exp(theta) S` and `N` constant but for gyro errors; all of the error of `D` is the error of `N`.
//!
//! | state | size | error | moves by |
//! |---|---|---|---|
//! | static part S | 3 | `S_true = Exp(s) S`, in m | its rate |
//! | rate of S | 3 | additive, rad/s | white noise `q` |
//! | flexure theta, its rate | 3 + 3 | additive, rad, rad/s | second-order Gauss-Markov, exact |
//! | second mode of the flexure, its rate | 3 + 3 | additive, rad, rad/s | the same; still where the hull has one mode |
//! | constant N | 3 | `N_true = Exp(-eta) N`, in the main unit's starting axes | relative gyro errors |
//! | relative gyro bias | 3 | additive, rad/s, in m | constant |
//! | what it varies by in the run | 3 | additive, rad/s, in m | first-order Gauss-Markov |
//! | relative scale and non-orthogonality | 6 | additive, symmetric matrix, in m | constant |
//!
//! Corrections to the paper: eq 29 lacks the derivative's dot; 39 states collapse to these because the units' single errors cannot be told
//! apart; the Euler angles of eqs 22 and 35 give way to the rotation vector. Bias's variation, scale and second mode are ours: as process noise the scale errors of a
//! coarse unit would have to be called white, which they are not, and its bias differs from pose to pose. The antisymmetric part of a triad's misalignment turns the unit as
//! a whole, no data show it, and it widens the published covariance instead.
//!
//! Static part and flexure share ONE Jacobian, that at `theta = 0`: with the exact pair the flexure itself becomes a regressor for
//! directions that nothing shows, and the filter invents information where there is no sway.

pub use super::grade::{Grade, Gyro};
use super::increment::Increment;
use super::{Matching, Observation, Prediction, rows_of};
use crate::flexure::{Flexure, Hull};
use frames::{Main, MainStart, Rot, Sub, SubStart, Vec3};
use nalgebra::{Matrix3, SMatrix, SVector, Vector3};
use serde::{Deserialize, Serialize};

/// Size of the error state.
pub const STATES: usize = 33;
/// Places of the error states.
pub mod place {
    /// Static part.
    pub const STATIC: usize = 0;
    /// Its rate.
    pub const STATIC_RATE: usize = 3;
    /// Flexure.
    pub const FLEXURE: usize = 6;
    /// Its rate.
    pub const FLEXURE_RATE: usize = 9;
    /// The constant `N`.
    pub const CONSTANT: usize = 12;
    /// Relative gyro bias.
    pub const BIAS: usize = 15;
    /// What the bias varies by in the run.
    pub const WANDER: usize = 18;
    /// Relative scale and non-orthogonality: xx, yy, zz, xy, xz, yz.
    pub const SCALE: usize = 21;
    /// Second mode of the flexure.
    pub const SECOND: usize = 27;
    /// Its rate.
    pub const SECOND_RATE: usize = 30;
}

/// Covariance of the error state.
pub type Covariance = SMatrix<f64, STATES, STATES>;
/// Error state.
pub type ErrorState = SVector<f64, STATES>;
/// Rows of something with three components.
pub type Rows = SMatrix<f64, 3, STATES>;
/// How three components depend on the six of a symmetric matrix.
pub type ByScale = SMatrix<f64, 3, 6>;

/// Standard deviation of a second mode that the hull does not have, rad: with none at all the covariance would fade into the smallest numbers there are, and
/// one of them comes out negative.
const NO_MODE: f64 = 1e-12;
/// Where angle and rate of the first and of the second mode stand.
const MODES: [(usize, usize); 2] = [(place::FLEXURE, place::FLEXURE_RATE), (place::SECOND, place::SECOND_RATE)];

/// Correlation time of the bias's variation in the run, s.
const WANDER_S: f64 = 100.0;

/// The symmetric matrix of the components xx, yy, zz, xy, xz, yz.
pub fn symmetric(m: &SVector<f64, 6>) -> Matrix3<f64> {
    Matrix3::new(m[0], m[3], m[4], m[3], m[1], m[5], m[4], m[5], m[2])
}

/// `d(M w) / d(components of M)`.
fn by_scale(w: Vector3<f64>) -> ByScale {
    let (x, y, z) = (w.x, w.y, w.z);
    ByScale::new(x, 0., 0., y, z, 0., 0., y, 0., x, 0., z, 0., 0., z, 0., x, y)
}

/// What has come in since the last propagation.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
struct Since {
    time_s: f64,
    /// `sum A_m dt`: how a bias error turns the constant.
    by_bias: Matrix3<f64>,
    /// The same for the scale states.
    by_scale: ByScale,
    /// Variance per axis that random walk, stamps and disturbances added to the constant.
    walk: f64,
    stamps: Matrix3<f64>,
}

impl Default for Since {
    fn default() -> Self {
        Self { time_s: 0.0, by_bias: Matrix3::zeros(), by_scale: ByScale::zeros(), walk: 0.0, stamps: Matrix3::zeros() }
    }
}

/// The nominal state of one area.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct So3 {
    grade: Grade,
    hull: Hull,
    static_part: Rot<Main, Sub>,
    static_rate: Vec3<Main>,
    /// Of the first mode, then of the second.
    theta: [Vector3<f64>; 2],
    theta_rate: [Vector3<f64>; 2],
    constant: Rot<MainStart, SubStart>,
    bias: Vec3<Main>,
    wander: Vec3<Main>,
    scale: SVector<f64, 6>,
    a_m: Rot<MainStart, Main>,
    a_s: Rot<SubStart, Sub>,
    rate_m: Vector3<f64>,
    since: Since,
}

/// How static part and flexure go on from now.
#[derive(Clone, Copy, Debug)]
pub struct Ahead {
    /// By how much the deformation turns, rad.
    pub turn: Vec3<Main>,
    /// How the error of that depends on the error state.
    pub rows: Rows,
    /// Covariance of what the flexure's noise adds, rad^2.
    pub noise: Matrix3<f64>,
}

impl So3 {
    /// A state at rest at the installation `static_part`, with a flexure model and a first idea of the relative gyro bias.
    pub fn new(grade: Grade, hull: Hull, static_part: Rot<Main, Sub>, bias: Vec3<Main>) -> Self {
        Self {
            grade,
            hull,
            static_part,
            static_rate: Vec3::ZERO,
            theta: [Vector3::zeros(); 2],
            theta_rate: [Vector3::zeros(); 2],
            constant: Rot::identity(),
            bias,
            wander: Vec3::ZERO,
            scale: SVector::zeros(),
            a_m: Rot::identity(),
            a_s: Rot::identity(),
            rate_m: Vector3::zeros(),
            since: Since::default(),
        }
    }

    /// Replaces the flexure model from now on.
    pub fn set_flexure(&mut self, hull: Hull) {
        self.hull = hull;
    }

    /// The model that moves a mode about an axis: what is left of a second one that the hull is no longer believed to have goes the way of the first.
    fn mode(&self, which: usize, axis: usize) -> Flexure {
        let first = self.hull.modes[axis];
        if which == 0 { first } else { self.hull.second[axis].unwrap_or(Flexure { sigma: NO_MODE, ..first }) }
    }

    /// Starts an epoch: the constant is defined by the deformation as it is believed to be now, which the attitudes show but for a `turn` of the
    /// ship. Gives the transition of the error state: the new constant's error is that of static part and flexure, turned into the starting axes.
    pub fn start_epoch(
        &mut self,
        a_m: Rot<MainStart, Main>,
        a_s: Rot<SubStart, Sub>,
        turn: Rot<Main, Main>,
    ) -> SMatrix<f64, STATES, STATES> {
        (self.a_m, self.a_s) = (a_m, a_s);
        self.constant = a_m * turn.inverse() * self.predicted() * a_s.inverse();
        let mut transition = Covariance::identity();
        let minus_a = -a_m.matrix();
        transition.fixed_view_mut::<3, 3>(place::CONSTANT, place::CONSTANT).fill(0.0);
        for place in [place::STATIC, place::FLEXURE, place::SECOND] {
            transition.fixed_view_mut::<3, 3>(place::CONSTANT, place).copy_from(&minus_a);
        }
        transition
    }

    /// Takes in one pair: the constant drifts by the relative gyro errors as they are known.
    pub fn advance(&mut self, step: &Increment) {
        let mid = step.middle_m();
        let dtheta = step.dtheta_m.column();
        let drift = (self.bias + self.wander) * step.time_s + Vec3::from_column(symmetric(&self.scale) * dtheta);
        self.constant = (Rot::<MainStart, MainStart>::exp(mid * drift) * self.constant).normalised();
        let rate = if step.time_s > 0.0 { dtheta / step.time_s } else { self.rate_m };
        let a = mid.matrix();
        let jitter = self.grade.main.stamp_jitter.powi(2) + self.grade.sub.stamp_jitter.powi(2);
        let since = &mut self.since;
        since.by_bias += a * step.time_s;
        since.by_scale += a * by_scale(dtheta);
        since.walk += self.grade.arw_density() * step.time_s
            + step.disturbance.powi(2)
            + self.grade.turning_variance() * rate.norm_squared() * step.time_s;
        since.stamps += step.rate_changes * jitter;
        (self.a_m, self.a_s, self.rate_m) = (step.a_m, step.a_s, rate);
    }

    /// Takes other attitudes for those of now.
    pub fn retime(&mut self, a_m: Rot<MainStart, Main>, a_s: Rot<SubStart, Sub>) {
        (self.a_m, self.a_s) = (a_m, a_s);
    }

    /// How errors of the gyros' bias and scale have turned the constant since the last propagation, in the starting axes.
    pub fn by_gyro(&self) -> (Matrix3<f64>, ByScale) {
        (self.since.by_bias, self.since.by_scale)
    }

    /// The flexure and its rate at the last propagation, rad, rad/s, in m.
    pub fn flexed(&self) -> (Vector3<f64>, Vector3<f64>) {
        (self.theta[0] + self.theta[1], self.theta_rate[0] + self.theta_rate[1])
    }

    /// Density of the noise that drives the liveliest axis of the flexure, rad^2/s^3.
    pub fn liveliest(&self) -> f64 {
        self.hull.all().map(Flexure::density).fold(0.0, f64::max)
    }

    /// How static part and flexure go on for `time_s` from now, by their models.
    pub fn ahead(&self, time_s: f64) -> Ahead {
        let mut turn = self.static_rate.column() * time_s;
        let (mut rows, mut noise) = (Rows::zeros(), Matrix3::zeros());
        let from_s = self.since.time_s;
        for axis in 0..3 {
            rows[(axis, place::STATIC_RATE + axis)] = -time_s;
            for (which, (angle, rate)) in MODES.into_iter().enumerate() {
                let mode = self.mode(which, axis);
                let (near, far) = (mode.transition(from_s), mode.transition(from_s + time_s));
                let by = [far[(0, 0)] - near[(0, 0)], far[(0, 1)] - near[(0, 1)]];
                turn[axis] += by[0] * self.theta[which][axis] + by[1] * self.theta_rate[which][axis];
                rows[(axis, angle + axis)] = -by[0];
                rows[(axis, rate + axis)] = -by[1];
                noise[(axis, axis)] += mode.noise(time_s)[(0, 0)];
            }
        }
        Ahead { turn: Vec3::from_column(turn), rows, noise }
    }

    /// Lets time pass for the model of static part and flexure.
    pub fn coast(&mut self, time_s: f64) {
        self.since.time_s += time_s;
    }

    /// The time since the last propagation, s.
    pub fn pending_s(&self) -> f64 {
        self.since.time_s
    }

    /// The deformation by the units' attitudes: two products a sample, without a filter step.
    pub fn deformation(&self) -> Rot<Main, Sub> {
        self.a_m.inverse() * self.constant * self.a_s
    }

    /// The deformation by the model alone, which is all there is while data are missing.
    pub fn predicted(&self) -> Rot<Main, Sub> {
        Rot::<Main, Main>::exp(Vec3::from_column(self.flexed().0)) * self.static_part
    }

    /// Static part.
    pub fn static_part(&self) -> Rot<Main, Sub> {
        self.static_part
    }

    /// The constant of the epoch.
    pub fn constant(&self) -> Rot<MainStart, SubStart> {
        self.constant
    }

    /// Relative gyro bias as it is known, rad/s.
    pub fn drift(&self) -> Vec3<Main> {
        self.bias + self.wander
    }

    /// Relative scale and non-orthogonality as they are known: xx, yy, zz, xy, xz, yz.
    pub fn scale(&self) -> [f64; 6] {
        self.scale.into()
    }

    /// Rate of the deformation by the filter, rad/s.
    pub fn rate(&self) -> Vec3<Main> {
        Vec3::from_column(self.flexed().1) + self.static_rate
    }

    /// How the error of [`So3::deformation`] (`Log(D_hat D_true^T)`, in m) depends on the error state.
    pub fn deformation_rows(&self) -> Rows {
        let back = self.a_m.inverse().matrix();
        let mut rows = Rows::zeros();
        rows.fixed_view_mut::<3, 3>(0, place::CONSTANT).copy_from(&back);
        for place in [place::BIAS, place::WANDER] {
            rows.fixed_view_mut::<3, 3>(0, place).copy_from(&(-back * self.since.by_bias));
        }
        rows.fixed_view_mut::<3, 6>(0, place::SCALE).copy_from(&(-back * self.since.by_scale));
        rows
    }

    /// How the error of [`So3::predicted`] depends on the error state, but for the sign.
    pub fn prediction_rows() -> Rows {
        rows_of(place::STATIC) + rows_of(place::FLEXURE) + rows_of(place::SECOND)
    }

    /// Covariance that has entered the deformation since the last propagation, in m.
    pub fn deformation_noise(&self) -> Matrix3<f64> {
        let back = self.a_m.inverse().matrix();
        Matrix3::identity() * self.since.walk + back * self.since.stamps * back.transpose() + self.stamp_noise()
    }

    /// White error of the attitudes by the jitter of the stamps, in m.
    fn stamp_noise(&self) -> Matrix3<f64> {
        let jitter = self.grade.main.stamp_jitter.powi(2) + self.grade.sub.stamp_jitter.powi(2);
        self.rate_m * self.rate_m.transpose() * jitter
    }
}

impl Matching<STATES, 3> for So3 {
    fn propagate(&mut self) -> Prediction<STATES> {
        let since = std::mem::take(&mut self.since);
        let h = since.time_s;
        let mut transition = Covariance::identity();
        let mut noise = Covariance::zeros();
        self.static_part = (Rot::<Main, Main>::exp(self.static_rate * h) * self.static_part).normalised();
        for axis in 0..3 {
            let (s, r) = (place::STATIC + axis, place::STATIC_RATE + axis);
            self.grade.place_static(h, s, r, &mut transition, &mut noise);
            for (which, (angle, rate)) in MODES.into_iter().enumerate() {
                let (x, v) = (angle + axis, rate + axis);
                let mode = self.mode(which, axis);
                mode.place(h, x, v, &mut transition, &mut noise);
                let (theta, theta_rate) = (self.theta[which][axis], self.theta_rate[which][axis]);
                self.theta[which][axis] = transition[(x, x)] * theta + transition[(x, v)] * theta_rate;
                self.theta_rate[which][axis] = transition[(v, x)] * theta + transition[(v, v)] * theta_rate;
            }
        }
        let kept = (-h / WANDER_S).exp();
        self.wander = self.wander * kept;
        for axis in place::WANDER..place::WANDER + 3 {
            transition[(axis, axis)] = kept;
            noise[(axis, axis)] = self.grade.wander_variance() * (1.0 - kept * kept);
        }
        for place in [place::BIAS, place::WANDER] {
            transition.fixed_view_mut::<3, 3>(place::CONSTANT, place).copy_from(&-since.by_bias);
        }
        transition.fixed_view_mut::<3, 6>(place::CONSTANT, place::SCALE).copy_from(&-since.by_scale);
        let walk = Matrix3::identity() * since.walk + since.stamps;
        noise.fixed_view_mut::<3, 3>(place::CONSTANT, place::CONSTANT).copy_from(&walk);
        Prediction { transition, noise }
    }

    fn observe(&self) -> Observation<STATES, 3> {
        let mut matrix = Self::prediction_rows();
        matrix.fixed_view_mut::<3, 3>(0, place::CONSTANT).copy_from(&self.a_m.inverse().matrix());
        let mismatch = self.predicted() * self.deformation().inverse();
        Observation {
            residual: -mismatch.log().column(),
            matrix,
            noise: Matrix3::identity() * self.grade.matching_variance() + self.stamp_noise(),
        }
    }

    fn inject(&mut self, error: &ErrorState) {
        let three = |place: usize| Vec3::<Main>::from_column(error.fixed_rows::<3>(place).into());
        self.static_part = Rot::<Main, Main>::exp(three(place::STATIC)) * self.static_part;
        self.static_rate += three(place::STATIC_RATE);
        for (which, (angle, rate)) in MODES.into_iter().enumerate() {
            self.theta[which] += error.fixed_rows::<3>(angle);
            self.theta_rate[which] += error.fixed_rows::<3>(rate);
        }
        let eta = three(place::CONSTANT).relabel::<MainStart>();
        self.constant = Rot::<MainStart, MainStart>::exp(-eta) * self.constant;
        self.bias += three(place::BIAS);
        self.wander += three(place::WANDER);
        self.scale += error.fixed_rows::<6>(place::SCALE);
    }
}

#[cfg(test)]
mod tests;
