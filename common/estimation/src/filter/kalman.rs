//! Kalman's update, in Joseph's form: the static part's variance falls far below that of the flexure beside it.

use super::symmetrise;
use nalgebra::{SMatrix, SVector};

/// Given the covariance `p` of the error state, the residual `z`, its matrix `h` and noise `r`: the estimate of the error
/// state, with `p` replaced by the covariance after the update. `None`, and `p` as it was, when the numbers do not allow it.
pub fn update<const N: usize, const K: usize>(
    p: &mut SMatrix<f64, N, N>,
    z: &SVector<f64, K>,
    h: &SMatrix<f64, K, N>,
    r: &SMatrix<f64, K, K>,
) -> Option<SVector<f64, N>> {
    let cross = *p * h.transpose();
    let innovation = h * cross + r;
    let gain = innovation.cholesky()?.solve(&cross.transpose()).transpose();
    let keep = SMatrix::<f64, N, N>::identity() - gain * h;
    let mut after = keep * *p * keep.transpose() + gain * r * gain.transpose();
    symmetrise(&mut after);
    let correction = gain * z;
    if !correction.iter().chain(after.iter()).all(|x| x.is_finite()) {
        return None;
    }
    *p = after;
    Some(correction)
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Matrix1, Matrix1x2, Matrix2, Vector1};

    #[test]
    fn two_measurements_of_a_constant_average() {
        let mut p = Matrix2::new(1e12, 0.0, 0.0, 1.0);
        let h = Matrix1x2::new(1.0, 0.0);
        let mut x = 0.0;
        for z in [3.0, 5.0] {
            x += update(&mut p, &Vector1::new(z - x), &h, &Matrix1::new(2.0)).expect("regular")[0];
        }
        assert!((x - 4.0).abs() < 1e-6 && (p[(0, 0)] - 1.0).abs() < 1e-6);
        assert_eq!(p[(1, 1)], 1.0, "what is not measured keeps its variance");
    }

    #[test]
    fn numbers_that_are_none_leave_the_covariance_alone() {
        let mut p = Matrix2::identity();
        let result = update(&mut p, &Vector1::new(f64::NAN), &Matrix1x2::new(1.0, 0.0), &Matrix1::new(1.0));
        assert!(result.is_none() && p == Matrix2::identity());
    }
}
