//! Table V: the filter with identified parameters.

use super::measure::{FILTERS, Filtered, Measured, TRUE_OF};
use super::{AXES, Ship};
use crate::{Bound, Claim, Published, Row, mean, rms};

/// Table V by axis, mrad: the true angle, the estimate, the absolute error; mean and standard deviation each.
const PAPER: [[(f64, f64); 3]; 3] = [
    [(3.4981, 0.4267), (3.5179, 0.5525), (0.2626, 0.2005)],
    [(3.4792, 0.7209), (3.5131, 0.7776), (0.3259, 0.2369)],
    [(3.5027, 0.4840), (3.5483, 0.5626), (0.1944, 0.1382)],
];
/// The static part of each axis, mrad.
const STATIC: f64 = 3.5;
/// The mean absolute value of a normal error of deviation 1.
const HALF_NORMAL: f64 = 0.797_884_560_8;

/// A figure of a filter in the trials where it ran.
fn values(trials: &[Measured], filter: usize, figure: impl Fn(&Filtered) -> f64) -> Vec<f64> {
    trials.iter().filter_map(|trial| trial.filtered[filter].as_ref()).map(figure).collect()
}

pub(super) fn rows(ship: Ship, trials: &[Measured]) -> Vec<Row> {
    let mut rows = Vec::new();
    for column in 0..2 {
        for axis in 0..3 {
            rows.extend([false, true].map(|deviation| angle_row(ship, trials, column, axis, deviation)));
        }
    }
    for filter in 0..FILTERS.len() {
        for axis in 0..3 {
            rows.extend([false, true].map(|deviation| error_row(ship, trials, filter, axis, deviation)));
        }
    }
    for filter in 0..FILTERS.len() {
        rows.extend((0..3).map(|axis| rmse_row(ship, trials, filter, axis)));
    }
    for filter in (0..FILTERS.len()).filter(|&filter| TRUE_OF[filter] != filter) {
        rows.extend((0..3).map(|axis| ratio_row(ship, trials, filter, axis)));
    }
    rows.extend((0..FILTERS.len()).map(|filter| nees_row(ship, trials, filter)));
    rows
}

fn published(ship: Ship, filter: usize, paper: impl FnOnce() -> Published) -> Published {
    match (ship, FILTERS[filter].0) {
        (Ship::Printed, "tk" | "tk-fine") => paper(),
        (Ship::Printed, _) => Published::Nothing("the paper's filter has its identified parameters only".into()),
        (Ship::BandLimited, _) => Published::Nothing("the paper's ship has no band limit".into()),
    }
}

/// The first two columns, by the first filter.
fn angle_row(ship: Ship, trials: &[Measured], column: usize, axis: usize, deviation: bool) -> Row {
    let (key, name) = [("truth", "true deformation"), ("estimate", "estimated deformation")][column];
    let figure = |(mean, deviation_): (f64, f64)| if deviation { deviation_ } else { mean };
    let values = values(trials, 0, |filtered| figure(filtered.angle[column][axis]));
    let claim = Claim {
        id: format!("{}/table-5/{key}-{}/{}", ship.id(), if deviation { "sd" } else { "mean" }, AXES[axis]),
        table: format!("Table V, angles{}", ship.title()),
        row: format!("{name}, {}", if deviation { "standard deviation" } else { "mean" }),
        axis: AXES[axis].into(),
        unit: "mrad".into(),
        bound: Bound::Value(if deviation { trials[0].truth[axis].sigma * 1e3 } else { STATIC }),
        paper: published(ship, 0, || Published::Magnitude(figure(PAPER[axis][column]), 100)),
        why: if deviation {
            "Within a trial; the bound is the flexure's deviation. Slow errors of the static part widen the estimate's, and how much \
             depends on the time that is left out at the start, which the paper does not tell."
        } else {
            "The static part with what is left of the flexure's mean after ten minutes."
        }
        .into(),
    };
    claim.mean(&values)
}

