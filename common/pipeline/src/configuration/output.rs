//! Where telegrams go, what they say and how often.

use super::document::Document;
use super::{Configuration, ConfigurationError, quantity, table};
use frames::Vec3;
use serde::Deserialize;
use serde::de::{Deserializer, Error};
use std::fmt;
use std::net::{IpAddr, Ipv4Addr, SocketAddr};
use std::path::PathBuf;
use telegrams::{KMB_LENGTH, Sentence, Style, Talker};

/// One destination and what it gets.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Output {
    /// Name of the area that it is told of.
    pub area: String,
    /// Where the telegrams go.
    #[serde(deserialize_with = "destination")]
    pub to: Destination,
    /// What they are.
    #[serde(rename = "sentences", deserialize_with = "telegrams")]
    pub telegrams: Telegrams,
    /// The talker of sentences that are not a maker's own.
    #[serde(default = "integrated", deserialize_with = "talker")]
    pub talker: Talker,
    /// Telegrams a second, not more than there are samples.
    #[serde(default = "ten", deserialize_with = "quantity::output_hz")]
    pub rate_hz: f64,
    /// Decimals of angles in sentences, 1 to 5.
    #[serde(default = "two", deserialize_with = "decimals")]
    pub decimals: usize,
    /// By how much the attitude is carried forward, s.
    #[serde(rename = "extrapolate_ms", default, deserialize_with = "quantity::extrapolate_ms")]
    pub extrapolate_s: f64,
    /// After so long without a solution the telegrams say that nothing is valid, s.
    #[serde(rename = "silence_ms", default = "half", deserialize_with = "quantity::silence_ms")]
    pub silence_s: f64,
}

impl Output {
    /// How its sentences are written.
    pub fn style(&self) -> Style {
        Style { talker: self.talker, decimals: self.decimals }
    }

    /// The most bytes that go out at one instant, where the area has a zero or not.
    pub fn longest(&self, zeroed: bool) -> usize {
        match &self.telegrams {
            Telegrams::Sentences(sentences) => {
                sentences.iter().map(|sentence| sentence.longest(self.decimals, zeroed)).sum()
            }
            Telegrams::Kmb => KMB_LENGTH,
        }
    }
}

/// Where telegrams go.
#[derive(Clone, Debug, PartialEq)]
pub enum Destination {
    /// Datagrams.
    Udp {
        /// A host, a multicast group or a broadcast address, with the port.
        address: SocketAddr,
        /// How many routers they may pass; `None` leaves it to the operating system, which lets multicast pass none.
        ttl: Option<u8>,
        /// Address of the host's own interface that they leave by.
        interface: Option<Ipv4Addr>,
    },
    /// A serial line: 8 bits, no parity, 1 stop bit.
    Serial {
        /// Such as `/dev/ttyS0`.
        device: PathBuf,
        /// Bits a second.
        baud: u32,
    },
}

impl fmt::Display for Destination {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Udp { address, .. } => write!(f, "udp {address}"),
            Self::Serial { device, baud } => write!(f, "serial {} at {baud} baud", device.display()),
        }
    }
}

/// What a destination gets.
#[derive(Clone, Debug, PartialEq)]
pub enum Telegrams {
    /// Sentences, in this order.
    Sentences(Vec<Sentence>),
    /// Kongsberg's binary.
    Kmb,
}

/// The speeds that serial lines have.
const BAUDS: [u32; 9] = [4800, 9600, 19_200, 38_400, 57_600, 115_200, 230_400, 460_800, 921_600];
/// A byte on a line: 8 bits between a start and a stop bit.
const BITS: f64 = 10.0;

