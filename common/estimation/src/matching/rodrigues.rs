//! Velocity and rate matching in inertial space, with the Rodrigues parameters of the installation.
//!
//! Source: paper 000 section 4.3, eqs 54-78. The frames are the units' own, frozen at the filter's start: `im` (MainStart), `is` (SubStart).
//!
//! | state | size | place | moves by |
//! |---|---|---|---|
//! | `l`: `C_im^is = (I + l x)^-1 (I - l x)`, eq 67 | 3 | 0 | constant |
//! | `dV`: error of the sub unit's velocity, m/s, in is | 3 | 3 | tilt and accelerometer bias, eq 71 |
//! | `ph`: `C_s^is = (I + ph x) C^_s^is`, rad, eq 60 | 3 | 6 | gyro bias |
//! | `eps`: relative gyro bias, sub minus main, rad/s, in s | 3 | 9 | constant |
//! | `nab`: relative accelerometer bias, m/s^2, in s | 3 | 12 | constant |
//! | `Vr`: velocity that the bending lever arm adds, m/s, in im | 3 | 15 | flexure |
//! | flexure `theta`, rad, its rate, rad/s, in m | 3 + 3 | 18 | second-order Gauss-Markov, exact |
//!
//! Corrections to the printed equations:
//! * `l` holds the misalignment AT the start, so it contains `theta(0)`. The deformation is the chain `C_m^im(t)^T C(l)^T (I + ph x) C^_s^is(t)`;
//!   the sum `2 l + theta` of the paper is off by `theta(0)` and kept as [`Output::Sum`].
//! * eqs 54, 61: `dw/dt x r` is never formed from gyro data. The rigid arm's velocity is the boundary term `C_m^im (w x r0)`, with `w` at the
//!   sample's end; the bending arm's is `Vr = [C_m^im (w x L0 theta + L0 theta')]` between the same limits, which is eqs 55, 56, 71, 75 integrated, for
//!   any damping (the printed `L1`, `L2` hold for critical damping only).
//! * eq 74 is discretised exactly for the flexure; what drives `theta'` drives `Vr` in the same instant, and their correlation is kept.
//! * eq 78: rates are means over a sample, `theta'` stands at its end: the rate rows' noise has `Q dt / 3` added.
//! * `P(0)` ties `l` to `theta`: `2 l = Phi + theta(0)`.

use super::grade::Grade;
use super::{Accel, Matching, Model, Motion, Observation, Prediction, Start, View, three};
use crate::flexure::Flexure;
use frames::{Main, MainStart, Rot, Sub, SubStart, Vec3};
use nalgebra::{Matrix3, SMatrix, SVector, Vector3};
use serde::{Deserialize, Serialize};

/// Size of the error state.
pub const STATES: usize = 24;
/// Size of the measurement: velocity, then rate.
pub const ROWS: usize = 6;
const PARAMETERS: usize = 0;
const VELOCITY: usize = 3;
const TILT: usize = 6;
const BIAS: usize = 9;
const ACCEL_BIAS: usize = 12;
const LEVER: usize = 15;
const FLEXURE: usize = 18;
const RATE: usize = 21;

/// Biases of the accelerometers may exceed their specification, which also covers their scale and alignment.
const ACCEL_DOUBT: f64 = 2.0;
/// Noise of the velocity rows: coning and sculling of single samples, m/s.
const VELOCITY_SIGMA: f64 = 2e-4;
/// So many times as large counts an adopted flexure. The heading is seen in the ship's sway, where only the driving noise matters, but with the
/// bending lever arm a flexure that is thought too small turns into false knowledge of it. From 4 to 16 the results are the same.
const WIDER: f64 = 4.0;
/// An interval this much longer than the one before has lost samples.
const LOST_SAMPLES: f64 = 1.5;

type Block = SMatrix<f64, 3, STATES>;
type Arm = SMatrix<f64, 3, 6>;

/// What is published as the deformation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Output {
    /// The chain of both gyros' attitudes through the estimated constant.
    #[default]
    Chain,
    /// `2 l + theta`, as paper 000 has it.
    Sum,
}

/// Which use of the model.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct Options {
    /// What is published.
    pub output: Output,
    /// Whether the lever arm bends with the deck, eq 6.
    pub dynamic_lever_arm: bool,
    /// Whether an adopted flexure counts as several times as large, with the same driving noise.
    pub cautious: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self { output: Output::Chain, dynamic_lever_arm: true, cautious: true }
    }
}

