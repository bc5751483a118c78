use crate::{Header, message};

/// How a unit's wire and clock do: published once a second by `acquire`. Latched.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LineHealth {
    /// Those of the unit's last sample.
    pub header: Header,
    /// When the last bytes came, ns of the host's monotonic clock; 0 before any.
    pub arrival_ns: i64,
    /// The device's own time of the last sample, unwrapped, ns.
    pub device_ns: i64,
    /// By how much the host's clock is faster than the device's, a ratio.
    pub skew: f64,
    /// Standard deviation of the arrivals' delay, s.
    pub jitter: f64,
    /// Standard deviation of the error of the mapped times as the clock filter knows it, without the constant latency, s.
    pub sigma: f64,
    /// Frames with a right check.
    pub good: u64,
    /// Frames with a wrong check.
    pub damaged: u64,
    /// Bytes that belong to no good frame.
    pub skipped: u64,
    /// Frames without a sample.
    pub others: u64,
    /// Samples that the device counted and that never came.
    pub lost: u64,
    /// Places where samples were lost.
    pub gaps: u64,
    /// Samples that came again or out of order.
    pub disordered: u64,
    /// Samples that the device itself called invalid.
    pub invalid: u64,
    /// Samples that came before the clock had settled.
    pub unsettled: u64,
    /// How often the device's clock started anew.
    pub restarts: u64,
    /// Pieces of the stream dropped inside the process because it did not keep up.
    pub overflow: u64,
    /// Pieces that could not be kept in the file of raw bytes.
    pub unkept: u64,
    /// How often the port was opened.
    pub opened: u64,
    /// UTC, ns since 1970, minus the host's monotonic clock by the last sample that told it; 0 before any.
    pub utc_offset_ns: i64,
    /// The time of that sample, ns of the host's monotonic clock.
    pub utc_at_ns: i64,
    /// Samples whose time is the device's own.
    pub by_device: u64,
    /// Samples whose time by the device was too far off that by the clock filter, which was taken.
    pub disagreeing: u64,
    /// 0 for the main unit, otherwise 1 + the index of the area.
    pub unit: u32,
    /// 1 while the clock filter's times are of use.
    pub settled: u32,
}

message!(LineHealth, "deckflex/LineHealth/3");
