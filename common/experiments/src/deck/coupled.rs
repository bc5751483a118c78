//! Flexure in step with the ship, of which nobody told the estimator: what the published range holds, over an ensemble of couplings.
//!
//! The total's error of a run is nearly one constant vector, so that a run is inside or outside nearly as a whole: only the ensemble has a share.

use super::claims::{POOLS, judged};
use super::measure::EARLY_S;
use super::method;
use crate::{
    Bound, Claim, Fault, Findings, Published, Row, Stretch, Study, Track, Trial, Trials, mean, presets, run_together,
};
use estimation::evaluate::NORMAL_95;
use frames::Vec3;
use pipeline::configuration::Configuration;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use simulation::{Coupling, Response};
use std::f64::consts::TAU;

/// Length, full and quick, s.
const DURATION_S: (f64, f64) = (10_800.0, 600.0);
/// Distance of the points of a track, s: errors change with the waves.
const EVERY_S: f64 = 1.0;
/// The largest share of the flexure's deviation that is coherent.
const LARGEST: f64 = 0.6;
/// Damping of a resonator over the critical one.
const DAMPING: f64 = 0.05;
/// The kinds of coupling, in turns over the trials: key and name.
const KINDS: [(&str, &str); 4] = [
    ("wandering", "gain and phase wander"),
    ("constant", "gain and phase stay"),
    ("delayed", "0.1 to 1.5 s late"),
    ("resonant", "resonator of 0.1 to 0.4 Hz"),
];
/// What the range must hold, and what the deviation of the dynamic part.
const HELD: f64 = 0.93;
const HONEST: (f64, f64) = (0.93, 0.98);
/// What the width may be over 1.96 deviations: uncoupled without turns, and after turns.
const WIDE: f64 = 6.0;
const WIDE_AFTER_TURNS: f64 = 2.0;

/// A case.
#[derive(Clone, Copy, Debug)]
struct Case {
    id: &'static str,
    title: &'static str,
    preset: &'static str,
    coupled: bool,
    turns: bool,
    trials: Trials,
}

const CASES: [Case; 3] = [
    Case {
        id: "straight",
        title: "004, coupled",
        preset: "error_range_weak",
        coupled: true,
        turns: false,
        trials: Trials { full: 30, quick: 1 },
    },
    Case {
        id: "turns",
        title: "004, coupled, with turns",
        preset: "error_range_weak_turns",
        coupled: true,
        turns: true,
        trials: Trials { full: 30, quick: 1 },
    },
    Case {
        id: "uncoupled",
        title: "004, not coupled, three hours",
        preset: "error_range_weak",
        coupled: false,
        turns: false,
        trials: Trials { full: 10, quick: 1 },
    },
];

/// A figure about each axis with key and name.
struct Figure {
    key: &'static str,
    name: &'static str,
    of: fn(&Measured) -> [f64; 3],
}

const FIGURES: [Figure; 4] = [
    Figure { key: "range", name: "share of errors of the total in the range", of: |trial| trial.range },
    Figure { key: "naive", name: "the same in 1.96 standard deviations", of: |trial| trial.naive },
    Figure { key: "width", name: "mean width of the range over 1.96 standard deviations", of: |trial| trial.width },
    Figure {
        key: "dynamic",
        name: "share of errors of the dynamic part in 1.96 of its standard deviations",
        of: |trial| trial.dynamic,
    },
];

/// A trial of a case, by axis.
#[derive(Clone, Copy, Debug)]
struct Measured {
    seed: u64,
    /// Index in [`KINDS`], and the coherent share of the flexure.
    kind: usize,
    share: f64,
    /// Share of the instants at which there is an estimate; the other shares are of these.
    valid: f64,
    range: [f64; 3],
    naive: [f64; 3],
    width: [f64; 3],
    dynamic: [f64; 3],
}

/// Without turns, then with turns, then uncoupled.
pub(crate) fn studies() -> Vec<Study> {
    let study = |case: &'static Case| {
        Study::new(case.trials, DURATION_S.0 as u64, |trial| measure(case, trial), |trials| conclude(case, trials))
    };
    CASES.iter().map(study).collect()
}

