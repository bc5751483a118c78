//! `deckflex estimate`: one solution a pair, valid or not.

mod checkpoint;
mod events;
mod states;

pub use events::Events;

use checkpoint::{Checkpoint, Keeper};
use messages::{Flags, FlexureParams, ImuPair, Solution, Stage, topic};
use pipeline::alarm::AlarmWatch;
use pipeline::configuration::Configuration;
use pipeline::lane;
use runtime::{Area, Context, Publisher, Sequence, Subscriber, Supply, TransportError, Waiter, monotonic_ns};
use states::{Encoder, States};
use std::time::Duration;

/// How long a sleep may last without data.
const NAP: Duration = Duration::from_millis(200);

/// Runs the stage of one area until its stream ends or a signal comes.
///
/// # Errors
/// The transport or the operating system refuses.
pub fn run(configuration: &Configuration, area: usize, context: &Context) -> Result<(), TransportError> {
    let name = configuration.areas[area].name.as_str();
    let place = Area { index: area as u32, name };
    let path = context.domain.join(format!("estimate_{area}.json"));
    let before = if context.resume { Checkpoint::read(&path) } else { None };
    // before the thread gets its class, or the others would have it too
    let mut keeper = Keeper::start(path)?;
    let encoder = Encoder::start()?;
    let (stop, mut connection) = context.connect(Stage::Estimate, Some(place))?;
    let node = &connection.node;
    let pairs: Subscriber<ImuPair> = Subscriber::open(node, &topic::pair(name))?;
    let parameters: Subscriber<FlexureParams> = Subscriber::open(node, &topic::parameters(name))?;
    let solutions = Publisher::open(node, &topic::solution(name))?;
    let mut states = States::open(node, encoder, place)?;
    let mut estimator = lane::estimator(configuration, area);
    let mut offered = before.and_then(|before| before.parameters());
    if let Some(before) = before {
        tracing::info!(with_model = offered.is_some(), "goes on from what the estimator before it kept");
        estimator.resume(&before.solution());
    }
    if let Some(set) = offered {
        estimator.offer(set);
    }
    let mut sequence = Sequence::default();
    let mut alarms = AlarmWatch::new(configuration.areas[area].alarm.as_ref());
    let (mut events, mut supply) = (Events::default(), Supply::new("pairs"));
    let mut valid_ns = monotonic_ns();
    let beat = &mut connection.beat;
    beat.ready()?;
    let mut waiter = Waiter::new();
    while !stop.requested() {
        waiter.wait(&[&pairs], NAP)?;
        let before = beat.health.taken;
        while let Some(pair) = pairs.take()? {
            if pair.header.is_end() {
                solutions.publish(&Solution { header: pair.header, area: place.index, ..Solution::default() })?;
                return beat.ended();
            }
            while let Some(set) = parameters.take()? {
                estimator.offer(set);
                events.offer(&set);
                offered = Some(set);
            }
            let mut solution = estimator.step(&pair);
            solution.header.stamps.solution_ns = monotonic_ns();
            solutions.publish(&solution)?;
            states.see(estimator.as_ref(), &solution.header)?;
            sequence.see(&pair.header);
            beat.health.taken += 1;
            beat.health.given += 1;
            beat.health.lost = sequence.lost();
            beat.health.late += u64::from(solution.flags.contains(Flags::LATE));
            beat.handled(&pair.header);
            alarms.see(&solution);
            keeper.see(&solution, offered.as_ref());
            events.see(&solution);
            if solution.is_valid() {
                valid_ns = solution.header.stamps.solution_ns;
            }
        }
        alarms.without(monotonic_ns() - valid_ns);
        beat.health.alarms = alarms.raised();
        events.alarms(alarms.raised());
        supply.see(beat.health.taken > before, monotonic_ns());
        beat.tick(monotonic_ns())?;
    }
    Ok(())
}
