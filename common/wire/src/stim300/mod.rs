//! Safran (Sensonor) STIM300: all datagrams with samples, and the one that tells the configuration.
//!
//! Source: data sheet TS1524 rev 31. All numbers are big-endian, most of 24 bits; the check is CRC-32/MPEG-2 over everything before it
//! and zeros up to a multiple of four bytes, which are not sent. Datagrams may end with carriage return and line feed.

mod configuration;

pub use configuration::{Configuration, GyroUnit};

use crate::bytes::{Reader, put_i24};
use crate::framer::{Look, Protocol};
use crate::kvh::CRC;

/// The sample counter has so many values.
pub const COUNTS: u32 = 256;
/// A count of the sample counter: one of the 2000 Hz at which the device itself samples, ns.
pub const COUNT_NS: i64 = 500_000;
/// Of a rate, deg/s.
pub const RATE_DEG_PER_S: f64 = 1.0 / (1 << 14) as f64;
/// Of an incremental or integrated angle, degrees.
pub const ANGLE_DEG: f64 = 1.0 / (1 << 21) as f64;

/// The unit of specific force with an accelerometer range in g: g times 2 to minus this.
pub fn force_exponent(range_g: u16) -> Option<i32> {
    match range_g {
        5 => Some(20),
        10 => Some(19),
        30 => Some(18),
        80 => Some(16),
        _ => None,
    }
}

/// From what the gyros felt to the filtered sample, ns, with a low-pass filter of so many Hz.
pub fn group_delay_ns(low_pass_hz: u16) -> Option<i64> {
    match low_pass_hz {
        262 => Some(2_200_000),
        131 => Some(3_700_000),
        66 => Some(6_700_000),
        33 => Some(12_700_000),
        16 => Some(24_700_000),
        _ => None,
    }
}

/// What a datagram holds beside the gyros.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Content {
    /// Accelerometers.
    pub acceleration: bool,
    /// Inclinometers.
    pub inclination: bool,
    /// Temperatures of every cluster that is there.
    pub temperature: bool,
    /// Time since the last pulse, or in older firmware the auxiliary input.
    pub auxiliary: bool,
}

/// By contents, in the order of the bits acceleration, inclination, temperature: without and with the auxiliary word. The ids of the
/// older firmware's auxiliary input are the last ones.
const IDS: [(u8, u8, u8); 8] = [
    (0x90, 0xF0, 0x98),
    (0x91, 0xF1, 0x99),
    (0x92, 0xF2, 0x9A),
    (0x93, 0xF3, 0x9B),
    (0x94, 0xF4, 0x9C),
    (0xA5, 0xF5, 0xAD),
    (0xA6, 0xF6, 0xAE),
    (0xA7, 0xF7, 0xAF),
];

impl Content {
    /// The contents of the datagram of this id.
    pub fn of(id: u8) -> Option<Self> {
        let index = IDS.iter().position(|ids| id == ids.0 || id == ids.1 || id == ids.2)?;
        let bit = |bit: usize| index >> bit & 1 == 1;
        Some(Self { acceleration: bit(0), inclination: bit(1), temperature: bit(2), auxiliary: id != IDS[index].0 })
    }

    /// Bytes of the datagram with its check.
    fn length(self) -> usize {
        let clusters = 1 + usize::from(self.acceleration) + usize::from(self.inclination);
        let temperatures = if self.temperature { 7 * clusters } else { 0 };
        let auxiliary = if self.auxiliary { 4 } else { 0 };
        1 + 10 * clusters + temperatures + auxiliary + 1 + 2 + 4
    }
}

/// Three values and their status: bit 7 integrity, 6 start-up, 5 outside operating conditions, 4 overload, 3 channel error, 2 to 0 which axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Cluster {
    /// About or along x, y, z.
    pub values: [i32; 3],
    /// 0 when all is well.
    pub status: u8,
}

