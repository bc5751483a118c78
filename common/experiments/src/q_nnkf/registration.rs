//! Table 2 and figures 8 to 10: the registrations over time, at 250, 1000, 2400 arcsec.

use super::method::{AXES, scenario};
use super::published::TABLE_2;
use crate::{
    Bound, Claim, Data, Fault, Figure, Findings, Label, Line, Plot, Published, Row, Stroke, Study, Trial, Trials, mean,
};
use estimation::align::analytic::Analytic;
use estimation::align::least_squares::LeastSquares;
use estimation::align::quaternion::{Angles, Quaternion};
use estimation::align::{Register, Registrar};
use frames::unit::ARCSEC;
use frames::{Main, Rot, Sub, Vec3};

const DURATION_S: usize = 900;
/// Rows are given at these times, s.
const TIMES: [usize; 8] = [5, 10, 20, 30, 60, 120, 300, 900];
/// When the paper's table is taken: its time is not published; its figures 8 to 10 have settled by then.
const TABLE_S: usize = 30;
/// A registration has converged once its error about each axis is below this, arcsec.
const CONVERGED: f64 = 50.0;

/// Name, key, column of table 2, and why the verdict is what it is.
const METHODS: [(&str, &str, Option<usize>, &str); 5] = [
    (
        "OQ, as printed",
        "oq",
        Some(1),
        "The error's size comes out; with time it grows, since the Earth's rate comes to rule the accumulated angles.",
    ),
    (
        "OQ, windows of 2 s",
        "oq_windowed",
        Some(1),
        "Windows keep the Earth's rate out; what grows later is the lag behind the quasi-static part.",
    ),
    ("LSE", "lse", Some(2), "At these angles least squares and quaternion optimisation are the same estimate."),
    (
        "ACA",
        "aca",
        Some(3),
        "Wanders about: accelerometer errors and the lever arm do not average out; their size is not published.",
    ),
    ("by motion (ours)", "motion", Some(1), "Windows of 0.1 s without their means."),
];

fn register(method: usize) -> Box<dyn Register> {
    match method {
        0 => Box::new(Quaternion::new(Angles::Cumulative)),
        1 => Box::new(Quaternion::new(Angles::Windowed)),
        2 => Box::new(LeastSquares::new()),
        3 => Box::new(Analytic::new()),
        _ => Box::new(Registrar::new(0.0)),
    }
}

pub(super) fn study() -> Study {
    let cost = (METHODS.len() * DURATION_S) as u64;
    Study::new(Trials { full: 20, quick: 4 }, cost, measure, conclude)
}

/// Error about each axis by method and second, arcsec; NaN without a solution.
type Measured = Vec<Vec<[f64; 3]>>;

fn measure(trial: &Trial) -> Result<Measured, Fault> {
    let installation = Vec3::<Main>::from(TABLE_2.map(|row| row[0] * ARCSEC));
    let data = Data::simulate(&scenario(trial.seed, installation, DURATION_S as f64)?)?;
    let of = |method: usize| {
        let mut register = register(method);
        let mut errors = vec![[f64::NAN; 3]];
        for (pair, truth) in data.pairs.iter().zip(&data.truths) {
            register.add(pair);
            if pair.header.time_ns >= errors.len() as i64 * 1_000_000_000 {
                let truth = Rot::<Main, Sub>::from_wxyz(truth.q);
                let found = register.solve().map(|found| (found.rotation * truth.inverse()).log().array());
                errors.push(found.map_or([f64::NAN; 3], |error| error.map(|e| e / ARCSEC)));
            }
        }
        errors
    };
    Ok((0..METHODS.len()).map(of).collect())
}

