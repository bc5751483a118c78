//! Real processes, killed, stopped and interrupted: the launch goes on by itself, nothing stays behind, and every row is still right.
//!
//! Counts and bits are asserted, never times. Which rows there are depends on when a process died; that they are right does not: they
//! are computed again from what they say themselves, see [`common::retrace`].
#![allow(clippy::unwrap_used)]

mod common;

use common::launch::{Ended, Launch, in_shared_memory, of_stage, one_at_a_time, processes, send};
use common::retrace::{Missing, Row, Story, holes, retrace, rows, sets};
use common::{Place, configuration, demo, first_difference, offline, recorded};
use libc::{SIGCONT, SIGINT, SIGKILL, SIGSTOP};
use pipeline::configuration::Configuration;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::thread::sleep;
use std::time::Duration;

/// What the rows of a run can be, given that one stage was killed once. At least one of the stories has to give them, bit by bit.
///
/// - A source that is killed leaves a hole in the samples; the processes behind it live on. Its two units' samples of an instant are
///   published one after the other, so the first hole may have the one and not the other.
/// - A synchroniser that is killed loses samples too, and the next one starts an epoch at the first sample that it gets.
/// - An estimator that is killed loses pairs, and the next one starts with registering at the first pair that it gets, with the set
///   of parameters that the rows name.
/// - An identifier that is killed costs no row. The next one's window begins with the first solution that it gets, which is the
///   length of a first window, or one or two periods more where that gave nothing, before its first set: one of those in force.
/// - In a new domain everything starts anew, and what was under way in the old one is lost.
fn stories(stage: &str, replaced: bool, rows: &BTreeMap<u64, Row>, configuration: &Configuration) -> Vec<Story> {
    let late = *rows.keys().next().unwrap_or(&0);
    let anew = holes(rows).first().map(|(_, after)| *after).or((late > 0).then_some(late));
    let samples = Story { missing: Missing::Samples, ..Story::default() };
    if replaced {
        return vec![Story { synchroniser: anew, estimator: anew, identifier: anew, ..samples }];
    }
    match stage {
        "simulate" | "replay" => vec![samples, Story { missing: Missing::SamplesButOne, ..samples }],
        "synchronise" => vec![Story { synchroniser: anew, ..samples }],
        "estimate" => vec![Story { estimator: anew, ..Story::default() }],
        "identify" => {
            let told = &configuration.areas[0].identifier;
            let samples = |seconds: f64| (seconds * configuration.rate_hz).round() as u64;
            let lengths = [0, 1, 2].map(|periods| samples(told.minimum_s) + periods * samples(told.period_s));
            let begins = sets(rows).into_iter().flat_map(|id| lengths.map(|length| id.checked_sub(length)));
            let first = begins.map(|identifier| Story { identifier, ..Story::default() });
            std::iter::once(Story::default()).chain(first).collect()
        }
        other => panic!("there is no stage {other}"),
    }
}

/// Asserts that one of the stories gives the rows; gives it, and how many parameter sets were learnt in it.
fn assert_right(configuration: &Configuration, solutions: &str, stories: &[Story]) -> (Story, u64) {
    let mut differences = Vec::new();
    for story in stories {
        match retrace(configuration, solutions, story) {
            Ok(sets) => return (*story, sets),
            Err(difference) => differences.push(format!("{story:?}: {difference}")),
        }
    }
    panic!("no story gives these rows:\n{}", differences.join("\n"));
}

/// Asserts that of all stages only this one has been restarted, and that the rows which are missing have been counted as lost.
fn assert_counts(ended: &Ended, stage: &str, rows: &BTreeMap<u64, Row>) {
    let report = ended.well();
    assert!(of_stage(report, stage, "restarts") >= 1, "{stage} was not restarted: {report:#}");
    let stages = report["stages"].as_array().unwrap().iter().map(|row| row["name"].as_str().unwrap());
    for other in stages.filter(|other| *other != stage) {
        assert_eq!(of_stage(report, other, "restarts"), 0, "{other}, when {stage} was killed: {}", ended.errors);
    }
    let area = &report["end_to_end"][0];
    assert_eq!(area["pairs"].as_u64().unwrap() as usize, rows.len());
    let missing: u64 = holes(rows).iter().map(|(before, after)| after - before - 1).sum();
    assert_eq!(area["lost"].as_u64().unwrap(), missing);
    let summary: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(ended.out.join("summary.json")).unwrap()).unwrap();
    assert_eq!(summary["areas"][0]["samples"].as_u64().unwrap() as usize, rows.len());
}

