//! Relevance vector machine: sparse Bayesian regression on any design matrix.
//!
//! Source: paper 000 eq 26-32, with the objective that its eq 33 should be, the logarithm of the marginal likelihood
//! `-(N log 2 pi + log|C| + y' C^-1 y) / 2`, `C = noise I + Phi A^-1 Phi'`; it is climbed by the fast sequential method of
//! M. Tipping and A. Faul (2003): in each round the one column is added, re-estimated or deleted that gains most.

use super::autocovariance::dot;
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

/// When to stop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Most rounds.
    pub rounds: usize,
    /// Least gain of a round in the logarithm of the marginal likelihood.
    pub gain: f64,
    /// Least noise variance as a share of the target's mean square. With more columns than rows it matters: the marginal
    /// likelihood then has its maximum where everything is explained and no noise is left.
    pub noise_share: f64,
}

impl Default for Limits {
    fn default() -> Self {
        Self { rounds: 300, gain: 1e-4, noise_share: 1e-6 }
    }
}

/// The sparse posterior.
#[derive(Clone, Debug, PartialEq)]
pub struct Relevance {
    /// The columns in the model, in the order in which they came.
    pub active: Vec<usize>,
    /// The precision of the prior of each of their weights.
    pub precisions: Vec<f64>,
    /// Posterior mean of their weights.
    pub weights: DVector<f64>,
    /// Posterior covariance of their weights.
    pub covariance: DMatrix<f64>,
    /// Variance of the noise.
    pub noise: f64,
    /// Logarithm of the marginal likelihood.
    pub evidence: f64,
    /// Rounds taken.
    pub rounds: usize,
}

/// Rounds between two estimates of the noise.
const NOISE_EVERY: usize = 5;
/// A relative change of the noise under this counts as none.
const NOISE_CHANGE: f64 = 1e-3;

/// Fits `target` (N) by few columns of `design` (N by M). `None` if sizes do not match, the target has no variance, no column
/// explains anything, or a number is not finite.
pub fn solve(design: &DMatrix<f64>, target: &DVector<f64>, limits: &Limits) -> Option<Relevance> {
    let mut model = Model::start(design, target, limits)?;
    let mut rounds = 0;
    let mut posterior = model.posterior()?;
    while rounds < limits.rounds {
        rounds += 1;
        let (step, gain) = model.best(&posterior);
        let settled = gain < limits.gain;
        if !settled {
            model.apply(step);
            posterior = model.posterior()?;
        }
        if settled || rounds % NOISE_EVERY == 0 {
            let change = model.renoise(&posterior, limits);
            posterior = model.posterior()?;
            if settled && change < NOISE_CHANGE {
                break;
            }
        }
    }
    let evidence = model.evidence(&posterior);
    evidence.is_finite().then(|| Relevance {
        covariance: posterior.factor.inverse(),
        active: model.active,
        precisions: model.precisions,
        weights: posterior.mean,
        noise: model.noise,
        evidence,
        rounds,
    })
}

#[derive(Clone, Copy)]
enum Step {
    Add(usize, f64),
    Reestimate(usize, f64),
    Delete(usize),
}

struct Posterior {
    factor: Cholesky<f64, Dyn>,
    mean: DVector<f64>,
}

struct Model<'a> {
    design: &'a DMatrix<f64>,
    target: &'a DVector<f64>,
    /// Squared length of each column.
    squares: Vec<f64>,
    /// Scalar product of each column with the target.
    projections: Vec<f64>,
    active: Vec<usize>,
    precisions: Vec<f64>,
    /// For each active column its scalar products with all columns.
    gram: Vec<Vec<f64>>,
    noise: f64,
}

impl<'a> Model<'a> {
    fn start(design: &'a DMatrix<f64>, target: &'a DVector<f64>, limits: &Limits) -> Option<Self> {
        let power = target.norm_squared() / target.len() as f64;
        if design.nrows() != target.len() || design.ncols() == 0 || !power.is_normal() {
            return None;
        }
        let squares: Vec<f64> = design.column_iter().map(|column| column.norm_squared()).collect();
        let projections: Vec<f64> = design.tr_mul(target).iter().copied().collect();
        let share = |i: &usize| if squares[*i] > 0.0 { projections[*i] * projections[*i] / squares[*i] } else { 0.0 };
        let first = (0..squares.len()).max_by(|a, b| share(a).total_cmp(&share(b)))?;
        let noise = power * limits.noise_share.max(0.1);
        let excess = share(&first) - noise;
        if !(excess > 0.0 && excess.is_finite()) {
            return None;
        }
        let precision = squares[first] / excess;
        let (active, precisions, gram) = (Vec::new(), Vec::new(), Vec::new());
        let mut model = Self { design, target, squares, projections, active, precisions, gram, noise };
        model.apply(Step::Add(first, precision));
        Some(model)
    }

    /// 000 eq 29.
    fn posterior(&self) -> Option<Posterior> {
        let size = self.active.len();
        let mut inverse = DMatrix::from_fn(size, size, |r, c| self.gram[r][self.active[c]] / self.noise);
        for (k, precision) in self.precisions.iter().enumerate() {
            inverse[(k, k)] += precision;
        }
        let factor = inverse.cholesky()?;
        let projections = DVector::from_iterator(size, self.active.iter().map(|&i| self.projections[i] / self.noise));
        let mean = factor.solve(&projections);
        Some(Posterior { factor, mean })
    }

