use crate::{Frame, Vec3};
use glam::{DQuat, DVec3};
use serde::{Deserialize, Serialize};
use std::marker::PhantomData;
use std::ops::Mul;

/// The rotation "A from B", `C_B^A`: turns a vector seen in `B` into the same vector seen in `A`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Rot<A: Frame, B: Frame> {
    pub(crate) q: DQuat,
    frames: PhantomData<(A, B)>,
}

/// Below this squared half angle sine and cosine are replaced by their series, which are then exact to the last bit.
const SMALL: f64 = 1e-6;

impl<A: Frame, B: Frame> Rot<A, B> {
    pub(crate) const fn wrap(q: DQuat) -> Self {
        Self { q, frames: PhantomData }
    }

    /// A and B coincide.
    pub const fn identity() -> Self {
        Self::wrap(DQuat::IDENTITY)
    }

    /// The rotation by the rotation vector `phi` (rad), `Exp([phi x])`.
    pub fn exp(phi: Vec3<A>) -> Self {
        let half = phi.v * 0.5;
        let square = half.length_squared();
        let (sinc, cosine) = if square < SMALL {
            (1.0 - square / 6.0 + square * square / 120.0, 1.0 - square / 2.0 + square * square / 24.0)
        } else {
            let angle = square.sqrt();
            (angle.sin() / angle, angle.cos())
        };
        let v = half * sinc;
        Self::wrap(DQuat::from_xyzw(v.x, v.y, v.z, cosine))
    }

    /// The rotation vector (rad), of length 0 to pi, seen in A (and, being the axis, the same in B).
    pub fn log(self) -> Vec3<A> {
        let q = if self.q.w < 0.0 { -self.q } else { self.q };
        let v = DVec3::new(q.x, q.y, q.z);
        let square = v.length_squared();
        let factor = if square < SMALL {
            // 2 asin(s) / s with s the sine of the half angle
            2.0 + square / 3.0 + 3.0 * square * square / 20.0
        } else {
            let sine = square.sqrt();
            2.0 * sine.atan2(q.w) / sine
        };
        Vec3::wrap(v * factor)
    }

    /// The rotation vector that lies nearest to another one: near a half turn [`Rot::log`] may jump to the opposite axis, which
    /// is the same rotation but no neighbour.
    pub fn log_beside(self, neighbour: Vec3<A>) -> Vec3<A> {
        let phi = self.log();
        let angle = phi.norm();
        if angle < 1.0 {
            return phi;
        }
        let other = phi * ((angle - std::f64::consts::TAU) / angle);
        if (other - neighbour).norm() < (phi - neighbour).norm() { other } else { phi }
    }

    /// "B from A".
    pub fn inverse(self) -> Rot<B, A> {
        Rot::wrap(self.q.conjugate())
    }

    /// Brings the quaternion back to unit length; wanted after many products.
    pub fn normalised(self) -> Self {
        Self::wrap(self.q.normalize())
    }

    /// The rotation of a quaternion `[w, x, y, z]`; `None` if it is not finite or has no length.
    pub fn from_quaternion(q: [f64; 4]) -> Option<Self> {
        let q = DQuat::from_xyzw(q[1], q[2], q[3], q[0]);
        let length = q.length();
        (length.is_finite() && length > 1e-9).then(|| Self::wrap(q / length))
    }

    /// The quaternion `[w, x, y, z]` of a message, taken as it is: no check, no change of a bit.
    pub fn from_wxyz(q: [f64; 4]) -> Self {
        Self::wrap(DQuat::from_xyzw(q[1], q[2], q[3], q[0]))
    }

    /// The quaternion `[w, x, y, z]` with `w >= 0`.
    pub fn quaternion(self) -> [f64; 4] {
        let q = if self.q.w < 0.0 { -self.q } else { self.q };
        [q.w, q.x, q.y, q.z]
    }

    /// The same rotation, declared between other frames: a change of name only.
    pub fn relabel<C: Frame, D: Frame>(self) -> Rot<C, D> {
        Rot::wrap(self.q)
    }

    /// The angle of the rotation (rad), 0 to pi.
    pub fn angle(self) -> f64 {
        self.log().norm()
    }
}

impl<A: Frame, B: Frame, C: Frame> Mul<Rot<B, C>> for Rot<A, B> {
    type Output = Rot<A, C>;
    fn mul(self, other: Rot<B, C>) -> Rot<A, C> {
        Rot::wrap(self.q * other.q)
    }
}

impl<A: Frame, B: Frame> Mul<Vec3<B>> for Rot<A, B> {
    type Output = Vec3<A>;
    fn mul(self, v: Vec3<B>) -> Vec3<A> {
        Vec3::wrap(self.q * v.v)
    }
}
