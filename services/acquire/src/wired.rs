//! A unit on its wire, from the bytes to the published sample.

use crate::AcquireError;
use crate::events::Events;
use crate::piece::Piece;
use crate::reader::{Common, Reader};
use frames::{Case, Main, Nav, Rot};
use messages::{Header, LineHealth, topic};
use pipeline::configuration::{Configuration, Line, Source};
use runtime::{Context, Feed, Node, Publisher, host_utc};
use std::sync::atomic::Ordering;
use wire::{Heard, Settings, Unit};

/// A unit with its reader and its health.
pub struct Wired {
    /// `main`, or the name of the area.
    pub name: String,
    /// The file of raw bytes has come to its end.
    pub ended: bool,
    /// Why the port is not open.
    pub fault: Option<String>,
    port: String,
    mounting: Option<Rot<Main, Case>>,
    unit: Unit,
    reader: Reader,
    health: LineHealth,
    events: Events,
    publisher: Publisher<LineHealth>,
}

impl Wired {
    /// Every unit of the configuration, the main unit first, and starts to read.
    pub fn all(
        configuration: &Configuration,
        context: &Context,
        node: &Node,
        common: &Common,
    ) -> Result<Vec<Self>, AcquireError> {
        let line = |source: &Source| source.line().cloned().ok_or(AcquireError::NoLine);
        let main = line(&configuration.main.source)?;
        let mut units = vec![Self::open(0, None, &main, configuration, context, node, common)?];
        units[0].mounting = Some(configuration.main.mounting);
        for (index, area) in configuration.areas.iter().enumerate() {
            let told = line(&area.source)?;
            units.push(Self::open(1 + index, Some(&area.name), &told, configuration, context, node, common)?);
        }
        Ok(units)
    }

    fn open(
        place: usize,
        area: Option<&str>,
        line: &Line,
        configuration: &Configuration,
        context: &Context,
        node: &Node,
        common: &Common,
    ) -> Result<Self, AcquireError> {
        let settings = Settings {
            device: line.device,
            interval_ns: configuration.interval_ns() / i64::from(line.decimation),
            decimation: line.decimation,
            time_source: line.time_source,
            latency_ns: line.latency_ns,
            unit: place as u32,
            run_id: context.run_id,
            epoch_ns: context.epoch_ns,
        };
        Ok(Self {
            name: area.unwrap_or("main").to_owned(),
            ended: false,
            fault: None,
            port: line.port.to_string(),
            mounting: None,
            unit: Unit::new(settings),
            reader: Reader::start(place, line, common.clone(), context)?,
            health: LineHealth { unit: place as u32, ..LineHealth::default() },
            events: Events::default(),
            publisher: Publisher::open(node, &topic::line(area))?,
        })
    }

    /// Whether the port has not been open yet.
    pub fn never_open(&self) -> bool {
        self.reader.counts.opened.load(Ordering::Relaxed) == 0
    }

    /// Notes that the port cannot be opened, or has broken off.
    pub fn fail(&mut self, reason: String) {
        tracing::warn!(unit = self.name, port = self.port, reason, "the port is closed");
        self.fault = Some(reason);
    }

    /// Takes bytes and publishes the samples in them.
    pub fn take(&mut self, piece: &Piece, feed: &mut Feed) -> Result<(), AcquireError> {
        self.unit.push(piece.arrival_ns, piece.bytes());
        self.health.arrival_ns = piece.arrival_ns;
        while let Some(heard) = self.unit.next_sample() {
            let Heard { sample, mut attitude, device_ns, utc_offset_ns, .. } = heard;
            if let (Some(attitude), Some(mounting)) = (&mut attitude, self.mounting) {
                let nav_from_case = Rot::<Nav, Case>::from_wxyz(attitude.q);
                attitude.q = (nav_from_case * mounting.inverse()).quaternion();
            }
            feed.publish_one(&sample, attitude.as_ref().filter(|_| sample.unit == 0))?;
            (self.health.header, self.health.device_ns) = (sample.header, device_ns);
            if let Some(utc_offset_ns) = utc_offset_ns {
                (self.health.utc_offset_ns, self.health.utc_at_ns) = (utc_offset_ns, sample.header.time_ns);
            }
        }
        match self.unit.complaint() {
            Some(complaint) => {
                Err(AcquireError::Stream { unit: self.name.clone(), port: self.port.clone(), complaint })
            }
            None => Ok(()),
        }
    }

    /// Publishes how the unit does, and adds it to the stage's own health.
    pub fn report(&mut self, feed: &mut Feed) -> Result<(), AcquireError> {
        let host = host_utc();
        self.unit.tell_host_utc(host.error_ns.map(|_| host.offset_ns));
        let (tally, clock, counts) = (self.unit.tally(), self.unit.clock(), &self.reader.counts);
        let before = self.health;
        let known = |value: f64| if value.is_finite() { value } else { 0.0 };
        self.health = LineHealth {
            header: Header { end: 0, ..before.header },
            skew: clock.skew(),
            jitter: known(clock.jitter()),
            sigma: known(clock.sigma()),
            good: tally.frames.good,
            damaged: tally.frames.damaged,
            skipped: tally.frames.skipped,
            others: tally.others,
            lost: tally.lost,
            gaps: tally.gaps,
            disordered: tally.disordered,
            invalid: tally.invalid,
            unsettled: tally.unsettled,
            restarts: tally.restarts,
            by_device: tally.by_device,
            disagreeing: tally.disagreeing,
            overflow: counts.overflow.load(Ordering::Relaxed),
            unkept: counts.unkept.load(Ordering::Relaxed),
            opened: counts.opened.load(Ordering::Relaxed),
            settled: u32::from(clock.settled()),
            ..before
        };
        let now = &self.health;
        self.events.see(&self.name, &self.port, &before, now);
        let stage = feed.health();
        stage.missing += now.lost - before.lost;
        stage.refused +=
            (now.damaged + now.disordered + now.invalid) - (before.damaged + before.disordered + before.invalid);
        stage.overflow += now.overflow - before.overflow;
        self.publisher.publish(now)?;
        self.publisher.refresh()?;
        Ok(())
    }
}
