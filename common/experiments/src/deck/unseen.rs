//! Where the ship's motion does not show the installation: what the estimator believes of it, against its error.

use super::AXES;
use super::claims::{judged, largest_of};
use super::method::{self, run_blind};
use super::paired::{Paired, root};
use crate::{Bound, Claim, Data, Fault, Findings, Published, Row, Study, Trial, Trials, mean, presets};
use frames::unit::DEGREE;
use frames::{Main, Rot, Vec3};
use pipeline::configuration::{Configuration, Installation};
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;
use simulation::Swing;

/// Length, full and quick, s. Figures are of its second half.
const DURATION_S: (f64, f64) = (600.0, 60.0);
/// What of the prior's deviation must be left where nothing is seen.
const KEPT: f64 = 0.9;
/// RMSE over deviation.
const HONEST: (f64, f64) = (0.5, 2.0);

/// A case.
#[derive(Clone, Copy, Debug)]
struct Case {
    id: &'static str,
    title: &'static str,
    /// Whether the ship rolls.
    rolls: bool,
    /// Whether the units have accelerometers.
    accelerometers: bool,
    /// Whether the installation is known to 1 degree.
    installation: bool,
    /// The axes about which nothing shows the installation: the roll is about y, gravity along z.
    unseen: &'static [usize],
}

const fn case(
    id: &'static str,
    title: &'static str,
    rolls: bool,
    accelerometers: bool,
    unseen: &'static [usize],
) -> Case {
    Case { id, title, rolls, accelerometers, installation: true, unseen }
}

const CASES: [Case; 6] = [
    case("still-gyros", "no sway, gyros only", false, false, &[0, 1, 2]),
    case("still", "no sway", false, true, &[2]),
    case("roll-gyros", "roll only, gyros only", true, false, &[1]),
    case("roll", "roll only", true, true, &[]),
    Case {
        installation: false,
        ..case("still-gyros-blind", "no sway, gyros only, no installation", false, false, &[])
    },
    Case { installation: false, ..case("still-blind", "no sway, no installation", false, true, &[]) },
];

/// A trial of a case.
#[derive(Clone, Copy, Debug)]
struct Measured {
    seed: u64,
    /// Share of the instants with a valid solution.
    valid: f64,
    /// The estimator beside itself, where it is valid.
    own: Option<Paired>,
}

pub(crate) fn studies() -> Vec<Study> {
    let study = |case: &'static Case| {
        let trials = Trials { full: 16, quick: 2 };
        Study::new(trials, DURATION_S.0 as u64, |trial| measure(case, trial), |trials| conclude(case, trials))
    };
    CASES.iter().map(study).collect()
}

fn configuration(case: &Case, trial: &Trial) -> Result<Configuration, Fault> {
    let mut source = Pcg64Mcg::seed_from_u64(trial.seed);
    let mut normal = || -> f64 { StandardNormal.sample(&mut source) };
    let error = Vec3::<Main>::from([normal(), normal(), normal()]) * DEGREE;
    Ok(presets::configuration("idam", trial.seed)?.with(|c| {
        c.run.duration_s = Some(if trial.quick { DURATION_S.1 } else { DURATION_S.0 });
        (c.simulation.pitch, c.simulation.heading) = (Swing::STILL, Swing::STILL);
        if !case.rolls {
            c.simulation.roll = Swing::STILL;
        }
        let area = &mut c.areas[0];
        let real = Rot::exp(area.simulation.installation);
        area.installation =
            case.installation.then(|| Installation { rotation: Rot::<Main, Main>::exp(error) * real, sigma: DEGREE });
        if !case.accelerometers {
            (c.main.accel, area.accel) = (None, None);
        }
    }))
}

fn measure(case: &Case, trial: &Trial) -> Result<Measured, Fault> {
    let configuration = configuration(case, trial)?;
    let track = run_blind(&method::default(&configuration), &Data::simulate(&configuration)?);
    let half = track.over(configuration.run.duration_s.unwrap_or(0.0) / 2.0..);
    Ok(Measured { seed: trial.seed, valid: half.valid_share(), own: Paired::of(half, half) })
}

fn conclude(case: &Case, trials: &[Measured]) -> Findings {
    let mut rows = vec![valid_row(case, trials)];
    if case.installation && trials.iter().any(|trial| trial.own.is_some()) {
        rows.extend([0, 1, 2].map(|axis| honest_row(case, trials, axis)));
        rows.extend([0, 1, 2].map(|axis| kept_row(case, trials, axis)));
    }
    Findings { rows, figures: Vec::new() }
}

fn claim(case: &Case, key: &str, row: &str, axis: &str, bound: Bound, paper: Published, why: String) -> Claim {
    Claim {
        id: format!("deck/unseen/{}/{key}/{axis}", case.id),
        table: format!("000, {}: the second half of the run", case.title),
        row: row.into(),
        axis: axis.into(),
        unit: String::new(),
        bound,
        paper,
        why,
    }
}

fn valid_row(case: &Case, trials: &[Measured]) -> Row {
    let values: Vec<f64> = trials.iter().map(|trial| trial.valid).collect();
    let (bound, paper, why) = if case.installation {
        (1.0, Published::AtLeast(1.0), "The installation as told is an estimate, if a coarse one.")
    } else {
        (0.0, Published::AtMost(0.0), "Nothing shows the installation and nobody told it.")
    };
    let claim = claim(case, "valid", "share of valid solutions", "all", Bound::Value(bound), paper, why.into());
    judged(claim, mean(&values), &values)
}

fn own(trials: &[Measured]) -> Vec<Paired> {
    trials.iter().filter_map(|trial| trial.own).collect()
}

fn honest_row(case: &Case, trials: &[Measured], axis: usize) -> Row {
    let of = |pair: &Paired| (pair.ours[axis] / pair.variance[axis]).sqrt();
    let pairs = own(trials);
    let why = largest_of(trials.iter().filter_map(|trial| Some((of(&trial.own?), trial.seed))));
    let paper = Published::Range(HONEST.0, HONEST.1);
    let claim = claim(case, "honest", "RMSE over standard deviation", AXES[axis], Bound::Value(1.0), paper, why);
    let ours = root(&pairs, axis, |pair| pair.ours) / root(&pairs, axis, |pair| pair.variance);
    judged(claim, ours, &pairs.iter().map(of).collect::<Vec<_>>())
}

fn kept_row(case: &Case, trials: &[Measured], axis: usize) -> Row {
    let values: Vec<f64> = own(trials).iter().map(|pair| pair.variance[axis].sqrt() / DEGREE).collect();
    let (paper, bound) = if case.unseen.contains(&axis) {
        (Published::AtLeast(KEPT), Bound::Value(1.0))
    } else {
        (Published::Nothing("the data show this axis".into()), Bound::None("not worked out".into()))
    };
    let why = "Without data about an axis its prior deviation of 1 degree stays.".into();
    let claim = claim(case, "kept", "standard deviation over that of the prior", AXES[axis], bound, paper, why);
    judged(claim, mean(&values), &values)
}
