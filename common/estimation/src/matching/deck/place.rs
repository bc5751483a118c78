//! Places of the error states: those of [`crate::matching::so3`], then these.

pub use crate::matching::so3::place::*;

/// Relative velocity by the accelerometers, in the main unit's starting axes.
pub const VELOCITY: usize = 33;
/// Relative accelerometer bias, in s.
pub const ACCEL_BIAS: usize = 36;
/// Angle from the sub unit's gyros to its accelerometers, in s.
pub const TRIAD: usize = 39;
/// How much of the flexure bends the lever arm, per axis.
pub const GAIN: usize = 42;
/// Lever arm, in m.
pub const ARM: usize = 45;
/// Rest of the delay.
pub const DELAY: usize = 48;
/// Skew.
pub const SKEW: usize = 49;
