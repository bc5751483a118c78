//! Section 4: error and ranges of the coupled scenarios.

use super::AXES;
use super::figures;
use super::measure::{Case, Measured, WIDTHS, Width};
use crate::{Bound, Claim, Findings, Published, Row, mean};
use frames::unit::ARCSEC;

/// Both of the paper's sets of F by axis.
const SETS: [[f64; 3]; 2] = [[1.4, 0.8, 2.0], [1.6, 1.0, 2.0]];
/// A range that holds less than this on some axis does not describe the error.
const LOST: f64 = 0.5;
/// A range that holds more than this holds it, but for an instant near an extreme.
const HELD: f64 = 0.99;

pub(super) fn conclude(case: Case, trials: &[Measured]) -> Findings {
    let mut rows = Vec::new();
    for width in 0..WIDTHS.len() {
        rows.extend((0..3).map(|axis| coverage_row(case, trials, width, axis)));
        rows.push(pooled_row(case, trials, width));
        rows.push(least_row(case, trials, width));
    }
    rows.extend((0..3).map(|axis| factor_row(case, trials, axis)));
    rows.extend((0..3).map(|axis| coherence_row(case, trials, axis)));
    for width in 0..WIDTHS.len() {
        rows.extend((0..3).map(|axis| width_row(case, trials, width, axis)));
    }
    rows.extend((0..3).map(|axis| error_row(case, trials, axis)));
    rows.extend((0..3).map(|axis| dynamic_row(case, trials, axis)));
    Findings { rows, figures: figures::ranges(case, trials) }
}

const COVERAGE: &str = "share of time after the first hour at which the range holds the static part's error";

fn table(case: Case, of: &str) -> String {
    format!("Section 4, {of} ({})", case.title())
}

fn coverages(trials: &[Measured], width: usize, axis: usize) -> Vec<f64> {
    trials.iter().map(|trial| trial.coverage(width, axis)).collect()
}

/// Whether most trials are as the paper's one voyage.
fn mostly(values: &[f64], like: impl Fn(f64) -> bool) -> bool {
    2 * values.iter().filter(|value| like(**value)).count() > values.len()
}

/// What the paper shows of a range for the one voyage that it has, whose coupling it does not give.
fn published(width: Width, coverages: &[f64]) -> Published {
    match width {
        Width::Deviations(_) => {
            Published::Statement("cannot include the real error (figure 4a)".into(), mostly(coverages, |c| c < HELD))
        }
        Width::Formula([f, ..]) if f < 1.2 => Published::Nothing("the paper shows no F = 1".into()),
        Width::Formula(_) => Published::Statement(
            "the real error stays within it (figures 4b, 8)".into(),
            mostly(coverages, |c| c >= HELD),
        ),
        Width::Coherent(_) => Published::Nothing("this range is not the paper's".into()),
    }
}

fn why(case: Case, width: Width) -> String {
    let strong = matches!(case, Case::Strong | Case::StrongTurns);
    match (width, strong) {
        (Width::Deviations(_), _) => "The filter takes coherent flexure for a static part and knows nothing of it. The statement holds if it does in most trials: \
             the paper has one voyage.",
        (Width::Formula(_), false) => {
            "The formula is the filter's deviation made about five times larger, enough where little of the flexure is in step; \
             trials with an unlucky coupling leave it."
        }
        (Width::Formula(_), true) => "No F of a weak coupling serves a strong one: the formula does not see the coupling.",
        (Width::Coherent(_), _) => "The range allows for any share F of the flexure to be in step with the ship.",
    }
    .into()
}

/// The claim of a range's coverage.
fn coverage(case: Case, width: usize, axis: &str, paper: Published, why: String) -> Claim {
    let (key, name, _) = WIDTHS[width];
    Claim {
        id: format!("error-range/{}/coverage/{key}/{axis}", case.key()),
        table: table(case, COVERAGE),
        row: name.into(),
        axis: axis.into(),
        unit: String::new(),
        bound: Bound::Value(1.0),
        paper,
        why,
    }
}

fn coverage_row(case: Case, trials: &[Measured], width: usize, axis: usize) -> Row {
    let (.., kind) = WIDTHS[width];
    let values = coverages(trials, width, axis);
    coverage(case, width, AXES[axis], published(kind, &values), why(case, kind)).mean(&values)
}

/// Over all axes.
fn pooled_row(case: Case, trials: &[Measured], width: usize) -> Row {
    let values: Vec<f64> =
        trials.iter().map(|trial| mean(&[0, 1, 2].map(|axis| trial.coverage(width, axis)))).collect();
    let paper = Published::Nothing("the paper shows each axis".into());
    coverage(case, width, "all", paper, "Mean over the axes.".into()).mean(&values)
}

