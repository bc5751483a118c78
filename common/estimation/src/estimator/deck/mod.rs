//! The fast stage by the project's own model: registration by motion, then the filter of [`crate::matching::deck`], with an output at every pair.
//!
//! What both units felt in the first minutes is kept, and later what they felt since the flexure became another one, or in the last minutes. Whenever better
//! parameters come, a second filter runs over all of it beside the live one, some increments at each pair, and takes over where it has caught up. When it
//! starts, how fast it runs and where it takes over follow from data time and the count of pairs alone, so that processes and a loop over a file give the
//! same bits, and no state ever passes between processes.

mod history;
mod origin;
mod replay;
mod running;
mod slam;
mod slow;
mod state;
mod surprise;

use super::{Settings, attitude_of_deck, row_major};
use crate::Estimator;
use crate::align::{DelayRegistrar, Register, Registrar, Registration};
use crate::evaluate::{Evaluate, Evidence, NORMAL_95};
use crate::flexure::Hull;
use crate::matching::View;
use crate::matching::deck::Options;
use crate::matching::increment::Increment;
use crate::state::{Frozen, StateError};
use frames::{Main, Rot, Vec3, unit};
use messages::{Flags, FlexureParams, ImuPair, Solution};
use nalgebra::{Matrix3, Vector3};
use origin::Origin;
use running::Running;
use slow::Slow;
use state::State;

/// While the filter runs, the registration by motion is worked out so often, ns.
const REGISTER_AGAIN_NS: i64 = 10_000_000_000;
/// A covariance beyond this (1 rad^2) says nothing of a rotation any more.
const LOST: f64 = 1.0;
/// No hull bends more than this (3 degrees, rad); what an identifier takes for more is a coarse unit's error.
const LARGEST_FLEXURE: f64 = 0.05;
/// The slow filter starts so long after the fast one, s: how large the slow part of the flexure is, no shorter window tells. From the first two minutes
/// on it put 100 arcsec into the demonstration.
const SLOW_FROM_S: f64 = 600.0;
/// The waves seldom hide as much as the range reckons with. The slow filter is weighed by so many times that; with all of it an uncoupled ship's errors
/// were a third larger on straight courses of three hours.
const LIKELY: f64 = 0.5;
/// The delay is registered from so much data, s.
const DELAY_DATA_S: f64 = 60.0;

/// Settings of [`DeckEstimator`].
#[derive(Clone, Copy, Debug)]
pub struct DeckSettings {
    /// What every estimator of an area is told.
    pub area: Settings,
    /// Accelerometers, lever arm, delay.
    pub options: Options,
    /// Whether the first minutes are run over again with better parameters.
    pub replay: bool,
}

impl DeckSettings {
    /// The least time from one update to the next.
    fn period_s(&self) -> f64 {
        1.0 / self.area.filter_hz - 0.5 * self.area.interval_s
    }

    /// Whether the sub unit's stamps may be late.
    fn has_delay(&self) -> bool {
        self.options.delay.sigma > 0.0
    }

    /// A flexure model kept to what the units can tell and a hull can do.
    fn bounded(&self, hull: Hull) -> Hull {
        hull.bounded(self.area.grade.least_flexure(), LARGEST_FLEXURE)
    }
}

/// The estimator of one area.
pub struct DeckEstimator {
    settings: DeckSettings,
    evaluation: Box<dyn Evaluate>,
    /// Until a filter starts.
    delays: Option<DelayRegistrar>,
    /// What an estimator that is gone said last.
    last: Option<Solution>,
    state: State,
}

impl DeckEstimator {
    /// An estimator that has seen nothing yet.
    pub fn new(settings: DeckSettings, evaluation: Box<dyn Evaluate>) -> Self {
        let (delays, state) = (settings.has_delay().then(DelayRegistrar::new), State::new(&settings));
        Self { settings, evaluation, delays, last: None, state }
    }

    /// Starts anew, with nothing but the parameters in force.
    fn reset(&mut self) {
        self.state.registrar = Registrar::new(self.settings.area.grade.scale_variance());
        self.delays = self.settings.has_delay().then(DelayRegistrar::new);
        self.state.history.end();
        (self.state.since_ns, self.state.origin, self.state.live, self.state.shadow, self.state.slow) =
            (None, None, None, None, None);
        self.state.epoch = None;
        self.state.news |= Flags::RESET;
    }

    /// The flexure model in force, or the one that a start by motion guesses.
    fn hull(&self, origin: &Origin) -> Hull {
        let adopted = self.state.adoption.hull().map(|hull| self.settings.bounded(hull));
        adopted.or(self.settings.area.hull).unwrap_or(origin.guess())
    }

