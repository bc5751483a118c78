//! Configurations: what is read, in which units, and what each mistake is told.

use estimation::flexure::Flexure;
use estimation::identify::Method;
use frames::unit::{ARCMIN, ARCSEC, DEG_PER_H, DEG_PER_SQRT_H, DEGREE, KNOT, MICRO_G, PPM, STANDARD_GRAVITY};
use frames::{Case, Main, Rot, Sub, Vec3};
use pipeline::configuration::{Configuration, EstimatorSettings, IdentifierMethod, SchedulingChoice, Source};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use std::path::{Path, PathBuf};

const MINIMAL: &str = r#"rate_hz = 100
[main]
source = { kind = "simulator" }
gyro = { arw_deg_per_sqrt_h = 0.001, bias_deg_per_h = 0.003 }
[[area]]
name = "radar"
source = { kind = "simulator" }
gyro = { arw_deg_per_sqrt_h = 0.001, bias_deg_per_h = 0.01 }
"#;

struct Folder(tempfile::TempDir);

impl Folder {
    fn new() -> Self {
        Self(tempfile::tempdir().expect("a temporary folder"))
    }

    fn write(&self, name: &str, text: &str) -> PathBuf {
        let path = self.0.path().join(name);
        std::fs::write(&path, text).expect("a writable folder");
        path
    }
}

fn read(text: &str) -> Result<Configuration, String> {
    let folder = Folder::new();
    let path = folder.write("ship.toml", text);
    let prefix = format!("{}/", folder.0.path().display());
    Configuration::read(&path).map_err(|error| error.to_string().replace(&prefix, ""))
}

fn good(text: &str) -> Configuration {
    read(text).unwrap_or_else(|error| panic!("{error}"))
}

/// The message of the minimal configuration with `from` replaced by `to`.
fn message(from: &str, to: &str) -> String {
    assert!(MINIMAL.contains(from), "{from}");
    read(&MINIMAL.replacen(from, to, 1)).expect_err(to)
}

/// The message of the minimal configuration with lines added to its area, from line 9.
fn message_with(lines: &str) -> String {
    read(&format!("{MINIMAL}{lines}\n")).expect_err(lines)
}

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-14 * b.abs()
}

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
    assert_eq!((area.lever_arm, area.accel, area.installation), (Vec3::ZERO, None, None));
    assert_eq!(area.mounting, Rot::<Sub, Case>::identity());
    assert_eq!(
        (area.gyro.scale, area.gyro.misalignment, area.gyro.stamp_jitter, area.gyro.range),
        (0.0, 0.0, 0.0, None)
    );
    let EstimatorSettings { filter_hz, registration_s, static_rate_noise, .. } = area.estimator;
    assert_eq!((filter_hz, registration_s), (10.0, 20.0));
    assert!(close(static_rate_noise, 1e-4 * ARCSEC * ARCSEC));
    let i = area.identifier;
    assert_eq!((i.window_s, i.period_s, i.lead_s, i.minimum_s, i.dictionary), (300.0, 10.0, 1.0, 10.0, 1));
    assert_eq!((i.method, i.safety), (IdentifierMethod::Learnt(Method::Rvm), true));
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

