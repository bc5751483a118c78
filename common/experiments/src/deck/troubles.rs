//! What goes wrong on a ship, on paper 000's scenario: whether the range holds the error all the same.

mod conclude;

use super::method::{self, run_blind};
use super::scenario::SPIKE_THRESHOLD;
use crate::{Data, Fault, Point, Stretch, Study, Track, Trial, Trials, presets};
use frames::unit::{ARCMIN, ARCSEC};
use messages::Flags;
use pipeline::configuration::Configuration;
use simulation::{Event, FlexureChange, GaussMarkov, QuasiStatic, SeaChange, Trouble};

/// Half an hour, for events.
const EVENTS_S: f64 = 1800.0;
/// An hour, for what is slow.
const SLOW_S: f64 = 3600.0;
/// Of a quick run, whatever the case.
const QUICK_S: f64 = 240.0;
/// An event comes after this part of a run, when the estimator has settled.
const AFTER: f64 = 1.0 / 3.0;
/// Errors count from here on, s.
const FROM_S: f64 = 60.0;
/// Points of a figure are so far apart, s.
const DRAWN_S: f64 = 1.0;

/// A case.
#[derive(Clone, Copy, Debug)]
struct Case {
    id: &'static str,
    title: &'static str,
    duration_s: f64,
    /// Whether it begins at a time, or else is there from the start.
    event: bool,
    /// Puts it into a scenario, at a time (s).
    change: fn(&mut Configuration, f64),
}

const fn event(id: &'static str, title: &'static str, change: fn(&mut Configuration, f64)) -> Case {
    Case { id, title, duration_s: EVENTS_S, event: true, change }
}

const CASES: [Case; 8] = [
    Case { event: false, ..event("none", "nothing goes wrong", |_, _| {}) },
    event("dead-accelerometers", "the sub unit's accelerometers die", |c, at_s| {
        befall(c, at_s, Trouble::DeadAccelerometers);
    }),
    event("stuck-gyro", "the sub unit's gyro y is stuck", |c, at_s| befall(c, at_s, Trouble::StuckGyro(1))),
    event("gap", "no samples of the sub unit for 30 s", |c, at_s| befall(c, at_s, Trouble::Gap(30.0))),
    event("delay-step", "the sub unit's stamps are later by 10 ms", |c, at_s| {
        befall(c, at_s, Trouble::DelayStep(10e-3));
    }),
    event("sea", "the sea is doubled within a minute", rougher),
    Case {
        event: false,
        ..event("second-mode", "a second mode of 0.3 Hz and 2 arcmin", |c, _| {
            let second = GaussMarkov::damped(0.2, 0.3, 2.0 * ARCMIN);
            c.areas[0].simulation.second_flexure = Some([second; 3]);
        })
    },
    Case {
        event: false,
        duration_s: SLOW_S,
        ..event("thermal", "the static part drifts by 0.1 degrees in an hour", |c, _| {
            // the first twelfth of a sinusoid is nearly a straight line
            c.areas[0].simulation.quasi_static =
                QuasiStatic { amplitude: [720.0 * ARCSEC; 3], period: 12.0 * SLOW_S, phase: [0.0; 3] };
        })
    },
];

fn befall(c: &mut Configuration, at_s: f64, trouble: Trouble) {
    c.areas[0].simulation.events = vec![Event { at_s, trouble }];
}

/// The hull feels the sea's change in the middle of it, and takes its own time to swing as strongly.
fn rougher(c: &mut Configuration, at_s: f64) {
    let change = SeaChange { at_s, factor: 2.0, ramp_s: 60.0 };
    c.simulation.sea_change = Some(change);
    let area = &mut c.areas[0].simulation;
    let flexure = area.flexure.map(|axis| GaussMarkov { sigma: change.factor * axis.sigma, ..axis });
    area.flexure_changes = vec![FlexureChange { at_s: at_s + change.ramp_s / 2.0, flexure }];
}

impl Case {
    fn duration_s(&self, quick: bool) -> f64 {
        if quick { QUICK_S } else { self.duration_s }
    }

