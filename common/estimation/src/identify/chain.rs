//! The relative attitude of a window, rebuilt with one constant.
//!
//! `A_m C_s^m = N A_s` and `dN/dt = [A_m drift x] N`: with `N` known at one instant, the gyros' attitudes give `C_s^m` at all
//! others. The whole window is rebuilt from the latest constant, since what the filter published earlier had worse ones.

use super::autocovariance::detrend;
use super::window::Point;
use crate::estimator::static_part;
use crate::matching::retiming::{Attitudes, Together};
use crate::matching::so3::symmetric;
use frames::{Main, MainStart, Rot, Sub, SubStart, Vec3, unit};
use messages::{ImuPair, Solution};
use nalgebra::{Matrix3, Vector3};

/// What ties the two gyro attitudes together at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Anchor {
    /// The instant, data time in ns.
    pub time_ns: i64,
    /// The constant `N` at the instant.
    pub constant: Rot<MainStart, SubStart>,
    /// Relative gyro bias that makes it drift, rad/s.
    pub drift: Vec3<Main>,
    /// Relative scale and non-orthogonality of the gyros, whose product with a turn of the ship adds to it.
    pub scale: Matrix3<f64>,
    /// Static part `S` of the deformation.
    pub fixed: Rot<Main, Sub>,
    /// Covariance of the constant's error, rad^2, in the main unit's starting axes.
    pub covariance: Matrix3<f64>,
    /// By how much the sub unit's stamps are late, s.
    pub delay_s: f64,
    /// By how much the delay grows in a second.
    pub skew: f64,
}

/// The covariance of the constant is widened so much before the window's own data may correct it.
const DOUBT: f64 = 9.0;
/// For how long the rate of a flexure keeps its sign, s: so many points of it count as one.
const CORRELATION_S: f64 = 2.0;

impl Anchor {
    /// The anchor of a solution and its pair; `None` if it is not finite.
    pub fn of(pair: &ImuPair, solution: &Solution) -> Option<Self> {
        let a_m = Rot::<MainStart, Main>::from_quaternion(pair.attitude_m)?.matrix();
        let drift = Vec3::from(solution.drift);
        let scale = symmetric(&solution.scale.into());
        Some(Self {
            time_ns: solution.header.time_ns,
            constant: Rot::from_quaternion(solution.constant)?,
            drift: drift.is_finite().then_some(drift)?,
            scale: scale.iter().all(|x| x.is_finite()).then_some(scale)?,
            fixed: static_part(solution)?,
            covariance: a_m * Matrix3::from_row_slice(&solution.covariance) * a_m.transpose(),
            delay_s: Some(solution.delay).filter(|delay| delay.is_finite())?,
            skew: Some(solution.skew).filter(|skew| skew.is_finite())?,
        })
    }

    /// The points with the attitudes of one moment each, for those that the window covers; a delay would turn the ship's motion into a rate of flexure.
    fn together(&self, points: &[Point]) -> Vec<Point> {
        let since = |from_ns: i64, point: &Point| unit::seconds(point.time_ns - from_ns);
        let begin_ns = points.first().map_or(0, |first| first.time_ns);
        let attitudes =
            Attitudes::of(points.iter().map(|point| (since(begin_ns, point), point.attitude_m, point.attitude_s)));
        let moment = |(node, point): (usize, &Point)| {
            let late_s = self.delay_s + self.skew * since(self.time_ns, point);
            let Together { a_m, a_s, .. } = attitudes.at(node, late_s)?;
            Some(Point { attitude_m: a_m, attitude_s: a_s, ..*point })
        };
        points.iter().enumerate().filter_map(moment).collect()
    }

    /// The constant at each point; `None` if no point stands at the anchor's instant.
    fn constants(&self, points: &[Point]) -> Option<Vec<Rot<MainStart, SubStart>>> {
        let here = points.binary_search_by_key(&self.time_ns, |point| point.time_ns).ok()?;
        let mut constants = vec![self.constant; points.len()];
        for j in here + 1..points.len() {
            constants[j] = (self.turn(&points[j - 1], &points[j]) * constants[j - 1]).normalised();
        }
        for j in (0..here).rev() {
            constants[j] = (self.turn(&points[j], &points[j + 1]).inverse() * constants[j + 1]).normalised();
        }
        Some(constants)
    }

    /// By what bias and scale turn the constant from one point to the next, to second order in the step.
    fn turn(&self, from: &Point, to: &Point) -> Rot<MainStart, MainStart> {
        let dtheta = (from.attitude_m.inverse() * to.attitude_m).log();
        let step_s = unit::seconds(to.time_ns - from.time_ns);
        let drift = self.drift * step_s + Vec3::from_column(self.scale * dtheta.column());
        Rot::exp((from.attitude_m * drift + to.attitude_m * drift) * 0.5)
    }
}

