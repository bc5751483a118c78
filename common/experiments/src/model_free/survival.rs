//! Beyond the paper: a delay of 200 ms, and a clock that is 50 ppm fast.

use super::delay::QUICK_RATE;
use super::{AXES, Figures, Size, claim, methods};
use crate::{
    Bound, Data, Estimated, Fault, Figure, Findings, Label, Line, Plot, Published, Row, Stroke, Study, Track, Trial,
    Trials, presets, rms, run, run_told,
};
use pipeline::configuration::{Configuration, DelaySettings, RegistrationMethod};
use std::ops::RangeInclusive;

const SPAN: RangeInclusive<f64> = 120.0..=900.0;
/// Seconds of data times methods, roughly.
const COST: u64 = 3 * 900 * 8;
const NOTHING: &str = "the paper goes no further than 30 ms";

/// Delay at the start, s, and skew.
const CASES: [(&str, f64, f64); 3] =
    [("200 ms", 0.2, 0.0), ("50 ms + 50 ppm", 0.05, 50e-6), ("200 ms + 50 ppm", 0.2, 50e-6)];

/// In the order of the tracks: id, name, why.
const METHODS: [(&str, &str, &str); 4] = [
    ("true", "Filter told the true models (the bound)", "Re-timed, with delay and skew as states."),
    (
        "gm",
        "Gauss-Markov, re-timed, delay and skew",
        "Coarse delay in 10 s, then re-timed whenever the rest exceeds 1 ms.",
    ),
    ("gm-constant", "Gauss-Markov, re-timed, delay without skew", "A constant falls behind a clock that runs away."),
    ("gm-linear", "Gauss-Markov, linear delay and skew", "The linear term of 200 ms lacks 232 arcsec."),
];

pub(super) fn study(size: Size) -> Study {
    Study::new(
        Trials { full: 6, quick: 1 },
        COST,
        move |trial| CASES.iter().map(|&case| measure(case, size, trial)).collect(),
        move |trials: &[Vec<Measured>]| conclude(size, trials),
    )
}

struct Measured {
    /// By method: with the delay's error at the end, us, and the skew's, ppm.
    figures: Vec<(Figures, f64, f64)>,
    /// Of the first trial.
    tracks: Option<Vec<Track>>,
}

fn late(scenario: &Configuration, delay_s: f64, skew: f64) -> Configuration {
    scenario.with(|c| {
        let wire = &mut c.areas[0].simulation.wire;
        (wire.delay, wire.skew) = (delay_s, skew);
    })
}

/// By how much a stamp `time_s` is late, s.
fn truth(delay_s: f64, skew: f64, time_s: f64) -> f64 {
    (delay_s + skew * time_s) / (1.0 + skew)
}

fn measure((_, delay_s, skew): (&str, f64, f64), size: Size, trial: &Trial) -> Result<Measured, Fault> {
    let scenario = late(&presets::configuration(&size.preset("2.1"), trial.seed)?, delay_s, skew)
        .with(|c| c.rate_hz *= if trial.quick { QUICK_RATE } else { 1.0 });
    let data = Data::simulate(&scenario)?;
    let begin_ns = data.pairs.first().map_or(0, |pair| pair.header.time_ns);
    let gm = methods::of("model_free_delay_skew", &scenario, size)?;
    let told = methods::of("model_free_b", &scenario, size)?.areas[0].installation;
    let others = [
        gm.clone(),
        gm.with(|c| c.areas[0].estimator.delay = Some(DelaySettings::default())),
        gm.with(|c| {
            let area = &mut c.areas[0];
            area.installation = told;
            area.estimator.registration = RegistrationMethod::Installation;
            area.estimator.delay =
                area.estimator.delay.map(|delay| DelaySettings { sigma: 0.3, retime: false, ..delay });
        }),
    ];
    let mut tracks = vec![run_told(&methods::told(&gm), &data, 0.5, &methods::changes(&scenario, begin_ns))];
    tracks.extend(others.iter().map(|method| run(method, &data, 0.5)));
    let value = |of: Option<Estimated>| of.map_or(f64::NAN, |of| of.value);
    let figures = |track: &Track| {
        let last = track.points.last();
        let error = last.map_or(f64::NAN, |last| value(last.delay) - truth(delay_s, skew, last.time_s));
        let drift = last.map_or(f64::NAN, |last| value(last.skew) - skew);
        (Figures::of(track.over(SPAN)), error * 1e6, drift * 1e6)
    };
    Ok(Measured { figures: tracks.iter().map(figures).collect(), tracks: (trial.index == 0).then_some(tracks) })
}

