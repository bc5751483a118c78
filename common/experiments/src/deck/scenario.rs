//! The scenarios: those of the papers' presets, and changes of them.

use super::method::{ERROR_RANGE, IDAM, Knowledge, MODEL_FREE, MODEL_FREE_SKEW, Q_NNKF, Rival, TUFTS_KUMARESAN};
use crate::{Fault, Trial, Trials, presets};
use frames::unit::{ARCMIN, ARCSEC, DEGREE};
use frames::{Main, Vec3};
use pipeline::configuration::{Configuration, Wire};

/// A unit of measure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Unit {
    pub name: &'static str,
    /// rad.
    pub size: f64,
}

const ARCMINUTE: Unit = Unit { name: "arcmin", size: ARCMIN };
const ARCSECOND: Unit = Unit { name: "arcsec", size: ARCSEC };

/// A scenario.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scenario {
    pub id: &'static str,
    pub title: &'static str,
    preset: &'static str,
    change: fn(&mut Configuration),
    /// Length if not that of the preset, s.
    duration_s: f64,
    /// Length in a quick run, s, if it takes part in one.
    quick_s: Option<f64>,
    pub trials: Trials,
    pub unit: Unit,
    /// What the ratio may be after five minutes, pooled and on any axis.
    pub limits: (f64, f64),
    /// What the RMSE may be about each axis, in the unit.
    pub sane: Option<[f64; 3]>,
    pub rivals: &'static [Rival],
}

/// Every scenario has the spike test, whether it has spikes or not.
pub(super) const SPIKE_THRESHOLD: f64 = 5.0;

/// Of the ratio.
const USUAL: (f64, f64) = (1.05, 1.15);
/// The same where the data are not what the model says.
const WIDE: (f64, f64) = (1.2, 1.2);

const IDAM_SANE: Option<[f64; 3]> = Some([0.25, 0.25, 0.6]);
const Q_NNKF_SANE: Option<[f64; 3]> = Some([2.8, 4.4, 4.0]);
const Q_NNKF_ACCEL_SANE: Option<[f64; 3]> = Some([1.3, 2.3, 4.0]);

impl Scenario {
    const fn new(
        id: &'static str,
        title: &'static str,
        preset: &'static str,
        (duration_s, full): (f64, usize),
        unit: Unit,
    ) -> Self {
        Self {
            id,
            title,
            preset,
            change: |_| {},
            duration_s,
            quick_s: None,
            trials: Trials { full, quick: 2 },
            unit,
            limits: USUAL,
            sane: None,
            rivals: &[],
        }
    }

    /// Ten minutes of paper 000.
    const fn idam(id: &'static str, title: &'static str) -> Self {
        Self::new(id, title, "idam", (600.0, 30), ARCMINUTE)
    }

    /// An hour of paper 001.
    const fn q_nnkf(id: &'static str, title: &'static str) -> Self {
        Self { sane: Q_NNKF_SANE, ..Self::new(id, title, "q_nnkf", (3600.0, 20), ARCSECOND) }
    }

    /// A quarter of an hour of paper 002 with a sub unit that is late.
    const fn late(id: &'static str, title: &'static str) -> Self {
        Self::new(id, title, "model_free_2_1_small", (900.0, 30), ARCSECOND)
    }

    const fn preset(self, preset: &'static str) -> Self {
        Self { preset, ..self }
    }

    const fn change(self, change: fn(&mut Configuration)) -> Self {
        Self { change, ..self }
    }

    const fn quick(self, seconds: f64) -> Self {
        Self { quick_s: Some(seconds), ..self }
    }

    const fn wide(self) -> Self {
        Self { limits: WIDE, ..self }
    }

    const fn sane(self, sane: Option<[f64; 3]>) -> Self {
        Self { sane, ..self }
    }

    const fn rivals(self, rivals: &'static [Rival]) -> Self {
        Self { rivals, ..self }
    }

