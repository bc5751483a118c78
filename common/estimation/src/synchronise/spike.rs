//! Samples that are far off for one instant only: found in a unit's own stream, before anything is integrated.
//!
//! A value is compared with the line through its neighbours, two before and two after; the scale is the median of the same
//! differences over the last whole block, so that noise, flexure and swell set it by themselves. A spike leaves the line and returns
//! to it. A step does not return: the deck's rate of bending steps in a slam, and must pass. An ordinary sample is
//! handed on at once; one that leaves the line of its past waits for the two after it. Spikes too small to be told without them are
//! found when it is too late, and then let every sample of the unit wait for a while; of a unit that goes on spiking all channels are then judged
//! [together](super::joint).
//!
//! Blocks begin at fixed sample numbers, so that a unit that is joined a few samples later is judged alike.

use super::joint::{CHANNELS, Doubts, Joint};
use super::roughness::{Roughness, Scale};
use frames::unit;
use messages::{Flags, ImuSample};
use std::collections::VecDeque;

/// Values kept of each channel: enough for a fourth difference that ends at the sample that is judged.
pub(super) const ROWS: usize = 7;
/// Samples after the one that is judged.
pub(super) const AHEAD: usize = 2;
/// The row that is judged.
pub(super) const CENTRE: usize = ROWS - 1 - AHEAD;
/// A sample waits if it is so many standard deviations off the line of its past.
const SUSPICIOUS: f64 = 4.0;
/// A spike is off the line of its past and off that of its future by at least so much of the excess.
const OFF: f64 = 0.25;
/// The lines of past and future may differ by so much of the excess on either side, and what lasts may be so much of it, or it is a step: of one that
/// falls into the sample the excess is at most half.
const STEP: f64 = 2.0 / 3.0;
/// After a spike the next value lies on the line of the past within so many standard deviations; after a step it does not.
const RETURN: f64 = 3.0;
/// A velocity excess is real if a step of the gyros acting on the lever arm explains more than this share of it. With a fifth one spike of a thousand
/// deviations in fifty passed for real, by the chance of a gyro's three deviations.
const EXPLAINED: f64 = 0.5;
/// Nominal length of a block, s, and the least and largest number of its samples.
const BLOCK_S: f64 = 5.0;
const BLOCK: (u64, u64) = (256, 512);
/// So many spikes in a block let every sample wait, for so many blocks after the last such one.
const MANY: u32 = 3;
const WATCH: u32 = 12;
/// So many such blocks in a row are no chance: three in a block are now and then, and slams show as two or three.
const STEADY: u32 = 2;
/// Differences below so much of a value are rounding.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// What the spike test is told.
#[derive(Clone, Copy, Debug)]
pub(super) struct Told {
    /// Multiple of the scale beyond which a sample is a spike; 0 for no test.
    pub threshold: f64,
    /// How far from the axis of a sudden turn the accelerometers may sit, m.
    pub lever_arm: f64,
    pub interval_ns: i64,
    /// Longest hole after which the scale still holds, ns.
    pub bridge_ns: i64,
}

/// A sample with what the test says of it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Judged {
    pub sample: ImuSample,
    pub flags: Flags,
    /// Standard deviation of what a replaced or an overlooked spike leaves in the angle, rad.
    pub disturbance: f64,
    decided: bool,
}

/// The test of one unit: channels 0 to 2 are gyros, 3 to 5 accelerometers.
#[derive(Debug)]
pub(super) struct SpikeTest {
    told: Told,
    rows: [[f64; CHANNELS]; ROWS],
    doubts: Doubts,
    /// How many of the rows, from the newest on, follow each other without a hole.
    filled: usize,
    waiting: VecDeque<Judged>,
    roughness: [Roughness; 6],
    /// Learns while every sample waits.
    joint: Joint,
    block: u64,
    last: Option<(u64, i64)>,
    /// Whether the block began while the unit was there.
    whole: bool,
    /// Rows of this block in which a channel by itself shows a spike, and how many blocks in a row had many.
    found: u32,
    many: u32,
    watch: u32,
    /// Whether the unit has spiked for long enough that all channels are asked together while it is watched.
    spikes: bool,
}