const FULL: &str = r#"rate_hz = 62.5
silence_s = 1
settle_s = 5
[run]
seed = 9
duration_s = 60
scheduling = "fifo"
[main]
source = { kind = "simulator" }
gyro = { arw_deg_per_sqrt_h = 0.6, bias_deg_per_h = 3600, scale_ppm = 5, misalignment_arcsec = 10, stamp_jitter_us = 50, range_deg_per_s = 180 }
accel = { vrw_ug_per_sqrt_hz = 10, bias_ug = 50, scale_ppm = 2, misalignment_arcsec = 3, range_g = 8 }
mounting = { matrix = [[0, 1, 0], [1, 0, 0], [0, 0, -1]] }
[[area]]
name = "a-1_b"
source = { kind = "simulator" }
lever_arm_m = [1, -2.5, 3]
gyro = { arw_deg_per_sqrt_h = 0.001, bias_deg_per_h = 0.01, stamp_jitter_us = 50 }
mounting = { rotation_vector_deg = [0, 0, 90] }
installation = { rotation_vector_deg = [1, 2, 3], sigma_deg = 0.5 }
[area.estimator]
matching = "so3"
filter_hz = 20
registration_s = 40
static_rate_noise_arcsec2_per_s3 = 2
[area.identifier]
method = "fixed"
window_s = 100
period_s = 5
lead_s = 2
minimum_s = 20
dictionary = 3
flexure = { mu_per_s = [0.1, 0.2, 0.3], b_rad_per_s = [0.4, 0.5, 0.6], sigma_arcsec = [60, 120, 180] }
[area.simulation]
installation_rotation_vector_arcmin = [60, 0, 0]
flexure = { mu_per_s = [1, 2, 3], b_rad_per_s = [4, 5, 6], sigma_arcmin = [1, 2, 3] }
dynamic_lever_arm = 0
wire = { delay_ms = 5, skew_ppm = 10, phase_ms = 3, rate_error_ppm = 20, loss = 1e-3, duplicate = 2e-3, swap = 3e-3, transit_ms = 4 }
gyro = { arw_deg_per_sqrt_h = 0.1, bias_deg_per_h = 1, stamp_jitter_us = 70 }
[simulation]
speed_knots = 10
latitude_deg = -30
course_deg = 90
velocity_follows_heading = true
heading = { amplitude_deg = 5 }
roll = { period_s = 12, phase_deg = 90 }
ins = { heading_arcsec = 30 }
accel = { bias_ug = 7 }
"#;

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
    let IdentifierMethod::Fixed(flexure) = area.identifier.method else { panic!("not fixed") };
    assert_eq!(flexure[1], Flexure { mu: 0.2, b: 0.5, sigma: 120.0 * ARCSEC });
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
    assert_eq!((demo.areas[0].name.as_str(), demo.settle_s, demo.areas[0].identifier.minimum_s), ("radar", 30.0, 8.0));
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

#[test]
fn a_misspelt_key_is_told_with_its_neighbour() {
    assert_eq!(
        message_with("[area.identifier]\nwindw_s = 3"),
        "ship.toml:10: unknown key `windw_s` in [area.identifier]; did you mean `window_s`?"
    );
    assert_eq!(
        message("bias_deg_per_h = 0.01", "bias_deg_h = 0.01"),
        "ship.toml:8: unknown key `bias_deg_h` in [area.gyro]; did you mean `bias_deg_per_h`?"
    );
    assert_eq!(
        message("rate_hz", "rate_khz"),
        "ship.toml:1: unknown key `rate_khz` at the top level; did you mean `rate_hz`?"
    );
    assert_eq!(
        message_with("[run]\nwind = 3"),
        "ship.toml:10: unknown key `wind` in [run]; known here: seed, duration_s, scheduling"
    );
    assert_eq!(
        message_with("[area.simulation.wire]\nlos = 0.1"),
        "ship.toml:10: unknown key `los` in [area.simulation.wire]; did you mean `loss`?"
    );
}

#[test]
fn a_value_out_of_its_range_is_told_with_the_range() {
    assert_eq!(message("rate_hz = 100", "rate_hz = -5"), "ship.toml:1: rate_hz = -5: must be within 10 to 1000");
    assert_eq!(message("rate_hz = 100", "rate_hz = nan"), "ship.toml:1: rate_hz = nan: must be within 10 to 1000");
    assert_eq!(
        message("bias_deg_per_h = 0.01", "bias_deg_per_h = inf"),
        "ship.toml:8: area[0].gyro.bias_deg_per_h = inf: must be within 0 to 100000"
    );
    assert_eq!(
        message("arw_deg_per_sqrt_h = 0.001", "arw_deg_per_sqrt_h = -1e-3"),
        "ship.toml:4: main.gyro.arw_deg_per_sqrt_h = -1e-3: must be within 0 to 1000"
    );
    assert_eq!(
        message_with("[area.identifier]\ndictionary = 101"),
        "ship.toml:10: area[0].identifier.dictionary = 101: must be within 1 to 100"
    );
    assert_eq!(
        message_with("lever_arm_m = [0, 0, 5000]"),
        "ship.toml:9: area[0].lever_arm_m: must be within -1000 to 1000"
    );
    assert_eq!(
        message("\"radar\"", "\"Radar mast\""),
        "ship.toml:6: area[0].name = \"Radar mast\": must be 1 to 32 characters of a-z, 0-9, _ and -"
    );
}

