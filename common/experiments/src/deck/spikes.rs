//! Spikes of the sub unit's sensors, against the same data without them.

use super::claims::{BOOTSTRAP, ENDS, POOLS, judged, largest_of};
use super::measure::EARLY_S;
use super::method::{self, run_blind};
use super::paired::{Paired, interval, of_one, ratio};
use crate::{Bound, Claim, Data, Fault, Findings, Published, Row, Study, Trial, Trials, presets};
use pipeline::configuration::Configuration;
use simulation::Outliers;

const DURATION_S: f64 = 600.0;
/// What the RMSE may be over that of the clean data.
const LIMIT: f64 = 1.1;
/// Key, name and what they are. What is not found of those of one sign is a bias.
const SPIKES: [(&str, &str, Outliers); 3] = [
    ("frequent", "50 deviations in 1 % of the samples", Outliers { probability: 0.01, size: 50.0, one_sided: true }),
    (
        "either-sign",
        "50 deviations of either sign in 1 % of the samples",
        Outliers { probability: 0.01, size: 50.0, one_sided: false },
    ),
    ("huge", "1000 deviations in 0.2 % of the samples", Outliers { probability: 0.002, size: 1000.0, one_sided: true }),
];

/// A trial: its seed, and what spikes of each kind do after five minutes.
type Measured = Option<(u64, [Option<Paired>; SPIKES.len()])>;

pub(super) fn study() -> Study {
    let cost = DURATION_S as u64 * (1 + SPIKES.len() as u64);
    Study::new(Trials { full: 30, quick: 1 }, cost, measure, conclude)
}

/// `None` in a quick run, which leaves this out.
fn measure(trial: &Trial) -> Result<Measured, Fault> {
    if trial.quick {
        return Ok(None);
    }
    let track = |outliers| {
        let configuration = presets::configuration("idam_outliers", trial.seed)?.with(|c| {
            c.run.duration_s = Some(DURATION_S);
            c.areas[0].simulation.outliers = outliers;
        });
        on(&configuration)
    };
    let clean = track(Outliers::default())?;
    let mut pairs = [None; SPIKES.len()];
    for (pair, (.., outliers)) in pairs.iter_mut().zip(SPIKES) {
        *pair = Paired::of(track(outliers)?.over(EARLY_S..), clean.over(EARLY_S..));
    }
    Ok(Some((trial.seed, pairs)))
}

fn on(configuration: &Configuration) -> Result<crate::Track, Fault> {
    Ok(run_blind(&method::default(configuration), &Data::simulate(configuration)?))
}

fn conclude(trials: &[Measured]) -> Findings {
    let kinds = (0..SPIKES.len()).filter(|_| trials.iter().any(Option::is_some));
    Findings { rows: kinds.flat_map(|kind| rows(trials, kind)).collect(), figures: Vec::new() }
}

/// The ratios about each axis and over all, then the upper ends of their intervals.
fn rows(trials: &[Measured], kind: usize) -> Vec<Row> {
    let (key, name, _) = SPIKES[kind];
    let seen: Vec<(u64, Paired)> =
        trials.iter().flatten().filter_map(|(seed, pairs)| Some((*seed, pairs[kind]?))).collect();
    let pairs: Vec<Paired> = seen.iter().map(|(_, pair)| *pair).collect();
    let claim = |end: &str, what: &str, axis: &str, paper: Published, why: String| Claim {
        id: format!("deck/spikes/{key}/{end}/{axis}"),
        table: "000, spikes of the sub unit: RMSE after 5 min over that of the clean data".into(),
        row: format!("{name}{what}"),
        axis: axis.into(),
        unit: String::new(),
        bound: Bound::Value(1.0),
        paper,
        why,
    };
    let values = |axes| pairs.iter().map(|pair| of_one(pair, axes)).collect::<Vec<_>>();
    let ratios = POOLS.into_iter().map(|(axis, axes)| {
        let why = largest_of(seen.iter().map(|(seed, pair)| (of_one(pair, axes), *seed)));
        judged(claim("ratio", "", axis, Published::AtMost(LIMIT), why), ratio(&pairs, axes), &values(axes))
    });
    let (end, what) = ENDS[1];
    let ends = POOLS.into_iter().filter(|_| pairs.len() > 1).map(|(axis, axes)| {
        let paper = Published::Nothing("the limit is one of the ratio".into());
        judged(claim(end, what, axis, paper, BOOTSTRAP.into()), interval(&pairs, axes)[1], &values(axes))
    });
    ratios.chain(ends).collect()
}
