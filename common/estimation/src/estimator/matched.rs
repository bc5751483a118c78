//! Any matching model with any filter: registration, propagation at each pair, an update at the filter's rate, an output at each pair.

use super::adoption::Adoption;
use super::{REGISTRATION_DOUBT, Settings, attitude_of_deck, guess, row_major};
use crate::align::{Register, Registration};
use crate::evaluate::{Evaluate, Evidence, Kept};
use crate::filter::{Filter, symmetrise};
use crate::flexure::Flexure;
use crate::matching::{Accel, Model, Motion, Prediction, Start, View};
use crate::state;
use crate::{Estimator, Frozen, StateError};
use frames::{Main, MainStart, Rot, Sub, SubStart, Vec3, unit};
use messages::{Flags, FlexureParams, ImuPair, Solution};
use nalgebra::{Matrix3, SMatrix};
use serde::{Deserialize, Serialize};

/// The flexure that is assumed while none is told or identified.
const BROAD: Flexure = Flexure { mu: 0.3, b: 0.6, sigma: 10.0 * unit::ARCSEC };
/// By how much larger a guessed flexure may be than its rate tells, as it would be if it were slower: too small a flexure is false
/// knowledge for a model that also sees the angle.
const WIDER: f64 = 4.0;
/// A covariance beyond this (1 rad^2) says nothing of a rotation any more.
const LOST: f64 = 1.0;
/// Standard deviation of the total above which the solution is not offered for use, rad.
const USABLE: f64 = 0.1;

/// Makes a registration that has seen nothing yet.
pub type MakeRegister = fn(&Settings) -> Box<dyn Register>;

/// Settings of [`Matched`].
pub struct MatchedSettings<O> {
    /// What every estimator of an area is told.
    pub area: Settings,
    /// Accelerometers of both units.
    pub accel: Accel,
    /// From the main to the sub unit, m.
    pub lever_arm: Vec3<Main>,
    /// The filter.
    pub filter: Filter,
    /// How the installation is first found; `None` starts from the surveyed installation with the first pair.
    pub registration: Option<MakeRegister>,
    /// Which use of the model.
    pub options: O,
}

/// The estimator of one area by a model `M` of `N` error states and `K` measurements.
pub struct Matched<M: Model<N, K>, const N: usize, const K: usize> {
    settings: MatchedSettings<M::Options>,
    evaluation: Box<dyn Evaluate>,
    registration: Option<Box<dyn Register>>,
    since_ns: Option<i64>,
    adoption: Adoption,
    running: Option<Running<M, N>>,
    news: Flags,
}

#[derive(Clone, Serialize, Deserialize)]
struct Running<M, const N: usize> {
    model: M,
    p: SMatrix<f64, N, N>,
    /// What the model says after the last pair taken in.
    view: View<N>,
    /// Covariance of the total by the error state alone, rad^2.
    covariance: Matrix3<f64>,
    epoch: u64,
    begin_ns: i64,
    last_ns: i64,
    updated_ns: i64,
    start_m: Rot<MainStart, Main>,
    start_s: Rot<SubStart, Sub>,
    w_im_m: Vec3<Main>,
}

/// What another estimator of the same settings goes on from.
#[derive(Serialize, Deserialize)]
struct State<M, const N: usize> {
    evaluation: Kept,
    since_ns: Option<i64>,
    adoption: Adoption,
    running: Running<M, N>,
    news: Flags,
}

impl<M: Model<N, K>, const N: usize, const K: usize> Matched<M, N, K> {
    /// An estimator that has seen nothing yet.
    pub fn new(settings: MatchedSettings<M::Options>, evaluation: Box<dyn Evaluate>) -> Self {
        Self {
            registration: settings.registration.map(|make| make(&settings.area)),
            settings,
            evaluation,
            since_ns: None,
            adoption: Adoption::new(),
            running: None,
            news: Flags::empty(),
        }
    }

    /// The filter starts with a pair, once registration has taken its time.
    fn register(&mut self, pair: &ImuPair) {
        let time_ns = pair.header.time_ns;
        let area = &self.settings.area;
        let (rotation, covariance, broad) = match &mut self.registration {
            None => {
                let Some(told) = area.installation else { return };
                // a flexure smaller than the doubt about the installation would be false knowledge too
                let broad = Flexure { sigma: BROAD.sigma.max(told.sigma), ..BROAD };
                (told.rotation, Matrix3::identity() * told.sigma.powi(2), [broad; 3])
            }
            Some(registration) => {
                registration.add(pair);
                let waited_s = unit::seconds(time_ns - *self.since_ns.get_or_insert(time_ns));
                if waited_s < area.registration_s - 0.5 * area.interval_s {
                    return;
                }
                let Some(Registration { rotation, covariance, residual_rate, .. }) =
                    registration.solve().filter(Registration::is_observable)
                else {
                    self.news |= Flags::UNOBSERVABLE;
                    return;
                };
                (rotation, covariance * REGISTRATION_DOUBT, guess(&residual_rate).map(|axis| axis.widened(WIDER)))
            }
        };
        if pair.flags.contains(Flags::GAP) {
            return;
        }
        let start = Start {
            grade: area.grade,
            accel: self.settings.accel,
            lever_arm: self.settings.lever_arm,
            flexure: self.adoption.hull().or(area.hull).map_or(broad, |hull| hull.modes),
            rotation,
            covariance,
        };
        self.begin(pair, &start);
    }

