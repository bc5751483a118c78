//! The offline loop gives the same bits each time, and the processes give the same bits as the offline loop.
//!
//! No assertion depends on how fast the host is, but for one that comes before each comparison: that no parameter set came late.
//! The lead leaves the identifier two seconds for what takes it 10 ms.
#![allow(clippy::unwrap_used)]

mod common;

use common::comparison;
use common::launch::one_at_a_time;
use common::retrace::{Story, retrace, rows, sets};
use common::{Place, changed, configuration, demo, first_difference, offline, recorded, shipped};
use pipeline::configuration::Configuration;
use std::fs;
use std::path::Path;

fn in_force(configuration: &Configuration, solutions: &str) -> usize {
    sets(&rows(configuration, solutions)).len()
}

#[test]
fn offline_repeats_itself() {
    let place = Place::new();
    let mut all = Vec::new();
    for seed in 1..=4 {
        let configuration = configuration(&place.write("demo.toml", &demo(seed, 1.0)), 25.0);
        let (solutions, sets) = offline(&configuration);
        assert_eq!(solutions.lines().count(), 1 + 2501);
        assert!(sets.len() > 3 && in_force(&configuration, &solutions) > 3, "seed {seed}: {} sets", sets.len());
        let (again, sets_again) = offline(&configuration);
        assert_eq!(first_difference(&solutions, &again), None, "seed {seed}");
        assert_eq!(sets, sets_again, "seed {seed}");
        assert!(!all.contains(&solutions), "seed {seed} gives what another one gave");
        all.push(solutions);
    }
}

/// Asserts that both ways lead to the same files, with parameter sets in force in each.
fn assert_same(place: &Place, configuration: &Path, duration: &str) {
    let _alone = one_at_a_time();
    let live = comparison::same_live_and_offline(place, configuration, duration);
    let configuration = Configuration::read(configuration).unwrap();
    for area in &configuration.areas {
        let solutions = live.solutions(&area.name);
        assert!(in_force(&configuration, &solutions) > 0, "{}: no parameter set came into force", area.name);
    }
}

#[test]
fn simulated_units_give_the_same_live_and_offline() {
    let place = Place::new();
    assert_same(&place, &place.write("demo.toml", &demo(1, 2.0)), "12s");
}

/// The default estimator, which runs over the first minutes again whenever parameters come.
#[test]
fn the_default_estimator_gives_the_same_live_and_offline() {
    let place = Place::new();
    let early = "[area.estimator]\nregistration_s = 6\n\n[area.identifier]";
    let text = shipped("demo.toml").replacen("[area.identifier]", early, 1);
    let rvm = "300\nmethod = \"rvm\"";
    let text = changed(&text, &[("window_s", rvm), ("minimum_s", "3"), ("period_s", "2"), ("lead_s", "2")]);
    assert_same(&place, &place.write("demo.toml", &text), "14s");
}

/// One of the units has a clock of its own, and its samples are lost, repeated and swapped.
#[test]
fn two_areas_give_the_same_live_and_offline() {
    let place = Place::new();
    let quick = "\n[area.estimator]\nmatching = \"so3\"\n\n[area.identifier]\nmethod = \"rvm\"\nminimum_s = 3\nperiod_s = 2\nlead_s = 2\n\n\
                 [area.simulation]\n";
    let text = shipped("two_areas.toml").replace("\n[area.simulation]\n", quick);
    assert_same(&place, &place.write("two_areas.toml", &changed(&text, &[("seed", "2")])), "12s");
}

#[test]
fn recorded_units_give_the_same_live_and_offline() {
    let place = Place::new();
    assert_same(&place, &recorded(&place, 3, 20.0, 4.0, 8.0), "20s");
}

/// The negative control: with a lead of one sample the live identifier is always too late, and the comparison must notice.
///
/// Even then nothing is lost: which set was in force when stands in the rows, and from them the run can be computed again.
#[test]
fn without_a_lead_live_and_offline_differ() {
    let place = Place::new();
    let path = recorded(&place, 4, 14.0, 4.0, 0.01);
    let _alone = one_at_a_time();
    let (live, offline) = comparison::both_ways(&place, &path, "14s");
    let late = live.well()["late_parameters"].as_u64().unwrap();
    let solutions = live.solutions("radar");
    let configuration = configuration(&path, 14.0);
    assert!(late > 0 && late as usize == in_force(&configuration, &solutions), "{late} late");
    assert_ne!(solutions, fs::read_to_string(offline.join("solution_radar.csv")).unwrap());
    retrace(&configuration, &solutions, &Story::default()).unwrap();
}
