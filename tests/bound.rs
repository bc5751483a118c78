//! `deckflex bound`: what it prints and writes, and what a user meets whose configuration or command line cannot be used.
#![allow(clippy::unwrap_used)]

mod common;

use common::{Place, shipped};
use serde_json::Value;
use std::fs;
use std::process::Output;

/// The configuration, the recording or the command line cannot be used.
const UNUSABLE: i32 = 2;

fn bound(place: &Place, arguments: &[&str]) -> Output {
    place.deckflex().arg("bound").args(arguments).current_dir(place.path("")).output().unwrap()
}

fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

#[test]
fn table_numbers_and_figure_are_of_the_length_that_was_asked_for() {
    let place = Place::new();
    place.write("demo.toml", &shipped("demo.toml"));
    let output = bound(&place, &["demo.toml", "--duration", "90s", "--svg", "sigma.svg", "--json", "sigma.json"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let said = String::from_utf8(output.stdout.clone()).unwrap();
    for words in
        ["area radar, gyros and accelerometers", "\n       30 s ", "\n    1.5 min ", "seeds 1, 2, 3, 4", "60 arcsec"]
    {
        assert!(said.contains(words), "{words:?}: {said}");
    }
    let told: Value = serde_json::from_str(&fs::read_to_string(place.path("sigma.json")).unwrap()).unwrap();
    let times = told["areas"][0]["rows"].as_array().unwrap().iter().map(|row| row["t_s"].as_f64().unwrap());
    assert_eq!(times.collect::<Vec<f64>>(), [30.0, 60.0, 90.0]);
    assert!(fs::read_to_string(place.path("sigma.svg")).unwrap().starts_with("<svg"));
}

#[test]
fn what_cannot_be_used_is_refused_as_by_the_other_commands() {
    let place = Place::new();
    let demo = shipped("demo.toml");
    place.write("misspelt.toml", &demo.replacen("lever_arm_m", "lever_arm", 1));
    place.write("stiff.toml", &demo.replacen("flexure =", "# flexure =", 1));
    for (name, words) in [
        ("misspelt.toml", "did you mean `lever_arm_m`"),
        ("stiff.toml", "`area[0].simulation.flexure` is missing"),
        ("nowhere.toml", "cannot read the configuration"),
    ] {
        let output = bound(&place, &[name, "--json", "sigma.json"]);
        assert_eq!(output.status.code(), Some(UNUSABLE), "{}", stderr(&output));
        assert!(stderr(&output).contains(name) && stderr(&output).contains(words), "{}", stderr(&output));
        assert!(output.stdout.is_empty() && !place.path("sigma.json").exists());
    }
    place.write("demo.toml", &demo);
    let output = bound(&place, &["demo.toml", "--svg", "nowhere/sigma.svg"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).contains("cannot write nowhere/sigma.svg"), "{}", stderr(&output));
    let output = bound(&place, &["demo.toml", "--duration", "long"]);
    assert_eq!(output.status.code(), Some(UNUSABLE));
}
