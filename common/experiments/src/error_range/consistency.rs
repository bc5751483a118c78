//! Without coupling, and with a static part that is known to be constant, the filter is right about itself.

use super::{AXES, HOUR_S};
use crate::{Bound, Claim, Fault, Findings, Published, Trial, mean, pairs, presets, rms};
use frames::unit::ARCSEC;
use frames::{Main, Rot, Sub};
use nalgebra::Matrix3;
use pipeline::configuration::RangeMethod;

const DURATION_S: f64 = 3.0 * HOUR_S;
pub(super) const COST: u64 = DURATION_S as u64 / 10;

/// At the end of a trial.
pub(super) struct Ended {
    /// Of the static part, arcsec.
    error: [f64; 3],
    /// Its deviation by the filter, arcsec.
    sigma: [f64; 3],
    /// `e^T P^-1 e`.
    nees: f64,
}

pub(super) fn measure(trial: &Trial) -> Result<Ended, Fault> {
    let configuration = presets::configuration("error_range_weak", trial.seed)?.with(|c| {
        c.run.duration_s = Some(DURATION_S);
        c.areas[0].simulation.coupling = None;
        c.areas[0].estimator.static_walk = 0.0;
    });
    let mut filter = super::measure::ranged(&configuration, RangeMethod::Naive, [1.0; 3]);
    let mut last = None;
    pairs(&configuration, |pair, truth| last = Some((filter.step(pair), *truth)))?;
    let Some((solution, truth)) = last else {
        return Ok(Ended { error: [f64::NAN; 3], sigma: [f64::NAN; 3], nees: f64::NAN });
    };
    let [found, real] = [solution.static_q, truth.static_q].map(Rot::<Main, Sub>::from_wxyz);
    let error = (found * real.inverse()).log();
    let covariance = Matrix3::from_row_slice(&solution.static_covariance);
    Ok(Ended {
        error: error.array().map(|angle| angle / ARCSEC),
        sigma: [0, 1, 2].map(|axis| covariance[(axis, axis)].sqrt() / ARCSEC),
        nees: covariance.try_inverse().map_or(f64::NAN, |inverse| error.column().dot(&(inverse * error.column()))),
    })
}

pub(super) fn conclude(trials: &[Ended]) -> Findings {
    let nothing = || Published::Nothing("the paper's data are coupled".into());
    let table = || "Without coupling, after three hours".to_owned();
    let row = |axis: usize| {
        let errors: Vec<f64> = trials.iter().map(|trial| trial.error[axis]).collect();
        let claim = Claim {
            id: format!("error-range/uncoupled/rmse/{}", AXES[axis]),
            table: table(),
            row: "RMSE of the static part".into(),
            axis: AXES[axis].into(),
            unit: "arcsec".into(),
            bound: Bound::Value(rms(&trials.iter().map(|trial| trial.sigma[axis]).collect::<Vec<_>>())),
            paper: nothing(),
            why: "The bound is the filter's own deviation, which holds where its model does.".into(),
        };
        claim.rms(&errors)
    };
    let mut rows: Vec<_> = [0, 1, 2].map(row).into();
    let nees: Vec<f64> = trials.iter().map(|trial| trial.nees).collect();
    let claim = Claim {
        id: "error-range/uncoupled/nees".into(),
        table: table(),
        row: "mean normalised squared error".into(),
        axis: "all".into(),
        unit: String::new(),
        bound: Bound::Value(3.0),
        paper: nothing(),
        why: "3 is honest: the filter fails through the coupling and nothing else.".into(),
    };
    rows.push(claim.figure(mean(&nees), &nees));
    Findings { rows, figures: Vec::new() }
}
