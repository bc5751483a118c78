//! A unit at the end of a wire: the device, its port, and what its frames do not say.

use super::instrument::Kind;
use super::quantity;
use frames::unit::nanoseconds;
use serde::Deserialize;
use std::path::PathBuf;
use wire::{Angle, Device, Port, Rotation, TimeSource};

/// A unit that speaks on a wire.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// Which device it is, and what it was told.
    pub device: Device,
    /// Where its bytes come from; the path of a file is absolute.
    pub port: Port,
    /// Whose time of a sample counts.
    pub time_source: TimeSource,
    /// So many of its samples are summed to one.
    pub decimation: u32,
    /// From the time of validity to the least delayed arrival, ns: subtracted from every time. The group delay of the filter that is told is in it.
    pub latency_ns: i64,
    /// Where the bytes are kept with the times of their arrival; the path is absolute.
    pub raw: Option<PathBuf>,
}

/// The keys of a source: those of every kind, so that an unknown one is told beside all that are known.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SourceTable {
    pub(super) kind: Kind,
    pub(super) path: Option<PathBuf>,
    serial: Option<PathBuf>,
    baud: Option<u32>,
    udp: Option<String>,
    tcp: Option<String>,
    file: Option<PathBuf>,
    rotation: Option<RotationKey>,
    angle: Option<AngleKey>,
    accel_range_g: Option<u16>,
    low_pass_hz: Option<u16>,
    decimation: Option<u32>,
    clock: Option<ClockKey>,
    #[serde(default, deserialize_with = "quantity::clock_bound_ms")]
    clock_bound_ms: Option<f64>,
    #[serde(default, deserialize_with = "quantity::latency_ms")]
    latency_ms: Option<f64>,
    raw: Option<PathBuf>,
}

#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum RotationKey {
    Delta,
    Rate,
}

#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum AngleKey {
    Radians,
    Degrees,
}

#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum ClockKey {
    Fitted,
    Device,
}

/// How far a device's time may be off the filter's, s.
const CLOCK_BOUND_S: f64 = 2e-3;
/// From the fastest unit to the slowest run.
const LARGEST_DECIMATION: u32 = 1000;
const DEFAULT_BAUD: u32 = 921_600;

