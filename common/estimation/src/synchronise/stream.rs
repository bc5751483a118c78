//! One unit's stream: in order, without repeats, short holes bridged, increments composed into an attitude.

use super::channel::Channels;
use super::spike::{Judged, SpikeTest, Told};
use super::{Counts, Unit};
use frames::{Frame, Rot, Vec3, unit};
use messages::{Flags, Header, ImuSample};
use std::collections::VecDeque;

/// So many later samples are held back for a missing one.
const REORDER: usize = 3;
/// A sample number so far below the expected one means that the unit began to count anew.
const RECOUNT: u64 = 64;
/// A stamp so far back means that the unit's clock was set, ns.
const CLOCK_SET_NS: i64 = 1_000_000_000;
/// Error of a bridged angle as a share of the change of rate times the hole: what a sine of wave periods leaves.
const BRIDGE_ERROR: f64 = 0.02;

/// A sample with the attitude that all increments up to it compose to.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node<S: Frame, B: Frame> {
    pub header: Header,
    pub interval_ns: i64,
    /// The sample's own increments, in body axes.
    pub dtheta: Vec3<B>,
    pub dvel: Vec3<B>,
    /// From the previous node: a bridged hole and the sample.
    step: Rot<B, B>,
    step_dvel: Vec3<B>,
    pub attitude: Rot<S, B>,
    pub velocity: Vec3<B>,
    pub disturbance: f64,
    /// Changes where a hole was too long to be bridged.
    pub segment: u64,
    pub flags: Flags,
    /// Holds the place of a sample whose numbers could not be used.
    pub void: bool,
}

/// The stream of one unit with body axes `B`, whose attitude is accumulated from the frame `S`.
#[derive(Debug)]
pub(super) struct Stream<S: Frame, B: Frame> {
    unit: Unit<B>,
    interval_ns: i64,
    bridge_ns: i64,
    /// Whether a sample that cannot be used still takes its place.
    keeps_void: bool,
    spikes: SpikeTest,
    channels: Channels,
    expected: Option<u64>,
    held: Vec<ImuSample>,
    last: Option<Node<S, B>>,
    segment: u64,
    /// Why samples have been refused since the last good one.
    pub refusals: Flags,
    pub nodes: VecDeque<Node<S, B>>,
    pub counts: Counts,
}

impl<S: Frame, B: Frame> Stream<S, B> {
    pub fn new(unit: Unit<B>, told: Told, keeps_void: bool) -> Self {
        Self {
            unit,
            interval_ns: told.interval_ns,
            bridge_ns: told.bridge_ns,
            keeps_void,
            spikes: SpikeTest::new(told),
            channels: Channels::new(unit.range),
            expected: None,
            held: Vec::with_capacity(REORDER + 1),
            last: None,
            segment: 0,
            refusals: Flags::empty(),
            nodes: VecDeque::with_capacity(256),
            counts: Counts::default(),
        }
    }

    /// Takes a sample as it arrives.
    pub fn push(&mut self, sample: &ImuSample) {
        let number = sample.header.sequence;
        match self.expected {
            Some(expected) if number.saturating_add(RECOUNT) < expected => {
                self.flush();
                self.segment += 1;
                self.test(sample);
            }
            Some(expected) if number < expected => self.counts.refused += 1,
            Some(expected) if number > expected => self.hold(sample),
            _ => {
                self.test(sample);
                self.release();
            }
        }
    }

    /// Gives up waiting for samples that are missing or might tell of a spike.
    pub fn flush(&mut self) {
        while !self.held.is_empty() {
            self.skip_to_held();
        }
        self.spikes.release();
        self.hand_on();
    }

    fn hold(&mut self, sample: &ImuSample) {
        match self.held.binary_search_by_key(&sample.header.sequence, |held| held.header.sequence) {
            Ok(_) => self.counts.refused += 1,
            Err(place) => self.held.insert(place, *sample),
        }
        if self.held.len() > REORDER {
            self.skip_to_held();
        }
    }

    fn skip_to_held(&mut self) {
        let first = self.held.remove(0);
        self.counts.missing += self.expected.map_or(0, |expected| first.header.sequence - expected);
        self.test(&first);
        self.release();
    }

    fn release(&mut self) {
        while self.held.first().is_some_and(|held| Some(held.header.sequence) == self.expected) {
            let next = self.held.remove(0);
            self.test(&next);
        }
    }

    /// The next sample in order.
    fn test(&mut self, sample: &ImuSample) {
        self.expected = Some(sample.header.sequence + 1);
        self.spikes.push(sample);
        self.hand_on();
    }

    fn hand_on(&mut self) {
        while let Some(judged) = self.spikes.pop() {
            self.accept(&judged);
        }
    }

