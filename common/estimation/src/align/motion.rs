//! Coarse registration of the installation from the motion alone, at any angle.
//!
//! Source: paper 001 eqs 2-8 in windowed form: the angle increments of both units over short windows, `a = C_s^m b + c`, solved
//! for the rotation in closed form (Davenport's problem, by singular values) after the means are taken out, so that a constant relative
//! gyro bias `c` does no harm. The literal cumulative form of the paper grows worse with time.
//!
//! Scale errors of coarse units leak into that rotation where the motion prefers an axis. So the matrix `(I + K) C_s^m` is solved
//! for as well, with `K` held to the size of the units' scale errors, and its nearest rotation is taken: with units as good as a
//! ship's this is Davenport's solution, with coarse ones their scale errors drop out.

use super::{Register, Registration};
use frames::{Main, Rot, Sub, Vec3, unit};
use messages::{Flags, ImuPair};
use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

/// Length of a window, s.
const WINDOW_S: f64 = 0.1;
/// The residuals of neighbouring windows of a flexing hull are not independent: their variance counts so much more.
const CORRELATION: f64 = 20.0;
/// The least variance of a relative scale error that is reckoned with: units that are called perfect are held to a billionth.
const LEAST_SCALE_VARIANCE: f64 = 1e-18;
/// Least number of windows before a solution is tried.
const LEAST_WINDOWS: f64 = 40.0;

/// Collects windows of both units' angle increments.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Registrar {
    /// Variance of a relative scale error.
    scale_variance: f64,
    filling: Filling,
    windows: f64,
    length_s: f64,
    sum_a: Vector3<f64>,
    sum_b: Vector3<f64>,
    sum_aa: Matrix3<f64>,
    sum_ab: Matrix3<f64>,
    sum_bb: Matrix3<f64>,
}

/// The window that is being filled.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
struct Filling {
    a: Vector3<f64>,
    b: Vector3<f64>,
    length_s: f64,
}

impl Registrar {
    /// A registrar for units whose relative scale errors have this variance.
    pub fn new(scale_variance: f64) -> Self {
        Self {
            scale_variance,
            filling: Filling::default(),
            windows: 0.0,
            length_s: 0.0,
            sum_a: Vector3::zeros(),
            sum_b: Vector3::zeros(),
            sum_aa: Matrix3::zeros(),
            sum_ab: Matrix3::zeros(),
            sum_bb: Matrix3::zeros(),
        }
    }

    fn window(&mut self, a: Vector3<f64>, b: Vector3<f64>, length_s: f64) {
        self.windows += 1.0;
        self.length_s += length_s;
        self.sum_a += a;
        self.sum_b += b;
        self.sum_aa += a * a.transpose();
        self.sum_ab += a * b.transpose();
        self.sum_bb += b * b.transpose();
    }
}

impl Register for Registrar {
    fn add(&mut self, pair: &ImuPair) {
        if pair.flags.intersects(Flags::GAP | Flags::NEW_EPOCH | Flags::SATURATED) {
            self.filling = Filling::default();
            return;
        }
        let interval_s = unit::seconds(pair.interval_ns);
        let filling = &mut self.filling;
        filling.a += Vec3::<Main>::from(pair.dtheta_m).column();
        filling.b += Vec3::<Sub>::from(pair.dtheta_s).column();
        filling.length_s += interval_s;
        if filling.length_s >= WINDOW_S - 0.5 * interval_s {
            let Filling { a, b, length_s } = std::mem::take(filling);
            self.window(a, b, length_s);
        }
    }

    fn solve(&self) -> Option<Registration> {
        let n = self.windows;
        if n < LEAST_WINDOWS {
            return None;
        }
        let aa = self.sum_aa - self.sum_a * self.sum_a.transpose() / n;
        let ab = self.sum_ab - self.sum_a * self.sum_b.transpose() / n;
        let bb = self.sum_bb - self.sum_b * self.sum_b.transpose() / n;
        let (davenport, singular) = nearest_rotation(&ab)?;
        let spread = |c: &Matrix3<f64>| aa - c * ab.transpose() - ab * c.transpose() + c * bb * c.transpose();
        let variance = spread(&davenport).trace() / (3.0 * n - 6.0);
        let pull = variance / self.scale_variance.max(LEAST_SCALE_VARIANCE);
        let scaled = (ab + davenport * pull) * (bb + Matrix3::identity() * pull).try_inverse()?;
        let (c, _) = nearest_rotation(&scaled)?;
        let residual = spread(&c);
        let freedom = 3.0 * n - 6.0;
        let variance = (residual.trace() / freedom).max(f64::MIN_POSITIVE);
        let information = Matrix3::identity() * aa.trace() - aa;
        let covariance = information.try_inverse()? * (variance * CORRELATION);
        let finite = covariance.iter().chain(c.iter()).all(|x| x.is_finite());
        let length_s = self.length_s / n;
        let rate_variance = residual.diagonal().map(|r| r.max(0.0) / (n - 2.0)) / (length_s * length_s);
        (finite && covariance.diagonal().min() > 0.0).then(|| Registration {
            rotation: Rot::from_matrix(&c),
            covariance,
            bias: Vec3::from_column((self.sum_a - c * self.sum_b) / self.length_s),
            bias_sigma: (rate_variance * (CORRELATION / n)).map(f64::sqrt),
            residual_rate: rate_variance.map(f64::sqrt),
            ratio: singular[1] / singular[0].max(f64::MIN_POSITIVE),
        })
    }
}

/// The rotation nearest to a matrix, and the matrix's singular values.
pub(super) fn nearest_rotation(m: &Matrix3<f64>) -> Option<(Matrix3<f64>, Vector3<f64>)> {
    let svd = m.try_svd(true, true, f64::EPSILON, 100)?;
    let (u, v_t) = (svd.u?, svd.v_t?);
    let sign = (u.determinant() * v_t.determinant()).signum();
    Some((u * Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, sign)) * v_t, svd.singular_values))
}

#[cfg(test)]
mod tests {
    use super::*;
    use messages::ImuPair;

    #[test]
    fn perfect_scale_factors_are_no_obstacle() {
        let installation = Rot::<Main, Sub>::exp(Vec3::new(0.3, -0.5, 0.4));
        let mut registrar = Registrar::new(0.0);
        for k in 0..2000 {
            let t = f64::from(k) * 0.01;
            let w = Vec3::<Main>::new((0.8 * t).sin(), (0.9 * t + 1.0).cos(), (1.1 * t).cos()) * 1e-3;
            let interval_ns = 10_000_000;
            let dtheta_s = installation.inverse() * w;
            registrar.add(&ImuPair {
                interval_ns,
                dtheta_m: w.array(),
                dtheta_s: dtheta_s.array(),
                ..ImuPair::default()
            });
        }
        let found = registrar.solve().expect("three axes of motion");
        assert!((found.rotation * installation.inverse()).angle() < 1e-9);
    }
}