#[test]
fn a_wrong_type_is_told_with_the_right_one() {
    assert_eq!(message("rate_hz = 100", "rate_hz = \"100\""), "ship.toml:1: rate_hz = \"100\": expected a number");
    assert_eq!(message_with("lever_arm_m = [1, 2]"), "ship.toml:9: area[0].lever_arm_m: expected 3 elements, found 2");
    assert_eq!(
        message_with("lever_arm_m = [1, 2, 3, 4]"),
        "ship.toml:9: area[0].lever_arm_m: expected 3 elements, found 4"
    );
    assert_eq!(
        message_with("lever_arm_m = [1, true, 2]"),
        "ship.toml:9: area[0].lever_arm_m[1] = true: expected a number"
    );
    assert_eq!(message_with("lever_arm_m = 3"), "ship.toml:9: area[0].lever_arm_m = 3: expected an array");
    assert_eq!(message_with("accel = [1, 2]"), "ship.toml:9: area[0].accel: expected a table");
    assert_eq!(message("\"radar\"", "5"), "ship.toml:6: area[0].name = 5: expected a string");
    assert_eq!(message("[[area]]", "[area]"), "ship.toml:5: area: expected an array");
    assert_eq!(message_with("[run]\nseed = -1"), "ship.toml:10: run.seed = -1: expected a whole number, 0 or more");
    assert_eq!(
        message_with("[run]\nscheduling = \"fif\""),
        "ship.toml:10: run.scheduling = \"fif\": must be one of \"auto\", \"normal\", \"fifo\"; did you mean `fifo`?"
    );
    assert_eq!(message_with("[run]\nscheduling = 1"), "ship.toml:10: run.scheduling = 1: expected a string");
    assert_eq!(
        message_with("[area.identifier]\nmethod = \"svr\""),
        "ship.toml:10: area[0].identifier.method = \"svr\": must be one of \"rvm\", \"rvm_gaussian\", \"support_vector\", \
         \"whale\", \"particle_swarm\", \"tufts_kumaresan\", \"tufts_kumaresan_printed\", \"yule_walker\", \
         \"matrix_pencil\", \"whittle\", \"fixed\""
    );
    assert_eq!(
        message_with("[area.estimator]\nmatching = \"ekf\""),
        "ship.toml:10: area[0].estimator.matching = \"ekf\": must be one of \"so3\", \"rate\", \"residual_attitude\", \
         \"small_angle\", \"exact_attitude\", \"rodrigues\", \"rodrigues_printed\", \"attitude_dcm\", \"quaternion\", \
         \"quaternion_delay\", \"quaternion_walk\", \"quaternion_network\", \"residual_attitude_network\", \
         \"residual_attitude_network_printed\", \"small_angle_network\", \"small_angle_network_printed\""
    );
    assert_eq!(
        message_with("[simulation]\nvelocity_follows_heading = 1"),
        "ship.toml:10: simulation.velocity_follows_heading = 1: expected true or false"
    );
}

#[test]
fn a_missing_key_is_told() {
    assert_eq!(message("rate_hz = 100", ""), "ship.toml: the required key `rate_hz` is missing");
    assert_eq!(message("name = \"radar\"", ""), "ship.toml:5: the required key `area[0].name` is missing");
    assert_eq!(
        message("arw_deg_per_sqrt_h = 0.001, bias_deg_per_h = 0.01", "bias_deg_per_h = 0.01"),
        "ship.toml:8: the required key `area[0].gyro.arw_deg_per_sqrt_h` is missing"
    );
    let (head, _) = MINIMAL.split_once("[[area]]").expect("an area");
    assert_eq!(read(head).expect_err("no area"), "ship.toml: area: at least one [[area]] is required");
    let (_, tail) =
        MINIMAL.split_once("gyro = { arw_deg_per_sqrt_h = 0.001, bias_deg_per_h = 0.003 }\n").expect("main");
    let no_main = format!("rate_hz = 100\n{tail}");
    assert_eq!(read(&no_main).expect_err("no main"), "ship.toml: the required key `main` is missing");
    assert_eq!(read("").expect_err("nothing"), "ship.toml: the required key `rate_hz` is missing");
    let implicit = MINIMAL.replace("[main]\nsource = { kind = \"simulator\" }\ngyro =", "main.gyro =");
    assert!(read(&implicit).expect_err("no source").contains("required key `main.source` is missing"));
}

