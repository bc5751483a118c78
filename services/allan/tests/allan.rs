//! From the recording's bytes to the lines of the configuration.
#![allow(clippy::unwrap_used)]

use allan::{AllanError, Kind, Options, run};
use frames::unit::{DEG_PER_H, DEG_PER_SQRT_H, MICRO_G};
use rand::{RngExt, SeedableRng};
use rand_distr::StandardNormal;
use rand_pcg::Pcg64Mcg;
use serde_json::Value;
use std::fmt::Write;
use std::fs;
use std::path::PathBuf;
use tempfile::TempDir;

/// deg/sqrt(h).
const ARW: f64 = 0.15;
/// ug/sqrt(Hz).
const VRW: f64 = 60.0;
/// 20 minutes at 50 Hz.
const ROWS: usize = 60_000;
const INTERVAL: f64 = 0.02;

/// A unit at rest with white noise and gyro biases of 100 deg/h, as increments.
fn place() -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let mut random = Pcg64Mcg::seed_from_u64(1);
    let mut normal = |sigma: f64| sigma * random.sample::<f64, _>(StandardNormal);
    let mut text = String::from("t_s,dtheta_x_rad,dtheta_y_rad,dtheta_z_rad,dvel_x_m_s,dvel_y_m_s,dvel_z_m_s\n");
    let (angle, velocity) = (ARW * DEG_PER_SQRT_H * INTERVAL.sqrt(), VRW * MICRO_G * INTERVAL.sqrt());
    for k in 0..ROWS {
        write!(text, "{:.2}", k as f64 * INTERVAL).unwrap();
        for bias in [100.0, -100.0, 100.0] {
            write!(text, ",{}", bias * DEG_PER_H * INTERVAL + normal(angle)).unwrap();
        }
        writeln!(text, ",{},{},{}", normal(velocity), normal(velocity), 9.81 * INTERVAL + normal(velocity)).unwrap();
    }
    let path = folder.path().join("still.csv");
    fs::write(&path, text).unwrap();
    (folder, path)
}

#[test]
fn the_lines_to_paste_hold_what_the_recording_was_made_of() {
    let (folder, file) = place();
    let (svg, json) = (folder.path().join("allan.svg"), folder.path().join("allan.json"));
    let report = run(&Options { file, unit: None, svg: Some(svg.clone()), json: Some(json.clone()) }).unwrap();
    assert_eq!((report.samples, report.stretches, report.bridged), (ROWS, 1, 0));
    assert_eq!(report.triads.iter().map(|triad| triad.kind).collect::<Vec<_>>(), [Kind::Gyro, Kind::Accel]);
    let said = report.to_string();
    let line = |name: &str| said.lines().find(|line| line.starts_with(name)).unwrap().to_owned();
    let pasted: toml::Table = toml::from_str(&format!("{}\n{}", line("gyro ="), line("accel ="))).unwrap();
    let number = |table: &str, key: &str| pasted[table][key].as_float().unwrap();
    assert!((number("gyro", "arw_deg_per_sqrt_h") / ARW - 1.0).abs() < 0.02, "{said}");
    assert!((number("accel", "vrw_ug_per_sqrt_hz") / VRW - 1.0).abs() < 0.02, "{said}");
    // 173.2 deg/h, of which the earth's rate may be 15
    assert!((number("gyro", "bias_deg_per_h") - (3f64.sqrt() * 100.0 - 15.04) / 3f64.sqrt()).abs() < 1.0, "{said}");
    assert!(number("gyro", "instability_deg_per_h") < 5.0, "{said}");
    assert!(number("accel", "bias_ug") < 100.0, "{said}");
    let told: Value = serde_json::from_str(&fs::read_to_string(json).unwrap()).unwrap();
    let x = &told["triads"]["gyro"]["axes"]["x"];
    assert!((x["arw_deg_per_sqrt_h"]["value"].as_f64().unwrap() / ARW - 1.0).abs() < 0.03, "{x}");
    assert!((x["mean_deg_per_h"].as_f64().unwrap() - 100.0).abs() < 5.0, "{x}");
    // ARW sqrt(60 / tau s) in deg/h
    let first = &x["points"][0];
    let expected = ARW * 60.0 / INTERVAL.sqrt();
    assert!((first["deviation_deg_per_h"].as_f64().unwrap() / expected - 1.0).abs() < 0.02, "{first}");
    let drawn = fs::read_to_string(svg).unwrap();
    assert!(drawn.trim_end().ends_with("</svg>") && !drawn.contains("NaN") && drawn.contains("deviation (ug)"));
}

#[test]
fn a_configuration_names_its_units() {
    let (folder, _) = place();
    let toml = folder.path().join("ship.toml");
    let gyro = "gyro = { arw_deg_per_sqrt_h = 0.1, bias_deg_per_h = 1 }";
    let source = "source = { kind = \"csv\", path = \"still.csv\" }";
    let text = format!("rate_hz = 50\n[main]\n{source}\n{gyro}\n[[area]]\nname = \"radar\"\n{source}\n{gyro}\n");
    fs::write(&toml, text).unwrap();
    let of =
        |unit: Option<&str>| run(&Options { file: toml.clone(), unit: unit.map(str::to_owned), ..Options::default() });
    assert_eq!(of(None).unwrap().to_string(), of(Some("radar")).unwrap().to_string());
    let said = of(Some("mast")).unwrap_err().to_string();
    assert!(said.contains("\"mast\" is no recording") && said.contains("main, radar"), "{said}");
}

#[test]
fn what_cannot_be_used_is_refused() {
    let (folder, file) = place();
    let refused = |options: Options| {
        let error = run(&options).unwrap_err();
        assert!(error.is_unusable(), "{error}");
        error.to_string()
    };
    let unit = Some("radar".to_owned());
    assert!(refused(Options { file: file.clone(), unit, ..Options::default() }).contains("--unit"));
    assert!(refused(Options { file: folder.path().join("no.csv"), ..Options::default() }).contains("no.csv"));
    let text = fs::read_to_string(&file).unwrap();
    let short = folder.path().join("short.csv");
    fs::write(&short, text.lines().take(40).map(|line| format!("{line}\n")).collect::<String>()).unwrap();
    assert!(refused(Options { file: short, ..Options::default() }).contains("48 or more samples"));
    let svg = Some(folder.path().join("nowhere/allan.svg"));
    let error = run(&Options { file, svg, ..Options::default() }).unwrap_err();
    assert!(matches!(error, AllanError::Output { .. }) && !error.is_unusable(), "{error}");
}
