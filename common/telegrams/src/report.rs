//! What a telegram is made from.

use crate::Attitude;

/// The deformation of an area.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Deformation {
    /// Rotation vector of `C_s^m`, rad, in m: about the axes to starboard, to the bow and up.
    pub angles: [f64; 3],
    /// Half width of the 95 % range of each component, rad.
    pub range: [f64; 3],
}

/// What is known of an area at one instant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Report {
    /// The instant, nanoseconds since 1970 in UTC, leap seconds not counted.
    pub utc_ns: i64,
    /// The attitude; `None` when it is invalid.
    pub attitude: Option<Attitude>,
    /// The deformation; `None` when it is invalid.
    pub deformation: Option<Deformation>,
    /// Rotation vector of the zero in force, rad: attitude and deformation are told from it; `None` without one.
    pub zero: Option<[f64; 3]>,
    /// Valid, but carried forward or of less trust than usual.
    pub reduced: bool,
}