impl SpikeTest {
    pub fn new(told: Told) -> Self {
        let block = ((BLOCK_S / unit::seconds(told.interval_ns)).round() as u64).clamp(BLOCK.0, BLOCK.1);
        Self {
            told,
            rows: [[0.0; CHANNELS]; ROWS],
            doubts: [[false; CHANNELS]; ROWS],
            filled: 0,
            waiting: VecDeque::with_capacity(ROWS),
            roughness: std::array::from_fn(|_| Roughness::new(block as usize)),
            joint: Joint::new(),
            block,
            last: None,
            whole: false,
            found: 0,
            many: 0,
            watch: 0,
            spikes: false,
        }
    }

    /// Takes the next sample in order.
    pub fn push(&mut self, sample: &ImuSample) {
        let [a, b, c] = sample.dtheta;
        let [d, e, f] = sample.dvel;
        let values = [a, b, c, d, e, f];
        let usable = self.told.threshold > 0.0 && values.iter().all(|x| x.is_finite());
        self.follow(sample);
        let judged = Judged { sample: *sample, flags: Flags::empty(), disturbance: 0.0, decided: !usable };
        self.waiting.push_back(judged);
        if !usable {
            self.release();
            return;
        }
        self.rows.copy_within(1.., 0);
        self.rows[ROWS - 1] = values;
        self.doubts.copy_within(1.., 0);
        self.doubts[ROWS - 1] = [false; CHANNELS];
        self.filled = ROWS.min(self.filled + 1);
        if self.filled > 2 * AHEAD {
            self.judge();
        }
    }

    /// The next sample that need not wait.
    pub fn pop(&mut self) -> Option<Judged> {
        let front = self.waiting.front()?;
        if !front.decided && self.must_wait() {
            return None;
        }
        self.waiting.pop_front()
    }

    /// Lets go what waits as it is; nothing is compared across this point.
    pub fn release(&mut self) {
        self.waiting.iter_mut().for_each(|judged| judged.decided = true);
        self.joint.interrupt();
        self.filled = 0;
    }

    /// Ends blocks and sees holes.
    fn follow(&mut self, sample: &ImuSample) {
        let (number, time_ns) = (sample.header.sequence, sample.header.time_ns);
        if let Some((last, last_ns)) = self.last {
            let hole_ns = time_ns - last_ns - self.told.interval_ns;
            if number != last + 1 || 2 * hole_ns.abs() > self.told.interval_ns {
                self.release();
            }
            if number <= last || hole_ns > self.told.bridge_ns || hole_ns <= -self.told.interval_ns {
                self.roughness.iter_mut().for_each(Roughness::clear);
                self.joint.clear();
                (self.whole, self.found, self.many, self.watch, self.spikes) = (false, 0, 0, 0, false);
            } else if number / self.block != last / self.block {
                self.end_block();
            }
        }
        self.whole |= number.is_multiple_of(self.block);
        self.last = Some((number, time_ns));
    }

    fn end_block(&mut self) {
        // holes leave fewer values
        let least = if self.whole { self.block as usize / 2 } else { usize::MAX };
        self.whole = true;
        self.roughness.iter_mut().for_each(|roughness| roughness.end_block(least));
        let is_many = self.found >= MANY;
        self.many = if is_many { self.many + 1 } else { 0 };
        self.watch = if is_many { WATCH } else { self.watch.saturating_sub(1) };
        self.spikes = self.watch > 0 && (self.spikes || self.many >= STEADY);
        self.found = 0;
        if self.watch > 0 {
            let alone = self.roughness.each_ref().map(|roughness| roughness.scale().map(|scale| scale.spike()));
            self.joint.end_block(&alone);
        } else {
            self.joint.clear();
        }
    }

