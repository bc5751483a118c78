//! The presets of the papers' scenarios, and the keys that they need.
#![allow(clippy::unwrap_used)]

use crate::text::{message_with, read_with};
use frames::unit::{ARCMIN, ARCSEC, DEG_PER_H, DEGREE};
use frames::{Rot, Vec3};
use pipeline::configuration::Configuration;
use simulation::{Oscillation, RandomSwing, Response, Scenario, Simulator, Swing, Tones};
use std::path::{Path, PathBuf};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../config/papers")
}

fn names() -> Vec<String> {
    let files = std::fs::read_dir(folder()).unwrap().map(|entry| entry.unwrap().path());
    let mut names: Vec<String> = files.map(|path| path.file_stem().unwrap().to_str().unwrap().to_string()).collect();
    names.sort();
    names
}

fn scenario(name: &str) -> Scenario {
    let path = folder().join(format!("{name}.toml"));
    Configuration::read(&path).unwrap_or_else(|error| panic!("{error}")).scenario(1)
}

#[test]
fn every_preset_is_sound_and_runs() {
    let names = names();
    assert_eq!(
        names.iter().filter(|name| name.starts_with("model_free_1_") || name.starts_with("model_free_2_")).count(),
        12
    );
    for name in names {
        let mut simulator = Simulator::new(&scenario(&name));
        let mut largest = 0.0f64;
        for _ in 0..500 {
            let epoch = simulator.step().unwrap();
            let deformation = Vec3::<frames::Main>::from(epoch.truth[0].dynamic);
            largest = largest.max(deformation.norm());
            assert!(epoch.sub.iter().all(|s| s.dtheta.iter().chain(&s.dvel).all(|x| x.is_finite())), "{name}");
        }
        assert!(largest > 0.0 && largest < 2.0 * DEGREE || name == "idam_shipborne_static", "{name}: {largest}");
    }
}

#[test]
fn the_figures_are_those_of_the_papers() {
    let s = scenario("q_nnkf");
    let area = &s.areas[0];
    assert!((area.flexure[0].sigma - (4.5e-7f64).sqrt() * DEGREE).abs() < 1e-3 * area.flexure[0].sigma);
    assert!((area.flexure[0].b - 0.15f64.hypot(std::f64::consts::TAU * 0.2)).abs() < 1e-12);
    assert_eq!((area.quasi_static.period, area.unit.bias_wander.tau, s.main.bias_wander.tau), (7200.0, 600.0, 600.0));
    assert!((area.quasi_static.amplitude[2] - 0.1 * DEGREE).abs() < 1e-15);
    assert!((area.unit.bias_wander.sigma - 1e-3 * DEG_PER_H).abs() < 1e-20);
    for (k, delay) in [("1", 0.01), ("2", 0.02), ("3", 0.03)] {
        let (small, large) = (format!("model_free_2_{k}_small"), format!("model_free_2_{k}_large"));
        let (small, large) = (&scenario(&small).areas[0], &scenario(&large).areas[0]);
        assert_eq!((small.wire.delay_s, large.wire.delay_s, small.flexure_changes.len()), (delay, delay, 2));
        assert!((large.flexure_changes[1].flexure[1].sigma - 50.0 * ARCSEC).abs() < 1e-15);
        assert!((small.flexure_changes[1].flexure[1].sigma - 3.0 * ARCSEC).abs() < 1e-15);
    }
    let printed = scenario("tufts_kumaresan");
    let Swing::Random(roll) = printed.ship.roll else { panic!("{:?}", printed.ship) };
    assert_eq!((roll.mu, roll.band_limit_hz), (0.06, None));
    assert!((printed.areas[0].installation.log() - Vec3::new(3.5e-3, 3.5e-3, 3.5e-3)).norm() < 1e-10);
    let s = scenario("error_range_strong_turns");
    assert_eq!((s.areas[0].coupling.unwrap().share, s.ship.turns.unwrap().every_s), (0.5, 1800.0));
    let Response::Phase { wander, wander_tau } = s.areas[0].coupling.unwrap().response else { panic!("{:?}", s.areas) };
    assert!((wander - 0.35).abs() < 1e-15 && (wander_tau - 9000.0).abs() < 1e-9);
    assert!(
        scenario("error_range_weak").ship.turns.is_none() && scenario("error_range_weak").duration_s == Some(68_400.0)
    );
    assert_eq!(scenario("idam").areas, Scenario::default().areas);
}

