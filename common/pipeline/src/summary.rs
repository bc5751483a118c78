//! The figures of a run: `summary.json`.

use crate::solution_file::deviations;
use estimation::evaluate::NORMAL_95;
use frames::{Main, Nav, Rot, Sub, Vec3, unit};
use messages::{Flags, Solution, Truth};
use serde::Serialize;
use std::collections::VecDeque;
use std::io;
use std::path::Path;

/// Truths that wait for their solution: those of the algorithm's wait and of a silent unit.
const WAITING: usize = 4096;

/// The figures of all areas.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Summary {
    /// One entry an area, in the configuration's order.
    pub areas: Vec<AreaSummary>,
}

/// The figures of one area. Error figures are missing without truth, others without a valid solution.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct AreaSummary {
    /// Name of the area.
    pub name: String,
    /// Solutions, valid or not.
    pub samples: u64,
    /// Share of valid ones.
    pub valid_fraction: f64,
    /// From which time after the first sample on the figures below are taken, s.
    pub settled_from_s: f64,
    /// Valid solutions from then on.
    pub settled_samples: u64,
    /// Root mean square error of the deformation in m.
    pub rmse_arcsec: Option<[f64; 3]>,
    /// Root mean square of the filter's standard deviations.
    pub sigma_arcsec: Option<[f64; 3]>,
    /// Share of solutions whose error lies within the published range.
    pub coverage_95: Option<[f64; 3]>,
    /// Root mean square error of the deck's attitude about east, north, up.
    pub deck_rmse_arcsec: Option<[f64; 3]>,
    /// Share of solutions whose deck attitude lies within 1.96 of its standard deviations.
    pub deck_coverage_95: Option<[f64; 3]>,
    /// Rotation vector of the installation as the motion alone shows it, averaged over the run; missing where it does not.
    pub installation_deg: Option<[f64; 3]>,
    /// Its standard deviation.
    pub installation_sigma_deg: Option<[f64; 3]>,
    /// Rotation vector of the filter's static part at the last valid solution.
    pub static_deg: Option<[f64; 3]>,
    /// Its standard deviation.
    pub static_sigma_deg: Option<[f64; 3]>,
    /// Rotation vector of the zero that the solutions are told from; missing without one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub zero_deg: Option<[f64; 3]>,
    /// Parameter sets used.
    pub parameter_sets: u64,
}

/// Sums of one stretch of an area's solutions.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    samples: u64,
    with_truth: u64,
    with_deck: u64,
    square: [f64; 3],
    variance: [f64; 3],
    covered: [u64; 3],
    deck_square: [f64; 3],
    deck_covered: [u64; 3],
}

/// Collects the figures of one area.
#[derive(Clone, Debug)]
pub struct Figures {
    name: String,
    settle_ns: i64,
    begin_ns: Option<i64>,
    samples: u64,
    valid: u64,
    all: Sums,
    settled: Sums,
    truths: VecDeque<Truth>,
    last: Option<Solution>,
    params_id: u64,
    parameter_sets: u64,
}

impl Figures {
    /// Of an area; error figures leave out the first `settle_s`.
    pub fn new(name: &str, settle_s: f64) -> Self {
        Self {
            name: name.to_owned(),
            settle_ns: unit::nanoseconds(settle_s),
            begin_ns: None,
            samples: 0,
            valid: 0,
            all: Sums::default(),
            settled: Sums::default(),
            truths: VecDeque::new(),
            last: None,
            params_id: 0,
            parameter_sets: 0,
        }
    }

    /// Takes the truth of an instant.
    pub fn truth(&mut self, truth: &Truth) {
        if self.truths.len() == WAITING {
            self.truths.pop_front();
        }
        self.truths.push_back(*truth);
    }

    /// Takes a solution.
    pub fn solution(&mut self, solution: &Solution) {
        self.samples += 1;
        if solution.params_id != self.params_id {
            (self.params_id, self.parameter_sets) = (solution.params_id, self.parameter_sets + 1);
        }
        let time_ns = solution.header.time_ns;
        let begin_ns = *self.begin_ns.get_or_insert(time_ns);
        while self.truths.front().is_some_and(|truth| truth.header.sequence < solution.header.sequence) {
            self.truths.pop_front();
        }
        if !solution.is_valid() {
            return;
        }
        let truth = self.truths.front().filter(|truth| truth.header.sequence == solution.header.sequence);
        self.valid += 1;
        self.last = Some(*solution);
        self.all.add(solution, truth);
        if time_ns - begin_ns >= self.settle_ns {
            self.settled.add(solution, truth);
        }
    }

