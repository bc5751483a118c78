//! What the told filter's covariance does with time, sensors and motion, and which configurations have none.
#![allow(clippy::unwrap_used)]

use bound::{Area, BoundError, Options, Point, Report};
use frames::unit::ARCMIN;
use std::fs;
use std::path::{Path, PathBuf};

fn shipped(name: &str) -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../config").join(name)).unwrap()
}

/// The text as a configuration in a folder of its own.
struct Place(tempfile::TempDir);

impl Place {
    fn new(text: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("ship.toml"), text).unwrap();
        Self(folder)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn options(&self, duration_s: Option<f64>) -> Options {
        Options { configuration: self.path("ship.toml"), duration_s, svg: None, json: None }
    }
}

fn run(text: &str, duration_s: f64) -> Report {
    bound::run(&Place::new(text).options(Some(duration_s))).unwrap()
}

/// Of the only area.
fn area(text: &str, duration_s: f64) -> Area {
    let mut report = run(text, duration_s);
    assert_eq!(report.areas.len(), 1);
    report.areas.remove(0)
}

fn refused(text: &str) -> String {
    match bound::run(&Place::new(text).options(Some(60.0))) {
        Err(BoundError::Configuration(error)) => error.to_string(),
        other => panic!("{other:?}"),
    }
}

fn at(area: &Area, t_s: f64) -> Point {
    *area.curve.iter().find(|point| point.t_s == t_s).unwrap()
}

fn without(text: &str, beginning: &str) -> String {
    let kept: Vec<&str> = text.lines().filter(|line| !line.starts_with(beginning)).collect();
    assert!(kept.len() < text.lines().count(), "nothing begins with {beginning}");
    kept.join("\n") + "\n"
}

#[test]
fn the_demonstrations_sigma_falls_with_time_about_every_axis() {
    let area = area(&shipped("demo.toml"), 1200.0);
    let rows = area.rows(1200.0);
    let times: Vec<f64> = rows.iter().map(|row| row.t_s).collect();
    assert_eq!(times, [30.0, 60.0, 120.0, 300.0, 600.0, 1200.0]);
    for pair in rows.windows(2) {
        let [before, after] = [0, 1].map(|i| pair[i].point.unwrap());
        for axis in 0..3 {
            assert!(after.total[axis] < before.total[axis], "{before:?} {after:?}");
            assert!(after.fixed[axis] < before.fixed[axis], "{before:?} {after:?}");
        }
    }
    let (first, last) = (rows[0].point.unwrap(), rows[5].point.unwrap());
    assert!((0..3).all(|axis| last.total[axis] < 0.5 * first.total[axis]), "{first:?} {last:?}");
    assert!(area.hardly_shown().is_empty() && !area.is_unobservable && area.left_out.is_empty());
}

/// The told filter of paper 000's ship had .49 arcmin about z, rms over 120 to 600 s, in a prototype of its own.
#[test]
fn the_bound_of_paper_000_about_z_is_the_known_one_and_accelerometers_show_the_level() {
    let text = shipped("papers/idam.toml");
    let both = area(&text, 600.0);
    assert!(both.has_accelerometers);
    let settled: Vec<f64> = both.curve.iter().filter(|point| point.t_s >= 120.0).map(|point| point.total[2]).collect();
    assert_eq!(settled.len(), 481);
    let rms = (settled.iter().map(|sigma| sigma * sigma).sum::<f64>() / 481.0).sqrt() / ARCMIN;
    assert!((rms / 0.49 - 1.0).abs() < 0.1, "{rms} arcmin");
    let gyros = area(&without(&text, "accel"), 600.0);
    assert!(!gyros.has_accelerometers);
    for t_s in [120.0, 300.0, 600.0] {
        let (with, without) = (at(&both, t_s).total, at(&gyros, t_s).total);
        assert!(with[0] < 0.9 * without[0] && with[1] < 0.9 * without[1], "{t_s} s: {with:?} {without:?}");
        assert!(with[2] < 1.05 * without[2], "{t_s} s: {with:?} {without:?}");
    }
}

