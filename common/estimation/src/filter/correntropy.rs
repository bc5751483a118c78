//! Maximum correntropy: each measurement counts by a Gaussian kernel of its own residual.
//!
//! Source: paper 000 eqs 44-53, in the form with one weight a measurement, eqs 50-53, a single pass. The kernel's widths 2 and 4 are ours:
//! the paper gives none.
//!
//! Corrections: eq 52's gain `P H^T C (H P H^T C + R)^-1` is that of Kalman's update with the noise `R C^-1` (for diagonal `R`), and this noise belongs into eq 51
//! as well, where the printed `H P H^T C + R` is not symmetric; eq 49 has the wrong sign before `H x` and the wrong last state.
//! Eq 53 measures the residual by `R`: its weights vanish wherever the state is less certain than the measurement,
//! so they have a floor; measured by the innovation's covariance they do not.

use nalgebra::{SMatrix, SVector};

/// The least weight.
const FLOOR: f64 = 1e-8;

/// What a residual is measured by, and the kernel's width in that measure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kernel {
    /// By the noise of the measurement, eq 53.
    Noise {
        /// In standard deviations.
        width: f64,
    },
    /// By the innovation's covariance `H P H^T + R`.
    Innovation {
        /// In standard deviations.
        width: f64,
    },
}

impl Kernel {
    /// Eq 53 with a width of two standard deviations.
    pub const BY_NOISE: Self = Self::Noise { width: 2.0 };
    /// By the innovation, with a width of four standard deviations.
    pub const BY_INNOVATION: Self = Self::Innovation { width: 4.0 };

    /// The noise that stands for `r` in Kalman's update: `R` over the weights of the residuals `z`.
    pub fn noise<const N: usize, const K: usize>(
        self,
        p: &SMatrix<f64, N, N>,
        z: &SVector<f64, K>,
        h: &SMatrix<f64, K, N>,
        r: &SMatrix<f64, K, K>,
    ) -> SMatrix<f64, K, K> {
        let (measure, width) = match self {
            Self::Noise { width } => (r.diagonal(), width),
            Self::Innovation { width } => ((h * p * h.transpose() + r).diagonal(), width),
        };
        let mut noise = *r;
        for i in 0..K {
            let weight = (-0.5 * z[i] * z[i] / (measure[i] * width * width)).exp().max(FLOOR);
            for j in 0..K {
                noise[(i, j)] /= weight.sqrt();
                noise[(j, i)] /= weight.sqrt();
            }
        }
        noise
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::filter::kalman;
    use nalgebra::{Matrix2, Matrix2x3, Matrix3, Vector2};

    fn case() -> (Matrix3<f64>, Matrix2x3<f64>, Matrix2<f64>) {
        let h = Matrix2x3::new(1.0, 0.2, 0.0, 0.1, 1.0, 0.5);
        (Matrix3::new(2.0, 0.1, 0.0, 0.1, 1.0, 0.3, 0.0, 0.3, 3.0), h, Matrix2::new(0.5, 0.0, 0.0, 0.2))
    }

    #[test]
    fn the_gain_is_the_printed_one() {
        let (p, h, r) = case();
        let z = Vector2::new(1.1, -0.4);
        let weights = Vector2::from_fn(|i, _| (-0.5 * z[i] * z[i] / (r[(i, i)] * 4.0)).exp());
        let c = Matrix2::from_diagonal(&weights);
        // 000 eq 52
        let gain = p * h.transpose() * c * (h * p * h.transpose() * c + r).try_inverse().expect("regular");
        let noise = Kernel::BY_NOISE.noise(&p, &z, &h, &r);
        let mut after = p;
        let error = kalman::update(&mut after, &z, &h, &noise).expect("regular");
        assert!((error - gain * z).norm() < 1e-12);
        // eq 51 with the symmetric covariance of the innovation
        assert!((after - (p - gain * h * p)).amax() < 1e-12);
    }

    #[test]
    fn the_printed_covariance_of_the_innovation_is_not_symmetric() {
        let (p, h, r) = case();
        let printed = h * p * h.transpose() * Matrix2::new(0.5, 0.0, 0.0, 0.9) + r;
        assert!((printed - printed.transpose()).amax() > 0.1);
    }

    #[test]
    fn a_spike_counts_for_nothing_and_a_small_residual_in_full() {
        let (p, h, r) = case();
        for kernel in [Kernel::BY_NOISE, Kernel::BY_INNOVATION] {
            let noise = kernel.noise(&p, &Vector2::new(1e3, 1e-3), &h, &r);
            assert!(noise[(0, 0)] > 1e7 * r[(0, 0)] && (noise[(1, 1)] / r[(1, 1)] - 1.0).abs() < 1e-4);
        }
    }
}