fn conclude(size: Size, trials: &[Vec<Measured>]) -> Findings {
    let mut findings = Findings::default();
    for (case, &(name, delay_s, skew)) in CASES.iter().enumerate() {
        let cases: Vec<&Measured> = trials.iter().map(|trial| &trial[case]).collect();
        for index in 0..METHODS.len() {
            findings.rows.extend(rows(name, size, &cases, index));
        }
        findings.figures.extend(figure(name, delay_s, skew, size, cases[0]));
    }
    findings
}

fn rows(case: &str, size: Size, trials: &[&Measured], index: usize) -> Vec<Row> {
    let (id, name, why) = METHODS[index];
    let table = format!("Beyond the paper: {case}, {} flexure", size.name());
    let of = |figure: &dyn Fn(&Measured) -> f64| trials.iter().map(|trial| figure(trial)).collect::<Vec<_>>();
    let row = |rest: &str, axis: &str, unit: &str, bound: Bound, why: &str| {
        let id = format!("model-free/late/{}/{}/{id}/{rest}", case.replace(' ', ""), size.name());
        claim(id, &table, name.into(), [axis, unit], bound, Published::Nothing(NOTHING.into()), why)
    };
    let mut rows: Vec<Row> = [0, 1, 2]
        .into_iter()
        .map(|axis| {
            let bound = match index {
                0 => rms(&of(&|trial| trial.figures[0].0.sigma[axis])),
                _ => rms(&of(&|trial| trial.figures[0].0.rmse[axis])),
            };
            row(&format!("rmse/{}", AXES[axis]), AXES[axis], "arcsec", Bound::Value(bound), why)
                .rms(&of(&|trial| trial.figures[index].0.rmse[axis]))
        })
        .collect();
    let bound = |figure: &dyn Fn(&Measured) -> f64| match index {
        0 => Bound::None("this is the bound".into()),
        _ => Bound::Value(rms(&of(figure))),
    };
    let delay = row("delay-end", "delay at the end", "us", bound(&|trial| trial.figures[0].1), why);
    rows.push(delay.rms(&of(&|trial| trial.figures[index].1)));
    if index != 2 {
        let skew = row("skew-end", "skew at the end", "ppm", bound(&|trial| trial.figures[0].2), why);
        rows.push(skew.rms(&of(&|trial| trial.figures[index].2)));
    }
    rows
}

fn figure(case: &str, delay_s: f64, skew: f64, size: Size, trial: &Measured) -> Option<Figure> {
    let tracks = trial.tracks.as_ref()?;
    let line = |index: usize, name: &str| Line {
        name: name.into(),
        stroke: Stroke::Solid,
        points: tracks[index]
            .points
            .iter()
            .step_by(4)
            .map(|point| {
                let error = point.delay.map(|delay| delay.value - truth(delay_s, skew, point.time_s));
                // a filter that has lost itself would hide the others
                (point.time_s, error.map_or(f64::NAN, |error| error * 1e3).clamp(-5.0, 5.0))
            })
            .collect(),
    };
    Some(Figure {
        title: format!("{case}, {} flexure: error of the delay", size.name()),
        caption: "The first trial; errors beyond 5 ms are drawn at 5 ms.".into(),
        plot: Plot::Lines {
            x: Label::new("time", "s"),
            y: Label::new("error of the delay", "ms"),
            lines: vec![
                line(1, "re-timed, delay and skew"),
                line(2, "re-timed, delay without skew"),
                line(3, "linear delay and skew"),
            ],
        },
    })
}
