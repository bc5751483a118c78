//! The methods that are compared.

use crate::{Data, Fault, Track, presets, run, run_told};
use frames::unit::nanoseconds;
use messages::{FlexureParams, Header};
use pipeline::configuration::{Configuration, DelaySettings, EstimatorSettings, IdentifierMethod, IdentifierSettings};

/// Distance of the points of a track: every pair.
const EVERY_S: f64 = 0.0;

/// The estimator on a scenario, from nothing: what a configuration gets that says nothing of it.
pub(super) fn default(scenario: &Configuration) -> Configuration {
    scenario.with(|c| {
        let area = &mut c.areas[0];
        (area.estimator, area.identifier) = (EstimatorSettings::default(), IdentifierSettings::default());
    })
}

/// The same, told the flexure from the start on.
pub(super) fn told(method: &Configuration) -> Configuration {
    method.with(|c| {
        let area = &mut c.areas[0];
        area.identifier.method = IdentifierMethod::Fixed(area.simulation.hull());
    })
}

/// Runs a method that is told the flexure from the start on, and tells it how the flexure changes, so much `later` than it does, s.
pub(super) fn run_true(method: &Configuration, data: &Data, later: f64) -> Track {
    let begin_ns = data.pairs.first().map_or(0, |pair| pair.header.time_ns);
    let set = |(change, id): (&simulation::FlexureChange, u64)| FlexureParams {
        header: Header::default(),
        id,
        effective_from_ns: begin_ns + nanoseconds(change.at_s + later),
        mu: change.flexure.map(|axis| axis.mu),
        b: change.flexure.map(|axis| axis.b),
        sigma: change.flexure.map(|axis| axis.sigma),
        ..FlexureParams::default()
    };
    let sets: Vec<FlexureParams> = method.areas[0].simulation.flexure_changes.iter().zip(1..).map(set).collect();
    run_told(method, data, EVERY_S, &sets)
}

/// Runs a method that is told nothing.
pub(super) fn run_blind(method: &Configuration, data: &Data) -> Track {
    run(method, data, EVERY_S)
}

/// A paper's method, or one of ours beside it, that is not told the true flexure.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rival {
    /// In the identities of rows.
    pub id: &'static str,
    /// In tables.
    pub name: &'static str,
    /// Whose estimator, identifier and installation it has.
    preset: &'static str,
    /// Whose identifier it has instead, where the preset's is told the true flexure.
    identifier: Option<&'static str>,
    /// What it takes for known that the estimator does not.
    takes_for_known: Option<Knowledge>,
}

/// Something that no data of a voyage tell, and that a method may be told.
#[derive(Clone, Copy, Debug)]
pub(super) struct Knowledge {
    /// In tables: "told that ...".
    pub what: &'static str,
    /// Tells it.
    pub tell: fn(&mut Configuration),
}

/// A late stamp looks like a static part where the ship swings about one axis, and most of the doubt about x and y is of that kind.
const PUNCTUAL: Knowledge = Knowledge { what: "no stamp is late", tell: punctual };

/// A static part that moves by a few arcseconds an hour is to the gyros a bias, and a bias such a motion.
const STILL: Knowledge = Knowledge {
    what: "no stamp is late and the static part never moves",
    tell: |c| {
        punctual(c);
        c.areas[0].estimator.static_rate_noise = 0.0;
    },
};

fn punctual(c: &mut Configuration) {
    c.areas[0].estimator.delay = Some(DelaySettings { sigma: 0.0, ..DelaySettings::default() });
}

impl Rival {
    const fn new(id: &'static str, name: &'static str, preset: &'static str) -> Self {
        Self { id, name, preset, identifier: None, takes_for_known: None }
    }

    const fn identified(self, by: &'static str) -> Self {
        Self { identifier: Some(by), ..self }
    }

    const fn taking_for_known(self, what: Knowledge) -> Self {
        Self { takes_for_known: Some(what), ..self }
    }

    /// What it takes for known that the estimator does not.
    pub(super) fn knowledge(&self) -> Option<Knowledge> {
        self.takes_for_known
    }

    /// The scenario with this method.
    pub(super) fn on(&self, scenario: &Configuration) -> Result<Configuration, Fault> {
        let preset = presets::configuration(self.preset, scenario.run.seed)?;
        let identifier = presets::configuration(self.identifier.unwrap_or(self.preset), scenario.run.seed)?;
        Ok(scenario.with(|c| {
            let (area, told) = (&mut c.areas[0], &preset.areas[0]);
            area.estimator = told.estimator;
            // what is known of the gyros is the same for all
            area.estimator.bias_doubt = EstimatorSettings::default().bias_doubt;
            area.installation = told.installation;
            area.identifier = identifier.areas[0].identifier;
        }))
    }
}

/// Rivals on paper 000.
pub(super) const IDAM: &[Rival] = &[
    Rival::new("ekf-rvm", "EKF, RVM", "idam_ekf").taking_for_known(PUNCTUAL),
    Rival::new("ekf-whittle", "EKF, Whittle", "idam_whittle").taking_for_known(PUNCTUAL),
    Rival::new("idam-bayes", "IDAM, Bayes weighting, RVM", "idam_bayes"),
    Rival::new("so3-whittle", "SO(3), Whittle", "idam_so3_whittle"),
];

/// Rivals on paper 001, whose own filters are all told the true flexure.
pub(super) const Q_NNKF: &[Rival] =
    &[Rival::new("q-kf-whittle", "Q-KF, Whittle", "q_nnkf_q_kf").identified("idam_whittle")];

/// Rivals on paper 002 with a small flexure.
pub(super) const MODEL_FREE: &[Rival] =
    &[Rival::new("gauss-markov", "Gauss-Markov with delay, broad flexure", "model_free_delay")];

/// Rivals on paper 002 with a small flexure and a skew.
pub(super) const MODEL_FREE_SKEW: &[Rival] =
    &[Rival::new("gauss-markov-skew", "Gauss-Markov with delay and skew, broad flexure", "model_free_delay_skew")];

/// Rivals on paper 003.
pub(super) const TUFTS_KUMARESAN: &[Rival] = &[
    Rival::new("dcm-tufts-kumaresan", "attitude by cosines, Tufts-Kumaresan", "tufts_kumaresan"),
    Rival::new("dcm-whittle", "attitude by cosines, Whittle", "tufts_kumaresan_whittle"),
];

/// Rivals on paper 004, whose own filter is told the true flexure.
pub(super) const ERROR_RANGE: &[Rival] =
    &[Rival::new("rate-whittle", "rate matching, Whittle", "error_range_weak_naive")
        .identified("idam_whittle")
        .taking_for_known(STILL)];
