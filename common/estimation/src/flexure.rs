//! Second-order Gauss-Markov flexure of one axis.
//!
//! Source: paper 000 eq 3 and paper 001 eq 28, with the driving density that follows from the stationary variance:
//! `x'' + 2 mu x' + b^2 x = w`, density of w `Q = 4 mu b^2 sigma^2`, for any damping (`mu < b` oscillates, `mu = b` is critical).

use nalgebra::{Matrix2, SMatrix, Vector2};
use serde::{Deserialize, Serialize};

/// The model of one axis.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Flexure {
    /// Damping, 1/s.
    pub mu: f64,
    /// Natural frequency, rad/s.
    pub b: f64,
    /// Standard deviation, rad.
    pub sigma: f64,
}

impl Flexure {
    /// Whether the numbers describe a flexure at all: positive and finite, slower than any sampling, smaller than a radian.
    pub fn is_sound(&self) -> bool {
        let within = |v: f64, least: f64, most: f64| v >= least && v <= most;
        within(self.mu, 1e-6, 1e3) && within(self.b, 1e-6, 1e3) && within(self.sigma, 1e-12, 1.0)
    }

    /// The same with a standard deviation of at least `least` and at most `most`; a smaller one keeps the density, so that the rate is
    /// as lively as before.
    pub fn bounded(self, least: f64, most: f64) -> Self {
        if self.sigma <= most {
            return Self { sigma: self.sigma.max(least), ..self };
        }
        let b = (self.density() / (4.0 * most * most)).cbrt();
        Self { mu: b, b, sigma: most }
    }

    /// One that is `factor` times as large with the same driving noise: critically damped and slower.
    pub fn widened(self, factor: f64) -> Self {
        let sigma = self.sigma * factor;
        let b = (self.density() / (4.0 * sigma * sigma)).cbrt();
        Self { mu: b, b, sigma }
    }

    /// Density of the driving noise, rad^2/s^3.
    pub fn density(&self) -> f64 {
        4.0 * self.mu * self.b * self.b * self.sigma * self.sigma
    }

    /// Stationary covariance of angle and rate.
    pub fn stationary(&self) -> Matrix2<f64> {
        let variance = self.sigma * self.sigma;
        Matrix2::from_diagonal(&Vector2::new(variance, self.b * self.b * variance))
    }

    /// `exp(-mu t)` times the cosine- and sine-like solutions `(c, s)` after the time `t`, where `s = sin(l t) / l`.
    fn modes(&self, t: f64) -> (f64, f64) {
        let k = self.b * self.b - self.mu * self.mu;
        let square = k * t * t;
        let decay = (-self.mu * t).exp();
        if square.abs() < 1e-6 {
            let c = 1.0 - square / 2.0 + square * square / 24.0;
            (decay * c, decay * t * (1.0 - square / 6.0 + square * square / 120.0))
        } else if k > 0.0 {
            let l = k.sqrt();
            (decay * (l * t).cos(), decay * (l * t).sin() / l)
        } else if (-square) < 300.0 * 300.0 {
            let l = (-k).sqrt();
            (decay * (l * t).cosh(), decay * (l * t).sinh() / l)
        } else {
            // the hyperbolic functions would overflow; the faster of their two exponentials is nothing by then
            let l = (-k).sqrt();
            let slow = 0.5 * ((l - self.mu) * t).exp();
            (slow, slow / l)
        }
    }

    /// Exact transition of `[angle, rate]` over the time `t`.
    pub fn transition(&self, t: f64) -> Matrix2<f64> {
        let (c, s) = self.modes(t);
        let (mu, b2) = (self.mu, self.b * self.b);
        Matrix2::new(c + mu * s, s, -b2 * s, c - mu * s)
    }

    /// Exact covariance of what the driving noise adds over the time `t`: `P - F P F^T`.
    pub fn noise(&self, t: f64) -> Matrix2<f64> {
        let p = self.stationary();
        let f = self.transition(t);
        p - f * p * f.transpose()
    }

    /// Writes transition and noise over the time `t` into those of a larger state with the angle at `x` and the rate at `v`.
    pub fn place<const N: usize>(
        &self,
        t: f64,
        x: usize,
        v: usize,
        transition: &mut SMatrix<f64, N, N>,
        noise: &mut SMatrix<f64, N, N>,
    ) {
        let (f, n) = (self.transition(t), self.noise(t));
        for (i, row) in [x, v].into_iter().enumerate() {
            for (j, column) in [x, v].into_iter().enumerate() {
                transition[(row, column)] = f[(i, j)];
                noise[(row, column)] = n[(i, j)];
            }
        }
    }

    /// Writes the stationary covariance into that of a larger state with the angle at `x` and the rate at `v`.
    pub fn place_stationary<const N: usize>(&self, x: usize, v: usize, p: &mut SMatrix<f64, N, N>) {
        let stationary = self.stationary();
        p[(x, x)] = stationary[(0, 0)];
        p[(v, v)] = stationary[(1, 1)];
    }

