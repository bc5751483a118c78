//! Standard deviations against time, over several runs.

use messages::{Flags, Solution};
use pipeline::offline::Sink;
use std::collections::VecDeque;

const SECOND_NS: i64 = 1_000_000_000;
/// The covariance swings with the ship, so a standard deviation is a mean over about two of her swings, s.
pub const SWINGS_S: f64 = 20.0;

/// What the filter knows at one time: root mean square over the runs and the last 20 s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Time since the first sample, s.
    pub t_s: f64,
    /// Standard deviation of the total deformation's error about the axes of m, rad.
    pub total: [f64; 3],
    /// That of its static part, rad.
    pub fixed: [f64; 3],
}

/// Variances of the total deformation, then of its static part, rad^2.
type Variances = [[f64; 3]; 2];

/// Takes one run's variances, the mean of the valid ones of each second.
pub struct Watch<F: FnMut(u64)> {
    areas: Vec<Seen>,
    begin_ns: Option<i64>,
    passed: F,
    reached: u64,
}

/// What was seen of one area.
#[derive(Clone, Default)]
pub struct Seen {
    seconds: Vec<Second>,
    /// Flags of the last solution.
    flags: Flags,
}

/// The valid solutions of a second.
#[derive(Clone, Copy, Default)]
struct Second {
    sums: Variances,
    count: f64,
}

impl Second {
    fn add(&mut self, variances: &Variances) {
        (0..2).for_each(|part| (0..3).for_each(|axis| self.sums[part][axis] += variances[part][axis]));
        self.count += 1.0;
    }

    fn mean(&self) -> Option<Variances> {
        (self.count > 0.0).then(|| self.sums.map(|part| part.map(|sum| sum / self.count)))
    }
}

impl<F: FnMut(u64)> Watch<F> {
    /// Has seen nothing yet; `passed` is told how many more seconds of data have been run over.
    pub fn new(areas: usize, passed: F) -> Self {
        Self { areas: vec![Seen::default(); areas], begin_ns: None, passed, reached: 0 }
    }

    /// By area.
    pub fn finish(self) -> Vec<Seen> {
        self.areas
    }
}

impl<F: FnMut(u64)> Sink for Watch<F> {
    fn solution(&mut self, solution: &Solution) {
        let time_ns = solution.header.time_ns;
        let since_ns = (time_ns - *self.begin_ns.get_or_insert(time_ns)).max(0);
        // a second ends with the solution at its end
        let second = (since_ns + SECOND_NS - 1) / SECOND_NS;
        let reached = second as u64;
        if reached > self.reached {
            (self.passed)(reached - self.reached);
            self.reached = reached;
        }
        let seen = &mut self.areas[solution.area as usize];
        seen.flags = solution.flags;
        seen.seconds.resize(seen.seconds.len().max(second as usize + 1), Second::default());
        if solution.is_valid() {
            let diagonal = |p: &[f64; 9]| [p[0], p[4], p[8]];
            seen.seconds[second as usize].add(&[&solution.covariance, &solution.static_covariance].map(diagonal));
        }
    }
}

/// Root mean square of the runs' standard deviations at each second at which all runs have valid ones.
pub fn pooled(runs: &[&Seen], duration_s: f64) -> Vec<Point> {
    let seconds = runs.iter().map(|run| run.seconds.len()).min().unwrap_or(0);
    let mut last = VecDeque::new();
    let point = |second: usize| {
        let t_s = (second as f64).min(duration_s);
        let mut runs_mean = Second::default();
        for run in runs {
            runs_mean.add(&run.seconds[second].mean()?);
        }
        last.push_back((t_s, runs_mean.mean()?));
        while last.pop_front_if(|(then_s, _)| *then_s <= t_s - SWINGS_S).is_some() {}
        let mut swings = Second::default();
        last.iter().for_each(|(_, variances)| swings.add(variances));
        let [total, fixed] = swings.mean()?.map(|part| part.map(f64::sqrt));
        Some(Point { t_s, total, fixed })
    };
    (0..seconds).filter_map(point).collect()
}

/// Whether the motion did not show the installation in one of the runs.
pub fn is_unobservable(runs: &[&Seen]) -> bool {
    runs.iter().any(|run| run.flags.contains(Flags::UNOBSERVABLE))
}
