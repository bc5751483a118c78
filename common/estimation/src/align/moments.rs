use super::Registration;
use frames::{Main, Rot, Sub, Vec3};
use nalgebra::{Matrix3, Vector3};

/// Second moments of angles that both units turned by at the same time, which is all that a registration by angles needs.
#[derive(Clone, Debug)]
pub(super) struct Moments {
    pub n: f64,
    aa: Matrix3<f64>,
    pub ab: Matrix3<f64>,
    bb: Matrix3<f64>,
}

impl Moments {
    pub fn new() -> Self {
        Self { n: 0.0, aa: Matrix3::zeros(), ab: Matrix3::zeros(), bb: Matrix3::zeros() }
    }

    /// Takes an angle of the main unit and one of the sub unit, rad.
    pub fn add(&mut self, a: &Vector3<f64>, b: &Vector3<f64>) {
        self.n += 1.0;
        self.aa += a * a.transpose();
        self.ab += a * b.transpose();
        self.bb += b * b.transpose();
    }

    /// Sum of the squares of the main unit's angles, less that about each axis: what shows a rotation.
    pub fn information(moment: &Matrix3<f64>) -> Matrix3<f64> {
        Matrix3::identity() * moment.trace() - moment
    }

    pub fn sub(&self) -> &Matrix3<f64> {
        &self.bb
    }

    /// A rotation with the doubt that its own residuals throw on it, of which so many are independent; each angle took `length_s`.
    pub fn registration(&self, rotation: Rot<Main, Sub>, independent: f64, length_s: f64) -> Option<Registration> {
        let c = rotation.matrix();
        let residual = self.aa - c * self.ab.transpose() - self.ab * c.transpose() + c * self.bb * c.transpose();
        let variance = (residual.trace() / (3.0 * self.n)).max(f64::MIN_POSITIVE);
        let information = Self::information(&self.aa) * (independent.max(1.0) / self.n);
        let covariance = information.try_inverse()? * variance;
        let singular = self.ab.singular_values();
        let finite = covariance.iter().chain(c.iter()).all(|x| x.is_finite());
        (finite && covariance.diagonal().min() > 0.0).then(|| Registration {
            rotation,
            covariance,
            bias: Vec3::ZERO,
            bias_sigma: Vector3::repeat(f64::INFINITY),
            residual_rate: residual.diagonal().map(|r| (r.max(0.0) / self.n).sqrt() / length_s),
            ratio: singular[1] / singular[0].max(f64::MIN_POSITIVE),
        })
    }
}
