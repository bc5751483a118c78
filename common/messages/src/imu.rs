use crate::{Flags, Header, message};

/// One sample of an inertial unit, in the unit's own axes.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ImuSample {
    /// `sequence` is the unit's sample number, `time_ns` the end of the interval.
    pub header: Header,
    /// The interval that the increments cover.
    pub interval_ns: i64,
    /// How many samples of this unit the source had handed out before. A gap here says that the transport lost some, a gap in
    /// the header's sequence that the unit did.
    pub ordinal: u64,
    /// Angle increment, rad.
    pub dtheta: [f64; 3],
    /// Velocity increment by specific force, m/s.
    pub dvel: [f64; 3],
    /// What the source saw.
    pub flags: Flags,
    /// 0 for the main unit, otherwise 1 + the index of the area.
    pub unit: u32,
}

message!(ImuSample, "deckflex/ImuSample/1");
