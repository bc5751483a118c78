//! Which terms the variances show.

use super::deviation::Averaged;
use super::fit::Fit;
use super::terms::Term;
use super::{Coefficients, Estimate};

const TERMS: [Term; 4] = [Term::Quantisation, Term::White, Term::Flicker, Term::Walk];
/// By which factor variances of errors and differences of deviances are larger than those of points that know nothing of each other:
/// neighbouring averaging times share their data.
const SHARED: f64 = 2.0;
/// A coefficient has to lower the deviance by this to be believed: the 95 % point of chi-square with one degree of freedom.
const PRICE: f64 = 3.84 * SHARED;
/// Correlation times that are tried, an octave.
const AN_OCTAVE: i32 = 3;
/// Below this averaging time a rise of `sigma^2 tau` is taken for the unit's own low-pass filter, s.
const FILTERED_S: f64 = 1.0;
/// By which factor it has to rise from one point to the next.
const RISE: f64 = 1.05;

/// The best set of terms, and what could stand in its place.
pub(super) struct Chosen {
    pub best: Fit,
    /// Fits of the same terms whose correlation time is as likely within one standard deviation.
    rivals: Vec<Fit>,
    /// By which factor the covariance is widened, because the points share data and the model does not meet them.
    widening: f64,
}

/// `None` where no set of terms can be fitted.
pub(super) fn choose(points: &[Averaged], freedoms: &[f64]) -> Option<Chosen> {
    let begin = unfiltered(points);
    let (points, freedoms) = (&points[begin..], &freedoms[begin..]);
    let mut fits: Vec<Fit> = Vec::new();
    for subset in 0..1u32 << TERMS.len() {
        let terms: Vec<Term> = (0..TERMS.len()).filter(|i| subset >> i & 1 == 1).map(|i| TERMS[i]).collect();
        if !terms.is_empty() {
            fits.extend(Fit::of(terms.clone(), points, freedoms));
        }
        for correlation in correlations(points) {
            let terms = terms.iter().copied().chain([Term::Markov(correlation)]).collect();
            fits.extend(Fit::of(terms, points, freedoms));
        }
    }
    let best = fits.iter().min_by(|a, b| cost(a).total_cmp(&cost(b)))?.clone();
    let left = points.len().saturating_sub(parameters(&best)).max(1);
    let widening = SHARED * (best.deviance / left as f64).max(1.0);
    let rivals = fits.into_iter().filter(|fit| kinds(fit) == kinds(&best) && fit.deviance < best.deviance + widening);
    Some(Chosen { rivals: rivals.collect(), best, widening })
}

/// Where the fit begins: a unit's low-pass filter holds the shortest averages below the slope of white noise.
fn unfiltered(points: &[Averaged]) -> usize {
    let rising = |pair: &&[Averaged]| {
        pair[1].tau <= FILTERED_S && pair[1].variance * pair[1].tau > RISE * pair[0].variance * pair[0].tau
    };
    points.windows(2).take_while(rising).count()
}

/// Shorter ones look like white noise, longer ones like a random walk.
fn correlations(points: &[Averaged]) -> impl Iterator<Item = f64> {
    let last = points.len() as i32 - 1;
    let first_tau = points[0].tau;
    (2 * AN_OCTAVE..AN_OCTAVE * (last - 1)).map(move |k| first_tau * (f64::from(k) / f64::from(AN_OCTAVE)).exp2())
}

/// A Gauss-Markov process counts for three: its correlation time is the best of many that were tried.
fn parameters(fit: &Fit) -> usize {
    fit.terms.len() + 2 * fit.terms.iter().filter(|term| matches!(term, Term::Markov(_))).count()
}

fn cost(fit: &Fit) -> f64 {
    fit.deviance + PRICE * parameters(fit) as f64
}

fn kinds(fit: &Fit) -> Vec<std::mem::Discriminant<Term>> {
    fit.terms.iter().map(std::mem::discriminant).collect()
}

impl Chosen {
    /// The coefficients of the terms that are shown.
    pub fn coefficients(&self) -> Coefficients {
        let fit = &self.best;
        let of = |wanted: Term| {
            let at = fit.terms.iter().position(|term| *term == wanted)?;
            Some(self.root(fit.coefficients[at], fit.covariance[(at, at)]))
        };
        Coefficients {
            white: of(Term::White),
            instability: self.instability(),
            correlation: self.correlation(),
            walk: of(Term::Walk),
            quantisation: of(Term::Quantisation),
            most_instability: 0.0,
        }
    }

    /// The square root of a square with its variance.
    fn root(&self, square: f64, variance: f64) -> Estimate {
        let value = square.sqrt();
        Estimate { value, sigma: (variance * self.widening).sqrt() / (2.0 * value) }
    }

    fn instability(&self) -> Option<Estimate> {
        let both = self.of_bias().into_iter().chain(self.lowest());
        both.max_by(|a, b| a.value.total_cmp(&b.value))
    }

    /// By the terms that stand for a wandering bias.
    fn of_bias(&self) -> Option<Estimate> {
        let of = |fit: &Fit| weighted(fit, &fit.terms.iter().map(|term| term.instability()).collect::<Vec<f64>>());
        let (best, variance) = of(&self.best);
        if best <= 0.0 {
            return None;
        }
        let known = self.root(best, variance);
        let by_correlation = half_width(self.rivals.iter().map(|fit| of(fit).0.sqrt()));
        Some(Estimate { sigma: known.sigma.hypot(by_correlation), ..known })
    }

    /// By the bottom of the fitted curve, where white noise passes into a random walk.
    fn lowest(&self) -> Option<Estimate> {
        let of = |wanted: Term| {
            let at = self.best.terms.iter().position(|term| *term == wanted)?;
            Some(self.best.coefficients[at])
        };
        let tau = (3.0 * of(Term::White)? / of(Term::Walk)?).sqrt();
        let level = Term::Flicker.variance(tau);
        let shares: Vec<f64> = self.best.terms.iter().map(|term| term.variance(tau) / level).collect();
        let (square, variance) = weighted(&self.best, &shares);
        Some(self.root(square, variance))
    }

    fn correlation(&self) -> Option<Estimate> {
        let of = |fit: &Fit| {
            fit.terms.iter().find_map(|term| match term {
                Term::Markov(correlation) => Some(*correlation),
                _ => None,
            })
        };
        let value = of(&self.best)?;
        // between the times that were tried nothing is known
        let grid = value * (1.0 / f64::from(AN_OCTAVE)).exp2() - value;
        let sigma = half_width(self.rivals.iter().filter_map(of)).max(grid);
        Some(Estimate { value, sigma })
    }
}

/// A weighted sum of the coefficients, and its variance.
fn weighted(fit: &Fit, weights: &[f64]) -> (f64, f64) {
    let sum = weights.iter().zip(fit.coefficients.iter()).map(|(w, c)| w * c).sum();
    let pairs = (0..weights.len()).flat_map(|i| (0..weights.len()).map(move |j| (i, j)));
    (sum, pairs.map(|(i, j)| weights[i] * weights[j] * fit.covariance[(i, j)]).sum())
}

fn half_width(values: impl Iterator<Item = f64>) -> f64 {
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
    if low < high { (high - low) / 2.0 } else { 0.0 }
}
