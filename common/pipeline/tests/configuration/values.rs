//! What is read, in which units.

use crate::text::{FULL, Folder, MINIMAL, close, good};
use estimation::flexure::Flexure;
use estimation::identify::Method;
use frames::unit::{ARCMIN, ARCSEC, DEG_PER_H, DEG_PER_SQRT_H, DEGREE, KNOT, MICRO_G, PPM, STANDARD_GRAVITY};
use frames::{Case, Main, Rot, Sub, Vec3};
use pipeline::configuration::{Configuration, EstimatorSettings, IdentifierMethod, SchedulingChoice};
use std::path::Path;

#[test]
fn everything_but_the_required_keys_has_a_default() {
    let c = good(MINIMAL);
    assert_eq!(
        (c.rate_hz, c.silence_s, c.settle_s, c.replay_pace, c.interval_ns()),
        (100.0, 0.5, 120.0, 1.0, 10_000_000)
    );
    assert_eq!((c.run.seed, c.run.duration_s, c.run.scheduling), (1, None, SchedulingChoice::Auto));
    assert_eq!((c.main.accel, c.main.mounting), (None, Rot::<Main, Case>::identity()));
    let area = &c.areas[0];
    assert_eq!((area.lever_arm, area.accel, area.installation, area.zero), (Vec3::ZERO, None, None, Vec3::ZERO));
    assert_eq!(area.mounting, Rot::<Sub, Case>::identity());
    assert_eq!(
        (area.gyro.scale, area.gyro.misalignment, area.gyro.stamp_jitter, area.gyro.range),
        (0.0, 0.0, 0.0, None)
    );
    let EstimatorSettings { filter_hz, registration_s, static_rate_noise, .. } = area.estimator;
    assert_eq!((filter_hz, registration_s), (10.0, 20.0));
    assert!(close(static_rate_noise, 1e-4 * ARCSEC * ARCSEC));
    let i = area.identifier;
    assert_eq!((i.window_s, i.period_s, i.lead_s, i.minimum_s, i.dictionary), (600.0, 10.0, 1.0, 30.0, 1));
    assert_eq!((i.method, i.safety), (IdentifierMethod::Learnt(Method::Whittle), true));
}

#[test]
fn the_default_ship_is_that_of_paper_000() {
    let s = good(MINIMAL).scenario(7);
    let other = simulation::Scenario { run_id: 7, ..simulation::Scenario::default() };
    assert_eq!((s.rate_hz, s.seed, s.run_id, s.duration_s), (100.0, 1, 7, None));
    assert_eq!(s.ship, other.ship);
    assert_eq!(s.ins.attitude, [20.0 * ARCSEC, 20.0 * ARCSEC, 60.0 * ARCSEC]);
    assert_eq!(s.areas[0].flexure, other.areas[0].flexure);
    assert_eq!(s.areas[0].installation, other.areas[0].installation);
    assert_eq!(s.areas[0].wire, simulation::Wire::default());
}

#[test]
fn units_of_measure_become_si() {
    let c = good(FULL);
    let g = c.main.gyro;
    assert!(close(g.arw, 0.01 * DEGREE) && close(g.arw, 0.6 * DEG_PER_SQRT_H));
    assert!(close(g.bias, DEGREE) && close(g.scale, 5e-6) && close(g.misalignment, 10.0 * DEGREE / 3600.0));
    assert!(close(g.stamp_jitter, 5e-5) && close(g.range.expect("a range"), std::f64::consts::PI));
    let a = c.main.accel.expect("accelerometers");
    assert!(close(a.vrw, 10e-6 * 9.80665) && close(a.bias, 50e-6 * 9.80665) && close(a.scale, 2e-6));
    assert!(close(a.misalignment, 3.0 * ARCSEC) && close(a.range.expect("a range"), 8.0 * STANDARD_GRAVITY));
    let area = &c.areas[0];
    assert_eq!(area.lever_arm, Vec3::new(1.0, -2.5, 3.0));
    let installation = area.installation.expect("an installation");
    assert!(close(installation.sigma, 0.5 * DEGREE));
    assert!((installation.rotation.log() - Vec3::new(DEGREE, 2.0 * DEGREE, 3.0 * DEGREE)).norm() < 1e-14);
    assert!(close(area.estimator.static_rate_noise, 2.0 * (DEGREE / 3600.0).powi(2)));
    let IdentifierMethod::Fixed(hull) = area.identifier.method else { panic!("not fixed") };
    assert_eq!(hull.modes[1], Flexure { mu: 0.2, b: 0.5, sigma: 120.0 * ARCSEC });
    assert_eq!((area.identifier.window_s, area.identifier.dictionary), (100.0, 3));
    assert_eq!((c.run.seed, c.run.duration_s, c.run.scheduling), (9, Some(60.0), SchedulingChoice::Fifo));
}

