use crate::{Header, message};

/// The attitude of the ship at the main unit, as its INS gives it.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MainAttitude {
    /// `sequence` and `time_ns` are those of the main unit's sample that the attitude belongs to.
    pub header: Header,
    /// `C_m^n`.
    pub q: [f64; 4],
    /// Standard deviation of its error about east, north, up, rad.
    pub sigma: [f64; 3],
}

message!(MainAttitude, "deckflex/MainAttitude/1");