/// The nominal state.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct RodriguesMatching {
    options: Options,
    grade: Grade,
    /// `None` without accelerometers.
    accel: Option<Accel>,
    lever_arm: Vector3<f64>,
    flexure: [Flexure; 3],
    x: SVector<f64, STATES>,
    a_m: Rot<MainStart, Main>,
    a_s: Rot<SubStart, Sub>,
    sample: Sample,
    /// Mean rate of the main unit over the sample before, in m.
    rate_before: Option<Vector3<f64>>,
    /// `C_m^im [w x L0, L0]`: what theta and its rate make of the lever arm's velocity now.
    arm: Arm,
    velocities: Option<Velocities>,
    pending: Pending,
}

/// Rates of the last sample, in the frozen frames.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
struct Sample {
    interval_s: f64,
    w_m: Vector3<f64>,
    w_s: Vector3<f64>,
    /// Velocity of the rigid lever arm at the sample's end; `None` where the rate there is not known.
    rigid: Option<Vector3<f64>>,
}

/// Velocities since an instant of the filter, m/s.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Velocities {
    m: Vector3<f64>,
    s: Vector3<f64>,
    /// Of the rigid lever arm at that instant.
    rigid: Vector3<f64>,
    /// [`RodriguesMatching::arm`] at the last propagation.
    arm: Arm,
}

/// What has come since the last propagation.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
struct Pending {
    time_s: f64,
    variance: f64,
    /// Integral of `C_s^is`.
    turn: Matrix3<f64>,
    /// Integral of the specific force in is.
    velocity: Vector3<f64>,
    /// Integral of `[f x]` times the integral of `C_s^is`.
    by_bias: Matrix3<f64>,
}

/// `C_is^im` of Rodrigues parameters, eq 67.
fn installation(l: &Vector3<f64>) -> Rot<MainStart, SubStart> {
    let n = l.norm();
    let factor = if n < 1e-9 { 2.0 } else { 2.0 * n.atan() / n };
    Rot::exp(Vec3::from_column(l * factor))
}

/// Rodrigues parameters of a rotation, below a half turn.
fn parameters(rotation: Rot<Main, Sub>) -> Vector3<f64> {
    let phi = rotation.log().column();
    let angle = phi.norm();
    if angle < 1e-9 { phi * 0.5 } else { phi * ((0.5 * angle).tan() / angle) }
}

/// How the rotation vector of `C_is^im` depends on its parameters, by an error on the left.
fn slope(l: &Vector3<f64>) -> Matrix3<f64> {
    (Matrix3::identity() + l.cross_matrix()) * (2.0 / (1.0 + l.norm_squared()))
}

impl RodriguesMatching {
    fn three(&self, place: usize) -> Vector3<f64> {
        three(&self.x, place)
    }

    /// Variance of what the velocity rows add of their own, m^2/s^2.
    fn velocity_variance(&self) -> f64 {
        // the rate at a sample's end comes from the means over two
        let end = 2.5 * self.grade.main.arw.powi(2) / self.sample.interval_s;
        VELOCITY_SIGMA.powi(2) + end * self.lever_arm.norm_squared()
    }

    /// The tilt now.
    fn tilt(&self) -> Vector3<f64> {
        self.three(TILT) - self.pending.turn * self.three(BIAS)
    }

    /// Flexure and rate now, and how they depend on those of the last propagation.
    fn bend(&self) -> (Vector3<f64>, Vector3<f64>, Block, Block) {
        let (mut angle, mut rate) = (Block::zeros(), Block::zeros());
        for axis in 0..3 {
            let f = self.flexure[axis].transition(self.pending.time_s);
            for (i, rows) in [&mut angle, &mut rate].into_iter().enumerate() {
                rows[(axis, FLEXURE + axis)] = f[(i, 0)];
                rows[(axis, RATE + axis)] = f[(i, 1)];
            }
        }
        (angle * self.x, rate * self.x, angle, rate)
    }

