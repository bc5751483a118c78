//! Paper 004: rate matching over nineteen hours while part of the flexure is in step with the ship, and how far ranges of the static part
//! reach against its error.

mod claims;
mod consistency;
mod figures;
mod linearity;
mod measure;
mod rotation;

use crate::{Study, Trials};
use measure::Case;

pub(crate) const TITLE: &str = "Paper 004: rate matching, the error range of the static part";

const AXES: [&str; 3] = ["x", "y", "z"];
const HOUR_S: f64 = 3600.0;

/// The studies of this paper.
pub(crate) fn studies() -> Vec<Study> {
    let mut studies: Vec<Study> = Case::ALL.into_iter().map(coupled).collect();
    studies.push(Study::new(Trials { full: 8, quick: 1 }, linearity::COST, linearity::measure, linearity::conclude));
    studies.push(Study::new(Trials { full: 8, quick: 2 }, rotation::COST, rotation::measure, rotation::conclude));
    studies.push(Study::new(
        Trials { full: 40, quick: 6 },
        consistency::COST,
        consistency::measure,
        consistency::conclude,
    ));
    studies
}

fn coupled(case: Case) -> Study {
    let trials = if case.turns() { Trials { full: 8, quick: 2 } } else { Trials { full: 12, quick: 4 } };
    Study::new(
        trials,
        measure::COST,
        move |trial| measure::measure(case, trial),
        move |trials| claims::conclude(case, trials),
    )
}