    /// Sparsity and quality of every column, `phi' C^-1 phi` and `phi' C^-1 y`.
    fn statistics(&self, posterior: &Posterior) -> (Vec<f64>, Vec<f64>) {
        let mut sparsity: Vec<f64> = self.squares.iter().map(|s| s / self.noise).collect();
        let mut quality: Vec<f64> = self.projections.iter().map(|p| p / self.noise).collect();
        let factor = posterior.factor.l_dirty();
        let mut rows: Vec<Vec<f64>> = Vec::with_capacity(self.active.len());
        for (k, gram) in self.gram.iter().enumerate() {
            let mut row: Vec<f64> = gram.iter().map(|g| g / self.noise).collect();
            for (j, earlier) in rows.iter().enumerate() {
                let share = factor[(k, j)];
                row.iter_mut().zip(earlier).for_each(|(v, e)| *v -= share * e);
            }
            let pivot = factor[(k, k)];
            row.iter_mut().zip(&mut sparsity).for_each(|(v, s)| {
                *v /= pivot;
                *s -= *v * *v;
            });
            let weight = posterior.mean[k] / self.noise;
            quality.iter_mut().zip(gram).for_each(|(q, g)| *q -= weight * g);
            rows.push(row);
        }
        (sparsity, quality)
    }

    /// The step that gains most, and its gain in the logarithm of the marginal likelihood.
    fn best(&self, posterior: &Posterior) -> (Step, f64) {
        let (sparsity, quality) = self.statistics(posterior);
        let mut place = vec![usize::MAX; sparsity.len()];
        self.active.iter().enumerate().for_each(|(k, &i)| place[i] = k);
        let mut best = (Step::Delete(0), f64::NEG_INFINITY);
        for i in 0..sparsity.len() {
            let (s, q) = (sparsity[i], quality[i]);
            let candidate = match self.precisions.get(place[i]) {
                None => add(i, s, q),
                Some(&precision) => change(place[i], precision, s, q, self.active.len() > 1),
            };
            if let Some((step, gain)) = candidate
                && gain > best.1
            {
                best = (step, gain);
            }
        }
        best
    }

    fn apply(&mut self, step: Step) {
        match step {
            Step::Add(i, precision) => {
                let column = self.design.column(i);
                let column = column.as_slice();
                let rows = self.design.nrows();
                self.gram.push(self.design.as_slice().chunks_exact(rows).map(|other| dot(other, column)).collect());
                self.active.push(i);
                self.precisions.push(precision);
            }
            Step::Reestimate(k, precision) => self.precisions[k] = precision,
            Step::Delete(k) => {
                self.active.remove(k);
                self.precisions.remove(k);
                self.gram.remove(k);
            }
        }
    }

    fn residual(&self, posterior: &Posterior) -> f64 {
        let mut residual = self.target.clone();
        for (&i, &weight) in self.active.iter().zip(posterior.mean.iter()) {
            residual.axpy(-weight, &self.design.column(i), 1.0);
        }
        residual.norm_squared()
    }

    /// 000 eq 32; returns the relative change of the noise.
    fn renoise(&mut self, posterior: &Posterior, limits: &Limits) -> f64 {
        let covariance = posterior.factor.inverse();
        let determined: f64 = self.precisions.iter().enumerate().map(|(k, a)| 1.0 - a * covariance[(k, k)]).sum();
        let count = self.target.len() as f64;
        let floor = limits.noise_share * self.target.norm_squared() / count;
        let noise = (self.residual(posterior) / (count - determined).max(1.0)).max(floor);
        let change = (noise / self.noise - 1.0).abs();
        self.noise = noise;
        change
    }

    fn evidence(&self, posterior: &Posterior) -> f64 {
        let count = self.target.len() as f64;
        let inverse: f64 = posterior.factor.l_dirty().diagonal().iter().map(|d| 2.0 * d.ln()).sum();
        let priors: f64 = self.precisions.iter().map(|a| a.ln()).sum();
        let penalty: f64 = self.precisions.iter().zip(posterior.mean.iter()).map(|(a, w)| a * w * w).sum();
        let misfit = self.residual(posterior) / self.noise + penalty;
        -0.5 * (count * (std::f64::consts::TAU * self.noise).ln() + inverse - priors + misfit)
    }
}

/// The gain of a column that is not in the model.
fn add(i: usize, s: f64, q: f64) -> Option<(Step, f64)> {
    let excess = q * q - s;
    (s > 0.0 && excess > 0.0).then(|| (Step::Add(i, s * s / excess), 0.5 * (excess / s + (s / (q * q)).ln())))
}

/// The gain of a better precision of a column that is in the model, or of its deletion.
fn change(k: usize, precision: f64, with: f64, quality: f64, deletable: bool) -> Option<(Step, f64)> {
    // Sparsity and quality as if the column were not in the model; rounding can spoil the difference.
    if with >= precision {
        return None;
    }
    let ratio = precision / (precision - with);
    let (s, q) = (with * ratio, quality * ratio);
    let excess = q * q - s;
    if excess > 0.0 {
        let better = s * s / excess;
        let difference = 1.0 / better - 1.0 / precision;
        let gain = quality * quality * difference / (1.0 + with * difference) - (1.0 + with * difference).ln();
        Some((Step::Reestimate(k, better), 0.5 * gain))
    } else if deletable {
        let gain = quality * quality / (with - precision) - (1.0 - with / precision).ln();
        Some((Step::Delete(k), 0.5 * gain))
    } else {
        None
    }
}
