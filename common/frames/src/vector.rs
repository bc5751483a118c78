use crate::Frame;
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::marker::PhantomData;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// A vector seen in the frame `F`. The unit of measure is the name's business.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Vec3<F: Frame> {
    pub(crate) v: DVec3,
    frame: PhantomData<F>,
}

impl<F: Frame> Vec3<F> {
    /// The zero vector.
    pub const ZERO: Self = Self { v: DVec3::ZERO, frame: PhantomData };

    /// A vector from its components.
    pub const fn new(x: f64, y: f64, z: f64) -> Self {
        Self::wrap(DVec3::new(x, y, z))
    }

    pub(crate) const fn wrap(v: DVec3) -> Self {
        Self { v, frame: PhantomData }
    }

    /// The component along x.
    pub fn x(self) -> f64 {
        self.v.x
    }

    /// The component along y.
    pub fn y(self) -> f64 {
        self.v.y
    }

    /// The component along z.
    pub fn z(self) -> f64 {
        self.v.z
    }

    /// The components, as messages carry them.
    pub fn array(self) -> [f64; 3] {
        self.v.to_array()
    }

    /// The scalar product.
    pub fn dot(self, other: Self) -> f64 {
        self.v.dot(other.v)
    }

    /// The vector product.
    pub fn cross(self, other: Self) -> Self {
        Self::wrap(self.v.cross(other.v))
    }

    /// The length.
    pub fn norm(self) -> f64 {
        self.v.length()
    }

    /// Whether no component is NaN or infinite.
    pub fn is_finite(self) -> bool {
        self.v.is_finite()
    }

    /// The same components, declared to be seen in another frame: a change of name, not a rotation.
    pub fn relabel<G: Frame>(self) -> Vec3<G> {
        Vec3::wrap(self.v)
    }
}

impl<F: Frame> From<[f64; 3]> for Vec3<F> {
    fn from(v: [f64; 3]) -> Self {
        Self::wrap(DVec3::from_array(v))
    }
}

impl<F: Frame> Add for Vec3<F> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self::wrap(self.v + other.v)
    }
}

impl<F: Frame> AddAssign for Vec3<F> {
    fn add_assign(&mut self, other: Self) {
        self.v += other.v;
    }
}

impl<F: Frame> Sub for Vec3<F> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self::wrap(self.v - other.v)
    }
}

impl<F: Frame> SubAssign for Vec3<F> {
    fn sub_assign(&mut self, other: Self) {
        self.v -= other.v;
    }
}

impl<F: Frame> Neg for Vec3<F> {
    type Output = Self;
    fn neg(self) -> Self {
        Self::wrap(-self.v)
    }
}

impl<F: Frame> Mul<f64> for Vec3<F> {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        Self::wrap(self.v * factor)
    }
}

impl<F: Frame> Div<f64> for Vec3<F> {
    type Output = Self;
    fn div(self, divisor: f64) -> Self {
        Self::wrap(self.v / divisor)
    }
}
