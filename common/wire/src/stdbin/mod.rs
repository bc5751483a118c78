//! iXblue and Exail STDBIN, "BINARY NAV", versions 2 to 5: PHINS, OCTANS, HYDRINS, Quadrans.
//!
//! Source: the field tables of ixblue_stdbin_decoder. All numbers are big-endian; the check is the sum of all bytes before it. The
//! vessel's axes are x to the bow, y to port, z up; roll is positive with the port side up, pitch with the bow DOWN.
//!
//! The rotation rate of navigation block 5 is free of the earth's rate, unlike a gyro: it is not even decoded.

mod blocks;
mod utc;

pub use blocks::{Group, Masks};

use crate::bytes::{Reader, put_triad};
use crate::framer::{Look, Protocol};

/// Bit of the navigation mask: heading, roll, pitch.
const ATTITUDE: u32 = 0;
const ATTITUDE_DEVIATION: u32 = 1;
const POSITION: u32 = 7;
const DATE: u32 = 13;
const QUATERNION: u32 = 26;
const ACCELERATION: u32 = 28;
/// Bit of the extended mask: rotation rate with the earth's rate.
const ROTATION: u32 = 2;

/// Bit of the mask of external sensors: that and when UTC came.
const UTC: u32 = 0;

/// A tick of the validity time, ns.
pub const TICK_NS: i64 = 100_000;
/// No telegram has more bytes: all blocks together.
const LONGEST: usize = 2048;
/// A longer answer is taken for garbage.
const LONGEST_ANSWER: usize = 1024;

/// What a telegram says, as far as it is of use here.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Telegram {
    /// 2 to 5.
    pub version: u8,
    /// Which blocks it had.
    pub masks: Masks,
    /// Time of validity, ticks of 100 us, of the day or since the start.
    pub time: u32,
    /// Number of the telegram.
    pub counter: u32,
    /// Heading, roll, pitch, degrees.
    pub attitude: Option<[f32; 3]>,
    /// Standard deviations of heading, roll, pitch, degrees.
    pub attitude_deviation: Option<[f32; 3]>,
    /// Latitude and longitude, degrees.
    pub position: Option<[f64; 2]>,
    /// Day, month and year.
    pub date: Option<[u16; 3]>,
    /// Scalar first: turns a vector seen in north, west, up into the same vector seen in the vessel's axes.
    pub quaternion: Option<[f32; 4]>,
    /// Specific force along the vessel's axes, m/s^2, gravity included.
    pub acceleration: Option<[f32; 3]>,
    /// Rotation rate about the vessel's axes, deg/s, the earth's rate included.
    pub rotation: Option<[f32; 3]>,
    /// Time of validity of the UTC that the device was told last, ticks.
    pub utc: Option<u32>,
}

/// A frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Frame {
    /// Navigation data.
    Telegram(Telegram),
    /// The answer to a command.
    Answer,
}

/// The frames of an STDBIN device.
#[derive(Clone, Copy, Debug)]
pub struct Stdbin;

impl Protocol for Stdbin {
    type Frame = Frame;
    const LONGEST: usize = LONGEST;
    const DISTINCT: bool = true;

    fn look(bytes: &[u8]) -> Look<Frame> {
        match (bytes[0], bytes.get(1), bytes.get(2)) {
            (b'I' | b'A', None, _) | (b'I', Some(b'X'), None) | (b'A', Some(b'N'), None) => Look::Short,
            (b'I', Some(b'X'), Some(2..=5)) => telegram(bytes),
            (b'A', Some(b'N'), Some(3..=5)) => answer(bytes),
            _ => Look::Foreign,
        }
    }
}

fn header_length(version: u8) -> usize {
    match version {
        2 => 21,
        3 => 25,
        _ => 27,
    }
}

fn telegram(bytes: &[u8]) -> Look<Frame> {
    let version = bytes[2];
    let header = header_length(version);
    if bytes.len() < header {
        return Look::Short;
    }
    let mut reader = Reader::new(&bytes[3..header]);
    let navigation = reader.u32();
    let extended = if version >= 3 { reader.u32() } else { 0 };
    let masks = Masks { navigation, extended, external: reader.u32() };
    if version >= 4 {
        reader.skip(2);
    }
    let length = usize::from(reader.u16());
    // by chance hardly so in other bytes, whose length would then be waited for
    if masks.size().is_none_or(|size| header + size + 4 != length) {
        return Look::Foreign;
    }
    let Some(bytes) = bytes.get(..length) else { return Look::Short };
    if !sum_is_right(bytes) {
        return Look::Damaged;
    }
    let mut told = Telegram { version, masks, time: reader.u32(), counter: reader.u32(), ..Telegram::default() };
    told.fill(&bytes[header..length - 4]);
    Look::Whole { frame: Frame::Telegram(told), length }
}