#[test]
fn without_sway_the_bound_rests_on_the_survey_and_says_so() {
    let still = "amplitude_deg = 0, period_s = 8";
    let text = shipped("demo.toml").replace("amplitude_deg = 10, period_s = 8", still);
    let text = text.replace("amplitude_deg = 10, period_s = 10", still);
    let nothing = area(&text, 60.0);
    assert!(nothing.curve.is_empty() && nothing.is_unobservable);
    assert_eq!(nothing.hardly_shown(), ['x', 'y', 'z']);
    let survey = "[area.installation]\nrotation_vector_deg = [0.167, 0.167, 0.5]\nsigma_deg = 0.3\n\n[area.identifier]";
    let report = run(&text.replacen("[area.identifier]", survey, 1), 60.0);
    let surveyed = &report.areas[0];
    // gravity shows the level to accelerometers at rest; the heading has the earth's rate alone
    assert!(surveyed.is_unobservable, "{report}");
    assert_eq!(surveyed.hardly_shown(), ['z'], "{report}");
    assert!(at(surveyed, 60.0).total[2] > 0.5 * 0.3 * 60.0 * ARCMIN, "{report}");
    assert!(report.to_string().contains("does not show the installation"), "{report}");
}

#[test]
fn a_configuration_without_motion_or_truth_is_told_what_to_add() {
    let demo = shipped("demo.toml");
    let ship =
        ["[simulation]", "speed_knots", "latitude_deg", "longitude_deg", "course_deg", "roll", "pitch", "heading"];
    let still = ship.iter().fold(demo.clone(), |text, key| without(&text, key));
    let said = refused(&still);
    assert!(said.contains("ship.toml: the required key `simulation` is missing"), "{said}");
    assert!(said.contains("add [simulation]"), "{said}");
    let stiff = without(&demo, "flexure");
    let line = 1 + stiff.lines().position(|line| line.starts_with("[[area]]")).unwrap();
    let said = refused(&stiff);
    assert!(said.contains(&format!("ship.toml:{line}: ")), "{said}");
    assert!(
        said.contains("`area[0].simulation.flexure` is missing") && said.contains("add [area.simulation]"),
        "{said}"
    );
    let said = refused(&without(&still, "flexure"));
    assert!(said.contains("`simulation`") && said.contains("`area[0].simulation.flexure`"), "{said}");
}

#[test]
fn recorded_units_have_no_bound() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../config/replay.toml");
    let options = Options { configuration: folder, duration_s: None, svg: None, json: None };
    let said = bound::run(&options).unwrap_err().to_string();
    let line = 1 + shipped("replay.toml").lines().position(|line| line.starts_with("source")).unwrap();
    assert!(said.contains(&format!("replay.toml:{line}: main.source.kind = \"csv\"")), "{said}");
    assert!(said.contains("[simulation]") && said.contains("flexure"), "{said}");
}

#[test]
fn what_the_bound_leaves_out_is_said() {
    let text = shipped("demo.toml")
        + "coupling = { share = 0.3 }\nimpulses = { factor = 50, probability = 0.001, cell_ms = 10 }\n";
    let said = run(&text, 40.0).to_string();
    for part in ["area.simulation.coupling", "area.simulation.impulses"] {
        assert!(said.contains(&format!("({part})")), "{said}");
    }
}

#[test]
fn figure_and_numbers_are_those_of_the_report() {
    let place = Place::new(&(shipped("two_areas.toml") + "[simulation]\nspeed_knots = 15\n"));
    let (svg, json) = (place.path("sigma.svg"), place.path("sigma.json"));
    let report = bound::run(&Options { svg: Some(svg.clone()), json: Some(json.clone()), ..place.options(Some(45.0)) });
    let report = report.unwrap();
    let drawn = fs::read_to_string(svg).unwrap();
    assert!(drawn.starts_with("<svg") && drawn.trim_end().ends_with("</svg>") && !drawn.contains("NaN"));
    assert_eq!(drawn.matches("sigma (arcsec)").count(), 2);
    let told: serde_json::Value = serde_json::from_str(&fs::read_to_string(json).unwrap()).unwrap();
    for (area, told) in report.areas.iter().zip(told["areas"].as_array().unwrap()) {
        assert_eq!(told["name"], area.name.as_str());
        let last = told["rows"].as_array().unwrap().last().unwrap();
        assert_eq!(last["t_s"], 45.0);
        let sigma = at(area, 45.0).total[1] / frames::unit::ARCSEC;
        assert!((last["sigma_arcsec"][1].as_f64().unwrap() / sigma - 1.0).abs() < 1e-12);
    }
}

#[test]
fn an_output_that_cannot_be_written_is_found_out_before_the_work() {
    let place = Place::new(&shipped("demo.toml"));
    let svg = place.path("nowhere/sigma.svg");
    // so long that the test would not end
    let said = bound::run(&Options { svg: Some(svg.clone()), ..place.options(Some(1e8)) }).unwrap_err().to_string();
    assert!(said.starts_with(&format!("cannot write {}: ", svg.display())), "{said}");
}
