//! What the processes of a launch log: with real ones that are killed, starved and asked to stop.
#![allow(clippy::unwrap_used)]

mod common;

use common::launch::{Ended, Launch, one_at_a_time, send};
use common::run::Run;
use common::{Place, demo, shipped};
use libc::{SIGCONT, SIGINT, SIGKILL, SIGSTOP};
use std::path::Path;
use std::thread::sleep;
use std::time::Duration;

/// The number behind the name of a field.
fn number(line: &str, field: &str) -> f64 {
    let (_, rest) = line.split_once(&format!("  {field}=")).unwrap_or_else(|| panic!("no {field} in {line}"));
    rest.split_whitespace().next().unwrap().parse().unwrap()
}

/// The only line of its kind.
fn only<'a>(ended: &'a Ended, level: &str, process: &str, words: &[&str]) -> &'a str {
    let found = ended.logged(level, process, words);
    assert_eq!(found.len(), 1, "{level} {process} {words:?}: {}", ended.errors);
    found[0]
}

#[test]
fn a_run_tells_what_happened_to_it() {
    let run = Run::simulated(1000.0);
    let _alone = one_at_a_time();
    let mut launch = run.start("told");
    run.until_in_force(&mut launch);
    let killed = launch.stage("estimate", None);
    send(killed, SIGKILL);
    let again = launch.stage("estimate", Some(killed));
    // the stages behind it hear nothing meanwhile
    let source = launch.stage("simulate", None);
    sleep(Duration::from_millis(1500));
    send(source, SIGSTOP);
    sleep(Duration::from_millis(2500));
    send(source, SIGCONT);
    launch.eventually("rows again", |launch| run.latest(launch).filter(|(number, _)| *number > 0));
    sleep(Duration::from_millis(1000));
    launch.signal(SIGINT);
    let ended = launch.end();
    let report = ended.well();
    assert_eq!(ended.not_logged(), "");

    only(&ended, "INFO", "launch", &["a run begins", "areas=1", "configuration="]);
    only(&ended, "INFO", "launch", &["all stages are ready"]);
    let first = ended.logged("INFO", "estimate/radar", &["the solutions are valid"]);
    assert!(!first.is_empty(), "{}", ended.errors);
    assert!(!ended.logged("INFO", "estimate/radar", &["the first flexure model is in force", "id="]).is_empty());

    let died = only(&ended, "WARN", "launch", &["a stage has died", "process=\"estimate of area radar\""]);
    assert!(died.contains("signal: 9"), "{died}");
    let restarted = only(&ended, "WARN", "launch", &["a stage is started again", "process=\"estimate of area radar\""]);
    assert_eq!((number(restarted, "pid"), number(restarted, "restarts")), (f64::from(again), 1.0));
    only(&ended, "INFO", "estimate/radar", &["goes on from what the estimator before it kept"]);

    for (process, what) in [
        ("synchronise/radar", "samples of the main unit"),
        ("synchronise/radar", "samples of the area's unit"),
        ("estimate/radar", "pairs"),
        ("identify/radar", "solutions"),
    ] {
        let lost = only(&ended, "WARN", process, &[&format!("no {what} come any more")]);
        assert!((1.0..1.6).contains(&number(lost, "silent_s")), "{lost}");
        let back = only(&ended, "INFO", process, &[&format!("{what} come again")]);
        assert!((2.3..4.0).contains(&number(back, "silent_s")), "{back}");
    }
    only(&ended, "INFO", "launch", &["asked to stop"]);
    let over = only(&ended, "INFO", "launch", &["the run has ended in order"]);
    assert_eq!(number(over, "pairs"), report["pairs"].as_f64().unwrap());
    assert_eq!(number(over, "restarts"), 1.0);
}

/// Two seconds of the demonstration.
fn short(place: &Place, table: &str, name: &str, log: &[&str]) -> Ended {
    let path = place.write(&format!("{name}.toml"), &format!("{}\n{table}", demo(1, 1.0)));
    Launch::start_with(place, name, &path, Some("2s"), log).end()
}

#[test]
fn the_level_is_the_configurations_unless_the_command_line_says_another() {
    let place = Place::new();
    let _alone = one_at_a_time();
    let quiet = short(&place, "[log]\nlevel = \"error\"\n", "quiet", &[]);
    quiet.well();
    assert_eq!(quiet.errors, "");
    let all = short(&place, "[log]\nlevel = \"error\"\n", "all", &["--log", "debug"]);
    all.well();
    for process in ["simulate", "synchronise/radar", "estimate/radar", "identify/radar"] {
        only(&all, "DEBUG", process, &["ready", "pid=", "scheduling="]);
        assert_eq!(number(only(&all, "DEBUG", process, &["stopped", "ended=true"]), "taken"), 201.0);
    }
    assert_eq!(all.not_logged(), "");
}

#[test]
fn a_log_for_a_journal_that_is_not_there_goes_to_the_error_output() {
    if Path::new("/run/systemd/journal/socket").exists() {
        return;
    }
    let place = Place::new();
    let _alone = one_at_a_time();
    let ended = short(&place, "[log]\nto = \"journal\"\n", "journal", &[]);
    ended.well();
    for process in ["launch", "estimate/radar"] {
        only(&ended, "WARN", process, &["there is no journal here", "socket=/run/systemd/journal/socket", "reason="]);
    }
    only(&ended, "INFO", "launch", &["the run has ended in order"]);
}

#[test]
fn a_level_or_a_destination_that_does_not_exist_is_refused() {
    let place = Place::new();
    for (key, value, allowed) in [
        ("level", "\"loud\"", "must be one of \"error\", \"warn\", \"info\", \"debug\""),
        ("to", "\"syslog\"", "must be one of \"stderr\", \"journal\""),
        ("file", "\"x.log\"", "unknown key `file` in [log]"),
    ] {
        let path = place.write("wrong.toml", &format!("{}\n[log]\n{key} = {value}\n", shipped("demo.toml")));
        let output = place.deckflex().arg("check").arg(&path).output().unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert!(said.contains(allowed) && (key == "file" || said.contains(&format!("log.{key} = {value}"))), "{said}");
    }
    let path = place.write("demo.toml", &shipped("demo.toml"));
    let output = place.deckflex().arg("launch").arg(&path).args(["--log", "loud"]).output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(said.contains("error, warn, info, debug"), "{said}");
}