    fn at_s(&self, quick: bool) -> f64 {
        self.duration_s(quick) * AFTER
    }

    fn configuration(&self, trial: &Trial) -> Result<Configuration, Fault> {
        Ok(presets::configuration("idam", trial.seed)?.with(|c| {
            c.run.duration_s = Some(self.duration_s(trial.quick));
            c.spike_threshold = SPIKE_THRESHOLD;
            (self.change)(c, self.at_s(trial.quick));
        }))
    }
}

/// How many instants there are, in how many of them a solution is valid, and in how many of these the range holds the error.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Counts {
    all: usize,
    valid: usize,
    held: [usize; 3],
}

impl Counts {
    fn of(stretch: Stretch) -> Self {
        let mut counts = Self { all: stretch.points.len(), ..Self::default() };
        for point in stretch.points.iter().filter(|point| point.valid) {
            counts.valid += 1;
            (0..3).for_each(|axis| counts.held[axis] += usize::from(point.error[axis].abs() <= point.range[axis]));
        }
        counts
    }

    fn and(self, other: Self) -> Self {
        let held = [0, 1, 2].map(|axis| self.held[axis] + other.held[axis]);
        Self { all: self.all + other.all, valid: self.valid + other.valid, held }
    }

    /// Share of the valid instants in which the range holds the error about some axes; NaN if none is valid.
    fn held_share(&self, axes: &[usize]) -> f64 {
        axes.iter().map(|&axis| self.held[axis]).sum::<usize>() as f64 / (self.valid * axes.len()) as f64
    }

    fn valid_share(&self) -> f64 {
        self.valid as f64 / self.all as f64
    }
}

/// What is kept of a trial.
#[derive(Clone, Debug)]
struct Measured {
    seed: u64,
    /// The event, s.
    at_s: f64,
    /// From one minute on.
    whole: Counts,
    /// From the event on.
    after: Counts,
    /// The largest error over the range about each axis, from one minute on.
    largest: [f64; 3],
    /// In how many instants from one minute on each flag is set.
    flags: Vec<(Flags, usize)>,
    /// What is drawn: of the first trial, thinned out.
    drawn: Vec<Point>,
}

impl Measured {
    fn of(track: &Track, case: &Case, trial: &Trial) -> Self {
        let at_s = case.at_s(trial.quick);
        let whole = track.over(FROM_S..);
        let over = |axis: usize| {
            let valid = whole.points.iter().filter(|point| point.valid);
            valid.map(|point| point.error[axis].abs() / point.range[axis]).fold(f64::NAN, f64::max)
        };
        let count = |flag| whole.points.iter().filter(|point| point.flags.contains(flag)).count();
        Self {
            seed: trial.seed,
            at_s,
            whole: Counts::of(whole),
            after: Counts::of(track.over(at_s..)),
            largest: [0, 1, 2].map(over),
            flags: Flags::all().iter().map(|flag| (flag, count(flag))).collect(),
            drawn: if trial.index == 0 { thinned(whole.points) } else { Vec::new() },
        }
    }
}

fn thinned(points: &[Point]) -> Vec<Point> {
    let mut due_s = f64::NEG_INFINITY;
    let is_due = |point: &&Point| {
        let is_due = point.time_s >= due_s;
        if is_due {
            due_s = point.time_s + DRAWN_S;
        }
        is_due
    };
    points.iter().filter(is_due).copied().collect()
}

pub(crate) fn studies() -> Vec<Study> {
    let study = |case: &'static Case| {
        let trials = Trials { full: 8, quick: 1 };
        let conclude = |trials: &[Measured]| conclude::conclude(case, trials);
        Study::new(trials, case.duration_s as u64, |trial| measure(case, trial), conclude)
    };
    CASES.iter().map(study).collect()
}

