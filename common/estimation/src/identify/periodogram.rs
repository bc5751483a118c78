//! Periodogram of a tapered series, and what the model says of it.

use super::series::{Kind, Series};
use crate::flexure::Flexure;
use realfft::RealFftPlanner;
use std::f64::consts::{PI, TAU};

/// How the ends of a series are faded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Taper {
    /// Raised cosine over the whole length.
    Hann,
    /// Raised cosine over this share of the length, half at each end.
    Tukey(f64),
}

impl Taper {
    /// Weight of the place `u` from 0 to 1.
    fn weight(self, u: f64) -> f64 {
        let share = match self {
            Taper::Hann => 1.0,
            Taper::Tukey(share) => share,
        };
        let end = u.min(1.0 - u) / (share / 2.0);
        if end < 1.0 { 0.5 - 0.5 * (PI * end).cos() } else { 1.0 }
    }
}

/// Power at the frequencies of a band.
#[derive(Clone, Debug, PartialEq)]
pub struct Periodogram {
    /// Angular frequencies, rad/s.
    pub frequencies: Vec<f64>,
    /// Two-sided density of the series, its square times s.
    pub power: Vec<f64>,
    /// How many lines one of them is the mean of.
    pub counts: Vec<f64>,
    /// How many independent values a line is worth: a taper makes neighbours alike.
    pub weight: f64,
}

impl Periodogram {
    /// From `band_hz.0` to `band_hz.1`; `None` if under eight frequencies lie there.
    pub fn new(series: &Series, taper: Taper, band_hz: (f64, f64)) -> Option<Self> {
        let count = series.values.len();
        let weights: Vec<f64> = (0..count).map(|j| taper.weight((j as f64 + 0.5) / count as f64)).collect();
        let squares: f64 = weights.iter().map(|w| w * w).sum();
        let fourths: f64 = weights.iter().map(|w| w.powi(4)).sum();
        let mut tapered: Vec<f64> = series.values.iter().zip(&weights).map(|(y, w)| y * w).collect();
        let plan = RealFftPlanner::new().plan_fft_forward(count);
        let mut lines = plan.make_output_vec();
        plan.process(&mut tapered, &mut lines).ok()?;
        let resolution = 1.0 / series.length_s();
        let within = |k: &usize| (band_hz.0..=band_hz.1).contains(&(*k as f64 * resolution));
        let bins: Vec<usize> = (1..count.div_ceil(2)).filter(within).collect();
        let power: Vec<f64> = bins.iter().map(|&k| lines[k].norm_sqr() * series.step_s / squares).collect();
        let frequencies = bins.iter().map(|&k| TAU * k as f64 * resolution).collect();
        let finite = power.iter().all(|p| p.is_finite());
        (bins.len() >= 8 && finite).then(|| Self {
            counts: vec![1.0; bins.len()],
            frequencies,
            power,
            weight: squares * squares / (count as f64 * fourths),
        })
    }

    /// The same with the means of neighbours where those are closer together than a `share` of their frequency.
    pub fn merged(&self, share: f64) -> Self {
        let mut merged = Self { frequencies: Vec::new(), power: Vec::new(), counts: Vec::new(), weight: self.weight };
        let mut begin = 0;
        for end in 1..=self.frequencies.len() {
            let wide = self.frequencies.get(end).is_none_or(|w| w - self.frequencies[begin] > share * w);
            if wide {
                let count = (end - begin) as f64;
                merged.frequencies.push(self.frequencies[begin..end].iter().sum::<f64>() / count);
                merged.power.push(self.power[begin..end].iter().sum::<f64>() / count);
                merged.counts.push(count);
                begin = end;
            }
        }
        merged
    }
}

/// On each side so many bands of frequencies above the sampling's are folded into the one that is seen.
const FOLDS: i32 = 2;

/// What a series shows of the angle's density at the angular frequency `w`; the mean rate over a step is a difference of angles.
pub fn gain(kind: Kind, step_s: f64, w: f64) -> f64 {
    match kind {
        Kind::Angles => 1.0,
        Kind::Rates => (2.0 * (w * step_s / 2.0).sin() / step_s).powi(2),
    }
}

/// What a mode has at `w` and in each band that is folded into it: `b^2 - f^2`, `4 mu^2 f^2`, and one over the sum of the first's square and the second.
fn folded(model: &Flexure, step_s: f64, w: f64) -> impl Iterator<Item = (f64, f64, f64)> {
    let (b2, mu2, sampling) = (model.b * model.b, model.mu * model.mu, TAU / step_s);
    (-FOLDS..=FOLDS).map(move |fold| {
        let f = w + sampling * f64::from(fold);
        let away = b2 - f * f;
        let damped = 4.0 * mu2 * f * f;
        (away, damped, 1.0 / (away * away + damped))
    })
}

/// Density of a sampled series without noise at the angular frequency `w` with its [`gain`].
pub fn density(model: &Flexure, gain: f64, step_s: f64, w: f64) -> f64 {
    gain * model.density() * folded(model, step_s, w).map(|(_, _, inverse)| inverse).sum::<f64>()
}

/// Derivatives of [`density`] in `ln mu`, `ln b`, `ln Q`; the last is the density itself.
pub fn slopes(model: &Flexure, gain: f64, step_s: f64, w: f64) -> [f64; 3] {
    let b2 = model.b * model.b;
    let [by_mu, by_b, sum] = folded(model, step_s, w).fold([0.0; 3], |[by_mu, by_b, sum], (away, damped, inverse)| {
        let squared = inverse * inverse;
        [by_mu - 2.0 * damped * squared, by_b - 4.0 * b2 * away * squared, sum + inverse]
    });
    let size = gain * model.density();
    [size * by_mu, size * by_b, size * sum]
}
