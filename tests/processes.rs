//! Real processes, killed, stopped and interrupted: the launch goes on by itself, nothing stays behind, and every row is still right.
//!
//! Counts and bits are asserted, never times. Which rows there are depends on when a process died; that they are right does not: they
//! are computed again from what they say themselves, see [`common::retrace`].
#![allow(clippy::unwrap_used)]

mod common;

use common::launch::{Launch, in_shared_memory, of_stage, one_at_a_time, processes, send};
use common::retrace::{Row, Story, holes, retrace, sets};
use common::run::{Run, assert_counts, assert_right, stories};
use common::{Place, configuration, demo, first_difference, offline};
use libc::{SIGCONT, SIGINT, SIGKILL, SIGSTOP};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::thread::sleep;
use std::time::Duration;

/// Asserts that rows are missing at one place only, long enough before the end for what comes after to be worth comparing.
fn assert_one_hole(run: &Run, rows: &BTreeMap<u64, Row>) {
    let holes = holes(rows);
    assert!(holes.len() == 1 && holes[0].1 + 400 < run.last, "{holes:?}");
}

#[test]
fn a_killed_simulator_goes_on_at_the_present() {
    let run = Run::simulated(15.0);
    let (_, rows, ..) = run.kill("simulate");
    assert_one_hole(&run, &rows);
}

#[test]
fn a_killed_replay_goes_on_at_the_present() {
    let run = Run::recorded(24.0, 4.0, 4.0);
    let (_, rows, ..) = run.kill("replay");
    assert_one_hole(&run, &rows);
}

#[test]
fn a_killed_synchroniser_starts_an_epoch() {
    let run = Run::recorded(24.0, 4.0, 4.0);
    let (_, rows, ..) = run.kill("synchronise");
    assert_one_hole(&run, &rows);
}

#[test]
fn a_killed_estimator_goes_on() {
    let run = Run::recorded(28.0, 4.0, 4.0);
    let (solutions, rows, _, story) = run.kill("estimate");
    assert_one_hole(&run, &rows);
    assert!(story.checkpoint.is_some(), "it registered anew");
    // the identifier has handed it the last set from before the hole, and not only together with the next one
    let (before, after) = holes(&rows)[0];
    assert!(rows.range(after..).take(20).any(|(_, row)| row.valid), "no solution at once");
    let (handed, row) = rows.range(after..).find(|(_, row)| row.params_id != 0).unwrap();
    assert!(row.params_id <= before, "no set from before the hole {before} to {after} but {}", row.params_id);
    assert!(sets(&rows).iter().all(|id| *id <= before || id > handed), "in force at {handed} only");
    // the comparison must notice: an estimator that had lived on would have given other bits
    assert!(retrace(&run.configuration, &solutions, &Story::default()).is_err());
}

#[test]
fn a_killed_identifier_costs_no_row() {
    let run = Run::recorded(26.0, 4.0, 4.0);
    let (solutions, rows, before, story) = run.kill("identify");
    run.assert_complete(&rows);
    let begin = story.identifier.expect("an identifier that had lived on would have given the same sets");
    assert!(begin > before, "the new window begins before the kill");
    // up to the first set that the kill has changed it is the run that it would have been
    let offline = offline(&run.configuration).0;
    let would_have_been = run.rows(&offline);
    let same = rows.iter().take_while(|(number, row)| row.params_id == would_have_been[number].params_id).count();
    assert!(before < same as u64 && same < rows.len());
    let beginning = |text: &str| text.lines().take(1 + same).collect::<Vec<&str>>().join("\n");
    assert_eq!(first_difference(&beginning(&solutions), &beginning(&offline)), None);
}

/// A stage that is killed within 60 ms of its start dies in the middle of opening its topics. Should something be left half made, only
/// a new domain helps, and the launcher has to make it by itself.
fn kill_at_start(run: &Run, stage: &str, delays_ms: &[u64]) {
    let _alone = one_at_a_time();
    for delay_ms in delays_ms {
        let mut launch = run.start(&format!("{stage}_{delay_ms}"));
        let pid = launch.stage(stage, None);
        sleep(Duration::from_millis(*delay_ms));
        send(pid, SIGKILL);
        let ended = launch.end();
        let (report, replaced) = (ended.well(), ended.domains.len() > 1);
        let solutions = ended.solutions("radar");
        let rows = run.rows(&solutions);
        assert!(of_stage(report, stage, "restarts") >= 1);
        if !replaced {
            assert_counts(&ended, stage, &rows);
        }
        assert!(holes(&rows).len() <= 1, "{:?}", holes(&rows));
        assert_right(&run.configuration, &solutions, &stories(stage, replaced, &rows, &run.configuration));
        if replaced {
            eprintln!("{stage}, killed after {delay_ms} ms, poisoned its domain: {}", ended.errors);
        }
    }
}

const MOMENTS_MS: [u64; 6] = [0, 6, 11, 17, 28, 60];

