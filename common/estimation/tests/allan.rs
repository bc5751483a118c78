//! What the Allan deviation shows of made noise, and that its numbers are those of another program.
#![allow(clippy::unwrap_used)]

use estimation::allan::{Coefficients, Estimate, Term, analyse};
use rand::{RngExt, SeedableRng};
use rand_distr::StandardNormal;
use rand_pcg::Pcg64Mcg;
use std::f64::consts::PI;

/// Six hours at 10 Hz: a sixtieth of a real recording's samples, of the same length.
const INTERVAL: f64 = 0.1;
const SAMPLES: usize = 216_000;

/// Made noise of a rate.
struct Noise(Pcg64Mcg);

impl Noise {
    fn new(seed: u64) -> Self {
        Self(Pcg64Mcg::seed_from_u64(seed))
    }

    fn normal(&mut self) -> f64 {
        self.0.sample(StandardNormal)
    }

    /// `n` is the random walk of the integral.
    fn white(&mut self, samples: usize, n: f64) -> Vec<f64> {
        (0..samples).map(|_| n / INTERVAL.sqrt() * self.normal()).collect()
    }

    /// A first-order Gauss-Markov process.
    fn markov(&mut self, samples: usize, sigma: f64, correlation: f64) -> Vec<f64> {
        let kept = (-INTERVAL / correlation).exp();
        let fresh = sigma * (1.0 - kept * kept).sqrt();
        let mut now = sigma * self.normal();
        let step = |_| {
            now = kept * now + fresh * self.normal();
            now
        };
        (0..samples).map(step).collect()
    }

    /// A spectral density `B^2 / (2 pi f)`, made of Gauss-Markov processes with equal variances at equal distances of their times'
    /// logarithms: `v` an e-fold gives `v / f`, one-sided, and `B^2 / pi` is the one-sided one of `B`.
    fn flicker(&mut self, samples: usize, b: f64) -> Vec<f64> {
        let ratio = 3.0f64;
        let sigma = b * (ratio.ln() / PI).sqrt();
        let mut sum = vec![0.0; samples];
        let mut correlation = 0.03 * INTERVAL;
        while correlation < 30.0 * samples as f64 * INTERVAL {
            sum.iter_mut().zip(self.markov(samples, sigma, correlation)).for_each(|(sum, one)| *sum += one);
            correlation *= ratio;
        }
        sum
    }

    fn walk(&mut self, samples: usize, k: f64) -> Vec<f64> {
        let mut now = 0.0;
        let step = |_| {
            now += k * INTERVAL.sqrt() * self.normal();
            now
        };
        (0..samples).map(step).collect()
    }
}

fn plus(mut a: Vec<f64>, b: Vec<f64>) -> Vec<f64> {
    a.iter_mut().zip(b).for_each(|(a, b)| *a += b);
    a
}

fn coefficients(rates: &[f64]) -> Coefficients {
    analyse(&[rates], INTERVAL).unwrap().coefficients
}

fn within(estimate: Option<Estimate>, truth: f64, factor: f64) -> bool {
    estimate.is_some_and(|estimate| (estimate.value / truth).ln().abs() < f64::ln(factor))
}

/// Root mean square of the errors in their own standard deviations.
fn in_sigmas(estimates: &[(Estimate, f64)]) -> f64 {
    let squares = estimates.iter().map(|(estimate, truth)| ((estimate.value - truth) / estimate.sigma).powi(2));
    (squares.sum::<f64>() / estimates.len() as f64).sqrt()
}

/// White and flicker noise in the ratio of a fibre-optic gyro of 0.012 deg/sqrt(h) and 0.07 deg/h.
#[test]
fn white_and_flicker_noise_of_six_hours_are_found_and_the_error_bars_are_honest() {
    let (n, b) = (1.0, 0.1);
    let (mut whites, mut flickers) = (Vec::new(), Vec::new());
    for seed in 1..=16 {
        let mut noise = Noise::new(seed);
        let rates = plus(noise.white(SAMPLES, n), noise.flicker(SAMPLES, b));
        let found = coefficients(&rates);
        assert!(within(found.white, n, 1.05) && within(found.instability, b, 1.5), "{seed}: {found:?}");
        assert!(
            found.walk.is_none() && found.quantisation.is_none() && found.most_instability > b,
            "{seed}: {found:?}"
        );
        whites.push((found.white.unwrap(), n));
        flickers.push((found.instability.unwrap(), b));
    }
    // of white noise the model's own error of 2 % is most of the bar
    assert!(in_sigmas(&whites) < 1.0, "{}", in_sigmas(&whites));
    assert!((0.6..1.5).contains(&in_sigmas(&flickers)), "{}", in_sigmas(&flickers));
}

/// The simulator's own kind of wandering bias.
#[test]
fn a_gauss_markov_bias_of_six_hours_is_found_with_its_correlation_time() {
    let (n, sigma, correlation) = (1.0, 0.2, 600.0);
    let instability = sigma * (Term::Markov(1.0).variance(1.8926) / Term::Flicker.variance(1.0)).sqrt();
    assert!((instability / sigma - 0.93).abs() < 0.005);
    let mut correlations = Vec::new();
    for seed in 1..=16 {
        let mut noise = Noise::new(seed);
        let rates = plus(noise.white(SAMPLES, n), noise.markov(SAMPLES, sigma, correlation));
        let found = coefficients(&rates);
        assert!(within(found.white, n, 1.05) && within(found.instability, instability, 1.5), "{seed}: {found:?}");
        correlations.extend(found.correlation.map(|correlation| correlation.value));
    }
    // it is not always told from flicker noise
    assert!(correlations.len() >= 8, "{correlations:?}");
    correlations.sort_unstable_by(f64::total_cmp);
    let median = correlations[correlations.len() / 2];
    assert!((median / correlation).ln().abs() < f64::ln(1.5), "{correlations:?}");
}

