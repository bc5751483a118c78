use serde::{Deserialize, Serialize};

/// What every message begins with.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Header {
    /// Which run the message belongs to; kept by a stage that is restarted.
    pub run_id: u64,
    /// For samples the unit's sample number; for pairs and solutions the MAIN unit's sample number.
    pub sequence: u64,
    /// Time of validity in the clock domain, the only time that the mathematics sees.
    pub time_ns: i64,
    /// The clock that `time_ns` is of, see [`ClockDomain`].
    pub clock_domain: u32,
    /// 1 for the mark that ends a stream, which carries no data; otherwise 0.
    pub end: u32,
    /// When the stages handled the data, on the host's monotonic clock; only the latency code sees them.
    pub stamps: Stamps,
}

impl Header {
    /// Whether this is the mark that ends a stream.
    pub fn is_end(&self) -> bool {
        self.end != 0
    }
}

/// Instants of the host's monotonic clock in nanoseconds; 0 where the message has not been.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Stamps {
    /// When the main unit's sample was due.
    pub due_ns: i64,
    /// When the source published the main unit's sample.
    pub source_ns: i64,
    /// When the source published the last sample that the pair needed: what lies between is the algorithm's wait.
    pub complete_ns: i64,
    /// When `synchronise` published the pair.
    pub pair_ns: i64,
    /// When `estimate` published the solution.
    pub solution_ns: i64,
    /// When `identify` published the parameters.
    pub parameters_ns: i64,
}

/// The values of [`Header::clock_domain`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum ClockDomain {
    /// Seconds since the start of a simulated run.
    Simulated = 0,
    /// The time column of a recording.
    Recorded = 1,
    /// The host's monotonic clock.
    HostMonotonic = 2,
}
