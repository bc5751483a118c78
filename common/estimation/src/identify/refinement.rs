//! The three tied parameters of the flexure model, fitted to the autocovariance of the rate.
//!
//! The model of the lags is that of [`super::expectation`] (paper 000 eq 17 and 20). Values at neighbouring lags err together and by known amounts (Bartlett's formula), so the squares are
//! weighted by the inverse of that covariance; a plain sum of squares loses most of what the data say of the density. Sinusoids
//! that the relevance vector machine found undamped are left free. Priors: `ln mu ~ N(ln 0.15, 1)`, `ln b ~ N(ln 0.6, 1)`.

use super::autocovariance::{Autocovariance, dot};
use super::dictionary::logarithmic;
use super::expectation::{detrended, rate_autocovariance};
use super::relevance::{Limits, solve};
use crate::flexure::Flexure;
use nalgebra::{Cholesky, DMatrix, DVector, Dyn, Matrix3, Vector3};

/// Range of the damping, 1/s.
pub const DAMPING: (f64, f64) = (0.02, 3.0);
/// Range of the natural frequency, rad/s.
pub const FREQUENCY: (f64, f64) = (0.02, 6.0);
/// Medians of the priors of damping and natural frequency.
pub(super) const MEDIANS: (f64, f64) = (0.15, 0.6);
/// Standard deviation of the priors' logarithms.
pub(super) const PRIOR_SD: f64 = 1.0;
/// Standard deviation of what the model leaves out, as a share of lag 0; it also bounds the condition of the weights.
const MISFIT: f64 = 1e-3;
/// The model is followed until it has decayed to this share, or to `FARTHEST` steps.
const DECAYED: f64 = 1e-4;
const FARTHEST: usize = 1500;
/// In longer windows the removal of mean and trend changes the results by less than their scatter, and costs time, s.
const DETRENDING_S: f64 = 60.5;
/// A change of the logarithms under this ends the reweighting.
const SETTLED: f64 = 5e-3;
/// Most steps of one fit, and the change of a logarithm that ends it.
const STEPS: usize = 6;
const CONVERGED: f64 = 2e-3;

/// The fitted model of one axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Refined {
    /// The most probable parameters.
    pub flexure: Flexure,
    /// Posterior covariance of `ln mu`, `ln b`, `ln Q`, `Q` the density.
    pub covariance: Matrix3<f64>,
    /// Variance of the white noise of the rates, rad^2/s^2.
    pub noise: f64,
    /// Logarithm of the likelihood of the lags with the priors, up to a constant.
    pub evidence: f64,
}

/// The expected values at lag 0 and at the lags.
fn expected(data: &Autocovariance, model: &Flexure) -> (f64, DVector<f64>) {
    if data.points as f64 * data.step_s > DETRENDING_S {
        return plain(data, model);
    }
    let sequence = rate_autocovariance(model, data.points, data.step_s);
    let zero = detrended(&sequence, &[0])[0];
    (zero, DVector::from_vec(detrended(&sequence, &data.lags)))
}

/// The same without the effect of the removed trend.
fn plain(data: &Autocovariance, model: &Flexure) -> (f64, DVector<f64>) {
    let count = data.lags.last().map_or(1, |last| last + 1);
    let sequence = rate_autocovariance(model, count, data.step_s);
    (sequence[0], DVector::from_iterator(data.lags.len(), data.lags.iter().map(|&h| sequence[h])))
}

/// The best of a grid of models by unweighted squares of `values` at the lags, the size being projected out.
pub fn coarse(data: &Autocovariance, values: &[f64]) -> Option<Flexure> {
    let mut best: Option<(f64, Flexure)> = None;
    for mu in logarithmic(DAMPING.0, DAMPING.1, 16) {
        for b in logarithmic(FREQUENCY.0, FREQUENCY.1, 20) {
            let unit = Flexure { mu, b, sigma: 1.0 };
            let shape = plain(data, &unit).1;
            let (along, square) = (dot(shape.as_slice(), values), shape.norm_squared());
            let explained = along * along / square;
            if along > 0.0 && explained.is_finite() && best.is_none_or(|(most, _)| explained > most) {
                best = Some((explained, Flexure { sigma: (along / square).sqrt(), ..unit }));
            }
        }
    }
    best.map(|(_, flexure)| flexure)
}

