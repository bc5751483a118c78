//! Autocovariance at equally spaced lags, from the first one on: what the sequence of paper 003 (eq 23-24) is made of.
//!
//! Lag 0 is never in it: it alone carries white noise.

use super::autocovariance::dot;
use super::series::Series;

/// Fewer lags than this identify nothing.
const FEWEST: usize = 6;

/// Unbiased autocovariance at the lags 1, 2, ... times a stride.
#[derive(Clone, Debug, PartialEq)]
pub struct Lagged {
    /// Points between two lags.
    pub stride: usize,
    /// Time between two lags, s.
    pub spacing_s: f64,
    /// The values, rad^2 or rad^2/s^2.
    pub values: Vec<f64>,
}

impl Lagged {
    /// At lags about `spacing_s` apart up to `longest_s`, at most a third of the data; `None` if that leaves too few.
    pub fn new(series: &Series, spacing_s: f64, longest_s: f64) -> Option<Self> {
        let stride = (spacing_s / series.step_s).round().max(1.0) as usize;
        let points = series.values.len();
        let longest = ((longest_s / series.step_s).round() as usize).min(points / 3);
        let lags = (1..=longest / stride).map(|k| k * stride);
        let value = |h: usize| dot(&series.values[..points - h], &series.values[h..]) / (points - h) as f64;
        let values: Vec<f64> = lags.map(value).collect();
        (values.len() >= FEWEST).then_some(Self { stride, spacing_s: stride as f64 * series.step_s, values })
    }

    /// The lags, s.
    pub fn times(&self) -> Vec<f64> {
        (1..=self.values.len()).map(|k| k as f64 * self.spacing_s).collect()
    }
}
