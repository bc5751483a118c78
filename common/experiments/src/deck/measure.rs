//! One trial: the estimator, the same told the truth, and rivals, over the same data.

use super::method::{self, Knowledge, Rival, run_blind, run_true};
use super::paired::Paired;
use super::scenario::Scenario;
use crate::{Data, Fault, Point, Track, Trial};
use std::ops::RangeInclusive;

/// The spans of time in which errors count, s: after five minutes, and the minutes before.
pub(super) const SPANS: [RangeInclusive<f64>; 2] = [EARLY_S..=f64::INFINITY, FROM_S..=EARLY_S];
/// An estimate is expected from here on, s.
const FROM_S: f64 = 60.0;
/// The end of the first minutes, s.
pub(super) const EARLY_S: f64 = 300.0;

/// No method knows of a change at once: an identification needs data of the flexure that is new, half a minute being five of its swings.
pub(super) const TOLD_LATER_S: f64 = 30.0;

/// What is kept of a trial.
#[derive(Clone, Debug)]
pub(super) struct Measured {
    pub seed: u64,
    /// Over the same estimator told the truth, by span.
    pub truth: [Option<Paired>; 2],
    /// Of the same told of changes of the flexure [`TOLD_LATER_S`] later than they happen, over the one told the truth, after five minutes; only where there are any.
    pub told_later: Option<Paired>,
    /// Over each rival, after five minutes.
    pub rivals: Vec<Beside>,
    /// The estimator's own figures, then those of the one told the truth.
    pub honesty: [Honesty; 2],
}

/// The estimator beside another method.
#[derive(Clone, Copy, Debug)]
pub(super) struct Beside {
    /// As it is.
    pub as_it_is: Option<Paired>,
    /// Told what the other takes for known, if there is anything.
    pub as_knowing: Option<Paired>,
    /// Told the true flexure, and nothing of what the other takes for known.
    pub as_true: Option<Paired>,
}

/// What a method says of its own error, against that error.
#[derive(Clone, Copy, Debug)]
pub(super) struct Honesty {
    /// `e^T P^-1 e` at the end.
    pub nees: f64,
    /// The largest error over its standard deviation in the first five minutes.
    pub early: f64,
    /// Share of the errors that the range holds.
    pub coverage: [f64; 3],
    /// Share of the instants at which there is an estimate.
    pub valid: f64,
    /// The largest change of the error from one pair to the next, over the range before it.
    pub step: f64,
}

impl Honesty {
    fn of(track: &Track) -> Self {
        let over = track.over(FROM_S..);
        let valid = |point: &&Point| point.valid;
        let early = track.over(..=EARLY_S).points.iter().filter(valid).map(|point| worst(point.error, point.sigma()));
        let steps = track.points.windows(2).filter(|pair| pair.iter().all(|point| point.valid)).map(|pair| {
            let change = [0, 1, 2].map(|axis| pair[1].error[axis] - pair[0].error[axis]);
            worst(change, pair[0].range)
        });
        Self {
            nees: track.points.iter().rfind(valid).map_or(f64::NAN, Point::nees),
            early: early.fold(f64::NAN, f64::max),
            coverage: over.coverage(|point| point.range),
            valid: over.valid_share(),
            step: steps.fold(f64::NAN, f64::max),
        }
    }
}

/// The largest of three values in terms of others.
fn worst(values: [f64; 3], of: [f64; 3]) -> f64 {
    [0, 1, 2].map(|axis| values[axis].abs() / of[axis]).into_iter().fold(0.0, f64::max)
}

/// Two methods over the same data, by span.
pub(super) fn paired(ours: &Track, other: &Track) -> [Option<Paired>; 2] {
    SPANS.map(|span| Paired::of(ours.over(span.clone()), other.over(span)))
}

/// `None` of a scenario that a quick run leaves out.
pub(super) fn measure(scenario: &Scenario, trial: &Trial) -> Result<Option<Measured>, Fault> {
    let Some(configuration) = scenario.configuration(trial)? else { return Ok(None) };
    let data = Data::simulate(&configuration)?;
    let default = method::default(&configuration);
    let ours = run_blind(&default, &data);
    let told = method::told(&default);
    let truth = run_true(&told, &data, 0.0);
    let changes = !configuration.areas[0].simulation.flexure_changes.is_empty();
    let later = changes.then(|| run_true(&told, &data, TOLD_LATER_S));
    let knowing = |knowledge: Knowledge| (knowledge.what, run_blind(&default.with(knowledge.tell), &data));
    let knowing: Vec<(&str, Track)> = scenario.knowledge().into_iter().map(knowing).collect();
    let beside = |rival: &Rival| -> Result<Beside, Fault> {
        let other = run_blind(&rival.on(&configuration)?, &data);
        let told_so = |knowledge: Knowledge| knowing.iter().find(|(what, _)| *what == knowledge.what);
        let as_knowing = rival.knowledge().and_then(told_so).and_then(|(_, track)| paired(track, &other)[0]);
        let [as_it_is, as_true] = [&ours, &truth].map(|track| paired(track, &other)[0]);
        Ok(Beside { as_it_is, as_knowing, as_true })
    };
    Ok(Some(Measured {
        seed: trial.seed,
        rivals: scenario.rivals.iter().map(beside).collect::<Result<_, Fault>>()?,
        truth: paired(&ours, &truth),
        told_later: later.and_then(|later| paired(&later, &truth)[0]),
        honesty: [Honesty::of(&ours), Honesty::of(&truth)],
    }))
}
