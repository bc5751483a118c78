//! The rows and the figure of a case.

use super::super::AXES;
use super::super::claims::{POOLS, judged, largest_of};
use super::{Case, Counts, Measured};
use crate::{Bound, Claim, Figure, Findings, Label, Line, Plot, Point, Published, Row, Stroke};
use frames::unit::ARCMIN;

/// The share of the errors that the range must hold, over all axes and trials.
const HELD: f64 = 0.93;

pub(super) fn conclude(case: &Case, trials: &[Measured]) -> Findings {
    let mut rows: Vec<Row> = POOLS.into_iter().map(|pool| held_row(case, trials, pool)).collect();
    rows.push(largest_row(case, trials));
    rows.push(valid_row(case, trials));
    Findings { rows, figures: figure(case, &trials[0]).into_iter().collect() }
}

fn claim(case: &Case, key: &str, row: &str, axis: &str, bound: Bound, paper: Published, why: String) -> Claim {
    Claim {
        id: format!("deck/troubles/{}/{key}/{axis}", case.id),
        table: format!("000, {}: what the estimator says of itself", case.title),
        row: row.into(),
        axis: axis.into(),
        unit: String::new(),
        bound,
        paper,
        why,
    }
}

fn pooled(trials: &[Measured], counts: fn(&Measured) -> Counts) -> Counts {
    trials.iter().map(counts).fold(Counts::default(), Counts::and)
}

fn held_row(case: &Case, trials: &[Measured], (axis, axes): (&str, &[usize])) -> Row {
    let whole = pooled(trials, |trial| trial.whole).held_share(axes);
    let after = pooled(trials, |trial| trial.after).held_share(axes);
    let lowest = trials.iter().map(|trial| (trial.whole.held_share(axes), trial.seed));
    let lowest = lowest.filter(|(share, _)| share.is_finite()).min_by(|a, b| a.0.total_cmp(&b.0));
    let why = match (lowest, case.event) {
        (None, _) => "No solution is valid.".into(),
        (Some((share, seed)), false) => format!("The lowest of a trial is {share:.3}, of seed {seed}."),
        (Some((share, seed)), true) => {
            format!("The lowest of a trial is {share:.3}, of seed {seed}; from the event on {after:.3} of all.")
        }
    };
    let paper = match axes.len() {
        3 => Published::AtLeast(HELD),
        _ => Published::Nothing("the limit is one of all axes".into()),
    };
    let row = "share of valid solutions from 1 min on whose range holds the error";
    let shares: Vec<f64> = trials.iter().map(|trial| trial.whole.held_share(axes)).filter(|s| s.is_finite()).collect();
    judged(claim(case, "held", row, axis, Bound::Value(0.95), paper, why), whole, &shares)
}

fn largest(trial: &Measured) -> f64 {
    trial.largest.into_iter().fold(f64::NAN, f64::max)
}

fn largest_row(case: &Case, trials: &[Measured]) -> Row {
    let seen: Vec<(f64, u64)> = trials.iter().map(|trial| (largest(trial), trial.seed)).collect();
    let seen: Vec<(f64, u64)> = seen.into_iter().filter(|(ratio, _)| ratio.is_finite()).collect();
    let ratios: Vec<f64> = seen.iter().map(|(ratio, _)| *ratio).collect();
    let bound = Bound::None("a range of 95 % is missed now and then".into());
    let paper = Published::Nothing("the limit is one of the share".into());
    let row = "largest error over its range from 1 min on";
    let claim = claim(case, "largest", row, "all", bound, paper, largest_of(seen.into_iter()));
    judged(claim, ratios.iter().copied().fold(f64::NAN, f64::max), &ratios)
}

fn valid_row(case: &Case, trials: &[Measured]) -> Row {
    let shares: Vec<f64> = trials.iter().map(|trial| trial.whole.valid_share()).collect();
    let ours = pooled(trials, |trial| trial.whole).valid_share();
    let after = pooled(trials, |trial| trial.after).valid_share();
    let since = if case.event { format!("From the event on {after:.3}. ") } else { String::new() };
    let paper = Published::Nothing("no limit is set".into());
    let why = format!("{since}{}", flags(trials));
    let row = "share of valid solutions from 1 min on";
    judged(claim(case, "valid", row, "all", Bound::Value(1.0), paper, why), ours, &shares)
}

/// The flags seen from one minute on with their shares of all instants, in words.
fn flags(trials: &[Measured]) -> String {
    let all = trials.iter().map(|trial| trial.whole.all).sum::<usize>() as f64;
    let seen = (0..trials[0].flags.len()).filter_map(|place| {
        let count = trials.iter().map(|trial| trial.flags[place].1).sum::<usize>();
        let share = 100.0 * count as f64 / all;
        (count > 0).then(|| format!("{} {share:.3} %", trials[0].flags[place].0.names()))
    });
    let seen: Vec<String> = seen.collect();
    if seen.is_empty() { "No flag is seen.".into() } else { format!("Flags seen: {}.", seen.join(", ")) }
}

