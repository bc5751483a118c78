//! What a frame of any device says about one sample.

use crate::count::Count;
use crate::{Angle, Rotation, kvh, stdbin, stim300};
use frames::unit::{DEGREE, STANDARD_GRAVITY};
use frames::{Euler, Nav, Rot, Vec3};

/// How a device tells the time of a sample.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stamp {
    pub count: Count,
    pub tick_ns: i64,
    /// Whether the tick is so long that the stamps are to be made smooth.
    pub coarse: bool,
    /// The number of the sample where it is another count.
    pub number: Option<Count>,
    /// From the data's own instant to the sending, as the device tells it, ns.
    pub latency_ns: i64,
}

/// A sample in SI units.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Reading {
    pub stamp: Stamp,
    /// rad over the nominal interval; `None` if the device says that it is of no use, or does not give it.
    pub dtheta: Option<[f64; 3]>,
    /// m/s over the nominal interval.
    pub dvel: Option<[f64; 3]>,
    /// Whether the device says that its accelerometers are of no use.
    pub force_invalid: bool,
    /// UTC at the time of the stamp, ns since 1970.
    pub utc_ns: Option<i64>,
    /// Attitude of the vessel, and its standard deviation about east, north, up, rad.
    pub attitude: Option<(Rot<Nav, Nav>, [f64; 3])>,
}

const SEQUENCE: &[u64] = &[kvh::SEQUENCES as u64];
const WHOLE: &[u64] = &[1 << 32];
/// A time of the day starts again at midnight, a time since the start when the number is full.
const DAY: &[u64] = &[864_000_000, 1 << 32];
const COUNTS: &[u64] = &[stim300::COUNTS as u64];

fn scaled(values: [f32; 3], factor: f64) -> [f64; 3] {
    values.map(|v| f64::from(v) * factor)
}

/// From the vessel's axes bow, port, up into starboard, bow, up.
fn body(values: [f64; 3]) -> [f64; 3] {
    [-values[1], values[0], values[2]]
}

impl Reading {
    /// `interval_ns` is the nominal one.
    pub fn of_kvh(frame: &kvh::Inertial, rotation: Rotation, angle: Angle, interval_ns: i64) -> Self {
        let interval = interval_ns as f64 * 1e-9;
        let unit = match angle {
            Angle::Radians => 1.0,
            Angle::Degrees => DEGREE,
        };
        let over = match rotation {
            Rotation::Delta => 1.0,
            Rotation::Rate => interval,
        };
        let sequence = Count { value: u32::from(frame.sequence), moduli: SEQUENCE };
        let stamp = match frame.extra {
            kvh::Extra::Stamped { microseconds, .. } => Stamp {
                count: Count { value: microseconds, moduli: WHOLE },
                tick_ns: 1000,
                coarse: false,
                number: Some(sequence),
                latency_ns: 0,
            },
            _ => Stamp { count: sequence, tick_ns: interval_ns, coarse: false, number: None, latency_ns: 0 },
        };
        Self {
            stamp,
            dtheta: frame.gyros_valid().then(|| scaled(frame.rotation, unit * over)),
            dvel: frame.accelerometers_valid().then(|| scaled(frame.acceleration, STANDARD_GRAVITY * interval)),
            force_invalid: !frame.accelerometers_valid(),
            utc_ns: None,
            attitude: None,
        }
    }

    /// `interval_ns` is the nominal one.
    pub fn of_stdbin(telegram: &stdbin::Telegram, interval_ns: i64) -> Self {
        let interval = interval_ns as f64 * 1e-9;
        let stamp = Stamp {
            count: Count { value: telegram.time, moduli: DAY },
            tick_ns: stdbin::TICK_NS,
            coarse: true,
            number: Some(Count { value: telegram.counter, moduli: WHOLE }),
            latency_ns: 0,
        };
        Self {
            stamp,
            dtheta: telegram.rotation.map(|rate| body(scaled(rate, DEGREE * interval))),
            dvel: telegram.acceleration.map(|force| body(scaled(force, interval))),
            force_invalid: false,
            utc_ns: telegram.utc_ns(),
            attitude: telegram.attitude.map(|attitude| {
                let sigma = telegram.attitude_deviation.map_or([0.0; 3], |sigma| level(attitude[0], sigma));
                (rotation(attitude), sigma)
            }),
        }
    }

    /// `interval_ns` is the nominal one.
    pub fn of_stim300(frame: &stim300::Datagram, rotation: Rotation, force_exponent: i32, interval_ns: i64) -> Self {
        let interval = interval_ns as f64 * 1e-9;
        let scale = match rotation {
            Rotation::Delta => stim300::ANGLE_DEG,
            Rotation::Rate => stim300::RATE_DEG_PER_S * interval,
        };
        let force = STANDARD_GRAVITY * 2f64.powi(-force_exponent) * interval;
        let of = |cluster: &stim300::Cluster, factor: f64| {
            (cluster.status == 0).then(|| cluster.values.map(|v| f64::from(v) * factor))
        };
        let stamp = Stamp {
            count: Count { value: u32::from(frame.counter), moduli: COUNTS },
            tick_ns: stim300::COUNT_NS,
            coarse: false,
            number: None,
            latency_ns: i64::from(frame.latency) * 1000,
        };
        Self {
            stamp,
            dtheta: of(&frame.gyro, scale * DEGREE),
            dvel: frame.acceleration.as_ref().and_then(|cluster| of(cluster, force)),
            force_invalid: frame.acceleration.is_some_and(|cluster| cluster.status != 0),
            utc_ns: None,
            attitude: None,
        }
    }
}

/// From heading, roll and pitch in degrees, the pitch with the bow down.
fn rotation([heading, roll, pitch]: [f32; 3]) -> Rot<Nav, Nav> {
    let [heading, roll, pitch] = [heading, roll, -pitch].map(|angle| f64::from(angle) * DEGREE);
    Euler { roll, pitch, heading }.rotation()
}

/// Deviations about east, north and up from those of heading, roll and pitch.
fn level(heading: f32, sigma: [f32; 3]) -> [f64; 3] {
    let (sine, cosine) = (f64::from(heading) * DEGREE).sin_cos();
    let [about_up, about_bow, about_starboard] = sigma.map(|s| f64::from(s) * DEGREE);
    let bow = Vec3::<Nav>::new(sine, cosine, 0.0) * about_bow;
    let starboard = Vec3::<Nav>::new(cosine, -sine, 0.0) * about_starboard;
    [bow.x().hypot(starboard.x()), bow.y().hypot(starboard.y()), about_up]
}
