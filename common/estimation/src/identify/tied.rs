//! The flexure model fitted to an autocovariance by plain least squares.
//!
//! Source: 000 eq 17 (factor the right way up) and 20, all three parameters tied; the variance is projected out, so that two
//! unknowns are left. The squares are weighted by the share of the data in each lag. Papers fit like this; for what the
//! correlation of neighbouring lags loses, see [`super::refinement`].

use super::dictionary::logarithmic;
use super::lagged::Lagged;
use super::refinement::{DAMPING, FREQUENCY};
use super::series::{Kind, Series};
use crate::flexure::Flexure;
use nalgebra::{DVector, Matrix2, Vector2};

/// Between two lags of these fits, s.
pub const SPACING_S: f64 = 0.2;
/// Their longest lag, s. With 40 s the errors at 300 s were measured to be a third larger in damping and a half in density, since
/// the late lags of a fast flexure hold nothing but sampling error; a slow one's frequency was a fifth better.
pub const LONGEST_S: f64 = 20.0;
/// Most steps of the fit, the change of a logarithm that ends it, and the step of the derivatives.
const STEPS: usize = 40;
const CONVERGED: f64 = 1e-6;
const DIFFERENCE: f64 = 1e-5;

/// The model at the lags of a series.
#[derive(Clone, Debug)]
pub struct Tied {
    kind: Kind,
    step_s: f64,
    stride: usize,
    weights: DVector<f64>,
}

impl Tied {
    /// For the lags of an autocovariance.
    pub fn new(series: &Series, lagged: &Lagged) -> Self {
        let points = series.values.len() as f64;
        let weights = DVector::from_fn(lagged.values.len(), |row, _| 1.0 - ((row + 1) * lagged.stride) as f64 / points);
        Self { kind: series.kind, step_s: series.step_s, stride: lagged.stride, weights }
    }

    /// The weighted values at the lags of a model with the variance 1.
    fn shape(&self, mu: f64, b: f64) -> DVector<f64> {
        let count = self.weights.len() * self.stride + 1;
        let model = Flexure { mu, b, sigma: 1.0 };
        // Angles cost an exponential a lag, rates follow from one to the next.
        let values = match self.kind {
            Kind::Angles => self.kind.autocovariance(&model, self.weights.len() + 1, self.step_s * self.stride as f64),
            Kind::Rates => self.kind.autocovariance(&model, count, self.step_s),
        };
        let stride = if self.kind == Kind::Angles { 1 } else { self.stride };
        DVector::from_fn(self.weights.len(), |row, _| values[(row + 1) * stride] * self.weights[row])
    }

    /// Variance of the flexure (rad^2) and weighted residual; `None` where the model cannot be as large as it would need to be.
    fn projected(&self, target: &DVector<f64>, mu: f64, b: f64) -> Option<(f64, DVector<f64>)> {
        let shape = self.shape(mu, b);
        let weighted = target.component_mul(&self.weights);
        let variance = shape.dot(&weighted) / shape.norm_squared();
        (variance > 0.0 && variance.is_finite()).then(|| (variance, weighted - shape * variance))
    }

    /// The variance that fits the target best, rad^2.
    pub fn variance(&self, target: &DVector<f64>, mu: f64, b: f64) -> Option<f64> {
        self.projected(target, mu, b).map(|(variance, _)| variance)
    }

    /// Sum of the weighted squares that are left, or infinity.
    pub fn cost(&self, target: &DVector<f64>, mu: f64, b: f64) -> f64 {
        self.projected(target, mu, b).map_or(f64::INFINITY, |(_, residual)| residual.norm_squared())
    }

    /// The model of given damping and frequency with the variance that fits best.
    pub fn flexure(&self, target: &DVector<f64>, mu: f64, b: f64) -> Option<Flexure> {
        let flexure = Flexure { mu, b, sigma: self.variance(target, mu, b)?.sqrt() };
        flexure.is_sound().then_some(flexure)
    }

    /// The best model: a grid, then Levenberg's method.
    pub fn least_squares(&self, target: &DVector<f64>) -> Option<Flexure> {
        let grid = logarithmic(DAMPING.0, DAMPING.1, 16)
            .flat_map(|mu| logarithmic(FREQUENCY.0, FREQUENCY.1, 20).map(move |b| (mu, b)));
        let (mu, b) =
            grid.min_by(|one, other| self.cost(target, one.0, one.1).total_cmp(&self.cost(target, other.0, other.1)))?;
        let found = self.descend(target, Vector2::new(mu.ln(), b.ln()))?;
        self.flexure(target, found[0].exp(), found[1].exp())
    }

    fn descend(&self, target: &DVector<f64>, mut logs: Vector2<f64>) -> Option<Vector2<f64>> {
        let residual = |logs: &Vector2<f64>| self.projected(target, logs[0].exp(), logs[1].exp()).map(|(_, r)| r);
        let mut here = residual(&logs)?;
        let mut damping = 1e-3;
        for _ in 0..STEPS {
            let mut slopes = Vec::with_capacity(2);
            for k in 0..2 {
                let mut there = logs;
                there[k] += DIFFERENCE;
                slopes.push((residual(&there)? - &here) / DIFFERENCE);
            }
            let dots = |a: &DVector<f64>, b: &DVector<f64>| a.dot(b);
            let normal = Matrix2::from_fn(|r, c| dots(&slopes[r], &slopes[c]));
            let downhill = -Vector2::from_fn(|k, _| dots(&slopes[k], &here));
            let mut moved = 0.0;
            while damping < 1e9 {
                let damped = normal + Matrix2::from_diagonal(&normal.diagonal()) * damping;
                let Some(step) = damped.try_inverse().map(|inverse| inverse * downhill) else { break };
                let next = bounded(logs + step);
                match residual(&next) {
                    Some(better) if better.norm_squared() <= here.norm_squared() => {
                        moved = (next - logs).amax();
                        (logs, here, damping) = (next, better, damping / 10.0);
                        break;
                    }
                    _ => damping *= 10.0,
                }
            }
            if moved < CONVERGED {
                break;
            }
        }
        Some(logs)
    }
}

fn bounded(logs: Vector2<f64>) -> Vector2<f64> {
    Vector2::new(logs[0].clamp(DAMPING.0.ln(), DAMPING.1.ln()), logs[1].clamp(FREQUENCY.0.ln(), FREQUENCY.1.ln()))
}