/// The kind and the coupling of a trial.
fn coupling(trial: &Trial) -> (usize, Coupling) {
    let mut source = Pcg64Mcg::seed_from_u64(trial.seed);
    let share = LARGEST * source.random::<f64>();
    let place = source.random::<f64>();
    let between = |low: f64, high: f64| low + (high - low) * place;
    let kind = trial.index % KINDS.len();
    let response = match kind {
        0 => Response::Phase { wander: 0.35, wander_tau: 9000.0 },
        1 => Response::Phase { wander: 0.0, wander_tau: 9000.0 },
        2 => Response::Delayed { delay_s: between(0.1, 1.5) },
        _ => {
            let b = TAU * between(0.1, 0.4);
            Response::Resonant { mu: DAMPING * b, b }
        }
    };
    (kind, Coupling { share, response, in_phase_rotation: Vec3::ZERO })
}

fn configuration(case: &Case, trial: &Trial) -> Result<Configuration, Fault> {
    let (_, coupling) = coupling(trial);
    Ok(presets::configuration(case.preset, trial.seed)?.with(|c| {
        c.run.duration_s = Some(if trial.quick { DURATION_S.1 } else { DURATION_S.0 });
        let area = &mut c.areas[0];
        area.installation = None;
        area.simulation.coupling = case.coupled.then_some(coupling);
    }))
}

/// `None` of a case that a quick run leaves out.
fn measure(case: &Case, trial: &Trial) -> Result<Option<Measured>, Fault> {
    if trial.quick && (case.turns || !case.coupled) {
        return Ok(None);
    }
    let configuration = configuration(case, trial)?;
    let tracks = run_together(&configuration, &[method::default(&configuration)], EVERY_S)?;
    // the first turn shows what the waves do not
    let turned_s =
        configuration.simulation.turns.map_or(EARLY_S, |turns| turns.every_s + turns.length_s + turns.ramp_s);
    Ok(tracks.first().map(|track| Measured::of(track, turned_s, trial)))
}

impl Measured {
    fn of(track: &Track, turned_s: f64, trial: &Trial) -> Self {
        let (kind, Coupling { share, .. }) = coupling(trial);
        let all = track.over(EARLY_S..);
        Self {
            seed: trial.seed,
            kind,
            share,
            valid: all.valid_share(),
            range: all.coverage(|point| point.range),
            naive: all.coverage(|point| point.sigma().map(|sigma| NORMAL_95 * sigma)),
            width: width(track.over(turned_s..)),
            dynamic: all.held(|point| point.dynamic_error, |point| point.dynamic_sigma.map(|sigma| NORMAL_95 * sigma)),
        }
    }
}

fn width(over: Stretch) -> [f64; 3] {
    over.mean_of(|point| {
        let sigma = point.sigma();
        [0, 1, 2].map(|axis| point.range[axis] / (NORMAL_95 * sigma[axis]))
    })
}

fn conclude(case: &Case, trials: &[Option<Measured>]) -> Findings {
    let trials: Vec<&Measured> = trials.iter().flatten().collect();
    let mut rows = Vec::new();
    if !trials.is_empty() {
        rows.extend(FIGURES.iter().flat_map(|figure| POOLS.map(|pool| row(case, &trials, figure, pool))));
        rows.push(valid_row(case, &trials));
    }
    if case.coupled {
        rows.extend((0..KINDS.len()).filter_map(|kind| kind_row(case, &trials, kind)));
    }
    Findings { rows, figures: Vec::new() }
}

fn claim(case: &Case, key: &str, axis: &str, row: String) -> Claim {
    Claim {
        id: format!("deck/coupled/{}/{key}/{axis}", case.id),
        table: format!("{}: the published range after 5 min", case.title),
        row,
        axis: axis.into(),
        unit: String::new(),
        bound: Bound::Value(0.95),
        paper: Published::Nothing("no limit is set".into()),
        why: String::new(),
    }
}

/// The mean over some axes.
fn pooled(trial: &Measured, figure: &Figure, axes: &[usize]) -> f64 {
    axes.iter().map(|&axis| (figure.of)(trial)[axis]).sum::<f64>() / axes.len() as f64
}

fn row(case: &Case, trials: &[&Measured], figure: &Figure, (axis, axes): (&str, &[usize])) -> Row {
    let values: Vec<f64> = trials.iter().map(|trial| pooled(trial, figure, axes)).collect();
    let bound = match figure.key {
        "width" if case.coupled => Bound::None("what a coupling may hide is no part of the deviation".into()),
        "width" => Bound::Value(1.0),
        _ => Bound::Value(0.95),
    };
    let claim = Claim {
        bound,
        paper: limit(case, figure.key, axes),
        why: extremes(case, trials, figure, axes),
        ..claim(case, figure.key, axis, figure.name.into())
    };
    judged(claim, mean(&values), &values)
}

