//! Ranges against the error over the first trial.

use super::AXES;
use super::measure::{Case, Measured, Moment, Width};
use crate::{Figure, Label, Line, Plot, Stroke};
use frames::unit::ARCSEC;

pub(super) fn ranges(case: Case, trials: &[Measured]) -> Vec<Figure> {
    let series = &trials[0].series;
    (0..3).map(|axis| figure(case, series, axis)).collect()
}

fn figure(case: Case, series: &[Moment], axis: usize) -> Figure {
    let value = |figure: &dyn Fn(&Moment) -> f64| -> Vec<(f64, f64)> {
        // the first minutes, in which nothing is known yet, would hide the rest
        series
            .iter()
            .filter(|now| now.time_s >= 1800.0)
            .map(|now| (now.time_s / 3600.0, figure(now) / ARCSEC))
            .collect()
    };
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
