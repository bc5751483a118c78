//! Paper 003: identification of the flexure from the angle between two attitudes by Tufts and Kumaresan's method and its rivals, and
//! the filter of 21 states with what they find; with the ship as printed and without motion above 0.4 Hz.

mod figures;
mod filter;
mod identification;
mod measure;
mod scene;
mod sweep;

use crate::{Findings, Study, Trials};
use measure::{FILTERS, Measured, SNR_DB, measure};

pub(crate) const TITLE: &str = "Paper 003: flexure parameters by Tufts and Kumaresan's method, attitude matching";

const AXES: [&str; 3] = ["x", "y", "z"];

/// Which ship.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Ship {
    Printed,
    BandLimited,
}

impl Ship {
    /// Before the keys of its rows.
    fn id(self) -> &'static str {
        match self {
            Self::Printed => "tufts-kumaresan",
            Self::BandLimited => "tufts-kumaresan/band-limited",
        }
    }

    /// Behind the titles of its tables.
    fn title(self) -> &'static str {
        match self {
            Self::Printed => "",
            Self::BandLimited => ", ship without motion above 0.4 Hz",
        }
    }
}

/// The studies of this paper.
pub(crate) fn studies() -> Vec<Study> {
    let filters = FILTERS.len() as u64 + 2;
    let cost = |filters: u64| scene::DURATION_S as u64 * filters;
    vec![
        Study::new(
            Trials { full: 100, quick: 6 },
            cost(filters + SNR_DB.len() as u64),
            |trial| measure("tufts_kumaresan", true, trial),
            |trials| conclude(Ship::Printed, trials),
        ),
        Study::new(
            Trials { full: 100, quick: 3 },
            cost(filters),
            |trial| measure("tufts_kumaresan_band_limited", false, trial),
            |trials| conclude(Ship::BandLimited, trials),
        ),
    ]
}

fn conclude(ship: Ship, trials: &[Measured]) -> Findings {
    let mut rows = identification::rows(ship, trials);
    rows.extend(filter::rows(ship, trials));
    let mut figures = figures::identification(ship, trials);
    figures.extend(figures::filter(ship, trials));
    if ship == Ship::Printed {
        let swept: Vec<&Measured> = trials.iter().filter(|trial| !trial.sweep.is_empty()).collect();
        rows.extend(sweep::rows(&swept));
        figures.extend(sweep::figures(&swept));
    }
    Findings { rows, figures }
}
