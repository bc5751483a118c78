//! A method over kept data does what the offline loop does; trials do not depend on the threads.
#![allow(clippy::unwrap_used)]

use experiments::{Data, Fault, Findings, Plan, Point, Study, Trials, Watch, presets, run, run_together};
use frames::unit::seconds;
use messages::{FlexureParams, Solution, Truth};
use pipeline::configuration::Configuration;
use pipeline::offline::{self, Sink};
use std::num::NonZeroUsize;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

fn demo(seed: u64) -> Configuration {
    presets::configuration("demo", seed).unwrap().with(|c| c.run.duration_s = Some(60.0))
}

#[derive(Default)]
struct Reference {
    truth: Option<Truth>,
    points: Vec<Point>,
    sets: Vec<FlexureParams>,
}

impl Sink for Reference {
    fn truth(&mut self, truth: &Truth) {
        self.truth = Some(*truth);
    }

    fn solution(&mut self, solution: &Solution) {
        let truth = self.truth.as_ref().filter(|truth| truth.header.sequence == solution.header.sequence);
        self.points.push(Point::of(solution, truth.unwrap()));
    }

    fn parameters(&mut self, parameters: &FlexureParams) {
        self.sets.push(*parameters);
    }
}

#[test]
fn a_track_has_the_bits_of_the_offline_loop() {
    for seed in [1, 2, 3] {
        let configuration = demo(seed);
        let mut reference = Reference::default();
        offline::run(&configuration, &mut reference).unwrap();
        let data = Data::simulate(&configuration).unwrap();
        let track = run(&configuration, &data, 0.0);
        assert!(track.points == reference.points, "seed {seed}");
        let adopted: Vec<FlexureParams> = track.adopted.iter().map(|adoption| adoption.set).collect();
        // at 30, 40 and 50 s
        assert!(adopted.len() >= 3 && adopted == reference.sets[..adopted.len()], "seed {seed}");
        let waits = track.adopted.iter().map(|a| a.time_s - seconds(a.set.effective_from_ns));
        assert!(waits.into_iter().all(|wait| (0.0..0.011).contains(&wait)), "seed {seed}");
    }
}

#[test]
fn methods_side_by_side_are_the_methods_one_by_one() {
    let scenario = demo(4);
    let slow = scenario.with(|c| c.areas[0].identifier.period_s = 20.0);
    let data = Data::simulate(&scenario).unwrap();
    let methods = [scenario.clone(), slow];
    let together = run_together(&scenario, &methods, 0.1).unwrap();
    assert!(together[0] != together[1]);
    for (method, track) in methods.iter().zip(&together) {
        assert!(run(method, &data, 0.1) == *track);
        assert_eq!(track.over(30.0..).valid_share(), 1.0);
        let (first, last) = (track.points[0].time_s, track.points[track.points.len() - 1].time_s);
        assert_eq!((track.points.len(), first, last), (601, 0.0, 60.0));
    }
}

#[test]
fn a_scenario_without_an_end_is_refused() {
    let endless = demo(1).with(|c| c.run.duration_s = None);
    assert!(matches!(Data::simulate(&endless), Err(Fault::NotAnExperiment(_))));
}

#[derive(Default)]
struct Sum(AtomicU64);

impl Watch for Sum {
    fn done(&self, cost: u64) {
        self.0.fetch_add(cost, Ordering::Relaxed);
    }
}

/// What a study hands to its conclusion, by so many threads.
fn measured(threads: usize, plan: Plan) -> Vec<(usize, u64, f64)> {
    let seen = std::sync::Arc::new(Mutex::new(Vec::new()));
    let concluded = seen.clone();
    let measure = |trial: &experiments::Trial| {
        // later trials end first
        let work = (0..(40 - trial.index.min(39)) * 20_000).fold(trial.seed as f64, |x, _| (x + 1.0).sqrt());
        Ok((trial.index, trial.seed, work))
    };
    let study = Study::new(Trials { full: 40, quick: 5 }, 3, measure, move |trials| {
        *concluded.lock().unwrap() = trials.to_vec();
        Findings::default()
    });
    let sum = Sum::default();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    pool.install(|| study.run(&plan, &sum)).unwrap();
    assert_eq!(sum.0.into_inner(), study.cost(&plan));
    seen.lock().unwrap().clone()
}

#[test]
fn trials_come_in_order_with_the_same_bits_on_any_number_of_threads() {
    let plan = Plan { trials: None, seed: 5, quick: false };
    let one = measured(1, plan);
    assert_eq!(one.len(), 40);
    assert!(one.iter().enumerate().all(|(index, trial)| trial.0 == index));
    assert!(one == measured(2, plan) && one == measured(7, plan));
    assert!(one != measured(1, Plan { seed: 6, ..plan }));
    // a longer run begins with the shorter one
    let few = measured(2, Plan { trials: NonZeroUsize::new(3), ..plan });
    assert!(few.iter().zip(&one).all(|(a, b)| a.1 == b.1) && few.len() == 3);
}

#[test]
fn the_first_fault_is_told_whichever_came_first() {
    let measure = |trial: &experiments::Trial| match trial.index {
        0..3 => Ok(()),
        index => Err(Fault::NoSuchPreset(index.to_string())),
    };
    let study = Study::new(Trials { full: 50, quick: 5 }, 1, measure, |_| Findings::default());
    let plan = Plan { trials: None, seed: 1, quick: false };
    for _ in 0..20 {
        let told = study.run(&plan, &Sum::default());
        assert!(matches!(told, Err(Fault::NoSuchPreset(index)) if index == "3"));
    }
}
