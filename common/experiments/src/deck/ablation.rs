//! What each part of the estimator is good for: taken out in turn, on the same data.

use super::claims::{SPAN_NAMES, judged};
use super::measure::{SPANS, paired};
use super::method::{self, run_blind};
use super::paired::{Paired, of_one, ratio};
use super::scenario::{SCENARIOS, Scenario};
use crate::{Bound, Claim, Data, Fault, Findings, Published, Row, Study, Trial, Trials, mean};
use estimation::identify::Method;
use pipeline::configuration::{Configuration, DelaySettings, IdentifierMethod, MatchingMethod};

/// A part, and how a configuration does without it.
struct Part {
    id: &'static str,
    name: &'static str,
    remove: fn(&mut Configuration),
    /// Whether the synchroniser's work is another one without it.
    of_data: bool,
}

const fn part(id: &'static str, name: &'static str, remove: fn(&mut Configuration)) -> Part {
    Part { id, name, remove, of_data: false }
}

const PARTS: [Part; 8] = [
    part("accelerometers", "without accelerometers", |c| {
        (c.main.accel, c.areas[0].accel) = (None, None);
    }),
    part("delay", "without delay and skew", |c| {
        c.areas[0].estimator.delay = Some(DelaySettings { sigma: 0.0, skew_sigma: 0.0, retime: true });
    }),
    part("so3", "without accelerometers, delay, evidence and replay", |c| {
        c.areas[0].estimator.matching = MatchingMethod::So3;
    }),
    part("whittle", "relevance vector machine in Whittle's place", |c| {
        c.areas[0].identifier.method = IdentifierMethod::Learnt(Method::Rvm);
    }),
    part("safety", "without the safety rule", |c| c.areas[0].identifier.safety = false),
    part("period", "identified every 60 s", |c| c.areas[0].identifier.period_s = 60.0),
    part("window", "window of 120 s", |c| c.areas[0].identifier.window_s = 120.0),
    Part { of_data: true, ..part("spikes", "without the spike test", |c| c.spike_threshold = 0.0) },
];

/// The scenarios in which parts are taken out.
const PLACES: [&str; 8] =
    ["000", "000-gyros", "000-impulsive", "000-low-grade", "001-30", "002-later", "002-changes", "003"];

/// The one of a quick run.
const QUICK: &str = "003";

/// A trial: by part and span, the whole estimator beside the one without the part, and the share of errors that the latter's range holds.
type Measured = Option<Vec<([Option<Paired>; 2], f64)>>;

pub(crate) fn studies() -> Vec<Study> {
    let study = |scenario: &'static Scenario| {
        let trials = Trials { full: 10, quick: 1 };
        let cost = scenario.cost() * PARTS.len() as u64;
        Study::new(trials, cost, |trial| measure(scenario, trial), |trials| conclude(scenario, trials))
    };
    SCENARIOS.iter().filter(|scenario| PLACES.contains(&scenario.id)).map(study).collect()
}

/// `None` of a scenario that a quick run leaves out.
fn measure(scenario: &Scenario, trial: &Trial) -> Result<Measured, Fault> {
    let wanted = !trial.quick || scenario.id == QUICK;
    let Some(configuration) = scenario.configuration(trial)?.filter(|_| wanted) else { return Ok(None) };
    let data = Data::simulate(&configuration)?;
    let default = method::default(&configuration);
    let whole = run_blind(&default, &data);
    let without = |part: &Part| {
        let changed = default.with(part.remove);
        let other =
            if part.of_data { run_blind(&changed, &Data::simulate(&changed)?) } else { run_blind(&changed, &data) };
        Ok((paired(&whole, &other), mean(&other.over(*SPANS[1].start()..).coverage(|point| point.range))))
    };
    Ok(Some(PARTS.iter().map(without).collect::<Result<_, Fault>>()?))
}

fn conclude(scenario: &Scenario, trials: &[Measured]) -> Findings {
    let trials: Vec<_> = trials.iter().flatten().collect();
    let mut rows = Vec::new();
    for (place, part) in PARTS.iter().enumerate().filter(|_| !trials.is_empty()) {
        for span in 0..SPANS.len() {
            let pairs: Vec<Paired> = trials.iter().filter_map(|trial| trial[place].0[span]).collect();
            rows.push(cost_row(scenario, part, span, &pairs));
        }
        let held: Vec<f64> = trials.iter().map(|trial| trial[place].1).collect();
        let claim = claim(scenario, part, "coverage", "share of errors within the range", Bound::Value(0.95));
        rows.push(judged(claim, mean(&held), &held));
    }
    Findings { rows, figures: Vec::new() }
}

fn cost_row(scenario: &Scenario, part: &Part, span: usize, pairs: &[Paired]) -> Row {
    const ALL: &[usize] = &[0, 1, 2];
    let (key, name) = SPAN_NAMES[span];
    let values: Vec<f64> = pairs.iter().map(|pair| 1.0 / of_one(pair, ALL)).collect();
    let claim = claim(scenario, part, key, &format!("RMSE over that of the whole, {name}"), Bound::Value(1.0));
    judged(claim, 1.0 / ratio(pairs, ALL), &values)
}

fn claim(scenario: &Scenario, part: &Part, key: &str, what: &str, bound: Bound) -> Claim {
    Claim {
        id: format!("deck/{}/without/{}/{key}", scenario.id, part.id),
        table: format!("{}: a part taken out", scenario.title),
        row: format!("{}, {what}", part.name),
        axis: "all".into(),
        unit: String::new(),
        bound,
        paper: Published::Nothing("a part is judged by what it is good for anywhere".into()),
        why: "Above 1 the part is worth having here.".into(),
    }
}
