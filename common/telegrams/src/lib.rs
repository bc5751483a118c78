//! What goes out on the ship's wires: from solutions to NMEA 0183 sentences and Kongsberg's binary.
//!
//! Signs inside are those of the crate `frames`: heading clockwise from north, roll positive with the port side up, pitch positive
//! with the bow up. What each telegram makes of them stands at its encoder.
//!
//! | telegram | content | when invalid |
//! |---|---|---|
//! | `--HDT` | heading | empty field |
//! | `--ROT` | rate of turn, degrees a minute, positive to starboard | empty field, status `V` |
//! | `PASHR` | UTC, heading, roll, pitch, their sigmas | empty fields, quality 0 |
//! | `PRDID` | pitch, roll, heading | empty fields |
//! | `PHTRO` | pitch, roll, each with a letter for its sign | empty fields |
//! | `--XDR` | deformation about x, y, z and its 95 % range, five decimals; the zero where one is in force | empty fields |
//! | KMB | UTC in nanoseconds, attitude, rates, sigmas | status bits |

mod attitude;
mod cadence;
mod kmb;
mod motion;
mod report;
mod sentence;
mod talker;
mod track;
mod utc;

pub use attitude::{Attitude, Axes};
pub use cadence::Cadence;
pub use kmb::{LENGTH as KMB_LENGTH, encode as encode_kmb};
pub use motion::{LONGEST_NS, Motion};
pub use report::{Deformation, Report};
pub use sentence::{Sentence, Style};
pub use talker::Talker;
pub use track::{Moment, Track, instant_ns};
pub use utc::{UtcMap, time_of_day};
