use crate::{Flags, Header, message};

/// What both units felt up to one instant of the main unit, in body axes (mounting applied).
///
/// The accumulated attitudes carry everything since the epoch's start, so a pair that is lost on the way loses only time.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ImuPair {
    /// `sequence` and `time_ns` are the main unit's.
    pub header: Header,
    /// The main sample number at which the accumulated attitudes start.
    pub epoch: u64,
    /// The interval of the increments: since the main unit's previous sample.
    pub interval_ns: i64,
    /// Angle increment of the main unit, rad, in m.
    pub dtheta_m: [f64; 3],
    /// Velocity increment of the main unit, m/s, in m.
    pub dvel_m: [f64; 3],
    /// Angle increment of the sub unit, rad, in s.
    pub dtheta_s: [f64; 3],
    /// Velocity increment of the sub unit, m/s, in s.
    pub dvel_s: [f64; 3],
    /// `C_m^m0`: the main unit's axes from where they stood at the epoch's start, by its gyros alone.
    pub attitude_m: [f64; 4],
    /// `C_s^s0`: the same of the sub unit.
    pub attitude_s: [f64; 4],
    /// `C_m^n` from the main INS; all zeros when there is none for this instant.
    pub ins: [f64; 4],
    /// Standard deviation of `ins` about east, north, up, rad.
    pub ins_sigma: [f64; 3],
    /// Standard deviation, per axis, of the angle error that entered the accumulated attitudes with this pair beyond the units'
    /// noise, because samples were bridged or at the end of their range; rad.
    pub disturbance: f64,
    /// Index of the area.
    pub area: u32,
    /// What happened to the data of this pair.
    pub flags: Flags,
}

message!(ImuPair, "deckflex/ImuPair/1");