    fn advance_rates(&mut self, motion: &Motion) {
        let dt = motion.interval_s.max(f64::MIN_POSITIVE);
        let lost = self.sample.interval_s > 0.0 && dt > LOST_SAMPLES * self.sample.interval_s;
        if lost {
            self.rate_before = None;
            self.velocities = None;
        }
        let mean = motion.dtheta_m.column() / dt;
        let (half_m, half_s) = (motion.dtheta_m * 0.5, motion.dtheta_s * 0.5);
        let c_m = self.a_m.matrix();
        let middle = self.a_m * Rot::<Main, Main>::exp(-half_m);
        let end = self.rate_before.map(|before| mean * 1.5 - before * 0.5);
        self.sample = Sample {
            interval_s: if lost { self.sample.interval_s } else { dt },
            w_m: middle.matrix() * mean,
            w_s: (self.a_s * Rot::<Sub, Sub>::exp(-half_s)).matrix() * motion.dtheta_s.column() / dt,
            rigid: end.map(|w| c_m * w.cross(&self.lever_arm)),
        };
        if self.options.dynamic_lever_arm {
            let l0 = -self.lever_arm.cross_matrix();
            let w = end.unwrap_or(mean);
            self.arm.fixed_columns_mut::<3>(0).copy_from(&(c_m * w.cross_matrix() * l0));
            self.arm.fixed_columns_mut::<3>(3).copy_from(&(c_m * l0));
        }
        self.rate_before = Some(mean);
    }

    fn advance_velocities(&mut self, motion: &Motion) {
        let middle_s = (self.a_s * Rot::<Sub, Sub>::exp(motion.dtheta_s * -0.5)).matrix();
        let turn = middle_s * motion.interval_s;
        let turned = self.pending.turn + turn * 0.5;
        self.pending.time_s += motion.interval_s;
        self.pending.variance += motion.disturbance.powi(2);
        self.pending.turn += turn;
        if let Some(velocities) = &mut self.velocities {
            let dvel_s = middle_s * motion.dvel_s.column();
            let middle_m = self.a_m * Rot::<Main, Main>::exp(motion.dtheta_m * -0.5);
            velocities.m += middle_m.matrix() * motion.dvel_m.column();
            velocities.s += dvel_s;
            self.pending.velocity += dvel_s;
            self.pending.by_bias += dvel_s.cross_matrix() * turned;
        }
    }

    /// The velocity states over the pending interval; they start anew where velocities do.
    fn propagate_velocities(&mut self, pending: &Pending, prediction: &mut Prediction<STATES>) {
        let variance = self.velocity_variance();
        let Prediction { transition, noise } = prediction;
        match (&mut self.velocities, self.accel, self.sample.rigid) {
            (Some(velocities), Some(accel), _) => {
                let tilt = pending.velocity.cross_matrix();
                transition.fixed_view_mut::<3, 3>(VELOCITY, TILT).copy_from(&tilt);
                transition.fixed_view_mut::<3, 3>(VELOCITY, BIAS).copy_from(&-pending.by_bias);
                transition.fixed_view_mut::<3, 3>(VELOCITY, ACCEL_BIAS).copy_from(&pending.turn);
                let walk = accel.vrw.powi(2) * pending.time_s;
                noise.fixed_view_mut::<3, 3>(VELOCITY, VELOCITY).fill_diagonal(walk);
                let bent: SMatrix<f64, 6, 6> = transition.fixed_view::<6, 6>(FLEXURE, FLEXURE).into();
                let driven: SMatrix<f64, 6, 6> = noise.fixed_view::<6, 6>(FLEXURE, FLEXURE).into();
                let with = self.arm * driven;
                transition.fixed_view_mut::<3, 6>(LEVER, FLEXURE).copy_from(&(self.arm * bent - velocities.arm));
                noise.fixed_view_mut::<3, 6>(LEVER, FLEXURE).copy_from(&with);
                noise.fixed_view_mut::<6, 3>(FLEXURE, LEVER).copy_from(&with.transpose());
                noise.fixed_view_mut::<3, 3>(LEVER, LEVER).copy_from(&(with * self.arm.transpose()));
                velocities.arm = self.arm;
            }
            (None, Some(_), Some(rigid)) => {
                transition.fixed_view_mut::<3, STATES>(VELOCITY, 0).fill(0.0);
                transition.fixed_view_mut::<3, STATES>(LEVER, 0).fill(0.0);
                noise.fixed_view_mut::<3, 3>(VELOCITY, VELOCITY).fill_diagonal(variance);
                let zero = Vector3::zeros();
                self.velocities = Some(Velocities { m: zero, s: zero, rigid, arm: self.arm });
            }
            _ => {}
        }
    }

