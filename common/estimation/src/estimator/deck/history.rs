//! What both units felt since the first pair, joined to the filter's intervals: what a filter with other parameters runs over again.

use crate::matching::increment::Increment;
use serde::{Deserialize, Serialize};

/// The longest history, s. A later change of the flexure model has little to say about the first minutes.
const LONGEST_S: f64 = 600.0;
/// The most increments that are kept.
const ROOM: usize = 6000;

/// The increments of the epoch in which the filter started.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct History {
    steps: Vec<Increment>,
    joining: Option<Increment>,
    begin_ns: i64,
    period_s: f64,
    length_s: f64,
    ended: bool,
}

impl History {
    /// An empty history of increments of at least `period_s`.
    pub fn new(period_s: f64) -> Self {
        Self { steps: Vec::with_capacity(ROOM), joining: None, begin_ns: 0, period_s, length_s: 0.0, ended: false }
    }

    /// Begins anew with the pair at `begin_ns`.
    pub fn restart(&mut self, begin_ns: i64) {
        self.steps.clear();
        (self.joining, self.begin_ns, self.length_s, self.ended) = (None, begin_ns, 0.0, false);
    }

    /// Takes no more: what comes does not join what is here.
    pub fn end(&mut self) {
        self.ended = true;
        self.steps.clear();
    }

    /// Whether it reaches up to now.
    pub fn is_complete(&self) -> bool {
        !self.ended
    }

    /// The instant at which it begins, ns.
    pub fn begin_ns(&self) -> i64 {
        self.begin_ns
    }

    /// Its length, s.
    pub fn length_s(&self) -> f64 {
        self.length_s
    }

    /// The increments, oldest first.
    pub fn steps(&self) -> &[Increment] {
        &self.steps
    }

    /// Takes in what both units felt; `true` when that ends an increment of the history.
    pub fn take(&mut self, step: &Increment) -> bool {
        if self.ended {
            return false;
        }
        let joined = self.joining.take().map_or(*step, |joining| joining.then(step));
        if joined.time_s < self.period_s {
            self.joining = Some(joined);
            return false;
        }
        self.length_s += joined.time_s;
        self.steps.push(joined);
        if self.length_s > LONGEST_S || self.steps.len() == ROOM {
            self.end();
        }
        !self.ended
    }
}
