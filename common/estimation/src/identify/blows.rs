//! Rates without the blows of a sea that hits the hull.
//!
//! A blow is a moment of far stronger driving noise. It adds to a periodogram's power as much as minutes of the rest, and a filter that reckons with blows by
//! itself needs the rest. Kalman's filter of the mode that was fitted to the whole says of each rate what could not be expected of it; where that is far too much
//! the flexure has got a kick, whose later course is taken out of the rates with it.

use super::innovation::{Kalman, Noisy};
use super::series::Series;
use crate::scatter::deviation;
use nalgebra::Vector3;

/// A change of the rate by so many deviations is a blow; ten minutes without one have a larger change once in ten thousand times.
const BLOW: f64 = 6.0;
/// What is not expected by so many deviations is a kick, once there are blows.
const KICK: f64 = 4.0;
/// Between the blows the driving noise is taken to be this share of the whole at least.
const LEAST: f64 = 1e-3;
/// Steps after which a covariance is as it stays.
const STEADY: usize = 200;

/// Whether rates at equal distances about one axis have blows in them.
fn has_blows(rates: &[f64]) -> bool {
    let mut changes: Vec<f64> = rates.windows(2).map(|pair| (pair[1] - pair[0]).abs()).collect();
    let largest = changes.iter().copied().fold(0.0, f64::max);
    largest > BLOW * deviation(&mut changes)
}

/// Rates without their blows; `None` if there are none, or nothing can be fitted.
pub fn without_blows(series: &Series) -> Option<Vec<f64>> {
    if !has_blows(series.values) {
        return None;
    }
    let whole = Kalman::new(&Noisy::fitted(series)?, series.step_s);
    let (_, calm) = whole.between(series.values).run(series.values, KICK);
    calm.iter().all(|rate| rate.is_finite()).then_some(calm)
}

impl Kalman {
    /// The same with no more driving noise than there is between the blows of rates.
    fn between(self, rates: &[f64]) -> Self {
        let (news, _) = self.run(rates, f64::INFINITY);
        let mut sizes: Vec<f64> = news.iter().map(|news| news.abs()).collect();
        // of what is not expected the white noise is a part that blows do not raise
        let (seen, steady) = (deviation(&mut sizes).powi(2), self.steady());
        let calmer = ((seen * steady - self.noise) / (steady - self.noise)).clamp(LEAST, 1.0);
        self.driven(calmer)
    }

    /// Variance of what is not expected of a rate, after a while.
    fn steady(&self) -> f64 {
        let mut p = self.start;
        for _ in 0..STEADY {
            p = self.carried(&self.updated(&p));
        }
        self.variance(&p)
    }

    /// What was not expected of each rate, in deviations, and the rates without what kicks of more than `limit` deviations did.
    fn run(&self, rates: &[f64], limit: f64) -> (Vec<f64>, Vec<f64>) {
        let (mut state, mut kicked) = (Vector3::zeros(), Vector3::zeros());
        let (mut p, mut calm) = (self.start, self.start);
        let step = |rate: &f64| {
            (state, kicked) = (self.transition * state, self.transition * kicked);
            (p, calm) = (self.carried(&p), self.carried(&calm));
            let off = rate - self.rate(&state);
            let news = off / self.variance(&p).sqrt();
            if news.abs() > limit {
                p += self.drive * ((off * off - self.variance(&p)) / self.share(&self.drive));
                kicked += self.gain(&p) * off;
            } else {
                kicked += (self.gain(&p) - self.gain(&calm)) * off;
            }
            state += self.gain(&p) * off;
            (p, calm) = (self.updated(&p), self.updated(&calm));
            (news, rate - self.rate(&kicked))
        };
        rates.iter().map(step).unzip()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::identify::onset::tests::{CALM, STEP_S, struck};
    use crate::identify::series::Kind;

    /// Root mean square.
    fn size(values: &[f64]) -> f64 {
        (values.iter().map(|value| value * value).sum::<f64>() / values.len() as f64).sqrt()
    }

    #[test]
    fn a_sea_that_does_not_hit_is_left_alone() {
        for seed in 0..20 {
            assert_eq!(without_blows(&series(&struck(CALM, 6000, 0, seed))), None, "{seed}");
        }
        for few in [vec![], vec![1.0; 100], vec![0.0; 6000], vec![f64::NAN; 6000]] {
            assert_eq!(without_blows(&series(&few)), None);
        }
    }

    fn series(rates: &[f64]) -> Series<'_> {
        Series { kind: Kind::Rates, values: rates, step_s: STEP_S }
    }

    /// Size of the mode that fits rates best over the calm sea's.
    fn fitted(rates: &[f64]) -> f64 {
        Noisy::fitted(&series(rates)).map_or(f64::NAN, |model| model.mode.sigma / CALM.mode.sigma)
    }

    /// The same noise with and without blows: little of the power that they add is left.
    #[test]
    fn most_of_the_blows_power_is_taken_out() {
        let mut share = 0.0;
        for seed in 0..20 {
            let (calm, hit) = (struck(CALM, 6000, 0, seed), struck(CALM, 6000, 200, seed));
            let left = without_blows(&series(&hit)).expect("blows");
            let power = |values: &[f64]| (size(values) / size(&calm)).powi(2) - 1.0;
            let (hit, left) = (power(&hit), power(&left));
            assert!(hit > 1.0 && left < hit, "{seed}: {hit} {left}");
            share += left / hit / 20.0;
        }
        assert!(share < 0.4, "{share}");
    }

    #[test]
    fn the_size_is_that_of_the_sea_between_blows() {
        let (mut with, mut without) = (0.0, 0.0);
        for seed in 0..10 {
            let hit = struck(CALM, 6000, 200, seed);
            with += fitted(&hit) / 10.0;
            without += without_blows(&series(&hit)).map_or(f64::NAN, |left| fitted(&left)) / 10.0;
        }
        // what a kick did is known no better than the flexure is
        assert!(with > 1.6 && (0.95..1.3).contains(&without), "{with} {without}");
    }
}