    /// The attitudes start anew with a pair.
    fn enter_epoch(&mut self, pair: &ImuPair) {
        self.state.epoch = Some(pair.epoch);
        self.state.increments.restart();
        self.state.shadow = None;
        if let Some(slow) = &mut self.state.slow {
            slow.leave_epoch();
        }
        if let Some(live) = &mut self.state.live {
            live.leave_epoch();
            self.state.history.end();
        } else {
            self.state.history.restart(pair.header.time_ns);
            if self.state.origin.is_some() {
                self.run_again();
            }
        }
    }

    /// Lets the slow filter see what the fast one sees.
    fn see_slowly(&mut self, time_ns: i64, felt: Option<&Increment>) {
        if self.evaluation.hidden().is_none() {
            return;
        }
        let since_s = unit::seconds(time_ns.saturating_sub(self.state.started_ns));
        let (Some(live), Some(origin), Some(felt)) =
            (&self.state.live, &self.state.origin, felt.filter(|_| since_s > SLOW_FROM_S))
        else {
            return;
        };
        let Some(now) = live.deck.together().filter(|_| !live.is_coasting()) else { return };
        let hull = self.hull(origin);
        let new = || Box::new(Slow::new(&self.settings, live.deck.so3(), hull));
        let mut slow = self.state.slow.take().unwrap_or_else(new);
        slow.set_flexure(hull);
        let Some(complete) = slow.step(time_ns, now, felt.disturbance) else { return };
        if complete {
            *slow = slow.revised(&self.settings, live.deck.so3());
        }
        self.state.slow = Some(slow);
    }

    /// By how much the covariance is too small for what the data say; 1 where they do not contradict.
    fn excess(&self, live: &Running) -> f64 {
        live.surprise().excess().max(self.state.slow.as_ref().map_or(1.0, |slow| slow.excess()))
    }

    /// By how much the deformation is turned by what the slow motion shows and the waves hide, and the half width of its range; `None` where the range
    /// does not reckon with that. `own` is the covariance of the fast filter's deformation.
    fn corrected(&self, live: &Running, own: &Matrix3<f64>) -> Option<(Rot<Main, Main>, [f64; 3])> {
        let hidden = self.evaluation.hidden()?;
        let known = |times: f64| own + Matrix3::from_diagonal(&hidden.map(|angle| (times * angle).powi(2)));
        let (slow, now) = (self.state.slow.as_ref()?, live.deck.together()?);
        let (turn, covariance) = slow.correct(live.deck.so3(), now, &known(LIKELY), &known(1.0))?;
        let triad = self.settings.area.grade.triad_variance();
        Some((turn, covariance.diagonal().map(|variance| NORMAL_95 * (variance + triad).sqrt()).into()))
    }

    /// Collects motion until it shows the installation; then a filter starts.
    fn register(&mut self, pair: &ImuPair) {
        let time_ns = pair.header.time_ns;
        self.state.registrar.add(pair);
        let since_ns = *self.state.since_ns.get_or_insert(time_ns);
        let waited_s = unit::seconds(time_ns - since_ns);
        if let Some(delays) = self.delays.as_mut().filter(|_| waited_s < DELAY_DATA_S) {
            delays.add(pair);
        }
        if self.state.origin.is_some() {
            if time_ns - self.state.registered_ns >= REGISTER_AGAIN_NS {
                self.state.registered =
                    self.state.registrar.solve().filter(Registration::is_observable).or(self.state.registered);
                self.state.registered_ns = time_ns;
            }
            return;
        }
        if pair.flags.contains(Flags::GAP) {
            return;
        }
        if let Some(origin) = self.last.take().and_then(|last| Origin::resumed(&self.settings, &last, time_ns)) {
            return self.start(origin, time_ns);
        }
        match Origin::find(&self.settings, &self.state.registrar, self.delays.as_ref(), waited_s) {
            origin::Found::Nothing => {}
            origin::Found::Unobservable => self.state.news |= Flags::UNOBSERVABLE,
            origin::Found::Start(origin) => self.start(*origin, time_ns),
        }
    }

    /// A first filter starts.
    fn start(&mut self, origin: Origin, time_ns: i64) {
        (self.state.registered, self.state.registered_ns) = (origin.by_motion, time_ns);
        self.state.origin = Some(origin);
        self.delays = None;
        if !self.settings.replay || !self.state.history.is_complete() {
            self.state.history.restart(time_ns);
        }
        self.run_again();
    }