/// The two units on one plate bend alike, and deviation 2 of 000 table 2 lies between them.
#[test]
fn the_reference_units_of_the_voyage_stand_beside_the_testing_units() {
    let s = scenario("idam_shipborne");
    let pair = s.areas[0].installation.inverse() * s.areas[2].installation;
    assert!((pair.log() - Vec3::new(-0.029, 0.525, -0.330) * DEGREE).norm() < 1e-6);
    let mut simulator = Simulator::new(&s);
    for _ in 0..1000 {
        let truth = &simulator.step().unwrap().truth;
        assert_eq!(truth[0].dynamic, truth[2].dynamic);
        assert_eq!(truth[1].dynamic, [0.0; 3]);
    }
    let still = scenario("idam_shipborne_static");
    assert_eq!(still.main, s.main);
    assert!(still.areas.iter().zip(&s.areas).all(|(a, b)| (a.unit, a.installation) == (b.unit, b.installation)));
}

fn told(lines: &str) -> Scenario {
    read_with(lines).unwrap().scenario(1)
}

#[test]
fn swings_are_read_in_three_forms() {
    let s = told(
        "[simulation]\nroll = { amplitude_deg = 4, period_s = 7, random_phase = true }\n\
         pitch = { amplitude_deg = 3, period_s = 8, tones = 24 }\n\
         heading = { sigma_deg = 1, frequency_hz = 0.05, mu_per_s = 0.12, band_limit_hz = 0.4 }",
    );
    let roll = Oscillation { amplitude: 4.0 * DEGREE, period: 7.0, phase: 0.0, random_phase: true };
    let pitch = Tones { rms: 3.0 * DEGREE / 2f64.sqrt(), period: 8.0, count: 24 };
    let b = 0.12f64.hypot(std::f64::consts::TAU * 0.05);
    let heading = RandomSwing { mu: 0.12, b, sigma: DEGREE, band_limit_hz: Some(0.4) };
    assert_eq!((s.ship.roll, s.ship.pitch), (Swing::Sine(roll), Swing::Tones(pitch)));
    assert_eq!(s.ship.heading, Swing::Random(heading));
}

