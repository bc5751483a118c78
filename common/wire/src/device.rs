//! Which device a unit is, and what it was told, as far as its frames do not say it.

use std::fmt;

/// A family of devices that speak alike.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Family {
    /// KVH 1750 and 1775.
    Kvh,
    /// iXblue and Exail STDBIN.
    Stdbin,
    /// Safran STIM300.
    Stim300,
}

impl Family {
    /// The name in configurations.
    pub fn name(self) -> &'static str {
        match self {
            Self::Kvh => "kvh",
            Self::Stdbin => "stdbin",
            Self::Stim300 => "stim300",
        }
    }
}

impl fmt::Display for Family {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Kvh => "KVH 1750 or 1775 (\"kvh\")",
            Self::Stdbin => "iXblue STDBIN (\"stdbin\")",
            Self::Stim300 => "Safran STIM300 (\"stim300\")",
        })
    }
}

/// What the gyros of a device give.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rotation {
    /// The angle since the sample before.
    Delta,
    /// The rate.
    Rate,
}

/// The unit of measure of angles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Angle {
    /// Radians.
    Radians,
    /// Degrees.
    Degrees,
}

/// A device and what it was told.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Device {
    /// KVH 1750 and 1775; the format stands in each frame.
    Kvh {
        /// `=ROTFMT`.
        rotation: Rotation,
        /// `=ROTUNITS`.
        angle: Angle,
    },
    /// iXblue and Exail STDBIN; everything stands in each telegram.
    Stdbin,
    /// Safran STIM300.
    Stim300 {
        /// What its gyros give.
        rotation: Rotation,
        /// Exponent of the unit of specific force: g times 2 to minus this.
        force_exponent: i32,
    },
}

impl Device {
    /// The family.
    pub fn family(&self) -> Family {
        match self {
            Self::Kvh { .. } => Family::Kvh,
            Self::Stdbin => Family::Stdbin,
            Self::Stim300 { .. } => Family::Stim300,
        }
    }
}
