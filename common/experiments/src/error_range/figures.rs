//! Figures 4, 7 and 8: ranges against the error over the first trial.
//!
//! Figure 5, the error of the flexure's rate between its predicted bounds, is not drawn: the bounds (eq 32) live within the evaluation, and a
//! solution carries no range but that of the angle.

use super::AXES;
use super::measure::{Case, Measured, Moment, Width};
use crate::{Figure, Label, Line, Plot, Stroke};
use frames::unit::ARCSEC;

pub(super) fn ranges(case: Case, trials: &[Measured]) -> Vec<Figure> {
    let series = &trials[0].series;
    let mut figures: Vec<Figure> = (0..3).map(|axis| figure(case, series, axis)).collect();
    figures.push(meeting(case, series));
    figures
}

/// A figure against hours. The first minutes, in which nothing is known yet, would hide the rest.
fn points(series: &[Moment], figure: impl Fn(&Moment) -> f64) -> Vec<(f64, f64)> {
    series.iter().filter(|now| now.time_s >= 1800.0).map(|now| (now.time_s / 3600.0, figure(now))).collect()
}

fn figure(case: Case, series: &[Moment], axis: usize) -> Figure {
    let value = |figure: &dyn Fn(&Moment) -> f64| points(series, |now| figure(now) / ARCSEC);
    let both = |name: &str, stroke, width| {
        [1.0, -1.0].map(|sign| Line { name: name.into(), stroke, points: value(&|now| sign * now.width(width, axis)) })
    };
    let mut lines = Vec::new();
    lines.extend(both("three deviations", Stroke::Bound, Width::Deviations(3.0)));
    lines.extend(both("formula, F = 1.4, 0.8, 2", Stroke::Solid, Width::Formula([1.4, 0.8, 2.0])));
    lines.extend(both("coherence, F = 1", Stroke::Solid, Width::Coherent(1.0)));
    lines.push(Line { name: "error".into(), stroke: Stroke::Truth, points: value(&|now| now.error[axis]) });
    Figure {
        title: format!("Error of the static part about {} and its ranges, {}", AXES[axis], case.title()),
        caption: "Figures 4 and 8 of the paper, the first trial.".into(),
        plot: Plot::Lines {
            x: Label::new("time", "h"),
            y: Label::new(format!("static part about {}", AXES[axis]), "arcsec"),
            lines,
        },
    }
}

/// The range grows in proportion to F (figure 6), so that at each instant it meets the error at a single F.
fn meeting(case: Case, series: &[Moment]) -> Figure {
    let line = |axis: usize| Line {
        name: AXES[axis].into(),
        stroke: Stroke::Solid,
        points: points(series, |now| now.error[axis].abs() / now.width(Width::Formula([1.0; 3]), axis)),
    };
    Figure {
        title: format!("F at which the formula's range is the error, {}", case.title()),
        caption: "Figure 7 of the paper, the first trial: the curves on which its surfaces intersect. A range holds the error where F lies \
                  above the curve; the paper's surfaces end at F = 2."
            .into(),
        plot: Plot::Lines {
            x: Label::new("time", "h"),
            y: Label::new("F", "1/sqrt(s)"),
            lines: [0, 1, 2].map(line).into(),
        },
    }
}
