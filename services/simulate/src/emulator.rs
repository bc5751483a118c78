//! `deckflex simulate --wire`: the simulated units as devices that speak their own protocol on pseudo-terminals and sockets.
//!
//! It stands where the cables would be: no other process knows. The ship's own time is that of the main unit's clock, which runs fast by
//! the skew against the host's; every sub unit's runs slow by as much, so all three disagree.

mod device;
mod files;

use device::Voice;
use files::Files;
use frames::unit::nanoseconds;
use pipeline::configuration::Configuration;
use rand_distr::{Distribution, Exp1};
use rand_pcg::Pcg64Mcg;
use runtime::line::{LineError, Outlet};
use runtime::scheduling::{self, Request};
use runtime::{Stop, TransportError, host_utc, monotonic_ns, sleep_until};
use simulation::{Epoch, Scenario, Simulator};
use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::fmt;
use std::path::PathBuf;

pub use device::KvhFormat;

/// How the emulated wires behave.
#[derive(Clone, Debug)]
pub struct Options {
    /// Mean of the delays beyond the least one, s: exponential.
    pub jitter_s: f64,
    /// The least delay, s.
    pub latency_s: f64,
    /// By how much the clocks are off the host's, a ratio.
    pub skew: f64,
    /// By how much the UTC that the main unit's INS tells is ahead of the host's, s; `None` if it tells none.
    pub utc_ahead_s: Option<f64>,
    /// Format of KVH units.
    pub kvh_format: KvhFormat,
    /// Folder for the truth and the true times of the samples.
    pub truth: Option<PathBuf>,
}

