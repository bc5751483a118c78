use frames::{Main, Rot, Sub, Vec3, unit};
use messages::{Flags, FlexureParams, Solution, Truth};
use nalgebra::Matrix3;
use pipeline::solution_file::deviations;
use pipeline::summary::deformation_error;
use std::ops::RangeBounds;

/// An estimate of the sub unit's clock.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimated {
    /// The estimate, in SI units.
    pub value: f64,
    /// Its standard deviation.
    pub sigma: f64,
}

/// A solution tells a standard deviation of zero where nothing is estimated.
fn estimated(value: f64, sigma: f64) -> Option<Estimated> {
    (sigma > 0.0).then_some(Estimated { value, sigma })
}

/// One instant of a run: rad, in m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Data time, s.
    pub time_s: f64,
    /// Whether the method stands by its estimate; figures leave out the others.
    pub valid: bool,
    /// Rotation vector of the estimate.
    pub estimate: [f64; 3],
    /// Rotation vector of the true deformation.
    pub truth: [f64; 3],
    /// `Log(C_hat C_true^T)`.
    pub error: [f64; 3],
    /// The method's covariance of that error, rad^2, row by row.
    pub covariance: [f64; 9],
    /// Half width of the method's 95 % range.
    pub range: [f64; 3],
    /// The same error of the static part.
    pub static_error: [f64; 3],
    /// Rotation vector of the dynamic part less the true one.
    pub dynamic_error: [f64; 3],
    /// The method's standard deviation of that error per axis.
    pub dynamic_sigma: [f64; 3],
    /// The delay by now, if the method estimates one.
    pub delay: Option<Estimated>,
    /// By how much the delay grows in a second, if the method estimates it.
    pub skew: Option<Estimated>,
    /// What the solution says about itself.
    pub flags: Flags,
}

impl Point {
    /// Of a solution and its truth.
    pub fn of(solution: &Solution, truth: &Truth) -> Self {
        let total = Rot::<Main, Sub>::from_wxyz(truth.q).log();
        let [found, real] = [solution.static_q, truth.static_q].map(Rot::<Main, Sub>::from_wxyz);
        Self {
            time_s: unit::seconds(solution.header.time_ns),
            valid: solution.is_valid(),
            estimate: Rot::<Main, Sub>::from_wxyz(solution.q).log_beside(total).array(),
            truth: total.array(),
            error: deformation_error(solution, truth).array(),
            covariance: solution.covariance,
            range: solution.range,
            static_error: (found * real.inverse()).log().array(),
            dynamic_error: [0, 1, 2].map(|axis| solution.dynamic[axis] - truth.dynamic[axis]),
            dynamic_sigma: deviations(&solution.dynamic_covariance),
            delay: estimated(solution.delay, solution.delay_sigma),
            skew: estimated(solution.skew, solution.skew_sigma),
            flags: solution.flags,
        }
    }

    /// Standard deviation per axis.
    pub fn sigma(&self) -> [f64; 3] {
        deviations(&self.covariance)
    }

    /// `e^T P^-1 e`, of mean 3 for an honest method; NaN if the covariance has no inverse.
    pub fn nees(&self) -> f64 {
        let error = Vec3::<Main>::from(self.error).column();
        let inverse = Matrix3::from_row_slice(&self.covariance).try_inverse();
        inverse.map_or(f64::NAN, |inverse| error.dot(&(inverse * error)))
    }
}

/// A parameter set and since when it was in force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Adoption {
    /// Data time, s.
    pub time_s: f64,
    /// The set.
    pub set: FlexureParams,
}

/// What a method did in a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Track {
    /// In the order of time, thinned out to one every so many seconds.
    pub points: Vec<Point>,
    /// The parameter sets that took effect.
    pub adopted: Vec<Adoption>,
    every_ns: i64,
    due_ns: i64,
    params_id: u64,
}

impl Track {
    pub(crate) fn new(every_s: f64) -> Self {
        let every_ns = unit::nanoseconds(every_s);
        Self { points: Vec::new(), adopted: Vec::new(), every_ns, due_ns: i64::MIN, params_id: 0 }
    }