#[test]
fn contradictions_are_told() {
    let swing = "needs either `amplitude_deg` and `period_s`";
    for (lines, place, part) in [
        ("[simulation]\nroll = { amplitude_deg = 4, sigma_deg = 1 }", "10: simulation.roll", swing),
        ("[simulation]\nroll = { tones = 24, phase_deg = 3 }", "10: simulation.roll", swing),
        ("[simulation]\nroll = { band_limit_hz = 0.4 }", "10: simulation.roll", swing),
        ("[simulation]\nroll = { tones = 0 }", "10: simulation.roll.tones = 0", "must be within 1 to 1000"),
        (
            "[simulation]\nturns = { rate_deg_per_s = 1, length_s = 180, every_s = 185 }",
            "10: simulation.turns",
            "`every_s` from `length_s` + `ramp_s` on",
        ),
        (
            "[area.simulation]\nflexure = { sigma_arcmin = [1, 1, 1], sigma_mrad = [1, 1, 1] }",
            "10: area[0].simulation.flexure",
            "only one of",
        ),
        (
            "[area.simulation]\nflexure = { at_s = 3, tau_s = [1, 1, 1] }",
            "10: area[0].simulation.flexure",
            "belongs to `flexure_changes`",
        ),
        (
            "[area.simulation]\nflexure_changes = [{ tau_s = [1, 1, 1] }]",
            "10: area[0].simulation.flexure_changes",
            "each change needs `at_s`",
        ),
        (
            "[area.simulation]\nflexure_changes = [{ at_s = 9, tau_s = [1, 1, 1] }, { at_s = 8, tau_s = [1, 1, 1] }]",
            "10: area[0].simulation.flexure_changes",
            "in the order of their times",
        ),
        (
            "[area.simulation]\ncoupling = { share = 0.3, delay_s = 1, wander_percent = 35 }",
            "10: area[0].simulation.coupling",
            "needs only one of `wander_percent`, `delay_s`, and `resonance_hz` with `damping_percent`",
        ),
        (
            "[area.simulation]\ncoupling = { share = 0.3, resonance_hz = 0.2 }",
            "10: area[0].simulation.coupling",
            "`resonance_hz` with `damping_percent`",
        ),
        (
            "[area.simulation]\ncoupling = { delay_s = -1 }",
            "10: area[0].simulation.coupling.delay_s = -1",
            "must be within 0 to 5",
        ),
        (
            "[area.simulation]\ncoupling = { resonance_hz = 0, damping_percent = 5 }",
            "10: area[0].simulation.coupling.resonance_hz = 0",
            "must be within 0.01 to 5",
        ),
        (
            "[area.simulation]\ncoupling = { resonance_hz = 0.2, damping_percent = 100 }",
            "10: area[0].simulation.coupling.damping_percent = 100",
            "must be within 0.1 to 90",
        ),
        ("[area.simulation]\nhull = 1", "10: area[0].simulation.hull = 1", "must be within 1000 to 9999"),
    ] {
        let message = message_with(lines);
        assert!(message.starts_with(&format!("ship.toml:{place}")) && message.contains(part), "{message}");
    }
}

#[test]
fn what_bends_and_errs_is_read_in_si() {
    let s = told(
        "[area.simulation]\nstarts_at_rest = true\noutliers = { probability = 0.01, size_sigmas = 50 }\n\
         impulses = { factor = 50, probability = 5e-4, cell_ms = 10 }\n\
         coupling = { in_phase_rotation_arcsec = [30, -20, 50] }",
    );
    let area = &s.areas[0];
    assert!(area.starts_at_rest && !area.unit.outliers.one_sided && area.unit.outliers.size == 50.0);
    assert_eq!(area.impulses.unwrap().cell_s, 0.01);
    let coupling = area.coupling.unwrap();
    assert!((coupling.in_phase_rotation - Vec3::new(30.0, -20.0, 50.0) * ARCSEC).norm() < 1e-18);
    assert_eq!((coupling.share, coupling.response), (0.0, Response::Phase { wander: 0.0, wander_tau: 9000.0 }));
    assert_eq!(area.installation, Rot::exp(Vec3::new(10.0 * ARCMIN, 10.0 * ARCMIN, 30.0 * ARCMIN)));
}

#[test]
fn a_coupling_is_read_in_three_forms() {
    let response = |keys: &str| {
        let coupling =
            told(&format!("[area.simulation]\ncoupling = {{ share = 0.3, {keys} }}")).areas[0].coupling.unwrap();
        assert_eq!(coupling.share, 0.3);
        coupling.response
    };
    let hour = Response::Phase { wander: 0.2, wander_tau: 3600.0 };
    assert_eq!(response("wander_percent = 20, wander_tau_h = 1"), hour);
    assert_eq!(response("delay_s = 1.5"), Response::Delayed { delay_s: 1.5 });
    let Response::Resonant { mu, b } = response("resonance_hz = 0.2, damping_percent = 5") else { panic!() };
    assert!((b - std::f64::consts::TAU * 0.2).abs() < 1e-15 && (mu - 0.05 * b).abs() < 1e-15);
}
