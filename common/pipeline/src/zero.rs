//! The zero that the last minute of an area's solutions asks for.

use frames::{Main, Rot, Sub, Vec3, unit};
use messages::Solution;
use std::collections::VecDeque;

/// A zero is the mean of so long, s.
const MINUTE_S: f64 = 60.0;
/// The span of a minute at a coarse rate is short of it by one interval, s.
const SHORT_S: f64 = 0.2;
/// Of the minute at least this share has to be valid.
const SHARE: f64 = 0.95;
/// No component of a zero may be greater, rad: a unit that stands so far off needs its mounting told, not a zero.
pub const LIMIT: f64 = 5.0 * unit::DEGREE;

/// A zero with what it comes of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Zero {
    /// Rotation vector, rad: of the mean deformation as it was estimated, without any zero that is in force.
    pub value: Vec3<Main>,
    /// Valid solutions behind the mean.
    pub solutions: usize,
    /// Half width of the 95 % range of the newest of them, rad.
    pub range: [f64; 3],
}

/// Why there is none.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum NoZero {
    /// The run is young, or was just attached to.
    #[error("only {0:.0} s of solutions have come here: a zero is the mean of a minute")]
    Short(f64),
    /// Too many are not valid.
    #[error("only {0:.0} % of the last minute's solutions are valid: a zero takes 95 %")]
    Invalid(f64),
    /// The deformation is not small.
    #[error("mean {0:+.2}, {1:+.2}, {2:+.2} degrees: a zero is at most 5; tell the mounting instead")]
    Large(f64, f64, f64),
}

/// The last minute of an area's solutions.
#[derive(Clone, Debug, Default)]
pub struct LastMinute {
    run_id: u64,
    points: VecDeque<Point>,
}

#[derive(Clone, Copy, Debug)]
struct Point {
    time_ns: i64,
    valid: bool,
    q: [f64; 4],
    zero: [f64; 3],
    range: [f64; 3],
}

impl LastMinute {
    /// Takes in a solution, which is no mark of an end.
    pub fn see(&mut self, solution: &Solution) {
        let Solution { header, q, zero, range, .. } = *solution;
        if self.run_id != header.run_id {
            self.points.clear();
            self.run_id = header.run_id;
        }
        self.points.push_back(Point { time_ns: header.time_ns, valid: solution.is_valid(), q, zero, range });
        let begin_ns = header.time_ns - unit::nanoseconds(MINUTE_S);
        while self.points.pop_front_if(|point| point.time_ns < begin_ns).is_some() {}
    }

    /// The zero by which the minute's mean would be told as none.
    ///
    /// # Errors
    /// The minute is not full, not valid enough, or the mean is not small.
    pub fn zero(&self) -> Result<Zero, NoZero> {
        let span_ns =
            self.points.back().zip(self.points.front()).map_or(0, |(last, first)| last.time_ns - first.time_ns);
        if unit::seconds(span_ns) < MINUTE_S - SHORT_S {
            return Err(NoZero::Short(unit::seconds(span_ns)));
        }
        let valid = || self.points.iter().filter(|point| point.valid);
        let (solutions, all) = (valid().count(), self.points.len());
        let share = solutions as f64 / all as f64;
        let (Some(last), true) = (valid().next_back(), share >= SHARE) else {
            return Err(NoZero::Invalid(100.0 * share));
        };
        let value = (mean(valid()) * Rot::<Sub, Sub>::exp(last.zero.into())).log();
        if value.array().iter().any(|x| x.abs() > LIMIT) || !value.is_finite() {
            let [x, y, z] = value.array().map(|x| x / unit::DEGREE);
            return Err(NoZero::Large(x, y, z));
        }
        Ok(Zero { value, solutions, range: last.range })
    }
}