#[test]
fn mountings_turn_case_axes_into_body_axes() {
    let c = good(FULL);
    let swapped = c.main.mounting * Vec3::<Case>::new(1.0, 2.0, 3.0);
    assert!((swapped - Vec3::new(2.0, 1.0, -3.0)).norm() < 1e-12);
    let turned = c.areas[0].mounting * Vec3::<Case>::new(1.0, 0.0, 0.0);
    assert!((turned - Vec3::new(0.0, 1.0, 0.0)).norm() < 1e-12);
}

#[test]
fn a_matrix_of_few_decimals_becomes_the_nearest_rotation() {
    let text = MINIMAL
        .replace("[[area]]", "mounting = { matrix = [[0.8660, -0.5, 0], [0.5, 0.8660, 0], [0, 0, 1]] }\n[[area]]");
    let phi = good(&text).main.mounting.log();
    assert!((phi - Vec3::new(0.0, 0.0, 0.5_f64.atan2(0.8660))).norm() < 1e-12, "{phi:?}");
}

#[test]
fn the_simulator_gets_the_true_figures() {
    let s = good(FULL).scenario(1);
    assert!(
        close(s.ship.speed, 10.0 * KNOT)
            && close(s.ship.latitude, -30.0 * DEGREE)
            && close(s.ship.course, 90.0 * DEGREE)
    );
    assert!(s.ship.velocity_follows_heading);
    let (simulation::Swing::Sine(roll), simulation::Swing::Sine(heading)) = (s.ship.roll, s.ship.heading) else {
        panic!("{:?}", s.ship);
    };
    assert!(close(heading.amplitude, 5.0 * DEGREE) && heading.period == 10.0);
    assert!(close(roll.amplitude, 10.0 * DEGREE) && roll.period == 12.0 && close(roll.phase, 90.0 * DEGREE));
    assert!(
        close(s.ins.attitude[2], 30.0 * ARCSEC)
            && close(s.ins.attitude[0], 20.0 * ARCSEC)
            && close(s.ins.noise, 2.0 * ARCSEC)
    );
    assert!(close(s.main.scale, 5.0 * PPM) && close(s.main.accel_bias, 7.0 * MICRO_G) && s.main.vrw == 0.0);
    let area = &s.areas[0];
    assert!(
        close(area.unit.arw, 0.1 * DEG_PER_SQRT_H) && close(area.unit.bias, DEG_PER_H) && area.unit.accel_bias == 0.0
    );
    assert!((area.installation.log() - Vec3::new(DEGREE, 0.0, 0.0)).norm() < 1e-14);
    assert_eq!((area.dynamic_lever_arm, area.flexure[2].mu, area.flexure[2].b), (0.0, 3.0, 6.0));
    assert!(close(area.flexure[1].sigma, 2.0 * ARCMIN));
    let w = area.wire;
    assert!(close(w.delay_s, 5e-3) && close(w.skew, 1e-5) && close(w.phase_s, 3e-3) && close(w.rate_error, 2e-5));
    assert!(close(w.jitter_s, 7e-5) && close(w.transit_s, 4e-3));
    assert_eq!((w.loss, w.duplicate, w.swap), (1e-3, 2e-3, 3e-3));
}

#[test]
fn the_configurations_of_the_project_are_sound() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../config");
    let demo = Configuration::read(&folder.join("demo.toml")).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!((demo.areas[0].name.as_str(), demo.settle_s, demo.areas[0].identifier.minimum_s), ("radar", 30.0, 30.0));
    let paper = simulation::Scenario::default();
    let scenario = demo.scenario(1);
    assert_eq!((scenario.ship, scenario.main), (paper.ship, paper.main));
    assert_eq!(scenario.areas, paper.areas);
    let two = Configuration::read(&folder.join("two_areas.toml")).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(two.areas.iter().map(|a| a.name.as_str()).collect::<Vec<_>>(), ["radar", "landing-aid"]);
    assert!(close(two.scenario(1).areas[1].wire.jitter_s, 2e-5));
    assert_ne!(two.scenario(1).areas[0].flexure, two.scenario(1).areas[1].flexure);
    let copy = Folder::new();
    std::fs::create_dir(copy.0.path().join("recordings")).expect("a writable folder");
    copy.write("recordings/main.csv", "t_s");
    copy.write("recordings/radar.csv", "t_s");
    let text = std::fs::read_to_string(folder.join("replay.toml")).expect("replay.toml");
    let replay = Configuration::read(&copy.write("replay.toml", &text)).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!((replay.main.source.kind(), replay.replay_pace), ("csv", 1.0));
}