impl SourceTable {
    /// The first key that is there of those that go with a wire only.
    pub(super) fn line_key(&self) -> Option<&'static str> {
        let there = [
            (self.serial.is_some(), "serial"),
            (self.baud.is_some(), "baud"),
            (self.udp.is_some(), "udp"),
            (self.tcp.is_some(), "tcp"),
            (self.file.is_some(), "file"),
            (self.rotation.is_some(), "rotation"),
            (self.angle.is_some(), "angle"),
            (self.accel_range_g.is_some(), "accel_range_g"),
            (self.low_pass_hz.is_some(), "low_pass_hz"),
            (self.decimation.is_some(), "decimation"),
            (self.clock.is_some(), "clock"),
            (self.clock_bound_ms.is_some(), "clock_bound_ms"),
            (self.latency_ms.is_some(), "latency_ms"),
            (self.raw.is_some(), "raw"),
        ];
        there.into_iter().find(|(there, _)| *there).map(|(_, key)| key)
    }

    /// Checks the keys of a wire against each other and against the kind.
    pub(super) fn line(self) -> Result<Line, String> {
        let kind = self.kind;
        let name = kind.name();
        let has_not = |there: bool, key: &str| match there {
            true => Err(format!("a source of kind \"{name}\" has no `{key}`")),
            false => Ok(()),
        };
        let rotation = match self.rotation {
            Some(RotationKey::Rate) => Some(Rotation::Rate),
            Some(RotationKey::Delta) => Some(Rotation::Delta),
            None => None,
        };
        let device = match kind {
            Kind::Kvh => {
                has_not(self.accel_range_g.is_some(), "accel_range_g")?;
                let angle = match self.angle {
                    Some(AngleKey::Degrees) => Angle::Degrees,
                    Some(AngleKey::Radians) | None => Angle::Radians,
                };
                Device::Kvh { rotation: rotation.unwrap_or(Rotation::Delta), angle }
            }
            Kind::Stim300 => {
                has_not(self.angle.is_some(), "angle")?;
                let range = self.accel_range_g.unwrap_or(10);
                let force_exponent = wire::stim300::force_exponent(range)
                    .ok_or_else(|| format!("accel_range_g = {range}: must be one of 5, 10, 30, 80"))?;
                Device::Stim300 { rotation: rotation.unwrap_or(Rotation::Rate), force_exponent }
            }
            _ => {
                has_not(self.accel_range_g.is_some(), "accel_range_g")?;
                has_not(self.angle.is_some(), "angle")?;
                has_not(rotation.is_some(), "rotation")?;
                Device::Stdbin
            }
        };
        let latency_ns = nanoseconds(self.latency_ms.unwrap_or(0.0)) + self.group_delay_ns()?;
        let decimation = self.decimation.unwrap_or(1);
        if !(1..=LARGEST_DECIMATION).contains(&decimation) {
            return Err(format!("decimation = {decimation}: must be within 1 to {LARGEST_DECIMATION}"));
        }
        let (time_source, raw) = (self.time_source()?, self.raw.clone());
        Ok(Line { device, port: self.port(name)?, time_source, decimation, latency_ns, raw })
    }

    /// Of the devices that are known only STDBIN tells UTC.
    fn time_source(&self) -> Result<TimeSource, String> {
        match (self.clock, self.clock_bound_ms) {
            (Some(ClockKey::Device), bound_s) if matches!(self.kind, Kind::Stdbin) => {
                Ok(TimeSource::Device { bound_ns: nanoseconds(bound_s.unwrap_or(CLOCK_BOUND_S)) })
            }
            (Some(ClockKey::Device), _) => Err(format!(
                "a source of kind \"{}\" tells no UTC: clock = \"device\" has no meaning",
                self.kind.name()
            )),
            (_, Some(_)) => Err("`clock_bound_ms` goes with clock = \"device\" only".to_owned()),
            _ => Ok(TimeSource::Fitted),
        }
    }

    /// Of the low-pass filter that a STIM300 was told.
    fn group_delay_ns(&self) -> Result<i64, String> {
        let Some(told) = self.low_pass_hz else { return Ok(0) };
        if !matches!(self.kind, Kind::Stim300) {
            return Err(format!("a source of kind \"{}\" has no `low_pass_hz`", self.kind.name()));
        }
        wire::stim300::group_delay_ns(told)
            .ok_or_else(|| format!("low_pass_hz = {told}: must be one of 16, 33, 66, 131, 262"))
    }

    fn port(self, name: &str) -> Result<Port, String> {
        if let Some(baud) = self.baud {
            if self.serial.is_none() {
                return Err(format!("baud = {baud} goes with `serial` only"));
            }
            if !(1200..=4_147_200).contains(&baud) {
                return Err(format!("baud = {baud}: must be within 1200 to 4147200"));
            }
        }
        match (self.serial, self.udp, self.tcp, self.file) {
            (Some(path), None, None, None) => Ok(Port::Serial { path, baud: self.baud.unwrap_or(DEFAULT_BAUD) }),
            (None, Some(udp), None, None) => udp
                .parse()
                .map(Port::Udp)
                .map_err(|_| format!("udp = \"{udp}\": must be an address and a port, such as 127.0.0.1:5000")),
            (None, None, Some(tcp), None) => match tcp.rsplit_once(':') {
                Some((host, port)) if !host.is_empty() && port.parse::<u16>().is_ok() => Ok(Port::Tcp(tcp)),
                _ => Err(format!("tcp = \"{tcp}\": must be a host and a port, such as 192.168.0.5:4001")),
            },
            (None, None, None, Some(path)) => Ok(Port::File(path)),
            _ => Err(format!("a source of kind \"{name}\" needs one of the keys `serial`, `udp`, `tcp` and `file`")),
        }
    }
}
