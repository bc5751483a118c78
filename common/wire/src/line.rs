//! A straight line that is followed: offset and slope, with their covariance.

/// By how much a clock's offset wanders by itself, s per square root of a second.
const OFFSET_WALK: f64 = 3e-7;
/// By how much its rate wanders: a crystal that warms up by a degree in a minute or two.
const SLOPE_WALK: f64 = 1e-8;

/// A Kalman filter of two states; offsets in seconds, slopes as ratios.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Line {
    /// Offset at `at`.
    pub offset: f64,
    pub slope: f64,
    /// Variances of offset and slope, and their covariance.
    pub variance: [f64; 3],
    /// Where the offset holds, s.
    at: f64,
}

impl Line {
    /// A line that goes through `offset` at `at` with standard deviations of both.
    pub fn new(at: f64, offset: f64, offset_sigma: f64, slope_sigma: f64) -> Self {
        Self { offset, slope: 0.0, variance: [offset_sigma * offset_sigma, slope_sigma * slope_sigma, 0.0], at }
    }

    /// The line's value.
    pub fn value(&self, at: f64) -> f64 {
        self.offset + self.slope * (at - self.at)
    }

    /// Goes on to `at`, which is not before.
    pub fn advance(&mut self, at: f64) {
        let step = (at - self.at).max(0.0);
        let [offset, slope, both] = self.variance;
        self.offset += self.slope * step;
        self.variance = [
            offset + 2.0 * step * both + step * step * slope + OFFSET_WALK * OFFSET_WALK * step,
            slope + SLOPE_WALK * SLOPE_WALK * step,
            both + step * slope,
        ];
        self.at += step;
    }

    /// Takes in that the value here is by `innovation` greater than the line says, with a variance of `noise`.
    pub fn correct(&mut self, innovation: f64, noise: f64) {
        let [offset, slope, both] = self.variance;
        let gain = [offset / (offset + noise), both / (offset + noise)];
        self.offset += gain[0] * innovation;
        self.slope += gain[1] * innovation;
        self.variance = [(1.0 - gain[0]) * offset, slope - gain[1] * both, (1.0 - gain[0]) * both];
    }
}
