//! Roll, pitch and heading of a deck area with what belongs to them.

use frames::{Euler, Nav, Rot, Sub, Vec3};

/// Beyond this pitch roll and heading lose their meaning, rad.
const STEEPEST: f64 = 1.4;

/// Something about each of the three angles.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Axes {
    /// Of the roll, positive with the port side up.
    pub roll: f64,
    /// Of the pitch, positive with the bow up.
    pub pitch: f64,
    /// Of the heading, clockwise from north.
    pub heading: f64,
}

/// The attitude of a deck area.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Attitude {
    /// The angles, rad.
    pub angles: Euler,
    /// Standard deviations of their errors, rad.
    pub sigma: Axes,
    /// How fast the angles change, rad/s.
    pub rate: Axes,
}

impl Attitude {
    /// From `C_s^n`, the standard deviations of its error about east, north and up (rad), which are taken as independent, and its
    /// rate (rad/s). `None` where a number is not finite or the deck stands so steep that roll and heading have no meaning.
    pub fn new(deck: Rot<Nav, Sub>, sigma: Vec3<Nav>, rate: Vec3<Nav>) -> Option<Self> {
        let angles = deck.euler();
        let finite = [angles.roll, angles.pitch, angles.heading].iter().all(|v| v.is_finite());
        if !finite || !sigma.is_finite() || !rate.is_finite() || angles.pitch.abs() > STEEPEST {
            return None;
        }
        let rows = sensitivity(&angles);
        let deviation =
            |row: Vec3<Nav>| (0..3).map(|i| (row.array()[i] * sigma.array()[i]).powi(2)).sum::<f64>().sqrt();
        Some(Self {
            angles,
            sigma: Axes { roll: deviation(rows.roll), pitch: deviation(rows.pitch), heading: deviation(rows.heading) },
            rate: Axes { roll: rows.roll.dot(rate), pitch: rows.pitch.dot(rate), heading: rows.heading.dot(rate) },
        })
    }
}

/// How the angles answer to a small turn about east, north and up.
struct Sensitivity {
    roll: Vec3<Nav>,
    pitch: Vec3<Nav>,
    heading: Vec3<Nav>,
}

/// Roll turns about the bow's direction, pitch about the horizontal to starboard of it, and the heading runs against the turn about up.
fn sensitivity(angles: &Euler) -> Sensitivity {
    let (sine, cosine) = angles.heading.sin_cos();
    let (tan, sec) = (angles.pitch.tan(), 1.0 / angles.pitch.cos());
    Sensitivity {
        roll: Vec3::new(sine * sec, cosine * sec, 0.0),
        pitch: Vec3::new(cosine, -sine, 0.0),
        heading: Vec3::new(sine * tan, cosine * tan, -1.0),
    }
}
