//! `deckflex identify`: learns the flexure model of one area, at low priority, without ever holding up the estimator.
//!
//! The process's main thread drains the ports and joins pairs with solutions; a second thread does the slow work. Between them is a
//! bounded channel whose overflow is counted.

use crossbeam::channel::{Receiver, Sender, TrySendError, bounded};
use estimation::Identifier;
use frames::unit::seconds;
use messages::{FlexureParams, Header, ImuPair, Solution, Stage, topic};
use pipeline::configuration::Configuration;
use pipeline::lane;
use runtime::{Area, Context, Publisher, Sequence, Subscriber, Supply, TransportError, Waiter, monotonic_ns};
use std::collections::VecDeque;
use std::thread;
use std::time::Duration;

/// How long a sleep may last without data; parameters that are ready wait no longer than to the next solution.
const NAP: Duration = Duration::from_millis(200);
/// Samples that may wait for the solver: 60 s at 100 Hz.
const BACKLOG: usize = 6000;

/// A pair and the solution of the same sample number.
type Joined = (ImuPair, Solution);

/// What the solver gives back.
struct Found {
    parameters: Option<FlexureParams>,
    restarted_windows: u64,
}

/// Runs the stage of one area until its stream ends or a signal comes.
///
/// # Errors
/// The transport or the operating system refuses.
pub fn run(configuration: &Configuration, area: usize, context: &Context) -> Result<(), TransportError> {
    let name = configuration.areas[area].name.as_str();
    let place = Area { index: area as u32, name };
    let (stop, mut connection) = context.connect(Stage::Identify, Some(place))?;
    let node = &connection.node;
    let mut inputs = Inputs {
        pairs: Subscriber::open(node, &topic::pair(name))?,
        solutions: Subscriber::open(node, &topic::solution(name))?,
        waiting: VecDeque::new(),
        sequence: Sequence::default(),
        end: None,
    };
    let parameters = Publisher::open(node, &topic::parameters(name))?;
    let (to_solver, samples) = bounded::<Joined>(BACKLOG);
    let (to_port, found) = bounded::<Found>(16);
    let identifier = lane::identifier(configuration, area);
    let solver = thread::spawn(move || solve(identifier, &samples, &to_port));
    let beat = &mut connection.beat;
    beat.ready()?;
    let mut waiter = Waiter::new();
    let mut supply = Supply::new("solutions");
    while inputs.end.is_none() && !stop.requested() {
        waiter.wait(&[&inputs.solutions], NAP)?;
        let (taken, overflow) = inputs.join(&to_solver)?;
        if inputs.end.is_none() {
            supply.see(taken > 0, monotonic_ns());
        }
        beat.health.taken += taken;
        beat.health.overflow += overflow;
        beat.health.lost = inputs.sequence.lost();
        for found in found.try_iter() {
            report(&found, &parameters, beat)?;
        }
        parameters.refresh()?;
        beat.tick(monotonic_ns())?;
    }
    drop(to_solver);
    for found in found.iter() {
        report(&found, &parameters, beat)?;
    }
    // the channel closed because the thread returned, or panicked: then the process must not look as if all had been well
    if let Err(panic) = solver.join() {
        std::panic::resume_unwind(panic);
    }
    if inputs.end.is_some() { beat.ended() } else { Ok(()) }
}

/// The slow thread.
fn solve(mut identifier: Box<dyn Identifier + Send>, samples: &Receiver<Joined>, to_port: &Sender<Found>) {
    for (pair, solution) in samples {
        let mut parameters = identifier.step(&pair, &solution);
        if let Some(set) = &mut parameters {
            set.header.stamps = solution.header.stamps;
        }
        let found = Found { parameters, restarted_windows: identifier.restarted_windows() };
        if found.parameters.is_some() && to_port.send(found).is_err() {
            return;
        }
    }
}

fn report(found: &Found, port: &Publisher<FlexureParams>, beat: &mut runtime::Beat) -> Result<(), TransportError> {
    beat.health.restarted_windows = found.restarted_windows;
    if let Some(mut set) = found.parameters {
        set.header.stamps.parameters_ns = monotonic_ns();
        port.publish(&set)?;
        let window_s = seconds(set.header.time_ns - set.window_begin_ns);
        let took_ms = (set.header.stamps.parameters_ns - set.header.stamps.solution_ns) as f64 * 1e-6;
        tracing::debug!(
            id = set.id,
            window_s,
            took_ms,
            effective_s = seconds(set.effective_from_ns),
            "a flexure model is learnt"
        );
        beat.health.given += 1;
        beat.handled(&set.header);
    }
    Ok(())
}

struct Inputs {
    pairs: Subscriber<ImuPair>,
    solutions: Subscriber<Solution>,
    /// Pairs whose solution has not come yet.
    waiting: VecDeque<ImuPair>,
    sequence: Sequence,
    end: Option<Header>,
}

impl Inputs {
    /// Joins what has come and passes it on; gives how many were taken and how many found the solver's backlog full.
    fn join(&mut self, to_solver: &Sender<Joined>) -> Result<(u64, u64), TransportError> {
        let (mut taken, mut overflow) = (0, 0);
        while let Some(solution) = self.solutions.take()? {
            // a solution's pair was published before it
            while let Some(pair) = self.pairs.take()? {
                if !pair.header.is_end() {
                    self.waiting.push_back(pair);
                }
            }
            if solution.header.is_end() {
                self.end = Some(solution.header);
                break;
            }
            self.sequence.see(&solution.header);
            while self.waiting.front().is_some_and(|pair| pair.header.sequence < solution.header.sequence) {
                self.waiting.pop_front();
            }
            let Some(pair) = self.waiting.pop_front_if(|pair| pair.header.sequence == solution.header.sequence) else {
                continue;
            };
            taken += 1;
            match to_solver.try_send((pair, solution)) {
                Ok(()) => {}
                Err(TrySendError::Full(_) | TrySendError::Disconnected(_)) => overflow += 1,
            }
        }
        Ok((taken, overflow))
    }
}