    /// Whether the first sample that waits, none before it waiting, has to wait for those after it.
    fn must_wait(&self) -> bool {
        let row = ROWS - self.waiting.len();
        let past = self.filled - self.waiting.len();
        if past < AHEAD || self.roughness.iter().all(|roughness| roughness.scale().is_none()) {
            return false;
        }
        self.watch > 0 || (0..6).any(|channel| self.suspicious(channel, row, past))
    }

    fn suspicious(&self, channel: usize, row: usize, past: usize) -> bool {
        let Some(scale) = self.roughness[channel].scale() else { return false };
        let y = |back: usize| self.rows[row - back][channel];
        let (off, sigma) = if past >= 4 && row >= 4 && scale.bends(1.0, 1.0) {
            (y(0) - 4.0 * y(1) + 6.0 * y(2) - 4.0 * y(3) + y(4), scale.fourth)
        } else {
            (y(0) - 2.0 * y(1) + y(2), scale.second)
        };
        off.abs() > (SUSPICIOUS * sigma).max(ROUNDING * y(0).abs())
    }

    /// Judges the sample that now has two after it.
    fn judge(&mut self) {
        let mut excess = [0.0; 6];
        let (mut flags, mut left) = (Flags::empty(), 0.0f64);
        let waits = self.waiting.len() > AHEAD;
        let alone: [Option<Found>; CHANNELS] = std::array::from_fn(|channel| self.alone(channel));
        // what is found together only must not bear itself out
        let is_seen = alone.iter().any(Option::is_some);
        let found = self.together().unwrap_or(alone);
        for (channel, found) in found.into_iter().enumerate() {
            let taps = self.taps(channel);
            self.roughness[channel].add(taps.second(), taps.fourth(), self.whole);
            let Some(found) = found else { continue };
            excess[channel] = found.excess;
            self.doubts[CENTRE][channel] = true;
            flags |= Flags::SPIKE;
            if channel < 3 {
                left = left.max(if waits { found.sigma } else { found.excess.abs() });
            }
        }
        if is_seen {
            self.found += 1;
            self.watch = if self.found >= MANY { WATCH } else { self.watch };
        }
        let place = if waits { self.waiting.len() - 1 - AHEAD } else { self.waiting.len() - 1 };
        let judged = &mut self.waiting[place];
        judged.flags |= flags;
        judged.disturbance = judged.disturbance.hypot(left);
        if waits {
            judged.decided = true;
            for axis in 0..3 {
                judged.sample.dtheta[axis] -= excess[axis];
                judged.sample.dvel[axis] -= excess[3 + axis];
            }
            (0..6).for_each(|channel| self.rows[CENTRE][channel] -= excess[channel]);
        }
        if self.watch > 0 {
            self.joint.take(&self.rows[CENTRE], !flags.is_empty());
        }
    }

    /// The spikes of the sample that is judged by all channels together; `None` where they cannot tell.
    fn together(&mut self) -> Option<[Option<Found>; 6]> {
        let is_whole = self.watch > 0 && self.filled == ROWS;
        let found = is_whole.then(|| self.joint.spikes(&self.rows, &self.doubts, self.told.threshold)).flatten();
        found.filter(|_| self.spikes)
    }

    /// The spike of a channel of the sample that is judged by itself.
    fn alone(&self, channel: usize) -> Option<Found> {
        let (taps, scale) = (self.taps(channel), self.roughness[channel].scale()?);
        let found = taps.spike(scale, self.told.threshold, self.filled == ROWS)?;
        (channel < 3 || !self.explains(found.excess)).then_some(found)
    }

    fn taps(&self, channel: usize) -> Taps {
        Taps(self.rows.map(|row| row[channel]))
    }

    /// Whether a step of the turn about the sample, acting on the lever arm, explains a velocity excess.
    fn explains(&self, excess: f64) -> bool {
        let step = |channel: usize| Some(self.taps(channel).lasting_step(self.roughness[channel].scale()?));
        let turn = (0..3).filter_map(step).map(|step| step * step).sum::<f64>().sqrt();
        turn / unit::seconds(self.told.interval_ns) * self.told.lever_arm > EXPLAINED * excess.abs()
    }
}

