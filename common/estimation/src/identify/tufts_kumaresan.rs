//! Tufts-Kumaresan: backward linear prediction of the autocovariance with a truncated singular value decomposition.
//!
//! Source: paper 003 eq 24-29 and its section IV (N = 20 s, L = 6 s of lags, M = 2).
//!
//! | quantity | meaning |
//! |---|---|
//! | `y(1..N)` | autocovariance at the lags 1 to N, never lag 0 |
//! | `b(1..L)` | prediction filter of least norm, rank M |
//! | zeros of `B(z)` | at `exp(-s*)`, outside the unit circle; the rest lie inside |
//!
//! Corrections: eq 25 needs a minus sign, `A b = -h`, for eq 29 to have its zeros where the paper says; with the printed sign they
//! mean nothing. The lags need not be those of each sample: 40 of 0.25 s instead of 400 of 0.05 s are no worse.

use super::axis::Identified;
use super::lagged::Lagged;
use super::poles::{identified, motion, sized};
use super::series::Series;
use nalgebra::{Complex, DMatrix, DVector, SVD, Schur};

/// Which lags, and how long a filter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lags {
    /// Between two lags, s; at least a sample's distance.
    pub spacing_s: f64,
    /// N, s.
    pub longest_s: f64,
    /// L over N.
    pub order: f64,
}

/// The lags of paper 003: each sample, L = 6 s, N = 20 s.
pub const PRINTED: Lags = Lags { spacing_s: 0.0, longest_s: 20.0, order: 0.3 };
/// The lags that cost least.
pub const DECIMATED: Lags = Lags { spacing_s: 0.25, longest_s: 10.0, order: 0.325 };
/// One oscillation has two poles.
const RANK: usize = 2;
/// Most iterations of a decomposition.
const ITERATIONS: usize = 10_000;

/// The sign of the right side of 003 eq 25.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sign {
    /// `A b = -h`.
    Corrected,
    /// `A b = h`.
    Printed,
}

/// Identifies an axis; `None` if no zero is a decaying mode.
pub fn identify(series: &Series, lags: &Lags) -> Option<Identified> {
    let lagged = Lagged::new(series, lags.spacing_s, lags.longest_s)?;
    let order = (lags.order * lagged.values.len() as f64).round() as usize;
    let zeros = zeros(&lagged.values, order, Sign::Corrected)?;
    identified(series, sized(series, &lagged, motion(factors(&zeros), lagged.spacing_s)?)?)
}

/// What a mode is multiplied by from one lag to the next, from the zeros: `exp(s) = 1 / conj(z)`.
pub fn factors(zeros: &[Complex<f64>]) -> impl Iterator<Item = Complex<f64>> {
    zeros.iter().map(|z| 1.0 / z.conj())
}

/// The zeros of the prediction filter of order `order` of a real sequence; `None` if the sequence is shorter than twice that or a
/// decomposition does not converge.
pub fn zeros(sequence: &[f64], order: usize, sign: Sign) -> Option<Vec<Complex<f64>>> {
    let rows = sequence.len().checked_sub(order)?;
    if order < RANK || rows < order || sequence.iter().any(|value| !value.is_finite()) {
        return None;
    }
    // 003 eq 26, 28
    let a = DMatrix::from_fn(rows, order, |row, column| sequence[row + column + 1]);
    let h = DVector::from_fn(rows, |row, _| sequence[row]);
    let filter = truncated(a, &h)?;
    let filter = if sign == Sign::Corrected { -filter } else { filter };
    // 003 eq 29
    let companion = DMatrix::from_fn(order, order, |row, column| match (row, column) {
        (0, k) => -filter[k],
        (r, k) => f64::from(u8::from(r == k + 1)),
    });
    Some(Schur::try_new(companion, f64::EPSILON, ITERATIONS)?.complex_eigenvalues().iter().copied().collect())
}

/// The solution of least norm by the largest singular values alone.
fn truncated(a: DMatrix<f64>, h: &DVector<f64>) -> Option<DVector<f64>> {
    let mut solution = DVector::zeros(a.ncols());
    let svd = SVD::try_new(a, true, true, f64::EPSILON, ITERATIONS)?;
    let (u, v) = (svd.u.as_ref()?, svd.v_t.as_ref()?);
    for k in 0..RANK {
        let share = u.column(k).dot(h) / svd.singular_values[k];
        solution.axpy(share, &v.row(k).transpose(), 1.0);
    }
    solution.iter().all(|value| value.is_finite()).then_some(solution)
}
