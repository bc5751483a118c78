//! `deckflex replay`: recorded units in the place of real ones, at one or more times the recorded pace.

use messages::Stage;
use pipeline::configuration::Configuration;
use pipeline::recording::RecordingError;
use pipeline::source::{Batch, Recorded};
use runtime::{Context, Delivery, Feed, TransportError, monotonic_ns, sleep_until};

/// Why a replay could not be carried out.
#[derive(Debug, thiserror::Error)]
pub enum ReplayError {
    /// A recording cannot be read.
    #[error(transparent)]
    Recording(#[from] RecordingError),
    /// The transport or the operating system refuses.
    #[error(transparent)]
    Transport(#[from] TransportError),
}

/// Runs the stage to the recordings' end or until a signal comes; then every stream gets its end mark.
///
/// A restarted replay reads forward to the sample that is due at present.
///
/// # Errors
/// A recording cannot be read, or the transport refuses.
pub fn run(configuration: &Configuration, context: &Context) -> Result<(), ReplayError> {
    let (stop, connection) = context.connect(Stage::Replay, None)?;
    let names: Vec<&str> = configuration.areas.iter().map(|area| area.name.as_str()).collect();
    let mut recorded = Recorded::open(configuration, context.run_id)?;
    let mut feed = Feed::open(connection, &names)?;
    let started_ns = monotonic_ns();
    let mut batch = Batch::default();
    let mut first_ns = None;
    while !stop.requested() && recorded.next(&mut batch) {
        let time_ns = batch.main.header.time_ns;
        let since_ns = (time_ns - *first_ns.get_or_insert(time_ns)).max(0);
        let due_ns = context.epoch_ns + (since_ns as f64 / configuration.replay_pace) as i64;
        let delivery =
            Delivery { main: &batch.main, attitude: batch.attitude.as_ref(), sub: &batch.sub, truth: &batch.truth };
        if context.resume && due_ns < started_ns {
            feed.skip(&delivery);
        } else if sleep_until(due_ns) || !stop.requested() {
            feed.publish(due_ns, &delivery)?;
        }
    }
    feed.health().refused = recorded.refused();
    feed.end()?;
    Ok(())
}
