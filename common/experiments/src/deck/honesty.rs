//! The estimator against what it says of itself.

use super::AXES;
use super::claims::{judged, largest};
use super::measure::Measured;
use super::scenario::Scenario;
use crate::{Bound, Claim, Findings, Published, Row, mean};
use estimation::evaluate::NORMAL_95;

/// What an error may be over its deviation in the first five minutes.
const FARTHEST: f64 = 4.5;
/// Whose figures stand in [`Measured::honesty`]: key and name.
const WHOSE: [(&str, &str); 2] = [("", ""), ("-told", ", told the truth")];

pub(super) fn conclude(scenario: &Scenario, trials: &[Option<Measured>]) -> Findings {
    let trials: Vec<&Measured> = trials.iter().flatten().collect();
    let mut rows = Vec::new();
    if !trials.is_empty() {
        rows.extend([0, 1].map(|whose| nees_row(scenario, &trials, whose)));
        rows.extend([0, 1].map(|whose| early_row(scenario, &trials, whose)));
        rows.extend([0, 1, 2].map(|axis| coverage_row(scenario, &trials, axis)));
        rows.push(valid_row(scenario, &trials));
        rows.push(step_row(scenario, &trials));
    }
    Findings { rows, figures: Vec::new() }
}

fn claim(scenario: &Scenario, id: &str, row: String, bound: Bound, paper: Published, why: String) -> Claim {
    Claim {
        id: format!("deck/{}/{id}", scenario.id),
        table: format!("{}: what the estimator says of itself", scenario.title),
        row,
        axis: "all".into(),
        unit: String::new(),
        bound,
        paper,
        why,
    }
}

fn values(trials: &[&Measured], figure: impl Fn(&Measured) -> f64) -> Vec<f64> {
    trials.iter().map(|trial| figure(trial)).collect()
}

fn highest(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::NAN, f64::max)
}

fn nees_row(scenario: &Scenario, trials: &[&Measured], whose: usize) -> Row {
    let (key, name) = WHOSE[whose];
    let figure = |trial: &Measured| trial.honesty[whose].nees;
    let [low, high] = nees_band(trials.len());
    let (row, paper) = (format!("normalised squared error at the end{name}"), Published::Range(low, high));
    let why = format!("3 is honest, the range holds 95 % of honest ensembles. {}", largest(trials, figure));
    let nees = values(trials, figure);
    judged(claim(scenario, &format!("nees{key}"), row, Bound::Value(3.0), paper, why), mean(&nees), &nees)
}

fn early_row(scenario: &Scenario, trials: &[&Measured], whose: usize) -> Row {
    let (key, name) = WHOSE[whose];
    let figure = |of: usize| move |trial: &Measured| trial.honesty[of].early;
    let row = format!("largest error over its deviation in the first 5 min{name}");
    let why = format!("Over all trials and axes. {}", largest(trials, figure(whose)));
    let told = Bound::Value(highest(&values(trials, figure(1))));
    let claim = claim(scenario, &format!("farthest{key}"), row, told, Published::AtMost(FARTHEST), why);
    let early = values(trials, figure(whose));
    judged(claim, highest(&early), &early)
}

fn coverage_row(scenario: &Scenario, trials: &[&Measured], axis: usize) -> Row {
    let row = "share of errors in the range from 1 min on".into();
    let paper = Published::Nothing("without coupling the limits are of ratio and squared error".into());
    let why = "The error of a run is nearly constant: single runs are inside or outside as a whole.".into();
    let claim = Claim {
        axis: AXES[axis].into(),
        ..claim(scenario, &format!("coverage/{}", AXES[axis]), row, Bound::Value(0.95), paper, why)
    };
    let held = values(trials, |trial: &Measured| trial.honesty[0].coverage[axis]);
    judged(claim, mean(&held), &held)
}

fn valid_row(scenario: &Scenario, trials: &[&Measured]) -> Row {
    let valid = values(trials, |trial: &Measured| trial.honesty[0].valid);
    let whole = valid.iter().filter(|share| **share == 1.0).count();
    let why = format!("{whole} of {} trials have one at every instant.", valid.len());
    let paper = Published::Nothing("no limit is set".into());
    let row = "share of valid solutions from 1 min on".into();
    judged(claim(scenario, "valid", row, Bound::Value(1.0), paper, why), mean(&valid), &valid)
}

fn step_row(scenario: &Scenario, trials: &[&Measured]) -> Row {
    let figure = |trial: &Measured| trial.honesty[0].step;
    let row = "largest change of the error from pair to pair, over the range".into();
    let why = format!("Above 1 is a step that the range does not cover. {}", largest(trials, figure));
    let bound = Bound::None("a take-over by a better filter is a step".into());
    let steps = values(trials, figure);
    judged(claim(scenario, "step", row, bound, Published::AtMost(1.0), why), highest(&steps), &steps)
}

/// Within which the mean of so many values of chi-square with 3 degrees of freedom lies in 95 of 100 cases, by Wilson and Hilferty:
/// right to 0.04 for one and to 0.02 for two.
fn nees_band(count: usize) -> [f64; 2] {
    let freedom = 3.0 * count as f64;
    let part = 2.0 / (9.0 * freedom);
    [-NORMAL_95, NORMAL_95].map(|z| (3e3 * (1.0 - part + z * part.sqrt()).powi(3)).round() / 1e3)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_band_is_that_of_tables() {
        for (count, low, high, near) in [
            (1, 0.2158, 9.3484, 0.04),
            (2, 0.6187, 7.2247, 0.02),
            (10, 1.6791, 4.6979, 0.005),
            (30, 2.1882, 3.9379, 0.003),
        ] {
            let [ours_low, ours_high] = nees_band(count);
            assert!(
                (ours_low - low).abs() < near && (ours_high - high).abs() < near,
                "{count}: {ours_low} {ours_high}"
            );
        }
    }
}
