//! Section 5: the error of the deformation from 120 s to 600 s, in Gaussian noise as the paper has it, and in what it claims to stand.

use super::methods::{Method, method};
use super::{AXES, figures};
use crate::{Bound, Claim, Data, Fault, Findings, Published, Row, Study, Track, Trial, Trials, presets, rms, run};
use frames::unit::ARCMIN;
use pipeline::configuration::Configuration;
use std::ops::RangeInclusive;

pub(super) const DURATION_S: u64 = 600;
/// Errors count from here to the end.
pub(super) const SPAN: RangeInclusive<f64> = 120.0..=600.0;
/// Distance of the points of a track, s.
const EVERY_S: f64 = 0.1;

/// A scenario with the methods that run on it.
pub(super) struct Scenario {
    pub id: &'static str,
    pub title: &'static str,
    preset: &'static str,
    change: fn(&mut Configuration),
    methods: &'static [&'static str],
    trials: Trials,
}

/// The scenarios of section 5; the first is the paper's own, the others have no figures in the paper.
pub(super) const SCENARIOS: [Scenario; 5] = [
    Scenario {
        id: "gaussian",
        title: "Section 5, Gaussian noise: RMSE from 120 s to 600 s",
        preset: "idam",
        change: |_| {},
        methods: &[
            "ekf-true",
            "ekf-rvm",
            "ekf-svr",
            "ekf-woa",
            "ekf-whittle",
            "ekf-rvm-raw",
            "ekf-svr-raw",
            "ekf-woa-raw",
            "ekf-whittle-raw",
            "mpf",
            "mcc-noise",
            "mcc-innovation",
            "idam-literal",
            "idam-weighted",
            "idam-bayes",
            "printed",
            "so3-true",
            "so3-rvm",
            "so3-whittle",
        ],
        trials: Trials { full: 20, quick: 2 },
    },
    Scenario {
        id: "rest",
        title: "Section 5, flexure that starts from zero: RMSE from 120 s to 600 s",
        preset: "idam",
        change: |c| c.areas[0].simulation.starts_at_rest = true,
        methods: &["ekf-true", "ekf-rvm", "ekf-svr", "ekf-woa", "idam-literal", "printed"],
        trials: Trials { full: 20, quick: 1 },
    },
    Scenario::robust("impulsive", "Section 5, impulsive waves: RMSE from 120 s to 600 s", "idam_impulsive", |_| {}),
    Scenario::robust(
        "outliers",
        "Section 5, outliers of 50 sigma in 1 % of the samples: RMSE from 120 s to 600 s",
        "idam_outliers",
        |_| {},
    ),
    Scenario::robust(
        "heavy",
        "Section 5, outliers of 1000 sigma in 0.2 % of the samples: RMSE from 120 s to 600 s",
        "idam_outliers",
        |c| {
            let outliers = &mut c.areas[0].simulation.outliers;
            (outliers.probability, outliers.size) = (0.002, 1000.0);
        },
    ),
];

/// What is compared where noise is not Gaussian.
const ROBUST: &[&str] =
    &["ekf-true", "ekf-rvm", "mcc-noise", "mcc-innovation", "idam-literal", "idam-bayes", "so3-true", "so3-rvm"];

/// The tracks of one trial; only the first trial keeps them.
pub(super) struct Measured {
    /// RMSE per method and axis, arcmin.
    pub rmse: Vec<[f64; 3]>,
    /// Share of errors in the 95 % range about z, per method.
    pub coverage: Vec<f64>,
    pub tracks: Vec<Track>,
}

/// The study of a scenario.
pub(super) fn study(scenario: &'static Scenario) -> Study {
    let cost = DURATION_S * scenario.methods.len() as u64;
    Study::new(scenario.trials, cost, |trial| measure(scenario, trial), |trials| conclude(scenario, trials))
}

fn measure(scenario: &Scenario, trial: &Trial) -> Result<Measured, Fault> {
    let told = presets::configuration(scenario.preset, trial.seed)?.with(|c| {
        c.run.duration_s = Some(DURATION_S as f64);
        (scenario.change)(c);
    });
    let data = Data::simulate(&told)?;
    let mut measured = Measured { rmse: Vec::new(), coverage: Vec::new(), tracks: Vec::new() };
    for id in scenario.methods {
        let track = run(&method(id).on(&told)?, &data, EVERY_S);
        let span = track.over(SPAN);
        measured.rmse.push(span.rmse().map(|error| error / ARCMIN));
        measured.coverage.push(span.coverage(|point| point.range)[2]);
        if trial.index == 0 {
            measured.tracks.push(track);
        }
    }
    Ok(measured)
}

impl Scenario {
    /// One whose noise is not Gaussian.
    const fn robust(
        id: &'static str,
        title: &'static str,
        preset: &'static str,
        change: fn(&mut Configuration),
    ) -> Self {
        Self { id, title, preset, change, methods: ROBUST, trials: Trials { full: 20, quick: 1 } }
    }

