//! `deckflex acquire`: units on wires in the place of simulated ones.
//!
//! One thread a port reads and notes the time of arrival; the stage itself finds the frames, maps the devices' times onto the host's
//! clock and publishes each sample as it comes.

mod error;
mod events;
mod keeper;
mod piece;
mod reader;
mod wired;

pub use error::AcquireError;

use crossbeam::channel::{RecvTimeoutError, bounded};
use frames::unit::nanoseconds;
use messages::Stage;
use pipeline::configuration::Configuration;
use reader::{Common, News};
use runtime::{Context, Feed, monotonic_ns};
use std::sync::Arc;
use std::time::Duration;
use wired::Wired;

/// Pieces that may wait for the stage: 10 s of two units at 200 Hz.
const DEPTH: usize = 4096;
/// The stage looks after itself at least so often.
const NAP: Duration = Duration::from_millis(50);
const HEALTH_NS: i64 = 1_000_000_000;
/// A port that has never been open may stay closed for so long, ns: another process may still have to make it.
const PATIENCE_NS: i64 = 15_000_000_000;

/// Runs the stage until the run's duration is over, the main unit's file of raw bytes has ended or a signal comes; then every stream gets its end mark.
///
/// # Errors
/// A stream is not what the configuration says, a port cannot be opened at the start, or the transport refuses.
pub fn run(configuration: &Configuration, context: &Context) -> Result<(), AcquireError> {
    let (stop, connection) = context.connect(Stage::Acquire, None)?;
    let names: Vec<&str> = configuration.areas.iter().map(|area| area.name.as_str()).collect();
    let mut feed = Feed::open(connection, &names)?;
    let (sender, news) = bounded(DEPTH);
    let common = Common { news: sender, shift_ns: Arc::default() };
    let mut units = Wired::all(configuration, context, feed.node(), &common)?;
    drop(common);
    let started_ns = monotonic_ns();
    let until_ns = configuration.run.duration_s.map_or(i64::MAX, |s| context.epoch_ns.saturating_add(nanoseconds(s)));
    let mut health_ns = started_ns;
    while !stop.requested() && !units[0].ended {
        match news.recv_timeout(NAP) {
            Ok(News::Bytes(piece)) => units[piece.unit].take(&piece, &mut feed)?,
            Ok(News::Fault { unit, reason, lasting }) => {
                let hopeless = lasting || monotonic_ns() - started_ns > PATIENCE_NS;
                if hopeless && units[unit].never_open() {
                    return Err(AcquireError::Port { unit: units[unit].name.clone(), reason });
                }
                units[unit].fail(reason);
            }
            Ok(News::Ended { unit }) => units[unit].ended = true,
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => break,
        }
        let now_ns = monotonic_ns();
        if now_ns - health_ns >= HEALTH_NS {
            health_ns = now_ns;
            for unit in &mut units {
                unit.report(&mut feed)?;
                if now_ns - started_ns > PATIENCE_NS
                    && unit.never_open()
                    && let Some(reason) = unit.fault.take()
                {
                    return Err(AcquireError::Port { unit: unit.name.clone(), reason });
                }
            }
            feed.tick()?;
        }
        if now_ns > until_ns {
            break;
        }
    }
    for unit in &mut units {
        unit.report(&mut feed)?;
    }
    feed.end()?;
    Ok(())
}