    /// 000 eq 78: three rows from the two units' vectors, what the sub unit's lacks and what the deck adds to the main unit's. Gives the residual and
    /// its derivative by `l`.
    fn compare(
        &self,
        s: Vector3<f64>,
        m: Vector3<f64>,
        lacks: Vector3<f64>,
        adds: Vector3<f64>,
    ) -> (Vector3<f64>, Matrix3<f64>) {
        let l = self.three(PARAMETERS);
        let turn = s + m - lacks + adds;
        (s - m - turn.cross(&l) - lacks - adds, turn.cross_matrix())
    }

    fn observe_velocity(&self, velocities: &Velocities, rigid: Vector3<f64>, seen: &mut Observation<STATES, ROWS>) {
        let l = self.three(PARAMETERS).cross_matrix();
        let v_m = velocities.m + rigid - velocities.rigid;
        let (residual, slope) = self.compare(velocities.s, v_m, self.three(VELOCITY), self.three(LEVER));
        seen.residual.fixed_rows_mut::<3>(0).copy_from(&residual);
        seen.matrix.fixed_view_mut::<3, 3>(0, PARAMETERS).copy_from(&slope);
        seen.matrix.fixed_view_mut::<3, 3>(0, VELOCITY).copy_from(&(Matrix3::identity() + l));
        seen.matrix.fixed_view_mut::<3, 3>(0, LEVER).copy_from(&(Matrix3::identity() - l));
        seen.noise.fixed_view_mut::<3, 3>(0, 0).fill_diagonal(self.velocity_variance());
    }
}

impl Matching<STATES, ROWS> for RodriguesMatching {
    // 000 eqs 74-77, over the filter's interval
    fn propagate(&mut self) -> Prediction<STATES> {
        let pending = std::mem::take(&mut self.pending);
        let mut prediction: Prediction<STATES> =
            Prediction { transition: SMatrix::identity(), noise: SMatrix::zeros() };
        let Prediction { transition, noise } = &mut prediction;
        transition.fixed_view_mut::<3, 3>(TILT, BIAS).copy_from(&-pending.turn);
        noise
            .fixed_view_mut::<3, 3>(TILT, TILT)
            .fill_diagonal(self.grade.arw_density() * pending.time_s + pending.variance);
        for axis in 0..3 {
            self.flexure[axis].place(pending.time_s, FLEXURE + axis, RATE + axis, transition, noise);
        }
        self.propagate_velocities(&pending, &mut prediction);
        self.x = prediction.transition * self.x;
        prediction
    }

    // 000 eq 78
    fn observe(&self) -> Observation<STATES, ROWS> {
        let mut seen = Observation { residual: SVector::zeros(), matrix: SMatrix::zeros(), noise: SMatrix::identity() };
        if let (Some(velocities), Some(rigid)) = (&self.velocities, self.sample.rigid) {
            self.observe_velocity(velocities, rigid, &mut seen);
        }
        let Sample { interval_s, w_m, w_s, .. } = self.sample;
        let l = self.three(PARAMETERS).cross_matrix();
        let (plus, minus) = (Matrix3::identity() + l, Matrix3::identity() - l);
        let (c_m, c_s) = (self.a_m.matrix(), self.a_s.matrix());
        let lacks = w_s.cross(&self.three(TILT)) + c_s * self.three(BIAS);
        let (residual, slope) = self.compare(w_s, w_m, lacks, c_m * self.three(RATE));
        seen.residual.fixed_rows_mut::<3>(3).copy_from(&residual);
        seen.matrix.fixed_view_mut::<3, 3>(3, PARAMETERS).copy_from(&slope);
        seen.matrix.fixed_view_mut::<3, 3>(3, TILT).copy_from(&(plus * w_s.cross_matrix()));
        seen.matrix.fixed_view_mut::<3, 3>(3, BIAS).copy_from(&(plus * c_s));
        seen.matrix.fixed_view_mut::<3, 3>(3, RATE).copy_from(&(minus * c_m));
        let density = self.flexure.iter().map(Flexure::density).fold(0.0, f64::max);
        let variance = self.grade.arw_density() / interval_s + density * interval_s / 3.0;
        seen.noise.fixed_view_mut::<3, 3>(3, 3).fill_diagonal(variance);
        seen
    }

    fn inject(&mut self, error: &SVector<f64, STATES>) {
        self.x += error;
    }
}

impl Model<STATES, ROWS> for RodriguesMatching {
    type Options = Options;

