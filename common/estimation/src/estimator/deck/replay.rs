//! The first minutes run over again beside the live filter, whenever better parameters come.

use super::DeckEstimator;
use super::running::Running;
use frames::unit;
use serde::{Deserialize, Serialize};

/// So many increments of the history are run over at each pair.
const AT_ONCE: usize = 5;
/// The history is run over again when it has grown by this factor.
const GROWN: f64 = 1.2;
/// A window that begins so long after the first solution does not speak of the first minutes, s.
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
        let running =
            Running::new(origin.begin(&self.settings, hull), self.state.history.begin_ns(), self.settings.period_s());
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

    /// Whether the parameters in force speak of the end of the history only, the flexure having become another one.
    fn is_of_another_flexure(&self) -> bool {
        let begin_ns = self.state.adoption.window_begin_ns().unwrap_or(i64::MIN);
        let since_start_s = unit::seconds(begin_ns.saturating_sub(self.state.started_ns));
        self.state.live.is_some() && since_start_s > LATEST_WINDOW_S
    }

    /// Lets the second filter catch up; where it has, it takes over. `at_end` says that the live filter stands at the end of the history.
    pub(super) fn catch_up(&mut self, at_end: bool) {
        let news =
            self.state.adoption.id() != self.state.replayed_id && self.state.history.length_s() >= self.state.again_s;
        if news && self.state.live.is_some() && self.state.shadow.is_none() && self.state.history.is_complete() {
            self.run_again();
        }
        if self.is_of_another_flexure() {
            self.state.history.end();
        }
        let Some(shadow) = &mut self.state.shadow else { return };
        if !self.state.history.is_complete() && self.state.live.is_some() {
            self.state.shadow = None;
            return;
        }
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
