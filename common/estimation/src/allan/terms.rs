//! The parts that an Allan variance is made of.

use std::f64::consts::{LN_2, PI};

/// A part of the model: its Allan variance is a coefficient times a known function of the averaging time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Term {
    /// Quantisation of the angle, coefficient Q^2.
    Quantisation,
    /// White noise of the rate, coefficient N^2.
    White,
    /// Flicker noise of the rate, coefficient B^2.
    Flicker,
    /// Random walk of the rate, coefficient K^2.
    Walk,
    /// First-order Gauss-Markov process with the correlation time in s, coefficient: its variance.
    Markov(f64),
}

/// Times the correlation time: where the Allan variance of a Gauss-Markov process is highest.
const HIGHEST_AT: f64 = 1.892_6;

impl Term {
    /// The Allan variance at the averaging time `tau` (s) for the coefficient 1.
    pub fn variance(self, tau: f64) -> f64 {
        match self {
            Self::Quantisation => 3.0 / (tau * tau),
            Self::White => 1.0 / tau,
            Self::Flicker => 2.0 * LN_2 / PI,
            Self::Walk => tau / 3.0,
            Self::Markov(correlation) => markov(tau / correlation),
        }
    }

    /// The square of the bias instability that the coefficient 1 amounts to; 0 for a term that is none.
    pub(super) fn instability(self) -> f64 {
        match self {
            Self::Flicker => 1.0,
            Self::Markov(_) => markov(HIGHEST_AT) / Self::Flicker.variance(1.0),
            _ => 0.0,
        }
    }
}

/// Of a process with unit variance, `r` averaging times in correlation times; IEEE Std 952, eq C.20, which for a short time is
/// that of a random walk.
fn markov(r: f64) -> f64 {
    if r < 1e-3 {
        return 2.0 * r / 3.0;
    }
    2.0 / r * (1.0 - (3.0 - 4.0 * (-r).exp() + (-2.0 * r).exp()) / (2.0 * r))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gauss_markov_process_is_highest_where_the_standard_says() {
        let highest = markov(HIGHEST_AT);
        // 0.437 q sqrt(T) with q^2 T / 2 = 1
        assert!((highest.sqrt() / (0.437 * 2f64.sqrt()) - 1.0).abs() < 2e-3, "{highest}");
        for r in [1.8, 1.88, 1.9, 2.0] {
            assert!(markov(r) < highest, "{r}");
        }
        assert!((markov(1.001e-3) / markov(0.999e-3) - 1.0).abs() < 4e-3);
        assert!((markov(1e4) / 2e-4 - 1.0).abs() < 2e-4, "white noise of the spectral density 2 T in the end");
    }
}
