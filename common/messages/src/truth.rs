use crate::{Header, message};

/// What the simulator knows: for comparison only, never for a filter.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Truth {
    /// `sequence` and `time_ns` are the main unit's.
    pub header: Header,
    /// Total deformation `C_s^m = Exp(dynamic) S`.
    pub q: [f64; 4],
    /// Static part `S`.
    pub static_q: [f64; 4],
    /// Flexure, rad, in m.
    pub dynamic: [f64; 3],
    /// `C_m^n`.
    pub ship: [f64; 4],
    /// Index of the area.
    pub area: u32,
    /// Keeps the size a multiple of 8 without hidden bytes.
    pub reserved: u32,
}

message!(Truth, "deckflex/Truth/1");
