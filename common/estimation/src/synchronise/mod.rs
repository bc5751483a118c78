//! Time synchronisation of one area: the sub unit's stream onto the main unit's instants, by data time alone.
//!
//! Each unit's stream is first cleaned (`stream`): repeated samples are dropped, a few late ones put back into their place, spikes
//! replaced (`spike`), short holes bridged, and the increments composed into an attitude. The sub unit's ATTITUDE is then interpolated at the main
//! unit's instants (`interpolation`), which preserves the increments whatever the stamps do. The result depends on the contents of the
//! two streams only, not on when they arrive; the one exception, silence, is decided by main data time and travels with the pair.
//!
//! Source: the time base of paper 002's reworking; four points on SO(3).

mod channel;
mod interpolation;
mod joint;
mod roughness;
mod spike;
mod stream;

use frames::{Case, Frame, Main, MainStart, Rot, Sub, SubStart, Vec3};
use interpolation::{Found, Point};
use messages::{Flags, ImuPair, ImuSample, MainAttitude};
use spike::Told;
use std::collections::VecDeque;
use stream::{Node, Stream};

/// What the synchroniser has to know of one unit.
#[derive(Clone, Copy, Debug)]
pub struct Unit<B: Frame> {
    /// From the unit's own axes to body axes.
    pub mounting: Rot<B, Case>,
    /// End of the gyros' measuring range, rad/s.
    pub range: Option<f64>,
}

/// Settings of one area's synchroniser.
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// Index of the area.
    pub area: u32,
    /// Nominal sampling interval of both units, ns.
    pub interval_ns: i64,
    /// The sub unit is declared silent after so much main data, ns.
    pub silence_ns: i64,
    /// Spikes are what is further off its neighbours than so many times the scale of a unit's own roughness; 0 for no test.
    pub spike_threshold: f64,
    /// Distance of the units, m: a step of a turn acts on accelerometers as far from its axis.
    pub lever_arm_m: f64,
    /// The main unit.
    pub main: Unit<Main>,
    /// The sub unit.
    pub sub: Unit<Sub>,
}

/// A sub stamp this near to the instant, as a share of the interval, needs no look-ahead.
const NEAR: f64 = 0.01;
/// The longest hole that is bridged, in nominal intervals.
const BRIDGE: i64 = 6;
/// Attitudes of the main INS that may wait for their sample: a stage that stood still finds as many as its topic holds.
const INS_DEPTH: usize = 4096;
/// Nodes of the sub unit that may wait for the main unit: 20 s at 200 Hz.
const SUB_DEPTH: usize = 4096;

/// What became of the samples of both units.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Samples missing in a unit's own stream.
    pub missing: u64,
    /// Samples refused: not finite, repeated, too late, or stamped before their predecessor.
    pub refused: u64,
    /// Samples at the end of the range, with a stuck channel or with a spike.
    pub suspect: u64,
}

/// Joins the streams of the main unit and one sub unit.
#[derive(Debug)]
pub struct Synchroniser {
    settings: Settings,
    main: Stream<MainStart, Main>,
    sub: Stream<SubStart, Sub>,
    ins: VecDeque<MainAttitude>,
    /// The last pair that had data of both units.
    last: Option<Last>,
    /// The end of the main unit's previous pair, good or not.
    previous_ns: Option<i64>,
    ended: bool,
}

/// What the next pair continues from.
#[derive(Debug)]
struct Last {
    epoch: u64,
    segments: (u64, u64),
    main_attitude: Rot<MainStart, Main>,
    sub_attitude: Rot<SubStart, Sub>,
    main_velocity: Vec3<Main>,
    sub_velocity: Vec3<Sub>,
}

impl Synchroniser {
    /// A synchroniser at the start of its streams.
    pub fn new(settings: Settings) -> Self {
        let told = Told {
            threshold: settings.spike_threshold,
            lever_arm: settings.lever_arm_m,
            interval_ns: settings.interval_ns,
            bridge_ns: BRIDGE * settings.interval_ns,
        };
        Self {
            settings,
            main: Stream::new(settings.main, told, true),
            sub: Stream::new(settings.sub, told, false),
            ins: VecDeque::with_capacity(64),
            last: None,
            previous_ns: None,
            ended: false,
        }
    }

    /// Takes an attitude of the main INS; it must come before the main sample of the same number.
    pub fn attitude(&mut self, attitude: &MainAttitude) {
        if self.ins.len() == INS_DEPTH {
            self.ins.pop_front();
        }
        self.ins.push_back(*attitude);
    }

    /// Takes a sample of the main unit.
    pub fn main(&mut self, sample: &ImuSample) {
        self.main.push(sample);
    }