/// The rotation whose quaternion is the normalised sum of theirs: their mean but for terms of third order in their differences.
fn mean<'a>(points: impl Iterator<Item = &'a Point>) -> Rot<Main, Sub> {
    let mut sum = [0.0; 4];
    for point in points {
        let along: f64 = sum.iter().zip(&point.q).map(|(a, b)| a * b).sum();
        // a quaternion and its negative are the same rotation
        let sign = if along < 0.0 { -1.0 } else { 1.0 };
        sum.iter_mut().zip(&point.q).for_each(|(sum, q)| *sum += sign * q);
    }
    Rot::from_wxyz(sum).normalised()
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use frames::unit::ARCSEC;
    use messages::Header;

    /// A flexure about y by which the deformation swings about 1, -2, 0.5 degrees.
    fn solution(k: i64, valid: bool, zero: Vec3<Main>) -> Solution {
        let still = Rot::<Main, Sub>::exp(Vec3::new(1.0, -2.0, 0.5) * unit::DEGREE);
        let swing = (std::f64::consts::TAU * k as f64 / 100.0).sin() * 600.0 * ARCSEC;
        let q = Rot::<Main, Main>::exp(Vec3::new(0.0, swing, 0.0))
            * still
            * Rot::<Sub, Sub>::exp(-Vec3::from(zero.array()));
        // every other one with the other sign
        let sign = if k % 2 == 0 { 1.0 } else { -1.0 };
        Solution {
            header: Header { run_id: 7, sequence: k as u64, time_ns: k * 100_000_000, ..Header::default() },
            q: q.quaternion().map(|x| sign * x),
            zero: zero.array(),
            range: [1e-4, 2e-4, 3e-4],
            valid: u32::from(valid),
            ..Solution::default()
        }
    }

    fn minute(from: i64, to: i64, valid: impl Fn(i64) -> bool, zero: Vec3<Main>) -> LastMinute {
        let mut minute = LastMinute::default();
        (from..to).for_each(|k| minute.see(&solution(k, valid(k), zero)));
        minute
    }

    #[test]
    fn it_is_the_mean_whatever_zero_is_in_force() {
        for in_force in [Vec3::ZERO, Vec3::new(0.02, -0.03, 0.01)] {
            let zero = minute(0, 1000, |_| true, in_force).zero().unwrap();
            let off = zero.value - Vec3::new(1.0, -2.0, 0.5) * unit::DEGREE;
            // six whole swings and a tenth
            assert!(off.norm() < 20.0 * ARCSEC, "{}", off.norm() / ARCSEC);
            assert_eq!((zero.solutions, zero.range), (601, [1e-4, 2e-4, 3e-4]));
        }
    }

    #[test]
    fn half_a_minute_an_invalid_stretch_and_a_large_angle_are_refused_in_words() {
        let said = |minute: LastMinute| minute.zero().unwrap_err().to_string();
        assert!(said(minute(0, 300, |_| true, Vec3::ZERO)).starts_with("only 30 s of solutions"));
        assert!(said(LastMinute::default()).starts_with("only 0 s"));
        assert!(said(minute(0, 1000, |k| k % 10 != 0, Vec3::ZERO)).starts_with("only 90 % of the last minute's"));
        assert!(said(minute(0, 1000, |_| false, Vec3::ZERO)).starts_with("only 0 %"));
        let mut large = LastMinute::default();
        let q = Rot::<Main, Sub>::exp(Vec3::new(0.0, 0.0, 0.5)).quaternion();
        (0..700).for_each(|k| large.see(&Solution { q, ..solution(k, true, Vec3::ZERO) }));
        assert_eq!(large.zero().unwrap_err().to_string().split(':').next(), Some("mean +0.00, +0.00, +28.65 degrees"));
    }

    #[test]
    fn another_run_begins_anew() {
        let mut minute = minute(0, 1000, |_| true, Vec3::ZERO);
        let other = solution(1000, true, Vec3::ZERO);
        minute.see(&Solution { header: Header { run_id: 8, ..other.header }, ..other });
        assert_eq!(minute.zero(), Err(NoZero::Short(0.0)));
    }
}
