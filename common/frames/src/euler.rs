use crate::{Frame, Nav, Rot, Vec3};
use std::f64::consts::TAU;

/// Roll, pitch and heading of a body in the navigation frame (rad).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Euler {
    /// Positive with the port side up, -pi to pi.
    pub roll: f64,
    /// Positive with the bow up, -pi/2 to pi/2.
    pub pitch: f64,
    /// Clockwise from north, 0 to 2 pi.
    pub heading: f64,
}

impl Euler {
    /// `C_b^n = Rz(-heading) Rx(pitch) Ry(roll)`.
    pub fn rotation<B: Frame>(self) -> Rot<Nav, B> {
        let z = Rot::<Nav, Nav>::exp(Vec3::new(0.0, 0.0, -self.heading));
        let x = Rot::<Nav, Nav>::exp(Vec3::new(self.pitch, 0.0, 0.0));
        let y = Rot::<Nav, B>::exp(Vec3::new(0.0, self.roll, 0.0));
        z * x * y
    }
}

impl<B: Frame> Rot<Nav, B> {
    /// Roll, pitch and heading of the body B.
    pub fn euler(self) -> Euler {
        let bow = self * Vec3::<B>::new(0.0, 1.0, 0.0);
        let starboard_up = (self * Vec3::<B>::new(1.0, 0.0, 0.0)).z();
        let mast_up = (self * Vec3::<B>::new(0.0, 0.0, 1.0)).z();
        Euler {
            roll: (-starboard_up).atan2(mast_up),
            pitch: bow.z().clamp(-1.0, 1.0).asin(),
            heading: bow.x().atan2(bow.y()).rem_euclid(TAU),
        }
    }
}