/// A datagram with a sample.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Datagram {
    /// Which contents it has.
    pub id: u8,
    /// In the configured unit.
    pub gyro: Cluster,
    /// In the configured unit and range.
    pub acceleration: Option<Cluster>,
    /// In units of 2^-22 g.
    pub inclination: Option<Cluster>,
    /// Of gyros, accelerometers, inclinometers, in units of 2^-8 degrees Celsius.
    pub temperatures: [Option<Cluster>; 3],
    /// Microseconds since the last pulse, or volts of the auxiliary input in units of 5/2^24; with its status.
    pub auxiliary: Option<(u32, u8)>,
    /// Number of the device's own sample.
    pub counter: u8,
    /// From that sample to the datagram, or to the trigger, us.
    pub latency: u16,
}

/// A frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Frame {
    /// A sample.
    Sample(Datagram),
    /// What the device was told.
    Configuration(Configuration),
    /// Told once at the start: trims of the bias, errors of the device.
    Other,
}

/// The frames of a STIM300.
#[derive(Clone, Copy, Debug)]
pub struct Stim300;

impl Protocol for Stim300 {
    type Frame = Frame;
    const LONGEST: usize = 64;
    const DISTINCT: bool = false;

    fn look(bytes: &[u8]) -> Look<Frame> {
        let length = match bytes[0] {
            b'\r' => {
                return match bytes.get(1) {
                    None => Look::Short,
                    Some(b'\n') => Look::Filler { length: 2 },
                    Some(_) => Look::Foreign,
                };
            }
            0xBC | 0xBD => 26,
            0xD1 | 0xD2 => 40,
            0xBE | 0xBF => 21,
            id => match Content::of(id) {
                Some(content) => content.length(),
                None => return Look::Foreign,
            },
        };
        let Some(bytes) = bytes.get(..length) else { return Look::Short };
        let (data, told) = bytes.split_at(length - 4);
        if check(data).to_be_bytes() != *told {
            return Look::Damaged;
        }
        let frame = match bytes[0] {
            0xBC | 0xBD => Frame::Configuration(Configuration::decode(data)),
            0xD1 | 0xD2 | 0xBE | 0xBF => Frame::Other,
            id => Content::of(id).map_or(Frame::Other, |content| Frame::Sample(Datagram::decode(data, content))),
        };
        Look::Whole { frame, length }
    }
}

fn check(data: &[u8]) -> u32 {
    let mut digest = CRC.digest();
    digest.update(data);
    digest.update(&[0; 3][..(4 - data.len() % 4) % 4]);
    digest.finalize()
}

impl Datagram {
    fn decode(data: &[u8], content: Content) -> Self {
        let mut reader = Reader::new(&data[1..]);
        let cluster =
            |reader: &mut Reader| Cluster { values: [reader.i24(), reader.i24(), reader.i24()], status: reader.u8() };
        let warmth = |reader: &mut Reader| Cluster {
            values: [reader.i16(), reader.i16(), reader.i16()].map(i32::from),
            status: reader.u8(),
        };
        let gyro = cluster(&mut reader);
        let acceleration = content.acceleration.then(|| cluster(&mut reader));
        let inclination = content.inclination.then(|| cluster(&mut reader));
        let temperatures = [true, content.acceleration, content.inclination]
            .map(|present| (content.temperature && present).then(|| warmth(&mut reader)));
        let auxiliary = content.auxiliary.then(|| (reader.u24(), reader.u8()));
        let (counter, latency) = (reader.u8(), reader.u16());
        Self { id: data[0], gyro, acceleration, inclination, temperatures, auxiliary, counter, latency }
    }

    /// Appends the datagram to a stream; `id` must go with the parts that are there.
    pub fn encode(&self, out: &mut Vec<u8>) {
        let begin = out.len();
        out.push(self.id);
        for cluster in [Some(self.gyro), self.acceleration, self.inclination].iter().flatten() {
            cluster.values.iter().for_each(|v| put_i24(out, *v));
            out.push(cluster.status);
        }
        for cluster in self.temperatures.iter().flatten() {
            cluster.values.iter().for_each(|v| out.extend_from_slice(&(*v as i16).to_be_bytes()));
            out.push(cluster.status);
        }
        if let Some((value, status)) = self.auxiliary {
            put_i24(out, value as i32);
            out.push(status);
        }
        out.push(self.counter);
        out.extend_from_slice(&self.latency.to_be_bytes());
        let check = check(&out[begin..]);
        out.extend_from_slice(&check.to_be_bytes());
    }
}
