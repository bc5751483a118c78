//! Experiments 2.1 to 2.3: Methods B and C, and filters with Gauss-Markov flexure, with a sub unit whose data are late.

use super::{AXES, Figures, Size, claim, methods};
use crate::{
    Bound, Data, Estimated, Fault, Figure, Findings, Label, Line, Plot, Published, Row, Stroke, Study, Track, Trial,
    Trials, presets, rms, run, run_told,
};
use pipeline::configuration::{Configuration, DelaySettings, RegistrationMethod};
use std::ops::RangeInclusive;

/// Errors count from here on, s.
const SPAN: RangeInclusive<f64> = 120.0..=900.0;
/// When the delay is looked at, s.
const EARLY_S: f64 = 10.0;
/// Samples of a quick run over those of a full one.
pub(super) const QUICK_RATE: f64 = 0.25;
/// What counts as found, us.
const FOUND_US: f64 = 200.0;
/// Seconds of data times methods, roughly.
const COST: u64 = 900 * 30;

struct Method {
    id: &'static str,
    name: &'static str,
    /// The paper's largest error.
    paper: Option<Published>,
    /// Whether its RMSE has rows.
    rmse: bool,
    /// Whether it has a delay.
    delay: bool,
    why: &'static str,
}

/// In the order of the tracks.
fn methods(delay_ms: u32) -> Vec<Method> {
    let index = (delay_ms / 10 - 1) as usize % 3;
    let c = Published::Magnitude([200.0, 300.0, 500.0][index], 1);
    let b = Published::AtMost([5.0, 5.0, 10.0][index]);
    let method = |id, name, paper, rmse, delay, why| Method { id, name, paper, rmse, delay, why };
    let all_rate =
        "The error is the ship's rate times the delay; which axis turns fastest is up to the sea, which is ours.";
    vec![
        method("true", "Filter told the true models (the bound)", None, true, true, "Re-timed, delay as a state."),
        method(
            "c",
            "Method C: network, no compensation",
            Some(c.clone()),
            true,
            false,
            "The network takes the ship's rate for deformation, and the static part passes through beside it.",
        ),
        method("c-gm", "Gauss-Markov, no compensation", Some(c), false, false, all_rate),
        method(
            "b",
            "Method B: network, measurement as input, linear delay",
            Some(b.clone()),
            true,
            true,
            "What is left is the static part, which the network takes for itself, and w' tau^2 / 2.",
        ),
        method(
            "b-time",
            "Method B: network, time as input, linear delay",
            Some(b.clone()),
            false,
            true,
            "A random walk of the deformation with the delay's linear term.",
        ),
        method(
            "walk",
            "Random walk of the deformation, re-timed",
            Some(b.clone()),
            false,
            true,
            "The delay is seen as well as with any model; the static part is not.",
        ),
        method(
            "gm-linear",
            "Gauss-Markov, linear delay",
            Some(b.clone()),
            false,
            true,
            "The neglected w' tau^2 / 2 is 0.6, 2.3 and 5.2 arcsec at 10, 20 and 30 ms.",
        ),
        method(
            "gm",
            "Gauss-Markov, re-timed",
            Some(b),
            true,
            true,
            "The largest of 900 s on three axes; the bound has the same, for a quarter of an hour shows no more.",
        ),
    ]
}

pub(super) fn study(delay_ms: u32, size: Size) -> Study {
    Study::new(
        Trials { full: 6, quick: 2 },
        COST,
        move |trial| measure(delay_ms, size, trial),
        move |trials| conclude(delay_ms, size, trials),
    )
}

/// What is kept of an estimated delay; us and s.
#[derive(Clone, Copy)]
struct Delay {
    early: f64,
    end: f64,
    sigma: f64,
    /// From the start until the error stays within [`FOUND_US`].
    found_s: f64,
}

impl Delay {
    fn of(track: &Track, delay_ms: u32) -> Self {
        let truth = f64::from(delay_ms) * 1e-3;
        let error = |delay: Estimated| (delay.value - truth) * 1e6;
        let at = |time_s: f64| {
            let last = track.points.iter().take_while(|point| point.time_s <= time_s + 1e-6).last();
            last.and_then(|point| point.delay).map_or(f64::NAN, error)
        };
        let off = |delay: Option<Estimated>| delay.is_none_or(|delay| error(delay).abs() > FOUND_US);
        let lost = track.points.iter().rev().find(|point| off(point.delay));
        let end = track.points.last().and_then(|point| point.delay);
        Self {
            early: at(EARLY_S),
            end: end.map_or(f64::NAN, error),
            sigma: end.map_or(f64::NAN, |delay| delay.sigma * 1e6),
            found_s: lost.map_or(0.0, |point| point.time_s),
        }
    }
}

