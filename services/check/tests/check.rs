//! What `check` says of sound, suspicious and unusable recordings.

use check::CheckError;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

const CONFIGURATION: &str = r#"rate_hz = 100
[main]
source = { kind = "csv", path = "main.csv" }
gyro = { arw_deg_per_sqrt_h = 0.001, bias_deg_per_h = 0.003 }
[[area]]
name = "radar"
source = { kind = "csv", path = "radar.csv" }
gyro = { arw_deg_per_sqrt_h = 0.001, bias_deg_per_h = 0.01 }
"#;

const HEADER: &str = "t_s,gyro_x_rad_s,gyro_y_rad_s,gyro_z_rad_s,accel_x_m_s2,accel_y_m_s2,accel_z_m_s2\n";

/// A unit at rest from the time `start` with the given interval and gravity, but without row 50.
fn recording(start: f64, interval: f64, gravity: f64) -> String {
    let rows = (0..200).filter(|&i| i != 50);
    let row = |i| format!("{:.6},0.001,0.002,-0.001,0,0,{gravity}\n", start + f64::from(i) * interval);
    HEADER.to_string() + &rows.map(row).collect::<String>()
}

fn folder(main: &str, radar: &str) -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("replay.toml");
    for (name, text) in [("replay.toml", CONFIGURATION), ("main.csv", main), ("radar.csv", radar)] {
        std::fs::write(folder.path().join(name), text).expect("a writable folder");
    }
    (folder, path)
}

#[test]
fn sound_recordings_are_described() {
    let (folder, path) = folder(&recording(0.0, 0.01, 9.8), &recording(0.5, 0.01, 9.8));
    let report = check::run(&path).unwrap_or_else(|error| panic!("{error}"));
    let text = report.to_string().replace(&format!("{}/", folder.path().display()), "");
    let expected = "\
replay.toml: sound
  100 Hz, sources csv, areas radar
main: main.csv
  first 199 rows, 0.000 to 1.990 s, 100.0000 Hz
  gaps 1, repeated 0, back 0, refused 0, not finite 0
  gyro rms 0.002449 rad/s, usual specific force 9.8000 m/s^2
radar: radar.csv
  first 199 rows, 0.500 to 2.490 s, 100.0000 Hz
  gaps 1, repeated 0, back 0, refused 0, not finite 0
  gyro rms 0.002449 rad/s, usual specific force 9.8000 m/s^2
";
    assert_eq!(text, expected);
}

#[test]
fn suspicious_recordings_are_told_but_no_error() {
    let (_folder, path) = folder(&recording(0.0, 0.02, 9.8), &recording(100.0, 0.01, 1.0));
    let report = check::run(&path).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(
        report.suspicions(),
        [
            "main: the rate is 50.0000 Hz, but rate_hz is 100",
            "radar: the usual specific force is 1.0000 m/s^2: it looks like g, not m/s^2",
            "radar: has no time in common with main",
        ]
    );
    assert!(report.to_string().contains("suspicious: radar: has no time in common with main\n"));
}

#[test]
fn every_unusable_recording_is_told() {
    let (_folder, path) = folder("time,x\n1,2\n", &format!("{HEADER}0.01,0.1"));
    let error = check::run(&path).expect_err("unusable");
    assert!(matches!(&error, CheckError::Recordings(all) if all.len() == 2), "{error}");
    let text = error.to_string();
    let lines: Vec<&str> = text.lines().collect();
    assert!(lines[0].ends_with("main.csv: the header is not recognised: the column t_s is missing"), "{text}");
    assert!(lines[1].ends_with("radar.csv: no row can be used (1 refused)"), "{text}");
}

#[test]
fn an_unsound_configuration_is_told() {
    let (folder, path) = folder("", "");
    std::fs::remove_file(folder.path().join("radar.csv")).expect("a file");
    let text = check::run(&path).expect_err("a missing recording").to_string();
    assert!(text.contains("replay.toml:7: area[0].source.path = \"radar.csv\": cannot read"), "{text}");
}

#[test]
fn the_simulator_has_no_recordings() {
    let demo = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../config/demo.toml");
    let report = check::run(&demo).unwrap_or_else(|error| panic!("{error}"));
    assert!(report.units.is_empty() && report.to_string().ends_with("  100 Hz, sources simulator, areas radar\n"));
}
