//! The whole state of the estimator, which another one of the same settings goes on from.

use super::history::History;
use super::origin::Origin;
use super::replay::Shadow;
use super::running::Running;
use super::slow::Slow;
use super::{DeckEstimator, DeckSettings};
use crate::align::{Registrar, Registration};
use crate::estimator::adoption::Adoption;
use crate::evaluate::Kept;
use crate::matching::increment::Increments;
use crate::state::{self, Frozen, StateError};
use messages::Flags;
use serde::{Deserialize, Serialize};

/// All that changes as data come, and that another estimator of the same settings goes on from.
#[derive(Clone, Serialize, Deserialize)]
pub(super) struct State {
    pub epoch: Option<u64>,
    pub increments: Increments,
    pub history: History,
    /// Goes on collecting when the filter runs: what the motion alone says of the installation.
    pub registrar: Registrar,
    pub since_ns: Option<i64>,
    pub registered: Option<Registration>,
    pub registered_ns: i64,
    pub origin: Option<Origin>,
    pub live: Option<Box<Running>>,
    /// What the slow motion alone shows; only where the range reckons with what the waves hide.
    pub slow: Option<Box<Slow>>,
    pub shadow: Option<Shadow>,
    /// Length of the history from which on it is worth running over again, s.
    pub again_s: f64,
    /// When the first filter went live, ns.
    pub started_ns: i64,
    /// The range last published, and what it must not be less than before a step, rad.
    pub range: [f64; 3],
    pub announced: [f64; 3],
    pub adoption: Adoption,
    /// The parameters with which the history was last run over.
    pub replayed_id: u64,
    /// Flags that the next solution carries.
    pub news: Flags,
}

impl State {
    /// Nothing has been seen yet.
    pub fn new(settings: &DeckSettings) -> Self {
        Self {
            epoch: None,
            increments: Increments::default(),
            history: History::new(settings.period_s()),
            registrar: Registrar::new(settings.area.grade.scale_variance()),
            since_ns: None,
            registered: None,
            registered_ns: i64::MIN,
            origin: None,
            live: None,
            slow: None,
            shadow: None,
            again_s: 0.0,
            started_ns: i64::MAX,
            range: [0.0; 3],
            announced: [0.0; 3],
            adoption: Adoption::new(),
            replayed_id: 0,
            news: Flags::empty(),
        }
    }
}

impl DeckEstimator {
    /// `None` before a filter is live: what a registration holds is large, and is kept for seconds only.
    pub(super) fn frozen(&self) -> Option<Frozen> {
        // a field that the estimator gets and the state does not is an error here
        let Self { settings, evaluation, delays, last, state } = self;
        if state.live.is_none() || delays.is_some() || last.is_some() {
            return None;
        }
        let (settings, state) = (*settings, (evaluation.kept(), state.clone()));
        Some(Box::new(move || state::seal(state::fingerprint(&settings), &state)))
    }

    /// An estimator of the same settings in a state.
    pub(super) fn thawed(&self, bytes: &[u8]) -> Result<Self, StateError> {
        let (evaluation, state): (Kept, State) = state::open(state::fingerprint(&self.settings), bytes)?;
        if !evaluation.is_like(&self.evaluation.kept()) {
            return Err(StateError::Settings);
        }
        Ok(Self { settings: self.settings, evaluation: evaluation.evaluate(), delays: None, last: None, state })
    }
}