/// A value of a channel with its neighbours: four before and two after, of which the earliest two may be missing.
#[derive(Clone, Copy, Debug)]
struct Taps([f64; ROWS]);

/// A spike, with the standard deviation of what is left when it is taken off.
pub(super) struct Found {
    pub excess: f64,
    pub sigma: f64,
}

impl Taps {
    fn second(self) -> f64 {
        let [.., a, y, b, _] = self.0;
        a - 2.0 * y + b
    }

    fn fourth(self) -> f64 {
        let [.., a2, a, y, b, b2] = self.0;
        a2 - 4.0 * a + 6.0 * y - 4.0 * b + b2
    }

    /// From the line through those before to the line through those after.
    fn step(self) -> f64 {
        let [.., a2, a, _, b, b2] = self.0;
        (2.0 * b - b2) - (2.0 * a - a2)
    }

    /// `whole` says that the earliest two are there.
    fn spike(self, scale: Scale, threshold: f64, whole: bool) -> Option<Found> {
        let single = if scale.bends(2.0, 6.0) { self.among_swell(scale, whole) } else { self.among_noise(scale) };
        let limit = |found: &Found| (threshold * found.sigma).max(ROUNDING * self.0[CENTRE].abs());
        // a pair first: the line between both neighbours is bent by the second of them
        self.double(scale, threshold)
            .or_else(|| single.filter(|found| found.excess.abs() > limit(found) && self.returns(found, scale)))
    }

    /// Whether those after go on where those before left off.
    fn returns(self, found: &Found, scale: Scale) -> bool {
        self.lasting_step(scale) <= STEP * found.excess.abs() && self.step().abs() <= 2.0 * STEP * found.excess.abs()
    }

    /// By how much the next two values are both off the line of the past, beyond noise; a spike of one of them is no step.
    fn lasting_step(self, scale: Scale) -> f64 {
        let [.., a2, a, _, b, b2] = self.0;
        let (next, after) = (b - 3.0 * a + 2.0 * a2, b2 - 4.0 * a + 3.0 * a2);
        let step = if next * after > 0.0 { next.abs().min(after.abs()) } else { 0.0 };
        let noise = (RETURN * 3f64.sqrt() * scale.second).max(ROUNDING * a.abs());
        if step > noise { step } else { 0.0 }
    }

    /// Off the middle of both neighbours, and off both lines.
    fn among_noise(self, scale: Scale) -> Option<Found> {
        let [.., a2, a, y, b, b2] = self.0;
        let excess = -self.second() / 2.0;
        let off = |line: f64| (y - line) * excess.signum() >= OFF * excess.abs();
        (off(2.0 * a - a2) && off(2.0 * b - b2)).then_some(Found { excess, sigma: scale.second / 2.0 })
    }

    /// Off the cubic through four neighbours, and off that of the past.
    fn among_swell(self, scale: Scale, whole: bool) -> Option<Found> {
        let [a4, a3, a2, a, y, ..] = self.0;
        let excess = self.fourth() / 6.0;
        let past = a4 - 4.0 * a3 + 6.0 * a2 - 4.0 * a + y;
        let is_off = past * excess.signum() >= OFF * excess.abs();
        (whole && is_off).then_some(Found { excess, sigma: scale.fourth / 6.0 })
    }

    /// Two in a row hide each other; the second is found next, beside the first one's replacement.
    fn double(self, scale: Scale, threshold: f64) -> Option<Found> {
        let [.., a2, a, y, b, b2] = self.0;
        let (excess, next) = (y - (2.0 * a + b2) / 3.0, b - (a + 2.0 * b2) / 3.0);
        let least = excess.abs().min(next.abs());
        let limit = (threshold * scale.second).max(ROUNDING * y.abs());
        let returns = (b2 - a - 3.0 * (a - a2)).abs() <= STEP * least;
        (least > limit && returns).then_some(Found { excess, sigma: scale.second })
    }
}
