//! A unit at the end of a wire.

mod decimator;
mod stream;
mod time_source;

pub use time_source::TimeSource;

use crate::count::{Smooth, step};
use crate::reading::{Reading, Stamp};
use crate::{Clock, Counts, Detector, Device, Family};
use decimator::Decimator;
use messages::{ClockDomain, Flags, Header, ImuSample, MainAttitude};
use std::fmt;
use stream::Stream;
use time_source::Word;

/// A stamp that is further off its arrival's than this belongs to a clock that has started anew, ns.
const RESTART_NS: i64 = 5_000_000_000;
/// So many stamps in a row that go back are no disorder on the way but a new start.
const DISORDER: u32 = 3;
/// Wraps that were guessed from a late arrival are found out within so long, ns.
const GUESS_NS: i64 = 5_000_000_000;
/// By an arrival that would be so much too early, ns.
const IMPOSSIBLE_NS: i64 = 5_000_000;
/// The sampling rate is judged over so long, ns, and may be off by so much.
const RATE_NS: i64 = 4_000_000_000;
const RATE_TOLERANCE: f64 = 0.1;
/// So many frames tell that something is missing from all.
const ALL: u64 = 10;

/// What has to be told about a unit.
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// Which device it is.
    pub device: Device,
    /// The nominal interval of its samples, ns.
    pub interval_ns: i64,
    /// So many of them are summed to one that is given out; 1 for each as it is.
    pub decimation: u32,
    /// From the time of validity to the least delayed arrival: filters of the device, sending, waking up; ns.
    pub latency_ns: i64,
    /// Whose time counts.
    pub time_source: TimeSource,
    /// 0 for the main unit, otherwise 1 + the index of the area.
    pub unit: u32,
    /// Which run the samples belong to.
    pub run_id: u64,
    /// When number 0 was due on the host's monotonic clock, ns.
    pub epoch_ns: i64,
}

/// A sample.
#[derive(Clone, Copy, Debug)]
pub struct Heard {
    /// Its time is the host's, its number counts from the run's epoch by what is given out; in the unit's own axes.
    pub sample: ImuSample,
    /// The vessel's attitude at the same instant, from devices that give it.
    pub attitude: Option<MainAttitude>,
    /// The device's own time, unwrapped, ns.
    pub device_ns: i64,
    /// By how much UTC, ns since 1970, is more than the sample's time, from devices that tell it.
    pub utc_offset_ns: Option<i64>,
    /// When its last byte came, ns of the host's monotonic clock.
    pub arrival_ns: i64,
}

/// Why a stream cannot be what the configuration says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Complaint {
    /// It looks like another device.
    OtherDevice {
        /// What was configured.
        told: Family,
        /// What it looks like.
        found: Family,
    },
    /// Telegrams without the raw rotation rate.
    NoRotation,
    /// The device says that its gyros give something else.
    GyroUnit,
    /// The device says that its accelerometers have another range, g.
    Range(u16),
    /// Another rate, Hz.
    Rate {
        /// What was configured, before any are summed.
        told: f64,
        /// What comes.
        found: f64,
    },
}

impl fmt::Display for Complaint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::OtherDevice { told, found } => {
                write!(f, "the configuration says \"{}\", but the stream looks like {found}", told.name())
            }
            Self::NoRotation => f.write_str(
                "the telegrams have no raw rotation rate (bit 2 of the extended mask): switch it on in the device; \
                 block 5 will not do, since it is free of the earth's rate",
            ),
            Self::GyroUnit => f.write_str("the device says that its gyros do not give what `rotation` tells"),
            Self::Range(range) => write!(f, "the device says that accel_range_g is {range}"),
            Self::Rate { told, found } => {
                write!(
                    f,
                    "the unit gives {found:.1} samples a second, but rate_hz (times `decimation`, where that is told) is {told}"
                )
            }
        }
    }
}

