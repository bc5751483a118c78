//! A unit at the end of a wire: the device, its port, and what its frames do not say.

use super::instrument::Kind;
use super::quantity;
use frames::unit::nanoseconds;
use serde::Deserialize;
use std::path::PathBuf;
use wire::{Angle, Device, Port, Rotation};

/// A unit that speaks on a wire.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// Which device it is, and what it was told.
    pub device: Device,
    /// Where its bytes come from; the path of a file is absolute.
    pub port: Port,
    /// From the time of validity to the least delayed arrival, ns: subtracted from every time.
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
        let latency_ns = nanoseconds(self.latency_ms.unwrap_or(0.0));
        let raw = self.raw.clone();
        Ok(Line { device, port: self.port(name)?, latency_ns, raw })
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
