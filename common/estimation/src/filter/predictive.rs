//! Model predictive filter: the model's error `D` is estimated from the measurement that is about to be used, and compensated.
//!
//! Source: paper 000 eqs 34-43. `D` minimises `(z - z^(D))^T R^-1 (z - z^(D)) / 2 + D^T A D / 2`, eq 39, so with `U = Lambda S`, the measurement's
//! dependence on `D`, `D = (U^T R^-1 U + A)^-1 U^T R^-1 r`, eq 40, and the state moves by `G D dt`, eq 41, with its covariance as it was, eq 42.
//! `U` is `H G dt` and `A` weighs `D` by the density of the noise that it stands for, `A = alpha dt Q^-1`: the paper leaves `A` open. By the inversion
//! lemma the state moves by `B H^T (H B H^T + R)^-1 r` with `B = G Q G^T dt / alpha`, what the interval added to the covariance over `alpha`, which
//! holds for any model and any singular `Q`.
//!
//! Corrections: the bracket of eq 40 has `+ A` outside the product; eq 41 lacks `dt`.
//!
//! With `alpha = 1`, [`Weight::LITERAL`], eq 39 is the posterior of the interval's noise given a state that is KNOWN. The state is not, and the update
//! of eqs 50, 51 uses the same measurement again. So `D` takes most of each innovation and leaves nothing to slow states.
//! [`Weight::Bayes`] puts the innovation's covariance `H P H^T + R` in the place of `R` in eq 39: then `D` is the noise's posterior
//! mean under the uncertain state. The measurement is still used twice, but `D` takes only the noise's own share of the innovation.

use nalgebra::{SMatrix, SVector};

/// How the predicted error of the model is weighed against the innovation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Weight {
    /// The innovation has the covariance `R`, and `A = alpha dt Q^-1`.
    Literal {
        /// 1 for the paper's reading; the larger, the less is compensated.
        alpha: f64,
    },
    /// The innovation has the covariance `H P H^T + R`, and `A = dt Q^-1`.
    Bayes,
}

impl Weight {
    /// The paper's reading.
    pub const LITERAL: Self = Self::Literal { alpha: 1.0 };
    /// So heavy that little is compensated.
    pub const HEAVY: Self = Self::Literal { alpha: 100.0 };
}

/// By how much the state moves for the predicted error of the model. `p`: covariance before the measurement; `driven`: what the last
/// interval added to it; `z`: residual, `h`: its matrix, `r`: its noise. `None` where the numbers do not allow it.
pub fn compensation<const N: usize, const K: usize>(
    weight: Weight,
    p: &SMatrix<f64, N, N>,
    driven: &SMatrix<f64, N, N>,
    z: &SVector<f64, K>,
    h: &SMatrix<f64, K, N>,
    r: &SMatrix<f64, K, K>,
) -> Option<SVector<f64, N>> {
    let (alpha, covariance) = match weight {
        Weight::Literal { alpha } => (alpha, *r),
        Weight::Bayes => (1.0, h * p * h.transpose() + r - h * driven * h.transpose()),
    };
    let cross = driven * h.transpose() / alpha;
    let moved = cross * (h * cross + covariance).cholesky()?.solve(z);
    moved.iter().all(|x| x.is_finite()).then_some(moved)
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Matrix2, Matrix2x4, Matrix4, Matrix4x2, Vector2};

    type Case = (Matrix4x2<f64>, Matrix2<f64>, Matrix2x4<f64>, Matrix2<f64>, Vector2<f64>);

    /// Two noises of four states, two measurements.
    fn case() -> Case {
        let g = Matrix4x2::new(0.0, 0.1, 1.0, 0.3, -0.2, 1.0, 0.0, 0.4);
        let h = Matrix2x4::new(1.0, 0.5, 0.0, 0.2, 0.3, -1.0, 0.7, 0.1);
        (g, Matrix2::new(2.0, 0.3, 0.3, 0.5), h, Matrix2::new(0.04, 0.01, 0.01, 0.09), Vector2::new(0.3, -0.8))
    }

    #[test]
    fn it_is_the_printed_solution() {
        let (g, q, h, r, z) = case();
        for (dt, alpha) in [(0.01, 1.0), (0.1, 1.0), (0.1, 100.0)] {
            let u = h * g * dt;
            let a = q.try_inverse().expect("regular") * (alpha * dt);
            let inverse = r.try_inverse().expect("regular");
            // 000 eqs 40, 41
            let d = (u.transpose() * inverse * u + a).try_inverse().expect("regular") * u.transpose() * inverse * z;
            let driven = g * q * g.transpose() * dt;
            let moved = compensation(Weight::Literal { alpha }, &Matrix4::identity(), &driven, &z, &h, &r);
            assert!((moved.expect("regular") - g * d * dt).norm() < 1e-12);
        }
    }

    #[test]
    fn by_bayes_it_is_the_noises_share_of_the_update() {
        let (g, q, h, r, z) = case();
        let driven = g * q * g.transpose() * 0.1;
        let p = Matrix4::identity() * 0.5 + driven;
        let moved = compensation(Weight::Bayes, &p, &driven, &z, &h, &r).expect("regular");
        let innovation = (h * p * h.transpose() + r).try_inverse().expect("regular");
        assert!((moved - driven * h.transpose() * innovation * z).norm() < 1e-12);
        let known = compensation(Weight::LITERAL, &p, &driven, &z, &h, &r).expect("regular");
        assert!(known.norm() > 2.0 * moved.norm());
    }

    #[test]
    fn numbers_that_are_none_give_none() {
        let (g, q, h, r, _) = case();
        let driven = g * q * g.transpose();
        let weight = Weight::LITERAL;
        assert!(compensation(weight, &driven, &driven, &Vector2::new(f64::NAN, 0.0), &h, &r).is_none());
    }
}
