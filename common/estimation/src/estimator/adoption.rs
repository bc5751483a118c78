//! Parameter sets that wait for the data time from which they are in force.

use super::model;
use crate::flexure::{Flexure, Hull};
use messages::FlexureParams;
use serde::{Deserialize, Serialize};
use std::collections::VecDeque;

/// Parameter sets that wait for their time.
const WAITING: usize = 8;
/// A window that is shorter than the one before by more than this has been cut, ns: what came before speaks of another flexure.
const CUT_NS: i64 = 60_000_000_000;

/// The set in force and those that wait.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Adoption {
    /// In the order of their time.
    waiting: VecDeque<FlexureParams>,
    params: Option<FlexureParams>,
    last_ns: Option<i64>,
    /// Where the flexure became another one, ns, until that is asked for.
    changed_ns: Option<i64>,
}

fn length_ns(params: &FlexureParams) -> i64 {
    params.effective_from_ns.saturating_sub(params.window_begin_ns)
}

impl Adoption {
    pub(super) fn new() -> Self {
        Self { waiting: VecDeque::with_capacity(WAITING), params: None, last_ns: None, changed_ns: None }
    }

    /// Takes an offer, unless it is known or unsound; `true` if it came after its time.
    pub(super) fn offer(&mut self, params: FlexureParams) -> bool {
        let known = |other: &FlexureParams| other.id == params.id;
        if !model(&params).all().all(Flexure::is_sound) {
            return false;
        }
        if self.params.as_ref().is_some_and(known) || self.waiting.iter().any(known) {
            return false;
        }
        if self.waiting.len() == WAITING {
            self.waiting.pop_front();
        }
        let place = self.waiting.partition_point(|other| other.effective_from_ns <= params.effective_from_ns);
        self.waiting.insert(place, params);
        self.last_ns.is_some_and(|last_ns| last_ns >= params.effective_from_ns)
    }

    /// Lets the time of a pair come.
    pub(super) fn advance(&mut self, time_ns: i64) {
        self.last_ns = Some(time_ns);
        while self.waiting.front().is_some_and(|params| params.effective_from_ns <= time_ns) {
            let next = self.waiting.pop_front();
            if let (Some(before), Some(next)) = (&self.params, &next)
                && length_ns(before).saturating_sub(length_ns(next)) > CUT_NS
            {
                self.changed_ns = Some(next.window_begin_ns);
            }
            self.params = next;
        }
    }

    /// Where the flexure became another one, ns, if that has been noticed since the last call.
    pub(super) fn take_change(&mut self) -> Option<i64> {
        self.changed_ns.take()
    }

    /// Identity of the set in force, 0 for none.
    pub(super) fn id(&self) -> u64 {
        self.params.map_or(0, |params| params.id)
    }

    /// The instant at which the data of the set in force begin, ns.
    pub(super) fn window_begin_ns(&self) -> Option<i64> {
        self.params.map(|params| params.window_begin_ns)
    }

    /// The flexure model in force.
    pub(super) fn hull(&self) -> Option<Hull> {
        self.params.as_ref().map(model)
    }
}
