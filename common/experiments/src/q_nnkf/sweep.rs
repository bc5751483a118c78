//! Tables 3 to 6: the error against the installation angle, the same about every axis.

use super::method::{AXES, DURATION_S, Figures, Method, SPAN, degrees, scenario};
use super::published::{ANGLES, TABLE_3, TABLE_4, TABLE_5, TABLE_6, Table, level};
use crate::{
    Bound, Claim, Data, Fault, Figure, Findings, Label, Line, Plot, Published, Row, Stroke, Study, Trial, Trials, mean,
};

/// A quick run lets the slow networks do only these, once.
const QUICK: [f64; 3] = [1.5, 3.0, 4.5];
/// Another realisation for each angle, as on the paper's turntable: their seeds lie so far apart.
const APART: u64 = 7_919;

pub(super) fn study() -> Study {
    let trials = Trials { full: 16, quick: 2 };
    Study::new(trials, ANGLES.len() as u64 * 6 * DURATION_S as u64, measure, conclude)
}

/// By angle and method, as far as it was run.
type Measured = Vec<Vec<(Method, Figures)>>;

fn measure(trial: &Trial) -> Result<Measured, Fault> {
    let one = |index: usize| {
        let angle = ANGLES[index];
        let seed = trial.seed.wrapping_add(APART * index as u64);
        let data = Data::simulate(&scenario(seed, degrees([angle; 3]), DURATION_S)?)?;
        let mut methods = vec![Method::Ckf, Method::Ekf, Method::QKf, Method::So3];
        if !trial.quick || trial.index == 0 && QUICK.contains(&angle) {
            methods.extend([Method::Nnkf, Method::QNnkf]);
        }
        if !trial.quick && QUICK.contains(&angle) {
            methods.push(Method::QNnkfPrinted);
        }
        let figures = |method: Method| Ok((method, Figures::of(method.track(seed, &data, 1.0)?.over(SPAN))));
        methods.into_iter().map(figures).collect()
    };
    (0..ANGLES.len()).map(one).collect()
}

/// A figure of a method at an angle in all trials.
fn values(trials: &[Measured], index: usize, method: Method, figure: impl Fn(&Figures) -> f64) -> Vec<f64> {
    let of = |measured: &Measured| measured[index].iter().find(|of| of.0 == method).map(|of| figure(&of.1));
    trials.iter().filter_map(of).collect()
}

/// A table of the paper, and the method that stands beside it.
struct Beside {
    table: &'static str,
    key: &'static str,
    method: Method,
    paper: &'static Table,
    why: &'static str,
}

const BESIDE: [Beside; 8] = [
    Beside {
        table: "Table 3, CKF",
        key: "table3",
        method: Method::Ckf,
        paper: &TABLE_3,
        why: "What equation 37 leaves out is quadratic in the angle; the exact size hangs on phases and latitude, which are not \
              published.",
    },
    Beside {
        table: "Table 4, EKF",
        key: "table4/printed",
        method: Method::Ckf,
        paper: &TABLE_4,
        why: "Equation 37 is linear, so an extended filter on it is the Kalman filter of table 3.",
    },
    Beside {
        table: "Table 4, EKF",
        key: "table4",
        method: Method::Ekf,
        paper: &TABLE_4,
        why: "An extended filter on the exact measurement has no error from the angle: the paper's rival was held back.",
    },
    Beside {
        table: "Table 5, NNKF",
        key: "table5",
        method: Method::Nnkf,
        paper: &TABLE_5,
        why: "Hangs on first weights and their doubt, which are not published; with a doubt of 0.01 the size comes out.",
    },
    Beside {
        table: "Table 6, Q-NNKF",
        key: "table6",
        method: Method::QNnkf,
        paper: &TABLE_6,
        why: "The network tells nothing that the model does not: it only adds error.",
    },
    Beside {
        table: "Table 6, Q-NNKF",
        key: "table6",
        method: Method::QNnkfPrinted,
        paper: &TABLE_6,
        why: "As printed, equation 34 cannot tell deformation from gyro drift.",
    },
    Beside {
        table: "Table 6, Q-NNKF",
        key: "table6",
        method: Method::QKf,
        paper: &TABLE_6,
        why: "The registration and the residual measurement reach the bound without a network; single figures of the paper are draws \
              from this spread.",
    },
    Beside {
        table: "Table 6, Q-NNKF",
        key: "table6",
        method: Method::So3,
        paper: &TABLE_6,
        why: "Nothing depends on the angle; single figures of the paper are draws from this spread.",
    },
];

fn conclude(trials: &[Measured]) -> Findings {
    let mut rows: Vec<Row> = BESIDE.iter().flat_map(|beside| table(trials, beside)).collect();
    for beside in BESIDE.iter().filter(|beside| beside.key == "table6") {
        rows.extend(levels(trials, beside));
    }
    for beside in BESIDE.iter().filter(|beside| beside.key == "table6") {
        rows.extend(largest(trials, beside));
    }
    Findings { rows, figures: AXES.iter().enumerate().map(|(axis, name)| figure(trials, axis, name)).collect() }
}