#[test]
fn a_random_walk_is_found_and_told_from_flicker_noise() {
    let k = 0.004;
    let mut walks = Vec::new();
    for seed in 1..=12 {
        let mut noise = Noise::new(seed);
        let found = coefficients(&plus(noise.white(SAMPLES, 1.0), noise.walk(SAMPLES, k)));
        assert!(within(found.white, 1.0, 1.05) && within(found.walk, k, 1.8), "{seed}: {found:?}");
        walks.push((found.walk.unwrap(), k));
    }
    assert!((0.6..1.5).contains(&in_sigmas(&walks)), "{}", in_sigmas(&walks));
}

#[test]
fn where_there_is_white_noise_only_a_bound_is_told() {
    let mut wrong = 0;
    for seed in 1..=20 {
        let found = coefficients(&Noise::new(seed).white(SAMPLES, 1.0));
        assert!(within(found.white, 1.0, 1.05), "{seed}: {found:?}");
        wrong += usize::from(found.instability.is_some() || found.walk.is_some() || found.quantisation.is_some());
        // white noise averaged over a third of the recording and divided by .664 is 0.018
        assert!((0.02..0.12).contains(&found.most_instability), "{seed}: {found:?}");
    }
    assert!(wrong <= 2, "something that is not there is seen in {wrong} of 20");
}

#[test]
fn quantisation_is_found() {
    let step = 0.2;
    let mut angle = 0.0;
    let mut noise = Noise::new(1);
    let mut before = 0.0;
    let quantised = |rate: f64| {
        angle += rate * INTERVAL;
        let now = (angle / step).round() * step;
        (now - std::mem::replace(&mut before, now)) / INTERVAL
    };
    let rates: Vec<f64> = noise.white(SAMPLES / 4, 0.3).into_iter().map(quantised).collect();
    let found = coefficients(&rates);
    assert!(within(found.white, 0.3, 1.05) && within(found.quantisation, step / 12f64.sqrt(), 1.1), "{found:?}");
}

/// White noise at times well above the filter's.
#[test]
fn a_units_low_pass_filter_does_not_hide_its_white_noise() {
    let mut now = 0.0;
    let white = Noise::new(1).white(SAMPLES / 4, 1.0);
    let smoothed: Vec<f64> = white
        .into_iter()
        .map(|rate| {
            now += 0.6 * (rate - now);
            now
        })
        .collect();
    // the same numbers as of a unit of 100 Hz
    let found = analyse(&[&smoothed], 0.1 * INTERVAL).unwrap().coefficients;
    assert!(within(found.white, 0.1f64.sqrt(), 1.05), "{found:?}");
}

#[test]
fn holes_and_too_little_data_are_met() {
    let white = Noise::new(1).white(20_000, 1.0);
    let parts: Vec<&[f64]> = white.chunks(4000).collect();
    let found = analyse(&parts, INTERVAL).unwrap();
    assert!(within(found.coefficients.white, 1.0, 1.05), "{found:?}");
    assert!(found.points.last().unwrap().tau <= 4000.0 / 3.0 * INTERVAL);
    for rates in [vec![], vec![1.0; 1000], vec![0.0, 1.0], vec![f64::NAN; 1000]] {
        assert!(analyse(&[&rates], INTERVAL).is_none());
    }
}

/// allantools 2024.6: `oadev(series, rate = 100, data_type = "freq", taus = [0.01, 0.02, ...])`.
#[test]
fn deviations_are_those_of_allantools() {
    let expected = [
        0.29104628332595883,
        0.2067976150417655,
        0.144336257862636,
        0.10237757193294521,
        0.07174573839898993,
        0.05710667463575839,
        0.0470327568093585,
        0.045436178404549415,
        0.048223663378575574,
        0.06974338133266753,
        0.10155992447249726,
    ];
    let (mut number, mut slow) = (12345u64, 0.0);
    let series: Vec<f64> = (0..4096)
        .map(|_| {
            number = number * 16807 % 2_147_483_647;
            let quick = number as f64 / 2_147_483_647.0 - 0.5;
            slow += 0.02 * quick;
            quick + slow
        })
        .collect();
    assert!((series.iter().sum::<f64>() / 408.68956460507087 - 1.0).abs() < 1e-12, "it is not the same series");
    let analysis = analyse(&[&series], 0.01).unwrap();
    assert_eq!(analysis.points.len(), expected.len());
    for (k, (point, expected)) in analysis.points.iter().zip(expected).enumerate() {
        assert_eq!(point.tau, 0.01 * f64::from(1 << k));
        assert!((point.deviation / expected - 1.0).abs() < 1e-11, "{point:?} instead of {expected}");
        assert!(point.lower < point.deviation && point.deviation < point.upper, "{point:?}");
    }
}