#[test]
fn a_simulator_may_be_killed_at_its_start() {
    kill_at_start(&Run::simulated(1.0), "simulate", &[0, 10, 20]);
}

#[test]
fn a_replay_may_be_killed_at_its_start() {
    kill_at_start(&Run::recorded(10.0, 8.0, 1.0), "replay", &[5, 15, 60]);
}

#[test]
fn a_synchroniser_may_be_killed_at_its_start() {
    kill_at_start(&Run::recorded(10.0, 8.0, 1.0), "synchronise", &MOMENTS_MS);
}

#[test]
fn an_estimator_may_be_killed_at_its_start() {
    kill_at_start(&Run::recorded(10.0, 8.0, 1.0), "estimate", &MOMENTS_MS);
}

#[test]
fn an_identifier_may_be_killed_at_its_start() {
    kill_at_start(&Run::recorded(10.0, 8.0, 1.0), "identify", &MOMENTS_MS);
}

#[test]
fn a_launch_says_for_whom_it_waits() {
    let run = Run::simulated(1.0);
    let _alone = one_at_a_time();
    let mut launch = run.start("waits");
    let pid = launch.stage("identify", None);
    send(pid, SIGSTOP);
    launch.eventually("complaint", |launch| {
        launch.errors().contains(r#"the source cannot start yet  waits_for="identify of area radar""#).then_some(())
    });
    send(pid, SIGCONT);
    let ended = launch.end();
    ended.well();
    run.assert_complete(&run.rows(&ended.solutions("radar")));
}

/// The launcher sleeps while the source dies and the run's time goes by: the next source has nothing to send but the end.
#[test]
fn a_source_that_dies_before_its_end_marks_is_restarted_to_give_them() {
    let run = Run::simulated(3.0);
    let _alone = one_at_a_time();
    let mut launch = run.start("late");
    launch.eventually("row", |launch| run.latest(launch));
    let pid = launch.stage("simulate", None);
    launch.signal(SIGSTOP);
    send(pid, SIGKILL);
    sleep(Duration::from_secs(3));
    launch.signal(SIGCONT);
    let ended = launch.end();
    let solutions = ended.solutions("radar");
    let rows = run.rows(&solutions);
    assert_counts(&ended, "simulate", &rows);
    assert_eq!(holes(&rows), []);
    assert!(rows.contains_key(&0) && !rows.contains_key(&run.last), "the source was to die before its end");
    assert_right(&run.configuration, &solutions, &stories("simulate", false, &rows, &run.configuration));
}

/// A topic that exists is opened and not made, and a process that dies while it opens one does no harm.
#[test]
fn every_topic_exists_before_the_first_stage() {
    let run = Run::simulated(3.0);
    let _alone = one_at_a_time();
    let mut launch = run.start("topics");
    launch.eventually("stage", |launch| launch.stages().pop());
    let [root] = &run.place.domains()[..] else { panic!("one domain") };
    let topics = || fs::read_dir(root.join("services")).unwrap().count();
    let first = topics();
    launch.eventually("row", |launch| run.latest(launch));
    assert_eq!(first, topics());
    assert_eq!(launch.end().well()["pairs"], run.last + 1);
}

/// Leaves every topic of a domain as a process leaves the one that it dies over: there, but without its description.
fn poison(root: &Path) {
    for file in fs::read_dir(root.join("services")).unwrap().flatten() {
        fs::remove_file(file.path()).unwrap();
        fs::write(file.path(), "").unwrap();
    }
}

#[test]
fn a_poisoned_domain_is_replaced_in_the_middle_of_a_run() {
    let run = Run::recorded(48.0, 4.0, 4.0);
    let _alone = one_at_a_time();
    let mut launch = run.start("poisoned");
    run.until_in_force(&mut launch);
    let [old] = &run.place.domains()[..] else { panic!("one domain") };
    poison(old);
    send(launch.stage("synchronise", None), SIGKILL);
    let ended = launch.end();
    let solutions = ended.solutions("radar");
    let rows = run.rows(&solutions);
    assert_counts(&ended, "synchronise", &rows);
    assert!(ended.domains.len() == 2 && ended.domains.contains(old), "{:?}: {}", ended.domains, ended.errors);
    assert_one_hole(&run, &rows);
    assert_right(&run.configuration, &solutions, &stories("synchronise", true, &rows, &run.configuration));
}

/// A stage that stands still for a while, as on a host that has other things to do, works off its queue and costs nothing. The fast
/// stages never wait for the identifier.
#[test]
fn a_stopped_stage_catches_up() {
    let run = Run::recorded(32.0, 4.0, 4.0);
    let _alone = one_at_a_time();
    let mut launch = run.start("stopped");
    let mut written = run.until_in_force(&mut launch);
    for stage in ["synchronise", "estimate"] {
        let pid = launch.stage(stage, None);
        send(pid, SIGSTOP);
        sleep(Duration::from_millis(500));
        send(pid, SIGCONT);
        (written, _) =
            launch.eventually("rows", |launch| run.latest(launch).filter(|(number, _)| *number > written + 300));
    }
    let pid = launch.stage("identify", None);
    send(pid, SIGSTOP);
    // far more than any queue of the operating system's holds events
    launch.eventually("rows without the identifier", |launch| {
        run.latest(launch).filter(|(number, _)| *number > written + 1000)
    });
    send(pid, SIGCONT);
    let ended = launch.end();
    let report = ended.well();
    for stage in ["replay", "synchronise", "estimate", "identify"] {
        assert_eq!(of_stage(report, stage, "restarts"), 0, "{stage}: {}", ended.errors);
        assert_eq!(of_stage(report, stage, "lost"), 0, "{stage}");
        assert_eq!(of_stage(report, stage, "overflow"), 0, "{stage}");
        assert_eq!(of_stage(report, stage, "in"), run.last + 1, "{stage}");
    }
    let solutions = ended.solutions("radar");
    run.assert_complete(&run.rows(&solutions));
    let (_, learnt) = assert_right(&run.configuration, &solutions, &[Story::default()]);
    assert_eq!(report["parameters"], learnt);
}

#[test]
fn an_interrupt_ends_a_launch_in_order() {
    let run = Run::simulated(1000.0);
    let _alone = one_at_a_time();
    let mut launch = run.start("interrupted");
    launch.eventually("hundred rows", |launch| run.latest(launch).filter(|(number, _)| *number > 100));
    launch.signal(SIGINT);
    let ended = launch.end();
    let report = ended.well();
    let solutions = ended.solutions("radar");
    assert!(solutions.ends_with('\n'));
    let count = solutions.lines().count() - 1;
    for stage in ["simulate", "synchronise", "estimate", "identify"] {
        assert_eq!(of_stage(report, stage, "restarts"), 0, "{stage}: {}", ended.errors);
        assert_eq!(of_stage(report, stage, "in") as usize, count, "{stage} has not worked off everything");
    }
    let offline = offline(&configuration(&run.path, (count - 1) as f64 / 100.0)).0;
    assert_eq!(first_difference(&solutions, &offline), None, "an interrupted run is a short one");
    let summary = fs::read_to_string(ended.out.join("summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_str(&summary).unwrap();
    assert_eq!(summary["areas"][0]["samples"].as_u64().unwrap() as usize, count);
}

#[test]
fn an_interrupt_before_the_first_sample_ends_a_launch_too() {
    let run = Run::simulated(1000.0);
    let _alone = one_at_a_time();
    let mut launch = run.start("interrupted");
    launch.stage("identify", None);
    launch.signal(SIGINT);
    let ended = launch.end();
    ended.well();
    assert!(ended.solutions("radar").starts_with("t_s,"));
}

#[test]
fn two_launches_do_not_meet() {
    let place = Place::new();
    let _alone = one_at_a_time();
    let demos = [21, 22].map(|seed| place.write(&format!("demo_{seed}.toml"), &demo(seed, 2.0)));
    let launches = [0, 1].map(|i| Launch::start(&place, ["first", "second"][i], &demos[i], Some("12s")));
    let mut domains = Vec::new();
    for (launch, path) in launches.into_iter().zip(&demos) {
        let ended = launch.end();
        assert_eq!(ended.well()["late_parameters"], 0, "the host is too slow for a comparison");
        assert_eq!(first_difference(&ended.solutions("radar"), &offline(&configuration(path, 12.0)).0), None);
        domains.extend(ended.domains);
    }
    assert!(domains.len() == 2 && domains[0] != domains[1], "{domains:?}");
}

/// Processes that were started for a domain.
fn of_domain(root: &Path) -> usize {
    let root = root.to_str().unwrap();
    processes().iter().filter(|process| process.arguments.iter().any(|argument| argument == root)).count()
}

/// At its start as well as at work: the stages leave by themselves, and the next launch clears up.
#[test]
fn a_killed_launcher_takes_its_stages_along_and_the_next_one_clears_up() {
    let run = Run::simulated(1.0);
    let _alone = one_at_a_time();
    let mut left = Vec::new();
    for (name, wanted) in [("one", 1), ("two", 2), ("all", 3), ("with_source", 4)] {
        let mut launch = run.start(name);
        launch.eventually("stage", |launch| Some(()).filter(|()| launch.stages().len() >= wanted));
        let root = run.place.domains().into_iter().find(|root| !left.contains(root)).unwrap();
        launch.signal(SIGKILL);
        let ended = launch.end();
        assert!(!ended.status.success() && ended.report.is_none());
        let start = std::time::Instant::now();
        while of_domain(&root) > 0 {
            assert!(start.elapsed() < Duration::from_secs(60), "{} stages outlive their launcher", of_domain(&root));
            sleep(Duration::from_millis(5));
        }
        assert!(root.exists(), "a killed launcher cannot clear up");
        left.push(root);
    }
    run.start("next").end().well();
    for root in left {
        assert!(!root.exists() && in_shared_memory(&root).is_empty(), "{} is left", root.display());
    }
}