fn error_row(ship: Ship, trials: &[Measured], filter: usize, axis: usize, deviation: bool) -> Row {
    let (key, name, _, coarse) = FILTERS[filter];
    let values = values(trials, filter, |f| if deviation { f.sd_abs[axis] } else { f.mean_abs[axis] });
    let bound = if deviation {
        Bound::None("the filter's covariance speaks of the square of the error".into())
    } else {
        // what the filter with the true parameters itself expects
        Bound::Value(HALF_NORMAL * rms(&self::values(trials, TRUE_OF[filter], |f| f.sigma[axis])))
    };
    let (paper, paper_sd) = PAPER[axis][2];
    let claim = Claim {
        id: format!("{}/table-5/{}/{key}/{}", ship.id(), if deviation { "sd-abs" } else { "mean-abs" }, AXES[axis]),
        table: format!("Table V, absolute error from 100 s to 600 s{}", ship.title()),
        row: format!("{name}, {}", if deviation { "standard deviation" } else { "mean" }),
        axis: AXES[axis].into(),
        unit: "mrad".into(),
        bound,
        paper: published(ship, filter, || Published::Magnitude(if deviation { paper_sd } else { paper }, 100)),
        why: if coarse {
            "The level of the paper with R = (0.05 mrad)^2; it gives neither R nor the time over which it averages."
        } else {
            "A smaller R uses more of the ship's fast motion, roll above all; the paper gives no R."
        }
        .into(),
    };
    claim.mean(&values)
}

fn rmse_row(ship: Ship, trials: &[Measured], filter: usize, axis: usize) -> Row {
    let (key, name, ..) = FILTERS[filter];
    let claim = Claim {
        id: format!("{}/table-5/rmse/{key}/{}", ship.id(), AXES[axis]),
        table: format!("Table V, RMSE from 100 s to 600 s{}", ship.title()),
        row: name.into(),
        axis: AXES[axis].into(),
        unit: "mrad".into(),
        bound: Bound::Value(rms(&values(trials, TRUE_OF[filter], |f| f.sigma[axis]))),
        paper: Published::Nothing("the paper gives absolute errors".into()),
        why: "Nearly all of it is the error of the static part, which identification hardly touches.".into(),
    };
    claim.rms(&values(trials, filter, |f| f.rmse[axis]))
}

/// On the same data.
fn ratio_row(ship: Ship, trials: &[Measured], filter: usize, axis: usize) -> Row {
    let (key, name, ..) = FILTERS[filter];
    let both: Vec<(f64, f64)> = trials
        .iter()
        .filter_map(|trial| {
            let told = trial.filtered[TRUE_OF[filter]].as_ref()?;
            Some((trial.filtered[filter].as_ref()?.rmse[axis], told.rmse[axis]))
        })
        .collect();
    let (found, told): (Vec<f64>, Vec<f64>) = both.iter().copied().unzip();
    let ratios: Vec<f64> = both.iter().map(|(found, told)| found / told).collect();
    let claim = Claim {
        id: format!("{}/table-5/ratio/{key}/{}", ship.id(), AXES[axis]),
        table: format!("Table V, RMSE over that with the true parameters, on the same data{}", ship.title()),
        row: name.into(),
        axis: AXES[axis].into(),
        unit: String::new(),
        bound: Bound::Value(1.0),
        paper: Published::Nothing("the paper's filter has its identified parameters only".into()),
        why: "Better identification does not improve this filter: its error is the static part's.".into(),
    };
    claim.figure(rms(&found) / rms(&told), &ratios)
}

fn nees_row(ship: Ship, trials: &[Measured], filter: usize) -> Row {
    let (key, name, ..) = FILTERS[filter];
    let values = values(trials, filter, |f| f.nees);
    let claim = Claim {
        id: format!("{}/table-5/nees/{key}", ship.id()),
        table: format!("Table V, mean normalised squared error{}", ship.title()),
        row: name.into(),
        axis: "all".into(),
        unit: String::new(),
        bound: Bound::Value(3.0),
        paper: Published::Nothing("the paper gives no covariance".into()),
        why: "3 is honest; below, the filter is more cautious than it must be.".into(),
    };
    claim.figure(mean(&values), &values)
}
