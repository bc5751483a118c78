//! What a user meets who mistypes: where the mistake is, what is allowed, exit code 2, and nothing started.
#![allow(clippy::unwrap_used)]

mod common;

use common::{Place, changed, recorded, shipped};
use std::fs;
use std::process::Output;

/// The configuration, the recording or the command line cannot be used.
const UNUSABLE: i32 = 2;

/// Each command that reads a configuration.
const COMMANDS: [&[&str]; 3] =
    [&["check"], &["launch", "--duration", "1s"], &["process", "--duration", "1s", "--out", "out"]];

fn deckflex(place: &Place, arguments: &[&str]) -> Output {
    place.deckflex().args(arguments).current_dir(place.path("")).output().unwrap()
}

fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

/// No domain has been made, nor the folder in which domains are made: no stage can have been started.
fn assert_nothing_started(place: &Place) {
    assert_eq!(fs::read_dir(place.path("run")).unwrap().count(), 0, "something was started");
}

/// Every command refuses the configuration, and its message holds all of the words.
fn assert_refused(place: &Place, configuration: &str, words: &[&str]) {
    for command in COMMANDS {
        let output = deckflex(place, &[command, &[configuration]].concat());
        let said = stderr(&output);
        assert_eq!(output.status.code(), Some(UNUSABLE), "{command:?}: {said}");
        for word in words {
            assert!(said.contains(word), "{command:?} does not say {word:?}: {said}");
        }
        assert!(output.stdout.is_empty(), "{command:?}");
        assert!(!place.path("out").exists(), "{command:?} has begun its output");
    }
    assert_nothing_started(place);
}

/// The line of a text in which something stands, as a message names it.
fn line_of(text: &str, what: &str) -> String {
    format!(":{}:", 1 + text.lines().position(|line| line.contains(what)).unwrap())
}

#[test]
fn a_misspelt_key_is_named_with_its_line_and_the_nearest_key() {
    let place = Place::new();
    for (right, wrong) in
        [("lever_arm_m", "lever_arm"), ("bias_deg_per_h", "bias_deg_per_hour"), ("window_s", "windows_s")]
    {
        let text = shipped("demo.toml").replacen(right, wrong, 1);
        place.write("demo.toml", &text);
        let line = format!("demo.toml{}", line_of(&text, wrong));
        assert_refused(&place, "demo.toml", &[&line, &format!("`{wrong}`"), &format!("did you mean `{right}`")]);
    }
}

#[test]
fn a_value_out_of_range_is_named_with_its_line_and_the_range() {
    let place = Place::new();
    for (key, value, range) in
        [("rate_hz", "-100", "10 to 1000"), ("rate_hz", "nan", "10 to 1000"), ("period_s", "0", "0.1 to 86400")]
    {
        let text = changed(&shipped("demo.toml"), &[(key, value)]);
        place.write("demo.toml", &text);
        let line = format!("demo.toml{}", line_of(&text, &format!("{key} = {value}")));
        assert_refused(&place, "demo.toml", &[&line, &format!("{key} = {value}"), range]);
    }
}

#[test]
fn a_file_that_is_not_there_is_named() {
    let place = Place::new();
    assert_refused(&place, "nowhere.toml", &["nowhere.toml", "cannot read the configuration"]);
    let text = shipped("replay.toml");
    place.write("replay.toml", &text);
    let line = format!("replay.toml{}", line_of(&text, "recordings/radar.csv"));
    assert_refused(
        &place,
        "replay.toml",
        &[&line, "recordings/main.csv", "recordings/radar.csv", "area[0].source.path"],
    );
}

#[test]
fn a_recording_without_rows_is_refused_by_name() {
    let place = Place::new();
    recorded(&place, 1, 1.0, 1.0, 1.0);
    let path = place.path("recordings/radar.csv");
    let whole = fs::read_to_string(&path).unwrap();
    let header = whole.lines().next().unwrap();
    for (left, reason) in [
        (String::new(), "the header is not recognised"),
        (header[..header.len() / 2].to_owned(), "the header is not recognised"),
        (header.to_owned(), "no row can be used"),
        (format!("{header}\n"), "no row can be used"),
        (format!("{header}\n0.01,1e-"), "no row can be used (1 refused)"),
    ] {
        fs::write(&path, left).unwrap();
        assert_refused(&place, "replay.toml", &["recordings/radar.csv", reason]);
    }
}