    /// The scenario of a trial, without what is known of the installation; `None` if a quick run leaves it out.
    pub(super) fn configuration(&self, trial: &Trial) -> Result<Option<Configuration>, Fault> {
        let duration_s = if trial.quick { self.quick_s } else { Some(self.duration_s) };
        let Some(duration_s) = duration_s else { return Ok(None) };
        Ok(Some(presets::configuration(self.preset, trial.seed)?.with(|c| {
            c.run.duration_s = Some(duration_s);
            c.areas[0].installation = None;
            c.spike_threshold = SPIKE_THRESHOLD;
            (self.change)(c);
        })))
    }

    /// What the rivals take for known, each thing once.
    pub(super) fn knowledge(&self) -> Vec<Knowledge> {
        let mut all: Vec<Knowledge> = self.rivals.iter().filter_map(Rival::knowledge).collect();
        all.sort_by_key(|knowledge| knowledge.what);
        all.dedup_by_key(|knowledge| knowledge.what);
        all
    }

    /// About the seconds of data times methods.
    pub(super) fn cost(&self) -> u64 {
        self.duration_s as u64 * (2 + self.rivals.len() + self.knowledge().len()) as u64
    }
}

/// All of them, in the order of the papers.
pub(super) const SCENARIOS: [Scenario; 21] = [
    // thirty leave the comparison with the 24-state filter undecided
    Scenario { trials: Trials { full: 60, quick: 2 }, ..Scenario::idam("000", "000, Gaussian") }
        .sane(IDAM_SANE)
        .quick(420.0)
        .rivals(IDAM),
    Scenario::idam("000-gyros", "000, gyros only").change(without_accelerometers),
    Scenario::idam("000-large", "000, installed at 20, 10, 40 degrees").sane(IDAM_SANE).change(|c| {
        c.areas[0].simulation.installation = Vec3::from([20.0, 10.0, 40.0]) * DEGREE;
    }),
    Scenario::idam("000-impulsive", "000, impulsive waves").preset("idam_impulsive").wide().rivals(IDAM),
    Scenario::idam("000-low-grade", "000, sub unit of 0.1 deg/sqrt(h)").change(|c| {
        c.areas[0].gyro.arw = 0.1 * DEGREE / HOUR_S.sqrt();
    }),
    Scenario::q_nnkf("001", "001, 3 degrees").change(|c| turned(c, 3.0)).rivals(Q_NNKF),
    Scenario::q_nnkf("001-0", "001, 0 degrees").change(|c| turned(c, 0.0)),
    Scenario::q_nnkf("001-30", "001, 30 degrees").change(|c| turned(c, 30.0)).quick(420.0).rivals(Q_NNKF),
    Scenario::q_nnkf("001-120", "001, 120 degrees").change(|c| turned(c, 120.0)),
    Scenario::q_nnkf("001-179", "001, 179 degrees").change(|c| turned(c, 179.0)),
    Scenario::q_nnkf("001-accel", "001, 3 degrees, accelerometers").sane(Q_NNKF_ACCEL_SANE).change(|c| {
        turned(c, 3.0);
        c.main.accel = c.simulation.accel;
        c.areas[0].accel = c.areas[0].simulation.accel;
    }),
    Scenario::new("002", "002, small flexure", "model_free_1_1_small", HOUR, ARCSECOND).rivals(MODEL_FREE),
    Scenario::new("002-changes", "002, small flexure that changes", "model_free_1_3_small", HOUR, ARCSECOND)
        .rivals(MODEL_FREE),
    Scenario::late("002-late", "002, small flexure, 12.3 ms late").change(|c| late(c, 12.3e-3, 0.0)).rivals(MODEL_FREE),
    Scenario::late("002-later", "002, small flexure, 200 ms late")
        .change(|c| late(c, 0.2, 0.0))
        .quick(420.0)
        .rivals(MODEL_FREE),
    Scenario::late("002-skew", "002, small flexure, 200 ms late, 50 ppm fast")
        .wide()
        .change(|c| late(c, 0.2, 50e-6))
        .rivals(MODEL_FREE_SKEW),
    Scenario::new("002-large", "002, large flexure", "model_free_1_1_large", HOUR, ARCSECOND),
    Scenario::new("002-large-changes", "002, large flexure that changes", "model_free_1_3_large", HOUR, ARCSECOND),
    Scenario::new("003", "003", "tufts_kumaresan", (600.0, 30), ARCSECOND).quick(420.0).rivals(TUFTS_KUMARESAN),
    Scenario::new("003-band", "003, no motion above 0.4 Hz", "tufts_kumaresan_band_limited", (600.0, 30), ARCSECOND)
        .rivals(TUFTS_KUMARESAN),
    Scenario::new("004", "004, not coupled", "error_range_weak", (2400.0, 30), ARCSECOND)
        .change(|c| c.areas[0].simulation.coupling = None)
        .quick(420.0)
        .rivals(ERROR_RANGE),
];