fn limit(case: &Case, key: &str, axes: &[usize]) -> Published {
    match key {
        "range" => Published::AtLeast(HELD),
        "dynamic" => Published::Range(HONEST.0, HONEST.1),
        "width" if !case.coupled => Published::AtMost(WIDE),
        "width" if case.turns && matches!(axes, [0] | [1]) => Published::AtMost(WIDE_AFTER_TURNS),
        "width" if case.turns => Published::Nothing("turns do not show the static angle about z".into()),
        _ => Published::Nothing("no limit is set".into()),
    }
}

/// The trials in which a figure is the smallest and the largest, in words.
fn extremes(case: &Case, trials: &[&Measured], figure: &Figure, axes: &[usize]) -> String {
    let mut sorted: Vec<(f64, &Measured)> = trials.iter().map(|trial| (pooled(trial, figure, axes), *trial)).collect();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
    let told = |(value, trial): &(f64, &Measured)| {
        let coupled = format!(" ({}, share {:.2})", KINDS[trial.kind].1, trial.share);
        format!("{value:.3} of seed {}{}", trial.seed, if case.coupled { &coupled } else { "" })
    };
    let ends = [sorted.first(), sorted.last()].map(|end| end.map_or_else(String::new, told));
    format!("From {} to {}.", ends[0], ends[1])
}

fn valid_row(case: &Case, trials: &[&Measured]) -> Row {
    let values: Vec<f64> = trials.iter().map(|trial| trial.valid).collect();
    let why = "The other shares are of the instants with a valid solution.".into();
    let claim = claim(case, "valid", "all", "share of valid solutions".into());
    judged(Claim { bound: Bound::Value(1.0), why, ..claim }, mean(&values), &values)
}

/// What the range holds of the errors under one kind of coupling.
fn kind_row(case: &Case, trials: &[&Measured], kind: usize) -> Option<Row> {
    let (key, name) = KINDS[kind];
    let [range, ..] = &FIGURES;
    let of: Vec<&Measured> = trials.iter().filter(|trial| trial.kind == kind).copied().collect();
    let values: Vec<f64> = of.iter().map(|trial| pooled(trial, range, &[0, 1, 2])).collect();
    let why = extremes(case, &of, range, &[0, 1, 2]);
    let paper = Published::Nothing("the limit is one of the ensemble".into());
    let claim = claim(case, &format!("range-{key}"), "all", format!("{}: {name}", range.name));
    (!values.is_empty()).then(|| judged(Claim { paper, why, ..claim }, mean(&values), &values))
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::Plan;

    /// Couplings do not depend on the case, and the ensemble has every kind from weak to strong.
    #[test]
    fn the_ensemble_has_every_kind_and_all_shares() {
        let plan = Plan { trials: None, seed: 1, quick: false };
        let (mut shares, mut kinds) = (Vec::new(), [0; KINDS.len()]);
        for index in 0..30 {
            let trial = plan.trial(index);
            let drawn = CASES.map(|case| configuration(&case, &trial).unwrap());
            let [straight, turns, uncoupled] = drawn.each_ref().map(|c| c.areas[0].simulation.coupling);
            assert!(straight.is_some() && straight == turns && uncoupled.is_none());
            assert!(drawn.iter().all(|c| c.areas[0].installation.is_none() && c.run.duration_s == Some(10_800.0)));
            assert_eq!(drawn.each_ref().map(|c| c.simulation.turns.is_some()), [false, true, false]);
            let (kind, coupling) = coupling(&trial);
            shares.push(coupling.share);
            kinds[kind] += 1;
            match coupling.response {
                Response::Phase { wander, .. } => assert_eq!(wander > 0.0, kind == 0),
                Response::Delayed { delay_s } => assert!(kind == 2 && (0.1..1.5).contains(&delay_s)),
                Response::Resonant { b, .. } => assert!(kind == 3 && (0.1..0.4).contains(&(b / TAU))),
            }
        }
        assert_eq!(kinds, [8, 8, 7, 7]);
        // the mean of 30 uniform shares: 0.3 within four deviations
        assert!((mean(&shares) - 0.3).abs() < 0.13 && shares.iter().all(|share| (0.0..LARGEST).contains(share)));
    }
}
