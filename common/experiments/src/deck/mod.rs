//! The project's own estimator on the scenarios of all papers, with one configuration for all of them.
//!
//! It is told nothing of a scenario but the grade of the units and where they stand. Beside it runs, on the same data, the same estimator that is
//! told the true flexure: what separates the two is what identification costs. The error of a run is nearly one constant vector, so
//! that figures of a method alone scatter widely, while the ratio of both on the same data does not.

mod ablation;
mod claims;
mod coupled;
mod honesty;
mod matrix;
mod measure;
mod method;
mod paired;
mod scenario;
mod spikes;
mod troubles;
mod unseen;

use crate::Study;
use scenario::{SCENARIOS, Scenario};

pub(crate) const TITLE: &str = "The project's own estimator: every paper's scenario, one configuration";

const AXES: [&str; 3] = ["x", "y", "z"];

/// The studies of this experiment. A quick run takes some scenarios only, and shortens them.
pub(crate) fn studies() -> Vec<Study> {
    let mut studies: Vec<Study> = SCENARIOS.iter().map(study).collect();
    studies.push(spikes::study());
    studies.extend(unseen::studies());
    studies.extend(ablation::studies());
    studies.extend(coupled::studies());
    studies.extend(troubles::studies());
    studies
}

fn study(scenario: &'static Scenario) -> Study {
    Study::new(
        scenario.trials,
        scenario.cost(),
        |trial| measure::measure(scenario, trial),
        |trials| {
            let told = claims::conclude(scenario, trials);
            told.and(honesty::conclude(scenario, trials)).and(matrix::conclude(scenario, trials))
        },
    )
}
