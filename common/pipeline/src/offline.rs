//! The whole system as one loop in one thread: the reference of every comparison.
//!
//! The processes make the same calls in the same order of data time and add nothing but ports.

use crate::configuration::Configuration;
use crate::lane;
use crate::recording::RecordingError;
use crate::source::{Batch, Source};
use estimation::synchronise::{Counts, Synchroniser};
use estimation::{Estimator, Identifier};
use messages::{FlexureParams, Solution, Truth};

/// Takes what the loop gives, area by area, in order.
pub trait Sink {
    /// The truth of an area; comes before the solution of the same sample number.
    fn truth(&mut self, _truth: &Truth) {}
    /// A solution.
    fn solution(&mut self, solution: &Solution);
    /// A parameter set, when it is made.
    fn parameters(&mut self, _parameters: &FlexureParams) {}
}

struct Lane {
    synchroniser: Synchroniser,
    estimator: Box<dyn Estimator>,
    identifier: Box<dyn Identifier + Send>,
}

impl Lane {
    fn new(configuration: &Configuration, area: usize) -> Self {
        Self {
            synchroniser: lane::synchroniser(configuration, area),
            estimator: lane::estimator(configuration, area),
            identifier: lane::identifier(configuration, area),
        }
    }

    fn work_off(&mut self, sink: &mut dyn Sink) {
        while let Some(pair) = self.synchroniser.pair() {
            let solution = self.estimator.step(&pair);
            sink.solution(&solution);
            if let Some(parameters) = self.identifier.step(&pair, &solution) {
                sink.parameters(&parameters);
                self.estimator.offer(parameters);
            }
        }
    }
}

/// What became of the samples of a run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Outcome {
    /// By area; a sample of the main unit counts in each.
    pub areas: Vec<Counts>,
    /// Rows of the recordings that could not be read.
    pub unreadable_rows: u64,
}

/// Runs a configuration from its first sample to its last.
///
/// # Errors
/// A recording cannot be opened.
pub fn run(configuration: &Configuration, sink: &mut dyn Sink) -> Result<Outcome, RecordingError> {
    let mut source = Source::open(configuration, 0)?;
    let mut lanes: Vec<Lane> = (0..configuration.areas.len()).map(|area| Lane::new(configuration, area)).collect();
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
    for lane in &mut lanes {
        lane.synchroniser.end();
        lane.work_off(sink);
    }
    let areas = lanes.iter().map(|lane| lane.synchroniser.counts()).collect();
    Ok(Outcome { areas, unreadable_rows: source.unreadable_rows() })
}
