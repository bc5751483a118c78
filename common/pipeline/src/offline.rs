//! The whole system as one loop in one thread: the reference of every comparison.
//!
//! The processes make the same calls in the same order of data time and add nothing but ports.

use crate::configuration::Configuration;
use crate::lane;
use crate::recorded_run::Course;
use crate::recording::RecordingError;
use crate::source::{Batch, Source};
use estimation::synchronise::{Counts, Synchroniser};
use estimation::{Estimator, Identifier};
use messages::{FlexureParams, Solution, Truth};
use std::collections::VecDeque;

/// Takes what the loop gives, area by area, in order.
pub trait Sink {
    /// The truth of an area; comes before the solution of the same sample number.
    fn truth(&mut self, _truth: &Truth) {}
    /// A solution.
    fn solution(&mut self, solution: &Solution);
    /// A parameter set, when it is learnt.
    fn parameters(&mut self, _parameters: &FlexureParams) {}
}

struct Lane {
    synchroniser: Synchroniser,
    estimator: Box<dyn Estimator>,
    parameters: Parameters,
}

/// Where parameter sets come from.
enum Parameters {
    /// They are learnt.
    Learnt(Box<dyn Identifier + Send>),
    /// They are those of a recorded run, at the samples at which they took effect.
    Recorded(VecDeque<(u64, FlexureParams)>),
}

impl Lane {
    fn new(configuration: &Configuration, area: usize, recorded: Option<VecDeque<(u64, FlexureParams)>>) -> Self {
        Self {
            synchroniser: lane::synchroniser(configuration, area),
            estimator: lane::estimator(configuration, area),
            parameters: match recorded {
                Some(sets) => Parameters::Recorded(sets),
                None => Parameters::Learnt(lane::identifier(configuration, area)),
            },
        }
    }

    fn work_off(&mut self, sink: &mut dyn Sink) {
        while let Some(pair) = self.synchroniser.pair() {
            if let Parameters::Recorded(sets) = &mut self.parameters {
                while let Some((_, set)) = sets.pop_front_if(|(number, _)| *number <= pair.header.sequence) {
                    self.estimator.offer(set);
                }
            }
            let solution = self.estimator.step(&pair);
            sink.solution(&solution);
            if let Parameters::Learnt(identifier) = &mut self.parameters
                && let Some(parameters) = identifier.step(&pair, &solution)
            {
                sink.parameters(&parameters);
                self.estimator.offer(parameters);
            }
        }
    }
}

/// What became of the samples of a run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Outcome {
    /// By area; a sample of the main unit counts in each. Empty where no samples were looked at.
    pub areas: Vec<Counts>,
    /// Rows of the recordings that could not be read.
    pub unreadable_rows: u64,
}

/// Runs a configuration from its first sample to its last.
///
/// # Errors
/// A recording cannot be opened.
pub fn run(configuration: &Configuration, sink: &mut dyn Sink) -> Result<Outcome, RecordingError> {
    go(configuration, |_| None, sink)
}

/// Goes through a recorded run again: with its parameter sets at the samples at which they took effect, and no further than it goes.
///
/// # Errors
/// The recorded run cannot be opened.
pub fn again(configuration: &Configuration, course: &Course, sink: &mut dyn Sink) -> Result<Outcome, RecordingError> {
    go(configuration, |area| course.adoptions(area), sink)
}

fn go(
    configuration: &Configuration,
    sets: impl Fn(usize) -> Option<VecDeque<(u64, FlexureParams)>>,
    sink: &mut dyn Sink,
) -> Result<Outcome, RecordingError> {
    let mut source = Source::open(configuration, 0)?;
    let areas = 0..configuration.areas.len();
    let mut lanes: Vec<Lane> = areas.map(|area| Lane::new(configuration, area, sets(area))).collect();
    let mut batch = Batch::default();
    while source.next(&mut batch) {
        batch.truth.iter().for_each(|truth| sink.truth(truth));
        for lane in &mut lanes {
            batch.attitude.iter().for_each(|attitude| lane.synchroniser.attitude(attitude));
            lane.synchroniser.main(&batch.main);
        }
        for sample in &batch.sub {
            lanes[sample.unit as usize - 1].synchroniser.sub(sample);
        }
        lanes.iter_mut().for_each(|lane| lane.work_off(sink));
    }
    // behind a cut the run had samples that its last pairs were made with
    if !configuration.as_recorded || source.whole() {
        for lane in &mut lanes {
            lane.synchroniser.end();
            lane.work_off(sink);
        }
    }
    let areas = lanes.iter().map(|lane| lane.synchroniser.counts()).collect();
    Ok(Outcome { areas, unreadable_rows: source.unreadable_rows() })
}