    /// Starts the filter with a pair, or with the first that registration has held and runs it up to the pair.
    fn begin(&mut self, pair: &ImuPair, start: &Start) {
        let registration = self.registration.take();
        let (lag, held) = registration.as_ref().map_or((None, [].as_slice()), |found| (found.lag(), found.held()));
        let (first, later) = held.split_first().unwrap_or((pair, &[]));
        let (mut model, mut p) = M::begin(&self.settings.options, start);
        if let Some(lag) = lag {
            model.delayed(&lag, &mut p);
        }
        let begin_ns = first.header.time_ns;
        let view = model.view();
        let mut running = Running {
            covariance: view.rows * p * view.rows.transpose(),
            view,
            model,
            p,
            epoch: first.epoch,
            begin_ns,
            last_ns: begin_ns,
            updated_ns: begin_ns,
            start_m: Rot::from_wxyz(first.attitude_m),
            start_s: Rot::from_wxyz(first.attitude_s),
            w_im_m: Vec3::ZERO,
        };
        let period_s = self.period_s();
        let sound = later.iter().all(|pair| running.step(pair, &self.settings.filter, period_s).is_some());
        if sound {
            self.running = Some(running);
        } else {
            self.reset();
        }
    }

    /// Of all that tells one estimator from another but for how it registers, which is over when there is a state.
    fn fingerprint(&self) -> u64 {
        let MatchedSettings { area, accel, lever_arm, filter, registration: _, options } = &self.settings;
        state::fingerprint(&(std::any::type_name::<M>(), area, accel, lever_arm, filter, options))
    }

    /// The least time from one update to the next.
    fn period_s(&self) -> f64 {
        1.0 / self.settings.area.filter_hz - 0.5 * self.settings.area.interval_s
    }

    /// Starts anew: the frames of the filter's start are lost.
    fn reset(&mut self) {
        self.running = None;
        self.since_ns = None;
        self.registration = self.settings.registration.map(|make| make(&self.settings.area));
        self.news |= Flags::RESET;
    }

    fn publish(&mut self, pair: &ImuPair, flags: Flags) -> Solution {
        let mut solution = Solution {
            header: pair.header,
            params_id: self.adoption.id(),
            epoch: pair.epoch,
            area: self.settings.area.area,
            flags,
            ..Solution::default()
        };
        let Some(running) = &self.running else { return solution };
        let View { deformation, rows, noise, static_part, static_rows, rate, rate_rows, drift, delay, skew } =
            running.view;
        let p = &running.p;
        let covariance = running.covariance + noise;
        let static_covariance = static_rows * p * static_rows.transpose();
        let dynamic_rows = rows - static_rows;
        let (a_m, a_s) = (Rot::<MainStart, Main>::from_wxyz(pair.attitude_m), Rot::from_wxyz(pair.attitude_s));
        let constant: Rot<MainStart, SubStart> = a_m * deformation * Rot::<SubStart, Sub>::inverse(a_s);

        solution.q = deformation.quaternion();
        solution.static_q = static_part.quaternion();
        solution.constant = constant.quaternion();
        solution.phi = deformation.log().array();
        solution.dynamic = (deformation * static_part.inverse()).log().array();
        solution.rate = rate.array();
        solution.drift = drift.array();
        solution.covariance = row_major(&covariance);
        solution.static_covariance = row_major(&static_covariance);
        solution.dynamic_covariance = row_major(&(dynamic_rows * p * dynamic_rows.transpose() + noise));
        let estimate = |state: Option<(f64, usize)>| state.map_or((0.0, 0.0), |(x, i)| (x, p[(i, i)].sqrt()));
        (solution.delay, solution.delay_sigma) = estimate(delay);
        (solution.skew, solution.skew_sigma) = estimate(skew);
        solution.range = self.evaluation.range(&Evidence {
            time_s: unit::seconds(pair.header.time_ns - running.begin_ns),
            interval_s: unit::seconds(pair.interval_ns),
            w_im_m: running.w_im_m,
            covariance,
            static_covariance,
            rate,
            rate_covariance: rate_rows * p * rate_rows.transpose(),
            rate_with_static: rate_rows * p * static_rows.transpose(),
        });
        let usable = !flags.contains(Flags::COASTING) && covariance.diagonal().max() < USABLE * USABLE;
        solution.valid = u32::from(usable);
        attitude_of_deck(&mut solution, pair, deformation, &covariance);
        solution
    }
}

