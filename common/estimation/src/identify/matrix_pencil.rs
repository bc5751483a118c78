//! Matrix pencil: the poles of the autocovariance from the shift of its signal subspace.
//!
//! Source: 003 eq 24 solved as by Y. Hua and T. Sarkar (1990): a Hankel matrix of the lags, its two largest right singular vectors,
//! and the eigenvalues of what takes these without their last row to these without their first.

use super::axis::Identified;
use super::lagged::Lagged;
use super::poles::{identified, motion, sized};
use super::series::Series;
use nalgebra::{Complex, DMatrix, Matrix2, SVD};

/// Between two lags, s.
const SPACING_S: f64 = 0.25;
/// The longest lag, s.
const LONGEST_S: f64 = 10.0;
/// Most iterations of the decomposition.
const ITERATIONS: usize = 10_000;

/// Identifies an axis; `None` if no pole decays.
pub fn identify(series: &Series) -> Option<Identified> {
    let lagged = Lagged::new(series, SPACING_S, LONGEST_S)?;
    identified(series, sized(series, &lagged, motion(factors(&lagged.values)?, lagged.spacing_s)?)?)
}

/// What the two strongest modes of a sequence are multiplied by from one lag to the next.
pub fn factors(sequence: &[f64]) -> Option<[Complex<f64>; 2]> {
    let pencil = sequence.len() / 2;
    if pencil < 3 || sequence.iter().any(|value| !value.is_finite()) {
        return None;
    }
    let hankel = DMatrix::from_fn(sequence.len() - pencil, pencil + 1, |row, column| sequence[row + column]);
    let svd = SVD::try_new(hankel, false, true, f64::EPSILON, ITERATIONS)?;
    let vectors = svd.v_t?.rows(0, 2).transpose();
    let (early, late) = (vectors.rows(0, pencil), vectors.rows(1, pencil));
    let normal: Matrix2<f64> = early.tr_mul(&early).fixed_view::<2, 2>(0, 0).into_owned();
    let cross: Matrix2<f64> = early.tr_mul(&late).fixed_view::<2, 2>(0, 0).into_owned();
    let values = (normal.try_inverse()? * cross).complex_eigenvalues();
    values.iter().all(|z| z.norm().is_finite()).then_some([values[0], values[1]])
}
