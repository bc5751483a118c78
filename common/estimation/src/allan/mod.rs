//! Overlapping Allan deviation of a unit at rest, and the noise coefficients that it shows.
//!
//! The variance is that of NIST SP 1065, eq 11; names and slopes of the terms are those of IEEE Std 952, annex C. With `x` the
//! angle (or velocity) summed up over the recording and `tau = m` sampling intervals,
//! `sigma^2(tau) = mean of (x[i + 2m] - 2 x[i + m] + x[i])^2 / (2 tau^2)`.

mod bias;
mod deviation;
mod fit;
mod freedom;
mod select;
mod terms;

pub use bias::least_bias;
pub use freedom::Noise;
pub use terms::Term;

use deviation::Averaged;
use select::Chosen;

/// The Allan deviation at one averaging time, in the unit of the rate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Averaging time, s.
    pub tau: f64,
    /// The deviation.
    pub deviation: f64,
    /// Lower end of its 68 % confidence bar.
    pub lower: f64,
    /// Upper end of its 68 % confidence bar.
    pub upper: f64,
    /// Equivalent degrees of freedom behind it.
    pub freedom: f64,
    /// The fitted model's deviation.
    pub model: f64,
}

/// A coefficient with one standard deviation of its error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The coefficient.
    pub value: f64,
    /// Its standard deviation.
    pub sigma: f64,
}

/// What the recording shows of one channel, whose rate is in the unit U (rad/s or m/s^2). A term that is not shown is `None`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Coefficients {
    /// White noise of the rate, U sqrt(s): angle or velocity random walk.
    pub white: Option<Estimate>,
    /// Bias instability, U: the highest Allan deviation of the wandering bias or, where white noise passes into a random walk and
    /// if it is more, the lowest of the whole curve; divided by `sqrt(2 ln 2 / pi)`.
    pub instability: Option<Estimate>,
    /// Correlation time, s, where the bias wanders as a first-order Gauss-Markov process rather than as flicker noise.
    pub correlation: Option<Estimate>,
    /// Random walk of the rate, U / sqrt(s).
    pub walk: Option<Estimate>,
    /// Quantisation of the summed up rate, U s.
    pub quantisation: Option<Estimate>,
    /// Flicker noise of the rate is less than this (97.5 %), U, whether it is shown or not.
    pub most_instability: f64,
}

/// Deviation and coefficients of one channel.
#[derive(Clone, Debug, PartialEq)]
pub struct Analysis {
    /// By averaging time, each twice the one before.
    pub points: Vec<Point>,
    /// What was made of them.
    pub coefficients: Coefficients,
}

/// Standard normal quantiles: of a 68 % bar's upper end, and of 99.5 %, which makes the least of the five or so points that bound
/// the bias instability a bound of 97.5 %.
const ONE_SIGMA: f64 = 1.0;
const BOUND: f64 = 2.58;

/// Analyses a channel's rate, sampled every `interval` s without a hole in each of the stretches.
///
/// `None` where the longest stretch has fewer than 48 values or the rate does not vary.
pub fn analyse(stretches: &[&[f64]], interval: f64) -> Option<Analysis> {
    let averaged = deviation::averaged(stretches, interval);
    let usable = averaged.iter().all(|point| point.variance.is_finite() && point.variance > 0.0);
    if averaged.len() < 5 || !usable {
        return None;
    }
    let lengths: Vec<usize> = stretches.iter().map(|stretch| stretch.len() + 1).collect();
    let mut freedoms: Vec<f64> =
        averaged.iter().map(|point| freedom::pooled(&lengths, point.factor, Noise::White)).collect();
    let mut chosen = select::choose(&averaged, &freedoms)?;
    // the degrees of freedom depend on the noise, which the first fit knows well enough
    for (freedom, point) in freedoms.iter_mut().zip(&averaged) {
        *freedom = freedom::pooled(&lengths, point.factor, chosen.best.noise_at(point.tau));
    }
    chosen = select::choose(&averaged, &freedoms)?;
    let point = |(point, freedom): (&Averaged, &f64)| told(point, *freedom, &chosen);
    let points: Vec<Point> = averaged.iter().zip(&freedoms).map(point).collect();
    let lowest = averaged.iter().zip(&freedoms).map(|(point, freedom)| {
        point.variance.sqrt() * freedom::bar(*freedom, BOUND).1 / Term::Flicker.variance(1.0).sqrt()
    });
    let most_instability = lowest.fold(f64::INFINITY, f64::min);
    Some(Analysis { points, coefficients: Coefficients { most_instability, ..chosen.coefficients() } })
}

fn told(point: &Averaged, freedom: f64, chosen: &Chosen) -> Point {
    let deviation = point.variance.sqrt();
    let (below, above) = freedom::bar(freedom, ONE_SIGMA);
    let model = chosen.best.variance(point.tau).sqrt();
    Point { tau: point.tau, deviation, lower: deviation * below, upper: deviation * above, freedom, model }
}
