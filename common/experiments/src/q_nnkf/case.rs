//! Figures 11 to 16: 1.5, 2, 3 degrees about x, y, z.

use super::method::{AXES, DURATION_S, Figures, Method, SPAN, degrees, euler, scenario};
use super::published::CASE;
use crate::{
    Bound, Claim, Data, Fault, Figure, Findings, Label, Line, Plot, Point, Published, Stroke, Study, Track, Trial,
    Trials, mean,
};
use frames::unit::ARCSEC;

/// With the paper's figures beside them, and why the verdict is what it is.
const METHODS: [(Method, Option<usize>, &str); 7] = [
    (Method::Ckf, Some(1), "What equation 37 leaves out is quadratic in the angle."),
    (
        Method::Ekf,
        Some(2),
        "On the exact measurement an extended filter loses nothing; on equation 37, which is linear, it is the CKF.",
    ),
    (Method::Nnkf, None, "Hangs on first weights and their doubt, which are not published."),
    (Method::QNnkf, Some(0), "The network tells nothing that the model does not."),
    (Method::QNnkfPrinted, Some(0), "As printed, equation 34 cannot tell deformation from gyro drift."),
    (Method::QKf, Some(0), "On the bound without a network."),
    (Method::So3, Some(0), "On the bound without a network or a small angle."),
];

pub(super) fn study() -> Study {
    let cost = METHODS.len() as u64 * DURATION_S as u64;
    Study::new(Trials { full: 8, quick: 1 }, cost, measure, conclude)
}

struct Measured {
    figures: Vec<Figures>,
    /// Of the first trial.
    tracks: Vec<Track>,
}

fn measure(trial: &Trial) -> Result<Measured, Fault> {
    let data = Data::simulate(&scenario(trial.seed, degrees([1.5, 2.0, 3.0]), DURATION_S)?)?;
    let tracks: Vec<Track> =
        METHODS.into_iter().map(|(method, ..)| method.track(trial.seed, &data, 1.0)).collect::<Result<_, _>>()?;
    let figures = tracks.iter().map(|track| Figures::of(track.over(SPAN))).collect();
    Ok(Measured { figures, tracks: if trial.index == 0 { tracks } else { Vec::new() } })
}

fn conclude(trials: &[Measured]) -> Findings {
    let mut rows = Vec::new();
    for (index, (method, paper, why)) in METHODS.into_iter().enumerate() {
        for (axis, axis_name) in AXES.into_iter().enumerate() {
            let rmse: Vec<f64> = trials.iter().map(|trial| trial.figures[index].rmse[axis]).collect();
            let sigma: Vec<f64> = trials.iter().map(|trial| trial.figures[METHODS.len() - 1].sigma[axis]).collect();
            let claim = Claim {
                id: format!("q-nnkf/case/{}/{axis_name}", method.key()),
                table: "Figures 14 to 16, RMSE at 1.5, 2, 3 degrees".into(),
                row: method.name().into(),
                axis: axis_name.into(),
                unit: "arcsec".into(),
                bound: Bound::Value(mean(&sigma)),
                paper: paper.map_or(Published::Nothing("not published at these angles".into()), |i| {
                    Published::Magnitude(CASE[i][axis], 1)
                }),
                why: why.into(),
            };
            rows.push(claim.rms(&rmse));
        }
    }
    Findings { rows, figures: figures(&trials[0].tracks) }
}

fn figures(tracks: &[Track]) -> Vec<Figure> {
    let [ckf, _, _, _, printed, q_kf, _] = tracks else { return Vec::new() };
    let mut figures: Vec<Figure> = (0..3).map(|axis| estimate(q_kf, axis)).collect();
    figures.push(errors("Q-KF", "figure 14, without the network: a few arcsec, as in the paper", q_kf));
    figures.push(errors("CKF", "figures 15 and 16: the oscillation is what equation 37 leaves out", ckf));
    figures.push(errors("Q-NNKF as printed", "figure 14 as printed: what the registration did not see stays", printed));
    figures
}

/// Figures 11 to 13: the quasi-static part as the estimate follows it.
fn estimate(track: &Track, axis: usize) -> Figure {
    let line = |name: &str, stroke, figure: &dyn Fn(&Point) -> f64| Line {
        name: name.into(),
        stroke,
        points: track.over(..).line(figure),
    };
    Figure {
        title: format!("Deformation about {}", AXES[axis]),
        caption: format!("The paper's figure {}: the estimate follows the quasi-static sine of two hours.", 11 + axis),
        plot: Plot::Lines {
            x: Label::new("time", "s"),
            y: Label::new(format!("Euler angle about {}", AXES[axis]), "arcsec"),
            lines: vec![
                line("Q-KF", Stroke::Solid, &|point| euler(point.estimate)[axis] / ARCSEC),
                line("truth", Stroke::Truth, &|point| euler(point.truth)[axis] / ARCSEC),
            ],
        },
    }
}

fn errors(name: &str, caption: &str, track: &Track) -> Figure {
    let line = |axis: usize| Line {
        name: AXES[axis].into(),
        stroke: Stroke::Solid,
        points: track.over(SPAN).line(|point| (euler(point.estimate)[axis] - euler(point.truth)[axis]) / ARCSEC),
    };
    Figure {
        title: format!("Error of {name}"),
        caption: format!("The paper's {caption}."),
        plot: Plot::Lines {
            x: Label::new("time", "s"),
            y: Label::new("error", "arcsec"),
            lines: (0..3).map(line).collect(),
        },
    }
}
