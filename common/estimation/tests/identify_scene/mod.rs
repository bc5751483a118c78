//! A swaying ship with a bending deck, as the identifier sees it: pairs and solutions.
#![allow(dead_code, clippy::unwrap_used)]

use estimation::flexure::Flexure;
use frames::{Euler, Main, MainStart, Nav, Rot, Sub, SubStart, Vec3, unit};
use messages::{ImuPair, Solution};
use nalgebra::{Matrix2, Vector2};
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64;

/// The critical flexure of paper 000: 1/e after 10, 10, 30 s, standard deviations 6, 6, 10 arcmin.
pub fn critical() -> [Flexure; 3] {
    let axis = |time: f64, arcmin: f64| Flexure { mu: 2.146 / time, b: 2.146 / time, sigma: arcmin * unit::ARCMIN };
    [axis(10.0, 6.0), axis(10.0, 6.0), axis(30.0, 10.0)]
}

/// The under-damped truth that the methods are compared on.
pub fn under_damped() -> [Flexure; 3] {
    let axis = |mu: f64, b: f64, arcmin: f64| Flexure { mu, b, sigma: arcmin * unit::ARCMIN };
    [axis(0.1, 0.6, 6.0), axis(0.12, 0.5, 6.0), axis(0.08, 0.4, 10.0)]
}

/// What is simulated.
#[derive(Clone, Copy)]
pub struct Scene {
    pub flexure: [Flexure; 3],
    pub interval_s: f64,
    pub arw_deg_per_sqrt_h: f64,
    /// Error of the solution's constant, arcmin.
    pub wrong_arcmin: [f64; 3],
    /// Bias of the sub unit's gyros, rad/s, in s.
    pub bias_s: [f64; 3],
    /// Whether the solution knows the bias.
    pub drift_known: bool,
    pub seed: u64,
}

impl Scene {
    pub fn new(flexure: [Flexure; 3], seed: u64) -> Self {
        let (wrong_arcmin, bias_s) = ([0.0; 3], [0.0; 3]);
        Self { flexure, interval_s: 0.1, arw_deg_per_sqrt_h: 0.001, wrong_arcmin, bias_s, drift_known: false, seed }
    }

    /// Pairs and solutions from time 0 on.
    pub fn run(self) -> Run {
        let mut rng = Pcg64::seed_from_u64(self.seed);
        let axes = self.flexure.map(|model| Axis::start(&model, self.interval_s, &mut rng));
        let interval_ns = unit::nanoseconds(self.interval_s);
        let start = ship(0.0);
        let fixed: Rot<Main, Sub> = Rot::exp(Vec3::new(0.02, -0.015, 0.03));
        let theta: Vec3<Main> = Vec3::new(axes[0].state[0], axes[1].state[0], axes[2].state[0]);
        let constant = (Rot::<Main, Main>::exp(theta) * fixed).relabel();
        Run {
            scene: self,
            rng,
            axes,
            interval_ns,
            start,
            fixed,
            constant,
            last: None,
            attitude_m: Rot::identity(),
            attitude_s: Rot::identity(),
            sequence: 0,
        }
    }
}

struct Axis {
    state: Vector2<f64>,
    transition: Matrix2<f64>,
    root: Matrix2<f64>,
}

impl Axis {
    fn start(model: &Flexure, step: f64, rng: &mut Pcg64) -> Self {
        let state = model.stationary().map(f64::sqrt) * normal2(rng);
        let root = model.noise(step).cholesky().unwrap().l();
        Self { state, transition: model.transition(step), root }
    }

    fn step(&mut self, rng: &mut Pcg64) {
        self.state = self.transition * self.state + self.root * normal2(rng);
    }
}

fn normal2(rng: &mut Pcg64) -> Vector2<f64> {
    Vector2::new(StandardNormal.sample(rng), StandardNormal.sample(rng))
}

/// Sway of 10 degrees: roll and pitch in 8 s, heading in 10 s.
fn ship(t: f64) -> Rot<Nav, Main> {
    let wave = |period: f64| 10.0 * unit::DEGREE * (std::f64::consts::TAU * t / period).sin();
    Euler { roll: wave(8.0), pitch: wave(8.0), heading: 45.0 * unit::DEGREE + wave(10.0) }.rotation()
}