    /// Takes a sample of the sub unit.
    pub fn sub(&mut self, sample: &ImuSample) {
        self.sub.push(sample);
        let nodes = &mut self.sub.nodes;
        let newest_ns = nodes.back().map_or(0, |node| node.header.time_ns);
        // a clock that jumped back leaves nodes that lie in its future
        while nodes.len() > SUB_DEPTH || nodes.front().is_some_and(|node| node.header.time_ns > newest_ns) {
            nodes.pop_front();
        }
    }

    /// Both streams have ended: what is held back is worked off.
    pub fn end(&mut self) {
        self.main.flush();
        self.sub.flush();
        self.ended = true;
    }

    /// What became of the samples so far.
    pub fn counts(&self) -> Counts {
        let (a, b) = (self.main.counts, self.sub.counts);
        Counts { missing: a.missing + b.missing, refused: a.refused + b.refused, suspect: a.suspect + b.suspect }
    }

    /// The next pair, as soon as the data decide it. Call until it gives `None`.
    pub fn pair(&mut self) -> Option<ImuPair> {
        let main = *self.main.nodes.front()?;
        let time_ns = main.header.time_ns;
        let found = interpolation::at(&self.sub.nodes, time_ns, self.near_ns(), self.ended);
        let pair = match found {
            _ if main.void => self.unpaired(&main, main.flags | Flags::GAP),
            Found::At(sub) => self.join(&main, sub),
            Found::Never => self.unpaired(&main, main.flags | self.sub.refusals | Flags::GAP),
            Found::Wait if self.silent(time_ns) => self.unpaired(&main, main.flags | Flags::GAP | Flags::SILENT),
            Found::Wait => return None,
        };
        self.main.nodes.pop_front();
        self.sub.forget_before(time_ns);
        self.previous_ns = Some(time_ns);
        Some(pair)
    }

    fn near_ns(&self) -> i64 {
        (NEAR * self.settings.interval_ns as f64) as i64
    }

    /// Whether the main unit has gone on for too long without data of the sub unit.
    fn silent(&self, time_ns: i64) -> bool {
        self.main.nodes.back().is_some_and(|newest| newest.header.time_ns - time_ns >= self.settings.silence_ns)
    }

    /// A pair of the main sample and the sub unit's state at its instant.
    fn join(&mut self, main: &Node<MainStart, Main>, mut sub: Point) -> ImuPair {
        let mut pair = self.unpaired(main, main.flags | sub.flags);
        pair.disturbance = main.disturbance.hypot(sub.disturbance);
        pair.header.stamps.complete_ns = main.header.stamps.source_ns.max(sub.source_ns);
        let mut main_attitude = main.attitude;
        let last = self.last.take().filter(|last| last.segments == (main.segment, sub.segment));
        pair.epoch = match &last {
            Some(last) => {
                pair.dtheta_m = (last.main_attitude.inverse() * main_attitude).log().array();
                pair.dtheta_s = (last.sub_attitude.inverse() * sub.attitude).log().array();
                pair.dvel_m = (main.velocity - last.main_velocity).array();
                pair.dvel_s = (sub.velocity - last.sub_velocity).array();
                last.epoch
            }
            None => {
                // from here on the bits depend on nothing that came before
                pair.flags |= Flags::NEW_EPOCH;
                self.main.rebase(0);
                main_attitude = Rot::identity();
                self.sub.rebase(sub.left);
                if let Found::At(again) =
                    interpolation::at(&self.sub.nodes, main.header.time_ns, self.near_ns(), self.ended)
                {
                    sub = again;
                }
                main.header.sequence
            }
        };
        pair.attitude_m = main_attitude.quaternion();
        pair.attitude_s = sub.attitude.quaternion();
        self.last = Some(Last {
            epoch: pair.epoch,
            segments: (main.segment, sub.segment),
            main_attitude,
            sub_attitude: sub.attitude,
            main_velocity: if last.is_some() { main.velocity } else { Vec3::ZERO },
            sub_velocity: sub.velocity,
        });
        pair
    }

    /// What is known of an instant without the sub unit.
    fn unpaired(&mut self, main: &Node<MainStart, Main>, flags: Flags) -> ImuPair {
        let time_ns = main.header.time_ns;
        let mut pair = ImuPair {
            header: main.header,
            interval_ns: self
                .previous_ns
                .map(|previous| time_ns - previous)
                .filter(|&d| d > 0)
                .unwrap_or(self.settings.interval_ns),
            area: self.settings.area,
            flags,
            ..ImuPair::default()
        };
        pair.header.stamps.complete_ns = pair.header.stamps.source_ns;
        while self.ins.front().is_some_and(|a| a.header.sequence < main.header.sequence) {
            self.ins.pop_front();
        }
        if let Some(ins) = self.ins.front().filter(|a| a.header.sequence == main.header.sequence) {
            pair.ins = ins.q;
            pair.ins_sigma = ins.sigma;
        }
        pair
    }
}