#[test]
fn text_that_is_not_toml_is_told_with_its_line() {
    let text = message("[[area]]", "[[area]");
    assert!(text.starts_with("ship.toml:5: not valid TOML: "), "{text}");
    let text = message("name = \"radar\"", "name = \"radar\"\nname = \"mast\"");
    assert!(text.starts_with("ship.toml:7: not valid TOML: duplicate key"), "{text}");
}

#[test]
fn a_file_that_is_not_there_is_told_with_the_reason() {
    let error = Configuration::read(Path::new("/nowhere/ship.toml")).expect_err("nowhere").to_string();
    assert_eq!(error, "/nowhere/ship.toml: cannot read the configuration: No such file or directory (os error 2)");
}

#[test]
fn sources_are_of_one_kind_and_recordings_exist() {
    let folder = Folder::new();
    folder.write("a.csv", "t_s");
    let main = MINIMAL.replacen("{ kind = \"simulator\" }", "{ kind = \"csv\", path = \"a.csv\" }", 1);
    let path = folder.write("ship.toml", &main);
    let told = |path: &Path| Configuration::read(path).expect_err("a fault").to_string();
    assert_eq!(
        told(&path),
        format!(
            "{}:7: area[0].source.kind = \"simulator\": all sources must be of one kind, and [main] has \"csv\"",
            path.display()
        )
    );
    let both = main.replacen("{ kind = \"simulator\" }", "{ kind = \"csv\", path = \"b.csv\" }", 1);
    let path = folder.write("ship.toml", &both);
    let missing = folder.0.path().join("b.csv");
    assert_eq!(
        told(&path),
        format!(
            "{}:7: area[0].source.path = \"b.csv\": cannot read {}: No such file or directory (os error 2)",
            path.display(),
            missing.display()
        )
    );
    folder.write("b.csv", "t_s");
    let c = Configuration::read(&path).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(c.areas[0].source, Source::Csv(missing));
    let pace = folder.write("pace.toml", &format!("{both}[replay]\npace = 20\n"));
    assert_eq!(Configuration::read(&pace).unwrap_or_else(|e| panic!("{e}")).replay_pace, 20.0);
    let path = folder.write("ship.toml", &format!("{both}[simulation]\n"));
    assert!(told(&path).ends_with(":9: simulation: has no effect with sources of kind \"csv\""));
    assert_eq!(
        message_with("[replay]\npace = 2"),
        "ship.toml:9: replay: has no effect with sources of kind \"simulator\""
    );
    assert_eq!(
        message("{ kind = \"simulator\" }", "{ kind = \"csv\" }"),
        "ship.toml:3: main.source: a source of kind \"csv\" needs the key `path`"
    );
}

#[test]
fn mountings_that_are_no_rotation_are_refused() {
    assert_eq!(
        message_with("mounting = { matrix = [[1, 0, 0], [0, 1, 0.1], [0, 0, 1]] }"),
        "ship.toml:9: area[0].mounting: the matrix must be orthogonal within 0.001, but C C^T differs from the unit matrix by 0.1000"
    );
    assert_eq!(
        message_with("mounting = { matrix = [[0, 1, 0], [1, 0, 0], [0, 0, 1]] }"),
        "ship.toml:9: area[0].mounting: the matrix must have the determinant +1, but it has -1: it mirrors an axis"
    );
    assert_eq!(
        message_with("mounting = {}"),
        "ship.toml:9: area[0].mounting: needs either `rotation_vector_deg` or `matrix`"
    );
}