/// A running scene.
pub struct Run {
    scene: Scene,
    rng: Pcg64,
    axes: [Axis; 3],
    interval_ns: i64,
    start: Rot<Nav, Main>,
    fixed: Rot<Main, Sub>,
    constant: Rot<MainStart, SubStart>,
    last: Option<(Rot<MainStart, Main>, Rot<SubStart, Sub>)>,
    attitude_m: Rot<MainStart, Main>,
    attitude_s: Rot<SubStart, Sub>,
    sequence: u64,
}

impl Run {
    fn noise<F: frames::Frame>(&mut self) -> Vec3<F> {
        let size = self.scene.arw_deg_per_sqrt_h * unit::DEG_PER_SQRT_H * self.scene.interval_s.sqrt();
        let mut next = || StandardNormal.sample(&mut self.rng);
        let (x, y, z): (f64, f64, f64) = (next(), next(), next());
        Vec3::new(x, y, z) * size
    }

    /// The pair and the solution of the next instant; the solution's constant follows the true one with a fixed error.
    pub fn next(&mut self) -> (ImuPair, Solution) {
        let time_ns = self.sequence as i64 * self.interval_ns;
        let true_m: Rot<MainStart, Main> = (self.start.inverse() * ship(unit::seconds(time_ns))).relabel();
        if self.sequence > 0 {
            let Self { axes, rng, .. } = self;
            axes.iter_mut().for_each(|axis| axis.step(rng));
        }
        let theta: Vec3<Main> = Vec3::new(self.axes[0].state[0], self.axes[1].state[0], self.axes[2].state[0]);
        let total: Rot<Main, Sub> = Rot::exp(theta) * self.fixed;
        let true_s: Rot<SubStart, Sub> = self.constant.inverse() * true_m * total;
        if let Some((last_m, last_s)) = self.last {
            let bias: Vec3<Sub> = Vec3::from(self.scene.bias_s) * self.scene.interval_s;
            let (noise_m, noise_s) = (self.noise(), self.noise());
            let increment_m: Rot<Main, Main> = last_m.inverse() * true_m;
            let increment_s: Rot<Sub, Sub> = last_s.inverse() * true_s;
            self.attitude_m = (self.attitude_m * increment_m * Rot::<Main, Main>::exp(noise_m)).normalised();
            self.attitude_s = (self.attitude_s * increment_s * Rot::<Sub, Sub>::exp(bias + noise_s)).normalised();
        }
        self.last = Some((true_m, true_s));
        let messages = self.messages(time_ns, total, theta);
        self.sequence += 1;
        messages
    }

    fn messages(&self, time_ns: i64, total: Rot<Main, Sub>, theta: Vec3<Main>) -> (ImuPair, Solution) {
        let mut pair = ImuPair { interval_ns: self.interval_ns, epoch: 0, ..ImuPair::default() };
        (pair.header.run_id, pair.header.sequence, pair.header.time_ns) = (7, self.sequence, time_ns);
        pair.attitude_m = self.attitude_m.quaternion();
        pair.attitude_s = self.attitude_s.quaternion();
        let wrong: Rot<Main, Main> = Rot::exp(Vec3::from(self.scene.wrong_arcmin) * unit::ARCMIN);
        let constant: Rot<MainStart, SubStart> = self.attitude_m * wrong * total * self.attitude_s.inverse();
        let mut solution = Solution { header: pair.header, valid: 1, ..Solution::default() };
        solution.q = total.quaternion();
        solution.static_q = self.fixed.quaternion();
        solution.constant = constant.quaternion();
        solution.dynamic = theta.array();
        if self.scene.drift_known {
            solution.drift = (self.fixed * -Vec3::<Sub>::from(self.scene.bias_s)).array();
        }
        (pair, solution)
    }

    /// Changes the error of the constants from now on, arcmin.
    pub fn mislead(&mut self, wrong_arcmin: [f64; 3]) {
        self.scene.wrong_arcmin = wrong_arcmin;
    }
}
