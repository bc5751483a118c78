//! The estimator beside each paper's best method that is not told the true flexure, on that paper's scenario.

use super::claims::{BOOTSTRAP, ENDS, POOLS, judged};
use super::measure::Measured;
use super::paired::{Paired, interval, of_one, ratio};
use super::scenario::Scenario;
use crate::{Bound, Claim, Findings, Published, Row};

/// What the upper end of the interval may be.
const LOSES: f64 = 1.1;

pub(super) fn conclude(scenario: &Scenario, trials: &[Option<Measured>]) -> Findings {
    let trials: Vec<&Measured> = trials.iter().flatten().collect();
    let mut rows = Vec::new();
    for place in (0..scenario.rivals.len()).filter(|_| !trials.is_empty()) {
        let (rival, beside) = (&scenario.rivals[place], trials.iter().map(|trial| &trial.rivals[place]));
        let pairs: Vec<Paired> = beside.clone().filter_map(|beside| beside.as_it_is).collect();
        rows.extend(rival_rows(scenario, (rival.id.into(), rival.name.into()), &pairs));
        // what another method takes for known, the data do not tell: no more than this can be done without it
        if let Some(knowledge) = rival.knowledge() {
            let pairs: Vec<Paired> = beside.clone().filter_map(|beside| beside.as_true).collect();
            let name = format!("{}, ours told the true flexure", rival.name);
            rows.extend(rival_rows(scenario, (format!("{}-bound", rival.id), name), &pairs));
            let pairs: Vec<Paired> = beside.filter_map(|beside| beside.as_knowing).collect();
            let name = format!("{}, ours told as it is that {}", rival.name, knowledge.what);
            rows.extend(rival_rows(scenario, (format!("{}-knowing", rival.id), name), &pairs));
        }
    }
    Findings { rows, figures: Vec::new() }
}

/// The ratios about each axis and over all, then the upper ends of their intervals.
fn rival_rows(scenario: &Scenario, (id, name): (String, String), pairs: &[Paired]) -> Vec<Row> {
    let claim = |key: &str, what: &str, axis: &str, paper: Published, why: &str| Claim {
        id: format!("deck/{}/{id}/{key}/{axis}", scenario.id),
        table: format!("{}: RMSE over that of other methods after 5 min, same data", scenario.title),
        row: format!("{name}{what}"),
        axis: axis.into(),
        unit: String::new(),
        bound: Bound::None("a method that does worse is no bound".into()),
        paper,
        why: why.into(),
    };
    let values = |axes| pairs.iter().map(|pair| of_one(pair, axes)).collect::<Vec<_>>();
    let ratio = |(axis, axes)| {
        let paper = Published::Nothing("the limit is one of the interval's upper end".into());
        judged(
            claim("ratio", "", axis, paper, "Below 1 the estimator is the better."),
            ratio(pairs, axes),
            &values(axes),
        )
    };
    let (key, what) = ENDS[1];
    let upper = |(axis, axes)| {
        let claim = claim(key, what, axis, Published::AtMost(LOSES), BOOTSTRAP);
        judged(claim, interval(pairs, axes)[1], &values(axes))
    };
    let ends = POOLS.into_iter().filter(|_| pairs.len() > 1).map(upper);
    POOLS.into_iter().map(ratio).chain(ends).collect()
}
