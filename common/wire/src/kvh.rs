//! KVH 1750 and 1775, formats A, B and C, and their built-in test frames.
//!
//! Source: KVH 1775 technical manual 56-0298, message formats. All numbers are big-endian; the check is CRC-32/MPEG-2 over everything
//! before it. Rotation is an angle increment or a rate, in rad or degrees, as the unit was told: nothing in a frame says which.

use crate::bytes::{Reader, put_triad};
use crate::framer::{Look, Protocol};
use crc::{CRC_32_MPEG_2, Crc};

pub(crate) const CRC: Crc<u32> = Crc::<u32>::new(&CRC_32_MPEG_2);

const HEADER: [u8; 2] = [0xFE, 0x81];
/// All gyros and accelerometers are valid.
pub const ALL_VALID: u8 = 0x77;
/// The sequence counts to here and starts again at 0.
pub const SEQUENCES: u32 = 128;

/// What a format has beside rotation, acceleration, status and sequence.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Extra {
    /// Format A: the temperature in the unit that the device was told.
    Plain {
        /// In degrees or hundredths, Celsius or Fahrenheit.
        temperature: i16,
    },
    /// Format B: a time stamp as well.
    Stamped {
        /// Microseconds of the device's clock, modulo 2^32.
        microseconds: u32,
        /// As in format A.
        temperature: i16,
    },
    /// Format C: temperature or magnetic field in turn.
    Slow {
        /// By `sequence % 4`: temperature in degrees Celsius, magnetic field about x, y, z in gauss.
        value: f32,
    },
}

/// A frame with inertial data.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inertial {
    /// Rotation about x, y, z in the configured unit.
    pub rotation: [f32; 3],
    /// Acceleration along x, y, z, g.
    pub acceleration: [f32; 3],
    /// What the format adds.
    pub extra: Extra,
    /// Bits 0 to 2: gyros x, y, z valid; bits 4 to 6: accelerometers.
    pub status: u8,
    /// 0 to 127, then again 0.
    pub sequence: u8,
}

impl Inertial {
    /// Whether all gyros are valid.
    pub fn gyros_valid(&self) -> bool {
        self.status & 0x07 == 0x07
    }

    /// Whether all accelerometers are valid.
    pub fn accelerometers_valid(&self) -> bool {
        self.status & 0x70 == 0x70
    }

    /// Appends the frame to a stream.
    pub fn encode(&self, out: &mut Vec<u8>) {
        let begin = out.len();
        out.extend_from_slice(&[HEADER[0], HEADER[1], 0xFF, format_code(&self.extra)]);
        put_triad(out, self.rotation);
        put_triad(out, self.acceleration);
        match self.extra {
            Extra::Plain { .. } => {}
            Extra::Stamped { microseconds, .. } => out.extend_from_slice(&microseconds.to_be_bytes()),
            Extra::Slow { value } => out.extend_from_slice(&value.to_be_bytes()),
        }
        out.extend_from_slice(&[self.status, self.sequence]);
        if let Extra::Plain { temperature } | Extra::Stamped { temperature, .. } = self.extra {
            out.extend_from_slice(&temperature.to_be_bytes());
        }
        let check = CRC.checksum(&out[begin..]);
        out.extend_from_slice(&check.to_be_bytes());
    }
}

fn format_code(extra: &Extra) -> u8 {
    match extra {
        Extra::Plain { .. } => 0x55,
        Extra::Stamped { .. } => 0x56,
        Extra::Slow { .. } => 0x57,
    }
}

/// A frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Frame {
    /// Inertial data.
    Inertial(Inertial),
    /// The answer to a built-in test.
    BuiltInTest {
        /// The result, 6 bytes or with the extended test 8; the rest is 0.
        result: [u8; 8],
        /// Whether it has 8 bytes.
        extended: bool,
    },
}

/// The frames of a KVH unit.
#[derive(Clone, Copy, Debug)]
pub struct Kvh;

impl Protocol for Kvh {
    type Frame = Frame;
    const LONGEST: usize = 40;
    const DISTINCT: bool = true;

    fn look(bytes: &[u8]) -> Look<Frame> {
        let known = bytes.len().min(HEADER.len());
        if bytes[..known] != HEADER[..known] {
            return Look::Foreign;
        }
        let length = match (bytes.get(2), bytes.get(3)) {
            (None, _) | (Some(0xFF | 0x00), None) => return Look::Short,
            (Some(0xFF), Some(0x55)) => 36,
            (Some(0xFF), Some(0x56)) => 40,
            (Some(0xFF), Some(0x57)) => 38,
            (Some(0x00), Some(0xAA)) => 11,
            (Some(0x00), Some(0xAB)) => 13,
            _ => return Look::Foreign,
        };
        let Some(bytes) = bytes.get(..length) else { return Look::Short };
        let frame = if bytes[2] == 0 { test(bytes) } else { inertial(bytes) };
        frame.map_or(Look::Damaged, |frame| Look::Whole { frame, length })
    }
}

fn inertial(bytes: &[u8]) -> Option<Frame> {
    let (data, check) = bytes.split_at(bytes.len() - 4);
    if CRC.checksum(data).to_be_bytes() != *check {
        return None;
    }
    let mut reader = Reader::new(&data[4..]);
    let (rotation, acceleration) = (reader.triad(), reader.triad());
    let (mut microseconds, mut value) = (0, 0.0);
    match data[3] {
        0x56 => microseconds = reader.u32(),
        0x57 => value = reader.f32(),
        _ => {}
    }
    let (status, sequence) = (reader.u8(), reader.u8());
    let extra = match data[3] {
        0x55 => Extra::Plain { temperature: reader.i16() },
        0x56 => Extra::Stamped { microseconds, temperature: reader.i16() },
        _ => Extra::Slow { value },
    };
    Some(Frame::Inertial(Inertial { rotation, acceleration, extra, status, sequence }))
}

fn test(bytes: &[u8]) -> Option<Frame> {
    let (data, check) = bytes.split_at(bytes.len() - 1);
    let sum = data.iter().fold(0u8, |sum, byte| sum.wrapping_add(*byte));
    let mut result = [0; 8];
    result[..data.len() - 4].copy_from_slice(&data[4..]);
    (sum == check[0]).then_some(Frame::BuiltInTest { result, extended: data[3] == 0xAB })
}
