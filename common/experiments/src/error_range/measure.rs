//! One trial: the filter with three ranges over the same data, and what the ranges hold of the static part's error.

use super::HOUR_S;
use crate::{Fault, Trial, pairs, presets};
use estimation::Estimator;
use frames::unit::seconds;
use frames::{Main, Rot, Sub};
use messages::{ImuPair, Solution, Truth};
use pipeline::configuration::{Configuration, RangeMethod};
use pipeline::lane;

/// Full length of a trial, and that of a quick one, s.
const DURATION_S: (f64, f64) = (19.0 * HOUR_S, 3.0 * HOUR_S);
/// For the progress bar: three filters.
pub(super) const COST: u64 = 3 * DURATION_S.0 as u64 / 10;
/// Figures count from here on: the first window of the ranges is full.
const FROM_S: f64 = HOUR_S;
/// Between two instants of a figure, s.
const SERIES_S: f64 = 120.0;

/// A scenario.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Case {
    Weak,
    Strong,
    WeakTurns,
    StrongTurns,
}

impl Case {
    pub(super) const ALL: [Self; 4] = [Self::Weak, Self::Strong, Self::WeakTurns, Self::StrongTurns];

    pub(super) fn key(self) -> &'static str {
        match self {
            Self::Weak => "weak",
            Self::Strong => "strong",
            Self::WeakTurns => "weak-turns",
            Self::StrongTurns => "strong-turns",
        }
    }

    pub(super) fn title(self) -> &'static str {
        match self {
            Self::Weak => "weak coupling",
            Self::Strong => "strong coupling",
            Self::WeakTurns => "weak coupling, turns",
            Self::StrongTurns => "strong coupling, turns",
        }
    }

    pub(super) fn turns(self) -> bool {
        matches!(self, Self::WeakTurns | Self::StrongTurns)
    }

    fn preset(self) -> &'static str {
        match self {
            Self::Weak => "error_range_weak",
            Self::Strong => "error_range_strong",
            Self::WeakTurns => "error_range_weak_turns",
            Self::StrongTurns => "error_range_strong_turns",
        }
    }
}

/// A range of the static part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Width {
    /// So many deviations of the filter.
    Deviations(f64),
    /// The paper's formula with F an axis.
    Formula([f64; 3]),
    /// By coherence with F.
    Coherent(f64),
}

/// The ranges whose coverage is told, with key and name.
pub(super) const WIDTHS: [(&str, &str, Width); 8] = [
    ("naive", "three deviations of the filter", Width::Deviations(3.0)),
    ("formula-1", "formula, F = 1", Width::Formula([1.0; 3])),
    ("formula-2", "formula, F = 2", Width::Formula([2.0; 3])),
    ("formula-3", "formula, F = 3", Width::Formula([3.0; 3])),
    ("formula-4.2", "formula, F = 1.4, 0.8, 2 (section 4.2)", Width::Formula([1.4, 0.8, 2.0])),
    ("formula-5", "formula, F = 1.6, 1, 2 (conclusion)", Width::Formula([1.6, 1.0, 2.0])),
    ("coherence-0.5", "coherence, F = 0.5", Width::Coherent(0.5)),
    ("coherence-1", "coherence, F = 1", Width::Coherent(1.0)),
];

/// Filter and ranges at one instant, rad.
#[derive(Clone, Copy)]
pub(super) struct Moment {
    pub(super) time_s: f64,
    /// Of the static part.
    pub(super) error: [f64; 3],
    /// Of the static part, and of the total.
    sigma: [[f64; 3]; 2],
    /// With F = 1.
    formula: [f64; 3],
    /// With F = 1.
    coherent: [f64; 3],
    dynamic_error: [f64; 3],
}

impl Moment {
    fn of(naive: &Solution, formula: &Solution, coherent: &Solution, truth: &Truth) -> Self {
        let [found, real] = [naive.static_q, truth.static_q].map(Rot::<Main, Sub>::from_wxyz);
        let sigma = |covariance: &[f64; 9]| [0, 1, 2].map(|axis| covariance[4 * axis].sqrt());
        Self {
            time_s: seconds(naive.header.time_ns),
            error: (found * real.inverse()).log().array(),
            sigma: [sigma(&naive.static_covariance), sigma(&naive.covariance)],
            formula: formula.range,
            coherent: coherent.range,
            dynamic_error: [0, 1, 2].map(|axis| naive.dynamic[axis] - truth.dynamic[axis]),
        }
    }

