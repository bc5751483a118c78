//! One axis by the relevance vector machine with damped sinusoids: from rates to the parameters of its flexure.
//!
//! Source: paper 000 section 3.2 (eq 25-33); the corrections stand in [`super::relevance`], [`super::dictionary`] and
//! [`super::refinement`]. Lag 0 does not enter.

use super::autocovariance::{Autocovariance, lags};
use super::dictionary::{Atom, Dictionary};
use super::refinement::{Refined, coarse, lines, neutral, refine};
use super::relevance::{Limits, Relevance, solve};
use crate::flexure::Flexure;
use nalgebra::{DVector, Matrix3};

/// What an axis's window says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Identified {
    /// The parameters before the safety rule.
    pub flexure: Flexure,
    /// Standard deviation of `ln mu`.
    pub ln_mu_sd: f64,
    /// Standard deviation of `ln b`.
    pub ln_b_sd: f64,
    /// Standard deviation of `ln sigma`.
    pub ln_sigma_sd: f64,
    /// Standard deviation of the logarithm of the density `Q`.
    pub ln_density_sd: f64,
}

impl Identified {
    /// With the standard deviations of a covariance of `ln mu`, `ln b`, `ln Q`, but at least what sampling over the time `T` leaves:
    /// `1/sqrt(mu T)` of `ln mu`, and `2/sqrt(b T)` of `ln b` at critical damping and above (less where it oscillates, by
    /// `sqrt(mu/b)`), each with the prior's information added. The floor of `ln b` is twice what the bound `2/sqrt(b T)` of `b^2`
    /// says: the likelihood is skew towards slow models, and with the bound itself the errors were measured to be three times the
    /// standard deviation. `None` if a number is not positive and finite.
    pub fn new(flexure: Flexure, covariance: &Matrix3<f64>, length_s: f64) -> Option<Self> {
        let Flexure { mu, b, sigma } = flexure;
        let mu_floor = 1.0 / (mu * length_s + 1.0);
        let b_floor = 1.0 / (b * length_s / (4.0 * (mu / b).min(1.0)) + 1.0);
        let result = Self {
            flexure,
            ln_mu_sd: covariance[(0, 0)].max(mu_floor).sqrt(),
            ln_b_sd: covariance[(1, 1)].max(b_floor).sqrt(),
            ln_sigma_sd: sigma_variance(covariance).max(mu_floor / 4.0 + b_floor).sqrt(),
            ln_density_sd: covariance[(2, 2)].sqrt(),
        };
        let numbers = [mu, b, sigma, result.ln_mu_sd, result.ln_b_sd, result.ln_sigma_sd, result.ln_density_sd];
        numbers.iter().all(|value| value.is_finite() && *value > 0.0).then_some(result)
    }
}

/// Variance of `ln sigma = (ln Q - ln 4 - ln mu - 2 ln b) / 2` from the covariance of `ln mu`, `ln b`, `ln Q`.
pub(super) fn sigma_variance(covariance: &Matrix3<f64>) -> f64 {
    let row = nalgebra::RowVector3::new(-0.5, -1.0, 0.5);
    (row * covariance * row.transpose())[0]
}

/// The analysis of windows of one length: the lags and the dictionary are the same for all axes.
#[derive(Clone, Debug)]
pub struct Analysis {
    points: usize,
    step_s: f64,
    dictionary: Dictionary,
}

/// Least share of the autocovariance's power that is sampling error, whatever the window.
const SAMPLING: f64 = 1e-3;
/// How often the weights of the refinement are renewed: from each start, and from the best.
const TRIAL: usize = 3;
const FINAL: usize = 6;
/// At most so many undamped sinusoids are left free in the refinement.
const MOST_LINES: usize = 8;
/// One of them needs so much of the window, s.
const SECONDS_PER_LINE: f64 = 20.0;

impl Analysis {
    /// For windows of `points` rates at the distance `step_s`; `size` multiplies the dictionary, `lines` puts the undamped atoms in.
    pub fn new(points: usize, step_s: f64, size: usize, lines: bool) -> Self {
        let times: Vec<f64> = lags(points, step_s).into_iter().map(|h| h as f64 * step_s).collect();
        Self { points, step_s, dictionary: Dictionary::new(&times, size, lines) }
    }

    /// Identifies an axis; `None` if its rates do not vary, are not finite, or fit no flexure.
    pub fn identify(&self, rates: &[f64]) -> Option<Identified> {
        if rates.len() != self.points {
            return None;
        }
        let data = Autocovariance::new(rates, self.step_s)?;
        let target = DVector::from_iterator(data.values.len(), data.values.iter().map(|r| r / data.zero));
        let relevance =
            solve(&self.dictionary.design, &target, &Limits { noise_share: SAMPLING, ..Limits::default() })?;
        let damped: Vec<f64> = self.damped(&relevance).iter().map(|r| r * data.zero).collect();
        let starts = [coarse(&data, &damped), Some(neutral(&data))];
        let mut trials: Vec<(Refined, Vec<f64>)> = Vec::new();
        for start in starts.into_iter().flatten() {
            let lines = self.lines(&data, &start);
            let sets = if lines.is_empty() { vec![lines] } else { vec![Vec::new(), lines] };
            trials.extend(sets.into_iter().filter_map(|set| Some((refine(&data, &set, start, TRIAL)?, set))));
        }
        let (trial, set) = trials.into_iter().max_by(|a, b| a.0.evidence.total_cmp(&b.0.evidence))?;
        let lines = self.lines(&data, &trial.flexure);
        let again = (lines != set).then(|| refine(&data, &lines, trial.flexure, FINAL)).flatten();
        let same = refine(&data, &set, trial.flexure, FINAL);
        let refined = [again, same].into_iter().flatten().max_by(|a, b| a.evidence.total_cmp(&b.evidence))?;
        Identified::new(refined.flexure, &refined.covariance, self.points as f64 * self.step_s)
    }

    /// The part of the autocovariance that the damped atoms make up.
    fn damped(&self, relevance: &Relevance) -> DVector<f64> {
        let mut sum = DVector::zeros(self.dictionary.design.nrows());
        for (&i, &weight) in relevance.active.iter().zip(relevance.weights.iter()) {
            if !matches!(self.dictionary.atoms[i], Atom::Line { .. }) {
                sum.axpy(weight, &self.dictionary.design.column(i), 1.0);
            }
        }
        sum
    }

    /// The frequencies of undamped sinusoids that stand out of what a model says.
    fn lines(&self, data: &Autocovariance, model: &Flexure) -> Vec<f64> {
        let most = MOST_LINES.min((self.points as f64 * self.step_s / SECONDS_PER_LINE) as usize);
        lines(data, model, &self.dictionary.lines(), most)
    }
}
