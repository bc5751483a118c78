//! The random swing as a linear system that white noise drives, stepped exactly from knot to knot: 003 eq 30.
//!
//! | state | what |
//! |---|---|
//! | 0, 1 | angle and rate of the second-order Gauss-Markov process |
//! | 2 to 5 | angle and rate after each of the two sections of the Butterworth low-pass; zero without a band limit |
//! | 6 | the output behind a low-pass of first order with the corner b: `s90 = 2 x6 - s` is late by a quarter of a period at b |

use crate::RandomSwing;
use crate::knots::{Knot, SPACING};
use crate::random::Source;
use nalgebra::{SMatrix, SVector};
use std::f64::consts::{PI, TAU};

type Square = SMatrix<f64, 7, 7>;

/// The process at its latest knot.
pub(crate) struct Process {
    transition: Square,
    noise: Square,
    state: SVector<f64, 7>,
    /// The states that are the angle and its rate.
    output: [usize; 2],
    swing: RandomSwing,
    rms: f64,
    source: Source,
}

impl Process {
    pub(crate) fn stationary(swing: &RandomSwing, mut source: Source) -> Self {
        let output = if swing.band_limit_hz.is_some() { [4, 5] } else { [0, 1] };
        let (transition, covariance) = discretised(&system(swing, output[0]), density(swing));
        let stationary = sum_of_all(&transition, &covariance);
        let state = root(&stationary) * SVector::from_fn(|_, _| source.normal());
        let rms = stationary[(output[0], output[0])].max(0.0).sqrt();
        Self { transition, noise: root(&covariance), state, output, swing: *swing, rms, source }
    }

    /// Standard deviation of the angle, rad.
    pub(crate) fn rms(&self) -> f64 {
        self.rms
    }

    /// The model.
    pub(crate) fn swing(&self) -> &RandomSwing {
        &self.swing
    }

    /// The next knot; the first one is the stationary state.
    pub(crate) fn knot(&mut self) -> Knot {
        let [angle, rate] = self.output.map(|i| self.state[i]);
        let lag = self.state[6];
        let normals = SVector::from_fn(|_, _| self.source.normal());
        self.state = self.transition * self.state + self.noise * normals;
        [[angle, rate], [2.0 * lag - angle, 2.0 * self.swing.b * (angle - lag) - rate]]
    }
}

/// Density of the angle (rad^2 s) at a frequency w of either sign: its integral over `dw / 2 pi` is the variance.
pub(crate) fn spectrum(swing: &RandomSwing, w: f64) -> f64 {
    let limit = swing.band_limit_hz.map_or(1.0, |hz| 1.0 / (1.0 + (w / (TAU * hz)).powi(8)));
    let (b2, w2) = (swing.b * swing.b, w * w);
    density(swing) * limit / ((b2 - w2).powi(2) + 4.0 * swing.mu * swing.mu * w2)
}

fn density(swing: &RandomSwing) -> f64 {
    4.0 * swing.mu * (swing.b * swing.sigma).powi(2)
}

/// `x' = A x + (0 1 0 0 0 0 0)^T w`.
fn system(swing: &RandomSwing, output: usize) -> Square {
    let mut a = Square::zeros();
    a[(0, 1)] = 1.0;
    a[(1, 0)] = -swing.b * swing.b;
    a[(1, 1)] = -2.0 * swing.mu;
    if let Some(corner) = swing.band_limit_hz.map(|hz| TAU * hz) {
        // the poles of order 4 lie at 22.5 and 67.5 degrees from the real axis
        for (row, angle) in [(2, PI / 8.0), (4, 3.0 * PI / 8.0)] {
            a[(row, row + 1)] = 1.0;
            a[(row + 1, row)] = -corner * corner;
            a[(row + 1, row + 1)] = -2.0 * angle.cos() * corner;
            a[(row + 1, row - 2)] = corner * corner;
        }
    }
    a[(6, output)] = swing.b;
    a[(6, 6)] = -swing.b;
    a
}

/// Transition and noise covariance from knot to knot, after Van Loan.
fn discretised(a: &Square, density: f64) -> (Square, Square) {
    let mut both = SMatrix::<f64, 14, 14>::zeros();
    both.fixed_view_mut::<7, 7>(0, 0).copy_from(&(-a * SPACING));
    both.fixed_view_mut::<7, 7>(7, 7).copy_from(&(a.transpose() * SPACING));
    both[(1, 8)] = density * SPACING;
    let exponential = both.exp();
    let transition = exponential.fixed_view::<7, 7>(7, 7).transpose();
    let covariance = transition * exponential.fixed_view::<7, 7>(0, 7);
    (transition, (covariance + covariance.transpose()) * 0.5)
}

/// `Q + F Q F^T + F^2 Q F^2^T + ...`, twice as many terms each time.
fn sum_of_all(transition: &Square, covariance: &Square) -> Square {
    let (mut power, mut sum) = (*transition, *covariance);
    for _ in 0..60 {
        sum += power * sum * power.transpose();
        power *= power;
    }
    sum
}

/// L with `L L^T = P`; what rounding makes negative is zero.
fn root(p: &Square) -> Square {
    // the states differ by many orders of magnitude
    let scale = SVector::<f64, 7>::from_fn(|i, _| p[(i, i)].max(0.0).sqrt());
    let ratio = |i: usize, j: usize| if scale[i] * scale[j] > 0.0 { p[(i, j)] / (scale[i] * scale[j]) } else { 0.0 };
    let eigen = Square::from_fn(ratio).symmetric_eigen();
    let lengths = eigen.eigenvalues.map(|l| l.max(0.0).sqrt());
    Square::from_diagonal(&scale) * eigen.eigenvectors * Square::from_diagonal(&lengths)
}