/// A start that owes nothing to the lags but its size: critical, at the geometric mean of the priors' medians.
pub fn neutral(data: &Autocovariance) -> Flexure {
    let b = (MEDIANS.0 * MEDIANS.1).sqrt();
    Flexure { mu: b, b, sigma: data.zero.sqrt() / b }
}

/// Fits the model from a start; `lines` are undamped frequencies (rad/s) that are left free. `None` if it cannot be weighted.
/// The weights are renewed at most `rounds` times.
pub fn refine(data: &Autocovariance, lines: &[f64], start: Flexure, rounds: usize) -> Option<Refined> {
    let mut logs = logarithms(&start);
    let mut result = None;
    for _ in 0..rounds {
        let model = flexure(logs);
        let noise = (data.zero - expected(data, &model).0).max(0.0);
        let weights = Weights::new(data, lines, &model, noise)?;
        let (fitted, information) = fit(data, &weights, logs)?;
        let change = (fitted - logs).amax();
        logs = fitted;
        let covariance = information.try_inverse()?;
        let away = (fitted - prior()).component_mul(&precision());
        let evidence = weights.likelihood(data, &model) - 0.5 * away.dot(&(fitted - prior()));
        result = Some(Refined { flexure: flexure(logs), covariance, noise, evidence });
        if change < SETTLED {
            break;
        }
    }
    result
}

/// Which of the undamped sinusoids stand out of what the model says of the lags: a relevance vector machine on the whitened
/// residual. At most `most` frequencies, rad/s, the strongest first.
pub fn lines(data: &Autocovariance, model: &Flexure, frequencies: &[f64], most: usize) -> Vec<f64> {
    let noise = (data.zero - expected(data, model).0).max(0.0);
    let Some(weights) = Weights::new(data, &[], model, noise) else { return Vec::new() };
    let times = data.times();
    let mut design =
        DMatrix::from_fn(times.len(), frequencies.len(), |row, column| (frequencies[column] * times[row]).cos());
    weights.factor.l_dirty().solve_lower_triangular_mut(&mut design);
    design.column_iter_mut().for_each(|mut column| column /= column.norm());
    let residual = weights.residual(data, model);
    // What is left after whitening has at least the variance 1.
    let noise_share = times.len() as f64 / residual.norm_squared();
    let Some(found) = solve(&design, &residual, &Limits { noise_share, ..Limits::default() }) else {
        return Vec::new();
    };
    let mut lines: Vec<(f64, usize)> = found.weights.iter().map(|w| w.abs()).zip(found.active).collect();
    lines.sort_by(|a, b| b.0.total_cmp(&a.0));
    lines.into_iter().take(most).map(|(_, i)| frequencies[i]).collect()
}

/// `ln mu`, `ln b`, `ln Q`.
fn logarithms(model: &Flexure) -> Vector3<f64> {
    Vector3::new(model.mu.ln(), model.b.ln(), model.density().ln())
}

fn flexure(logs: Vector3<f64>) -> Flexure {
    let (mu, b, density) = (logs[0].exp(), logs[1].exp(), logs[2].exp());
    Flexure { mu, b, sigma: (density / (4.0 * mu * b * b)).sqrt() }
}

/// Levenberg's method on the whitened residual with the priors; returns the logarithms and the information about them.
fn fit(data: &Autocovariance, weights: &Weights, start: Vector3<f64>) -> Option<(Vector3<f64>, Matrix3<f64>)> {
    let (prior, precision) = (prior(), precision());
    let objective = |logs: &Vector3<f64>| {
        let residual = weights.residual(data, &flexure(*logs));
        let away = logs - prior;
        let cost = residual.norm_squared() + away.component_mul(&precision).dot(&away);
        (residual, cost)
    };
    let (mut logs, mut damping) = (start, 1e-3);
    let (mut residual, mut cost) = objective(&logs);
    let mut information = Matrix3::zeros();
    for _ in 0..STEPS {
        let jacobian = weights.jacobian(data, &logs);
        information =
            jacobian.tr_mul(&jacobian).fixed_view::<3, 3>(0, 0).into_owned() + Matrix3::from_diagonal(&precision);
        let downhill = jacobian.tr_mul(&residual) - precision.component_mul(&(logs - prior));
        let mut moved = 0.0;
        while damping < 1e6 {
            let damped = information + Matrix3::from_diagonal(&information.diagonal()) * damping;
            let next = bounded(logs + damped.cholesky()?.solve(&downhill));
            let (next_residual, next_cost) = objective(&next);
            if next_cost <= cost {
                moved = (next - logs).amax();
                (logs, residual, cost) = (next, next_residual, next_cost);
                damping = (damping / 10.0_f64).max(1e-9);
                break;
            }
            damping *= 10.0;
        }
        if moved < CONVERGED {
            break;
        }
    }
    cost.is_finite().then_some((logs, information))
}

