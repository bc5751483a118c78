//! A month at sea: what grows over weeks, and whether the numbers of a filter of fifty states last.

use super::AXES;
use super::claims::judged;
use super::method;
use crate::{
    Bound, Claim, Fault, Findings, Point, Published, Row, Stretch, Study, Track, Trial, Trials, presets, run_together,
};
use frames::unit::ARCSEC;
use nalgebra::Matrix3;
use simulation::QuasiStatic;

const HOUR_S: f64 = 3600.0;
const DAY_S: f64 = 24.0 * HOUR_S;
/// Length, full and quick, s.
const DURATION_S: (f64, f64) = (30.0 * DAY_S, 900.0);
/// How often the error is looked at, s: nothing of the flexure is left from one point to the next.
const EVERY_S: (f64, f64) = (300.0, 10.0);
/// The hull is learnt every ten minutes, or the month would cost hours; the default is ten seconds.
const LEARN_S: f64 = 600.0;
/// The Sun bends her once a day.
const SUN: f64 = 100.0 * ARCSEC;

/// RMSE over deviation.
const HONEST: (f64, f64) = (0.5, 2.0);
/// Share of errors in the range.
const COVERED: f64 = 0.93;
/// A deviation at the end over that at the start.
const GROWN: f64 = 1.1;
/// Largest over smallest eigenvalue of the deformation's covariance, which a double carries with room to spare.
const CONDITION: f64 = 1e6;

/// First and last third of the track, without what comes before a first solution is expected.
struct Thirds<'a> {
    whole: Stretch<'a>,
    first: Stretch<'a>,
    last: Stretch<'a>,
}

impl<'a> Thirds<'a> {
    fn of(track: &'a Track) -> Self {
        let end_s = track.points.last().map_or(0.0, |point| point.time_s);
        let begin_s = 0.2 * end_s.min(HOUR_S);
        Self {
            whole: track.over(begin_s..),
            first: track.over(begin_s..end_s / 3.0),
            last: track.over(end_s * 2.0 / 3.0..),
        }
    }
}

pub(crate) fn studies() -> Vec<Study> {
    vec![Study::new(Trials { full: 1, quick: 1 }, (DURATION_S.0 / 20.0) as u64, measure, conclude)]
}

fn measure(trial: &Trial) -> Result<Vec<Track>, Fault> {
    let pick = |(full, quick)| if trial.quick { quick } else { full };
    let scenario = presets::configuration("error_range_weak", trial.seed)?.with(|c| {
        c.run.duration_s = Some(pick(DURATION_S));
        let area = &mut c.areas[0];
        area.installation = None;
        area.simulation.coupling = None;
        area.simulation.quasi_static = QuasiStatic { amplitude: [SUN; 3], period: DAY_S, phase: [0.0, 2.0, 4.0] };
    });
    let default = method::default(&scenario).with(|c| c.areas[0].identifier.period_s = LEARN_S);
    run_together(&scenario, &[default], pick(EVERY_S))
}

fn conclude(trials: &[Vec<Track>]) -> Findings {
    let rows = |track: &Track| -> Vec<Row> {
        let thirds = Thirds::of(track);
        let all = [valid_row(&thirds), condition_row(&thirds)];
        all.into_iter().chain((0..3).flat_map(|axis| axis_rows(&thirds, axis))).collect()
    };
    Findings { rows: trials.iter().flatten().next().map_or(Vec::new(), rows), figures: Vec::new() }
}

fn row(key: &str, what: &str, axis: &str, paper: Published, bound: Bound, ours: f64) -> Row {
    let claim = Claim {
        id: format!("deck/month/{key}/{axis}"),
        table: "004, not coupled, a month".into(),
        row: what.into(),
        axis: axis.into(),
        unit: String::new(),
        bound,
        paper,
        why: "The static part goes to and fro by 100 arcsec a day; the hull is learnt every ten minutes.".into(),
    };
    judged(claim, ours, &[ours])
}

fn valid_row(thirds: &Thirds) -> Row {
    let share = thirds.whole.valid_share();
    row("valid", "share of valid solutions", "all", Published::AtLeast(1.0), Bound::Value(1.0), share)
}

fn condition_row(thirds: &Thirds) -> Row {
    let worst = thirds.whole.points.iter().map(condition).fold(0.0, f64::max);
    let bound = Bound::None("the axes differ in what shows them".into());
    row("condition", "largest condition number of the covariance", "all", Published::AtMost(CONDITION), bound, worst)
}

/// Largest over smallest eigenvalue; infinite where the covariance is none.
fn condition(point: &Point) -> f64 {
    let covariance = Matrix3::from_row_slice(&point.covariance);
    let eigenvalues = ((covariance + covariance.transpose()) * 0.5).symmetric_eigenvalues();
    if eigenvalues.min() > 0.0 { eigenvalues.max() / eigenvalues.min() } else { f64::INFINITY }
}

fn axis_rows(thirds: &Thirds, axis: usize) -> [Row; 3] {
    let name = AXES[axis];
    let honest = thirds.last.rmse()[axis] / thirds.last.rms_of(Point::sigma)[axis];
    let grown = thirds.last.rms_of(Point::sigma)[axis] / thirds.first.rms_of(Point::sigma)[axis];
    let covered = thirds.last.coverage(|point| point.range)[axis];
    [
        (
            "honest",
            "RMSE over standard deviation, last third",
            Published::Range(HONEST.0, HONEST.1),
            Bound::Value(1.0),
            honest,
        ),
        ("grown", "standard deviation, last third over first", Published::AtMost(GROWN), Bound::Value(1.0), grown),
        (
            "coverage",
            "share of errors in the range, last third",
            Published::AtLeast(COVERED),
            Bound::Value(0.95),
            covered,
        ),
    ]
    .map(|(key, what, paper, bound, ours)| row(key, what, name, paper, bound, ours))
}
