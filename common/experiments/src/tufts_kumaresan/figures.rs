//! What was found against the bound, and the filter's estimates and errors.

use super::identification::{bound, values};
use super::measure::{FILTERS, Measured, TK, TRUE_OF, WAYS, WHITTLE, parameters};
use super::{AXES, Ship};
use crate::{Bars, Cloud, Ellipse, Figure, Label, Line, Plot, Series, Stroke, rms, spread};
use std::f64::consts::TAU;

/// Holds 95 % of a plane's normal points.
const SIGMAS: f64 = 2.45;

/// Frequency and damping about each axis.
pub(super) fn identification(ship: Ship, trials: &[Measured]) -> Vec<Figure> {
    (0..3).map(|axis| scatter(ship, trials, axis)).collect()
}

fn scatter(ship: Ship, trials: &[Measured], axis: usize) -> Figure {
    let cloud = |way: usize| Cloud {
        name: WAYS[way].name.into(),
        truth: false,
        points: values(trials, way, axis, 1).into_iter().zip(values(trials, way, axis, 2)).collect(),
        sigma: Vec::new(),
    };
    let truth = parameters(&trials[0].truth[axis]);
    let mut clouds: Vec<Cloud> = [TK, WHITTLE].map(cloud).into();
    clouds.push(Cloud { name: "truth".into(), truth: true, points: vec![(truth[1], truth[2])], sigma: Vec::new() });
    let ellipse = |bound: estimation::identify::bound::Bound| {
        // of frequency and damping from ln mu and ln b
        let (mu, b) = (bound.flexure.mu, bound.flexure.b);
        let scale = TAU * (b * b - mu * mu).sqrt();
        let (by_mu, by_b) = (-mu * mu / scale, b * b / scale);
        let c = &bound.covariance;
        let xx = by_mu * by_mu * c[(0, 0)] + 2.0 * by_mu * by_b * c[(0, 1)] + by_b * by_b * c[(1, 1)];
        let xy = mu * (by_mu * c[(0, 0)] + by_b * c[(0, 1)]);
        Ellipse {
            name: "Cramer-Rao bound, 95 %".into(),
            centre: (truth[1], truth[2]),
            covariance: [xx, xy, mu * mu * c[(0, 0)]],
            sigmas: SIGMAS,
        }
    };
    Figure {
        title: format!("Identified frequency and damping about {}{}", AXES[axis], ship.title()),
        caption: "One point a trial; Table IV of the paper gives mean and deviation. Maximum likelihood fills the bound's ellipse.".into(),
        plot: Plot::Scatter {
            x: Label::new("frequency", "Hz"),
            y: Label::new("damping", "1/s"),
            clouds,
            ellipses: bound(&trials[0], axis).map(ellipse).into_iter().collect(),
        },
    }
}

/// RMSE of all filters, and the first trial.
pub(super) fn filter(ship: Ship, trials: &[Measured]) -> Vec<Figure> {
    let series = |axis: usize| {
        let of = |filter: usize, sigma: bool| -> Vec<f64> {
            let figures = trials.iter().filter_map(|trial| trial.filtered[filter].as_ref());
            figures.map(|f| if sigma { f.sigma[axis] } else { f.rmse[axis] }).collect()
        };
        let value = |filter: usize| (rms(&of(filter, false)), spread(&of(filter, false)));
        Series {
            name: AXES[axis].into(),
            values: (0..FILTERS.len()).map(value).collect(),
            bounds: (0..FILTERS.len()).map(|filter| rms(&of(TRUE_OF[filter], true))).collect(),
        }
    };
    let mut figures = vec![Figure {
        title: format!("RMSE of the filter{}", ship.title()),
        caption: "From 100 s to 600 s, with the spread of one trial; the tick is the deviation that the filter with the true \
                  parameters expects."
            .into(),
        plot: Plot::Bars(Bars {
            value: Label::new("RMSE", "mrad"),
            groups: FILTERS.map(|(_, name, ..)| name.into()).into(),
            series: [0, 1, 2].map(series).into(),
        }),
    }];
    if let Some(track) = &trials[0].track {
        let line = |name: &str, stroke, points| Line { name: name.into(), stroke, points };
        let all = track.over(..);
        figures.push(Figure {
            title: format!("Deformation about y{}", ship.title()),
            caption: "The first trial, with parameters by Tufts and Kumaresan's method.".into(),
            plot: Plot::Lines {
                x: Label::new("time", "s"),
                y: Label::new("deformation about y", "mrad"),
                lines: vec![
                    line("estimate", Stroke::Solid, all.line(|point| point.estimate[1] * 1e3)),
                    line("truth", Stroke::Truth, all.line(|point| point.truth[1] * 1e3)),
                ],
            },
        });
        let error = |axis: usize| line(AXES[axis], Stroke::Solid, all.line(|point| point.error[axis] * 1e3));
        figures.push(Figure {
            title: format!("Errors of the filter{}", ship.title()),
            caption: "The same trial: slow, because nearly all of it is the error of the static part.".into(),
            plot: Plot::Lines {
                x: Label::new("time", "s"),
                y: Label::new("error", "mrad"),
                lines: [0, 1, 2].map(error).into(),
            },
        });
    }
    figures
}