/// The error about the axis that is the farthest out of its range; `None` if nothing is valid.
fn figure(case: &Case, trial: &Measured) -> Option<Figure> {
    let axes = [0, 1, 2].into_iter().filter(|&axis| trial.largest[axis].is_finite());
    let axis = axes.max_by(|&a, &b| trial.largest[a].total_cmp(&trial.largest[b]))?;
    let value = |figure: &dyn Fn(&Point) -> f64| {
        let shown = |point: &Point| if point.valid { figure(point) / ARCMIN } else { f64::NAN };
        trial.drawn.iter().map(|point| (point.time_s, shown(point))).collect::<Vec<_>>()
    };
    let line = |name: &str, stroke, points| Line { name: name.into(), stroke, points };
    let range = value(&|point| point.range[axis]);
    let error = value(&|point| point.error[axis]);
    let height = range.iter().chain(&error).map(|(_, y)| y.abs()).fold(0.0, f64::max);
    let mut lines = vec![
        line("95 % range", Stroke::Bound, range),
        line("95 % range", Stroke::Bound, value(&|point| -point.range[axis])),
        line("error", Stroke::Solid, error),
    ];
    if case.event {
        lines.push(line("event", Stroke::Truth, vec![(trial.at_s, -height), (trial.at_s, height)]));
    }
    Some(Figure {
        title: format!("Error about {} and its range, 000, {}", AXES[axis], case.title),
        caption:
            "The first trial, about the axis that is the farthest out of its range. Lines break where no solution is \
                  valid."
                .into(),
        plot: Plot::Lines {
            x: Label::new("time", "s"),
            y: Label::new(format!("deformation about {}", AXES[axis]), "arcmin"),
            lines,
        },
    })
}

#[cfg(test)]
mod tests {
    use super::super::{CASES, Measured};
    use super::*;
    use messages::Flags;
    use std::collections::BTreeSet;

    fn trial(valid: usize, held: [usize; 3], largest: [f64; 3]) -> Measured {
        let whole = Counts { all: 100, valid, held };
        let after = Counts { all: 50, valid: valid / 2, held: held.map(|held| held / 2) };
        let flags = vec![(Flags::INTERPOLATED, 100), (Flags::GAP, 100 - valid)];
        Measured { seed: 1, at_s: 80.0, whole, after, largest, flags, drawn: Vec::new() }
    }

    #[test]
    fn rows_are_unique_over_the_cases_and_pooled_by_instants() {
        let trials = [trial(100, [100, 90, 80], [0.5, 1.5, 2.5]), trial(20, [20, 20, 20], [0.5, 0.6, 0.7])];
        let rows: Vec<Row> = CASES.iter().flat_map(|case| conclude(case, &trials).rows).collect();
        let ids: BTreeSet<&str> = rows.iter().map(|row| row.claim.id.as_str()).collect();
        assert_eq!((rows.len(), ids.len()), (6 * CASES.len(), 6 * CASES.len()));
        let ours = |id: &str| rows.iter().find(|row| row.claim.id == id).map(|row| row.ours);
        assert_eq!(ours("deck/troubles/gap/held/y"), Some(110.0 / 120.0));
        assert_eq!(ours("deck/troubles/gap/held/all"), Some(330.0 / 360.0));
        assert_eq!(ours("deck/troubles/gap/largest/all"), Some(2.5));
        assert_eq!(ours("deck/troubles/gap/valid/all"), Some(0.6));
        let valid = rows.iter().find(|row| row.claim.id == "deck/troubles/gap/valid/all").map(|row| &row.claim.why);
        assert_eq!(
            valid.map(String::as_str),
            Some("From the event on 0.600. Flags seen: interpolated 100.000 %, gap 40.000 %.")
        );
    }

    #[test]
    fn a_case_without_a_valid_solution_fails_and_draws_nothing() {
        let findings = conclude(&CASES[2], &[trial(0, [0; 3], [f64::NAN; 3])]);
        assert!(findings.figures.is_empty());
        let held = findings.rows.iter().find(|row| row.claim.axis == "all").map(|row| row.verdict);
        assert_eq!(held, Some(crate::Verdict::DoesNot));
    }

    #[test]
    fn a_figure_marks_the_event_and_shows_the_worst_axis() {
        for case in &CASES {
            let figures = conclude(case, &[trial(100, [100, 90, 80], [0.5, 1.5, 2.5])]).figures;
            let Plot::Lines { lines, y, .. } = &figures[0].plot else { panic!("no lines") };
            assert_eq!((figures.len(), y.text.as_str()), (1, "deformation about z"));
            assert_eq!(lines.iter().any(|line| line.name == "event"), case.event, "{}", case.id);
        }
    }
}
