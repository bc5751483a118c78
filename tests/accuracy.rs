//! Accuracy of the demo scenario beside its bound, over fixed seeds.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use estimation::flexure::Flexure;
use frames::unit;
use messages::{Solution, Truth};
use nalgebra::{Matrix3, Vector3};
use pipeline::configuration::{Configuration, IdentifierMethod};
use pipeline::offline::{self, Sink};
use pipeline::summary::deformation_error;
use std::path::Path;

const ACCURATE_FROM_S: f64 = 120.0;
const DURATION_S: f64 = 600.0;

/// Errors of one run of one area.
#[derive(Default)]
struct Errors {
    truth: Option<Truth>,
    square: [f64; 3],
    count: f64,
    /// Normalised squared error of the last solution.
    nees: f64,
    worst_early: f64,
}

impl Sink for Errors {
    fn truth(&mut self, truth: &Truth) {
        self.truth = Some(*truth);
    }

    fn parameters(&mut self, p: &messages::FlexureParams) {
        if std::env::var("SHOW").is_ok() { let t = unit::seconds(p.header.time_ns); if t < 130.0 {
            println!("t {t:6.1} mu {:.3?} b {:.3?} sigma {:.2?} Q {:.2?}", p.mu, p.b, p.sigma.map(|s| s / unit::ARCMIN), [0,1,2].map(|i| 4.0*p.mu[i]*(p.b[i]*p.sigma[i]).powi(2)*1e8)); } }
    }

    fn solution(&mut self, solution: &Solution) {
        let truth = self.truth.as_ref().filter(|truth| truth.header.sequence == solution.header.sequence).unwrap();
        if !solution.is_valid() {
            return;
        }
        let error = deformation_error(solution, truth);
        let t = unit::seconds(solution.header.time_ns);
        let e = Vector3::from(error.array());
        let p = Matrix3::from_row_slice(&solution.covariance);
        self.nees = (e.transpose() * p.try_inverse().unwrap() * e)[0];
        for axis in 0..3 {
            self.worst_early = self.worst_early.max(e[axis].abs() / p[(axis, axis)].sqrt());
        }
        if t >= ACCURATE_FROM_S {
            (0..3).for_each(|axis| self.square[axis] += e[axis].powi(2));
            self.count += 1.0;
        }
    }
}

fn demo(seed: u64) -> Configuration {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("config/demo.toml");
    let mut configuration = Configuration::read(&path).unwrap();
    configuration.run.seed = seed;
    configuration.run.duration_s = Some(DURATION_S);
    if let Ok(m) = std::env::var("MINIMUM") {
        configuration.areas[0].identifier.minimum_s = m.parse().unwrap();
    }
    configuration
}

fn told(mut configuration: Configuration) -> Configuration {
    let truth = configuration.areas[0].simulation.flexure;
    let model = std::array::from_fn(|i| Flexure { mu: truth[i].mu, b: truth[i].b, sigma: truth[i].sigma });
    configuration.areas[0].identifier.method = IdentifierMethod::Fixed(model);
    configuration
}

fn run(configuration: &Configuration) -> Errors {
    let mut errors = Errors::default();
    offline::run(configuration, &mut errors).unwrap();
    errors
}

#[test]
fn explore() {
    let n: u64 = std::env::var("SEEDS").map_or(16, |s| s.parse().unwrap());
    let jobs: Vec<u64> = (1..=n).collect();
    let results: Vec<(u64, Errors, Errors)> = std::thread::scope(|scope| {
        let halves: Vec<_> = jobs
            .chunks(jobs.len().div_ceil(2))
            .map(|c| {
                scope.spawn(move || c.iter().map(|&s| (s, run(&demo(s)), run(&told(demo(s))))).collect::<Vec<_>>())
            })
            .collect();
        halves.into_iter().flat_map(|h| h.join().unwrap()).collect()
    });
    let rms = |e: &Errors| e.square.map(|s| (s / e.count).sqrt() / unit::ARCMIN);
    let mut pooled = [[0.0; 3]; 2];
    let mut nees = [0.0; 2];
    for (seed, a, b) in &results {
        println!(
            "{seed:3} {:.2?} nees {:6.2} worst {:5.2}  | told {:.2?} nees {:6.2} worst {:5.2}",
            rms(a),
            a.nees,
            a.worst_early,
            rms(b),
            b.nees,
            b.worst_early
        );
        for i in 0..3 {
            pooled[0][i] += rms(a)[i].powi(2) / n as f64;
            pooled[1][i] += rms(b)[i].powi(2) / n as f64;
        }
        nees[0] += a.nees / n as f64 / 3.0;
        nees[1] += b.nees / n as f64 / 3.0;
    }
    println!("pooled {:.3?} told {:.3?} nees/3 {:.2?}", pooled[0].map(f64::sqrt), pooled[1].map(f64::sqrt), nees);
}

#[test]
fn one() {
    let seed = std::env::var("SEED").map_or(9, |s| s.parse().unwrap());
    struct Show(Errors, f64);
    impl Sink for Show {
        fn truth(&mut self, t: &Truth) { self.0.truth(t) }
        fn parameters(&mut self, p: &messages::FlexureParams) { self.0.parameters(p) }
        fn solution(&mut self, s: &Solution) {
            self.0.solution(s);
            let t = unit::seconds(s.header.time_ns);
            if t >= self.1 && t < 130.0 { self.1 += 5.0;
                let e = deformation_error(s, self.0.truth.as_ref().unwrap()).array().map(|e| e / unit::ARCMIN);
                println!("    {t:6.1} valid {} err {e:.2?} sigma {:.2?}", s.valid, [0,4,8].map(|i| s.covariance[i].sqrt()/unit::ARCMIN)); }
        }
    }
    offline::run(&demo(seed), &mut Show(Errors::default(), 0.0)).unwrap();
}