/// What became of a unit's stream.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tally {
    /// Frames and bytes.
    pub frames: Counts,
    /// Frames without a sample: built-in tests, answers, configurations.
    pub others: u64,
    /// Samples that the device counted and that never came.
    pub lost: u64,
    /// Places where samples were lost.
    pub gaps: u64,
    /// Samples that came again or out of order, and were dropped.
    pub disordered: u64,
    /// Samples that the device itself called invalid, or that lack the rotation.
    pub invalid: u64,
    /// Samples that came before the clock had settled.
    pub unsettled: u64,
    /// How often the device's clock started anew.
    pub restarts: u64,
    /// Samples whose time is the device's own.
    pub by_device: u64,
    /// Samples whose time by the device was too far off that by the clock filter, which was taken.
    pub disagreeing: u64,
    /// Samples given out.
    pub given: u64,
}

/// Where the stream stands.
#[derive(Clone, Copy, Debug)]
struct Place {
    count: u32,
    number: Option<u32>,
    /// Unwrapped stamp.
    device_ns: i64,
    /// The same if every interval were the nominal one.
    regular_ns: i64,
    sequence: u64,
    arrival_ns: i64,
}

/// Bytes with the time of their arrival in, samples with their time of validity out.
#[derive(Debug)]
pub struct Unit {
    settings: Settings,
    stream: Stream,
    detector: Option<Detector>,
    clock: Clock,
    /// UTC minus the host's monotonic clock, while the host's clock is disciplined, ns.
    host_utc_ns: Option<i64>,
    smooth: Smooth,
    decimator: Decimator,
    place: Option<Place>,
    /// Wraps that were assumed because an arrival was late, ns, and when.
    guess: Option<(i64, i64)>,
    backward: u32,
    sequence: Option<u64>,
    arrival_ns: i64,
    pace: Option<(i64, u64, u64)>,
    complaint: Option<Complaint>,
    tally: Tally,
}

impl Unit {
    /// A unit that has said nothing.
    pub fn new(settings: Settings) -> Self {
        Self {
            settings,
            stream: Stream::new(settings.device),
            detector: Some(Detector::default()),
            clock: Clock::new(settings.latency_ns),
            host_utc_ns: None,
            smooth: Smooth::new(crate::stdbin::TICK_NS),
            decimator: Decimator::new(settings.decimation),
            place: None,
            guess: None,
            backward: 0,
            sequence: None,
            arrival_ns: 0,
            pace: None,
            complaint: None,
            tally: Tally::default(),
        }
    }

    /// Tells what the host knows of UTC, minus its monotonic clock, ns; `None` while nobody disciplines its clock.
    pub fn tell_host_utc(&mut self, offset_ns: Option<i64>) {
        self.host_utc_ns = offset_ns;
    }

    /// Takes bytes that came at `arrival_ns` of the host's monotonic clock.
    pub fn push(&mut self, arrival_ns: i64, bytes: &[u8]) {
        self.arrival_ns = arrival_ns;
        self.stream.push(bytes);
        if let Some(detector) = &mut self.detector {
            detector.push(bytes);
            let told = self.settings.device.family();
            match detector.found() {
                Some(found) if found != told => self.complaint = Some(Complaint::OtherDevice { told, found }),
                Some(_) => self.detector = None,
                None => {}
            }
        }
    }

    /// The next sample of what has been pushed; call until it gives `None`.
    pub fn next_sample(&mut self) -> Option<Heard> {
        loop {
            let frame = self.stream.next_frame(self.settings.interval_ns);
            self.tally.frames = self.stream.counts();
            match frame? {
                stream::Told::Sample(reading) => {
                    if let Some(heard) = self.sample(&reading).and_then(|heard| self.decimator.take(heard)) {
                        self.tally.given += 1;
                        return Some(heard);
                    }
                }
                stream::Told::Doubt(complaint) => {
                    self.tally.others += 1;
                    self.complaint = Some(complaint);
                }
                stream::Told::Other => self.tally.others += 1,
            }
        }
    }