impl<M: Model<N, K>, const N: usize, const K: usize> Estimator for Matched<M, N, K> {
    fn offer(&mut self, params: FlexureParams) {
        if self.adoption.offer(params) {
            self.news |= Flags::LATE;
        }
    }

    fn step(&mut self, pair: &ImuPair) -> Solution {
        self.adoption.advance(pair.header.time_ns);
        let mut flags = pair.flags;
        if self.running.as_ref().is_some_and(|running| running.epoch != pair.epoch) {
            self.reset();
        }
        let period_s = self.period_s();
        match &mut self.running {
            None => self.register(pair),
            Some(_) if pair.flags.contains(Flags::GAP) => flags |= Flags::COASTING,
            Some(running) => {
                if let Some(hull) = self.adoption.hull() {
                    running.model.set_flexure(hull.modes);
                }
                if running.step(pair, &self.settings.filter, period_s).is_none() {
                    self.reset();
                }
            }
        }
        if self.adoption.id() == 0 && self.settings.area.hull.is_none() {
            flags |= Flags::PRIOR;
        }
        if self.running.is_none() {
            flags |= Flags::REGISTERING;
        }
        flags |= std::mem::take(&mut self.news);
        self.publish(pair, flags)
    }

    fn freeze(&self) -> Option<Frozen> {
        // a field that the estimator gets and the state does not is an error here; there is no registration beside a filter
        let Self { settings: _, evaluation, registration: _, since_ns, adoption, running, news } = self;
        let state = State {
            evaluation: evaluation.kept(),
            since_ns: *since_ns,
            adoption: adoption.clone(),
            running: running.clone()?,
            news: *news,
        };
        let settings = self.fingerprint();
        Some(Box::new(move || state::seal(settings, &state)))
    }

    fn thaw(&mut self, state: &[u8]) -> Result<(), StateError> {
        let State { evaluation, since_ns, adoption, running, news } =
            state::open::<State<M, N>>(self.fingerprint(), state)?;
        if !evaluation.is_like(&self.evaluation.kept()) {
            return Err(StateError::Settings);
        }
        self.evaluation = evaluation.evaluate();
        self.registration = None;
        (self.since_ns, self.adoption, self.running, self.news) = (since_ns, adoption, Some(running), news);
        Ok(())
    }
}

impl<M, const N: usize> Running<M, N> {
    /// Takes in a pair; `None` when the numbers have become useless.
    fn step<const K: usize>(&mut self, pair: &ImuPair, filter: &Filter, period_s: f64) -> Option<()>
    where
        M: Model<N, K>,
    {
        let time_ns = pair.header.time_ns;
        let interval_s = unit::seconds(time_ns - self.last_ns);
        self.last_ns = time_ns;
        let dtheta_m = Vec3::from(pair.dtheta_m);
        self.w_im_m = dtheta_m / unit::seconds(pair.interval_ns).max(f64::MIN_POSITIVE);
        self.model.advance(&Motion {
            time_s: unit::seconds(time_ns - self.begin_ns),
            interval_s,
            a_m: (self.start_m.inverse() * Rot::<MainStart, Main>::from_wxyz(pair.attitude_m)).relabel(),
            a_s: (self.start_s.inverse() * Rot::<SubStart, Sub>::from_wxyz(pair.attitude_s)).relabel(),
            dtheta_m,
            dtheta_s: Vec3::from(pair.dtheta_s),
            dvel_m: Vec3::from(pair.dvel_m),
            dvel_s: Vec3::from(pair.dvel_s),
            disturbance: pair.disturbance,
        });
        if unit::seconds(time_ns - self.updated_ns) >= period_s {
            self.updated_ns = time_ns;
            let Prediction { transition, noise } = self.model.propagate();
            self.p = transition * self.p * transition.transpose() + noise;
            symmetrise(&mut self.p);
            filter.correct(&mut self.model, &mut self.p, &noise)?;
        }
        self.view = self.model.view();
        self.covariance = self.view.rows * self.p * self.view.rows.transpose();
        let variances = self.p.diagonal();
        let sound = variances.iter().all(|v| v.is_finite() && *v >= 0.0) && self.view.deformation.log().is_finite();
        (sound && self.covariance.diagonal().max() < LOST * LOST).then_some(())
    }
}
