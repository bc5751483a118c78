//! Recordings from the middle of a run: what the estimators' states in them are good for.
#![allow(clippy::unwrap_used)]

mod common;

use common::launch::{Launch, one_at_a_time, send};
use common::{Place, first_difference, recorded};
use libc::SIGINT;
use recording::{About, Ending, Event, Reader, Record, Writer};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn files(folder: &Path) -> Vec<PathBuf> {
    let mut files: Vec<PathBuf> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    files
}

/// Goes through a recorded run again, by its first file or its folder.
fn again(place: &Place, what: &Path, name: &str) -> (Output, PathBuf) {
    let out = place.path(name);
    let arguments = ["process", what.to_str().unwrap(), "--out", out.to_str().unwrap()];
    (place.deckflex().args(arguments).output().unwrap(), out.join("solution_radar.csv"))
}

/// Asserts that a replay starts from a state and gives the last of the run's solutions to the bit; gives how many.
fn assert_tail(place: &Place, what: &Path, name: &str, all: &str) -> usize {
    let (output, solutions) = again(place, what, name);
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(output.status.success(), "{said}{}", String::from_utf8_lossy(&output.stderr));
    let solutions = fs::read_to_string(solutions).unwrap();
    let count = solutions.lines().count() - 1;
    assert!(said.contains("area radar: from behind ") && !said.contains("differ"), "{said}");
    assert!(said.contains(&format!("area radar: {count} solutions are the recorded ones to the bit")), "{said}");
    let rows: Vec<&str> = all.lines().collect();
    let first = solutions.lines().nth(1).unwrap();
    let from = rows.iter().position(|row| *row == first).expect("the first row is one of the run's");
    let part = [&rows[..1], &rows[from..(from + count).min(rows.len())]].concat().join("\n") + "\n";
    assert_eq!(first_difference(&part, &solutions), None, "{said}");
    count
}

/// The value behind an argument.
fn told(arguments: &[String], key: &str) -> String {
    arguments[arguments.iter().position(|argument| argument == key).unwrap() + 1].clone()
}

/// By the default estimator, whose first minutes are in its state too.
#[test]
fn a_recorder_that_comes_later_records_what_can_be_replayed_to_the_bit() {
    let place = Place::new();
    let path = recorded(&place, 41, 60.0, 4.0, 4.0);
    let text = fs::read_to_string(&path).unwrap().replace("matching = \"so3\"", "matching = \"deck\"");
    fs::write(&path, text).unwrap();
    let folder = place.path("late");
    let live = {
        let _alone = one_at_a_time();
        let mut launch = Launch::start(&place, "live", &path, None);
        launch.eventually("a valid row", |launch| {
            let row = launch.written("radar")?;
            (row.lines().nth(1)?.split(',').nth(1) == Some("1")).then_some(())
        });
        let stage = launch.stages().into_iter().find(|stage| stage.arguments[1] == "estimate").unwrap();
        let mut command: Command = place.deckflex();
        command.arg("record").arg(&path).arg("--folder").arg(&folder);
        for key in ["--domain", "--run-id"] {
            command.args([key, &told(&stage.arguments, key)]);
        }
        let mut recorder = command.spawn().unwrap();
        let live = launch.end();
        if recorder.try_wait().unwrap().is_none() {
            send(recorder.id(), SIGINT);
        }
        assert!(recorder.wait().unwrap().success());
        live
    };
    // the recorder, which is not of the launch, may have outlived its domain
    assert!(live.status.success(), "{}", live.errors);
    let all = live.solutions("radar");
    let [file] = &files(&folder)[..] else { panic!("one file") };
    let count = assert_tail(&place, &folder, "again", &all);
    assert_eq!(assert_tail(&place, file, "by_name", &all), count);
    assert!(count > 1000, "{count} solutions");
}

/// What a file says at its beginning and its end, and its messages.
fn read(path: &Path) -> (About, Vec<(String, Record)>, Ending) {
    let bytes = fs::read(path).unwrap();
    let (mut about, mut records, mut ending) = (None, Vec::new(), None);
    for event in Reader::new(bytes.as_slice()) {
        match event {
            Event::Metadata(m) => {
                about = about.or(About::from_metadata(&m.name, &m.metadata));
                ending = ending.or(Ending::from_metadata(&m.name, &m.metadata));
            }
            Event::Message(message) => {
                records.push((message.channel.topic.clone(), message.record().unwrap().unwrap()))
            }
        }
    }
    (about.unwrap(), records, ending.unwrap())
}

#[test]
fn each_file_of_a_rotation_can_be_replayed_alone_and_none_may_be_missing() {
    let place = Place::new();
    let path = recorded(&place, 42, 24.0, 4.0, 4.0);
    let folder = place.path("rotated");
    let text = fs::read_to_string(&path).unwrap();
    fs::write(&path, format!("{text}\n[record]\nfolder = \"{}\"\nrotate_mb = 1\n", folder.display())).unwrap();
    let live = {
        let _alone = one_at_a_time();
        Launch::start(&place, "live", &path, None).end()
    };
    live.well();
    let all = live.solutions("radar");
    let parts = files(&folder);
    assert!(parts.len() > 2, "{} files", parts.len());
    // the whole, by the folder
    let (output, solutions) = again(&place, &folder, "whole");
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(said.contains("2401 solutions are the recorded ones to the bit"), "{said}");
    assert_eq!(first_difference(&all, &fs::read_to_string(solutions).unwrap()), None);
    // from the second file on, and the second file alone
    let rest = assert_tail(&place, &parts[1], "rest", &all);
    let alone = place.folder("alone").join("run_001.mcap");
    fs::copy(&parts[1], &alone).unwrap();
    let count = assert_tail(&place, &alone, "one", &all);
    assert!(count > 200 && rest > count, "{count} of {rest}");
    // with another configuration its state is refused, in words, and the estimator starts anew
    let (about, records, ending) = read(&alone);
    let other = about.configuration.replace("bias_deg_per_h = 0.01", "bias_deg_per_h = 0.02");
    assert_ne!(other, about.configuration);
    let mut writer = Writer::new(Vec::new(), &About { configuration: other, ..about }).unwrap();
    records.iter().for_each(|(topic, record)| writer.write(topic, 0, record).unwrap());
    let other = place.folder("other").join("run_001.mcap");
    fs::write(&other, writer.finish(&ending).unwrap()).unwrap();
    let (output, _) = again(&place, &other, "refused");
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(
        output.status.success() && said.contains("refused: it is that of an estimator with another configuration"),
        "{said}"
    );
    assert!(!said.contains("from behind"), "{said}");
    // a file between is missing
    fs::remove_file(&parts[1]).unwrap();
    let (output, _) = again(&place, &folder, "hole");
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(said.contains(parts[1].to_str().unwrap()) && said.contains("is missing"), "{said}");
}