#[test]
fn the_fixed_model_and_its_figures_belong_together() {
    assert_eq!(
        message_with("[area.identifier]\nmethod = \"fixed\""),
        "ship.toml:9: area[0].identifier: method \"fixed\" needs the key `flexure`"
    );
    let flexure = "flexure = { mu_per_s = [1, 1, 1], b_rad_per_s = [1, 1, 1], sigma_arcsec = [1, 1, 1] }";
    assert_eq!(
        message_with(&format!("[area.identifier]\n{flexure}")),
        "ship.toml:9: area[0].identifier: the key `flexure` goes with method \"fixed\" only, not with \"rvm\""
    );
    assert_eq!(
        message_with("[area.simulation]\nflexure = { tau_s = [1, 1, 1], mu_per_s = [1, 1, 1] }"),
        "ship.toml:10: area[0].simulation.flexure: needs either `tau_s`, or `mu_per_s` and `b_rad_per_s`, or `mu_per_s` and `frequency_hz`"
    );
}

#[test]
fn rules_of_several_keys_are_all_reported() {
    let text = MINIMAL.replace("rate_hz = 100", "rate_hz = 10\nsilence_s = 0.1")
        + "[area.estimator]\nfilter_hz = 50\n[area.identifier]\nminimum_s = 10\nwindow_s = 8\n"
        + MINIMAL.split_once("[[area]]").map_or("", |(_, tail)| tail).replace("\nname", "[[area]]\nname").as_str();
    let told = read(&text).expect_err("four faults");
    let lines: Vec<&str> = told.lines().collect();
    assert_eq!(
        lines,
        [
            "ship.toml:16: area[1].name = \"radar\": area[0] has the same name",
            "ship.toml:2: silence_s = 0.1: must be at least two samples, 0.2 s at 10 Hz",
            "ship.toml:11: area[0].estimator.filter_hz = 50: must not be above rate_hz = 10",
            "ship.toml:13: area[0].identifier.minimum_s = 10: 10 s is longer than window_s = 8",
        ]
    );
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, rng_seed: RngSeed::Fixed(1), ..ProptestConfig::default() })]

    #[test]
    fn damaged_text_is_read_or_refused_but_never_a_panic(
        at in 0..FULL.len(), length in 0..40usize, patch in prop::collection::vec(any::<u8>(), 0..20)
    ) {
        let mut text = FULL.as_bytes().to_vec();
        text.splice(at..(at + length).min(FULL.len()), patch);
        let folder = Folder::new();
        let path = folder.0.path().join("ship.toml");
        std::fs::write(&path, &text).expect("a writable folder");
        if let Err(error) = Configuration::read(&path) {
            prop_assert!(error.to_string().starts_with(&path.display().to_string()));
        }
    }
}

#[test]
fn every_method_of_identification_can_be_told() {
    for method in Method::ALL {
        for safety in [true, false] {
            let told = format!("[area.identifier]\nmethod = \"{}\"\nsafety = {safety}\n", method.name());
            let identifier = good(&format!("{MINIMAL}{told}")).areas[0].identifier;
            assert_eq!((identifier.method, identifier.safety), (IdentifierMethod::Learnt(method), safety));
        }
    }
    let wrong = message_with("[area.identifier]\nmethod = \"tufts_kumaresen\"");
    assert!(wrong.contains("method") && wrong.contains("tufts_kumaresen"), "{wrong}");
    assert!(wrong.ends_with("did you mean `tufts_kumaresan`?"), "{wrong}");
    let flexure = "flexure = { mu_per_s = [1, 1, 1], b_rad_per_s = [1, 1, 1], sigma_arcsec = [1, 1, 1] }";
    let wrong = message_with(&format!("[area.identifier]\nmethod = \"whittle\"\n{flexure}"));
    assert!(wrong.contains("not with \"whittle\""), "{wrong}");
}

#[test]
fn delay_and_network_go_with_the_matchings_that_have_them() {
    let faults = [
        ("matching = \"quaternion\"\ndelay = {}", "delay", "no delay"),
        ("matching = \"quaternion_delay\"\nnetwork = {}", "network", "no network"),
    ];
    for (estimator, key, others) in faults {
        let message = message_with(&format!("[area.estimator]\n{estimator}"));
        assert!(message.contains(&format!("estimator.{key}")) && message.ends_with(others), "{message}");
    }
    let message = message_with("[area.estimator]\nmatching = \"quaternion\"\nregistration = \"delay\"");
    assert!(message.ends_with("which goes with \"motion\", \"installation\""), "{message}");
}