const HOUR_S: f64 = 3600.0;
/// An hour, and how many trials of it.
const HOUR: (f64, usize) = (HOUR_S, 20);

fn without_accelerometers(c: &mut Configuration) {
    (c.main.accel, c.areas[0].accel) = (None, None);
}

/// Installed at an angle about the direction of paper 001's installation.
fn turned(c: &mut Configuration, degrees: f64) {
    let installation = &mut c.areas[0].simulation.installation;
    let direction: Vec3<Main> = *installation * (1.0 / installation.norm());
    *installation = direction * (degrees * DEGREE);
}

/// A sub unit that is late by a time and whose clock is fast. The flexure stays the same: the filter that is told the truth runs its first
/// minutes over again with the model in force, which would be another one from 300 s on.
fn late(c: &mut Configuration, delay: f64, skew: f64) {
    c.areas[0].simulation.wire = Wire { delay, skew, ..c.areas[0].simulation.wire };
    c.areas[0].simulation.flexure_changes.clear();
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::super::method;
    use super::*;
    use pipeline::configuration::{IdentifierMethod, MatchingMethod};
    use std::collections::BTreeSet;

    /// A preset that does not exist, or a method that is told what it should find out, would fail after hours.
    #[test]
    fn every_scenario_has_its_methods_and_only_one_is_told_the_truth() {
        let trial = Trial { index: 0, seed: 1, quick: false };
        for scenario in &SCENARIOS {
            let configuration = scenario.configuration(&trial).unwrap().unwrap();
            let ours = method::default(&configuration);
            let area = &ours.areas[0];
            assert_eq!(area.estimator.matching, MatchingMethod::Deck);
            assert!(area.installation.is_none() && matches!(area.identifier.method, IdentifierMethod::Learnt(_)));
            let truth = &method::told(&ours).areas[0];
            let IdentifierMethod::Fixed(hull) = truth.identifier.method else { panic!("{}", scenario.id) };
            for (told, real) in hull.modes.iter().zip(area.simulation.flexure) {
                assert_eq!((told.mu, told.b, told.sigma), (real.mu, real.b, real.sigma));
            }
            for rival in scenario.rivals {
                if let IdentifierMethod::Fixed(told) = rival.on(&configuration).unwrap().areas[0].identifier.method {
                    assert_ne!(told.modes[0].sigma, hull.modes[0].sigma, "{} is told the truth", rival.id);
                }
            }
        }
        let ids: BTreeSet<&str> = SCENARIOS.iter().map(|scenario| scenario.id).collect();
        assert_eq!(ids.len(), SCENARIOS.len());
    }

    #[test]
    fn the_installation_of_paper_001_is_turned_by_the_angle() {
        let trial = Trial { index: 0, seed: 1, quick: false };
        for (id, degrees) in [("001", 3.0), ("001-0", 0.0), ("001-179", 179.0)] {
            let scenario = SCENARIOS.iter().find(|scenario| scenario.id == id).unwrap();
            let configuration = scenario.configuration(&trial).unwrap().unwrap();
            let angle = configuration.areas[0].simulation.installation.norm() / DEGREE;
            assert!((angle - degrees).abs() < 1e-9, "{id}: {angle}");
        }
    }
}
