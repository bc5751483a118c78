//! Modified Yule-Walker equations: two coefficients from more lags than needed.
//!
//! Source: the recursion that 003 eq 7 obeys at equally spaced lags, `r(k) + a1 r(k-1) + a2 r(k-2) = 0`, by least squares over
//! k = 3 to K, so that lag 0 with its noise is in none of them. Ordinary Yule-Walker, with lags 0 to 2, was measured to give a
//! damping 30 % too small.

use super::axis::Identified;
use super::lagged::Lagged;
use super::poles::{identified, motion, sized};
use super::series::Series;
use nalgebra::{Complex, Matrix2, Vector2};

/// Between two lags, s.
const SPACING_S: f64 = 0.5;
/// The longest lag, s.
const LONGEST_S: f64 = 10.0;

/// Identifies an axis; `None` if the recursion does not decay.
pub fn identify(series: &Series) -> Option<Identified> {
    let lagged = Lagged::new(series, SPACING_S, LONGEST_S)?;
    identified(series, sized(series, &lagged, motion(factors(&lagged.values)?, lagged.spacing_s)?)?)
}

/// The roots of `z^2 + a1 z + a2`.
pub fn factors(sequence: &[f64]) -> Option<[Complex<f64>; 2]> {
    let (mut normal, mut right) = (Matrix2::zeros(), Vector2::zeros());
    for three in sequence.windows(3) {
        let row = Vector2::new(three[1], three[0]);
        normal += row * row.transpose();
        right -= row * three[2];
    }
    let a = normal.try_inverse()? * right;
    let root = Complex::new(a[0] * a[0] / 4.0 - a[1], 0.0).sqrt();
    let centre = Complex::new(-a[0] / 2.0, 0.0);
    a.iter().all(|value| value.is_finite()).then_some([centre + root, centre - root])
}
