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
mod month;
mod paired;
mod scenario;
mod spikes;
mod troubles;
mod unseen;

use crate::Study;
use scenario::{SCENARIOS, Scenario};

pub(crate) const SCENARIOS_TITLE: &str = "The project's own estimator: every paper's scenario, one configuration";
pub(crate) const UNSEEN_TITLE: &str = "The project's own estimator: motion that does not show the installation";
pub(crate) const TROUBLES_TITLE: &str = "The project's own estimator: what goes wrong on a ship";
pub(crate) const COUPLING_TITLE: &str = "The project's own estimator: flexure in step with the ship";
pub(crate) const MONTH_TITLE: &str = "The project's own estimator: a month at sea";
pub(crate) const PARTS_TITLE: &str = "The project's own estimator: what each part is good for";

const AXES: [&str; 3] = ["x", "y", "z"];

/// The papers' scenarios and spikes. A quick run takes some scenarios only, and shortens them.
pub(crate) fn scenarios() -> Vec<Study> {
    SCENARIOS.iter().map(study).chain([spikes::study()]).collect()
}

pub(crate) use ablation::studies as parts;
pub(crate) use coupled::studies as coupling;
pub(crate) use month::studies as month;
pub(crate) use troubles::studies as troubles;
pub(crate) use unseen::studies as unseen;

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