    /// Keeps the instant if one is due; says whether the solution is the first with another parameter set.
    pub(crate) fn take(&mut self, solution: &Solution, truth: &Truth) -> bool {
        let time_ns = solution.header.time_ns;
        if time_ns >= self.due_ns {
            self.points.push(Point::of(solution, truth));
            let next_ns = self.due_ns.saturating_add(self.every_ns);
            self.due_ns = if next_ns > time_ns { next_ns } else { time_ns.saturating_add(self.every_ns) };
        }
        std::mem::replace(&mut self.params_id, solution.params_id) != solution.params_id
    }

    pub(crate) fn adopt(&mut self, solution: &Solution, set: Option<&FlexureParams>) {
        let time_s = unit::seconds(solution.header.time_ns);
        self.adopted.extend(set.map(|&set| Adoption { time_s, set }));
    }

    /// The points of a span of time, s, such as `120.0..=600.0`.
    pub fn over(&self, span: impl RangeBounds<f64>) -> Stretch<'_> {
        let first = self.points.partition_point(|point| before(point.time_s, &span));
        let within = self.points[first..].iter().take_while(|point| span.contains(&point.time_s)).count();
        Stretch { points: &self.points[first..first + within] }
    }
}

fn before(time_s: f64, span: &impl RangeBounds<f64>) -> bool {
    match span.start_bound() {
        std::ops::Bound::Included(&start) => time_s < start,
        std::ops::Bound::Excluded(&start) => time_s <= start,
        std::ops::Bound::Unbounded => false,
    }
}

/// Part of a track. Its figures are of the valid points, per axis, in rad; NaN if there are none.
#[derive(Clone, Copy, Debug)]
pub struct Stretch<'a> {
    /// All points, valid or not.
    pub points: &'a [Point],
}

impl<'a> Stretch<'a> {
    fn valid(&self) -> impl Iterator<Item = &'a Point> + use<'a> {
        self.points.iter().filter(|point| point.valid)
    }

    fn mean(&self, figure: impl Fn(&Point) -> f64) -> f64 {
        let (sum, count) = self.valid().fold((0.0, 0.0), |(sum, count), point| (sum + figure(point), count + 1.0));
        sum / count
    }

    /// A figure of each point against time, for a plot; the line breaks at points that are not valid.
    pub fn line(&self, figure: impl Fn(&Point) -> f64) -> Vec<(f64, f64)> {
        let value = |point: &Point| if point.valid { figure(point) } else { f64::NAN };
        self.points.iter().map(|point| (point.time_s, value(point))).collect()
    }

    /// Share of valid points: the other figures speak of no more than these.
    pub fn valid_share(&self) -> f64 {
        self.valid().count() as f64 / self.points.len() as f64
    }

    /// Root mean square error.
    pub fn rmse(&self) -> [f64; 3] {
        self.rms_of(|point| point.error)
    }

    /// Root mean square of anything, such as `|point| point.static_error`.
    pub fn rms_of(&self, figure: impl Fn(&Point) -> [f64; 3]) -> [f64; 3] {
        [0, 1, 2].map(|axis| self.mean(|point| figure(point)[axis].powi(2)).sqrt())
    }

    /// Mean error.
    pub fn mean_error(&self) -> [f64; 3] {
        self.mean_of(|point| point.error)
    }

    /// Mean absolute error.
    pub fn mean_abs(&self) -> [f64; 3] {
        [0, 1, 2].map(|axis| self.mean(|point| point.error[axis].abs()))
    }

    /// Largest absolute error.
    pub fn max_abs(&self) -> [f64; 3] {
        [0, 1, 2].map(|axis| self.valid().map(|point| point.error[axis].abs()).fold(f64::NAN, f64::max))
    }

    /// Root mean square of the method's standard deviations.
    pub fn sigma(&self) -> [f64; 3] {
        self.rms_of(Point::sigma)
    }

    /// Mean of anything, such as `|point| point.range`.
    pub fn mean_of(&self, figure: impl Fn(&Point) -> [f64; 3]) -> [f64; 3] {
        [0, 1, 2].map(|axis| self.mean(|point| figure(point)[axis]))
    }

