//! A short look at what comes from the units on wires.

use pipeline::configuration::{Configuration, Line as Told, Port};
use runtime::line::Line;
use runtime::monotonic_ns;
use std::fmt;
use wire::{Complaint, Detector, Family, Settings, Tally, TimeSource, Unit};

/// How long each unit is listened to, ns: the rate is judged by then.
const LISTEN_NS: i64 = 6_000_000_000;
const DATAGRAM: usize = 65_536;

/// What came from a unit; its text is for people.
#[derive(Clone, Debug)]
pub struct Listened {
    /// `main`, or the name of the area.
    pub name: String,
    /// Where it was listened to.
    pub port: String,
    /// Why the port is not open.
    pub fault: Option<String>,
    /// Bytes that came.
    pub bytes: u64,
    /// What the stream looks like.
    pub looks_like: Option<Family>,
    /// Why it cannot be what the configuration says.
    pub complaint: Option<Complaint>,
    /// What became of it.
    pub tally: Tally,
    /// Standard deviation of the arrivals' delay, s.
    pub jitter: f64,
}

/// Listens to the units on wires, one after the other; to none where there are none. A file is no port.
pub fn listen(configuration: &Configuration) -> impl Iterator<Item = Listened> {
    let areas = configuration.areas.iter().map(|area| (area.name.as_str(), &area.source));
    let units = std::iter::once(("main", &configuration.main.source)).chain(areas);
    let lines = units.filter_map(|(name, source)| Some((name, source.line()?)));
    let ports = lines.filter(|(_, line)| !matches!(line.port, Port::File(_)));
    ports.map(|(name, line)| hear(name, line, configuration.interval_ns()))
}

fn hear(name: &str, told: &Told, interval_ns: i64) -> Listened {
    let begin_ns = monotonic_ns();
    let Told { device, decimation, latency_ns, .. } = *told;
    let interval_ns = interval_ns / i64::from(decimation);
    let (time_source, unit, run_id, epoch_ns) = (TimeSource::Fitted, 0, 0, begin_ns);
    let settings = Settings { device, interval_ns, decimation, latency_ns, time_source, unit, run_id, epoch_ns };
    let mut unit = Unit::new(settings);
    let (mut line, mut detector) = (Line::new(told.port.clone()), Detector::default());
    let (mut bytes, mut buffer) = (0, vec![0; DATAGRAM]);
    while monotonic_ns() - begin_ns < LISTEN_NS {
        let count = line.read(&mut buffer);
        let arrival_ns = monotonic_ns();
        bytes += count as u64;
        detector.push(&buffer[..count]);
        unit.push(arrival_ns, &buffer[..count]);
        while unit.next_sample().is_some() {}
    }
    Listened {
        name: name.to_owned(),
        port: told.port.to_string(),
        fault: line.fault().map(ToString::to_string),
        bytes,
        looks_like: detector.found(),
        complaint: unit.complaint(),
        tally: unit.tally(),
        jitter: unit.clock().jitter(),
    }
}

impl fmt::Display for Listened {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, port, bytes, tally, .. } = self;
        if let Some(fault) = &self.fault {
            return write!(f, "{name}: cannot open {fault}");
        }
        match self.looks_like {
            _ if *bytes == 0 => write!(f, "{name}: nothing comes on {port}")?,
            None => write!(f, "{name}: {bytes} bytes on {port}, but no frame of a known device")?,
            Some(family) => write!(f, "{name}: {family} on {port}")?,
        }
        let seconds = LISTEN_NS as f64 * 1e-9;
        if self.looks_like.is_some() {
            write!(
                f,
                "\n  {:.1} frames a second, {} damaged, {} bytes skipped, {} samples lost, jitter {:.0} us",
                tally.frames.good as f64 / seconds,
                tally.frames.damaged,
                tally.frames.skipped,
                tally.lost,
                self.jitter * 1e6
            )?;
        }
        self.complaint.iter().try_for_each(|complaint| write!(f, "\nsuspicious: {name}: {complaint}"))
    }
}
