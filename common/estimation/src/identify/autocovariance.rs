//! Autocovariance of the relative rate, paper 000 eq 20.
//!
//! The estimate is the unbiased one, `r(h) = sum y_j y_{j+h} / (n - h)`, so that a sinusoid in the data is an undamped
//! sinusoid in it. Lag 0 is apart: it alone carries the gyros' white noise. Lag 1 is left out, for quantisation shows there.

/// Lags up to here are all used, s.
const DENSE_S: f64 = 4.0;
/// Lags up to here are used each second one, s.
const MIDDLE_S: f64 = 20.0;
/// The longest lag, s, of which each fourth one is used.
const LONGEST_S: f64 = 40.0;

/// Autocovariance at lag 0 and at a set of lags that thins out towards the longest.
#[derive(Clone, Debug, PartialEq)]
pub struct Autocovariance {
    /// Number of rates it is made of.
    pub points: usize,
    /// Distance of the points, s.
    pub step_s: f64,
    /// Value at lag 0, rad^2/s^2.
    pub zero: f64,
    /// The lags in steps, from 2 on.
    pub lags: Vec<usize>,
    /// The values at the lags, rad^2/s^2.
    pub values: Vec<f64>,
}

impl Autocovariance {
    /// Of rates at the distance `step_s`; `None` if there are too few of them or they do not vary.
    pub fn new(rates: &[f64], step_s: f64) -> Option<Self> {
        let points = rates.len();
        let lags = lags(points, step_s);
        let zero = dot(rates, rates) / points as f64;
        if lags.len() < 8 || !zero.is_normal() {
            return None;
        }
        let value = |&h: &usize| dot(&rates[..points - h], &rates[h..]) / (points - h) as f64;
        let values = lags.iter().map(value).collect();
        Some(Self { points, step_s, zero, lags, values })
    }

    /// The lags in s.
    pub fn times(&self) -> Vec<f64> {
        self.lags.iter().map(|&h| h as f64 * self.step_s).collect()
    }
}

/// The lags used for a number of points: at most a third of them.
pub fn lags(points: usize, step_s: f64) -> Vec<usize> {
    let last = (points / 3).min((LONGEST_S / step_s) as usize);
    let mut lags = Vec::new();
    let mut lag = 2;
    while lag <= last {
        lags.push(lag);
        let time = lag as f64 * step_s;
        lag += if time < DENSE_S {
            1
        } else if time < MIDDLE_S {
            2
        } else {
            4
        };
    }
    lags
}

/// Removes mean and linear trend.
pub fn detrend(y: &mut [f64]) {
    let n = y.len() as f64;
    if y.len() < 2 {
        return;
    }
    let middle = (n - 1.0) / 2.0;
    let mean = y.iter().sum::<f64>() / n;
    let moment: f64 = y.iter().enumerate().map(|(j, v)| (j as f64 - middle) * v).sum();
    let slope = moment * 12.0 / (n * (n * n - 1.0));
    for (j, v) in y.iter_mut().enumerate() {
        *v -= mean + slope * (j as f64 - middle);
    }
}

/// Scalar product over the shorter length, in eight sums so that it runs on vector units.
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let n = a.len().min(b.len());
    let (a, b) = (a[..n].chunks_exact(8), b[..n].chunks_exact(8));
    let rest: f64 = a.remainder().iter().zip(b.remainder()).map(|(x, y)| x * y).sum();
    let mut sums = [0.0; 8];
    for (x, y) in a.zip(b) {
        for k in 0..8 {
            sums[k] += x[k] * y[k];
        }
    }
    rest + sums.iter().sum::<f64>()
}
