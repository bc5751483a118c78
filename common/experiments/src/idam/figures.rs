//! Figures 4 to 6.

use super::deformation::{Measured, SPAN, Scenario};
use super::{AXES, methods::method};
use crate::{Bars, Figure, Label, Line, Plot, Series, Stroke, Track, rms, spread};
use frames::unit::ARCMIN;

/// The methods that the lines of a figure show, as in the paper with ours beside them.
const SHOWN: [&str; 4] = ["ekf-svr", "ekf-woa", "idam-literal", "so3-rvm"];

fn shown<'a>(scenario: &Scenario, trial: &'a Measured) -> Vec<(&'static str, &'a Track)> {
    let named = scenario.methods().zip(&trial.tracks);
    named.filter(|(told, _)| SHOWN.contains(&told.id)).map(|(told, track)| (told.name, track)).collect()
}

fn line(name: &str, stroke: Stroke, points: Vec<(f64, f64)>) -> Line {
    Line { name: name.into(), stroke, points }
}

/// Figures 4 and 5, from the first trial.
pub(super) fn of_one_trial(scenario: &Scenario, trial: &Measured) -> Vec<Figure> {
    let tracks = shown(scenario, trial);
    let mut figures: Vec<Figure> = (0..3).map(|axis| estimates(&tracks, axis)).collect();
    figures.extend((0..3).map(|axis| errors(&tracks, axis)));
    figures
}

fn estimates(tracks: &[(&'static str, &Track)], axis: usize) -> Figure {
    let estimate = |(name, track): &(&str, &Track)| {
        line(name, Stroke::Solid, track.over(SPAN).line(|point| point.estimate[axis] / ARCMIN))
    };
    let mut lines: Vec<Line> = tracks.iter().map(estimate).collect();
    if let Some((_, track)) = tracks.first() {
        lines.push(line("truth", Stroke::Truth, track.over(SPAN).line(|point| point.truth[axis] / ARCMIN)));
    }
    Figure {
        title: format!("Deformation about {}", AXES[axis]),
        caption: "Figure 4 of the paper, with the static part: the first trial. All methods follow the flexure; they differ by a \
                  nearly constant angle."
            .into(),
        plot: Plot::Lines { x: Label::new("time", "s"), y: Label::new(format!("deformation about {}", AXES[axis]), "arcmin"), lines },
    }
}

fn errors(tracks: &[(&'static str, &Track)], axis: usize) -> Figure {
    let error = |(name, track): &(&str, &Track)| {
        line(name, Stroke::Solid, track.over(SPAN).line(|point| point.error[axis] / ARCMIN))
    };
    let mut lines = Vec::new();
    if let Some((_, track)) = tracks.iter().find(|(name, _)| *name == method("so3-rvm").name) {
        let range = |sign: f64| track.over(SPAN).line(move |point| sign * point.range[axis] / ARCMIN);
        lines.extend([1.0, -1.0].map(|sign| line("95 % range of SO(3)", Stroke::Bound, range(sign))));
    }
    lines.extend(tracks.iter().map(error));
    Figure {
        title: format!("Error about {}", AXES[axis]),
        caption: "Figure 5 of the paper: the first trial.".into(),
        plot: Plot::Lines {
            x: Label::new("time", "s"),
            y: Label::new(format!("error about {}", AXES[axis]), "arcmin"),
            lines,
        },
    }
}

/// Figure 6: all methods over all trials.
pub(super) fn bars(scenario: &Scenario, trials: &[Measured]) -> Figure {
    let series = |axis: usize| {
        let value = |id: &str| {
            let values = scenario.rmse(trials, id, axis);
            (rms(&values), spread(&values))
        };
        Series {
            name: AXES[axis].into(),
            values: scenario.methods().map(|told| value(told.id)).collect(),
            bounds: scenario.methods().map(|told| scenario.total(trials, told.bound, axis)).collect(),
        }
    };
    Figure {
        title: scenario.title.into(),
        caption: "Figure 6 of the paper: root mean square over the trials, with the spread of one trial; the tick is the filter \
                  that is told the true flexure."
            .into(),
        plot: Plot::Bars(Bars {
            value: Label::new("RMSE", "arcmin"),
            groups: scenario.methods().map(|told| told.name.into()).collect(),
            series: [0, 1, 2].map(series).into(),
        }),
    }
}
