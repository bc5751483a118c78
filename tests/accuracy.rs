//! Accuracy of the demo scenario beside its bound, over fixed seeds; and of real units on one rigid board.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use frames::{Main, Rot, Sub, Vec3, unit};
use messages::{Solution, Truth};
use nalgebra::{Matrix3, Vector3};
use pipeline::configuration::{Configuration, IdentifierMethod};
use pipeline::offline::{self, Sink};
use pipeline::summary::deformation_error;
use std::collections::VecDeque;
use std::path::{Path, PathBuf};

/// Errors count from here to the end, s.
const FROM_S: f64 = 120.0;
const DURATION_S: f64 = 600.0;

/// Errors of one run of the demo.
#[derive(Default)]
struct Errors {
    /// Those to which no solution has come yet.
    truths: VecDeque<Truth>,
    square: [f64; 3],
    count: f64,
    /// Normalised squared error of the last solution.
    nees: f64,
    deck_outside: f64,
}

impl Sink for Errors {
    fn truth(&mut self, truth: &Truth) {
        self.truths.push_back(*truth);
    }

    fn solution(&mut self, solution: &Solution) {
        // a suspicious sample waits for the two after it
        while self.truths.pop_front_if(|truth| truth.header.sequence < solution.header.sequence).is_some() {}
        let truth = *self.truths.front().filter(|truth| truth.header.sequence == solution.header.sequence).unwrap();
        let truth = &truth;
        if !solution.is_valid() || unit::seconds(solution.header.time_ns) < FROM_S {
            return;
        }
        let error: Vector3<f64> = deformation_error(solution, truth).column();
        let p = Matrix3::from_row_slice(&solution.covariance);
        self.nees = (error.transpose() * p.try_inverse().unwrap() * error)[0];
        (0..3).for_each(|axis| self.square[axis] += error[axis].powi(2));
        let deck = pipeline::summary::deck_error(solution, truth).array();
        self.deck_outside +=
            (0..3).filter(|&axis| deck[axis].abs() > 1.96 * solution.deck_sigma[axis]).count() as f64 / 3.0;
        self.count += 1.0;
    }
}

fn demo(seed: u64) -> Configuration {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("config/demo.toml");
    let mut configuration = Configuration::read(&path).unwrap();
    configuration.run.seed = seed;
    configuration.run.duration_s = Some(DURATION_S);
    configuration
}

/// The same run by a filter that is told the true flexure model: the bound.
fn told(seed: u64) -> Configuration {
    let mut configuration = demo(seed);
    let area = &mut configuration.areas[0];
    area.identifier.method = IdentifierMethod::Fixed(area.simulation.hull());
    configuration
}

/// The runs of these configurations, on two threads.
fn runs(configurations: Vec<Configuration>) -> Vec<Errors> {
    let run = |configuration: &Configuration| {
        let mut errors = Errors::default();
        offline::run(configuration, &mut errors).unwrap();
        errors
    };
    std::thread::scope(|scope| {
        let halves = configurations.chunks(configurations.len().div_ceil(2));
        let started: Vec<_> =
            halves.map(|half| scope.spawn(move || half.iter().map(run).collect::<Vec<_>>())).collect();
        started.into_iter().flat_map(|half| half.join().unwrap()).collect()
    })
}

/// Root mean square error per axis over all runs, arcmin.
fn rms(runs: &[Errors]) -> [f64; 3] {
    let mean = |axis: usize| runs.iter().map(|run| run.square[axis] / run.count).sum::<f64>() / runs.len() as f64;
    [0, 1, 2].map(|axis| mean(axis).sqrt() / unit::ARCMIN)
}

#[test]
fn demo_stays_near_the_filter_that_is_told_the_flexure() {
    let found = runs((1..=30).map(demo).collect());
    let bound = runs((1..=16).map(told).collect());
    let (ours, theirs) = (rms(&found[..16]), rms(&bound));
    let norm = |v: [f64; 3]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
    let ratio = norm(ours) / norm(theirs);
    let nees: f64 = found.iter().map(|run| run.nees).sum();
    let outside = found.iter().map(|run| run.deck_outside / run.count).sum::<f64>() / 30.0;
    println!("rms arcmin {ours:.3?}, told {theirs:.3?}, ratio {ratio:.3}; NEES of 30 seeds {nees:.1} of 90");
    println!("deck attitude outside its range: {outside:.3}");
    assert!(ratio <= 1.2, "{ratio}");
    assert!(ours[2] <= 0.8 && ours[0] <= 0.75 && ours[1] <= 0.75, "{ours:?}");
    // 95 % of a chi-square with 90 degrees of freedom
    assert!((65.6..118.2).contains(&nees), "{nees}");
    assert!(outside < 0.1, "{outside}");
}

/// The landing aid of two areas, 35 m aft, on a hull that swings at 0.2 Hz: there the flexure makes as much velocity as the ship.
fn lively(seed: u64) -> Configuration {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("config/two_areas.toml");
    let mut configuration = Configuration::read(&path).unwrap();
    configuration.run.seed = seed;
    configuration.run.duration_s = Some(DURATION_S / 2.0);
    configuration.areas.remove(0);
    for axis in &mut configuration.areas[0].simulation.flexure {
        axis.b = 1.2;
    }
    configuration
}

