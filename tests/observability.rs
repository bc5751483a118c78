//! What the output says when the motion shows the installation, a part of it, or nothing; and how it comes through gaps.
#![allow(clippy::unwrap_used)]

use frames::{Main, Rot, Sub, Vec3, unit};
use messages::{Flags, Solution, Truth};
use pipeline::configuration::{Configuration, EstimatorSettings, IdentifierSettings};
use pipeline::offline::{self, Sink};
use pipeline::summary::deformation_error;
use simulation::SeaChange;

/// One area; `ship`, `area` and `sub` are lines for their tables.
fn configuration(ship: &str, area: &str, simulation: &str, seed: u64, duration_s: f64) -> Configuration {
    let gyro = "gyro = { arw_deg_per_sqrt_h = 0.001, bias_deg_per_h = 0.01, scale_ppm = 5, misalignment_arcsec = 5 }";
    let text = format!(
        "rate_hz = 100\n[main]\nsource = {{ kind = \"simulator\" }}\n{gyro}\n[simulation]\n{ship}\n[run]\nseed = {seed}\n\
         duration_s = {duration_s}\n[[area]]\nname = \"radar\"\nsource = {{ kind = \"simulator\" }}\n{gyro}\n{area}\n\
         [area.estimator]\nmatching = \"so3\"\n[area.identifier]\nmethod = \"rvm\"\nwindow_s = 300\nminimum_s = 10\n[area.simulation]\n{simulation}\n"
    );
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("test.toml");
    std::fs::write(&path, text).unwrap();
    Configuration::read(&path).unwrap()
}

const NO_SWAY: &str = "roll = { amplitude_deg = 0 }\npitch = { amplitude_deg = 0 }\nheading = { amplitude_deg = 0 }";
const ROLL_ONLY: &str = "pitch = { amplitude_deg = 0 }\nheading = { amplitude_deg = 0 }";
/// The simulator's installation of 10, 10, 30 arcmin, surveyed 1 degree off about z.
const SURVEYED: &str = "installation = { rotation_vector_deg = [0.166667, 0.166667, 1.2], sigma_deg = 1 }";

#[derive(Default)]
struct All {
    truths: Vec<Truth>,
    solutions: Vec<Solution>,
}

impl Sink for All {
    fn truth(&mut self, truth: &Truth) {
        self.truths.push(*truth);
    }
    fn solution(&mut self, solution: &Solution) {
        self.solutions.push(*solution);
    }
}

impl All {
    fn of(configuration: &Configuration) -> Self {
        let mut all = Self::default();
        offline::run(configuration, &mut all).unwrap();
        all
    }

    /// The last solution with data, and its error: the very last pair may lack the sub unit's later samples.
    fn last(&self) -> (&Solution, Vec3<Main>) {
        let solution = self.solutions.iter().rfind(|s| !s.flags.contains(Flags::GAP)).unwrap();
        let truth = self.truths.iter().find(|t| t.header.sequence == solution.header.sequence).unwrap();
        (solution, deformation_error(solution, truth))
    }
}

fn sigma(solution: &Solution, axis: usize) -> f64 {
    solution.covariance[4 * axis].sqrt()
}

#[test]
fn without_sway_and_survey_nothing_is_claimed() {
    let all = All::of(&configuration(NO_SWAY, "", "", 3, 60.0));
    assert_eq!(all.solutions.len(), 6001);
    assert!(all.solutions.iter().all(|s| !s.is_valid()));
    assert!(all.solutions.last().unwrap().flags.contains(Flags::UNOBSERVABLE | Flags::REGISTERING));
}

#[test]
fn without_sway_the_survey_is_all_there_is() {
    for seed in 1..=4 {
        let all = All::of(&configuration(NO_SWAY, SURVEYED, "", seed, 300.0));
        let (last, error) = all.last();
        assert!(last.is_valid() && last.flags.contains(Flags::INSTALLATION | Flags::UNOBSERVABLE));
        for axis in 0..3 {
            assert!(sigma(last, axis) > 0.9 * unit::DEGREE, "seed {seed}: nothing shows axis {axis}");
            assert!(error.array()[axis].abs() < 3.0 * sigma(last, axis), "seed {seed} axis {axis}");
        }
    }
}