#[derive(Deserialize)]
#[serde(rename_all = "snake_case")]
enum Kind {
    Udp,
    Serial,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct DestinationTable {
    kind: Kind,
    #[serde(default, deserialize_with = "address")]
    address: Option<SocketAddr>,
    #[serde(default, deserialize_with = "ttl")]
    ttl: Option<u8>,
    #[serde(default, deserialize_with = "interface")]
    interface: Option<Ipv4Addr>,
    device: Option<PathBuf>,
    #[serde(default, deserialize_with = "baud")]
    baud: Option<u32>,
}

fn destination<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Destination, D::Error> {
    let table: DestinationTable = table::one(deserializer)?;
    match table {
        DestinationTable { kind: Kind::Udp, address: Some(address), ttl, interface, device: None, baud: None } => {
            Ok(Destination::Udp { address, ttl, interface })
        }
        DestinationTable { kind: Kind::Udp, .. } => Err(D::Error::custom(
            "a destination of kind \"udp\" needs the key `address` and may have `ttl` and `interface`",
        )),
        DestinationTable {
            kind: Kind::Serial,
            device: Some(device),
            baud: Some(baud),
            address: None,
            ttl: None,
            interface: None,
        } => Ok(Destination::Serial { device, baud }),
        DestinationTable { kind: Kind::Serial, .. } => Err(D::Error::custom(
            "a destination of kind \"serial\" needs the keys `device` and `baud` and has no others",
        )),
    }
}

fn address<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<SocketAddr>, D::Error> {
    let text = String::deserialize(deserializer)?;
    match text.parse::<SocketAddr>() {
        Ok(address) if address.port() > 0 => Ok(Some(address)),
        _ => Err(D::Error::custom("must be an address with a port of 1 to 65535, such as \"192.168.0.20:4001\"")),
    }
}

fn ttl<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<u8>, D::Error> {
    match u64::deserialize(deserializer)? {
        n @ 1..=255 => Ok(Some(n as u8)),
        _ => Err(D::Error::custom("must be within 1 to 255")),
    }
}

fn interface<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Ipv4Addr>, D::Error> {
    let text = String::deserialize(deserializer)?;
    let message = "must be the IPv4 address of one of the host's interfaces, such as \"192.168.0.5\"";
    text.parse().map(Some).map_err(|_| D::Error::custom(message))
}

fn baud<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<u32>, D::Error> {
    let baud = u64::deserialize(deserializer)?;
    let known = BAUDS.into_iter().find(|known| u64::from(*known) == baud);
    known
        .map(Some)
        .ok_or_else(|| D::Error::custom(format!("must be one of {}", BAUDS.map(|b| b.to_string()).join(", "))))
}

fn telegrams<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Telegrams, D::Error> {
    let names = Vec::<String>::deserialize(deserializer)?;
    if names == ["KMB"] {
        return Ok(Telegrams::Kmb);
    }
    if names.iter().any(|name| name == "KMB") {
        return Err(D::Error::custom("KMB is binary and must be alone: give it a destination of its own"));
    }
    let sentence = |name: &String| Sentence::ALL.into_iter().find(|sentence| sentence.name() == name);
    let known = Sentence::ALL.map(|sentence| sentence.name()).join(", ");
    match names.iter().map(sentence).collect::<Option<Vec<Sentence>>>() {
        Some(sentences) if !sentences.is_empty() => Ok(Telegrams::Sentences(sentences)),
        _ => Err(D::Error::custom(format!("must be some of {known}, or KMB alone"))),
    }
}

fn talker<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Talker, D::Error> {
    let text = String::deserialize(deserializer)?;
    Talker::new(&text).ok_or_else(|| D::Error::custom("must be two capital letters or digits and not begin with P"))
}

fn decimals<'de, D: Deserializer<'de>>(deserializer: D) -> Result<usize, D::Error> {
    match usize::deserialize(deserializer)? {
        n @ 1..=5 => Ok(n),
        _ => Err(D::Error::custom("must be within 1 to 5")),
    }
}

fn integrated() -> Talker {
    Talker::INTEGRATED
}

fn ten() -> f64 {
    10.0
}

fn two() -> usize {
    2
}

fn half() -> f64 {
    0.5
}

/// What several keys of an output have to do with each other and with the areas.
pub(super) fn rules(configuration: &Configuration, document: &Document, faults: &mut Vec<ConfigurationError>) {
    let samples_hz = configuration.rate_hz;
    for (i, output) in configuration.outputs.iter().enumerate() {
        let mut fault = |key: &str, message: &str| faults.push(document.fault(&format!("output[{i}].{key}"), message));
        if !configuration.areas.iter().any(|area| area.name == output.area) {
            let known: Vec<String> = configuration.areas.iter().map(|area| format!("\"{}\"", area.name)).collect();
            fault("area", &format!("must be the name of an area: {}", known.join(", ")));
        }
        if output.rate_hz > samples_hz {
            fault("rate_hz", &format!("must not be above the samples' rate_hz = {samples_hz}"));
        }
        if output.silence_s * samples_hz < 2.0 {
            fault("silence_ms", &format!("must be at least two samples, {} ms at {samples_hz} Hz", 2e3 / samples_hz));
        }
        match &output.to {
            Destination::Udp { address, interface: Some(_), .. } if matches!(address.ip(), IpAddr::V6(_)) => {
                fault("to.interface", "goes with IPv4 addresses only");
            }
            Destination::Udp { .. } => {}
            Destination::Serial { device, baud } => {
                let area = configuration.areas.iter().find(|area| area.name == output.area);
                let longest = output.longest(area.is_some_and(|area| area.zero != Vec3::ZERO));
                let needed = longest as f64 * BITS * output.rate_hz;
                if needed > f64::from(*baud) {
                    let message = format!(
                        "{longest} bytes, {} times a second, need up to {needed:.0} baud: fewer sentences, a lower rate_hz or a faster line",
                        output.rate_hz
                    );
                    fault("to.baud", &message);
                }
                let same = |other: &Output| matches!(&other.to, Destination::Serial { device: d, .. } if d == device);
                if let Some(first) = configuration.outputs[..i].iter().position(same) {
                    fault("to.device", &format!("output[{first}] has the same device"));
                }
            }
        }
    }
}