struct Measured {
    /// By method.
    figures: Vec<(Figures, Delay)>,
    /// Of the first trial.
    tracks: Option<Vec<Track>>,
}

/// All methods but the first, as configurations.
fn configurations(size: Size, scenario: &Configuration) -> Result<Vec<Configuration>, Fault> {
    let preset = |name: &str| methods::of(name, scenario, size);
    let b = preset("model_free_b")?;
    let gm = preset("model_free_delay")?;
    let told = b.areas[0].installation;
    let linear = b.areas[0].estimator.delay;
    let untimed = methods::matched(&gm, true).with(|c| c.areas[0].installation = told);
    Ok(vec![
        preset("model_free_c")?,
        untimed,
        b,
        preset("model_free_b_time")?.with(|c| c.areas[0].estimator.delay = linear),
        preset("model_free_walk")?.with(|c| c.areas[0].estimator.delay = Some(DelaySettings::default())),
        gm.with(|c| {
            let area = &mut c.areas[0];
            (area.installation, area.estimator.delay) = (told, linear);
            area.estimator.registration = RegistrationMethod::Installation;
        }),
        gm,
    ])
}

fn measure(delay_ms: u32, size: Size, trial: &Trial) -> Result<Measured, Fault> {
    let scenario = presets::configuration(&size.preset(&format!("2.{}", delay_ms / 10)), trial.seed)?
        .with(|c| c.rate_hz *= if trial.quick { QUICK_RATE } else { 1.0 });
    let data = Data::simulate(&scenario)?;
    let begin_ns = data.pairs.first().map_or(0, |pair| pair.header.time_ns);
    let bound = methods::told(&methods::of("model_free_delay", &scenario, size)?);
    let mut tracks = vec![run_told(&bound, &data, 0.1, &methods::changes(&scenario, begin_ns))];
    for method in configurations(size, &scenario)? {
        tracks.push(run(&method, &data, 0.1));
    }
    let figures = |track: &Track| (Figures::of(track.over(SPAN)), Delay::of(track, delay_ms));
    Ok(Measured { figures: tracks.iter().map(figures).collect(), tracks: (trial.index == 0).then_some(tracks) })
}

fn conclude(delay_ms: u32, size: Size, trials: &[Measured]) -> Findings {
    let mut rows = Vec::new();
    for (index, method) in methods(delay_ms).iter().enumerate() {
        if method.rmse {
            rows.extend(deformation_rows(delay_ms, size, trials, index, method));
        }
        if let Some(paper) = &method.paper {
            rows.push(largest_row(delay_ms, size, trials, index, method, paper));
        }
    }
    for (index, method) in methods(delay_ms).iter().enumerate().filter(|(_, method)| method.delay) {
        rows.extend(delay_rows(delay_ms, size, trials, index, method));
    }
    Findings { rows, figures: figures(delay_ms, size, trials) }
}

fn id(delay_ms: u32, size: Size, method: &Method, rest: &str) -> String {
    format!("model-free/2.{}/{}/{}/{rest}", delay_ms / 10, size.name(), method.id)
}

fn table(delay_ms: u32, size: Size, of: &str) -> String {
    format!("Experiment 2.{}, {delay_ms} ms, {} flexure: {of}", delay_ms / 10, size.name())
}

fn deformation_rows(
    delay_ms: u32,
    size: Size,
    trials: &[Measured],
    index: usize,
    method: &Method,
) -> impl Iterator<Item = Row> {
    [0, 1, 2].into_iter().map(move |axis| {
        let of = |figure: &dyn Fn(&Measured) -> f64| trials.iter().map(figure).collect::<Vec<_>>();
        let values = of(&|trial| trial.figures[index].0.rmse[axis]);
        let bound = match index {
            0 => rms(&of(&|trial| trial.figures[0].0.sigma[axis])),
            _ => rms(&of(&|trial| trial.figures[0].0.rmse[axis])),
        };
        claim(
            id(delay_ms, size, method, &format!("rmse/{}", AXES[axis])),
            &table(delay_ms, size, "RMSE after 2 min"),
            method.name.into(),
            [AXES[axis], "arcsec"],
            Bound::Value(bound),
            Published::Nothing("figure 18 has no figures in the text".into()),
            method.why,
        )
        .rms(&values)
    })
}

