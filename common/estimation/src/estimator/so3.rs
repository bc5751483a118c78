//! The fast stage: registration by motion, then the filter of [`crate::matching::so3`], with an output at every pair.

use super::adoption::Adoption;
use super::{REGISTRATION_DOUBT, Settings, deck, guess, row_major};
use crate::Estimator;
use crate::align::{Register, Registrar, Registration};
use crate::filter::{kalman, symmetrise};
use crate::matching::so3::{Covariance, Increment, STATES, So3, place};
use crate::matching::{Matching, STATIC_RATE_SIGMA};
use frames::{Main, MainStart, Rot, Sub, SubStart, Vec3, unit};
use messages::{Flags, FlexureParams, ImuPair, Solution};
use nalgebra::{Matrix3, SMatrix, Vector3};

/// While the filter runs, the registration by motion is worked out so often, ns.
const REGISTER_AGAIN_NS: i64 = 10_000_000_000;
/// Registration by motion takes at least so long, s.
const LEAST_REGISTRATION_S: f64 = 5.0;
/// A registration as good as this is not waited for any longer.
const GOOD_REGISTRATION: f64 = 0.5 * unit::DEGREE;
/// The published range in standard deviations: 95 % of a normal error.
const RANGE: f64 = 1.96;
/// A covariance beyond this (1 rad^2) says nothing of a rotation any more.
const LOST: f64 = 1.0;
/// No hull bends more than this (3 degrees, rad); what an identifier takes for more is a coarse unit's error.
const LARGEST_FLEXURE: f64 = 0.05;
/// Beyond this standard deviation (rad) the constant is not worth keeping.
const BROKEN: f64 = 0.1;

/// The estimator of one area.
#[derive(Clone, Debug)]
pub struct So3Estimator {
    settings: Settings,
    phase: Phase,
    /// Goes on collecting when the filter runs: what the motion alone says of the installation.
    registrar: Registrar,
    registered: Option<Registration>,
    registered_ns: i64,
    adoption: Adoption,
    /// Flags that the next solution carries.
    news: Flags,
}

#[derive(Clone, Debug)]
enum Phase {
    Registering { since_ns: Option<i64> },
    Running(Box<Running>),
}

/// The filter at work.
#[derive(Clone, Debug)]
struct Running {
    so3: So3,
    p: Covariance,
    flags: Flags,
    last_ns: Option<i64>,
    good: Option<Good>,
    /// Whether the last pair had no data.
    coasting: bool,
}

/// The last pair that had data.
#[derive(Clone, Copy, Debug)]
struct Good {
    epoch: u64,
    time_ns: i64,
    a_m: Rot<MainStart, Main>,
}

fn registrar(settings: &Settings) -> Registrar {
    Registrar::new(settings.grade.scale_variance())
}

impl So3Estimator {
    /// An estimator that has seen nothing yet.
    pub fn new(settings: Settings) -> Self {
        Self {
            settings,
            registrar: registrar(&settings),
            registered: None,
            registered_ns: i64::MIN,
            phase: Phase::Registering { since_ns: None },
            adoption: Adoption::new(),
            news: Flags::empty(),
        }
    }

    fn adopt(&mut self) {
        if let (Some(flexure), Phase::Running(running)) = (self.adoption.flexure(), &mut self.phase) {
            let least = self.settings.grade.least_flexure();
            running.so3.set_flexure(flexure.map(|axis| axis.bounded(least, LARGEST_FLEXURE)));
        }
    }

    /// Collects motion until it shows the installation; then the filter starts with this pair.
    fn register(&mut self, pair: &ImuPair) {
        let time_ns = pair.header.time_ns;
        self.registrar.add(pair);
        let Phase::Registering { since_ns } = &mut self.phase else {
            if time_ns - self.registered_ns >= REGISTER_AGAIN_NS {
                self.registered = self.registrar.solve().filter(Registration::is_observable).or(self.registered);
                self.registered_ns = time_ns;
            }
            return;
        };
        let waited_s = unit::seconds(time_ns - *since_ns.get_or_insert(time_ns));
        if waited_s < LEAST_REGISTRATION_S || pair.flags.contains(Flags::GAP) {
            return;
        }
        let found = self.registrar.solve().filter(Registration::is_observable);
        let timed_out = waited_s >= self.settings.registration_s;
        let running = match (found, self.settings.installation) {
            (Some(found), _) if timed_out || found.largest_sigma() < GOOD_REGISTRATION => {
                self.start(found, Flags::empty())
            }
            (None, Some(installation)) if timed_out => {
                let surveyed = Registration {
                    rotation: installation.rotation,
                    covariance: Matrix3::identity() * (installation.sigma.powi(2) / REGISTRATION_DOUBT),
                    bias: Vec3::ZERO,
                    bias_sigma: Vector3::from_element(f64::INFINITY),
                    residual_rate: self.registrar.solve().map_or(Vector3::zeros(), |seen| seen.residual_rate),
                    ratio: 0.0,
                };
                self.start(surveyed, Flags::INSTALLATION | Flags::UNOBSERVABLE)
            }
            (None, None) if timed_out => {
                self.news |= Flags::UNOBSERVABLE;
                return;
            }
            _ => return,
        };
        (self.registered, self.registered_ns) = (found, time_ns);
        self.phase = Phase::Running(Box::new(running));
        self.adopt();
    }

