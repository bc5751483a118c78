//! The messages that the stages exchange, and the one table of topics that carry them.
//!
//! Every message is a `repr(C)` struct of numbers and arrays, so that a program in another language can read it, with a name
//! that ends in its version: whoever changes a field changes the number. Rotations are quaternions `[w, x, y, z]` and
//! "A from B" as in the crate `frames`; covariances are row-major 3 by 3 in rad^2; times are nanoseconds.

mod alarms;
mod flags;
mod header;
mod health;
mod imu;
mod line_health;
mod main_attitude;
mod output;
mod pair;
mod parameters;
mod solution;
mod state;
pub mod topic;
mod truth;

pub use alarms::Alarms;
pub use flags::Flags;
pub use header::{ClockDomain, Header, Stamps};
pub use health::{Health, Scheduling, Stage, State};
pub use imu::ImuSample;
pub use line_health::LineHealth;
pub use main_attitude::MainAttitude;
pub use output::{OutputState, UtcSource};
pub use pair::ImuPair;
pub use parameters::FlexureParams;
pub use solution::Solution;
pub use state::{STATE_PART, StatePart, StateWish};
pub use truth::Truth;

/// A type that travels between processes: plain data of fixed layout, every bit pattern of which is a value.
///
/// # Safety
/// The type is `repr(C)`, holds no pointer, no reference and no enum, and is valid for every bit pattern.
pub unsafe trait Message: Copy + Default + std::fmt::Debug + Send + Sync + 'static {
    /// The identity of the layout, `deckflex/<Type>/<version>`.
    const TYPE_NAME: &'static str;
    /// The header that every message begins with.
    fn header(&self) -> &Header;
    /// The header, to be written.
    fn header_mut(&mut self) -> &mut Header;
}

macro_rules! message {
    ($type:ty, $name:literal) => {
        // SAFETY: repr(C), numbers and arrays of numbers only; the layout tests pin it.
        unsafe impl $crate::Message for $type {
            const TYPE_NAME: &'static str = $name;
            fn header(&self) -> &$crate::Header {
                &self.header
            }
            fn header_mut(&mut self) -> &mut $crate::Header {
                &mut self.header
            }
        }
    };
}
pub(crate) use message;
