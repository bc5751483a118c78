//! What the pure steps cost beside each other: thread CPU time, medians of rounds, all in one run.
//!
//! Each round is 10 s of the demonstration's data, and rounds count from the first in which the identifier's window is full.
#![allow(clippy::print_stdout)]

use estimation::synchronise::Synchroniser;
use messages::{Flags, ImuPair, Solution};
use pipeline::configuration::Configuration;
use pipeline::lane;
use pipeline::source::{Batch, Source};
use simulation::Outliers;
use std::error::Error;
use std::hint::black_box;
use std::path::Path;

const ROUND: usize = 1000;
const ROUNDS: usize = 9;
const WINDOW_S: f64 = 300.0;

/// CPU time of this thread, ns: what others do on the host does not count.
fn cpu_ns() -> f64 {
    let mut now = libc::timespec { tv_sec: 0, tv_nsec: 0 };
    // SAFETY: the pointer is valid; the call cannot fail for this clock.
    unsafe { libc::clock_gettime(libc::CLOCK_THREAD_CPUTIME_ID, &mut now) };
    now.tv_sec as f64 * 1e9 + now.tv_nsec as f64
}

/// Time per piece of work, ns, over the rounds.
#[derive(Default)]
struct Cost(Vec<f64>);

impl Cost {
    fn measure(&mut self, mut work: impl FnMut() -> usize) {
        let begin = cpu_ns();
        let pieces = work();
        self.0.push((cpu_ns() - begin) / pieces as f64);
    }

    fn median(&mut self, name: &str) -> Result<f64, String> {
        self.0.sort_by(f64::total_cmp);
        self.0.get(self.0.len() / 2).copied().ok_or_else(|| format!("{name} has done nothing"))
    }
}

/// Takes the samples of all batches; how many that is.
fn synchronised(synchroniser: &mut Synchroniser, batches: &[Batch], pairs: &mut Vec<ImuPair>) -> usize {
    pairs.clear();
    for batch in batches {
        batch.attitude.iter().for_each(|attitude| synchroniser.attitude(attitude));
        synchroniser.main(&batch.main);
        batch.sub.iter().for_each(|sample| synchroniser.sub(sample));
        pairs.extend(std::iter::from_fn(|| synchroniser.pair()));
    }
    batches.iter().map(|batch| 1 + batch.sub.len()).sum()
}

/// A synchroniser whose sub unit spikes once in a hundred samples of each axis.
fn spiking(demo: &Configuration) -> Result<(Cost, Vec<ImuPair>), Box<dyn Error>> {
    let configuration = demo.with(|c| {
        c.spike_threshold = 5.0;
        c.areas[0].simulation.outliers = Outliers { probability: 0.01, size: 50.0, one_sided: true };
    });
    let mut source = Source::open(&configuration, 0)?;
    let mut synchroniser = lane::synchroniser(&configuration, 0);
    let (mut batches, mut pairs, mut cost) = (vec![Batch::default(); ROUND], Vec::new(), Cost::default());
    for round in 0..2 * ROUNDS {
        if !batches.iter_mut().all(|batch| source.next(batch)) {
            return Err("the simulator has ended".into());
        }
        if round == ROUNDS {
            cost.0.clear();
        }
        cost.measure(|| synchronised(&mut synchroniser, &batches, &mut pairs));
    }
    Ok((cost, pairs))
}

fn main() -> Result<(), Box<dyn Error>> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("config/demo.toml");
    let mut configuration = Configuration::read(&path)?;
    configuration.areas[0].identifier.window_s = WINDOW_S;
    let mut source = Source::open(&configuration, 0)?;
    let mut synchroniser = lane::synchroniser(&configuration, 0);
    let mut estimator = lane::estimator(&configuration, 0);
    let mut identifier = lane::identifier(&configuration, 0);
    let warm_up = (WINDOW_S * configuration.rate_hz / ROUND as f64).ceil() as usize;
    let mut batches = vec![Batch::default(); ROUND];
    let mut pairs: Vec<ImuPair> = Vec::with_capacity(2 * ROUND);
    let mut solutions: Vec<Solution> = Vec::with_capacity(2 * ROUND);
    let (mut simulate, mut synchronise, mut estimate, mut identify) =
        (Cost::default(), Cost::default(), Cost::default(), Cost::default());
    for round in 0..warm_up + ROUNDS {
        if round == warm_up {
            [&mut simulate, &mut synchronise, &mut estimate, &mut identify].into_iter().for_each(|cost| cost.0.clear());
        }
        simulate.measure(|| batches.iter_mut().filter_map(|batch| source.next(batch).then_some(())).count());
        synchronise.measure(|| synchronised(&mut synchroniser, &batches, &mut pairs));
        solutions.clear();
        estimate.measure(|| {
            solutions.extend(pairs.iter().map(|pair| estimator.step(black_box(pair))));
            solutions.len()
        });
        for (pair, solution) in pairs.iter().zip(&solutions) {
            let begin = cpu_ns();
            if let Some(parameters) = identifier.step(pair, solution) {
                identify.0.push(cpu_ns() - begin);
                estimator.offer(parameters);
            }
        }
    }
    let (mut spikes, mended) = spiking(&configuration)?;
    if !mended.iter().any(|pair| pair.flags.contains(Flags::SPIKE)) {
        return Err("no spike was found".into());
    }
    let unit = estimate.median("the estimator")?;
    println!("{:<44} {:>12} {:>20}", "step", "median us", "to the pair's step");
    for (name, cost) in [
        ("estimator, a pair (mean with its filter)", &mut estimate),
        ("synchroniser, a sample", &mut synchronise),
        ("synchroniser, a sample while a unit spikes", &mut spikes),
        ("simulator, an epoch", &mut simulate),
        ("identifier, a firing with a full window", &mut identify),
    ] {
        let median = cost.median(name)?;
        println!("{name:<44} {:>12.3} {:>20.3}", median / 1e3, median / unit);
    }
    Ok(())
}
