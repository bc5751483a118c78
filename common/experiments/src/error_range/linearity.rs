//! Figure 6: the range against F, by as many filters.

use super::measure::ranged;
use super::{AXES, HOUR_S};
use crate::{Bound, Claim, Fault, Figure, Findings, Label, Line, Plot, Published, Stroke, Trial, mean, pairs, presets};
use frames::unit::{ARCSEC, seconds};
use pipeline::configuration::RangeMethod;

const FACTORS: [f64; 5] = [0.4, 0.8, 1.2, 1.6, 2.0];
const DURATION_S: f64 = 2.0 * HOUR_S;
pub(super) const COST: u64 = DURATION_S as u64 / 10 * FACTORS.len() as u64;
/// A range this near to a straight line through the origin is linear.
const LINEAR: f64 = 1e-9;

/// Mean half width of the second hour by factor and axis, arcsec.
type Widths = [[f64; 3]; FACTORS.len()];

pub(super) fn measure(trial: &Trial) -> Result<Widths, Fault> {
    let configuration =
        presets::configuration("error_range_weak", trial.seed)?.with(|c| c.run.duration_s = Some(DURATION_S));
    let mut filters = FACTORS.map(|factor| ranged(&configuration, RangeMethod::ErrorRange, [factor; 3]));
    let mut widths = Widths::default();
    let mut count = 0.0;
    pairs(&configuration, |pair, _| {
        let counts = seconds(pair.header.time_ns) >= HOUR_S;
        count += f64::from(u8::from(counts));
        for (filter, widths) in filters.iter_mut().zip(&mut widths) {
            let range = filter.step(pair).range;
            if counts {
                (0..3).for_each(|axis| widths[axis] += range[axis] / ARCSEC);
            }
        }
    })?;
    Ok(widths.map(|axes| axes.map(|sum| sum / count)))
}

pub(super) fn conclude(trials: &[Widths]) -> Findings {
    let width = |factor: usize, axis: usize| mean(&trials.iter().map(|trial| trial[factor][axis]).collect::<Vec<_>>());
    let last = FACTORS.len() - 1;
    let row = |axis: usize| {
        let slope = |factor: usize| width(factor, axis) / FACTORS[factor];
        let departure = (0..last).map(|factor| (slope(factor) / slope(last) - 1.0).abs()).fold(0.0, f64::max);
        let claim = Claim {
            id: format!("error-range/linearity/{}", AXES[axis]),
            table: "Figure 6, the formula's range against F".into(),
            row: "largest relative departure from a line through the origin".into(),
            axis: AXES[axis].into(),
            unit: String::new(),
            bound: Bound::Value(0.0),
            paper: Published::Statement("increases linearly as F getting greater".into(), departure < LINEAR),
            why: "F multiplies the predicted error of the rate (eq 32), on which the range depends linearly.".into(),
        };
        claim.mean(&[departure])
    };
    let line = |axis: usize| Line {
        name: AXES[axis].into(),
        stroke: Stroke::Solid,
        points: FACTORS.iter().enumerate().map(|(factor, f)| (*f, width(factor, axis))).collect(),
    };
    Findings {
        rows: [0, 1, 2].map(row).into(),
        figures: vec![Figure {
            title: "The formula's range against F".into(),
            caption: "Figure 6 of the paper: mean over the second hour and the trials.".into(),
            plot: Plot::Lines {
                x: Label::new("F", "1/sqrt(s)"),
                y: Label::new("half width", "arcsec"),
                lines: [0, 1, 2].map(line).into(),
            },
        }],
    }
}
