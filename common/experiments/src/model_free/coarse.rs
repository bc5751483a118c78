//! Beyond the paper: how well a stretch of data shows the delay before any filter runs.

use super::{Size, claim};
use crate::{Bound, Fault, Findings, Published, Study, Trial, Trials, pairs, presets};
use estimation::align::{DelayRegistrar, Register};
use estimation::flexure::Flexure;
use frames::Vec3;
use frames::unit::{ARCSEC, DEGREE};
use pipeline::configuration::Configuration;
use simulation::{Oscillation, Swing, Tones};
use std::f64::consts::TAU;

/// Lengths of data, s.
const WINDOWS_S: [f64; 6] = [5.0, 10.0, 20.0, 60.0, 120.0, 300.0];
/// The delays, by trial, ms.
const DELAYS_MS: [f64; 3] = [12.3, -57.7, 187.4];
/// The constant static part, arcsec.
const STATIC_ARCSEC: [f64; 3] = [150.0, -200.0, 250.0];
/// Sinusoids of a random sea, an axis.
const TONES: usize = 24;
/// The sea of the scenarios: amplitude, deg, and period, s, about x, y, z.
const SWING: [(f64, f64); 3] = [(3.0, 8.0), (4.0, 7.0), (2.0, 6.0)];

#[derive(Clone, Copy)]
struct Case {
    id: &'static str,
    name: &'static str,
    size: Option<Size>,
    random: bool,
}

const CASES: [Case; 5] = [
    Case { id: "rigid", name: "no flexure", size: None, random: false },
    Case { id: "small-sine", name: "small flexure, sinusoidal sea", size: Some(Size::Small), random: false },
    Case { id: "small-random", name: "small flexure, random sea", size: Some(Size::Small), random: true },
    Case { id: "large-sine", name: "large flexure, sinusoidal sea", size: Some(Size::Large), random: false },
    Case { id: "large-random", name: "large flexure, random sea", size: Some(Size::Large), random: true },
];

/// By window: errors by correlation and by least squares, us.
type Errors = [(f64, f64); WINDOWS_S.len()];
type Which = fn(&(f64, f64)) -> f64;

pub(super) fn studies() -> Vec<Study> {
    let study = |case: Case| {
        Study::new(
            Trials { full: 24, quick: 6 },
            600,
            move |trial| measure(case, trial),
            move |trials: &[Errors]| conclude(case, trials),
        )
    };
    CASES.map(study).into()
}

fn scenario(case: Case, delay_s: f64, trial: &Trial) -> Result<Configuration, Fault> {
    let preset = case.size.unwrap_or(Size::Small).preset("2.1");
    Ok(presets::configuration(&preset, trial.seed)?.with(|c| {
        c.run.duration_s = Some(WINDOWS_S[WINDOWS_S.len() - 1] + 1.0);
        if case.random {
            let ship = &mut c.simulation;
            for swing in [&mut ship.roll, &mut ship.pitch, &mut ship.heading] {
                if let Swing::Sine(Oscillation { amplitude, period, .. }) = *swing {
                    *swing = Swing::Tones(Tones { rms: amplitude / 2f64.sqrt(), period, count: TONES });
                }
            }
        }
        let area = &mut c.areas[0].simulation;
        area.wire.delay = delay_s;
        area.flexure_changes.clear();
        (area.quasi_static, area.installation) = (Default::default(), Vec3::from(STATIC_ARCSEC) * ARCSEC);
        if case.size.is_none() {
            area.flexure.iter_mut().for_each(|axis| axis.sigma = 0.0);
        }
    }))
}

fn measure(case: Case, trial: &Trial) -> Result<Errors, Fault> {
    let delay_s = DELAYS_MS[trial.index % DELAYS_MS.len()] * 1e-3;
    let mut registrar = DelayRegistrar::new();
    let mut errors = [(f64::NAN, f64::NAN); WINDOWS_S.len()];
    let mut begin_ns = None;
    let error = |found: Option<f64>| found.map_or(f64::NAN, |found| (found - delay_s) * 1e6);
    pairs(&scenario(case, delay_s, trial)?, |pair, _| {
        registrar.add(pair);
        let time_s = frames::unit::seconds(pair.header.time_ns - *begin_ns.get_or_insert(pair.header.time_ns));
        if let Some(window) = WINDOWS_S.iter().position(|window| (time_s - window).abs() < 1e-6) {
            let squares = registrar.lag().map(|lag| lag.delay);
            errors[window] = (error(registrar.correlate()), error(squares));
        }
    })?;
    Ok(errors)
}

/// The least standard deviation that a flexure of known spectrum allows with a sinusoidal sea, us.
fn bound(case: Case, scenario: &Configuration, window_s: f64) -> Bound {
    if case.size.is_none() {
        return Bound::None("limited by the gyros' noise and the four-point interpolation".into());
    }
    if case.random {
        return Bound::None("the spectrum of a random sea differs from trial to trial".into());
    }
    let information = |axis: usize| {
        let (amplitude_deg, period_s) = SWING[axis];
        let w = TAU / period_s;
        let model = scenario.areas[0].simulation.flexure[axis];
        let spectrum = Flexure { mu: model.mu, b: model.b, sigma: model.sigma }.spectrum(w);
        window_s * (amplitude_deg * DEGREE * w).powi(2) / (2.0 * spectrum)
    };
    Bound::Value(1e6 / [0, 1, 2].map(information).iter().sum::<f64>().sqrt())
}

fn conclude(case: Case, trials: &[Errors]) -> Findings {
    let preset = presets::configuration(&case.size.unwrap_or(Size::Small).preset("2.1"), 0);
    let mut findings = Findings::default();
    for (window, length_s) in WINDOWS_S.into_iter().enumerate() {
        let methods: [(&str, &str, Which); 2] =
            [("correlation", "correlation", |e| e.0), ("least-squares", "least squares", |e| e.1)];
        for (id, name, of) in methods {
            let values: Vec<f64> = trials.iter().map(|trial| of(&trial[window])).collect();
            let bound = match &preset {
                Ok(preset) => bound(case, preset, length_s),
                Err(fault) => Bound::None(fault.to_string()),
            };
            let claim = claim(
                format!("model-free/coarse/{}/{id}/{length_s}s", case.id),
                "Beyond the paper: the coarse delay",
                format!("{}, {length_s} s, {name}", case.name),
                ["delay", "us"],
                bound,
                Published::Nothing("the paper starts its filter at once".into()),
                "The flexure's rate is the limit, not the gyros; the bound takes its spectrum as known.",
            );
            findings.rows.push(claim.rms(&values));
        }
    }
    findings
}
