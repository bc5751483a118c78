//! The data of one axis: angles or rates at equal distances, and how they are prepared.
//!
//! Paper 003 removes slow parts of the angle by a high-pass filter (eq 22) of which it says only that it works in the frequency
//! domain. A cut at 0.05 Hz after the removal of a line reproduces its table; the line alone leaves less bias in the frequency.

use super::autocovariance::detrend;
use super::expectation::rate_autocovariance;
use crate::flexure::Flexure;
use realfft::RealFftPlanner;

/// What the numbers of a series are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// The angle of the flexure, rad (paper 003).
    Angles,
    /// Its mean rate from one instant to the next, rad/s (paper 000).
    Rates,
}

impl Kind {
    /// Autocovariance of a series of the model at the lags 0 to `count` - 1 steps, rad^2 or rad^2/s^2.
    pub fn autocovariance(self, model: &Flexure, count: usize, step_s: f64) -> Vec<f64> {
        match self {
            Kind::Angles => (0..count).map(|k| model.autocovariance(k as f64 * step_s)).collect(),
            Kind::Rates => rate_autocovariance(model, count, step_s),
        }
    }
}

/// The data of one axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Series<'a> {
    /// Angles or rates.
    pub kind: Kind,
    /// The numbers, rad or rad/s, without mean.
    pub values: &'a [f64],
    /// Their distance, s.
    pub step_s: f64,
}

/// Fewer numbers than this identify nothing.
const FEWEST: usize = 16;

impl Series<'_> {
    /// Length of the data, s.
    pub fn length_s(&self) -> f64 {
        self.values.len() as f64 * self.step_s
    }

    /// Whether the data can say anything: enough of them, finite, and not constant.
    pub fn is_usable(&self) -> bool {
        let power = self.values.iter().map(|v| v * v).sum::<f64>();
        let varied = self.values.iter().any(|v| *v != self.values[0]);
        self.values.len() >= FEWEST && self.step_s > 0.0 && self.step_s.is_finite() && power.is_normal() && varied
    }
}

/// What is taken out of a series before it is identified.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Preparation {
    /// Mean and linear trend.
    Line,
    /// These, and then every frequency below this one, Hz (003 eq 22).
    HighPass(f64),
}

/// The prepared series.
pub fn prepared(values: &[f64], step_s: f64, preparation: Preparation) -> Vec<f64> {
    let mut values = values.to_vec();
    detrend(&mut values);
    match preparation {
        Preparation::Line => values,
        Preparation::HighPass(hz) => high_pass(values, step_s, hz),
    }
}

// 003 eq 22
fn high_pass(mut values: Vec<f64>, step_s: f64, hz: f64) -> Vec<f64> {
    let length = values.len();
    if length == 0 {
        return values;
    }
    let mut planner = RealFftPlanner::new();
    let (forward, inverse) = (planner.plan_fft_forward(length), planner.plan_fft_inverse(length));
    let mut spectrum = forward.make_output_vec();
    // The buffers are of the plans' own lengths, the only thing that can be wrong.
    if forward.process(&mut values, &mut spectrum).is_err() {
        return values;
    }
    let resolution = 1.0 / (length as f64 * step_s);
    spectrum.iter_mut().enumerate().filter(|(k, _)| (*k as f64) * resolution < hz).for_each(|(_, line)| *line *= 0.0);
    if inverse.process(&mut spectrum, &mut values).is_ok() {
        values.iter_mut().for_each(|value| *value /= length as f64);
    }
    values
}