    fn start(&self, from: Registration, flags: Flags) -> Running {
        let grade = self.settings.grade;
        let flexure = self.settings.flexure.unwrap_or_else(|| guess(&from.residual_rate));
        let specified = grade.bias_variance();
        let mut p = Covariance::zeros();
        p.fixed_view_mut::<3, 3>(place::STATIC, place::STATIC).copy_from(&(from.covariance * REGISTRATION_DOUBT));
        p.fixed_view_mut::<6, 6>(place::SCALE, place::SCALE).copy_from(&grade.scale_covariance(from.rotation));
        let mut bias = Vector3::zeros();
        for axis in 0..3 {
            p[(place::STATIC_RATE + axis, place::STATIC_RATE + axis)] = STATIC_RATE_SIGMA.powi(2);
            flexure[axis].place_stationary(place::FLEXURE + axis, place::FLEXURE_RATE + axis, &mut p);
            // what the registration saw of the bias counts only where the specification is the wider one
            let seen = from.bias_sigma[axis].powi(2) * REGISTRATION_DOUBT;
            let trust = if seen.is_finite() { specified / (specified + seen) } else { 0.0 };
            bias[axis] = trust * from.bias.array()[axis];
            p[(place::BIAS + axis, place::BIAS + axis)] = specified * (1.0 - trust);
            p[(place::WANDER + axis, place::WANDER + axis)] = grade.wander_variance();
        }
        let so3 = So3::new(grade, flexure, from.rotation, Vec3::from_column(bias));
        Running { so3, p, flags, last_ns: None, good: None, coasting: true }
    }

    fn publish(&self, pair: &ImuPair, running: Option<&Running>, flags: Flags) -> Solution {
        let mut solution = Solution {
            header: pair.header,
            params_id: self.adoption.id(),
            epoch: pair.epoch,
            area: self.settings.area,
            flags,
            ..Solution::default()
        };
        let Some(running) = running else { return solution };
        let (so3, p) = (&running.so3, &running.p);
        let coasting = flags.contains(Flags::COASTING);
        let deformation = if coasting { so3.predicted() } else { so3.deformation() };
        let (mut rows, noise) = if coasting {
            (So3::prediction_rows(), Matrix3::zeros())
        } else {
            (so3.deformation_rows(), so3.deformation_noise())
        };
        let triad = Matrix3::identity() * self.settings.grade.triad_variance();
        let covariance = rows * p * rows.transpose() + noise + triad;
        rows.fixed_view_mut::<3, 3>(0, place::STATIC).copy_from(&if coasting {
            Matrix3::zeros()
        } else {
            Matrix3::identity()
        });
        let dynamic_covariance = rows * p * rows.transpose() + noise;
        let static_covariance = p.fixed_view::<3, 3>(place::STATIC, place::STATIC) + triad;

        solution.q = deformation.quaternion();
        solution.static_q = so3.static_part().quaternion();
        solution.constant = so3.constant().quaternion();
        solution.phi = deformation.log().array();
        solution.dynamic = (deformation * so3.static_part().inverse()).log().array();
        solution.rate = so3.rate().array();
        solution.drift = so3.drift().array();
        solution.scale = so3.scale();
        solution.covariance = row_major(&covariance);
        solution.static_covariance = row_major(&static_covariance);
        solution.dynamic_covariance = row_major(&dynamic_covariance);
        if let Some(registered) = &self.registered {
            solution.registered = registered.rotation.quaternion();
            solution.registered_sigma = registered.covariance.diagonal().map(f64::sqrt).into();
        }
        solution.range = covariance.diagonal().map(|v| RANGE * v.sqrt()).into();
        solution.valid = u32::from(!coasting && covariance.diagonal().max() < LOST);
        deck(&mut solution, pair, deformation, &covariance);
        solution
    }
}

