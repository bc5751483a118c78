//! A run with one stage killed, and what its rows and counts must be then.

use super::launch::{Ended, Launch, of_stage, one_at_a_time, send};
use super::retrace::{Missing, Row, Story, holes, retrace, rows, sets};
use super::{Place, configuration, demo, recorded};
use libc::SIGKILL;
use pipeline::configuration::Configuration;
use std::collections::BTreeMap;
use std::fs;
use std::path::PathBuf;

/// What the rows of a run can be, given that one stage was killed once. At least one of the stories has to give them, bit by bit.
///
/// - A source that is killed leaves a hole in the samples; the processes behind it live on. Its two units' samples of an instant are
///   published one after the other, so the first hole may have the one and not the other.
/// - A synchroniser that is killed loses samples too, and the next one starts an epoch at the first sample that it gets.
/// - An estimator that is killed loses pairs, and the next one goes on at the first pair that it gets, from one of the last checkpoints, or
///   by registering where there was none, with the set of parameters that the rows name.
/// - An identifier that is killed costs no row. The next one's window begins with the first solution that it gets, which is the
///   length of a first window, or one or two periods more where that gave nothing, before its first set: one of those in force.
/// - In a new domain everything starts anew, and what was under way in the old one is lost.
pub fn stories(stage: &str, replaced: bool, rows: &BTreeMap<u64, Row>, configuration: &Configuration) -> Vec<Story> {
    let late = *rows.keys().next().unwrap_or(&0);
    let anew = holes(rows).first().map(|(_, after)| *after).or((late > 0).then_some(late));
    let samples = Story { missing: Missing::Samples, ..Story::default() };
    if replaced {
        return vec![Story { synchroniser: anew, estimator: anew, identifier: anew, ..samples }];
    }
    match stage {
        "simulate" | "replay" => vec![samples, Story { missing: Missing::SamplesButOne, ..samples }],
        "synchronise" => vec![Story { synchroniser: anew, ..samples }],
        "estimate" => {
            let from = |checkpoint| Story { estimator: anew, checkpoint, ..Story::default() };
            vec![from(Some(0)), from(Some(1)), from(None)]
        }
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
pub fn assert_right(configuration: &Configuration, solutions: &str, stories: &[Story]) -> (Story, u64) {
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
pub fn assert_counts(ended: &Ended, stage: &str, rows: &BTreeMap<u64, Row>) {
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
pub struct Run {
    pub place: Place,
    pub path: PathBuf,
    duration: String,
    pub configuration: Configuration,
    /// Number of the last sample.
    pub last: u64,
}

impl Run {
    /// Of the simulator, at the pace of life.
    pub fn simulated(seconds: f64) -> Self {
        let place = Place::new();
        let path = place.write("demo.toml", &demo(11, 1.0));
        Self::new(place, path, seconds)
    }

    /// Of recordings, faster.
    pub fn recorded(seconds: f64, pace: f64, lead_s: f64) -> Self {
        let place = Place::new();
        let path = recorded(&place, 12, seconds, pace, lead_s);
        Self::new(place, path, seconds)
    }

    fn new(place: Place, path: PathBuf, seconds: f64) -> Self {
        let configuration = configuration(&path, seconds);
        let last = (seconds * configuration.rate_hz) as u64;
        Self { place, path, duration: format!("{}ms", 1000.0 * seconds), configuration, last }
    }

    pub fn start(&self, name: &str) -> Launch {
        Launch::start(&self.place, name, &self.path, Some(&self.duration))
    }

    pub fn rows(&self, solutions: &str) -> BTreeMap<u64, Row> {
        rows(&self.configuration, solutions)
    }

    /// The last row that has been written by now; there may be some more that have not reached the file.
    pub fn latest(&self, launch: &Launch) -> Option<(u64, Row)> {
        self.rows(&launch.written("radar")?).pop_last()
    }

    /// Waits until a parameter set is in force, and gives the number of a row with it.
    pub fn until_in_force(&self, launch: &mut Launch) -> u64 {
        launch.eventually("parameter set in force", |launch| {
            self.latest(launch).filter(|(_, row)| row.params_id != 0).map(|(number, _)| number)
        })
    }

    /// Asserts that every row is there.
    pub fn assert_complete(&self, rows: &BTreeMap<u64, Row>) {
        assert_eq!(holes(rows), []);
        assert_eq!((rows.keys().next(), rows.keys().last()), (Some(&0), Some(&self.last)));
    }

    /// Kills a stage when everything is at work; the domain and the other stages survive.
    ///
    /// Gives the rows, the number of one from before the kill, and what happened.
    pub fn kill(&self, stage: &str) -> (String, BTreeMap<u64, Row>, u64, Story) {
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
