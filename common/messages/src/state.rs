use crate::{Header, message};

/// How many bytes of a state travel in one message.
pub const STATE_PART: usize = 664;

/// A part of an estimator's state, from which another estimator can go on as if it were that one. Sent when somebody who records wishes for it.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StatePart {
    /// That of the last pair that the state has seen.
    pub header: Header,
    /// Length of the whole state, bytes.
    pub length: u64,
    /// Where in it this part begins; parts come in order.
    pub offset: u64,
    /// Index of the area.
    pub area: u32,
    /// Unused.
    pub reserved: u32,
    /// The part; 0 behind the state's end.
    pub bytes: [u8; STATE_PART],
}

impl Default for StatePart {
    fn default() -> Self {
        Self { header: Header::default(), length: 0, offset: 0, area: 0, reserved: 0, bytes: [0; STATE_PART] }
    }
}

message!(StatePart, "deckflex/StatePart/1");

/// Somebody who records begins a file, and wishes for a state now and every minute from now on. Latched.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StateWish {
    /// Without a time.
    pub header: Header,
}

message!(StateWish, "deckflex/StateWish/1");