/// A recorder that is switched off leaves half a line, which must not pass for a number.
#[test]
fn of_a_recording_that_is_cut_only_the_last_line_is_lost() {
    let place = Place::new();
    recorded(&place, 1, 1.0, 1.0, 1.0);
    let path = place.path("recordings/main.csv");
    let whole = fs::read_to_string(&path).unwrap();
    fs::write(&path, &whole[..whole.len() - 3]).unwrap();
    let output = deckflex(&place, &["check", "replay.toml"]);
    let said = String::from_utf8(output.stdout.clone()).unwrap();
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(said.contains("first 100 rows") && said.contains("refused 1"), "{said}");
    assert!(deckflex(&place, &["process", "replay.toml", "--out", "out"]).status.success());
    let solutions = fs::read_to_string(place.path("out/solution_radar.csv")).unwrap();
    assert_eq!(solutions.lines().count(), 1 + 100);
    assert_nothing_started(&place);
}

#[test]
fn a_simulated_run_without_an_end_is_for_launch_only() {
    let place = Place::new();
    place.write("demo.toml", &shipped("demo.toml"));
    let output = deckflex(&place, &["process", "demo.toml", "--out", "out"]);
    assert_eq!(output.status.code(), Some(UNUSABLE));
    let said = stderr(&output);
    assert!(said.contains("--duration") && said.contains("run.duration_s"), "{said}");
    assert!(!place.path("out").exists());
}

#[test]
fn every_shipped_configuration_of_simulated_units_is_sound() {
    let place = Place::new();
    for name in ["demo.toml", "two_areas.toml"] {
        place.write(name, &shipped(name));
        let output = deckflex(&place, &["check", name]);
        let said = String::from_utf8(output.stdout.clone()).unwrap();
        assert!(output.status.success() && said.contains("sound") && said.contains("radar"), "{}", stderr(&output));
        assert_eq!(stderr(&output), "");
    }
    assert_nothing_started(&place);
}

#[test]
fn help_names_every_command() {
    let place = Place::new();
    let output = deckflex(&place, &["--help"]);
    let said = String::from_utf8(output.stdout.clone()).unwrap();
    assert!(output.status.success());
    let commands = [
        "launch",
        "process",
        "check",
        "bound",
        "recover",
        "export",
        "report",
        "simulate",
        "replay",
        "synchronise",
        "estimate",
        "identify",
        "record",
    ];
    for command in commands {
        assert!(said.contains(&format!("\n  {command} ")), "{command}: {said}");
        let output = deckflex(&place, &[command, "--help"]);
        assert!(output.status.success() && !output.stdout.is_empty(), "{command}");
    }
    for wrong in
        [&[][..], &["lunch"], &["launch"], &["launch", "demo.toml", "--duration", "long"], &["process", "demo.toml"]]
    {
        let output = deckflex(&place, wrong);
        assert_eq!(output.status.code(), Some(UNUSABLE), "{wrong:?}");
        assert!(stderr(&output).contains("Usage:") || stderr(&output).contains("--help"), "{wrong:?}");
    }
    assert_nothing_started(&place);
}

/// A stage that is started by hand says what it lacks.
#[test]
fn a_stage_needs_a_domain_and_a_known_area() {
    let place = Place::new();
    place.write("demo.toml", &shipped("demo.toml"));
    let output = deckflex(&place, &["estimate", "demo.toml", "--area", "rador", "--domain", "nowhere"]);
    assert_eq!(output.status.code(), Some(UNUSABLE));
    assert!(stderr(&output).contains("\"rador\""), "{}", stderr(&output));
    let output = deckflex(&place, &["estimate", "demo.toml", "--area", "radar", "--domain", "nowhere"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).contains("nowhere is not a domain"), "{}", stderr(&output));
    assert_nothing_started(&place);
}
