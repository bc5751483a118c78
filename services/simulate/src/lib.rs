//! `deckflex simulate`: the simulated units in the place of real ones, paced by absolute deadlines.

mod emulator;

pub use emulator::{Emulator, EmulatorError, KvhFormat, Options};

use messages::Stage;
use pipeline::configuration::Configuration;
use runtime::{Context, Delivery, Feed, TransportError, monotonic_ns, sleep_until};
use simulation::Simulator;

/// Runs the stage until the run's duration is over or a signal comes; then every stream gets its end mark.
///
/// A restarted simulator computes forward from the first sample of the same run and goes on with the present one.
///
/// # Errors
/// The transport or the operating system refuses.
pub fn run(configuration: &Configuration, context: &Context) -> Result<(), TransportError> {
    let (stop, connection) = context.connect(Stage::Simulate, None)?;
    let names: Vec<&str> = configuration.areas.iter().map(|area| area.name.as_str()).collect();
    let mut simulator = Simulator::new(&configuration.scenario(context.run_id));
    let mut feed = Feed::open(connection, &names)?;
    let started_ns = monotonic_ns();
    while !stop.requested()
        && let Some(epoch) = simulator.step()
    {
        let due_ns = context.epoch_ns + epoch.main.header.time_ns;
        let delivery =
            Delivery { main: &epoch.main, attitude: Some(&epoch.attitude), sub: &epoch.sub, truth: &epoch.truth };
        if context.resume && due_ns < started_ns {
            feed.skip(&delivery);
        } else if sleep_until(due_ns) || !stop.requested() {
            feed.publish(due_ns, &delivery)?;
        }
    }
    feed.end()
}
