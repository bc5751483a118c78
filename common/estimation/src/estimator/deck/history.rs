//! What both units felt lately, joined to the filter's intervals, and a filter that stands at its beginning: what is run over again with other parameters.
//!
//! The history begins where the flexure in force begins, with the first pair or with a change, for as long as every new set of parameters says more of that
//! time; then it follows the live filter some minutes behind, so that a change that is noticed late finds a filter that has not yet lived through it.

use super::DeckSettings;
use super::running::Running;
use crate::flexure::Hull;
use crate::matching::increment::Increment;
use serde::{Deserialize, Serialize};
use std::collections::VecDeque;

/// The longest history, s. A later change of the flexure model has little to say about the first minutes.
const LONGEST_S: f64 = 600.0;
/// So far the filter at its beginning stays behind while nothing changes, s: longer than it takes to notice a change.
const BEHIND_S: f64 = 180.0;
/// The most increments that are kept, and room for those that come while a second filter runs over them.
const ROOM: usize = 6000;
const SPARE: usize = 256;
/// So many increments are run over at each pair.
pub const AT_ONCE: usize = 5;

/// Where a history begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
enum Beginning {
    /// With the epoch, where a filter starts anew with every set of parameters.
    Epoch,
    /// Where the flexure became another one, ns, once the filter at the beginning has come up to there.
    Change(i64),
    /// Some minutes behind the live filter; the flexure in force is older.
    Behind,
    /// Nowhere: what comes does not join what came before, and is not kept.
    Nowhere,
}

/// The increments since the beginning, oldest first.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct History {
    steps: VecDeque<Increment>,
    joining: Option<Increment>,
    begin_ns: i64,
    period_s: f64,
    length_s: f64,
    beginning: Beginning,
    /// The filter at the beginning; `None` before any has started.
    base: Option<Box<Running>>,
}

impl History {
    /// An empty history of increments of at least `period_s`.
    pub fn new(period_s: f64) -> Self {
        Self {
            steps: VecDeque::with_capacity(ROOM + SPARE),
            joining: None,
            begin_ns: 0,
            period_s,
            length_s: 0.0,
            beginning: Beginning::Epoch,
            base: None,
        }
    }

    /// Begins anew with the pair at `begin_ns`, where a flexure begins.
    pub fn restart(&mut self, begin_ns: i64) {
        self.end();
        (self.begin_ns, self.beginning) = (begin_ns, Beginning::Epoch);
    }

    /// Begins anew beside a live filter, whose flexure began before.
    pub fn follow(&mut self, live: &Running) {
        self.restart(live.last_ns());
        self.base = Some(Box::new(live.clone()));
        self.release();
    }

    /// Takes no more: what comes does not join what is here.
    pub fn end(&mut self) {
        self.steps.clear();
        (self.joining, self.base, self.length_s, self.beginning) = (None, None, 0.0, Beginning::Nowhere);
    }

    /// Whether it reaches up to now.
    pub fn is_complete(&self) -> bool {
        self.beginning != Beginning::Nowhere
    }

    /// The instant at which it begins, ns.
    pub fn begin_ns(&self) -> i64 {
        self.begin_ns
    }

    /// Its length, s.
    pub fn length_s(&self) -> f64 {
        self.length_s
    }

    /// Where the flexure in force begins, ns, if the history begins there.
    pub fn flexure_from_ns(&self) -> Option<i64> {
        let is_behind = |time_ns| self.steps.front().is_some_and(|first| first.time_ns <= time_ns);
        match self.beginning {
            Beginning::Epoch => Some(self.begin_ns),
            Beginning::Change(time_ns) => Some(time_ns).filter(|&time_ns| !is_behind(time_ns)),
            Beginning::Behind | Beginning::Nowhere => None,
        }
    }

    /// The filter at its beginning; `None` where one starts anew with every set of parameters.
    pub fn base(&self) -> Option<&Running> {
        self.base.as_deref().filter(|_| self.beginning != Beginning::Epoch)
    }

    /// Places a filter that starts there at its beginning.
    pub fn set_base(&mut self, running: &Running) {
        self.base = Some(Box::new(running.clone()));
    }

    /// The flexure has become another one at an instant, from which on the increments are kept.
    pub fn anchor(&mut self, time_ns: i64) {
        self.beginning = Beginning::Change(time_ns.max(self.begin_ns));
    }

    /// The parameters to come say nothing more of the beginning, which follows the end from now on.
    pub fn release(&mut self) {
        self.beginning = Beginning::Behind;
    }

    /// The increments, oldest first.
    pub fn steps(&self) -> &VecDeque<Increment> {
        &self.steps
    }

    /// Takes in what both units felt; `true` when that ends an increment of the history.
    pub fn take(&mut self, step: &Increment) -> bool {
        if !self.is_complete() {
            return false;
        }
        let joined = self.joining.take().map_or(*step, |joining| joining.then(step));
        if joined.time_s < self.period_s {
            self.joining = Some(joined);
            return false;
        }
        self.length_s += joined.time_s;
        self.steps.push_back(joined);
        if self.length_s > LONGEST_S || self.steps.len() >= ROOM {
            match self.base {
                Some(_) => self.release(),
                None => self.end(),
            }
        }
        self.is_complete()
    }

    /// Lets the filter at the beginning come nearer to where it should stand; by the model in force unless another flexure is ahead of it.
    pub fn advance(&mut self, hull: Hull, settings: &DeckSettings) {
        for _ in 0..AT_ONCE {
            let (Some(base), Some(first)) = (&mut self.base, self.steps.front()) else { return };
            match self.beginning {
                Beginning::Change(time_ns) if first.time_ns <= time_ns => {}
                Beginning::Behind if self.length_s > BEHIND_S || self.steps.len() >= ROOM => base.set_flexure(hull),
                _ => return,
            }
            (self.begin_ns, self.length_s) = (first.time_ns, self.length_s - first.time_s);
            if base.step(first.time_ns, Some(first), settings).is_none() {
                return self.end();
            }
            self.steps.pop_front();
        }
    }
}
