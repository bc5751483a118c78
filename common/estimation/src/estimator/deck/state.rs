//! The whole state of the estimator, which another one of the same settings goes on from.

use super::{DeckEstimator, History, Origin, Running, Shadow, Slow};
use crate::align::{Registrar, Registration};
use crate::estimator::adoption::Adoption;
use crate::evaluate::Kept;
use crate::matching::increment::Increments;
use crate::state::{self, Frozen, StateError};
use messages::Flags;
use serde::{Deserialize, Serialize};

#[derive(Serialize, Deserialize)]
struct State {
    evaluation: Kept,
    epoch: Option<u64>,
    increments: Increments,
    history: History,
    registrar: Registrar,
    since_ns: Option<i64>,
    registered: Option<Registration>,
    registered_ns: i64,
    origin: Option<Origin>,
    live: Option<Box<Running>>,
    slow: Option<Box<Slow>>,
    shadow: Option<Shadow>,
    again_s: f64,
    started_ns: i64,
    range: [f64; 3],
    announced: [f64; 3],
    adoption: Adoption,
    replayed_id: u64,
    news: Flags,
}

impl DeckEstimator {
    /// `None` before a filter is live: what a registration holds is large, and is kept for seconds only.
    pub(super) fn frozen(&self) -> Option<Frozen> {
        // a field that the estimator gets and the state does not is an error here
        let Self {
            settings,
            evaluation,
            epoch,
            increments,
            history,
            registrar,
            delays,
            since_ns,
            registered,
            registered_ns,
            origin,
            last,
            live,
            slow,
            shadow,
            again_s,
            started_ns,
            range,
            announced,
            adoption,
            replayed_id,
            news,
        } = self;
        if live.is_none() || delays.is_some() || last.is_some() {
            return None;
        }
        let state = State {
            evaluation: evaluation.kept(),
            epoch: *epoch,
            increments: increments.clone(),
            history: history.clone(),
            registrar: registrar.clone(),
            since_ns: *since_ns,
            registered: *registered,
            registered_ns: *registered_ns,
            origin: *origin,
            live: live.clone(),
            slow: slow.clone(),
            shadow: shadow.clone(),
            again_s: *again_s,
            started_ns: *started_ns,
            range: *range,
            announced: *announced,
            adoption: adoption.clone(),
            replayed_id: *replayed_id,
            news: *news,
        };
        let settings = *settings;
        Some(Box::new(move || state::seal(state::fingerprint(&settings), &state)))
    }

    /// An estimator of the same settings in a state.
    pub(super) fn thawed(&self, bytes: &[u8]) -> Result<Self, StateError> {
        let State {
            evaluation,
            epoch,
            increments,
            history,
            registrar,
            since_ns,
            registered,
            registered_ns,
            origin,
            live,
            slow,
            shadow,
            again_s,
            started_ns,
            range,
            announced,
            adoption,
            replayed_id,
            news,
        } = state::open(state::fingerprint(&self.settings), bytes)?;
        if !evaluation.is_like(&self.evaluation.kept()) {
            return Err(StateError::Settings);
        }
        Ok(Self {
            settings: self.settings,
            evaluation: evaluation.evaluate(),
            epoch,
            increments,
            history,
            registrar,
            delays: None,
            since_ns,
            registered,
            registered_ns,
            origin,
            last: None,
            live,
            slow,
            shadow,
            again_s,
            started_ns,
            range,
            announced,
            adoption,
            replayed_id,
            news,
        })
    }
}
