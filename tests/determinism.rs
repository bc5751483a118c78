//! The offline loop gives the same bits each time, and the processes give the same bits as the offline loop.
//!
//! No assertion depends on how fast the host is, but for one that comes before each comparison: that no parameter set came late.
//! The lead leaves the identifier two seconds for what takes it 10 ms.
#![allow(clippy::unwrap_used)]

mod common;

use common::comparison;
use common::launch::{Ended, one_at_a_time};
use common::retrace::{Story, retrace, rows, sets};
use common::{Place, changed, configuration, demo, first_difference, offline, recorded, shipped};
use frames::{Main, Rot, Sub, Vec3};
use messages::{Flags, FlexureParams, Solution};
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
fn assert_same(place: &Place, configuration: &Path, duration: &str) -> Ended {
    let _alone = one_at_a_time();
    let live = comparison::same_live_and_offline(place, configuration, duration);
    let configuration = Configuration::read(configuration).unwrap();
    for area in &configuration.areas {
        let solutions = live.solutions(&area.name);
        assert!(in_force(&configuration, &solutions) > 0, "{}: no parameter set came into force", area.name);
    }
    live
}

#[test]
fn simulated_units_give_the_same_live_and_offline() {
    let place = Place::new();
    assert_same(&place, &place.write("demo.toml", &demo(1, 2.0)), "12s");
}

/// A zero changes what is told, and neither what is learnt nor how well it is known.
#[test]
fn a_zero_turns_the_solutions_and_nothing_else() {
    let place = Place::new();
    let name = "name = \"radar\"";
    let run = |zero: &str| {
        let text = demo(6, 1.0).replacen(name, &format!("{name}\n{zero}"), 1);
        let mut seen = Seen::default();
        pipeline::offline::run(&configuration(&place.write("demo.toml", &text), 25.0), &mut seen).unwrap();
        seen
    };
    let (without, with) = (run(""), run("zero_deg = [0.2, -0.1, 0.5]"));
    let turn = Rot::<Sub, Sub>::exp(Vec3::new(0.2, -0.1, 0.5) * frames::unit::DEGREE);
    assert_eq!(without.solutions.len(), with.solutions.len());
    let mut valid = 0;
    for (a, b) in without.solutions.iter().zip(&with.solutions).filter(|(a, _)| a.is_valid()) {
        let back = Rot::<Main, Sub>::from_wxyz(b.q) * turn;
        let off = (back * Rot::<Main, Sub>::from_wxyz(a.q).inverse()).angle();
        // what is learnt goes through the zero and back, with the rounding of that
        assert!(off < 1e-9, "{off} at {}", a.header.sequence);
        for axis in 0..3 {
            assert!((a.range[axis] / b.range[axis] - 1.0).abs() < 1e-6, "{:?} {:?}", a.range, b.range);
        }
        assert_eq!((a.valid, a.flags | Flags::ZEROED), (b.valid, b.flags));
        valid += 1;
    }
    assert!(valid > 1000 && without.sets.len() > 3, "{valid} valid, {} sets", without.sets.len());
    for (a, b) in without.sets.iter().zip(&with.sets) {
        for axis in 0..3 {
            let off = [a.b[axis] / b.b[axis] - 1.0, a.sigma[axis] / b.sigma[axis] - 1.0].map(f64::abs);
            assert!(off.into_iter().all(|off| off < SEARCHED), "{off:?} of set {}", a.id);
        }
    }
}

/// The search for a flexure ends with a step of this size (relative), and rounding may end it a step earlier or later.
const SEARCHED: f64 = 1e-5;

#[derive(Default)]
struct Seen {
    solutions: Vec<Solution>,
    sets: Vec<FlexureParams>,
}

impl pipeline::offline::Sink for Seen {
    fn solution(&mut self, solution: &Solution) {
        self.solutions.push(*solution);
    }

    fn parameters(&mut self, parameters: &FlexureParams) {
        self.sets.push(*parameters);
    }
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

/// One of the units has a clock of its own, its samples are lost, repeated and swapped, and its deformation is told from a zero.
#[test]
fn two_areas_give_the_same_live_and_offline() {
    let place = Place::new();
    let quick = "\n[area.estimator]\nmatching = \"so3\"\n\n[area.identifier]\nmethod = \"rvm\"\nminimum_s = 3\nperiod_s = 2\nlead_s = 2\n\n\
                 [area.simulation]\n";
    let text = shipped("two_areas.toml").replace("\n[area.simulation]\n", quick);
    let name = "name = \"landing-aid\"";
    let text = changed(&text, &[("seed", "2")]).replacen(name, &format!("{name}\nzero_deg = [0.2, -0.1, 0.5]"), 1);
    let live = assert_same(&place, &place.write("two_areas.toml", &text), "12s");
    for (area, zeroed) in [("radar", false), ("landing-aid", true)] {
        let solutions = live.solutions(area);
        assert!(solutions.lines().skip(1).all(|row| row.contains("zeroed") == zeroed), "{area}");
    }
    let told = live.well()["end_to_end"].as_array().unwrap().iter().map(|row| row["zero_deg"].is_array());
    assert_eq!(told.collect::<Vec<_>>(), [false, true]);
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
