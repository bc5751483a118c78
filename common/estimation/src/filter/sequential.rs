//! Kalman's update one value at a time, for states of which each value sees only a few.

use nalgebra::{SMatrix, SVector};

/// `F P F^T` for a transition of which most elements are zero; symmetric to the last bit.
pub fn carried<const N: usize>(transition: &SMatrix<f64, N, N>, p: &SMatrix<f64, N, N>) -> SMatrix<f64, N, N> {
    let by_rows = |m: &SMatrix<f64, N, N>| {
        // column i of M F^T
        let mut product = SMatrix::<f64, N, N>::zeros();
        for j in 0..N {
            for i in 0..N {
                let factor = transition[(i, j)];
                if factor != 0.0 {
                    product.column_mut(i).axpy(factor, &m.column(j), 1.0);
                }
            }
        }
        product
    };
    let mut carried = by_rows(&by_rows(p).transpose());
    super::symmetrise(&mut carried);
    carried
}

/// What an update found.
#[derive(Clone, Copy, Debug)]
pub struct Correction<const N: usize> {
    /// Estimate of the error state.
    pub error: SVector<f64, N>,
    /// Mean of the squared innovations in terms of their variance, over the values that see any state; 1 is expected.
    pub surprise: f64,
}

/// Given the covariance `p` of the error state, the residual `z`, its matrix `h` and noise `r`: the estimate of the error
/// state, with `p` replaced by the covariance after the update. `None`, and `p` as it was, when the numbers do not allow it.
pub fn update<const N: usize, const K: usize>(
    p: &mut SMatrix<f64, N, N>,
    z: &SVector<f64, K>,
    h: &SMatrix<f64, K, N>,
    r: &SMatrix<f64, K, K>,
) -> Option<Correction<N>> {
    // values with noise of their own each
    let white = r.cholesky()?.l();
    let (mut z, mut h) = (*z, *h);
    if !white.solve_lower_triangular_mut(&mut z) || !white.solve_lower_triangular_mut(&mut h) {
        return None;
    }
    let (mut error, mut after) = (SVector::<f64, N>::zeros(), *p);
    let (mut squares, mut count) = (0.0, 0.0);
    for k in 0..K {
        let row = h.row(k);
        let mut cross = SVector::<f64, N>::zeros();
        for (i, factor) in row.iter().enumerate().filter(|(_, factor)| **factor != 0.0) {
            cross.axpy(*factor, &after.column(i), 1.0);
        }
        let variance = (row * cross)[0] + 1.0;
        let surprise = z[k] - (row * error)[0];
        if !(variance.is_finite() && surprise.is_finite()) {
            return None;
        }
        // right after a state was defined by others the value is known, and what is left of its variance is rounding
        if variance <= 1.0 {
            continue;
        }
        if row.iter().any(|factor| *factor != 0.0) {
            squares += surprise * surprise / variance;
            count += 1.0;
        }
        error.axpy(surprise / variance, &cross, 1.0);
        // both triangles get the same numbers
        after.syger(-1.0 / variance, &cross, &cross, 1.0);
        mirror(&mut after);
    }
    if !error.iter().chain(after.diagonal().iter()).all(|x| x.is_finite()) {
        return None;
    }
    *p = after;
    Some(Correction { error, surprise: if count > 0.0 { squares / count } else { 1.0 } })
}

/// The lower triangle written over the upper one.
fn mirror<const N: usize>(m: &mut SMatrix<f64, N, N>) {
    for j in 0..N {
        for i in j + 1..N {
            m[(j, i)] = m[(i, j)];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::filter::kalman;
    use nalgebra::{Matrix3, Matrix4, SMatrix, Vector3, Vector4};

    fn covariance() -> Matrix4<f64> {
        let a = Matrix4::new(2.0, 0.3, 0.1, 0.0, -0.4, 1.0, 0.2, 0.5, 0.0, 0.7, 3.0, 0.1, 0.2, 0.2, -0.6, 0.4);
        a * a.transpose()
    }

    #[test]
    fn it_is_kalmans_update() {
        let h = SMatrix::<f64, 3, 4>::new(1.0, 0.0, 0.0, 0.5, 0.0, 0.0, 2.0, 0.0, 1.0, 1.0, 0.0, 0.0);
        let r = Matrix3::new(0.5, 0.1, 0.0, 0.1, 0.3, 0.05, 0.0, 0.05, 0.2);
        let z = Vector3::new(0.3, -0.7, 1.1);
        let (mut p, mut other) = (covariance(), covariance());
        let Correction { error, surprise } = update(&mut p, &z, &h, &r).expect("regular");
        let innovation = h * covariance() * h.transpose() + r;
        let square = (z.transpose() * innovation.try_inverse().expect("regular") * z)[0];
        assert!((3.0 * surprise - square).abs() < 1e-12);
        let expected: Vector4<f64> = kalman::update(&mut other, &z, &h, &r).expect("regular");
        assert!((error - expected).norm() < 1e-12 && (p - other).norm() < 1e-12);
        assert_eq!(p, p.transpose());
    }

    #[test]
    fn a_covariance_is_carried_as_by_the_whole_product() {
        let f = Matrix4::new(1.0, 0.1, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.9, 0.2, 0.0, 0.3, 0.0, 1.0);
        let whole = f * covariance() * f.transpose();
        let carried = carried(&f, &covariance());
        assert!((carried - whole).norm() < 1e-12 && carried == carried.transpose());
    }

    #[test]
    fn a_value_that_is_known_says_nothing() {
        // the second state is minus the first, to the last bit or not
        let tie = Matrix4::new(1.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0);
        let known = tie * covariance() * tie.transpose() - Matrix4::from_diagonal(&Vector4::new(1e-15, 0.0, 0.0, 0.0));
        let mut p = known;
        let h = SMatrix::<f64, 1, 4>::new(1.0, 1.0, 0.0, 0.0);
        let found = update(&mut p, &nalgebra::Vector1::new(1e-17), &h, &nalgebra::Matrix1::new(1e-8)).expect("sound");
        assert!(p == known && found.error == Vector4::zeros());
    }

    #[test]
    fn numbers_that_are_none_leave_the_covariance_alone() {
        let mut p = covariance();
        let h = SMatrix::<f64, 1, 4>::new(1.0, 0.0, 0.0, 0.0);
        let result = update(&mut p, &nalgebra::Vector1::new(f64::NAN), &h, &nalgebra::Matrix1::new(1.0));
        assert!(result.is_none() && p == covariance());
    }
}