impl Estimator for So3Estimator {
    fn offer(&mut self, params: FlexureParams) {
        if self.adoption.offer(params) {
            self.news |= Flags::LATE;
        }
    }

    fn step(&mut self, pair: &ImuPair) -> Solution {
        self.adoption.advance(pair.header.time_ns);
        self.adopt();
        self.register(pair);
        let mut flags = pair.flags;
        if self.adoption.id() == 0 && self.settings.flexure.is_none() {
            flags |= Flags::PRIOR;
        }
        if let Phase::Running(running) = &mut self.phase
            && running.step(pair, &self.settings).is_none()
        {
            self.phase = Phase::Registering { since_ns: None };
            self.registrar = registrar(&self.settings);
            self.news |= Flags::RESET;
        }
        flags |= std::mem::take(&mut self.news);
        match &self.phase {
            Phase::Registering { .. } => self.publish(pair, None, flags | Flags::REGISTERING),
            Phase::Running(running) => {
                let coasting = if running.coasting { Flags::COASTING } else { Flags::empty() };
                self.publish(pair, Some(running), flags | running.flags | coasting)
            }
        }
    }
}

impl Running {
    /// Takes in a pair; `None` when the numbers have become useless.
    fn step(&mut self, pair: &ImuPair, settings: &Settings) -> Option<()> {
        let time_ns = pair.header.time_ns;
        let since = |before_ns: i64| unit::seconds(time_ns - before_ns).max(0.0);
        self.so3.coast(self.last_ns.map_or(0.0, since));
        self.last_ns = Some(time_ns);
        let due = self.so3.pending_s() >= 1.0 / settings.filter_hz - 0.5 * settings.interval_s;
        self.coasting = pair.flags.contains(Flags::GAP);
        if self.coasting {
            if due {
                self.predict();
            }
            return self.is_sound();
        }
        let a_m = Rot::from_wxyz(pair.attitude_m);
        let a_s = Rot::from_wxyz(pair.attitude_s);
        match self.good {
            Some(good) if good.epoch == pair.epoch => {
                // from the accumulated attitudes, so that a pair lost on the way loses only time
                let dtheta_m = (good.a_m.inverse() * a_m).log();
                let time_s = since(good.time_ns);
                self.so3.advance(&Increment { a_m, a_s, dtheta_m, time_s, disturbance: pair.disturbance });
                if due {
                    self.predict();
                    if self.chain_is_broken() {
                        self.start_epoch(a_m, a_s);
                    }
                    let seen = self.so3.observe();
                    let error = kalman::update(&mut self.p, &seen.residual, &seen.matrix, &seen.noise)?;
                    self.so3.inject(&error);
                }
            }
            _ => {
                self.predict();
                self.start_epoch(a_m, a_s);
            }
        }
        self.good = Some(Good { epoch: pair.epoch, time_ns, a_m });
        self.is_sound()
    }

    /// Forgets the constant: it is defined anew by what static part and flexure are believed to be.
    fn start_epoch(&mut self, a_m: Rot<MainStart, Main>, a_s: Rot<SubStart, Sub>) {
        let transition = self.so3.start_epoch(a_m, a_s);
        self.p = transition * self.p * transition.transpose();
        symmetrise(&mut self.p);
    }

    /// Whether the constant is known so badly that a linear update would do harm, and worse than what it could be defined by.
    fn chain_is_broken(&self) -> bool {
        let trace = |rows: SMatrix<f64, 3, STATES>| (rows * self.p * rows.transpose()).trace();
        let chain = trace(self.so3.deformation_rows());
        chain > BROKEN * BROKEN && chain > 4.0 * trace(So3::prediction_rows())
    }

    fn predict(&mut self) {
        let prediction = self.so3.propagate();
        self.p = prediction.transition * self.p * prediction.transition.transpose() + prediction.noise;
        symmetrise(&mut self.p);
    }

    fn is_sound(&self) -> Option<()> {
        let diagonal = self.p.diagonal();
        (diagonal.iter().all(|v| v.is_finite() && *v >= 0.0) && self.so3.deformation().log().is_finite()).then_some(())
    }
}
