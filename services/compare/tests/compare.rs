//! Two files of a made deformation: rates, mountings, holes and rows of no use.
#![allow(clippy::unwrap_used)]

use compare::{CompareError, Options, run};
use frames::unit::ARCSEC;
use frames::{Main, Rot, Sub, Vec3};
use serde_json::Value;
use std::fmt::Write;
use std::fs;
use std::path::PathBuf;
use tempfile::TempDir;

/// The deformation at a time: 600 arcsec at 0.1 Hz.
fn truth(t: f64) -> Rot<Main, Sub> {
    let swing = 600.0 * ARCSEC * (0.628 * t).sin();
    Rot::exp(Vec3::new(0.01 + swing, -0.02, 0.03 - swing))
}

/// The error: 10 arcsec about x, 20 about z, changing sign every second.
fn error(t: f64) -> [f64; 3] {
    let sign = if (t.floor() as i64) % 2 == 0 { 1.0 } else { -1.0 };
    [10.0 * sign, 0.0, -20.0 * sign]
}

struct Place(TempDir);

impl Place {
    fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    fn write(&self, name: &str, text: &str) -> PathBuf {
        let path = self.0.path().join(name);
        fs::write(&path, text).unwrap();
        path
    }

    /// 100 Hz over 60 s, the first second invalid, as a solution file has it.
    fn solution(&self) -> PathBuf {
        let mut text = String::from("t_s,valid,q_w,q_x,q_y,q_z,range_x_arcsec,range_y_arcsec,range_z_arcsec\n");
        for k in 0..6000 {
            let t = 100.0 + f64::from(k) * 0.01;
            let e = Vec3::<Main>::from(error(t).map(|v| v * ARCSEC));
            let [w, x, y, z] = (Rot::<Main, Main>::exp(e) * truth(t)).quaternion();
            match k {
                0..100 => writeln!(text, "{t},0,,,,,,,").unwrap(),
                _ => writeln!(text, "{t},1,{w},{x},{y},{z},15,1,15").unwrap(),
            }
        }
        self.write("solution.csv", &text)
    }

    /// 40 Hz, off the solution's instants, by a unit that is mounted otherwise; a hole from 130 to 132 s.
    fn reference(&self) -> PathBuf {
        let mounting = Rot::<Sub, Sub>::exp(Vec3::new(0.5, 0.0, -2.0));
        let mut text = String::from("t_s,q_w,q_x,q_y,q_z\n");
        for k in 0..2400 {
            let t = 100.003 + f64::from(k) * 0.025;
            let [w, x, y, z] = (truth(t) * mounting).quaternion();
            if !(130.0..132.0).contains(&t) {
                writeln!(text, "{t},{w},{x},{y},{z}").unwrap();
            }
        }
        self.write("reference.csv", &text)
    }
}

#[test]
fn error_and_coverage_are_those_that_were_made() {
    let place = Place::new();
    let json = place.0.path().join("compare.json");
    let options = Options {
        solution: place.solution(),
        reference: place.reference(),
        json: Some(json.clone()),
        ..Options::default()
    };
    let report = run(&options).unwrap();
    let figures = report.figures;
    for (rmse, expected) in figures.rmse.into_iter().zip([10.0, 0.0, 20.0]) {
        // of the interpolation of a swing of 0.1 Hz at 40 Hz 0.05 arcsec are left
        assert!((rmse / ARCSEC - expected).abs() < 0.3, "{report}");
    }
    assert_eq!(figures.coverage, Some([1.0, 1.0, 0.0]), "{report}");
    assert!((figures.pooled_coverage().unwrap() - 2.0 / 3.0).abs() < 1e-12);
    // the solution is -2 rad about z and so on from the reference's
    let fixed = report.fixed * Rot::<Sub, Sub>::exp(Vec3::new(0.5, 0.0, -2.0));
    assert!(fixed.angle() < 1.0 * ARCSEC, "{report}");
    assert_eq!((report.solution_invalid, report.solution_refused), (100, 0));
    assert!((203..=207).contains(&report.unmatched), "{report}");
    let told: Value = serde_json::from_str(&fs::read_to_string(json).unwrap()).unwrap();
    assert_eq!(told["coverage_95"], serde_json::json!([1.0, 1.0, 0.0]));
    assert!((told["rmse_arcsec"][2].as_f64().unwrap() - 20.0).abs() < 0.3);
    assert!(
        report.to_string().contains("within the range, %             100.0      100.0        0.0       66.7"),
        "{report}"
    );
}

#[test]
fn the_static_stretch_alone_gives_the_fixed_deviation() {
    let place = Place::new();
    let (solution, reference) = (place.solution(), place.reference());
    let of = |still, from| {
        run(&Options { solution: solution.clone(), reference: reference.clone(), still, from, ..Options::default() })
    };
    // the error of that second is taken for fixed
    let report = of(Some([0.995, 1.905]), 10.0).unwrap();
    assert!((report.figures.rmse[0] / ARCSEC - 200f64.sqrt()).abs() < 0.5, "{report}");
    assert!((report.figures.mean[2].abs() / ARCSEC - 20.0).abs() < 1.0, "{report}");
    assert!(report.span[0] >= 110.99 && report.still == 91, "{report}");
    let said = of(Some([500.0, 600.0]), 0.0).unwrap_err();
    assert!(said.is_unusable() && said.to_string().contains("--static 500s..600s"), "{said}");
    let said = of(None, 1e4).unwrap_err().to_string();
    assert!(said.contains("--from 10000s leaves nothing"), "{said}");
}

#[test]
fn against_the_truth_the_fixed_deviation_may_stay() {
    let place = Place::new();
    let solution = place.solution();
    let mut truth_text = String::from("phi_x_arcsec,phi_y_arcsec,phi_z_arcsec,t_s\n");
    for k in 0..6000 {
        let t = 100.0 + f64::from(k) * 0.01;
        let off = Rot::<Main, Main>::exp(Vec3::new(0.0, 50.0 * ARCSEC, 0.0));
        let [x, y, z] = (off * truth(t)).log().array().map(|v| v / ARCSEC);
        writeln!(truth_text, "{x},{y},{z},{t}").unwrap();
    }
    let reference = place.write("truth.csv", &truth_text);
    let report = run(&Options { solution, reference, keep_fixed: true, ..Options::default() }).unwrap();
    assert!((report.figures.mean[1] / ARCSEC + 50.0).abs() < 0.1 && report.interpolated == 0, "{report}");
    assert_eq!(report.figures.coverage.unwrap()[1], 0.0);
}

#[test]
fn files_that_cannot_be_used_are_refused_by_name() {
    let place = Place::new();
    let solution = place.solution();
    let refused = |text: &str| {
        let reference = place.write("bad.csv", text);
        let error = run(&Options { solution: solution.clone(), reference, ..Options::default() }).unwrap_err();
        assert!(error.is_unusable() && error.to_string().contains("bad.csv"), "{error}");
        error
    };
    assert!(refused("t_s,q_w\n1,2\n").to_string().contains("needs the column"));
    assert!(
        refused("t_s,q_w,q_x,q_y,q_z\n1,x,0,0,0\n2,,,,\n").to_string().contains("(1 invalid or empty, 1 unreadable)")
    );
    assert!(matches!(refused("t_s,q_w,q_x,q_y,q_z\n5,1,0,0,0\n6,1,0,0,0\n"), CompareError::Apart { .. }));
    let reference = place.0.path().join("nowhere.csv");
    let said = run(&Options { solution, reference, ..Options::default() }).unwrap_err().to_string();
    assert!(said.contains("nowhere.csv"), "{said}");
}