fn largest_row(
    delay_ms: u32,
    size: Size,
    trials: &[Measured],
    index: usize,
    method: &Method,
    paper: &Published,
) -> Row {
    let of = |index: usize| trials.iter().map(|trial| trial.figures[index].0.largest).collect::<Vec<_>>();
    let bound = of(0).iter().sum::<f64>() / trials.len() as f64;
    claim(
        id(delay_ms, size, method, "largest"),
        &table(delay_ms, size, "largest error after 2 min"),
        method.name.into(),
        ["all", "arcsec"],
        Bound::Value(bound),
        paper.clone(),
        method.why,
    )
    .mean(&of(index))
}

fn delay_rows(delay_ms: u32, size: Size, trials: &[Measured], index: usize, method: &Method) -> [Row; 4] {
    let of =
        |figure: &dyn Fn(&Delay) -> f64| trials.iter().map(|trial| figure(&trial.figures[index].1)).collect::<Vec<_>>();
    let sigma = rms(&trials.iter().map(|trial| trial.figures[0].1.sigma).collect::<Vec<_>>());
    let found = trials.iter().map(|trial| trial.figures[0].1.found_s).sum::<f64>() / trials.len() as f64;
    let row = |rest: &str, what: &str, unit: &str, bound, paper, why: &str| {
        let table = table(delay_ms, size, "the delay");
        claim(
            id(delay_ms, size, method, rest),
            &table,
            format!("{}: {what}", method.name),
            ["delay", unit],
            bound,
            paper,
            why,
        )
    };
    let unseen = || Published::Nothing("figure 17 has no figures in the text".into());
    let early = row(
        "delay-10s",
        "error after 10 s",
        "us",
        Bound::None("the bound's standard deviation is of the end".into()),
        unseen(),
        "The flexure's own rate disturbs the delay; time and a small flexure help.",
    );
    let end = row(
        "delay-end",
        "error at the end",
        "us",
        Bound::Value(sigma),
        unseen(),
        "The bound is the standard deviation of the filter that is told the true models.",
    );
    let within = row(
        "delay-found",
        "time until it stays within 0.2 ms",
        "s",
        Bound::Value(found),
        Published::AtMost(5.0),
        "The paper's 5 s are read off a curve, whose end nobody can see to 0.2 ms.",
    );
    let sure = |index: usize| trials.iter().map(move |trial| f64::from(trial.figures[index].1.early.abs() <= FOUND_US));
    let share = row(
        "delay-10s-share",
        "share of the trials within 0.2 ms after 10 s",
        "",
        Bound::Value(sure(0).sum::<f64>() / trials.len() as f64),
        unseen(),
        "Ten seconds are one wave and a half: the bound itself does not always get there.",
    );
    let sure: Vec<f64> = sure(index).collect();
    [
        early.rms(&of(&|delay| delay.early)),
        share.mean(&sure),
        end.rms(&of(&|delay| delay.end)),
        within.mean(&of(&|delay| delay.found_s)),
    ]
}

fn figures(delay_ms: u32, size: Size, trials: &[Measured]) -> Vec<Figure> {
    let Some(tracks) = &trials[0].tracks else { return Vec::new() };
    let truth_s = f64::from(delay_ms) * 1e-3;
    let line = |index: usize, name: &str| {
        let points = tracks[index].points.iter().filter(|point| point.time_s <= 60.0);
        let error = |delay: Option<Estimated>| delay.map_or(f64::NAN, |delay| delay.value * 1e3);
        Line {
            name: name.into(),
            stroke: Stroke::Solid,
            points: points.map(|point| (point.time_s, error(point.delay))).collect(),
        }
    };
    let truth =
        Line { name: "truth".into(), stroke: Stroke::Truth, points: vec![(0.0, truth_s * 1e3), (60.0, truth_s * 1e3)] };
    vec![Figure {
        title: format!("Delay of {delay_ms} ms, {} flexure", size.name()),
        caption: "The first minute of the first trial; the paper's figure 17.".into(),
        plot: Plot::Lines {
            x: Label::new("time", "s"),
            y: Label::new("delay", "ms"),
            lines: vec![
                line(3, "Method B, measurement as input"),
                line(5, "random walk, re-timed"),
                line(7, "Gauss-Markov, re-timed"),
                truth,
            ],
        },
    }]
}
