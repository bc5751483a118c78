//! What an emulated device says of a sample.

use frames::unit::{DEGREE, STANDARD_GRAVITY};
use frames::{Nav, Rot};
use messages::{ImuSample, MainAttitude};
use wire::kvh::{self, Extra};
use wire::stdbin::Telegram;
use wire::stim300::{self, Cluster, Datagram};
use wire::{Angle, Device, Rotation};

/// Format of a KVH unit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum KvhFormat {
    /// No time but the sequence number.
    A,
    /// With microseconds.
    #[default]
    B,
    /// Temperature and magnetic field in turn.
    C,
}

/// An emulated device.
pub struct Voice {
    device: Device,
    format: KvhFormat,
    interval_ns: i64,
    begin_utc_ns: Option<i64>,
}

impl Voice {
    pub fn new(device: Device, format: KvhFormat, interval_ns: i64) -> Self {
        Self { device, format, interval_ns, begin_utc_ns: None }
    }

    /// From now on the device is told UTC, by which sample 0 was at this time, ns since 1970.
    pub fn tell_utc(&mut self, begin_ns: i64) {
        self.begin_utc_ns = Some(begin_ns);
    }

    /// The frame of a sample, in the device's own time: its clock counts nominal intervals.
    pub fn frame(&self, sample: &ImuSample, attitude: Option<&MainAttitude>) -> Vec<u8> {
        let mut out = Vec::with_capacity(128);
        match self.device {
            Device::Kvh { rotation, angle } => self.kvh(sample, rotation, angle).encode(&mut out),
            Device::Stdbin => self.stdbin(sample, attitude).encode(&mut out),
            Device::Stim300 { rotation, force_exponent } => {
                self.stim300(sample, rotation, force_exponent).encode(&mut out);
            }
        }
        out
    }

    fn interval(&self) -> f64 {
        self.interval_ns as f64 * 1e-9
    }

    fn device_ns(&self, sample: &ImuSample) -> i64 {
        sample.header.sequence as i64 * self.interval_ns
    }

    fn kvh(&self, sample: &ImuSample, rotation: Rotation, angle: Angle) -> kvh::Inertial {
        let unit = match angle {
            Angle::Radians => 1.0,
            Angle::Degrees => DEGREE,
        };
        let over = match rotation {
            Rotation::Delta => 1.0,
            Rotation::Rate => self.interval(),
        };
        let temperature = 25;
        kvh::Inertial {
            rotation: sample.dtheta.map(|v| (v / (unit * over)) as f32),
            acceleration: sample.dvel.map(|v| (v / (STANDARD_GRAVITY * self.interval())) as f32),
            extra: match self.format {
                KvhFormat::A => Extra::Plain { temperature },
                KvhFormat::B => Extra::Stamped { microseconds: (self.device_ns(sample) / 1000) as u32, temperature },
                KvhFormat::C => Extra::Slow { value: f32::from(temperature) },
            },
            status: kvh::ALL_VALID,
            sequence: (sample.header.sequence % u64::from(kvh::SEQUENCES)) as u8,
        }
    }

    fn stdbin(&self, sample: &ImuSample, attitude: Option<&MainAttitude>) -> Telegram {
        // starboard, bow, up into bow, port, up
        let vessel = |v: [f64; 3], unit: f64| [v[1], -v[0], v[2]].map(|v| (v / (unit * self.interval())) as f32);
        let euler = attitude.map(|attitude| Rot::<Nav, Nav>::from_wxyz(attitude.q).euler());
        let degrees = |angles: [f64; 3]| angles.map(|angle| (angle / DEGREE) as f32);
        let rounded_ns = self.device_ns(sample) + wire::stdbin::TICK_NS / 2;
        let told = Telegram {
            version: 3,
            time: (rounded_ns / wire::stdbin::TICK_NS % 864_000_000) as u32,
            counter: sample.header.sequence as u32,
            attitude: euler.map(|euler| degrees([euler.heading, euler.roll, -euler.pitch])),
            attitude_deviation: attitude.map(|attitude| {
                let [east, north, up] = attitude.sigma;
                degrees([up, east.max(north), east.max(north)])
            }),
            acceleration: Some(vessel(sample.dvel, 1.0)),
            rotation: Some(vessel(sample.dtheta, DEGREE)),
            ..Telegram::default()
        };
        self.begin_utc_ns.map_or(told, |begin_ns| told.at_utc(begin_ns + rounded_ns))
    }

    fn stim300(&self, sample: &ImuSample, rotation: Rotation, force_exponent: i32) -> Datagram {
        let scale = match rotation {
            Rotation::Delta => stim300::ANGLE_DEG,
            Rotation::Rate => stim300::RATE_DEG_PER_S * self.interval(),
        };
        let force = STANDARD_GRAVITY * 2f64.powi(-force_exponent) * self.interval();
        let cluster = |v: [f64; 3], unit: f64| Cluster { values: v.map(|v| (v / unit).round() as i32), status: 0 };
        Datagram {
            id: 0x91,
            gyro: cluster(sample.dtheta, scale * DEGREE),
            acceleration: Some(cluster(sample.dvel, force)),
            counter: (self.device_ns(sample) / stim300::COUNT_NS % i64::from(stim300::COUNTS)) as u8,
            ..Datagram::default()
        }
    }
}
