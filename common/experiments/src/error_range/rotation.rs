//! Section 3: a coupling that is in phase with the ship and antisymmetric moves the static part by exactly its own size.

use super::{AXES, HOUR_S};
use crate::{Bound, Claim, Fault, Findings, Published, Trial, mean, pairs, presets};
use frames::unit::{ARCSEC, seconds};
use frames::{Main, Rot, Sub, Vec3};
use pipeline::configuration::{Configuration, RangeMethod};

/// arcsec.
const ROTATION: [f64; 3] = [30.0, -20.0, 50.0];
const DURATION_S: f64 = 2.0 * HOUR_S;
pub(super) const COST: u64 = DURATION_S as u64 / 10 * 2;
/// The shift is the rotation, within so much of it: theory is to first order.
const NEAR: f64 = 0.05;

/// By how much the coupling moves the mean estimate of the second hour, arcsec.
pub(super) fn measure(trial: &Trial) -> Result<[f64; 3], Fault> {
    let with = |rotation: Vec3<Main>| -> Result<Configuration, Fault> {
        Ok(presets::configuration("error_range_weak", trial.seed)?.with(|c| {
            c.run.duration_s = Some(DURATION_S);
            if let Some(coupling) = &mut c.areas[0].simulation.coupling {
                coupling.share = 0.0;
                coupling.in_phase_rotation = rotation;
            }
        }))
    };
    let plain = estimate(&with(Vec3::ZERO)?)?;
    let moved = estimate(&with(Vec3::from(ROTATION.map(|angle| angle * ARCSEC)))?)?;
    Ok([0, 1, 2].map(|axis| (moved[axis] - plain[axis]) / ARCSEC))
}

/// Mean estimate of the static part over the second hour, rad.
fn estimate(configuration: &Configuration) -> Result<[f64; 3], Fault> {
    let mut filter = super::measure::ranged(configuration, RangeMethod::Naive, [1.0; 3]);
    let (mut sum, mut count) = ([0.0; 3], 0.0);
    pairs(configuration, |pair, _| {
        let solution = filter.step(pair);
        if seconds(pair.header.time_ns) >= HOUR_S {
            let angle = Rot::<Main, Sub>::from_wxyz(solution.static_q).log().array();
            (0..3).for_each(|axis| sum[axis] += angle[axis]);
            count += 1.0;
        }
    })?;
    Ok(sum.map(|sum| sum / count))
}

pub(super) fn conclude(trials: &[[f64; 3]]) -> Findings {
    let row = |axis: usize| {
        let values: Vec<f64> = trials.iter().map(|shift| shift[axis]).collect();
        let holds = (mean(&values) - ROTATION[axis]).abs() <= NEAR * ROTATION[axis].abs();
        let claim = Claim {
            id: format!("error-range/rotation/{}", AXES[axis]),
            table: "Section 3, shift of the static part by a coupling K = -[e x]".into(),
            row: format!("e = {:.0}, {:.0}, {:.0} arcsec", ROTATION[0], ROTATION[1], ROTATION[2]),
            axis: AXES[axis].into(),
            unit: "arcsec".into(),
            bound: Bound::Value(ROTATION[axis]),
            paper: Published::Statement(
                "the coupling leads to the estimation error of the static part (eq 29)".into(),
                holds,
            ),
            why: "To the gyros such a flexure is a static angle: no processing of the same data can tell them apart."
                .into(),
        };
        claim.mean(&values)
    };
    Findings { rows: [0, 1, 2].map(row).into(), figures: Vec::new() }
}