    fn accept(&mut self, judged: &Judged) {
        let sample = &judged.sample;
        let interval_ns = if sample.interval_ns > 0 { sample.interval_ns } else { self.interval_ns };
        let found = self.channels.inspect(sample, unit::seconds(interval_ns)) | sample.flags | judged.flags;
        let back_ns = self.last.map_or(0, |last| last.header.time_ns - sample.header.time_ns);
        if self.last.is_some() && (0..CLOCK_SET_NS).contains(&back_ns) {
            self.counts.refused += 1;
            self.refusals |= if back_ns > 0 { Flags::TIME_BACK } else { Flags::empty() };
            return;
        }
        if back_ns >= CLOCK_SET_NS {
            self.refusals |= Flags::TIME_BACK;
            self.segment += 1;
        }
        if found.intersects(Flags::NOT_FINITE | Flags::STUCK) {
            self.refusals |= found;
            if found.contains(Flags::NOT_FINITE) {
                self.counts.refused += 1;
            } else {
                self.counts.suspect += 1;
            }
            if self.keeps_void {
                self.nodes.push_back(self.void(sample, found));
            }
            return;
        }
        self.counts.suspect += u64::from(found.intersects(Flags::SATURATED | Flags::SPIKE | Flags::ACCEL_STUCK));
        let mut node = self.compose(sample, interval_ns, found);
        node.disturbance = node.disturbance.hypot(judged.disturbance);
        self.refusals = Flags::empty();
        self.last = Some(node);
        self.nodes.push_back(node);
    }

    fn void(&self, sample: &ImuSample, flags: Flags) -> Node<S, B> {
        Node {
            header: sample.header,
            interval_ns: self.interval_ns,
            dtheta: Vec3::ZERO,
            dvel: Vec3::ZERO,
            step: Rot::identity(),
            step_dvel: Vec3::ZERO,
            attitude: Rot::identity(),
            velocity: Vec3::ZERO,
            disturbance: 0.0,
            segment: self.segment,
            flags,
            void: true,
        }
    }

    /// The node of a good sample: bridges a short hole before it, starts a new segment after a long one.
    fn compose(&mut self, sample: &ImuSample, interval_ns: i64, found: Flags) -> Node<S, B> {
        let turn = |v: [f64; 3]| self.unit.mounting * Vec3::from(v);
        let (dtheta, dvel) = (turn(sample.dtheta), turn(sample.dvel));
        let mut node = Node {
            interval_ns,
            dtheta,
            dvel,
            step: Rot::exp(dtheta),
            step_dvel: dvel,
            flags: found | self.refusals,
            void: false,
            ..self.void(sample, Flags::empty())
        };
        if found.contains(Flags::SATURATED) {
            // how far beyond its range the rate went is not known: as far again
            node.disturbance = dtheta.norm();
        }
        let Some(last) = self.last else { return node };
        let hole_ns = sample.header.time_ns - interval_ns - last.header.time_ns;
        if hole_ns > self.bridge_ns {
            self.segment += 1;
        } else if hole_ns > interval_ns / 2 {
            let (before, after) = (last.interval_ns as f64, interval_ns as f64);
            let hole = hole_ns as f64;
            let mean = |a: Vec3<B>, b: Vec3<B>| (a / before + b / after) * (0.5 * hole);
            let change = (dtheta / after - last.dtheta / before) * hole;
            node.step = Rot::<B, B>::exp(mean(last.dtheta, dtheta)) * node.step;
            node.step_dvel = mean(last.dvel, dvel) + dvel;
            node.disturbance = node.disturbance.hypot(BRIDGE_ERROR * change.norm());
            node.flags |= Flags::BRIDGED;
        }
        node.segment = self.segment;
        node.attitude = (last.attitude * node.step).normalised();
        node.velocity = last.velocity + node.step_dvel;
        node
    }

    /// Lets the accumulation start at the node `index`.
    pub fn rebase(&mut self, index: usize) {
        let nodes = &mut self.nodes;
        nodes[index].attitude = Rot::identity();
        nodes[index].velocity = Vec3::ZERO;
        for i in (1..=index).rev() {
            nodes[i - 1].attitude = nodes[i].attitude * nodes[i].step.inverse();
            nodes[i - 1].velocity = nodes[i].velocity - nodes[i].step_dvel;
        }
        let mut left = nodes[index];
        for node in nodes.iter_mut().skip(index + 1).filter(|node| !node.void) {
            node.attitude = (left.attitude * node.step).normalised();
            node.velocity = left.velocity + node.step_dvel;
            left = *node;
        }
        self.last = Some(left);
    }

    /// Drops the nodes that no later instant can need.
    pub fn forget_before(&mut self, time_ns: i64) {
        while self.nodes.len() > 3 && self.nodes[2].header.time_ns <= time_ns {
            self.nodes.pop_front();
        }
    }
}