    /// Share of points whose error lies within a half width, such as `|point| point.range`.
    pub fn coverage(&self, half_width: impl Fn(&Point) -> [f64; 3]) -> [f64; 3] {
        self.held(|point| point.error, half_width)
    }

    /// Share of points of which something, such as `|point| point.dynamic_error`, lies within a half width.
    pub fn held(&self, error: impl Fn(&Point) -> [f64; 3], half_width: impl Fn(&Point) -> [f64; 3]) -> [f64; 3] {
        [0, 1, 2].map(|axis| self.mean(|point| f64::from(error(point)[axis].abs() <= half_width(point)[axis])))
    }

    /// Mean of [`Point::nees`]: 3 for an honest method.
    pub fn nees(&self) -> f64 {
        self.mean(Point::nees)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use messages::Header;

    /// A track of 10 s at 10 Hz whose error about z is the number of the second, invalid from 8 s on.
    fn track(every_s: f64) -> Track {
        let mut track = Track::new(every_s);
        for sequence in 0..=100 {
            let header = Header { sequence, time_ns: sequence as i64 * 100_000_000, ..Header::default() };
            let second = (sequence / 10) as f64;
            let real = Rot::<Main, Sub>::exp(Vec3::new(0.1, -0.2, 0.3));
            let found = Rot::<Main, Main>::exp(Vec3::new(1e-3, 0.0, second * 1e-3)) * real;
            let covariance = [4e-6, 0.0, 0.0, 0.0, 4e-6, 0.0, 0.0, 0.0, 4e-6];
            let valid = u32::from(sequence < 80);
            let range = [1e-2, 0.0, 2.5e-3];
            let (dynamic, dynamic_covariance) = ([3e-3, 0.0, second * 1e-3], covariance);
            let solution = Solution { header, q: found.quaternion(), covariance, valid, range, ..Solution::default() };
            let solution = Solution { dynamic, dynamic_covariance, ..solution };
            let truth = Truth { header, q: real.quaternion(), dynamic: [0.0, 1e-3, 0.0], ..Truth::default() };
            track.take(&solution, &truth);
        }
        track
    }

    #[test]
    fn figures_of_a_span_are_those_of_its_valid_points() {
        let track = track(0.1);
        let near = |a: f64, b: f64| (a - b).abs() < 1e-12;
        let some = track.over(1.0..3.0);
        assert_eq!(some.points.len(), 20);
        assert!(near(some.rmse()[2], 1e-3 * 2.5f64.sqrt()) && near(some.rmse()[0], 1e-3));
        assert!(near(some.mean_abs()[2], 1.5e-3) && near(some.mean_error()[2], 1.5e-3));
        assert!(near(some.max_abs()[2], 2e-3) && near(some.sigma()[1], 2e-3));
        assert!((some.nees() - (0.25 + 2.5 / 4.0)).abs() < 1e-9);
        assert_eq!(track.over(..4.0).coverage(|point| point.range)[2], 0.75);
        let wide = |point: &Point| point.dynamic_sigma.map(|sigma| 1.25 * sigma);
        assert_eq!(track.over(..4.0).held(|point| point.dynamic_error, wide), [0.0, 1.0, 0.75]);
        assert!(near(some.mean_of(wide)[1], 2.5e-3) && near(some.mean_of(|point| point.range)[0], 1e-2));
        assert_eq!(track.over(6.0..10.0).valid_share(), 0.5);
        assert!(near(track.over(6.0..=10.0).rmse()[2], 1e-3 * 42.5f64.sqrt()));
        assert!(track.over(9.0..).rmse()[2].is_nan() && track.over(20.0..).points.is_empty());
    }

    #[test]
    fn a_track_is_thinned_out_by_time() {
        let times: Vec<f64> = track(2.0).points.iter().map(|point| point.time_s).collect();
        assert_eq!(times, [0.0, 2.0, 4.0, 6.0, 8.0, 10.0]);
        assert_eq!(track(0.01).points.len(), 101);
    }
}
