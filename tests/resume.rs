//! An estimator that goes on from what the one before it said: at once, and within its range.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use frames::unit;
use messages::Solution;
use pipeline::configuration::Configuration;
use pipeline::lane;
use pipeline::source::{Batch, Source};
use pipeline::summary::deformation_error;
use std::path::Path;

/// When the estimator dies, when the next one gets its first pair, and the end, s.
const DIES_S: f64 = 100.0;
const RESUMES_S: f64 = 101.0;
const UNTIL_S: f64 = 160.0;

/// What came after the death of a demonstration's estimator.
#[derive(Default)]
struct After {
    /// When the first valid solution came, s.
    first_s: Option<f64>,
    solutions: usize,
    in_range: usize,
    /// The largest error over its deviation.
    farthest: f64,
}

fn after(seed: u64) -> After {
    let mut configuration =
        Configuration::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("config/demo.toml")).unwrap();
    configuration.run.seed = seed;
    let mut source = Source::open(&configuration, 0).unwrap();
    let mut synchroniser = lane::synchroniser(&configuration, 0);
    let mut estimator = lane::estimator(&configuration, 0);
    let mut identifier = lane::identifier(&configuration, 0);
    let mut batch = Batch::default();
    let (mut last, mut set, mut dead) = (Solution::default(), None, false);
    let mut after = After::default();
    while source.next(&mut batch) {
        batch.attitude.iter().for_each(|attitude| synchroniser.attitude(attitude));
        synchroniser.main(&batch.main);
        batch.sub.iter().for_each(|sample| synchroniser.sub(sample));
        while let Some(pair) = synchroniser.pair() {
            let time_s = unit::seconds(pair.header.time_ns);
            if time_s > UNTIL_S {
                return after;
            }
            if (DIES_S..RESUMES_S).contains(&time_s) {
                dead = true;
                continue;
            }
            if std::mem::take(&mut dead) {
                estimator = lane::estimator(&configuration, 0);
                estimator.resume(&last);
                estimator.offer(set.unwrap());
            }
            let solution = estimator.step(&pair);
            if let Some(found) = identifier.step(&pair, &solution) {
                estimator.offer(found);
                set = Some(found);
            }
            if time_s < DIES_S {
                last = solution;
            } else if solution.is_valid() {
                after.first_s.get_or_insert(time_s);
                let error = deformation_error(&solution, &batch.truth[0]).array();
                for (axis, error) in error.map(f64::abs).into_iter().enumerate() {
                    after.solutions += 1;
                    after.in_range += usize::from(error <= solution.range[axis]);
                    after.farthest = after.farthest.max(error / solution.covariance[axis * 4].sqrt());
                }
            }
        }
    }
    after
}

#[test]
fn the_next_estimator_is_there_at_once_and_within_its_range() {
    let runs = [1, 2, 3, 4].map(after);
    let (mut solutions, mut in_range) = (0, 0);
    for (run, seed) in runs.iter().zip(1..) {
        let first_s = run.first_s.unwrap();
        println!("seed {seed}: from {first_s} s on, farthest {:.2}, {}/{}", run.farthest, run.in_range, run.solutions);
        assert!(first_s < RESUMES_S + 0.5, "seed {seed}: {first_s}");
        assert!(run.farthest < 4.5, "seed {seed}: {}", run.farthest);
        (solutions, in_range) = (solutions + run.solutions, in_range + run.in_range);
    }
    assert!(in_range as f64 > 0.93 * solutions as f64, "{in_range} of {solutions}");
}