fn measure(case: &Case, trial: &Trial) -> Result<Measured, Fault> {
    let configuration = case.configuration(trial)?;
    let track = run_blind(&method::default(&configuration), &Data::simulate(&configuration)?);
    Ok(Measured::of(&track, case, trial))
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use frames::{Main, Rot, Sub, Vec3};
    use messages::{Header, Solution, Truth};

    /// A case that changes nothing would hold its error without saying anything.
    #[test]
    fn every_case_but_the_first_changes_the_scenario_within_the_run() {
        for quick in [false, true] {
            let trial = Trial { index: 0, seed: 1, quick };
            let scenarios = CASES.map(|case| {
                let duration_s = Some(EVENTS_S);
                simulation::Scenario { duration_s, ..case.configuration(&trial).unwrap().scenario(1) }
            });
            for (i, scenario) in scenarios.iter().enumerate() {
                assert!(scenarios[..i].iter().all(|other| other != scenario), "{}", CASES[i].id);
            }
            for case in &CASES {
                let (at_s, duration_s) = (case.at_s(quick), case.duration_s(quick));
                assert!(at_s > FROM_S && at_s + 60.0 < duration_s, "{}", case.id);
            }
        }
    }

    #[test]
    fn the_static_part_drifts_by_a_tenth_of_a_degree_in_the_hour() {
        let case = CASES.iter().find(|case| case.id == "thermal").unwrap();
        let trial = Trial { index: 0, seed: 1, quick: false };
        let mut scenario = case.configuration(&trial).unwrap().scenario(1);
        scenario.rate_hz = 10.0;
        let mut simulator = simulation::Simulator::new(&scenario);
        let mut parts = Vec::new();
        while let Some(epoch) = simulator.step() {
            parts.push(Rot::<Main, Sub>::from_wxyz(epoch.truth[0].static_q));
        }
        let turned = (parts[parts.len() - 1] * parts[0].inverse()).log();
        assert!((turned - Vec3::new(1.0, 1.0, 1.0) * (6.0 * ARCMIN)).norm() < 1e-3 * ARCMIN, "{turned:?}");
    }

    /// 100 s at 10 Hz with a range of 1; from the event at 80 s on the error about y is 2, from 90 s on nothing is valid.
    #[test]
    fn shares_are_of_valid_instants_and_the_largest_is_over_the_range() {
        let mut track = Track::new(0.0);
        for sequence in 0..1000 {
            let header = Header { sequence, time_ns: sequence as i64 * 100_000_000, ..Header::default() };
            let error = if sequence < 800 { 0.5e-3 } else { 2e-3 };
            let q = Rot::<Main, Sub>::exp(Vec3::new(0.0, error, 0.0)).quaternion();
            let valid = u32::from(sequence < 900);
            let flags = if sequence < 900 { Flags::INTERPOLATED } else { Flags::GAP };
            let solution = Solution { header, q, range: [1e-3; 3], valid, flags, ..Solution::default() };
            track.take(&solution, &Truth { header, q: [1.0, 0.0, 0.0, 0.0], ..Truth::default() });
        }
        let trial = Trial { index: 0, seed: 1, quick: true };
        let measured = Measured::of(&track, &CASES[1], &trial);
        assert_eq!(measured.whole, Counts { all: 400, valid: 300, held: [300, 200, 300] });
        assert_eq!(measured.after, Counts { all: 200, valid: 100, held: [100, 0, 100] });
        assert!((measured.largest[1] - 2.0).abs() < 1e-9 && measured.largest[0] < 1e-9);
        let of = |flag| measured.flags.iter().find(|(seen, _)| *seen == flag).unwrap().1;
        assert_eq!([Flags::INTERPOLATED, Flags::GAP, Flags::SPIKE].map(of), [300, 100, 0]);
        assert!((39..=41).contains(&measured.drawn.len()), "{}", measured.drawn.len());
        let pooled = measured.whole.and(measured.after);
        assert_eq!((pooled.held_share(&[1]), pooled.held_share(&[0, 1, 2])), (0.5, 1000.0 / 1200.0));
        assert!(Counts::default().held_share(&[0]).is_nan());
    }
}
