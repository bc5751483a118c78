//! What inertial units say on their wires: bytes in, values out, and their clocks against the host's.
//!
//! | module | what |
//! |---|---|
//! | [`kvh`], [`stdbin`], [`stim300`] | the frames of a device, read and written |
//! | [`Framer`] | frames out of a stream, found again after garbage |
//! | [`Detector`] | which device a stream looks like |
//! | [`Clock`] | a device's time as the host's, by a filter of two states |
//! | [`raw`] | a stream kept with its times of arrival |
//! | [`Unit`] | all of it together: bytes with the time of their arrival in, samples with their time of validity out |
//!
//! Pure: no port, no clock and no thread. The same bytes with the same times of arrival give the same samples.
//!
//! Axes are those of the crate `frames`, x to starboard, y to the bow, z up, where a device defines axes of the vessel, as STDBIN does;
//! otherwise they are those printed on the unit.

mod bytes;
mod clock;
mod count;
mod detector;
mod device;
mod framer;
pub mod kvh;
mod line;
mod port;
pub mod raw;
mod reading;
pub mod stdbin;
pub mod stim300;
mod unit;

pub use clock::Clock;
pub use detector::Detector;
pub use device::{Angle, Device, Family, Rotation};
pub use framer::{Counts, Framer, Look, Protocol};
pub use port::Port;
pub use unit::{Complaint, Heard, Settings, Tally, TimeSource, Unit};