    fn begin(options: &Options, start: &Start) -> (Self, SMatrix<f64, STATES, STATES>) {
        let accel = (start.accel.vrw > 0.0 || start.accel.bias > 0.0).then_some(start.accel);
        let l = parameters(start.rotation);
        let mut x = SVector::<f64, STATES>::zeros();
        x.fixed_rows_mut::<3>(PARAMETERS).copy_from(&l);
        let mut p = SMatrix::<f64, STATES, STATES>::zeros();
        let bent = Matrix3::from_diagonal(&Vector3::from_fn(|axis, _| start.flexure[axis].stationary()[(0, 0)]));
        let rate = Matrix3::from_diagonal(&Vector3::from_fn(|axis, _| start.flexure[axis].stationary()[(1, 1)]));
        // (I + l x) of eq 67 has the inverse (I - l x + l l^T) / (1 + l^2)
        let back = (Matrix3::identity() - l.cross_matrix() + l * l.transpose()) * 0.5;
        let with = back * bent;
        p.fixed_view_mut::<3, 3>(PARAMETERS, PARAMETERS)
            .copy_from(&(back * (start.covariance + bent) * back.transpose()));
        p.fixed_view_mut::<3, 3>(PARAMETERS, FLEXURE).copy_from(&with);
        p.fixed_view_mut::<3, 3>(FLEXURE, PARAMETERS).copy_from(&with.transpose());
        p.fixed_view_mut::<3, 3>(FLEXURE, FLEXURE).copy_from(&bent);
        p.fixed_view_mut::<3, 3>(RATE, RATE).copy_from(&rate);
        p.fixed_view_mut::<3, 3>(BIAS, BIAS).fill_diagonal(start.grade.bias_variance());
        let accel_bias = start.accel.bias * ACCEL_DOUBT;
        p.fixed_view_mut::<3, 3>(ACCEL_BIAS, ACCEL_BIAS).fill_diagonal(accel_bias * accel_bias);
        let model = Self {
            options: *options,
            grade: start.grade,
            accel,
            lever_arm: start.lever_arm.column(),
            flexure: start.flexure,
            x,
            a_m: Rot::identity(),
            a_s: Rot::identity(),
            sample: Sample::default(),
            rate_before: None,
            arm: Arm::zeros(),
            velocities: None,
            pending: Pending::default(),
        };
        (model, p)
    }

    fn advance(&mut self, motion: &Motion) {
        (self.a_m, self.a_s) = (motion.a_m, motion.a_s);
        self.advance_rates(motion);
        self.advance_velocities(motion);
    }

    fn set_flexure(&mut self, flexure: [Flexure; 3]) {
        self.flexure = if self.options.cautious { flexure.map(|axis| axis.widened(WIDER)) } else { flexure };
    }

    fn view(&self) -> View<STATES> {
        let l = self.three(PARAMETERS);
        let installed = installation(&l);
        let (theta, rate, angle_rows, rate_rows) = self.bend();
        let bend = Rot::<Main, Main>::exp(Vec3::from_column(theta));
        let constant = installed * Rot::<SubStart, SubStart>::exp(Vec3::from_column(self.tilt()));
        let chain: Rot<Main, Sub> = self.a_m.inverse() * constant * self.a_s;
        let a_m = self.a_m.inverse().matrix();
        let by_tilt = a_m * installed.matrix();
        let mut rows = Block::zeros();
        let (deformation, static_part, static_rows);
        match self.options.output {
            Output::Chain => {
                rows.fixed_view_mut::<3, 3>(0, PARAMETERS).copy_from(&(a_m * slope(&l)));
                rows.fixed_view_mut::<3, 3>(0, TILT).copy_from(&by_tilt);
                rows.fixed_view_mut::<3, 3>(0, BIAS).copy_from(&(-by_tilt * self.pending.turn));
                (deformation, static_part, static_rows) = (chain, bend.inverse() * chain, rows - angle_rows);
            }
            Output::Sum => {
                rows.fixed_view_mut::<3, 3>(0, PARAMETERS).copy_from(&slope(&l));
                let whole: Rot<Main, Sub> = installed.relabel();
                (deformation, static_part, static_rows) = (bend * whole, whole, rows);
                rows += angle_rows;
            }
        }
        View {
            deformation,
            rows,
            noise: Matrix3::identity()
                * (self.grade.arw_density() * self.pending.time_s
                    + self.pending.variance
                    + self.grade.triad_variance()),
            static_part,
            static_rows,
            rate: Vec3::from_column(rate),
            rate_rows,
            drift: -(chain * Vec3::<Sub>::from_column(self.three(BIAS))),
            delay: None,
            skew: None,
        }
    }
}

#[cfg(test)]
mod tests;