    fn publish(&mut self, pair: &ImuPair, flags: Flags) -> Solution {
        let mut solution = Solution {
            header: pair.header,
            params_id: self.state.adoption.id(),
            epoch: pair.epoch,
            area: self.settings.area.area,
            flags,
            ..Solution::default()
        };
        let Some(running) = &self.state.live else { return solution };
        let p = &running.p;
        let coasting = running.is_coasting();
        let View { deformation, rows, noise, static_part, static_rows, rate, rate_rows, drift, delay, skew } =
            running.deck.view(coasting);
        let excess = self.excess(running);
        let triad = Matrix3::identity() * self.settings.area.grade.triad_variance();
        let own = (rows * p * rows.transpose() + noise) * excess;
        let covariance = own + triad;
        let static_covariance = static_rows * p * static_rows.transpose() * excess + triad;
        let dynamic_rows = rows - static_rows;
        let so3 = running.deck.so3();

        let (turn, seen) = self.corrected(running, &own).unzip();
        let turn = turn.unwrap_or(Rot::identity());
        let (deformation, static_part) = (turn * deformation, turn * static_part);
        solution.q = deformation.quaternion();
        solution.static_q = static_part.quaternion();
        solution.constant = so3.constant().quaternion();
        solution.phi = deformation.log().array();
        solution.dynamic = (deformation * static_part.inverse()).log().array();
        solution.rate = rate.array();
        solution.drift = drift.array();
        solution.scale = so3.scale();
        solution.nis = running.surprise().mean();
        solution.covariance = row_major(&covariance);
        solution.static_covariance = row_major(&static_covariance);
        solution.dynamic_covariance = row_major(&((dynamic_rows * p * dynamic_rows.transpose() + noise) * excess));
        let estimate = |state: Option<(f64, usize)>| state.map_or((0.0, 0.0), |(x, i)| (x, p[(i, i)].sqrt()));
        (solution.delay, solution.delay_sigma) = estimate(delay);
        (solution.skew, solution.skew_sigma) = estimate(skew);
        if let Some(registered) = &self.state.registered {
            solution.registered = registered.rotation.quaternion();
            solution.registered_sigma = registered.covariance.diagonal().map(f64::sqrt).into();
        }
        let interval_s = unit::seconds(pair.interval_ns).max(f64::MIN_POSITIVE);
        let range = self.evaluation.range(&Evidence {
            time_s: running.elapsed_s(),
            interval_s,
            w_im_m: Vec3::<Main>::from(pair.dtheta_m) / interval_s,
            covariance,
            static_covariance,
            rate,
            rate_covariance: rate_rows * p * rate_rows.transpose(),
            rate_with_static: rate_rows * p * static_rows.transpose(),
        });
        let range = seen.unwrap_or(range);
        let announced = if self.state.shadow.is_some() { self.state.announced } else { [0.0; 3] };
        solution.range = std::array::from_fn(|axis| range[axis].max(announced[axis]));
        self.state.range = solution.range;
        solution.valid = u32::from(!coasting && covariance.diagonal().max() < LOST);
        // what the waves may hide is hidden in the deck's attitude too
        let hidden = self.evaluation.hidden().map_or(Matrix3::zeros(), |_| {
            let told = Vector3::from(range).map(|range| (range / NORMAL_95).powi(2));
            Matrix3::from_diagonal(&(told - covariance.diagonal()).map(|more| more.max(0.0)))
        });
        attitude_of_deck(&mut solution, pair, deformation, &(covariance + hidden));
        solution
    }
}

impl Estimator for DeckEstimator {
    fn offer(&mut self, params: FlexureParams) {
        if self.state.adoption.offer(params) {
            self.state.news |= Flags::LATE;
        }
    }

    fn resume(&mut self, last: &Solution) {
        self.last = Some(*last);
    }

    fn freeze(&self) -> Option<Frozen> {
        self.frozen()
    }

    fn thaw(&mut self, state: &[u8]) -> Result<(), StateError> {
        *self = self.thawed(state)?;
        Ok(())
    }

    fn step(&mut self, pair: &ImuPair) -> Solution {
        self.state.adoption.advance(pair.header.time_ns);
        let is_gap = pair.flags.contains(Flags::GAP);
        if !is_gap && self.state.epoch != Some(pair.epoch) {
            self.enter_epoch(pair);
        }
        let felt = if is_gap { None } else { self.state.increments.next(pair) };
        let at_end = felt.is_some_and(|step| self.state.history.take(&step));
        if let (Some(hull), Some(live)) = (self.state.adoption.hull(), &mut self.state.live) {
            live.set_flexure(self.settings.bounded(hull));
        }
        let lost = self
            .state
            .live
            .as_mut()
            .is_some_and(|live| live.step(pair.header.time_ns, felt.as_ref(), &self.settings).is_none());
        if lost {
            self.reset();
        }
        self.see_slowly(pair.header.time_ns, felt.as_ref());
        self.register(pair);
        self.catch_up(at_end);

        let mut flags = pair.flags;
        if self.state.adoption.id() == 0 && self.settings.area.hull.is_none() {
            flags |= Flags::PRIOR;
        }
        flags |= std::mem::take(&mut self.state.news);
        flags |= self.state.origin.as_ref().map_or(Flags::empty(), |origin| origin.flags);
        flags |= match &self.state.live {
            None => Flags::REGISTERING,
            Some(live) if live.is_coasting() => Flags::COASTING,
            Some(live) if self.excess(live) > 1.0 => Flags::INCONSISTENT,
            Some(_) => Flags::empty(),
        };
        self.publish(pair, flags)
    }
}
