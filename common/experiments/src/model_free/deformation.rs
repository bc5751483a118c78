//! Experiments 1.1 to 1.3: Methods A and B without delay.

use super::{AXES, Figures, Size, claim, methods};
use crate::{
    Bars, Bound, Claim, Data, Fault, Figure, Findings, Label, Line, Plot, Published, Series, Stroke, Study, Track,
    Trial, Trials, presets, rms, run, run_told, spread,
};
use frames::unit::ARCSEC;
use pipeline::configuration::{Configuration, RegistrationMethod};

/// "After the estimation errors curve converges": after so much of the whole.
const CONVERGED: f64 = 1.0 / 3.0;
/// Seconds of data times methods, roughly.
const COST: u64 = 3600 * 12;
/// Updates of a network a second in a quick run.
const QUICK_NETWORK_HZ: f64 = 2.0;
const NO_SUCH_METHOD: &str = "the paper has no such method";

/// A method of an experiment.
struct Method {
    id: &'static str,
    name: &'static str,
    /// The paper's RMSE, arcsec.
    paper: Option<[f64; 3]>,
    why: &'static str,
}

const A_PAPER: [[f64; 3]; 3] = [[3.1988, 2.5995, 2.7369], [5.4095, 3.1924, 3.4838], [572.5369, 547.6232, 524.7748]];
const B_PAPER: [[f64; 3]; 3] = [[2.2520, 2.1032, 2.1212], [2.2687, 2.3296, 2.5545], [1.8513, 2.4581, 1.8049]];

/// In the order of the tracks.
fn methods(experiment: &str) -> Vec<Method> {
    let index = ["1.1", "1.2", "1.3"].iter().position(|&name| name == experiment).unwrap_or(0);
    let a_why = match index {
        0 => "With the true model Method A is the bound itself; the paper's level is that of another flexure.",
        1 => "A wrong model costs a factor, not the result: all error is the static part that it mistakes for flexure.",
        _ => "A static part without process noise cannot follow one that drifts; a rate of it, one line, cures that.",
    };
    let b_why = "With the measurement as input the network explains it by itself, and the static part passes through.";
    let method = |id, name, paper, why| Method { id, name, paper, why };
    vec![
        method("true", "Filter told the true models (the bound)", None, "Beside its own standard deviation."),
        method("a", "Method A", Some(A_PAPER[index]), a_why),
        method("b", "Method B, measurement as input, unscented", Some(B_PAPER[index]), b_why),
        method(
            "b-time",
            "Method B, time as input, unscented",
            None,
            "The offsets of the output make it a random walk.",
        ),
        method("b-previous", "Method B, last output as input, unscented", None, "As restless as its feedback."),
        method("walk", "Random walk of the deformation", None, "No model at all, and what Method B can be at best."),
        method("a-rate", "Method A, wrong flexure, static part with a rate", None, "The one line that Method A lacks."),
        method(
            "broad",
            "One broad Gauss-Markov model",
            None,
            "Twice the size, a frequency in the middle: broad, not wrong.",
        ),
        method("identified", "Identified Gauss-Markov models", None, "Whittle's likelihood every minute."),
    ]
}

pub(super) fn study(experiment: &'static str, size: Size) -> Study {
    Study::new(
        Trials { full: 6, quick: 2 },
        COST,
        move |trial| measure(experiment, size, trial),
        move |trials| conclude(experiment, size, trials),
    )
}

struct Measured {
    /// By method.
    figures: Vec<Figures>,
    /// Of the first trial: Methods A and B.
    tracks: Option<[Track; 2]>,
}

/// All methods of an experiment but the first, as configurations.
fn configurations(experiment: &str, size: Size, scenario: &Configuration) -> Result<Vec<Configuration>, Fault> {
    let preset = |name: &str| methods::of(name, scenario, size);
    let wrong = preset("model_free_a")?;
    let broad = methods::matched(&methods::of("model_free_delay", scenario, size)?, true)
        .with(|c| c.areas[0].installation = wrong.areas[0].installation);
    let a = if experiment == "1.1" { methods::told(&wrong) } else { wrong.clone() };
    let b = preset("model_free_b")?.with(|c| c.areas[0].estimator.delay = None);
    Ok(vec![
        a,
        b,
        preset("model_free_b_time")?,
        preset("model_free_b_previous")?,
        preset("model_free_walk")?,
        methods::matched(&wrong, true),
        broad.clone(),
        methods::identified(&broad).with(|c| c.areas[0].estimator.registration = RegistrationMethod::Motion),
    ])
}

/// The preset; a quick run takes half of the length and of the samples.
fn scenario(experiment: &str, size: Size, trial: &Trial) -> Result<Configuration, Fault> {
    let scenario = presets::configuration(&size.preset(experiment), trial.seed)?;
    if !trial.quick {
        return Ok(scenario);
    }
    Ok(scenario.with(|c| {
        c.rate_hz *= 0.5;
        c.run.duration_s = c.run.duration_s.map(|duration_s| duration_s * 0.5);
        c.areas[0].simulation.flexure_changes.iter_mut().for_each(|change| change.at_s *= 0.5);
    }))
}