fn prior() -> Vector3<f64> {
    Vector3::new(MEDIANS.0.ln(), MEDIANS.1.ln(), 0.0)
}

fn precision() -> Vector3<f64> {
    Vector3::new(1.0, 1.0, 0.0) / (PRIOR_SD * PRIOR_SD)
}

fn bounded(mut logs: Vector3<f64>) -> Vector3<f64> {
    logs[0] = logs[0].clamp(DAMPING.0.ln(), DAMPING.1.ln());
    logs[1] = logs[1].clamp(FREQUENCY.0.ln(), FREQUENCY.1.ln());
    logs
}

/// The covariance of the values at the lags, as a triangle that whitens them.
struct Weights {
    factor: Cholesky<f64, Dyn>,
}

impl Weights {
    fn new(data: &Autocovariance, lines: &[f64], model: &Flexure, noise: f64) -> Option<Self> {
        let longest = *data.lags.last()?;
        let overlap = overlaps(data, model, noise, 2 * longest);
        let n = data.points as f64;
        let unbiased: Vec<f64> = data.lags.iter().map(|&h| (1.0 - h as f64 / n).sqrt()).collect();
        let size = data.lags.len();
        let mut covariance = DMatrix::from_fn(size, size, |r, c| {
            let (h, k) = (data.lags[r], data.lags[c]);
            (overlap[h.abs_diff(k)] + overlap[h + k]) / (n * unbiased[r] * unbiased[c])
        });
        for k in 0..size {
            covariance[(k, k)] += (MISFIT * data.zero).powi(2);
        }
        for line in lines {
            let shape = DVector::from_iterator(size, data.times().iter().map(|t| (line * t).cos()));
            covariance.ger(data.zero * data.zero, &shape, &shape, 1.0);
        }
        Some(Self { factor: covariance.cholesky()? })
    }

    fn whiten(&self, mut vector: DVector<f64>) -> DVector<f64> {
        self.factor.l_dirty().solve_lower_triangular_mut(&mut vector);
        vector
    }

    fn residual(&self, data: &Autocovariance, model: &Flexure) -> DVector<f64> {
        self.whiten(DVector::from_column_slice(&data.values) - expected(data, model).1)
    }

    /// Derivatives of the whitened model in the logarithms, by central differences.
    fn jacobian(&self, data: &Autocovariance, logs: &Vector3<f64>) -> nalgebra::MatrixXx3<f64> {
        const STEP: f64 = 1e-4;
        let columns: [DVector<f64>; 3] = std::array::from_fn(|k| {
            let mut step = Vector3::zeros();
            step[k] = STEP;
            let (up, down) = (flexure(logs + step), flexure(logs - step));
            self.whiten((expected(data, &up).1 - expected(data, &down).1) / (2.0 * STEP))
        });
        nalgebra::MatrixXx3::from_columns(&columns)
    }

    fn likelihood(&self, data: &Autocovariance, model: &Flexure) -> f64 {
        let size: f64 = self.factor.l_dirty().diagonal().iter().map(|d| d.ln()).sum();
        -size - 0.5 * self.residual(data, model).norm_squared()
    }
}

/// `sum_m r(m) r(m + k)` over all m for k up to `most`: what Bartlett's formula is made of.
fn overlaps(data: &Autocovariance, model: &Flexure, noise: f64, most: usize) -> Vec<f64> {
    let mut side = rate_autocovariance(model, FARTHEST.min(data.points), data.step_s);
    let least = DECAYED * side[0];
    let end = side.iter().rposition(|r| r.abs() >= least).map_or(1, |last| last + 1);
    side.truncate(end);
    side[0] += noise;
    let both: Vec<f64> = side[1..].iter().rev().chain(&side).copied().collect();
    (0..=most).map(|k| both.get(k..).map_or(0.0, |late| dot(late, &both))).collect()
}