    /// Half width of a range about an axis.
    pub(super) fn width(&self, width: Width, axis: usize) -> f64 {
        match width {
            Width::Deviations(count) => count * self.sigma[0][axis],
            Width::Formula(factor) => factor[axis] * self.formula[axis],
            Width::Coherent(factor) => {
                let own = 3.0 * self.sigma[1][axis];
                own + factor * (self.coherent[axis] - own)
            }
        }
    }
}

/// By axis, rad.
#[derive(Default)]
pub(super) struct Measured {
    count: f64,
    error: [f64; 3],
    dynamic_error: [f64; 3],
    sigma: [f64; 3],
    held: [[f64; 3]; WIDTHS.len()],
    width: [[f64; 3]; WIDTHS.len()],
    /// The least F of the formula that holds every error.
    pub(super) formula: [f64; 3],
    /// The same of the range by coherence.
    pub(super) coherent: [f64; 3],
    /// Of the first trial.
    pub(super) series: Vec<Moment>,
}

impl Measured {
    fn take(&mut self, now: &Moment) {
        self.count += 1.0;
        for axis in 0..3 {
            let error = now.error[axis].abs();
            self.error[axis] += error * error;
            self.sigma[axis] += now.sigma[0][axis].powi(2);
            self.dynamic_error[axis] += now.dynamic_error[axis].powi(2);
            for (i, &(_, _, width)) in WIDTHS.iter().enumerate() {
                let width = now.width(width, axis);
                self.held[i][axis] += f64::from(u8::from(error <= width));
                self.width[i][axis] += width;
            }
            self.formula[axis] = self.formula[axis].max(error / now.formula[axis]);
            let own = now.width(Width::Coherent(0.0), axis);
            let needed = (error - own) / (now.coherent[axis] - own);
            self.coherent[axis] = self.coherent[axis].max(needed);
        }
    }

    /// Root mean square error of the static part.
    pub(super) fn rmse(&self, axis: usize) -> f64 {
        (self.error[axis] / self.count).sqrt()
    }

    /// The same of the flexure.
    pub(super) fn dynamic_rmse(&self, axis: usize) -> f64 {
        (self.dynamic_error[axis] / self.count).sqrt()
    }

    /// The filter's own deviation of the static part.
    pub(super) fn sigma(&self, axis: usize) -> f64 {
        (self.sigma[axis] / self.count).sqrt()
    }

    /// Share of instants at which a range held the error.
    pub(super) fn coverage(&self, width: usize, axis: usize) -> f64 {
        self.held[width][axis] / self.count
    }

    /// Mean half width of a range.
    pub(super) fn width(&self, width: usize, axis: usize) -> f64 {
        self.width[width][axis] / self.count
    }
}

/// The filter of a configuration with a range.
pub(super) fn ranged(configuration: &Configuration, range: RangeMethod, factor: [f64; 3]) -> Box<dyn Estimator> {
    let told = configuration.with(|c| {
        c.areas[0].estimator.range = Some(range);
        c.areas[0].estimator.range_factor = factor;
    });
    lane::estimator(&told, 0)
}

pub(super) fn measure(case: Case, trial: &Trial) -> Result<Measured, Fault> {
    let duration_s = if trial.quick { DURATION_S.1 } else { DURATION_S.0 };
    let configuration =
        presets::configuration(case.preset(), trial.seed)?.with(|c| c.run.duration_s = Some(duration_s));
    let mut filters = [RangeMethod::Naive, RangeMethod::ErrorRange, RangeMethod::Coherence]
        .map(|range| ranged(&configuration, range, [1.0; 3]));
    let mut measured = Measured::default();
    let mut due_s = FROM_S;
    let mut drawn_s = 0.0;
    pairs(&configuration, |pair: &ImuPair, truth| {
        let [naive, formula, coherent] = filters.each_mut().map(|filter| filter.step(pair));
        let now_s = seconds(pair.header.time_ns);
        if now_s < due_s.min(drawn_s) || !naive.is_valid() {
            return;
        }
        let now = Moment::of(&naive, &formula, &coherent, truth);
        if now_s >= due_s {
            due_s += 1.0;
            measured.take(&now);
        }
        if now_s >= drawn_s {
            drawn_s += SERIES_S;
            if trial.index == 0 {
                measured.series.push(now);
            }
        }
    })?;
    Ok(measured)
}
