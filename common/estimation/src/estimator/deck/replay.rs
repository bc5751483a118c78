//! What came lately run over again beside the live filter, whenever better parameters come: the first minutes, and those since a change of the flexure.

use super::DeckEstimator;
use super::history::AT_ONCE;
use super::running::Running;
use super::state::State;
use frames::unit;
use serde::{Deserialize, Serialize};

/// The history is run over again when it has grown by this factor.
const GROWN: f64 = 1.2;
/// A window that begins so long after the flexure does not speak of its beginning, s.
const LATEST_WINDOW_S: f64 = 10.0;
/// By how much more than a step the range is widened before it.
const MARGIN: f64 = 1.2;

/// A filter that runs over the history.
#[derive(Clone, Serialize, Deserialize)]
pub(super) struct Shadow {
    running: Box<Running>,
    done: usize,
}

impl DeckEstimator {
    /// A filter starts at the beginning of the history, with the parameters in force.
    pub(super) fn run_again(&mut self) {
        let Some(origin) = &self.state.origin else { return };
        let hull = self.hull(origin);
        let begin_ns = self.state.history.begin_ns();
        let running = if let Some(base) = self.state.history.base() {
            let mut running = base.clone();
            running.set_flexure(hull);
            running
        } else {
            let running = Running::new(origin.begin(&self.settings, hull), begin_ns, self.settings.period_s());
            self.state.history.set_base(&running);
            running
        };
        if self.settings.replay {
            self.state.shadow = Some(Shadow { running: Box::new(running), done: 0 });
        } else {
            self.state.history.end();
            self.state.live = Some(Box::new(running));
        }
        self.state.replayed_id = self.state.adoption.id();
        self.state.announced = [0.0; 3];
        self.state.again_s = self.state.history.length_s() * GROWN;
    }

    /// Lets the history begin where the parameters in force do, or follow the live filter where they say nothing more of its beginning.
    fn place_history(&mut self) {
        let Some(live) = self.state.live.as_ref().filter(|_| self.settings.replay && self.state.shadow.is_none())
        else {
            return;
        };
        if !self.state.history.is_complete() {
            self.state.history.follow(live);
        }
        if let Some(changed_ns) = self.state.adoption.take_change() {
            self.state.history.anchor(changed_ns);
            self.state.again_s = 0.0;
        } else if let Some(from_ns) = self.state.history.flexure_from_ns() {
            // what comes before the first solution is in the windows or not, as the identifier likes
            let first_ns = from_ns.max(self.state.started_ns);
            let begin_ns = self.state.adoption.window_begin_ns().unwrap_or(i64::MIN);
            if unit::seconds(begin_ns.saturating_sub(first_ns)) > LATEST_WINDOW_S {
                self.state.history.release();
            }
        }
        if let Some(origin) = &self.state.origin {
            let hull = self.hull(origin);
            self.state.history.advance(hull, &self.settings);
        }
    }

    /// Lets the second filter catch up; where it has, it takes over. `at_end` says that the live filter stands at the end of the history.
    pub(super) fn catch_up(&mut self, at_end: bool) {
        self.place_history();
        let State { adoption, history, live, shadow, .. } = &self.state;
        let news = adoption.id() != self.state.replayed_id && history.length_s() >= self.state.again_s;
        if news && live.is_some() && shadow.is_none() && history.flexure_from_ns().is_some() {
            self.run_again();
        }
        if !self.state.history.is_complete() && self.state.live.is_some() {
            self.state.shadow = None;
        }
        let Some(shadow) = &mut self.state.shadow else { return };
        let steps = self.state.history.steps();
        for step in steps.iter().skip(shadow.done).take(AT_ONCE) {
            shadow.done += 1;
            if shadow.running.step(step.time_ns, Some(step), &self.settings).is_none() {
                self.state.shadow = None;
                if self.state.live.is_none() {
                    self.reset();
                }
                return;
            }
        }
        if at_end && shadow.done == steps.len() && !steps.is_empty() {
            self.take_over();
        }
    }

    /// The second filter, which has caught up, becomes the live one, unless its data disagree with it. Where the step is larger than the range that
    /// is published, the range is widened first, and the step comes with the next interval.
    fn take_over(&mut self) {
        let (Some(shadow), Some(live)) = (&self.state.shadow, &self.state.live) else {
            self.state.live = self.state.shadow.take().map(|shadow| shadow.running);
            self.state.started_ns = self.state.live.as_ref().map_or(i64::MAX, |live| live.last_ns());
            return;
        };
        if !shadow.running.surprise().is_small() {
            self.state.shadow = None;
            return;
        }
        let total = |running: &Running| running.deck.view(running.is_coasting()).deformation;
        let step = (total(&shadow.running) * total(live).inverse()).log().array().map(f64::abs);
        let covered = step.iter().zip(&self.state.range).all(|(step, range)| step <= range);
        if covered {
            self.state.live = self.state.shadow.take().map(|shadow| shadow.running);
        } else {
            self.state.announced = step.map(|step| step * MARGIN);
        }
    }
}