/// The rate of the deformation over a window.
#[derive(Clone, Debug, PartialEq)]
pub struct Chain {
    /// Mean rates between neighbouring points per axis of m, linear trend removed, rad/s.
    pub rates: [Vec<f64>; 3],
    /// Distance of the points, s.
    pub step_s: f64,
    /// Sum of the variances of the axes, rad^2/s^2.
    pub variance: f64,
    /// The anchor, carried to the last point.
    pub end: Anchor,
}

impl Chain {
    /// Rebuilds the window; `None` if the anchor's instant is not in it, there are under three points, or a number is not finite.
    pub fn rebuild(points: &[Point], anchor: &Anchor) -> Option<Self> {
        let moments;
        let points = if anchor.delay_s == 0.0 {
            points
        } else {
            moments = anchor.together(points);
            &moments
        };
        if points.len() < 3 {
            return None;
        }
        let constants = anchor.constants(points)?;
        let angle = |(point, constant): (&Point, &Rot<MainStart, SubStart>)| {
            let total: Rot<Main, Sub> = point.attitude_m.inverse() * *constant * point.attitude_s;
            (total * anchor.fixed.inverse()).log()
        };
        let angles: Vec<Vec3<Main>> = points.iter().zip(&constants).map(angle).collect();
        let step_s = typical_step(points)?;
        let mut rates: [Vec<f64>; 3] = Default::default();
        let mut turns = Vec::with_capacity(points.len());
        for (times, pair) in points.windows(2).zip(angles.windows(2)) {
            let step = unit::seconds(times[1].time_ns - times[0].time_ns);
            // Lost points are filled with the mean rate, so that a lag stays a number of steps.
            let steps = (step / step_s).round().max(1.0) as usize;
            let rate = (pair[1] - pair[0]) / step;
            let seen = |point: &Point| point.attitude_m.inverse().matrix();
            turns.extend(std::iter::repeat_n((seen(&times[1]) - seen(&times[0])) / step, steps));
            for (axis, value) in rate.array().into_iter().enumerate() {
                rates[axis].extend(std::iter::repeat_n(value, steps));
            }
        }
        rates.iter_mut().for_each(|axis| detrend(axis));
        correct(&mut rates, &turns, step_s, &anchor.covariance);
        let variance = rates.iter().flatten().map(|y| y * y).sum::<f64>() / rates[0].len() as f64;
        let end = Anchor { time_ns: points.last()?.time_ns, constant: *constants.last()?, ..*anchor };
        variance.is_finite().then_some(Self { rates, step_s, variance, end })
    }
}

/// Takes out what an error of the constant makes of the ship's motion.
///
/// A wrong constant turns the motion into a false rate of flexure; a filter that believes in such a flexure never finds the right
/// constant. The window's own data break the circle: the constant that leaves least, weighed against its covariance.
fn correct(rates: &mut [Vec<f64>; 3], turns: &[Matrix3<f64>], step_s: f64, covariance: &Matrix3<f64>) {
    let count = turns.len() as f64;
    let weights = rates.each_ref().map(|axis| {
        let variance = axis.iter().map(|y| y * y).sum::<f64>() / count;
        (step_s / CORRELATION_S).min(1.0) / variance.max(f64::MIN_POSITIVE)
    });
    let Some(mut information) = (covariance * DOUBT).try_inverse() else { return };
    let mut vector = Vector3::zeros();
    for (j, turn) in turns.iter().enumerate() {
        for axis in 0..3 {
            let row = turn.row(axis);
            information += row.transpose() * row * weights[axis];
            vector += row.transpose() * (weights[axis] * rates[axis][j]);
        }
    }
    let Some(error) = information.try_inverse().map(|inverse| inverse * vector) else { return };
    if error.iter().all(|x| x.is_finite()) {
        for (j, turn) in turns.iter().enumerate() {
            let false_rate = turn * error;
            (0..3).for_each(|axis| rates[axis][j] -= false_rate[axis]);
        }
    }
}

/// Median distance of the points, s.
fn typical_step(points: &[Point]) -> Option<f64> {
    let mut steps: Vec<i64> = points.windows(2).map(|pair| pair[1].time_ns - pair[0].time_ns).collect();
    let middle = steps.len() / 2;
    let step = *steps.select_nth_unstable(middle).1;
    (step > 0).then(|| unit::seconds(step))
}
