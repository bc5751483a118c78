//! One simulated scenario, and methods that run over it as the offline loop runs them.

use crate::{Fault, Track};
use estimation::{Estimator, Identifier};
use messages::{FlexureParams, ImuPair, Truth};
use pipeline::configuration::{Configuration, Source as Kind};
use pipeline::lane;
use pipeline::source::{Batch, Source};
use std::collections::VecDeque;

/// What the first area's units felt and what was true, an instant of the main unit each: 520 bytes a sample. A long scenario is
/// better run by [`run_together`], which keeps nothing.
#[derive(Clone, Debug)]
pub struct Data {
    /// What the methods get.
    pub pairs: Vec<ImuPair>,
    /// The truth of each pair.
    pub truths: Vec<Truth>,
}

impl Data {
    /// Simulates a configuration's first area from its first sample to its last.
    ///
    /// # Errors
    /// The configuration has no end or its units are not simulated.
    pub fn simulate(configuration: &Configuration) -> Result<Self, Fault> {
        let mut data = Self { pairs: Vec::new(), truths: Vec::new() };
        pairs(configuration, |pair, truth| {
            data.pairs.push(*pair);
            data.truths.push(*truth);
        })?;
        Ok(data)
    }
}

/// Simulates a configuration's first area and hands out each pair with its truth.
///
/// # Errors
/// The configuration has no end or its units are not simulated.
pub fn pairs(configuration: &Configuration, mut take: impl FnMut(&ImuPair, &Truth)) -> Result<(), Fault> {
    if configuration.main.source != Kind::Simulator || configuration.run.duration_s.is_none() {
        return Err(Fault::NotAnExperiment(configuration.path.display().to_string()));
    }
    let mut source = Source::open(configuration, 0)?;
    let mut synchroniser = lane::synchroniser(configuration, 0);
    let mut batch = Batch::default();
    let mut truths = VecDeque::new();
    let mut hand_out = |synchroniser: &mut estimation::synchronise::Synchroniser, truths: &mut VecDeque<Truth>| {
        while let Some(pair) = synchroniser.pair() {
            while truths.pop_front_if(|truth: &mut Truth| truth.header.sequence < pair.header.sequence).is_some() {}
            if let Some(truth) = truths.front().filter(|truth| truth.header.sequence == pair.header.sequence) {
                take(&pair, truth);
            }
        }
    };
    while source.next(&mut batch) {
        truths.extend(batch.truth.iter().filter(|truth| truth.area == 0));
        batch.attitude.iter().for_each(|attitude| synchroniser.attitude(attitude));
        synchroniser.main(&batch.main);
        batch.sub.iter().filter(|sample| sample.unit == 1).for_each(|sample| synchroniser.sub(sample));
        hand_out(&mut synchroniser, &mut truths);
    }
    synchroniser.end();
    hand_out(&mut synchroniser, &mut truths);
    Ok(())
}

/// A configuration's estimator and identifier at work.
struct Method {
    estimator: Box<dyn Estimator>,
    identifier: Box<dyn Identifier + Send>,
    /// Sets that are made and not yet in force.
    pending: Vec<FlexureParams>,
    track: Track,
}

impl Method {
    fn new(configuration: &Configuration, every_s: f64) -> Self {
        Self {
            estimator: lane::estimator(configuration, 0),
            identifier: lane::identifier(configuration, 0),
            pending: Vec::new(),
            track: Track::new(every_s),
        }
    }

    /// The calls of the offline loop, in its order.
    fn step(&mut self, pair: &ImuPair, truth: &Truth) {
        let solution = self.estimator.step(pair);
        if self.track.take(&solution, truth) {
            let set = self.pending.iter().find(|set| set.id == solution.params_id);
            self.track.adopt(&solution, set);
            self.pending.retain(|set| set.id > solution.params_id);
        }
        if let Some(parameters) = self.identifier.step(pair, &solution) {
            self.pending.push(parameters);
            self.estimator.offer(parameters);
        }
    }
}

/// Runs the method of a configuration over data; only what its estimator and identifier are told matters. The track keeps a
/// point every `every_s`.
pub fn run(configuration: &Configuration, data: &Data, every_s: f64) -> Track {
    let mut method = Method::new(configuration, every_s);
    data.pairs.iter().zip(&data.truths).for_each(|(pair, truth)| method.step(pair, truth));
    method.track
}

/// The same with parameter sets that are offered before the first pair, each from its time on.
pub fn run_told(configuration: &Configuration, data: &Data, every_s: f64, sets: &[FlexureParams]) -> Track {
    let mut method = Method::new(configuration, every_s);
    for &set in sets {
        method.pending.push(set);
        method.estimator.offer(set);
    }
    data.pairs.iter().zip(&data.truths).for_each(|(pair, truth)| method.step(pair, truth));
    method.track
}

/// Runs the methods of several configurations side by side over the scenario of the first argument, without keeping the data.
///
/// # Errors
/// The scenario has no end or its units are not simulated.
pub fn run_together(scenario: &Configuration, methods: &[Configuration], every_s: f64) -> Result<Vec<Track>, Fault> {
    let mut methods: Vec<Method> = methods.iter().map(|method| Method::new(method, every_s)).collect();
    pairs(scenario, |pair, truth| methods.iter_mut().for_each(|method| method.step(pair, truth)))?;
    Ok(methods.into_iter().map(|method| method.track).collect())
}
