//! `deckflex reproduce`: what it prints and writes, on any number of threads, and what a user meets who mistypes.
#![allow(clippy::unwrap_used)]

mod common;

use common::Place;
use serde_json::Value;
use std::collections::BTreeSet;
use std::fs;
use std::process::Output;
use std::time::{Duration, Instant};

/// The configuration, the recording or the command line cannot be used.
const UNUSABLE: i32 = 2;

fn reproduce(place: &Place, arguments: &[&str]) -> Output {
    place.deckflex().arg("reproduce").args(arguments).current_dir(place.path("")).output().unwrap()
}

fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

fn assert_row(row: &Value) {
    let keys: BTreeSet<&str> = row.as_object().unwrap().keys().map(String::as_str).collect();
    let expected = ["id", "table", "row", "axis", "unit", "ours", "spread", "bound", "paper", "verdict", "why"];
    assert_eq!(keys, BTreeSet::from(expected));
    for key in ["id", "table", "row", "axis", "why"] {
        assert!(row[key].as_str().is_some_and(|text| !text.is_empty()), "{key}: {row}");
    }
    for key in ["bound", "paper"] {
        assert!(row[key].is_number() || row[key].as_str().is_some_and(|text| !text.is_empty()), "{key}: {row}");
    }
    assert!(row["unit"].is_string() && row["ours"].is_number() && !row["spread"].is_string(), "{row}");
    let verdicts = ["reproduces", "reproduces in size", "does not reproduce", "not testable"];
    assert!(verdicts.contains(&row["verdict"].as_str().unwrap()), "{row}");
}

/// All papers in one run, as the quick way of the command promises; each method has its rows.
#[test]
fn the_quick_run_has_rows_for_every_paper_and_method() {
    let place = Place::new();
    let output = reproduce(&place, &["all", "--quick", "--json", "out.json"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let document: Value = serde_json::from_str(&fs::read_to_string(place.path("out.json")).unwrap()).unwrap();
    let rows = document["experiments"].as_array().unwrap();
    rows.iter().for_each(assert_row);
    let ids: BTreeSet<&str> = rows.iter().map(|row| row["id"].as_str().unwrap()).collect();
    assert_eq!(ids.len(), rows.len(), "an id stands twice");
    for paper in ["idam", "q-nnkf", "model-free", "tufts-kumaresan", "error-range", "deck"] {
        assert!(ids.iter().any(|id| id.starts_with(&format!("{paper}/"))), "{paper}");
    }
    let named = |word: &str| rows.iter().any(|row| row["row"].as_str().unwrap().contains(word));
    for method in [
        "EKF, RVM",
        "SVR",
        "WOA",
        "Whittle",
        "MPF",
        "MCC by R",
        "MCC by the innovation",
        "IDAM to the letter",
        "IDAM, Bayes weighting",
        "SO(3)",
        "rvm_gaussian",
        "particle_swarm",
        "matrix_pencil",
        "yule_walker",
        "ACA",
        "LSE",
        "CKF",
        "EKF on the exact measurement",
        "Q-KF",
        "NNKF",
        "Q-NNKF as printed",
        "Method A",
        "Method B",
        "Method C",
        "time as input",
        "last output as input",
        "Random walk",
        "Tufts-Kumaresan",
        "formula",
        "coherence",
        "three deviations",
    ] {
        assert!(named(method), "no row of {method}");
    }
}

#[test]
fn the_same_rows_tables_and_page_on_one_thread_and_on_two() {
    let place = Place::new();
    let run = |threads: &str| {
        let (json, report) = (format!("{threads}.json"), format!("report{threads}"));
        let arguments =
            ["tufts-kumaresan", "--quick", "--trials", "2", "--threads", threads, "--json", &json, "--report", &report];
        let output = reproduce(&place, &arguments);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        assert_eq!(stderr(&output), "", "no bar without a terminal");
        let page = fs::read_to_string(place.path(&report).join("index.html")).unwrap();
        (String::from_utf8(output.stdout).unwrap(), fs::read_to_string(place.path(&json)).unwrap(), page)
    };
    let (tables, json, page) = run("1");
    let two = run("2");
    assert!(tables == two.0 && json == two.1 && page == two.2, "one thread and two differ");

    let document: Value = serde_json::from_str(&json).unwrap();
    assert_eq!(document.as_object().unwrap().len(), 1);
    let rows = document["experiments"].as_array().unwrap();
    rows.iter().for_each(assert_row);
    let ids: BTreeSet<&str> = rows.iter().map(|row| row["id"].as_str().unwrap()).collect();
    assert!(ids.len() == rows.len() && ids.iter().all(|id| id.starts_with("tufts-kumaresan/")), "{ids:?}");
    for row in rows {
        let words =
            |text: &str| ["table", "row", "verdict"].iter().all(|key| text.contains(row[key].as_str().unwrap()));
        assert!(words(&tables), "{row} is not in\n{tables}");
    }

    assert!(page.starts_with("<!DOCTYPE html>") && page.contains("<svg") && page.contains("</html>"));
    let linked = ["<script", "<link", "<img", "src=", "href=", "url(", "@import"];
    assert!(linked.iter().all(|link| !page.contains(link)), "the page is not self-contained");
}

#[test]
fn wrong_arguments_are_refused_with_what_is_allowed() {
    let place = Place::new();
    for (arguments, words) in [
        (&["idem"][..], &["idem", "idam", "all"][..]),
        (&["idam", "--trials", "0"], &["--trials", "0"]),
        (&["idam", "--trials", "many"], &["--trials", "many"]),
        (&["idam", "--threads", "0"], &["--threads", "0"]),
        (&["idam", "--seed=-1"], &["--seed", "-1"]),
        (&["idam", "idam"], &["unexpected"]),
    ] {
        let output = reproduce(&place, arguments);
        assert_eq!(output.status.code(), Some(UNUSABLE), "{arguments:?}");
        assert!(words.iter().all(|word| stderr(&output).contains(word)), "{arguments:?}: {}", stderr(&output));
        assert!(output.stdout.is_empty());
    }
}

/// A thousand trials would take an hour.
#[test]
fn an_output_that_cannot_be_written_is_told_before_the_work() {
    let place = Place::new();
    place.write("file", "");
    for arguments in [["--json", "nowhere/out.json"], ["--json", "."], ["--report", "file"]] {
        let start = Instant::now();
        let output = reproduce(&place, &[&["idam", "--trials", "1000"][..], &arguments].concat());
        assert_eq!(output.status.code(), Some(1), "{arguments:?}");
        assert!(start.elapsed() < Duration::from_secs(5), "{arguments:?}");
        let said = stderr(&output);
        assert!(said.contains("cannot write") && said.contains(arguments[1]), "{said}");
        assert!(output.stdout.is_empty());
    }
}
