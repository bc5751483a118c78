//! From the poles of an autocovariance to the flexure model.
//!
//! Source: paper 003 eq 7 and 24: from the first lag on the autocovariance of angle and rate is
//! `exp(-alpha t) (c1 cos beta t + c2 sin beta t)` with the same `alpha = mu` and `beta^2 = b^2 - mu^2`. Of an angle `c1` is the variance;
//! of a rate the variance follows from the size of the tied model, as 000 eq 24 says in other words.
//! Two real poles are an over-damped flexure, one a critical one.

use super::axis::Identified;
use super::bound::{Band, Bound};
use super::lagged::Lagged;
use super::refinement::{DAMPING, FREQUENCY};
use super::series::{Kind, Series};
use super::tied::Tied;
use crate::flexure::Flexure;
use nalgebra::{Complex, DMatrix, DVector, Matrix3};

/// The errors of `ln mu`, `ln b`, `ln Q` of methods that fit lags without weights over their bounds, as measured on windows of 300 s:
/// of angles, and of rates, where the noise of a lag hides the density most.
const LOSS_OF_ANGLES: [f64; 3] = [1.6, 1.8, 5.0];
const LOSS_OF_RATES: [f64; 3] = [2.5, 2.5, 10.0];
/// An imaginary part under this share of the modulus counts as none.
const REAL: f64 = 1e-9;

/// Damping and natural frequency from the factors `z` by which modes are multiplied from one lag to the next: the oscillation that
/// decays fastest, for a filter's other zeros decay backwards or hardly; without one the two slowest real modes. `None` if none decays.
pub fn motion(factors: impl IntoIterator<Item = Complex<f64>>, spacing_s: f64) -> Option<(f64, f64)> {
    let decays = |z: &Complex<f64>| z.norm() > 0.0 && z.norm() < 1.0;
    let mut decaying: Vec<Complex<f64>> = factors.into_iter().filter(decays).collect();
    decaying.sort_by(|a, b| a.norm().total_cmp(&b.norm()));
    let oscillates = |z: &&Complex<f64>| z.im > REAL * z.norm();
    if let Some(z) = decaying.iter().find(oscillates) {
        let (alpha, beta) = (-z.norm().ln() / spacing_s, z.arg() / spacing_s);
        return Some((alpha, alpha.hypot(beta)));
    }
    let mut real = decaying.iter().rev().filter(|z| z.re > 0.0).map(|z| -z.re.ln() / spacing_s);
    let first = real.next()?;
    let second = real.next().unwrap_or(first);
    Some(((first + second) / 2.0, (first * second).sqrt()))
}

/// The model of given damping and natural frequency, brought into the range of the models, with the size that the lags say.
pub fn sized(series: &Series, lagged: &Lagged, (mu, b): (f64, f64)) -> Option<Flexure> {
    let (mu, b) = (mu.clamp(DAMPING.0, DAMPING.1), b.clamp(FREQUENCY.0, FREQUENCY.1));
    let variance = match series.kind {
        Kind::Angles if b > mu => amplitude(lagged, mu, (b * b - mu * mu).sqrt())?,
        _ => Tied::new(series, lagged).variance(&DVector::from_column_slice(&lagged.values), mu, b)?,
    };
    let flexure = Flexure { mu, b, sigma: variance.sqrt() };
    (variance > 0.0 && flexure.is_sound()).then_some(flexure)
}

/// `c1` by least squares.
fn amplitude(lagged: &Lagged, alpha: f64, beta: f64) -> Option<f64> {
    let times = lagged.times();
    let design = DMatrix::from_fn(times.len(), 2, |row, column| {
        let (sine, cosine) = (beta * times[row]).sin_cos();
        (-alpha * times[row]).exp() * if column == 0 { cosine } else { sine }
    });
    let normal = design.tr_mul(&design).cholesky()?;
    Some(normal.solve(&design.tr_mul(&DVector::from_column_slice(&lagged.values)))[0])
}

/// A model whose method gives no standard deviations: those of the bound, times what such methods lose.
pub fn identified(series: &Series, flexure: Flexure) -> Option<Identified> {
    let length_s = series.length_s();
    let bound = Bound::new(&flexure, length_s, Band::of(series), 0.0)?;
    let loss = if series.kind == Kind::Angles { LOSS_OF_ANGLES } else { LOSS_OF_RATES };
    let loss = Matrix3::from_diagonal(&loss.into());
    Identified::new(flexure, &(loss * bound.covariance * loss), length_s)
}
