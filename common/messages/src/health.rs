use crate::{Alarms, Header, message};

/// How a stage does: published when it is ready, once a second, and when it ends. Latched.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Health {
    /// `sequence` is the last main sample number handled, `time_ns` its time.
    pub header: Header,
    /// Samples, pairs or solutions taken in.
    pub taken: u64,
    /// Messages published.
    pub given: u64,
    /// Messages that never arrived, by gaps in their sequence.
    pub lost: u64,
    /// Samples of a unit that were missing in its own stream.
    pub missing: u64,
    /// Samples refused: not finite, repeated, or stamped before their predecessor.
    pub refused: u64,
    /// Samples taken at the end of the measuring range or with stuck channels.
    pub suspect: u64,
    /// Messages dropped inside the process because a slow thread did not keep up.
    pub overflow: u64,
    /// Parameter sets that came after the time from which they were to be in force.
    pub late: u64,
    /// Windows that were started anew by a gap.
    pub restarted_windows: u64,
    /// See [`Stage`].
    pub stage: u32,
    /// Index of the area; `u32::MAX` for a stage that serves all.
    pub area: u32,
    /// See [`State`].
    pub state: u32,
    /// The scheduling really obtained, see [`Scheduling`].
    pub scheduling: u32,
    /// The process.
    pub pid: u32,
    /// Limits of the area that have been crossed, as `estimate` sees them.
    pub alarms: Alarms,
}

message!(Health, "deckflex/Health/2");

macro_rules! code {
    ($(#[$doc:meta])* $name:ident { $($(#[$vdoc:meta])* $variant:ident = $number:literal => $text:literal),* $(,)? }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        #[repr(u32)]
        pub enum $name { $($(#[$vdoc])* $variant = $number),* }
        impl $name {
            /// The code of a message; `None` if it has no meaning.
            pub fn from_code(code: u32) -> Option<Self> {
                match code { $($number => Some(Self::$variant),)* _ => None }
            }
            /// The name in tables and files.
            pub fn name(self) -> &'static str {
                match self { $(Self::$variant => $text),* }
            }
        }
    };
}

code! {
    /// A stage of the pipeline.
    Stage {
        /// Simulated units.
        Simulate = 0 => "simulate",
        /// Recorded units.
        Replay = 1 => "replay",
        /// Time synchronisation.
        Synchronise = 2 => "synchronise",
        /// The fast estimator.
        Estimate = 3 => "estimate",
        /// The slow identifier.
        Identify = 4 => "identify",
        /// Units on wires.
        Acquire = 5 => "acquire",
        /// Telegrams on the ship's wires.
        Output = 6 => "output",
        /// The recorder.
        Record = 7 => "record",
    }
}

code! {
    /// What a stage is doing.
    State {
        /// Connected and waiting for data.
        Ready = 0 => "ready",
        /// Handling data.
        Running = 1 => "running",
        /// The stream ended and everything has been worked off.
        Ended = 2 => "ended",
    }
}

code! {
    /// The scheduling class that the operating system granted.
    Scheduling {
        /// The ordinary time-sharing class.
        Normal = 0 => "normal",
        /// Real-time, first in first out.
        Fifo = 1 => "fifo",
        /// Time-sharing at a low priority.
        Low = 2 => "low",
    }
}
