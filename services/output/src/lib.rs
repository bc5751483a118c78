//! `deckflex output`: the areas' solutions as telegrams on the ship's wires.

mod area;
mod clock;
mod destination;
mod error;
mod line;

pub use error::OutputError;

use area::AreaInput;
use clock::Clock;
use destination::Destination;
use messages::{OutputState, Stage, topic};
use pipeline::configuration::Configuration;
use runtime::{Beat, Context, Publisher, TransportError, Waiter, Wake, monotonic_ns};
use std::time::Duration;

/// How long a sleep may last without data.
const NAP_NS: i64 = 100_000_000;
/// The source of UTC is read, and the states are published, so often, ns.
const SECOND_NS: i64 = 1_000_000_000;

/// The destinations with the topics of their states.
struct Destinations {
    all: Vec<(Destination, Publisher<OutputState>)>,
    clock: Clock,
    told_ns: i64,
}

impl Destinations {
    /// Sends what the areas' new solutions tell.
    fn tell(&mut self, areas: &mut [AreaInput]) -> Result<(), TransportError> {
        for area in areas {
            while let Some(solution) = area.next()? {
                for (destination, _) in self.all.iter_mut().filter(|(d, _)| d.area() == area.index()) {
                    destination.tell(&solution, area.track(), &self.clock);
                }
            }
        }
        Ok(())
    }

    /// Says that nothing is valid where an area has been silent for too long, and brings lines, clock and states up to date.
    fn attend(&mut self, areas: &[AreaInput], now_ns: i64) -> Result<(), TransportError> {
        for (destination, _) in &mut self.all {
            let newest_ns = areas.iter().find(|area| area.index() == destination.area()).map(AreaInput::newest_ns);
            destination.attend(newest_ns.unwrap_or(now_ns), now_ns, &self.clock);
            destination.log(now_ns);
        }
        if now_ns - self.told_ns >= SECOND_NS {
            self.publish(now_ns)?;
            // last, so that the states tell the greatest age that telegrams were sent with
            self.clock.read()?;
        }
        Ok(())
    }

    fn publish(&mut self, now_ns: i64) -> Result<(), TransportError> {
        self.told_ns = now_ns;
        self.all
            .iter()
            .try_for_each(|(destination, port)| port.publish(&destination.state(&self.clock, now_ns)).map(|_| ()))
    }

    /// The last word on every line is that nothing is valid any more.
    fn end(&mut self) -> Result<(), TransportError> {
        for (destination, _) in &mut self.all {
            destination.end(monotonic_ns(), &self.clock);
        }
        self.publish(monotonic_ns())
    }

    fn count(&self, beat: &mut Beat, areas: &[AreaInput]) {
        let sum = |count: fn(&OutputState) -> u64| self.all.iter().map(|(d, _)| count(d.counts())).sum();
        let health = &mut beat.health;
        health.given = sum(|state| state.sent);
        health.overflow = sum(|state| state.unsendable);
        health.refused = sum(|state| state.withheld);
        health.taken = areas.iter().map(AreaInput::taken).sum();
        health.lost = areas.iter().map(AreaInput::lost).sum();
        if let Some(header) = areas.iter().filter_map(AreaInput::last).max_by_key(|header| header.time_ns) {
            beat.handled(header);
        }
    }

    /// How long the stage may sleep.
    fn nap(&self, now_ns: i64) -> Duration {
        let due_ns = self.all.iter().map(|(destination, _)| destination.due_ns()).min().unwrap_or(i64::MAX);
        Duration::from_nanos(due_ns.saturating_sub(now_ns).clamp(1_000_000, NAP_NS) as u64)
    }
}

/// Runs the stage until the streams of all its areas end or a signal comes.
///
/// # Errors
/// A destination cannot be opened at the start of a run (later it is tried again and again), or the transport refuses.
pub fn run(configuration: &Configuration, context: &Context) -> Result<(), OutputError> {
    let (stop, mut connection) = context.connect(Stage::Output, None)?;
    let node = &connection.node;
    let mut areas = Vec::new();
    for (index, area) in configuration.areas.iter().enumerate() {
        if configuration.outputs.iter().any(|output| output.area == area.name) {
            areas.push(AreaInput::open(node, index, &area.name)?);
        }
    }
    let mut destinations = Destinations { all: Vec::new(), clock: Clock::open(node, configuration)?, told_ns: 0 };
    for number in 0..configuration.outputs.len() {
        let destination = Destination::open(configuration, number, context.run_id, context.resume)?;
        destinations.all.push((destination, Publisher::open(node, &topic::output(number))?));
    }
    let beat = &mut connection.beat;
    beat.ready()?;
    let mut waiter = Waiter::new();
    while !stop.requested() && !areas.iter().all(AreaInput::ended) {
        let wakes: Vec<&dyn Wake> = areas.iter().map(AreaInput::wake).collect();
        waiter.wait(&wakes, destinations.nap(monotonic_ns()))?;
        destinations.tell(&mut areas)?;
        let now_ns = monotonic_ns();
        destinations.attend(&areas, now_ns)?;
        destinations.count(beat, &areas);
        beat.tick(now_ns)?;
    }
    destinations.end()?;
    destinations.count(beat, &areas);
    Ok(beat.ended()?)
}
