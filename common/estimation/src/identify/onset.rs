//! When a flexure became another one: each model's exact likelihood of every rate, added up before and after (E. S. Page, 1954).
//!
//! A mode is driven by noise all the time, so that every rate says something of its density: where that becomes half or twice as large a few seconds show when.

use super::innovation::{Kalman, Noisy};
use nalgebra::Vector3;
use std::f64::consts::TAU;

/// Minus the logarithm of the density of each rate (rad/s, mean over the `step_s` before it), given those before.
fn surprises(model: &Noisy, rates: &[f64], step_s: f64) -> Vec<f64> {
    let kalman = Kalman::new(model, step_s);
    let (mut state, mut p) = (Vector3::zeros(), kalman.start);
    let surprise = |rate: &f64| {
        state = kalman.transition * state;
        p = kalman.carried(&p);
        let (off, variance) = (rate - kalman.rate(&state), kalman.variance(&p));
        state += kalman.gain(&p) * off;
        p = kalman.updated(&p);
        0.5 * ((TAU * variance).ln() + off * off / variance)
    };
    rates.iter().map(surprise).collect()
}

/// The place from which on a second model explains the rates about each axis, at least `least` before their end. Each axis: rates, the model of the beginning,
/// the one of the end.
pub fn onset(axes: &[(&[f64], Noisy, Noisy); 3], step_s: f64, least: usize) -> usize {
    let count = axes[0].0.len();
    let mut gains = vec![0.0; count];
    for (rates, before, after) in axes {
        let [before, after] = [before, after].map(|model| surprises(model, rates, step_s));
        gains.iter_mut().zip(before.iter().zip(&after)).for_each(|(gain, (before, after))| *gain += before - after);
    }
    let (mut sum, mut best) = (0.0, (f64::NEG_INFINITY, 0));
    for place in (0..count).rev() {
        sum += gains[place];
        if count - place >= least && sum > best.0 {
            best = (sum, place);
        }
    }
    best.1
}

#[cfg(test)]
pub mod tests {
    use super::*;
    use crate::flexure::Flexure;
    use nalgebra::Vector2;
    use rand::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};
    use rand_pcg::Pcg64;

    pub const STEP_S: f64 = 0.1;

    /// A flexure that is driven step by step.
    struct Driven {
        state: Vector2<f64>,
        rng: Pcg64,
    }

    impl Driven {
        fn new(seed: u64) -> Self {
            Self { state: Vector2::zeros(), rng: Pcg64::seed_from_u64(seed) }
        }

        fn normal(&mut self) -> f64 {
            StandardNormal.sample(&mut self.rng)
        }

        /// The next rate, the flexure being driven so many times as strongly as usual.
        fn rate(&mut self, Noisy { mode, noise }: &Noisy, strength: f64) -> f64 {
            let root = mode.noise(STEP_S).cholesky().expect("positive").l();
            let drive = root * Vector2::new(self.normal(), self.normal());
            let next = mode.transition(STEP_S) * self.state + drive * strength;
            let rate = (next[0] - self.state[0]) / STEP_S + self.normal() * noise.sqrt();
            self.state = next;
            rate
        }
    }

    /// Rates of a flexure that is hit after every so many steps, if that is not 0.
    pub fn struck(model: Noisy, count: usize, every: usize, seed: u64) -> Vec<f64> {
        let mut driven = Driven::new(seed);
        let strength = |k: usize| if every > 0 && k % every == every - 1 { 20.0 } else { 1.0 };
        (0..count).map(|k| driven.rate(&model, strength(k))).collect()
    }

    /// Rates of parts of so many steps, one after the other.
    fn rates(parts: &[(Noisy, usize)], seed: u64) -> Vec<f64> {
        let mut driven = Driven::new(seed);
        parts
            .iter()
            .flat_map(|(model, count)| std::iter::repeat_n(model, *count))
            .map(|model| driven.rate(model, 1.0))
            .collect()
    }

    pub const CALM: Noisy = Noisy { mode: Flexure { mu: 0.13, b: 1.2, sigma: 2e-3 }, noise: 1e-8 };
    const LIVELY: Noisy = Noisy { mode: Flexure { mu: 0.2, b: 0.9, sigma: 3e-3 }, noise: 1e-8 };

    #[test]
    fn the_squares_of_what_the_right_model_did_not_expect_are_what_it_says() {
        let rates = rates(&[(CALM, 20_000)], 1);
        let mean = |model: Noisy| surprises(&model, &rates, STEP_S)[100..].iter().sum::<f64>() / 19_900.0;
        for other in [
            LIVELY,
            Noisy { noise: 2e-8, ..CALM },
            Noisy { mode: Flexure { sigma: 2.2e-3, ..CALM.mode }, ..CALM },
            Noisy { mode: Flexure { sigma: 1.8e-3, ..CALM.mode }, ..CALM },
        ] {
            assert!(mean(CALM) < mean(other), "{other:?}");
        }
    }

    #[test]
    fn a_change_is_placed_to_seconds() {
        for seed in 0..20 {
            for (before, after) in [(CALM, LIVELY), (LIVELY, CALM)] {
                let rates = [0, 1, 2].map(|axis| rates(&[(before, 1500), (after, 400)], 3 * seed + axis));
                let axes = rates.each_ref().map(|rates| (rates.as_slice(), before, after));
                let place = onset(&axes, STEP_S, 100);
                assert!(place.abs_diff(1500) < 50, "{seed}: {place}");
            }
        }
    }
}