/// The bound at an angle, from the filter that is told the true parameters.
fn bound(trials: &[Measured], index: usize, axis: usize) -> f64 {
    mean(&values(trials, index, Method::So3, |figures| figures.sigma[axis]))
}

fn table(trials: &[Measured], beside: &Beside) -> Vec<Row> {
    let Beside { table, key, method, paper, why } = beside;
    let name = if *key == "table4/printed" { "EKF on equation 37" } else { method.name() };
    let mut rows = Vec::new();
    for (index, angle) in ANGLES.into_iter().enumerate() {
        for (axis, axis_name) in AXES.into_iter().enumerate() {
            let values = values(trials, index, *method, |figures| figures.rmse[axis]);
            if values.is_empty() {
                continue;
            }
            let claim = Claim {
                id: format!("q-nnkf/{key}/{}/{angle}/{axis_name}", method.key()),
                table: (*table).into(),
                row: format!("{name}, {angle} deg"),
                axis: axis_name.into(),
                unit: "arcsec".into(),
                bound: Bound::Value(bound(trials, index, axis)),
                paper: Published::Magnitude(paper[axis][index], 1),
                why: (*why).into(),
            };
            rows.push(claim.rms(&values));
        }
    }
    rows
}

/// The errors of a trial at the angles that were run.
fn over_angles(trial: &Measured, method: Method, axis: usize) -> Vec<f64> {
    let found = |at: &Vec<(Method, Figures)>| at.iter().find(|of| of.0 == method).map(|of| of.1.rmse[axis]);
    trial.iter().filter_map(found).collect()
}

/// A figure over the angles, in each trial.
fn summary(
    trials: &[Measured],
    beside: &Beside,
    [key, table]: [&str; 2],
    paper: impl Fn(usize) -> Published,
    figure: impl Fn(&[f64]) -> f64,
) -> Vec<Row> {
    let row = |(axis, axis_name): (usize, &str)| {
        let all = trials.iter().map(|trial| over_angles(trial, beside.method, axis)).filter(|all| !all.is_empty());
        let values: Vec<f64> = all.map(|all| figure(&all)).collect();
        let bounds: Vec<f64> = (0..ANGLES.len()).map(|index| bound(trials, index, axis)).collect();
        let claim = Claim {
            id: format!("q-nnkf/{key}/{}/{axis_name}", beside.method.key()),
            table: table.into(),
            row: beside.method.name().into(),
            axis: axis_name.into(),
            unit: "arcsec".into(),
            bound: Bound::Value(mean(&bounds)),
            paper: paper(axis),
            why: beside.why.into(),
        };
        (!values.is_empty()).then(|| claim.mean(&values))
    };
    AXES.into_iter().enumerate().filter_map(row).collect()
}

/// The level of table 6: the mean over the angles.
fn levels(trials: &[Measured], beside: &Beside) -> Vec<Row> {
    let names = ["table6/mean", "Table 6, mean over the angles"];
    summary(trials, beside, names, |axis| Published::Magnitude(level(beside.paper)[axis], ANGLES.len()), mean)
}

/// What figure 20 and the abstract claim: less than 10 arcsec at every angle.
fn largest(trials: &[Measured], beside: &Beside) -> Vec<Row> {
    let names = ["figure20", "Figure 20, largest RMSE over the angles"];
    let most = |all: &[f64]| all.iter().copied().fold(f64::NAN, f64::max);
    summary(trials, beside, names, |_| Published::AtMost(10.0), most)
}

/// Figures 17 to 19.
fn figure(trials: &[Measured], axis: usize, name: &str) -> Figure {
    let line = |method: Method| {
        let point = |(index, angle): (usize, f64)| {
            let values = values(trials, index, method, |figures| figures.rmse[axis]);
            (!values.is_empty()).then(|| (angle, crate::rms(&values).log10()))
        };
        let points: Vec<(f64, f64)> = ANGLES.into_iter().enumerate().filter_map(point).collect();
        Line { name: method.name().into(), stroke: Stroke::Solid, points }
    };
    let bounds = ANGLES.into_iter().enumerate().map(|(i, angle)| (angle, bound(trials, i, axis).log10())).collect();
    let methods = [Method::Ckf, Method::Ekf, Method::Nnkf, Method::QNnkf, Method::QKf, Method::So3];
    let mut lines = vec![Line { name: "bound".into(), stroke: Stroke::Bound, points: bounds }];
    lines.extend(methods.map(line));
    Figure {
        title: format!("Error about {name} against the installation angle"),
        caption: format!(
            "The paper's figure {}, with the logarithm of the error: methods without registration grow with the square of the angle, the others lie \
             on the bound.",
            17 + axis
        ),
        plot: Plot::Lines {
            x: Label::new("installation angle about every axis", "deg"),
            y: Label::new(format!("log10 of the RMSE about {name}"), "arcsec"),
            lines,
        },
    }
}