/// A run of a few thousand samples in a few seconds.
struct Run {
    place: Place,
    path: PathBuf,
    duration: String,
    configuration: Configuration,
    last: u64,
}

impl Run {
    /// Of the simulator, at the pace of life.
    fn simulated(seconds: f64) -> Self {
        let place = Place::new();
        let path = place.write("demo.toml", &demo(11, 1.0));
        Self::new(place, path, seconds)
    }

    /// Of recordings, faster.
    fn recorded(seconds: f64, pace: f64, lead_s: f64) -> Self {
        let place = Place::new();
        let path = recorded(&place, 12, seconds, pace, lead_s);
        Self::new(place, path, seconds)
    }

    fn new(place: Place, path: PathBuf, seconds: f64) -> Self {
        let configuration = configuration(&path, seconds);
        let last = (seconds * configuration.rate_hz) as u64;
        Self { place, path, duration: format!("{}ms", 1000.0 * seconds), configuration, last }
    }

    fn start(&self, name: &str) -> Launch {
        Launch::start(&self.place, name, &self.path, Some(&self.duration))
    }

    fn rows(&self, solutions: &str) -> BTreeMap<u64, Row> {
        rows(&self.configuration, solutions)
    }

    /// The last row that has been written by now; there may be some more that have not reached the file.
    fn latest(&self, launch: &Launch) -> Option<(u64, Row)> {
        self.rows(&launch.written("radar")?).pop_last()
    }

    /// Waits until a parameter set is in force, and gives the number of a row with it.
    fn until_in_force(&self, launch: &mut Launch) -> u64 {
        launch.eventually("parameter set in force", |launch| {
            self.latest(launch).filter(|(_, row)| row.params_id != 0).map(|(number, _)| number)
        })
    }

    /// Asserts that every row is there.
    fn assert_complete(&self, rows: &BTreeMap<u64, Row>) {
        assert_eq!(holes(rows), []);
        assert_eq!((rows.keys().next(), rows.keys().last()), (Some(&0), Some(&self.last)));
    }

    /// Kills a stage when everything is at work; the domain and the other stages survive.
    ///
    /// Gives the rows, the number of one from before the kill, and what happened.
    fn kill(&self, stage: &str) -> (String, BTreeMap<u64, Row>, u64, Story) {
        let _alone = one_at_a_time();
        let mut launch = self.start(stage);
        let before = self.until_in_force(&mut launch);
        let pid = launch.stage(stage, None);
        send(pid, SIGKILL);
        launch.stage(stage, Some(pid));
        let ended = launch.end();
        let solutions = ended.solutions("radar");
        let rows = self.rows(&solutions);
        assert_counts(&ended, stage, &rows);
        assert_eq!(ended.domains.len(), 1, "all topics exist, so a kill cannot poison them: {}", ended.errors);
        assert!(rows.contains_key(&0) && rows.contains_key(&self.last), "the run has a beginning and an end");
        assert!(holes(&rows).iter().all(|(last, _)| *last >= before), "nothing was lost before the kill");
        let stories = stories(stage, false, &rows, &self.configuration);
        let (story, learnt) = assert_right(&self.configuration, &solutions, &stories);
        // an identifier that lived on has learnt from every window of the rows
        assert!(stage == "identify" || ended.well()["parameters"] == learnt, "{learnt} sets were to be learnt");
        (solutions, rows, before, story)
    }
}

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
fn a_killed_estimator_registers_anew() {
    let run = Run::recorded(28.0, 4.0, 4.0);
    let (solutions, rows, ..) = run.kill("estimate");
    assert_one_hole(&run, &rows);
    // the identifier has handed it the last set from before the hole, and not only together with the next one
    let (before, after) = holes(&rows)[0];
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

/// A stage that is killed within 60 ms of its start dies in the middle of opening its topics. Where one is left half made, only a
/// new domain helps, and the launcher has to make it by itself.
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
        eprintln!("{stage} killed after {delay_ms} ms: {} domains, {} rows", ended.domains.len(), rows.len());
    }
}

const MOMENTS_MS: [u64; 8] = [0, 5, 9, 13, 18, 26, 38, 60];

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