/// The axis that a range serves worst in a trial.
fn least_row(case: Case, trials: &[Measured], width: usize) -> Row {
    let (.., kind) = WIDTHS[width];
    let least = |trial: &Measured| [0, 1, 2].map(|axis| trial.coverage(width, axis)).into_iter().fold(1.0, f64::min);
    let values: Vec<f64> = trials.iter().map(least).collect();
    let paper = match kind {
        Width::Deviations(_) => {
            Published::Statement("cannot include the real error (figure 4a)".into(), mean(&values) < LOST)
        }
        _ => Published::Nothing("the paper shows each axis".into()),
    };
    let why = "Mean over the trials of each trial's worst axis, which a coupling chooses by its direction.";
    coverage(case, width, "least", paper, why.into()).mean(&values)
}

/// The F that would just have held every error.
fn factor_row(case: Case, trials: &[Measured], axis: usize) -> Row {
    let values: Vec<f64> = trials.iter().map(|trial| trial.formula[axis]).collect();
    let [one, other] = SETS.map(|set| set[axis]);
    let claim = Claim {
        id: format!("error-range/{}/best-factor/formula/{}", case.key(), AXES[axis]),
        table: table(case, "least F that holds every error"),
        row: "formula".into(),
        axis: AXES[axis].into(),
        unit: "1/sqrt(s)".into(),
        bound: Bound::None("F is made from the error itself: nothing bounds it".into()),
        paper: Published::Range(one.min(other), one.max(other)),
        why: "The paper's two sets, 1.4, 0.8, 2 and 1.6, 1, 2, are such figures of one ship; F follows the coupling, trial by trial.".into(),
    };
    claim.mean(&values)
}

fn coherence_row(case: Case, trials: &[Measured], axis: usize) -> Row {
    let values: Vec<f64> = trials.iter().map(|trial| trial.coherent[axis].max(0.0)).collect();
    let claim = Claim {
        id: format!("error-range/{}/best-factor/coherence/{}", case.key(), AXES[axis]),
        table: table(case, "least F that holds every error"),
        row: "coherence".into(),
        axis: AXES[axis].into(),
        unit: String::new(),
        bound: Bound::Value(1.0),
        paper: Published::Nothing("this range is not the paper's".into()),
        why: "A share of the flexure, so that 1 is nearly always enough.".into(),
    };
    claim.mean(&values)
}

fn width_row(case: Case, trials: &[Measured], width: usize, axis: usize) -> Row {
    let (key, name, _) = WIDTHS[width];
    let values: Vec<f64> = trials.iter().map(|trial| trial.width(width, axis) / ARCSEC).collect();
    let claim = Claim {
        id: format!("error-range/{}/width/{key}/{}", case.key(), AXES[axis]),
        table: table(case, "mean half width"),
        row: name.into(),
        axis: AXES[axis].into(),
        unit: "arcsec".into(),
        bound: Bound::Value(mean(&trials.iter().map(|trial| trial.rmse(axis) / ARCSEC).collect::<Vec<_>>())),
        paper: Published::Nothing("figures without numbers".into()),
        why: "The bound is the error that the range has to hold.".into(),
    };
    claim.mean(&values)
}

fn error_row(case: Case, trials: &[Measured], axis: usize) -> Row {
    let sigma: Vec<f64> = trials.iter().map(|trial| trial.sigma(axis) / ARCSEC).collect();
    let claim = Claim {
        id: format!("error-range/{}/rmse/static/{}", case.key(), AXES[axis]),
        table: table(case, "error of the filter"),
        row: "static part".into(),
        axis: AXES[axis].into(),
        unit: "arcsec".into(),
        bound: Bound::Value(crate::rms(&sigma)),
        paper: Published::Nothing("figures without numbers, from data that are not published".into()),
        why: "The bound is the filter's own deviation, right where nothing is coupled.".into(),
    };
    claim.rms(&trials.iter().map(|trial| trial.rmse(axis) / ARCSEC).collect::<Vec<_>>())
}

/// Half of the flexure's deviation, arcsec: a better estimate than none.
const ACCURATE: f64 = 6.0;

fn dynamic_row(case: Case, trials: &[Measured], axis: usize) -> Row {
    let values: Vec<f64> = trials.iter().map(|trial| trial.dynamic_rmse(axis) / ARCSEC).collect();
    let claim = Claim {
        id: format!("error-range/{}/rmse/dynamic/{}", case.key(), AXES[axis]),
        table: table(case, "error of the filter"),
        row: "dynamic part".into(),
        axis: AXES[axis].into(),
        unit: "arcsec".into(),
        bound: Bound::None("the dynamic part's error goes with the static part's".into()),
        paper: Published::Statement("can be estimated accurately".into(), crate::rms(&values) < ACCURATE),
        why: "A fraction of the flexure's 11.9 arcsec at any coupling.".into(),
    };
    claim.rms(&values)
}
