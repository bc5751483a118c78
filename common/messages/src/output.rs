use crate::{Header, message};

/// What one destination of `output` has been sent: published once a second and at the end. Latched. Counts are those of the process.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct OutputState {
    /// `sequence` and `time_ns` are those of the last solution that was told.
    pub header: Header,
    /// Telegrams that went out; all sentences of an instant are one.
    pub sent: u64,
    /// Of these, those that said that the attitude is invalid.
    pub invalid: u64,
    /// Of these, those whose attitude was carried forward.
    pub extrapolated: u64,
    /// Telegrams that could not be sent: a full or broken line.
    pub unsendable: u64,
    /// Telegrams that were not sent because they were too old or not later than the one before.
    pub withheld: u64,
    /// Of those that went out, those whose area has a zero in force.
    pub zeroed: u64,
    /// UTC minus the host's monotonic clock, as used at present, ns.
    pub utc_offset_ns: i64,
    /// Age of the measurement behind it, ns.
    pub utc_age_ns: i64,
    /// How wrong the source of UTC says that it may be, ns; negative where it does not say.
    pub utc_error_ns: i64,
    /// By how much UTC runs ahead of its source since that was set back, ns.
    pub utc_ahead_ns: i64,
    /// From the published solution to the telegram's departure: median, ns.
    pub delay_p50_ns: i64,
    /// What one in 100 exceeds, ns.
    pub delay_p99_ns: i64,
    /// The longest, ns.
    pub delay_max_ns: i64,
    /// See [`UtcSource`].
    pub utc_source: u32,
    /// Index of the destination in the configuration.
    pub output: u32,
    /// Index of the area.
    pub area: u32,
    /// 1 while the destination takes telegrams.
    pub open: u32,
}

message!(OutputState, "deckflex/OutputState/2");

/// Where UTC comes from: the values of [`OutputState::utc_source`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum UtcSource {
    /// The host's clock, which the operating system does not hold for synchronised.
    HostFree = 0,
    /// The host's clock, synchronised.
    Host = 1,
    /// The telegrams of the main unit's INS.
    Ins = 2,
}

impl UtcSource {
    /// The source of a code; `None` if it has no meaning.
    pub fn from_code(code: u32) -> Option<Self> {
        match code {
            0 => Some(Self::HostFree),
            1 => Some(Self::Host),
            2 => Some(Self::Ins),
            _ => None,
        }
    }

    /// The name in tables and files.
    pub fn name(self) -> &'static str {
        match self {
            Self::HostFree => "host, not synchronised",
            Self::Host => "host",
            Self::Ins => "INS",
        }
    }
}