    pub(super) fn methods(&self) -> impl Iterator<Item = &'static Method> {
        self.methods.iter().map(|id| method(id))
    }

    /// A method's RMSE about an axis, by trial.
    pub(super) fn rmse(&self, trials: &[Measured], id: &str, axis: usize) -> Vec<f64> {
        match self.methods.iter().position(|other| *other == id) {
            Some(place) => trials.iter().map(|trial| trial.rmse[place][axis]).collect(),
            None => Vec::new(),
        }
    }

    /// Root mean square over all trials.
    pub(super) fn total(&self, trials: &[Measured], id: &str, axis: usize) -> f64 {
        rms(&self.rmse(trials, id, axis))
    }

    fn claim(&self, id: &str, row: &str, axis: &str) -> Claim {
        Claim {
            id: format!("idam/{}/{id}/{axis}", self.id),
            table: self.title.into(),
            row: row.into(),
            axis: axis.into(),
            unit: "arcmin".into(),
            bound: Bound::None("this is the bound of others".into()),
            paper: Published::Nothing("the paper gives figures for one scenario, without its impulses".into()),
            why: String::new(),
        }
    }

    fn rows(&self, trials: &[Measured]) -> Vec<Row> {
        let mut rows = Vec::new();
        for told in self.methods() {
            for (axis, name) in AXES.into_iter().enumerate() {
                let mut claim = self.claim(told.id, told.name, name);
                if told.bound != told.id {
                    claim.bound = Bound::Value(self.total(trials, told.bound, axis));
                }
                if self.id == "gaussian" {
                    claim.paper = told.published(name);
                }
                claim.why = told.why.into();
                rows.push(claim.rms(&self.rmse(trials, told.id, axis)));
            }
        }
        rows
    }
}

fn conclude(scenario: &Scenario, trials: &[Measured]) -> Findings {
    let mut rows = scenario.rows(trials);
    let mut figures = Vec::new();
    if scenario.id == "gaussian" {
        rows.extend(ratios(scenario, trials));
        rows.extend(coverage(scenario, trials));
        figures.extend(figures::of_one_trial(scenario, &trials[0]));
    }
    figures.push(figures::bars(scenario, trials));
    Findings { rows, figures }
}

/// RMSE about z over that of another method on the same data.
fn ratios(scenario: &Scenario, trials: &[Measured]) -> Vec<Row> {
    let own = "the paper has no filter with the true parameters";
    let order = "Rivals are told apart by the flexure that they identify, and the chain hardly depends on it.";
    let near = "The static part is found from the ship's rotation; a safe flexure model costs up to a tenth with gyros alone, a quarter with a lever arm that bends.";
    [
        ("so3-rvm", "so3-true", Published::Nothing(own.into()), near),
        ("so3-whittle", "so3-true", Published::Nothing(own.into()), near),
        ("ekf-rvm", "ekf-true", Published::Nothing(own.into()), near),
        ("ekf-whittle", "ekf-true", Published::Nothing(own.into()), near),
        ("ekf-svr", "ekf-rvm", Published::Magnitude(6.56 / 4.26, 1), order),
        ("ekf-woa", "ekf-rvm", Published::Magnitude(5.032 / 4.26, 1), order),
    ]
    .into_iter()
    .map(|(one, other, paper, why)| {
        Claim {
            id: format!("idam/{}/ratio/{one}/{other}", scenario.id),
            table: "Section 5, Gaussian noise: RMSE about z over that of another method, same data".into(),
            row: format!("{} over {}", method(one).name, method(other).name),
            axis: "z".into(),
            unit: String::new(),
            bound: Bound::Value(1.0),
            paper,
            why: why.into(),
        }
        .mean(&[scenario.total(trials, one, 2) / scenario.total(trials, other, 2)])
    })
    .collect()
}

/// Share of errors about z in the 95 % range.
fn coverage(scenario: &Scenario, trials: &[Measured]) -> Vec<Row> {
    let row = |(place, told): (usize, &'static Method)| {
        let values: Vec<f64> = trials.iter().map(|trial| trial.coverage[place]).collect();
        let claim = Claim {
            id: format!("idam/{}/coverage/{}", scenario.id, told.id),
            table: "Section 5, Gaussian noise: share of errors about z in the 95 % range".into(),
            row: told.name.into(),
            axis: "z".into(),
            unit: String::new(),
            bound: Bound::Value(0.95),
            paper: Published::Nothing("the paper gives no covariance".into()),
            why: "The error of a run is nearly constant: single runs are inside or outside as a whole.".into(),
        };
        claim.mean(&values)
    };
    scenario.methods().enumerate().map(row).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An identity that no method has would panic, a bound that does not run would be NaN.
    #[test]
    fn every_scenario_comes_to_its_conclusion() {
        for scenario in &SCENARIOS {
            let count = scenario.methods.len();
            let measured =
                Measured { rmse: vec![[1.0, 2.0, 3.0]; count], coverage: vec![0.9; count], tracks: Vec::new() };
            let rows = conclude(scenario, &[measured]).rows;
            assert!(rows.len() >= 3 * count, "{}", scenario.id);
            for row in rows {
                let bounded = !matches!(row.claim.bound, Bound::Value(value) if !value.is_finite());
                assert!(row.ours.is_finite() && bounded && !row.claim.why.is_empty(), "{row:?}");
            }
        }
    }
}