#[test]
fn roll_alone_leaves_the_angle_about_its_own_axis_unknown() {
    for seed in 1..=4 {
        let all = All::of(&configuration(ROLL_ONLY, SURVEYED, "", seed, 300.0));
        let (last, error) = all.last();
        assert!(last.is_valid() && last.flags.contains(Flags::UNOBSERVABLE), "seed {seed}");
        assert!(sigma(last, 1) > 0.7 * unit::DEGREE, "seed {seed}: {}", sigma(last, 1) / unit::DEGREE);
        for axis in [0, 2] {
            assert!(sigma(last, axis) < 0.1 * unit::DEGREE, "seed {seed}: roll shows axis {axis}");
        }
        (0..3).for_each(|axis| assert!(error.array()[axis].abs() < 3.5 * sigma(last, axis), "seed {seed} axis {axis}"));
    }
}

/// What both units felt in port is of no use to a filter that starts at sea.
#[test]
fn a_ship_that_sails_after_a_quarter_of_an_hour_is_registered_then() {
    let sails_s = 900.0;
    let ship = "roll = { amplitude_deg = 5e-4 }\npitch = { amplitude_deg = 5e-4 }\nheading = { amplitude_deg = 5e-4 }";
    let configuration = configuration(ship, "", "", 1, sails_s + 200.0).with(|c| {
        c.areas[0].estimator = EstimatorSettings::default();
        c.areas[0].identifier = IdentifierSettings::default();
        c.simulation.sea_change = Some(SeaChange { at_s: sails_s, factor: 8e3, ramp_s: 30.0 });
    });
    let all = All::of(&configuration);
    let (port, sea): (Vec<&Solution>, Vec<&Solution>) =
        all.solutions.iter().partition(|solution| unit::seconds(solution.header.time_ns) < sails_s);
    assert!(port.iter().all(|solution| !solution.is_valid()));
    assert!(sea.iter().skip(10_000).all(|solution| solution.is_valid() || solution.flags.contains(Flags::GAP)));
    let (last, error) = all.last();
    assert!((0..3).all(|axis| error.array()[axis].abs() < 3.0 * sigma(last, axis)), "{error:?}");
}

#[test]
fn any_installation_angle_is_found_blind() {
    let turns = ["[1200, 600, 2400]", "[5400, 0, 0]", "[0, 0, 10739]", "[6000, -6000, 6000]"];
    for (seed, turn) in (1..).zip(turns) {
        let simulation = format!("installation_rotation_vector_arcmin = {turn}");
        let all = All::of(&configuration("", "", &simulation, seed, 180.0));
        let (last, error) = all.last();
        assert!(last.is_valid() && !last.flags.contains(Flags::UNOBSERVABLE), "{turn}");
        assert!(error.norm() < 4.0 * unit::ARCMIN, "{turn}: {} arcmin", error.norm() / unit::ARCMIN);
    }
}

/// A line that loses a fifth of the samples, repeats and swaps others: bridged, flagged, survived.
#[test]
fn a_bad_line_widens_the_range_and_no_more() {
    let wire = "wire = { phase_ms = 4, rate_error_ppm = 30, loss = 0.2, duplicate = 0.05, swap = 0.05 }";
    for seed in 1..=3 {
        let all = All::of(&configuration("", "", wire, seed, 180.0));
        assert_eq!(all.solutions.len(), 18001);
        let bridged = all.solutions.iter().filter(|s| s.flags.contains(Flags::BRIDGED)).count();
        assert!(bridged > 2000, "{bridged}");
        let (last, error) = all.last();
        assert!(last.is_valid());
        (0..3).for_each(|axis| assert!(error.array()[axis].abs() < 4.0 * sigma(last, axis), "seed {seed} axis {axis}"));
    }
}

/// The constant of a pair of rotations is no business of the sub unit's own axes: turning them with `mounting` changes nothing.
#[test]
fn mounting_turns_a_unit_back() {
    let plain = All::of(&configuration("", "", "", 5, 40.0));
    let mounting = "mounting = { rotation_vector_deg = [0, 0, 90] }";
    let turned = All::of(&configuration("", mounting, "", 5, 40.0));
    let q = |all: &All| Rot::<Main, Sub>::from_wxyz(all.solutions.last().unwrap().q);
    let apart = (q(&plain) * q(&turned).inverse()).angle() / unit::ARCMIN;
    assert!(apart < 1.0, "{apart} arcmin");
}
