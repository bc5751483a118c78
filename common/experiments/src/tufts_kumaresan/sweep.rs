//! Figure 3: errors against the signal-to-noise ratio.

use super::AXES;
use super::measure::{Measured, SNR_DB, parameters};
use crate::{Bound, Claim, Figure, Label, Line, Plot, Published, Row, Stroke, mean, rms};

const NAMES: [&str; 3] = ["magnitude", "frequency", "damping"];
const KEYS: [&str; 3] = ["sigma", "f", "alpha"];
/// Errors are "similar" if they differ by no more than this.
const SIMILAR: f64 = 1.35;

/// Relative errors of a parameter on all axes, in per cent.
fn errors(trials: &[&Measured], ratio: usize, parameter: usize) -> Vec<f64> {
    let of = |trial: &&Measured| {
        let truth = trial.truth.map(|axis| parameters(&axis)[parameter]);
        let found = trial.sweep[ratio].found;
        found.map(|axes| [0, 1, 2].map(|axis| 100.0 * (axes[axis][parameter] / truth[axis] - 1.0)))
    };
    trials.iter().filter_map(of).flatten().collect()
}

/// The filter's mean absolute error about an axis, mrad.
fn filtered(trials: &[&Measured], ratio: usize, axis: usize) -> Vec<f64> {
    trials.iter().filter_map(|trial| trial.sweep[ratio].mean_abs).map(|errors| errors[axis]).collect()
}

pub(super) fn rows(trials: &[&Measured]) -> Vec<Row> {
    let mut rows = Vec::new();
    let last = SNR_DB.len() - 1;
    for parameter in 0..3 {
        rows.extend((0..SNR_DB.len()).map(|ratio| error_row(trials, ratio, parameter)));
        let ratio = rms(&errors(trials, 0, parameter)) / rms(&errors(trials, last, parameter));
        rows.push(flat_row(KEYS[parameter], NAMES[parameter], ratio));
    }
    for axis in 0..3 {
        rows.extend((0..SNR_DB.len()).map(|ratio| filter_row(trials, ratio, axis)));
    }
    rows
}

fn error_row(trials: &[&Measured], ratio: usize, parameter: usize) -> Row {
    let errors = errors(trials, ratio, parameter);
    let claim = Claim {
        id: format!("tufts-kumaresan/figure-3/{}/{}", KEYS[parameter], SNR_DB[ratio]),
        table: "Figure 3a-c, relative error of the parameters against the signal-to-noise ratio".into(),
        row: format!("{}, {} dB", NAMES[parameter], SNR_DB[ratio]),
        axis: "all".into(),
        unit: "%".into(),
        bound: Bound::None("Table IV has the bound without noise, which the lags from 1 on hardly see".into()),
        paper: Published::Nothing("a figure without numbers".into()),
        why: "Root mean square over trials and axes.".into(),
    };
    claim.rms(&errors)
}

fn flat_row(key: &str, name: &str, ratio: f64) -> Row {
    let claim = Claim {
        id: format!("tufts-kumaresan/figure-3/{key}/flat"),
        table: "Figure 3a-c, relative error of the parameters against the signal-to-noise ratio".into(),
        row: format!("{name}, error at 5 dB over that at 30 dB"),
        axis: "all".into(),
        unit: String::new(),
        bound: Bound::Value(1.0),
        paper: Published::Statement("similar across the range of the SNR".into(), ratio <= SIMILAR),
        why: "White noise is in the lag 0 of the autocovariance alone, and that is left out.".into(),
    };
    claim.mean(&[ratio])
}

fn filter_row(trials: &[&Measured], ratio: usize, axis: usize) -> Row {
    let claim = Claim {
        id: format!("tufts-kumaresan/figure-3/filter/{}/{}", SNR_DB[ratio], AXES[axis]),
        table: "Figure 3d, mean absolute error of the filter against the signal-to-noise ratio".into(),
        row: format!("{} dB", SNR_DB[ratio]),
        axis: AXES[axis].into(),
        unit: "mrad".into(),
        bound: Bound::None("Table V has the filter's own deviation without noise".into()),
        paper: Published::Nothing("a figure without numbers".into()),
        why: "The filter is told the noise; without, its error is that of Table V.".into(),
    };
    claim.mean(&filtered(trials, ratio, axis))
}

pub(super) fn figures(trials: &[&Measured]) -> Vec<Figure> {
    if trials.is_empty() {
        return Vec::new();
    }
    let line = |name: &str, value: &dyn Fn(usize) -> f64| Line {
        name: name.into(),
        stroke: Stroke::Solid,
        points: (0..SNR_DB.len()).map(|ratio| (SNR_DB[ratio], value(ratio))).collect(),
    };
    let figure = |title: &str, y: Label, lines| Figure {
        title: title.into(),
        caption: "Figure 3 of the paper: nothing gets worse with the noise but a little at 5 dB.".into(),
        plot: Plot::Lines { x: Label::new("signal-to-noise ratio", "dB"), y, lines },
    };
    let parameter = |p: usize| line(NAMES[p], &|ratio| rms(&errors(trials, ratio, p)));
    let axis = |a: usize| line(AXES[a], &|ratio| mean(&filtered(trials, ratio, a)));
    vec![
        figure("Identification in noise", Label::new("relative error", "%"), [0, 1, 2].map(parameter).into()),
        figure("The filter in noise", Label::new("mean absolute error", "mrad"), [0, 1, 2].map(axis).into()),
    ]
}