    /// Why the stream cannot be what the configuration says, as soon as that is known.
    pub fn complaint(&self) -> Option<Complaint> {
        self.complaint
    }

    /// What became of the stream so far.
    pub fn tally(&self) -> Tally {
        self.tally
    }

    /// The device's clock against the host's.
    pub fn clock(&self) -> &Clock {
        &self.clock
    }

    fn sample(&mut self, reading: &Reading) -> Option<Heard> {
        let place = self.follow(&reading.stamp)?;
        let mut device_ns = place.device_ns;
        if reading.stamp.coarse {
            device_ns = self.smooth.time_ns(device_ns, place.regular_ns);
        }
        let fitted_ns = self.clock.hear(device_ns, self.arrival_ns - reading.stamp.latency_ns);
        self.judge_rate(place.sequence);
        if !self.clock.settled() {
            self.tally.unsettled += 1;
            return None;
        }
        let Some(dtheta) = reading.dtheta else {
            self.tally.invalid += 1;
            if self.tally.given == 0 && self.tally.invalid >= ALL && self.settings.device == Device::Stdbin {
                self.complaint = Some(Complaint::NoRotation);
            }
            return None;
        };
        // the tick is coarse, the smoothed time less so
        let utc_ns = reading.utc_ns.map(|utc_ns| utc_ns + device_ns - place.device_ns);
        let time_ns = match self.settings.time_source.word(utc_ns, self.host_utc_ns, fitted_ns) {
            Word::Taken(time_ns) => {
                self.tally.by_device += 1;
                time_ns
            }
            Word::Refused => {
                self.tally.disagreeing += 1;
                fitted_ns
            }
            Word::None => fitted_ns,
        };
        let sequence = self.number(time_ns, place.sequence);
        let header = Header {
            run_id: self.settings.run_id,
            sequence,
            time_ns,
            clock_domain: ClockDomain::HostMonotonic as u32,
            ..Header::default()
        };
        let dvel = reading.dvel.unwrap_or([0.0; 3]);
        let mut flags = Flags::empty();
        flags.set(Flags::NOT_FINITE, !dtheta.iter().chain(&dvel).all(|v| v.is_finite()));
        flags.set(Flags::ACCEL_STUCK, reading.force_invalid);
        let (interval_ns, unit) = (self.settings.interval_ns, self.settings.unit);
        let attitude =
            reading.attitude.map(|(rotation, sigma)| MainAttitude { header, q: rotation.quaternion(), sigma });
        let sample = ImuSample { header, interval_ns, dtheta, dvel, flags, unit, ordinal: 0 };
        let utc_offset_ns = utc_ns.map(|utc_ns| utc_ns - time_ns);
        Some(Heard { sample, attitude, device_ns, utc_offset_ns, arrival_ns: self.arrival_ns })
    }

    /// Numbers count from the epoch where the stream begins or begins again, and by the device from there on.
    fn number(&mut self, time_ns: i64, counted: u64) -> u64 {
        let by_time = (time_ns - self.settings.epoch_ns) as f64 / self.settings.interval_ns as f64;
        let by_time = by_time.round().max(0.0) as u64;
        let begin = *self.sequence.get_or_insert(by_time.saturating_sub(counted));
        begin + counted
    }

