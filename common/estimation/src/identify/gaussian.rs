//! Relevance vector machine with a Gaussian kernel, then the model fitted to the smooth curve.
//!
//! Source: paper 000 section 3.2 read literally: eq 25-32 smooth the autocovariance, eq 21-24 are compared with the result.
//! Corrections: lag 0 is left out; so is the constant of eq 25, since an autocovariance decays to nothing; the kernel's width, which
//! the paper does not give, is the one of several with the largest marginal likelihood (000's eq 33 corrected).

use super::axis::Identified;
use super::lagged::Lagged;
use super::poles::identified;
use super::relevance::{Limits, solve};
use super::series::Series;
use super::tied::{LONGEST_S, SPACING_S, Tied};
use nalgebra::{DMatrix, DVector};

/// Widths of the kernel that are tried, s.
const WIDTHS_S: [f64; 4] = [0.5, 1.0, 2.0, 4.0];
/// Least share of the autocovariance's power that is sampling error.
const SAMPLING: f64 = 1e-3;

/// Identifies an axis; `None` if the curve fits no flexure.
pub fn identify(series: &Series) -> Option<Identified> {
    let lagged = Lagged::new(series, SPACING_S, LONGEST_S)?;
    let smooth = smooth(&lagged)?;
    identified(series, Tied::new(series, &lagged).least_squares(&smooth)?)
}

/// The smooth curve at the lags.
fn smooth(lagged: &Lagged) -> Option<DVector<f64>> {
    let largest = lagged.values.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
    let target = DVector::from_column_slice(&lagged.values) / largest;
    let limits = Limits { noise_share: SAMPLING, ..Limits::default() };
    let curve = |width_s: &f64| {
        let design = kernel(&lagged.times(), *width_s);
        let found = solve(&design, &target, &limits)?;
        let mut curve = DVector::zeros(target.len());
        for (&i, &weight) in found.active.iter().zip(found.weights.iter()) {
            curve.axpy(weight * largest, &design.column(i), 1.0);
        }
        Some((found.evidence, curve))
    };
    let curves = WIDTHS_S.iter().filter_map(curve);
    curves.max_by(|one, other| one.0.total_cmp(&other.0)).map(|(_, curve)| curve)
}

/// Gaussian kernel between all times.
pub(super) fn kernel(times: &[f64], width_s: f64) -> DMatrix<f64> {
    let value = |row: usize, column: usize| (-0.5 * ((times[row] - times[column]) / width_s).powi(2)).exp();
    DMatrix::from_fn(times.len(), times.len(), value)
}
