//! The fast steps allocate nothing once they are warm.
#![allow(clippy::unwrap_used)]

use estimate::Events;
use messages::Flags;
use pipeline::configuration::{Configuration, MatchingMethod};
use pipeline::lane;
use pipeline::source::{Batch, Source};
use runtime::log::{Level, Log, Settings, Speaker, To};
use simulation::Simulator;
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::path::Path;

thread_local! {
    // of this thread alone, since the test harness allocates in others
    static ALLOCATIONS: Cell<u64> = const { Cell::new(0) };
}

struct Counting;

fn count() {
    ALLOCATIONS.set(ALLOCATIONS.get() + 1);
}

// SAFETY: everything is passed on to the system's allocator; counting touches a thread's own cell, which needs no allocation.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count();
        // SAFETY: the caller's promises hold for the system's allocator as well.
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        count();
        // SAFETY: as above.
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn realloc(&self, block: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count();
        // SAFETY: as above.
        unsafe { System.realloc(block, layout, size) }
    }

    unsafe fn dealloc(&self, block: *mut u8, layout: Layout) {
        // SAFETY: as above.
        unsafe { System.dealloc(block, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Gives what `work` gives and adds to `sum` how often it allocated.
fn counted<T>(sum: &mut u64, work: impl FnOnce() -> T) -> T {
    let before = ALLOCATIONS.get();
    let result = work();
    *sum += ALLOCATIONS.get() - before;
    result
}

const WARM_UP: u64 = 6_000;
const MEASURED: u64 = 10_000;

fn demo(seed: u64) -> Configuration {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("config/demo.toml");
    let mut configuration = Configuration::read(&path).unwrap();
    configuration.run.seed = seed;
    // the default makes room for another filter whenever it runs over the first minutes again
    configuration.areas[0].estimator.matching = MatchingMethod::So3;
    configuration
}

#[test]
fn the_counter_counts() {
    let mut sum = 0;
    let mut kept = counted(&mut sum, || Vec::<u64>::with_capacity(4));
    assert_eq!(sum, 1);
    counted(&mut sum, || kept.extend(0..5));
    assert_eq!((sum, kept.len()), (2, 5));
}

/// With a log as it is in a run: a new set every few seconds is none of its words at this level, and no sample is.
#[test]
fn synchroniser_and_estimator_allocate_nothing() {
    let speaker = Speaker { stage: "estimate".into(), area: Some("radar".into()) };
    let _log = Log::start(Settings { level: Level::Info, to: To::Stderr, speaker });
    for seed in 1..=3 {
        let configuration = demo(seed);
        let mut source = Source::open(&configuration, 0).unwrap();
        let mut synchroniser = lane::synchroniser(&configuration, 0);
        let mut estimator = lane::estimator(&configuration, 0);
        let mut identifier = lane::identifier(&configuration, 0);
        let mut events = Events::default();
        let mut batch = Batch::default();
        let (mut synchronise, mut estimate, mut pairs, mut sets) = (0, 0, 0, 0);
        for k in 0..WARM_UP + MEASURED {
            if k == WARM_UP {
                assert!(sets > 0, "seed {seed}: no parameters before the count begins");
                (synchronise, estimate, pairs, sets) = (0, 0, 0, 0);
            }
            assert!(source.next(&mut batch));
            counted(&mut synchronise, || {
                batch.attitude.iter().for_each(|attitude| synchroniser.attitude(attitude));
                synchroniser.main(&batch.main);
                batch.sub.iter().for_each(|sample| synchroniser.sub(sample));
            });
            while let Some(pair) = counted(&mut synchronise, || synchroniser.pair()) {
                // what the log has to be told of it included
                let solution = counted(&mut estimate, || {
                    let solution = estimator.step(&pair);
                    events.see(&solution);
                    solution
                });
                pairs += 1;
                if k >= WARM_UP {
                    assert!(solution.is_valid() && solution.params_id > 0, "seed {seed}: {}", solution.flags.names());
                    assert!(!solution.flags.contains(Flags::PRIOR), "seed {seed}");
                }
                if let Some(parameters) = identifier.step(&pair, &solution) {
                    sets += 1;
                    counted(&mut estimate, || {
                        estimator.offer(parameters);
                        events.offer(&parameters);
                    });
                }
            }
        }
        assert!(pairs >= MEASURED - 10 && sets > 5, "seed {seed}: {pairs} pairs, {sets} parameter sets");
        assert_eq!((synchronise, estimate), (0, 0), "seed {seed}: allocations of synchroniser and estimator");
    }
}

#[test]
fn simulator_allocates_nothing() {
    for seed in 1..=3 {
        let mut simulator = Simulator::new(&demo(seed).scenario(0));
        let mut simulate = 0;
        for k in 0..WARM_UP + MEASURED {
            if k == WARM_UP {
                simulate = 0;
            }
            assert!(counted(&mut simulate, || simulator.step().is_some()));
        }
        assert_eq!(simulate, 0, "seed {seed}");
    }
}
