//! The estimator against the same estimator told the truth.

use super::AXES;
use super::measure::{Measured, TOLD_LATER_S};
use super::paired::{Paired, interval, of_one, ratio, root};
use super::scenario::Scenario;
use crate::{Bound, Claim, Findings, Published, Row, Verdict, rms, spread};

/// The axes that a ratio is taken over, by name.
pub(super) const POOLS: [(&str, &[usize]); 4] = [("x", &[0]), ("y", &[1]), ("z", &[2]), ("all", &[0, 1, 2])];
/// Key and name of the ends of an interval.
pub(super) const ENDS: [(&str, &str); 2] = [("lower", ", 95 % interval from"), ("upper", ", 95 % interval to")];
/// What an interval is made of.
pub(super) const BOOTSTRAP: &str = "By the bootstrap over trials.";
/// Key and name of the spans of [`super::measure::SPANS`], in their order.
pub(super) const SPAN_NAMES: [(&str, &str); 2] = [("late", "after 5 min"), ("early", "from 1 to 5 min")];
/// What a ratio may be from 1 to 5 minutes.
const EARLY: f64 = 1.25;

/// The ratios and errors of both spans.
pub(super) fn conclude(scenario: &Scenario, trials: &[Option<Measured>]) -> Findings {
    let trials: Vec<&Measured> = trials.iter().flatten().collect();
    let mut rows = Vec::new();
    for span in (0..SPAN_NAMES.len()).filter(|_| !trials.is_empty()) {
        rows.extend(ratio_rows(scenario, &trials, span));
    }
    for span in (0..SPAN_NAMES.len()).filter(|_| !trials.is_empty()) {
        rows.extend(error_rows(scenario, &pairs(&trials, span), span));
    }
    rows.extend(later_rows(scenario, &trials));
    Findings { rows, figures: Vec::new() }
}

/// What it costs to hear of a change of the flexure half a minute later than it happens, were the new flexure told then.
fn later_rows(scenario: &Scenario, trials: &[&Measured]) -> Vec<Row> {
    let pairs: Vec<Paired> = trials.iter().filter_map(|trial| trial.told_later).collect();
    let row = |(axis, axes): (&str, &[usize])| {
        let claim = Claim {
            id: format!("deck/{}/told-later/ratio/{axis}", scenario.id),
            table: format!(
                "{}: RMSE if told of changes {TOLD_LATER_S} s late over that if told at once",
                scenario.title
            ),
            row: SPAN_NAMES[0].1.into(),
            axis: axis.into(),
            unit: String::new(),
            bound: Bound::Value(1.0),
            paper: Published::Nothing("what no method that has to see a change can do much better than".into()),
            why: "Half a minute is five swings of the new flexure.".into(),
        };
        let values: Vec<f64> = pairs.iter().map(|pair| of_one(pair, axes)).collect();
        judged(claim, ratio(&pairs, axes), &values)
    };
    POOLS.into_iter().filter(|_| !pairs.is_empty()).map(row).collect()
}

fn pairs(trials: &[&Measured], span: usize) -> Vec<Paired> {
    trials.iter().filter_map(|trial| trial.truth[span]).collect()
}

/// A row whose verdict takes the figure as it is: a limit of our own is not excused by the spread over the trials.
pub(super) fn judged(claim: Claim, ours: f64, values: &[f64]) -> Row {
    let verdict = Verdict::of(ours, f64::NAN, values.len(), &claim.paper);
    Row { claim, ours, spread: spread(values), trials: values.len(), verdict }
}

/// The trial in which a figure is the largest, in words.
pub(super) fn largest(trials: &[&Measured], figure: impl Fn(&Measured) -> f64) -> String {
    largest_of(trials.iter().map(|trial| (figure(trial), trial.seed)))
}

/// The same of figures with their seeds.
pub(super) fn largest_of(figures: impl Iterator<Item = (f64, u64)>) -> String {
    let largest = figures.max_by(|a, b| a.0.total_cmp(&b.0));
    largest.map_or("No trial has one.".into(), |(figure, seed)| {
        format!("The largest of a trial is {figure:.3}, of seed {seed}.")
    })
}

/// The ratios about each axis and over all, then both ends of their intervals.
fn ratio_rows(scenario: &Scenario, trials: &[&Measured], span: usize) -> Vec<Row> {
    let pairs = pairs(trials, span);
    let (key, name) = SPAN_NAMES[span];
    let claim = |end: &str, what: &str, axis: &str, paper: Published, why: String| Claim {
        id: format!("deck/{}/{key}/{end}/{axis}", scenario.id),
        table: format!("{}: RMSE over that of the same estimator told the truth, same data", scenario.title),
        row: format!("{name}{what}"),
        axis: axis.into(),
        unit: String::new(),
        bound: Bound::Value(1.0),
        paper,
        why,
    };
    let mut rows = Vec::new();
    for (axis, axes) in POOLS {
        let limit = match (span, axes.len()) {
            (0, 3) => scenario.limits.0,
            (0, _) => scenario.limits.1,
            _ => EARLY,
        };
        let why = largest(trials, |trial| trial.truth[span].map_or(f64::NAN, |pair| of_one(&pair, axes)));
        let values: Vec<f64> = pairs.iter().map(|pair| of_one(pair, axes)).collect();
        rows.push(judged(claim("ratio", "", axis, Published::AtMost(limit), why), ratio(&pairs, axes), &values));
    }
    for (place, (end, what)) in ENDS.into_iter().enumerate().filter(|_| pairs.len() > 1) {
        rows.extend(POOLS.map(|(axis, axes)| {
            let values: Vec<f64> = pairs.iter().map(|pair| of_one(pair, axes)).collect();
            let paper = Published::Nothing("the limit is one of the ratio".into());
            judged(claim(end, what, axis, paper, BOOTSTRAP.into()), interval(&pairs, axes)[place], &values)
        }));
    }
    rows
}

/// A figure of a pair, with key and name.
type Kind = (&'static str, &'static str, fn(&Paired) -> [f64; 3]);

const KINDS: [Kind; 4] = [
    ("rmse", "RMSE", |pair| pair.ours),
    ("sigma", "standard deviation", |pair| pair.variance),
    ("rmse-told", "RMSE told the truth", |pair| pair.other),
    ("sigma-told", "standard deviation told the truth", |pair| pair.other_variance),
];

fn error_rows(scenario: &Scenario, pairs: &[Paired], span: usize) -> Vec<Row> {
    let (key, name) = SPAN_NAMES[span];
    let size = scenario.unit.size;
    let row = |(id, what, figure): Kind, axis: usize| {
        let sane = scenario.sane.filter(|_| (id, span) == ("rmse", 0));
        let claim = Claim {
            id: format!("deck/{}/{key}/{id}/{}", scenario.id, AXES[axis]),
            table: format!("{}: error and standard deviation", scenario.title),
            row: format!("{what}, {name}"),
            axis: AXES[axis].into(),
            unit: scenario.unit.name.into(),
            bound: Bound::Value(root(pairs, axis, |pair| pair.other_variance) / size),
            paper: sane
                .map_or(Published::Nothing("the limits are of ratios".into()), |sane| Published::AtMost(sane[axis])),
            why: "The bound is the standard deviation of the estimator that is told the truth.".into(),
        };
        let values: Vec<f64> = pairs.iter().map(|pair| figure(pair)[axis].sqrt() / size).collect();
        judged(claim, rms(&values), &values)
    };
    KINDS.into_iter().flat_map(|kind| [0, 1, 2].map(|axis| row(kind, axis))).collect()
}