fn conclude(trials: &[Measured]) -> Findings {
    let mut rows = Vec::new();
    for (method, (name, key, column, why)) in METHODS.into_iter().enumerate() {
        for time in TIMES {
            for (axis, axis_name) in AXES.into_iter().enumerate() {
                let values: Vec<f64> =
                    trials.iter().filter_map(|trial| trial[method].get(time)).map(|e| e[axis].abs()).collect();
                let paper = match column.filter(|_| time == TABLE_S) {
                    Some(column) => Published::Magnitude(published(axis, column), 1),
                    None => Published::Nothing("the paper gives one figure, at no stated time".into()),
                };
                let claim = Claim {
                    id: format!("q-nnkf/table2/{key}/{time}/{axis_name}"),
                    table: "Table 2, errors of the registrations".into(),
                    row: format!("{name}, {time} s"),
                    axis: axis_name.into(),
                    unit: "arcsec".into(),
                    bound: Bound::None("flexure and quasi-static drift are no noise of a registration's model".into()),
                    paper,
                    why: why.into(),
                };
                rows.push(claim.rms(&values));
            }
        }
    }
    rows.push(speed(trials));
    rows.push(worst(trials));
    Findings { rows, figures: AXES.iter().enumerate().map(|(axis, name)| figure(&trials[0], axis, name)).collect() }
}

/// The error of table 2, to the decimal that it gives, arcsec.
fn published(axis: usize, column: usize) -> f64 {
    ((TABLE_2[axis][column] - TABLE_2[axis][0]).abs() * 10.0).round() / 10.0
}

/// Whether ACA is the worst of the three, as figure 10 shows it.
fn worst(trials: &[Measured]) -> Row {
    let size = |errors: &[[f64; 3]]| errors[TABLE_S].iter().map(|e| e * e).sum::<f64>().sqrt();
    let ratios: Vec<f64> = trials.iter().map(|trial| size(&trial[3]) / size(&trial[0]).max(size(&trial[2]))).collect();
    let claim = Claim {
        id: "q-nnkf/table2/worst".into(),
        table: "Figures 8 to 10, ACA".into(),
        row: format!("error of ACA over the larger one of OQ and LSE, {TABLE_S} s"),
        axis: "all".into(),
        unit: String::new(),
        bound: Bound::None("a ratio of two estimates".into()),
        paper: Published::Statement("ACA has the worst convergence".into(), mean(&ratios) > 1.0),
        why: "Tilted by accelerometer errors and moved by lever arm and swing, the triad of one second wanders.".into(),
    };
    claim.mean(&ratios)
}

/// When a registration has come close, s.
fn converged(errors: &[[f64; 3]]) -> f64 {
    let close = |error: &[f64; 3]| error.iter().all(|e| e.abs() < CONVERGED);
    errors.iter().position(close).map_or(f64::NAN, |seconds| seconds as f64)
}

fn speed(trials: &[Measured]) -> Row {
    let ratios: Vec<f64> = trials.iter().map(|trial| converged(&trial[2]) / converged(&trial[0])).collect();
    let ratio = mean(&ratios);
    let claim = Claim {
        id: "q-nnkf/table2/speed".into(),
        table: "Figures 8 and 9, speed of convergence".into(),
        row: format!("time of LSE over that of OQ to {CONVERGED} arcsec"),
        axis: "all".into(),
        unit: String::new(),
        bound: Bound::None("a ratio of two estimates".into()),
        paper: Published::Statement("OQ is about four times as fast as LSE".into(), (3.0..=5.0).contains(&ratio)),
        why:
            "Both solve the same least squares from the same angles; they differ by half the square of the angle only."
                .into(),
    };
    claim.mean(&ratios)
}

/// Figures 8 to 10, an axis each.
fn figure(trial: &Measured, axis: usize, name: &str) -> Figure {
    let line = |(method, errors): (usize, &Vec<[f64; 3]>)| {
        let points =
            errors.iter().take(121).enumerate().map(|(second, e)| (second as f64, e[axis].clamp(-400.0, 400.0)));
        Line { name: METHODS[method].0.into(), stroke: Stroke::Solid, points: points.collect() }
    };
    Figure {
        title: format!("Registrations: error about {name}"),
        caption: "The paper's figures 8 to 10, the first trial: OQ and LSE lie on each other, ACA wanders (cut at 400 arcsec)."
            .into(),
        plot: Plot::Lines {
            x: Label::new("time", "s"),
            y: Label::new(format!("error about {name}"), "arcsec"),
            lines: trial.iter().enumerate().map(line).collect(),
        },
    }
}