fn answer(bytes: &[u8]) -> Look<Frame> {
    let Some(head) = bytes.get(..5) else { return Look::Short };
    let length = usize::from(u16::from_be_bytes([head[3], head[4]]));
    if !(9..=LONGEST_ANSWER).contains(&length) {
        return Look::Foreign;
    }
    match bytes.get(..length) {
        None => Look::Short,
        Some(bytes) if sum_is_right(bytes) => Look::Whole { frame: Frame::Answer, length },
        Some(_) => Look::Damaged,
    }
}

fn sum(bytes: &[u8]) -> u32 {
    bytes.iter().fold(0u32, |sum, byte| sum.wrapping_add(u32::from(*byte)))
}

fn sum_is_right(bytes: &[u8]) -> bool {
    let (data, check) = bytes.split_at(bytes.len() - 4);
    sum(data).to_be_bytes() == *check
}

impl Telegram {
    fn fill(&mut self, mut data: &[u8]) {
        for (group, bit, size) in self.masks.blocks() {
            let (block, rest) = data.split_at(size.min(data.len()));
            data = rest;
            let mut reader = Reader::new(block);
            match (group, bit) {
                (Group::Navigation, ATTITUDE) => self.attitude = Some(reader.triad()),
                (Group::Navigation, ATTITUDE_DEVIATION) => self.attitude_deviation = Some(reader.triad()),
                (Group::Navigation, POSITION) => self.position = Some([reader.f64(), reader.f64()]),
                (Group::Navigation, DATE) => {
                    let [day, month] = [reader.u8(), reader.u8()].map(u16::from);
                    self.date = Some([day, month, reader.u16()]);
                }
                (Group::Navigation, QUATERNION) => {
                    let scalar = reader.f32();
                    let [x, y, z] = reader.triad();
                    self.quaternion = Some([scalar, x, y, z]);
                }
                (Group::Navigation, ACCELERATION) => self.acceleration = Some(reader.triad()),
                (Group::Extended, ROTATION) => self.rotation = Some(reader.triad()),
                (Group::External, UTC) => self.utc = Some(reader.u32()),
                _ => {}
            }
        }
    }

    /// Appends a telegram of the fields that have a value to a stream; `masks` is not looked at.
    ///
    /// Version 2 has no place for `rotation`, which is then left out.
    pub fn encode(&self, out: &mut Vec<u8>) {
        let begin = out.len();
        let masks = self.masks_of_fields();
        let header = header_length(self.version);
        let length = header + masks.size().unwrap_or(0) + 4;
        out.extend_from_slice(&[b'I', b'X', self.version]);
        out.extend_from_slice(&masks.navigation.to_be_bytes());
        if self.version >= 3 {
            out.extend_from_slice(&masks.extended.to_be_bytes());
        }
        out.extend_from_slice(&masks.external.to_be_bytes());
        if self.version >= 4 {
            out.extend_from_slice(&(masks.navigation_size() as u16).to_be_bytes());
        }
        out.extend_from_slice(&(length as u16).to_be_bytes());
        out.extend_from_slice(&self.time.to_be_bytes());
        out.extend_from_slice(&self.counter.to_be_bytes());
        self.attitude.iter().chain(&self.attitude_deviation).for_each(|v| put_triad(out, *v));
        if let Some([latitude, longitude]) = self.position {
            out.extend_from_slice(&latitude.to_be_bytes());
            out.extend_from_slice(&longitude.to_be_bytes());
            out.extend_from_slice(&[0; 5]);
        }
        if let Some([day, month, year]) = self.date {
            out.extend_from_slice(&[day as u8, month as u8]);
            out.extend_from_slice(&year.to_be_bytes());
        }
        if let Some([scalar, x, y, z]) = self.quaternion {
            out.extend_from_slice(&scalar.to_be_bytes());
            put_triad(out, [x, y, z]);
        }
        self.acceleration.iter().for_each(|v| put_triad(out, *v));
        self.rotation.iter().filter(|_| self.version >= 3).for_each(|v| put_triad(out, *v));
        if let Some(utc) = self.utc {
            out.extend_from_slice(&utc.to_be_bytes());
            out.push(0);
        }
        let check = sum(&out[begin..]);
        out.extend_from_slice(&check.to_be_bytes());
    }

    fn masks_of_fields(&self) -> Masks {
        let bit = |has: bool, bit: u32| u32::from(has) << bit;
        let navigation = bit(self.attitude.is_some(), ATTITUDE)
            | bit(self.attitude_deviation.is_some(), ATTITUDE_DEVIATION)
            | bit(self.position.is_some(), POSITION)
            | bit(self.date.is_some(), DATE)
            | bit(self.quaternion.is_some(), QUATERNION)
            | bit(self.acceleration.is_some(), ACCELERATION);
        let extended = bit(self.rotation.is_some() && self.version >= 3, ROTATION);
        Masks { navigation, extended, external: bit(self.utc.is_some(), UTC) }
    }
}
