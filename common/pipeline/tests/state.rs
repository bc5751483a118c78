//! An estimator that goes on from another one's state gives the same bits.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use estimation::{Estimator, StateError};
use frames::Vec3;
use messages::{FlexureParams, ImuPair, Solution};
use pipeline::configuration::{Configuration, MatchingMethod, RangeMethod};
use pipeline::lane;
use pipeline::source::{Batch, Source};
use simulation::{FlexureChange, GaussMarkov};
use std::collections::HashSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

fn shipped(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../config").join(name)
}

/// A pair, the set that is offered before it, and its solution.
type Step = (Option<FlexureParams>, ImuPair, Solution);

/// All steps of a run, and the states that the estimator had behind some of them.
struct Run {
    steps: Vec<Step>,
    states: Vec<(usize, Vec<u8>)>,
    /// How long the copying of each took.
    copied: Vec<Duration>,
}

fn run(configuration: &Configuration, every: usize) -> Run {
    let mut source = Source::open(configuration, 0).unwrap();
    let mut synchroniser = lane::synchroniser(configuration, 0);
    let mut estimator = lane::estimator(configuration, 0);
    let mut identifier = lane::identifier(configuration, 0);
    let (mut batch, mut set) = (Batch::default(), None);
    let mut run = Run { steps: Vec::new(), states: Vec::new(), copied: Vec::new() };
    while source.next(&mut batch) {
        batch.attitude.iter().for_each(|attitude| synchroniser.attitude(attitude));
        synchroniser.main(&batch.main);
        batch.sub.iter().filter(|sample| sample.unit == 1).for_each(|sample| synchroniser.sub(sample));
        while let Some(pair) = synchroniser.pair() {
            set.iter().for_each(|set| estimator.offer(*set));
            let solution = estimator.step(&pair);
            run.steps.push((set.take(), pair, solution));
            set = identifier.step(&pair, &solution);
            if !run.steps.len().is_multiple_of(every) {
                continue;
            }
            let begin = Instant::now();
            if let Some(frozen) = estimator.freeze() {
                run.copied.push(begin.elapsed());
                run.states.push((run.steps.len(), frozen()));
            }
        }
    }
    run
}

fn bits(solution: &Solution) -> String {
    // as short as they can be read back exactly
    format!("{solution:?}")
}

fn assert_same(estimator: &mut dyn Estimator, steps: &[Step], name: &str) {
    for (set, pair, solution) in steps {
        set.iter().for_each(|set| estimator.offer(*set));
        let again = estimator.step(pair);
        assert_eq!(bits(&again), bits(solution), "{name}: sample {}", pair.header.sequence);
    }
}

#[test]
fn every_method_goes_on_from_its_state_to_the_bit() {
    let mut seen = HashSet::new();
    let mut presets: Vec<PathBuf> =
        fs::read_dir(shipped("papers")).unwrap().map(|entry| entry.unwrap().path()).collect();
    presets.sort();
    for path in presets {
        let mut configuration = Configuration::read(&path).unwrap();
        let told = &configuration.areas[0].estimator;
        if !seen.insert(format!("{:?} {:?}", told.matching, told.range())) {
            continue;
        }
        let name = format!("{} {:?}", path.display(), told.matching);
        configuration.run.duration_s = Some(7000.0 / configuration.rate_hz);
        let Run { steps, states, .. } = run(&configuration, 3001);
        assert!(states.len() >= 2, "{name}: {} states in {} steps", states.len(), steps.len());
        for (from, state) in &states {
            let mut again = lane::estimator(&configuration, 0);
            again.thaw(state).unwrap();
            assert_same(again.as_mut(), &steps[*from..], &name);
        }
        let other = configuration.with(|told| told.areas[0].gyro.arw *= 1.001);
        assert_eq!(lane::estimator(&other, 0).thaw(&states[0].1), Err(StateError::Settings), "{name}");
    }
    assert!(seen.len() > 12, "{seen:?}");
}

/// Through the first minutes that are run over again, those since a change of the flexure that are, and beyond into the slow filter's time.
#[test]
fn the_own_estimator_goes_on_from_its_state_to_the_bit() {
    let configuration = Configuration::read(&shipped("demo.toml")).unwrap().with(|told| {
        told.run.duration_s = Some(1000.0);
        told.areas[0].zero = Vec3::new(1e-3, 2e-3, -1e-3);
        let simulation = &mut told.areas[0].simulation;
        let flexure = simulation.flexure.map(|axis| GaussMarkov { sigma: 2.0 * axis.sigma, ..axis });
        simulation.flexure_changes = vec![FlexureChange { at_s: 750.0, flexure }];
    });
    let told = &configuration.areas[0].estimator;
    assert_eq!((told.matching, told.range()), (MatchingMethod::Deck, RangeMethod::Observed));
    // not at the end of an increment, nor always at the same place within one
    let Run { steps, states, mut copied } = run(&configuration, 2503);
    let (first, last) = (states.first().unwrap(), states.last().unwrap());
    assert!(first.0 < 6000 && last.0 > 95_000 && states.len() > 35, "{} states", states.len());
    copied.sort();
    println!("a copy took {:?}, the longest {:?}", copied[copied.len() / 2], copied[copied.len() - 1]);
    let largest = states.iter().map(|(_, state)| state.len()).max().unwrap();
    assert!(largest < 2_000_000 && last.1.len() < 900_000, "{largest} and {} bytes", last.1.len());
    println!("{largest} bytes at most, {} in the end", last.1.len());
    for (from, state) in &states {
        let mut again = lane::estimator(&configuration, 0);
        again.thaw(state).unwrap();
        let until = steps.len().min(from + 7000);
        assert_same(again.as_mut(), &steps[*from..until], "deck");
    }
}

#[test]
fn what_is_no_state_of_this_estimator_is_refused_and_changes_nothing() {
    let configuration =
        Configuration::read(&shipped("demo.toml")).unwrap().with(|told| told.run.duration_s = Some(60.0));
    let Run { steps, states, .. } = run(&configuration, 5000);
    let state = &states[0].1;
    let mut estimator = lane::estimator(&configuration, 0);
    assert!(estimator.freeze().is_none(), "there is no filter yet");
    let so3 = configuration.with(|told| told.areas[0].estimator.matching = MatchingMethod::So3);
    assert_eq!(lane::estimator(&so3, 0).thaw(state), Err(StateError::Settings));
    let range = configuration.with(|told| told.areas[0].estimator.range = Some(RangeMethod::Normal));
    assert_eq!(lane::estimator(&range, 0).thaw(state), Err(StateError::Settings));
    for cut in (0..state.len()).step_by(997) {
        assert!(estimator.thaw(&state[..cut]).is_err(), "{cut}");
    }
    let mut another = state.clone();
    another[12] = b'x';
    assert!(matches!(estimator.thaw(&another), Err(StateError::Version { .. })));
    assert_same(estimator.as_mut(), &steps, "refused");
}