/// Why nothing can be emulated.
#[derive(Debug, thiserror::Error)]
pub enum EmulatorError {
    /// The operating system refuses.
    #[error(transparent)]
    System(#[from] TransportError),
    /// A port cannot be opened.
    #[error("{unit}: cannot open {reason}")]
    Port {
        /// `main`, or the name of the area.
        unit: String,
        /// The port and the reason.
        reason: LineError,
    },
    /// There is nothing to emulate.
    #[error("{unit}: the source is no device, so there is no wire to speak on")]
    NoWire {
        /// `main`, or the name of the area.
        unit: String,
    },
    /// The truth cannot be written.
    #[error("cannot write the truth: {0}")]
    Truth(#[from] std::io::Error),
}

/// The sender must be on time for the delays to be those that were asked for.
const PRIORITY: i32 = 42;
/// From the start to the first sample, ns.
const RUN_UP_NS: i64 = 200_000_000;
/// The end of each wait is spent awake, ns: waking up takes longer than the delays that are emulated.
const AWAKE_NS: i64 = 150_000;
/// Any odd number begins a sequence of its own.
const ODD: u128 = 0x9E37_79B9_7F4A_7C15;
/// A sub unit samples by so much of an interval after the main unit.
const PHASE: f64 = 0.37;

/// Emulated units whose wires are open.
pub struct Emulator {
    simulator: Simulator,
    voices: Vec<Voice>,
    outlets: Vec<Outlet>,
    ports: Vec<String>,
    files: Option<Files>,
    options: Options,
    seed: u64,
}

/// A frame on its way.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
struct Frame {
    due_ns: i64,
    unit: usize,
    bytes: Vec<u8>,
}

impl Emulator {
    /// Opens the wires of all units.
    ///
    /// # Errors
    /// A source is no device on a wire, a port cannot be opened, or the truth cannot be written.
    pub fn open(configuration: &Configuration, options: Options) -> Result<Self, EmulatorError> {
        let areas = configuration.areas.iter().map(|area| (area.name.as_str(), &area.source));
        let mut emulator = Self {
            simulator: Simulator::new(&scenario(configuration, options.skew)),
            voices: Vec::new(),
            outlets: Vec::new(),
            ports: Vec::new(),
            files: options.truth.as_deref().map(|folder| Files::create(folder, configuration)).transpose()?,
            options,
            seed: configuration.run.seed,
        };
        for (name, source) in std::iter::once(("main", &configuration.main.source)).chain(areas) {
            let line = source.line().ok_or_else(|| EmulatorError::NoWire { unit: name.to_owned() })?;
            let outlet =
                Outlet::open(&line.port).map_err(|reason| EmulatorError::Port { unit: name.to_owned(), reason })?;
            emulator.ports.push(format!("{name}: {} on {}", line.device.family(), line.port));
            emulator.outlets.push(outlet);
            let format = emulator.options.kvh_format;
            emulator.voices.push(Voice::new(line.device, format, configuration.interval_ns()));
        }
        Ok(emulator)
    }

    /// Speaks until the run's duration is over or a signal comes.
    ///
    /// # Errors
    /// The operating system refuses, or the truth cannot be written.
    pub fn run(mut self) -> Result<(), EmulatorError> {
        let stop = Stop::install()?;
        scheduling::apply(Request::Auto, PRIORITY);
        let begin_ns = monotonic_ns() + RUN_UP_NS;
        if let Some(ahead_s) = self.options.utc_ahead_s {
            self.voices[0].tell_utc(begin_ns + host_utc().offset_ns + nanoseconds(ahead_s));
        }
        let mut random = Pcg64Mcg::new(u128::from(self.seed) << 64 | ODD);
        let mut waiting = BinaryHeap::new();
        let skew = self.options.skew;
        let host_ns = |ship_ns: i64| begin_ns + (ship_ns as f64 / (1.0 + skew)).round() as i64;
        while let Some(epoch) = self.simulator.step() {
            let mut delayed = |true_ns: i64| {
                let jitter_s: f64 = self.options.jitter_s * <Exp1 as Distribution<f64>>::sample(&Exp1, &mut random);
                true_ns + ((self.options.latency_s + jitter_s) * 1e9).round() as i64
            };
            let now_ns = host_ns(epoch.main.header.time_ns);
            for (unit, true_ns, bytes) in spoken(&mut self.voices, epoch, host_ns) {
                waiting.push(Reverse(Frame { due_ns: delayed(true_ns), unit, bytes }));
            }
            if let Some(files) = &mut self.files {
                files.write(epoch, host_ns)?;
            }
            // whatever comes later is due after this
            while let Some(Reverse(frame)) = waiting.peek()
                && frame.due_ns <= now_ns
            {
                wait_until(frame.due_ns);
                self.outlets[frame.unit].send(&frame.bytes);
                waiting.pop();
            }
            if stop.requested() {
                waiting.clear();
                break;
            }
        }
        while let Some(Reverse(frame)) = waiting.pop() {
            wait_until(frame.due_ns);
            self.outlets[frame.unit].send(&frame.bytes);
        }
        self.files.map_or(Ok(()), Files::finish)?;
        Ok(())
    }
}

/// Frames of all units that the epoch brings, with the host's time at which their data end.
fn spoken(voices: &mut [Voice], epoch: &Epoch, host_ns: impl Fn(i64) -> i64) -> Vec<(usize, i64, Vec<u8>)> {
    let mut all = Vec::with_capacity(1 + epoch.sub.len());
    for sample in std::iter::once(&epoch.main).chain(&epoch.sub) {
        let unit = sample.unit as usize;
        let attitude = (unit == 0).then_some(&epoch.attitude);
        all.push((unit, host_ns(sample.header.time_ns), voices[unit].frame(sample, attitude)));
    }
    all
}

/// The simulated run, with sub units on clocks of their own.
fn scenario(configuration: &Configuration, skew: f64) -> Scenario {
    let mut scenario = configuration.scenario(0);
    for area in &mut scenario.areas {
        area.wire.rate_error = (1.0 - skew) / (1.0 + skew) - 1.0;
        area.wire.phase_s = PHASE / scenario.rate_hz;
    }
    scenario
}

fn wait_until(due_ns: i64) {
    sleep_until(due_ns - AWAKE_NS);
    while monotonic_ns() < due_ns {
        std::hint::spin_loop();
    }
}

impl fmt::Display for Emulator {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.ports.iter().try_for_each(|port| writeln!(f, "{port}"))?;
        write!(f, "speaking until Ctrl-C; `deckflex launch` with the same configuration listens")
    }
}