fn measure(experiment: &str, size: Size, trial: &Trial) -> Result<Measured, Fault> {
    let scenario = scenario(experiment, size, trial)?;
    let data = Data::simulate(&scenario)?;
    let begin_ns = data.pairs.first().map_or(0, |pair| pair.header.time_ns);
    let moves = experiment == "1.3";
    let bound = methods::told(&methods::matched(&methods::of("model_free_a", &scenario, size)?, moves));
    let mut tracks = vec![run_told(&bound, &data, 1.0, &methods::changes(&scenario, begin_ns))];
    for method in configurations(experiment, size, &scenario)? {
        let coarser = |c: &mut Configuration| c.areas[0].estimator.filter_hz = QUICK_NETWORK_HZ;
        let slow = trial.quick && method.areas[0].estimator.network.is_some();
        tracks.push(run(&if slow { method.with(coarser) } else { method }, &data, 1.0));
    }
    let converged_s = CONVERGED * scenario.run.duration_s.unwrap_or(0.0);
    let figures = tracks.iter().map(|track| Figures::of(track.over(converged_s..))).collect();
    let kept = (trial.index == 0).then(|| [tracks.swap_remove(1), tracks.swap_remove(2)]);
    Ok(Measured { figures, tracks: kept })
}

fn conclude(experiment: &str, size: Size, trials: &[Measured]) -> Findings {
    let table = format!("Experiment {experiment}, {} flexure, RMSE after a third", size.name());
    let methods = methods(experiment);
    let values = |method: usize, axis: usize| -> Vec<f64> {
        trials.iter().map(|trial| trial.figures[method].rmse[axis]).collect()
    };
    let mut rows = Vec::new();
    for (index, method) in methods.iter().enumerate() {
        for (axis, name) in AXES.into_iter().enumerate() {
            let bound = match index {
                0 => rms(&trials.iter().map(|trial| trial.figures[0].sigma[axis]).collect::<Vec<_>>()),
                _ => rms(&values(0, axis)),
            };
            let paper = match method.paper {
                Some(figures) => Published::Magnitude(figures[axis], 1),
                None => Published::Nothing(NO_SUCH_METHOD.into()),
            };
            let id = format!("model-free/{experiment}/{}/{}/{name}", size.name(), method.id);
            let claim: Claim =
                claim(id, &table, method.name.into(), [name, "arcsec"], Bound::Value(bound), paper, method.why);
            rows.push(claim.rms(&values(index, axis)));
        }
    }
    Findings { rows, figures: figures(experiment, size, trials, &methods) }
}

fn figures(experiment: &str, size: Size, trials: &[Measured], methods: &[Method]) -> Vec<Figure> {
    let of = |method: usize, axis: usize| {
        let values: Vec<f64> = trials.iter().map(|trial| trial.figures[method].rmse[axis]).collect();
        (rms(&values), spread(&values))
    };
    // the raw difference that Method B lets pass and Method A without a rate would hide all the others
    let shown: Vec<usize> = (0..methods.len()).filter(|&i| of(i, 0).0.max(of(i, 2).0) < 20.0 * of(0, 2).0).collect();
    let series = |axis: usize| Series {
        name: AXES[axis].into(),
        values: shown.iter().map(|&method| of(method, axis)).collect(),
        bounds: shown.iter().map(|_| of(0, axis).0).collect(),
    };
    let mut figures = vec![Figure {
        title: format!("Experiment {experiment}, {} flexure: RMSE after a third", size.name()),
        caption: "The paper's figures 7, 10 and 13. The tick is the filter that is told the true models; methods that \
                  are off by more than twenty times its error are left out."
            .into(),
        plot: Plot::Bars(Bars {
            value: Label::new("RMSE", "arcsec"),
            groups: shown.iter().map(|&method| methods[method].name.into()).collect(),
            series: [0, 1, 2].map(series).into(),
        }),
    }];
    if let Some(tracks) = &trials[0].tracks {
        figures.push(errors(experiment, size, tracks));
    }
    figures
}

fn errors(experiment: &str, size: Size, tracks: &[Track; 2]) -> Figure {
    let line = |name: &str, track: &Track| Line {
        name: name.into(),
        stroke: Stroke::Solid,
        points: track.over(60.0..).line(|point| point.error[0] / ARCSEC).into_iter().step_by(5).collect(),
    };
    Figure {
        title: format!("Experiment {experiment}, {} flexure: error about x", size.name()),
        caption: "The first trial; the paper's figures 6, 9 and 12.".into(),
        plot: Plot::Lines {
            x: Label::new("time", "s"),
            y: Label::new("error about x", "arcsec"),
            lines: vec![line("Method A", &tracks[0]), line("Method B", &tracks[1])],
        },
    }
}
