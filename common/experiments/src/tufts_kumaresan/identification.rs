//! Table IV: means and standard deviations of the identified parameters.

use super::measure::{Measured, Parameters, TK, WAYS, WHITTLE, parameters};
use super::scene::DURATION_S;
use super::{AXES, Ship};
use crate::{Bound, Claim, Published, Row, mean, spread};
use estimation::identify::Kind;
use estimation::identify::bound::{self, Band};

const NAMES: [(&str, &str, &str); 3] =
    [("sigma", "magnitude", "mrad"), ("f", "frequency", "Hz"), ("alpha", "damping", "1/s")];

/// Table IV by axis and parameter: mean, standard deviation over 100 trials.
const PAPER: [[(f64, f64); 3]; 3] = [
    [(0.3950, 0.0064), (0.1892, 0.0041), (0.1272, 0.0252)],
    [(0.6722, 0.0089), (0.1685, 0.0039), (0.1054, 0.0188)],
    [(0.4961, 0.0075), (0.1798, 0.0034), (0.1013, 0.0183)],
];

/// The band in which the flexure stands out, Hz.
const BAND_HZ: (f64, f64) = (0.02, 1.5);

/// Standard deviations that no unbiased method can be below.
pub(super) fn bound(trial: &Measured, axis: usize) -> Option<bound::Bound> {
    let band = Band { kind: Kind::Angles, step_s: 0.05, hz: BAND_HZ };
    bound::Bound::new(&trial.truth[axis], DURATION_S, band, 0.0)
}

fn bounds(trial: &Measured, axis: usize) -> Option<Parameters> {
    let bound = bound(trial, axis)?;
    Some([bound.sigma_sd() * 1e3, bound.frequency_sd_hz()?, bound.mu_sd()])
}

/// What a way found of a parameter, where it found anything.
pub(super) fn values(trials: &[Measured], way: usize, axis: usize, parameter: usize) -> Vec<f64> {
    trials.iter().filter_map(|trial| trial.found[way].map(|axes| axes[axis][parameter])).collect()
}

pub(super) fn rows(ship: Ship, trials: &[Measured]) -> Vec<Row> {
    let mut rows = Vec::new();
    let ways: Vec<usize> = if ship == Ship::Printed { (0..WAYS.len()).collect() } else { vec![TK, WHITTLE] };
    for &way in &ways {
        for axis in 0..3 {
            for parameter in 0..3 {
                rows.push(mean_row(ship, trials, way, axis, parameter));
            }
        }
    }
    for &way in &ways {
        for axis in 0..3 {
            for parameter in 0..3 {
                rows.push(deviation_row(ship, trials, way, axis, parameter));
            }
        }
    }
    for way in [TK, WHITTLE] {
        rows.extend((0..3).map(|axis| realised_row(ship, trials, way, axis)));
    }
    rows.push(share_row(ship, trials));
    rows
}

fn published(ship: Ship, way: usize, paper: impl FnOnce() -> Published) -> Published {
    match (ship, way) {
        (Ship::Printed, TK) => paper(),
        (Ship::Printed, _) => Published::Nothing("the paper identifies by Tufts and Kumaresan's method only".into()),
        (Ship::BandLimited, _) => Published::Nothing("the paper's ship has no band limit".into()),
    }
}

fn mean_row(ship: Ship, trials: &[Measured], way: usize, axis: usize, parameter: usize) -> Row {
    let (key, name, unit) = NAMES[parameter];
    let (paper, sd) = PAPER[axis][parameter];
    let claim = Claim {
        id: format!("{}/table-4/mean/{}/{key}/{}", ship.id(), WAYS[way].key, AXES[axis]),
        table: format!("Table IV, means (bound: the true value){}", ship.title()),
        row: format!("{}: {name}", WAYS[way].name),
        axis: AXES[axis].into(),
        unit: unit.into(),
        bound: Bound::Value(parameters(&trials[0].truth[axis])[parameter]),
        paper: published(ship, way, || Published::Spread(paper, sd)),
        why: match WAYS[way].key {
            "tk" => "Two passes and a sharp high-pass filter, as the paper describes; the cut costs the frequency up to 1 %.",
            "tk-first-pass" => "What the static part adds to the angle is of the flexure's size, not \"very small\".",
            _ => {
                "A line taken out instead of the high-pass filter leaves no such bias; in a third pass, as the first is now and then \
                 misled by the ship."
            }
        }
        .into(),
    };
    claim.mean(&values(trials, way, axis, parameter))
}

fn deviation_row(ship: Ship, trials: &[Measured], way: usize, axis: usize, parameter: usize) -> Row {
    let (key, name, unit) = NAMES[parameter];
    let values = values(trials, way, axis, parameter);
    let claim = Claim {
        id: format!("{}/table-4/sd/{}/{key}/{}", ship.id(), WAYS[way].key, AXES[axis]),
        table: format!("Table IV, standard deviations over the trials (bound: Cramer-Rao){}", ship.title()),
        row: format!("{}: {name}", WAYS[way].name),
        axis: AXES[axis].into(),
        unit: unit.into(),
        bound: bounds(&trials[0], axis).map_or_else(
            || Bound::None("the band says nothing of the parameter".into()),
            |bounds| Bound::Value(bounds[parameter]),
        ),
        paper: published(ship, way, || Published::Magnitude(PAPER[axis][parameter].1, 100)),
        why: match (key, way) {
            ("sigma", _) => {
                "Ten minutes of a random process have a size of their own: the paper's deviation is a quarter of what is possible, \
                 unless it is meant against the size that the trial really had, as below."
            }
            (_, WHITTLE) => "Maximum likelihood is near the bound.",
            _ => "Methods of the autocovariance use less of the data than maximum likelihood.",
        }
        .into(),
    };
    claim.figure(spread(&values), &values)
}

/// The magnitude against the one that the flexure really had.
fn realised_row(ship: Ship, trials: &[Measured], way: usize, axis: usize) -> Row {
    let differences: Vec<f64> =
        trials.iter().filter_map(|trial| trial.found[way].map(|axes| axes[axis][0] - trial.realised[axis])).collect();
    let claim = Claim {
        id: format!("{}/table-4/realised/{}/sigma/{}", ship.id(), WAYS[way].key, AXES[axis]),
        table: format!("Table IV, magnitude less the trial's own, standard deviation{}", ship.title()),
        row: WAYS[way].name.into(),
        axis: AXES[axis].into(),
        unit: "mrad".into(),
        bound: Bound::None("the Cramer-Rao bound is about the process, not about one draw of it".into()),
        paper: published(ship, way, || Published::Magnitude(PAPER[axis][0].1, 100)),
        why: "Against the deviation of the very data the paper's figure comes out: that is what it must mean.".into(),
    };
    claim.figure(spread(&differences), &differences)
}

/// How often the paper's way gave a model on all axes.
fn share_row(ship: Ship, trials: &[Measured]) -> Row {
    let gave: Vec<f64> = trials.iter().map(|trial| f64::from(u8::from(trial.found[TK].is_some()))).collect();
    let claim = Claim {
        id: format!("{}/table-4/share/tk", ship.id()),
        table: format!("Table IV, share of trials with a model on all axes{}", ship.title()),
        row: WAYS[TK].name.into(),
        axis: "all".into(),
        unit: String::new(),
        bound: Bound::Value(1.0),
        paper: published(ship, TK, || Published::Nothing("the paper tells of no failures".into())),
        why: "A trial without a decaying mode would be left out of the means.".into(),
    };
    claim.figure(mean(&gave), &gave)
}