/// The noise that drives a flexure is in the velocities and in the force between them; once that was taken for a delay, by 6 ms and 120 arcsec.
#[test]
fn a_lively_hull_on_a_long_lever_arm_is_not_taken_for_a_delay() {
    let found = runs((1..=16).map(lively).collect());
    let nees: f64 = found.iter().map(|run| run.nees).sum();
    println!("rms arcmin {:.3?}; NEES of 16 seeds {nees:.1} of 48", rms(&found));
    let outside = found.iter().map(|run| run.deck_outside / run.count).sum::<f64>() / 16.0;
    println!("deck attitude outside its range: {outside:.3}");
    assert!(outside < 0.07, "{outside}");
    // 99.9 % of a chi-square with 48 degrees of freedom
    assert!(nees < 84.1, "{nees}");
    assert!(rms(&found).iter().all(|&rms| rms < 1.5), "{:?}", rms(&found));
}

/// What the comparisons leave out lasts for more than a hundredth of a second; once the filter that compares so often believed it to be noise, and was a
/// minute of arc off at a quarter of that.
#[test]
fn a_filter_that_compares_at_every_pair_is_not_surer_than_one_at_ten_hertz() {
    let every_pair = |seed| {
        let mut configuration = lively(seed);
        configuration.areas[0].estimator.filter_hz = configuration.rate_hz;
        configuration
    };
    let found = runs((1..=4).map(every_pair).collect());
    let nees: f64 = found.iter().map(|run| run.nees).sum();
    println!("rms arcmin {:.3?}; NEES of 4 seeds {nees:.1} of 12", rms(&found));
    // 99.9 % of a chi-square with 12 degrees of freedom
    assert!(nees < 32.9, "{nees}");
}

fn recordings() -> Option<PathBuf> {
    let told = std::env::var_os("DECKFLEX_DATA").map(PathBuf::from);
    let folder = told.unwrap_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data")).join("mimu4444");
    if !folder.is_dir() {
        println!("skipped: no data");
        return None;
    }
    Some(folder)
}

/// How often the dynamic part of a rigid board stays within its range, and the last registered installation.
#[derive(Default)]
struct Board {
    valid: f64,
    inside: [f64; 3],
    installation: Option<Rot<Main, Sub>>,
}

impl Sink for Board {
    fn solution(&mut self, solution: &Solution) {
        if !solution.is_valid() {
            return;
        }
        self.valid += 1.0;
        for axis in 0..3 {
            let sigma = solution.dynamic_covariance[4 * axis].sqrt();
            self.inside[axis] += f64::from(solution.dynamic[axis].abs() <= 1.96 * sigma);
        }
        self.installation = Rot::from_quaternion(solution.registered);
    }
}

/// Two MEMS units on one rigid board, turned by hand: the true dynamic deformation is zero, and the installation was determined from
/// nine such recordings together.
#[test]
fn a_rigid_board_has_no_flexure() {
    let Some(folder) = recordings() else { return };
    let half_turn = Rot::<Sub, Main>::exp(Vec3::new(std::f64::consts::PI, 0.0, 0.0));
    let small = |x: f64, y: f64, z: f64| Rot::<Sub, Sub>::exp(Vec3::new(x, y, z) * unit::DEGREE);
    let units = [
        ("exp1_imu3.csv", small(-0.017, -0.018, -0.221) * Rot::<Sub, Main>::identity()),
        ("exp1_imu2.csv", small(0.131, -0.050, -90.192) * half_turn),
    ];
    for (file, sub_from_main) in units {
        let work = tempfile::tempdir().unwrap();
        let grade = "gyro = { arw_deg_per_sqrt_h = 0.6, bias_deg_per_h = 5000, scale_ppm = 20000, misalignment_arcsec = 3600, \
                     stamp_jitter_us = 490, range_deg_per_s = 2000 }";
        let source = |file: &str| format!("source = {{ kind = \"csv\", path = {:?} }}", folder.join(file));
        let main = source("exp1_imu1.csv");
        let sub = source(file);
        let text = format!("rate_hz = 62.5\n[main]\n{main}\n{grade}\n[[area]]\nname = \"board\"\n{sub}\n{grade}\n");
        let path = work.path().join("board.toml");
        std::fs::write(&path, text).unwrap();
        let mut board = Board::default();
        offline::run(&Configuration::read(&path).unwrap(), &mut board).unwrap();
        let error = (board.installation.unwrap() * sub_from_main).angle() / unit::DEGREE;
        let inside = board.inside.map(|n| n / board.valid);
        println!("{file}: installation within {error:.3} deg, dynamic part within its range {inside:.3?} of the time");
        assert!(error < 0.25, "{file}: {error}");
        assert!(inside.iter().all(|&share| share >= 0.95), "{file}: {inside:?}");
    }
}