    /// Autocovariance at the lag `tau >= 0`: paper 000 eq 17 with the factor the right way up, `R(0) = sigma^2`.
    pub fn autocovariance(&self, tau: f64) -> f64 {
        let (c, s) = self.modes(tau);
        self.sigma * self.sigma * (c + self.mu * s)
    }

    /// Two-sided spectral density at the angular frequency `w`, rad^2 s.
    pub fn spectrum(&self, w: f64) -> f64 {
        let d = self.b * self.b - w * w;
        self.density() / (d * d + 4.0 * self.mu * self.mu * w * w)
    }
}

/// The flexure of a hull about the axes of m: a mode each, and beside it a second where the hull has one. The flexure is their sum.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Hull {
    /// The mode about each axis, the slower one where there are two.
    pub modes: [Flexure; 3],
    /// The second mode.
    pub second: [Option<Flexure>; 3],
}

impl From<[Flexure; 3]> for Hull {
    fn from(modes: [Flexure; 3]) -> Self {
        Self { modes, second: [None; 3] }
    }
}

impl Hull {
    /// All modes.
    pub fn all(&self) -> impl Iterator<Item = &Flexure> {
        self.modes.iter().chain(self.second.iter().flatten())
    }

    /// The same with standard deviations as [`Flexure::bounded`] keeps them; a second mode may be as small as it likes.
    pub fn bounded(self, least: f64, most: f64) -> Self {
        let second = |mode: Flexure| mode.bounded(0.0, most);
        Self {
            modes: self.modes.map(|mode| mode.bounded(least, most)),
            second: self.second.map(|mode| mode.map(second)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CASES: [Flexure; 4] = [
        Flexure { mu: 0.2146, b: 0.2146, sigma: 1.7e-3 },
        Flexure { mu: 0.1, b: 0.6, sigma: 1e-3 },
        Flexure { mu: 0.8, b: 0.3, sigma: 2e-3 },
        Flexure { mu: 0.15, b: 1.2566, sigma: 1e-5 },
    ];

    #[test]
    fn transition_solves_the_differential_equation() {
        for m in CASES {
            let a = Matrix2::new(0.0, 1.0, -m.b * m.b, -2.0 * m.mu);
            for t in [1e-3, 0.01, 0.1, 1.0, 20.0] {
                assert!((m.transition(t) - (a * t).exp()).norm() < 1e-12 * (1.0 + m.transition(t).norm()), "{m:?} {t}");
            }
        }
    }

    #[test]
    fn a_wider_flexure_is_driven_as_before() {
        for m in CASES {
            let wide = m.widened(4.0);
            assert!(
                (wide.density() / m.density() - 1.0).abs() < 1e-12 && wide.sigma == 4.0 * m.sigma && wide.mu == wide.b
            );
        }
    }

    #[test]
    fn a_long_time_forgets_everything() {
        for m in CASES.into_iter().chain([Flexure { mu: 90.0, b: 3.0, sigma: 1e-3 }]) {
            assert!(m.transition(1e5).amax() < 1e-12 && (m.noise(1e5) - m.stationary()).amax() < 1e-20, "{m:?}");
        }
    }

    #[test]
    fn stationary_covariance_solves_lyapunov() {
        for m in CASES {
            let a = Matrix2::new(0.0, 1.0, -m.b * m.b, -2.0 * m.mu);
            let q = Matrix2::new(0.0, 0.0, 0.0, m.density());
            let p = m.stationary();
            assert!((a * p + p * a.transpose() + q).norm() < 1e-14 * q.norm().max(p.norm()));
        }
    }

    #[test]
    fn noise_is_the_integral_of_the_driving_noise() {
        for m in CASES {
            let (t, n) = (0.1, 2000);
            let mut sum = Matrix2::zeros();
            for i in 0..n {
                let f = m.transition((i as f64 + 0.5) * t / n as f64);
                let g = f.column(1) * f.column(1).transpose();
                sum += g * (m.density() * t / n as f64);
            }
            assert!((m.noise(t) - sum).norm() < 1e-6 * sum.norm(), "{m:?}");
        }
    }

    #[test]
    fn autocovariance_is_the_transform_of_the_spectrum() {
        for m in CASES {
            for tau in [0.0, 0.5, 3.0, 12.0] {
                let (n, top) = (400_000, 200.0);
                let h = top / n as f64;
                let sum: f64 = (0..n).map(|i| (i as f64 + 0.5) * h).map(|w| m.spectrum(w) * (w * tau).cos()).sum();
                let integral = sum * h / std::f64::consts::PI;
                assert!((integral - m.autocovariance(tau)).abs() < 1e-5 * m.sigma * m.sigma, "{m:?} {tau}");
            }
        }
    }
}
