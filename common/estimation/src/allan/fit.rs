//! Maximum likelihood of a set of terms.

use super::deviation::Averaged;
use super::freedom::Noise;
use super::terms::Term;
use nalgebra::{DMatrix, DVector};

/// By how much a model of a few terms is taken to be wrong at each averaging time, as a part of the variance. Without it the
/// shortest times, which millions of samples know to a thousandth, would rule the whole fit.
const MODEL_ERROR: f64 = 0.02;
const ITERATIONS: usize = 30;

/// Terms with the coefficients that explain the variances best.
#[derive(Clone, Debug)]
pub(super) struct Fit {
    pub terms: Vec<Term>,
    /// One a term, greater than zero.
    pub coefficients: DVector<f64>,
    pub covariance: DMatrix<f64>,
    /// Twice the logarithm of the likelihood's ratio to that of a model that meets every point.
    pub deviance: f64,
}

impl Fit {
    /// Fisher's scoring; `None` where a coefficient comes out negative, so that a smaller set of terms is as good.
    pub fn of(terms: Vec<Term>, points: &[Averaged], freedoms: &[f64]) -> Option<Self> {
        let basis = DMatrix::from_fn(points.len(), terms.len(), |i, j| terms[j].variance(points[i].tau));
        let weights: Vec<f64> = freedoms.iter().map(|freedom| 1.0 / (2.0 / freedom + MODEL_ERROR.powi(2))).collect();
        let mut model: Vec<f64> = points.iter().map(|point| point.variance).collect();
        let mut solved = None;
        for _ in 0..ITERATIONS {
            let (coefficients, covariance) = solve(&basis, points, &weights, &model)?;
            let fitted = &basis * &coefficients;
            // a step that goes below zero anywhere is cut short
            model = fitted.iter().zip(&model).map(|(new, old)| new.max(0.1 * old)).collect();
            solved = Some((coefficients, covariance));
        }
        let (coefficients, covariance) = solved?;
        if coefficients.iter().any(|c| *c <= 0.0) {
            return None;
        }
        let of_point = |((point, model), weight): ((&Averaged, &f64), &f64)| {
            let ratio = point.variance / model;
            2.0 * weight * (ratio - 1.0 - ratio.ln())
        };
        let deviance = points.iter().zip(&model).zip(&weights).map(of_point).sum();
        Some(Self { terms, coefficients, covariance, deviance })
    }

    /// The model's Allan variance.
    pub fn variance(&self, tau: f64) -> f64 {
        self.terms.iter().zip(self.coefficients.iter()).map(|(term, c)| c * term.variance(tau)).sum()
    }

    /// The kind of noise whose slope the model has there.
    pub fn noise_at(&self, tau: f64) -> Noise {
        let slope = (self.variance(1.1 * tau) / self.variance(tau / 1.1)).ln() / (1.1f64 * 1.1).ln();
        match slope {
            s if s < -1.5 => Noise::Quantisation,
            s if s < -0.5 => Noise::White,
            s if s < 0.5 => Noise::Flicker,
            _ => Noise::Walk,
        }
    }
}

/// Weighted least squares about a model: coefficients and their covariance.
fn solve(
    basis: &DMatrix<f64>,
    points: &[Averaged],
    weights: &[f64],
    model: &[f64],
) -> Option<(DVector<f64>, DMatrix<f64>)> {
    let root = |i: usize| weights[i].sqrt() / model[i];
    let rows = DMatrix::from_fn(basis.nrows(), basis.ncols(), |i, j| basis[(i, j)] * root(i));
    let target = DVector::from_fn(basis.nrows(), |i, _| points[i].variance * root(i));
    // coefficients of different terms are many powers of ten apart
    let scales: Vec<f64> = rows.column_iter().map(|column| column.norm()).collect();
    let scaled = DMatrix::from_fn(rows.nrows(), rows.ncols(), |i, j| rows[(i, j)] / scales[j]);
    let normal = (scaled.transpose() * &scaled).cholesky()?;
    let solution = normal.solve(&(scaled.transpose() * target));
    let inverse = normal.inverse();
    let covariance = DMatrix::from_fn(scales.len(), scales.len(), |i, j| inverse[(i, j)] / (scales[i] * scales[j]));
    Some((DVector::from_fn(scales.len(), |i, _| solution[i] / scales[i]), covariance))
}