    /// The figures so far. A run too short to settle is taken whole.
    pub fn summary(&self) -> AreaSummary {
        let settled = self.settled.samples > 0;
        let sums = if settled { &self.settled } else { &self.all };
        let arcsec = |square: [f64; 3], n: u64| (n > 0).then(|| square.map(|s| (s / n as f64).sqrt() / unit::ARCSEC));
        let share = |covered: [u64; 3], n: u64| (n > 0).then(|| covered.map(|c| c as f64 / n as f64));
        let degrees = |v: [f64; 3]| v.map(|x| x / unit::DEGREE);
        let vector = |q: [f64; 4]| Rot::<Main, Sub>::from_wxyz(q).log().array();
        let registered = self.last.filter(|last| last.registered != [0.0; 4]);
        AreaSummary {
            name: self.name.clone(),
            samples: self.samples,
            valid_fraction: if self.samples > 0 { self.valid as f64 / self.samples as f64 } else { 0.0 },
            settled_from_s: if settled { unit::seconds(self.settle_ns) } else { 0.0 },
            settled_samples: sums.samples,
            rmse_arcsec: arcsec(sums.square, sums.with_truth),
            sigma_arcsec: arcsec(sums.variance, sums.samples),
            coverage_95: share(sums.covered, sums.with_truth),
            deck_rmse_arcsec: arcsec(sums.deck_square, sums.with_deck),
            deck_coverage_95: share(sums.deck_covered, sums.with_deck),
            installation_deg: registered.map(|last| degrees(vector(last.registered))),
            installation_sigma_deg: registered.map(|last| degrees(last.registered_sigma)),
            static_deg: self.last.map(|last| degrees(vector(last.static_q))),
            static_sigma_deg: self.last.map(|last| degrees(deviations(&last.static_covariance))),
            zero_deg: self.last.filter(|last| last.flags.contains(Flags::ZEROED)).map(|last| degrees(last.zero)),
            parameter_sets: self.parameter_sets,
        }
    }
}

impl Sums {
    fn add(&mut self, solution: &Solution, truth: Option<&Truth>) {
        self.samples += 1;
        for axis in 0..3 {
            self.variance[axis] += solution.covariance[4 * axis];
        }
        let Some(truth) = truth else { return };
        self.with_truth += 1;
        let error = deformation_error(solution, truth);
        for axis in 0..3 {
            self.square[axis] += error.array()[axis].powi(2);
            self.covered[axis] += u64::from(error.array()[axis].abs() <= solution.range[axis]);
        }
        if solution.deck != [0.0; 4] {
            self.with_deck += 1;
            let error = deck_error(solution, truth).array();
            for axis in 0..3 {
                self.deck_square[axis] += error[axis].powi(2);
                self.deck_covered[axis] += u64::from(error[axis].abs() <= NORMAL_95 * solution.deck_sigma[axis]);
            }
        }
    }
}

/// `Log(C_hat C_true^T)` of the deformation, rad, in m.
pub fn deformation_error(solution: &Solution, truth: &Truth) -> Vec3<Main> {
    let (found, real) = (Rot::<Main, Sub>::from_wxyz(solution.q), Rot::<Main, Sub>::from_wxyz(truth.q));
    (found * real.inverse()).log()
}

/// The same of the deck's attitude, about east, north, up.
pub fn deck_error(solution: &Solution, truth: &Truth) -> Vec3<Nav> {
    let real = Rot::<Nav, Main>::from_wxyz(truth.ship) * Rot::<Main, Sub>::from_wxyz(truth.q);
    (Rot::<Nav, Sub>::from_wxyz(solution.deck) * real.inverse()).log()
}

impl Summary {
    /// Writes the figures as JSON.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write(&self, path: &Path) -> io::Result<()> {
        let mut text = serde_json::to_string_pretty(self)?;
        text.push('\n');
        std::fs::write(path, text)
    }
}