    /// Where the stamp stands after the one before; `None` for a sample to be dropped.
    fn follow(&mut self, stamp: &Stamp) -> Option<Place> {
        let arrival_ns = self.arrival_ns;
        let Some(before) = self.place else { return Some(self.begin(stamp, 0)) };
        let passed_ns = arrival_ns - before.arrival_ns;
        let steps = step(before.count, stamp.count, passed_ns as f64 / stamp.tick_ns as f64);
        let step_ns = steps * stamp.tick_ns;
        if (step_ns - passed_ns).abs() > RESTART_NS {
            return Some(self.restart(stamp, before.sequence + 1));
        }
        if steps <= 0 {
            self.backward += 1;
            if self.backward >= DISORDER && steps < 0 {
                return Some(self.restart(stamp, before.sequence + 1));
            }
            self.tally.disordered += 1;
            return None;
        }
        self.backward = 0;
        let mut place = Place { device_ns: before.device_ns + step_ns, ..before };
        self.doubt(stamp, before.count, steps, &mut place);
        let nominal = (place.device_ns - before.device_ns) as f64 / self.settings.interval_ns as f64;
        let samples = match (before.number, stamp.number) {
            (Some(before), Some(now)) => step(before, now, nominal),
            _ => nominal.round() as i64,
        };
        let samples = samples.max(1);
        if samples > 1 {
            self.tally.gaps += 1;
            self.tally.lost += samples as u64 - 1;
        }
        place.regular_ns += samples * self.settings.interval_ns;
        place.sequence += samples as u64;
        (place.count, place.number) = (stamp.count.value, stamp.number.map(|count| count.value));
        place.arrival_ns = arrival_ns;
        self.place = Some(place);
        Some(place)
    }

    /// Whether a count wrapped while nothing came, or the samples only came late, shows later: they then come too early.
    fn doubt(&mut self, stamp: &Stamp, before: u32, steps: i64, place: &mut Place) {
        let shortest = stamp.count.moduli.iter().min().map_or(i64::MAX, |&modulus| modulus as i64);
        let least = (i64::from(stamp.count.value) - i64::from(before)).rem_euclid(shortest);
        if steps > least && least > 0 {
            self.guess = Some(((steps - least) * stamp.tick_ns, self.arrival_ns));
            return;
        }
        let Some((guessed_ns, at_ns)) = self.guess else { return };
        let late_ns = self.clock.lateness_ns(place.device_ns, self.arrival_ns - stamp.latency_ns).unwrap_or(0);
        if self.arrival_ns - at_ns > GUESS_NS {
            self.guess = None;
        } else if late_ns < -IMPOSSIBLE_NS {
            place.device_ns -= guessed_ns;
            self.guess = None;
        }
    }

    fn begin(&mut self, stamp: &Stamp, sequence: u64) -> Place {
        let device_ns = i64::from(stamp.count.value) * stamp.tick_ns;
        let place = Place {
            count: stamp.count.value,
            number: stamp.number.map(|count| count.value),
            device_ns,
            regular_ns: device_ns,
            sequence,
            arrival_ns: self.arrival_ns,
        };
        self.place = Some(place);
        place
    }

    fn restart(&mut self, stamp: &Stamp, sequence: u64) -> Place {
        self.tally.restarts += 1;
        self.clock.restart();
        self.smooth.restart();
        self.decimator.restart();
        (self.guess, self.backward, self.pace) = (None, 0, None);
        // the time that has passed shows in the numbers too
        let passed = self.place.map_or(0, |before| self.arrival_ns - before.arrival_ns) / self.settings.interval_ns;
        self.begin(stamp, sequence + passed.max(0) as u64)
    }

    fn judge_rate(&mut self, sequence: u64) {
        if !self.clock.settled() {
            return;
        }
        let good = self.tally.frames.good;
        let (since_ns, first, frames) = *self.pace.get_or_insert((self.arrival_ns, sequence, good));
        let passed_ns = self.arrival_ns - since_ns;
        if passed_ns < RATE_NS || self.complaint.is_some() {
            return;
        }
        // a count in units of time gives the nominal rate whatever comes; frames tell then, as far as none are lost
        let counted = match self.place.and_then(|place| place.number) {
            None if matches!(self.settings.device, Device::Stim300 { .. }) => good - frames,
            _ => sequence - first,
        };
        let (told, found) = (1e9 / self.settings.interval_ns as f64, counted as f64 * 1e9 / passed_ns as f64);
        let quiet = self.tally.lost > 0 && found < told;
        if (found / told - 1.0).abs() > RATE_TOLERANCE && !quiet {
            self.complaint = Some(Complaint::Rate { told, found });
        }
        self.pace = Some((self.arrival_ns, sequence, good));
    }
}
