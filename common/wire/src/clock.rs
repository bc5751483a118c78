use crate::line::Line;

/// Arrivals are judged in blocks of at least so long, s: the least delayed one of a block tells.
const BLOCK_S: f64 = 0.25;
/// And of at least so many.
const BLOCK: u32 = 16;
/// A crystal is off its nominal rate by about so much.
const SKEW_SIGMA: f64 = 1e-4;
/// What is known of the least delay of a block before anything was seen, s.
const FIRST_SPREAD: f64 = 2e-5;
/// No arrival is noted better than this, s.
const FINEST: f64 = 2e-6;
/// Blocks beyond so many standard deviations count less.
const GATE: f64 = 4.0;
/// An arrival before the line by more than this cannot be noise, s.
const EARLY: f64 = 3e-4;
/// Before the first block is whole: a fast device of many samples a second comes earlier by its skew alone, s.
const FIRST_EARLY: f64 = 2.0 * SKEW_SIGMA * BLOCK_S;
/// When every block has come late for so long the way itself has become longer, s.
const LONGER_WAY_S: f64 = 5.0;
/// The device's time is trusted after so long, s.
const SETTLE_S: f64 = 1.0;

/// A device's time as the host's, by a filter of two states: offset and skew.
///
/// An arrival can be late by any amount but never early, so the filter follows the least delayed arrivals. What the least delay itself
/// is no arrival can tell: that is the constant latency, which is told.
#[derive(Clone, Debug)]
pub struct Clock {
    latency_ns: i64,
    state: Option<State>,
}

/// Times in seconds since the anchor, so that numbers stay small.
#[derive(Clone, Debug)]
struct State {
    device_ns: i64,
    host_ns: i64,
    /// How much later than by the device's clock the least delayed arrivals come, against the device's time.
    line: Line,
    block: Option<Block>,
    blocks: u32,
    /// How far apart the two least delayed arrivals of a block are, smoothed.
    spread: f64,
    /// Device time of the last block that was not late.
    sound_s: f64,
    last_s: f64,
    lateness: f64,
    variance: f64,
}

#[derive(Clone, Copy, Debug)]
struct Block {
    begin_s: f64,
    count: u32,
    at_s: f64,
    least: f64,
    second: f64,
}

impl Clock {
    /// A clock that has heard nothing; `latency_ns` is from validity to the least delayed arrival.
    pub fn new(latency_ns: i64) -> Self {
        Self { latency_ns, state: None }
    }

    /// Forgets everything: the device's clock has started anew.
    pub fn restart(&mut self) {
        self.state = None;
    }

    /// Takes in that data of the device's time `device_ns` came at the host's `arrival_ns`, and gives their time of validity.
    pub fn hear(&mut self, device_ns: i64, arrival_ns: i64) -> i64 {
        let state = self.state.get_or_insert_with(|| State::new(device_ns, arrival_ns));
        state.hear(device_ns, arrival_ns);
        state.host_ns(device_ns) - self.latency_ns
    }

    /// By how much the arrival was later than the least delayed ones, were it of device time `device_ns`, ns.
    pub fn lateness_ns(&self, device_ns: i64, arrival_ns: i64) -> Option<i64> {
        self.state.as_ref().map(|state| arrival_ns - state.host_ns(device_ns))
    }

    /// Whether enough has been heard for the times to be of use.
    pub fn settled(&self) -> bool {
        self.state.as_ref().is_some_and(|state| state.last_s > SETTLE_S && state.blocks > 1)
    }

    /// By how much the host's clock is faster than the device's, a ratio.
    pub fn skew(&self) -> f64 {
        self.state.as_ref().map_or(0.0, |state| state.line.slope)
    }

    /// Standard deviation of the arrivals' delay over the last seconds, s.
    pub fn jitter(&self) -> f64 {
        self.state.as_ref().map_or(0.0, |state| state.variance.sqrt())
    }

    /// Standard deviation of the mapping's error as the filter knows it, s.
    pub fn sigma(&self) -> f64 {
        self.state.as_ref().map_or(f64::INFINITY, |state| state.line.variance[0].max(0.0).sqrt())
    }
}

impl State {
    fn new(device_ns: i64, host_ns: i64) -> Self {
        Self {
            device_ns,
            host_ns,
            line: Line::new(0.0, 0.0, 1e-3, SKEW_SIGMA),
            block: None,
            blocks: 0,
            spread: FIRST_SPREAD,
            sound_s: 0.0,
            last_s: 0.0,
            lateness: 0.0,
            variance: 0.0,
        }
    }

    fn host_ns(&self, device_ns: i64) -> i64 {
        let since_ns = device_ns - self.device_ns;
        self.host_ns + since_ns + (self.line.value(since_ns as f64 * 1e-9) * 1e9).round() as i64
    }

    fn hear(&mut self, device_ns: i64, arrival_ns: i64) {
        let now_s = (device_ns - self.device_ns) as f64 * 1e-9;
        let late = ((arrival_ns - self.host_ns) - (device_ns - self.device_ns)) as f64 * 1e-9;
        let residual = late - self.line.value(now_s);
        self.note_jitter(residual, now_s);
        self.last_s = now_s;
        // what the line was drawn through so far had been late
        let early = if self.blocks == 0 { FIRST_EARLY } else { EARLY + 5.0 * self.line.variance[0].max(0.0).sqrt() };
        if residual < -early {
            self.line.advance(now_s);
            self.line.offset += residual;
            self.line.variance[0] += residual * residual;
            (self.block, self.sound_s) = (None, now_s);
            return;
        }
        let block = self.block.get_or_insert(Block {
            begin_s: now_s,
            count: 0,
            at_s: now_s,
            least: f64::INFINITY,
            second: f64::INFINITY,
        });
        block.take(residual, now_s);
        if block.count >= BLOCK && now_s - block.begin_s >= BLOCK_S {
            let block = *block;
            self.block = None;
            self.take(&block);
        }
    }

    /// Over some ten seconds at 100 Hz.
    fn note_jitter(&mut self, residual: f64, now_s: f64) {
        let share = ((now_s - self.last_s) / 10.0).clamp(0.0, 1.0);
        let off = residual - self.lateness;
        self.lateness += share * off;
        self.variance = (1.0 - share) * (self.variance + share * off * off);
    }

    fn take(&mut self, block: &Block) {
        let gap = block.second - block.least;
        // a stall in one block says nothing about the others
        self.spread += 0.1 * (gap.min(10.0 * self.spread) - self.spread);
        self.line.advance(block.at_s);
        // the least of many delays lies above the least of all by about as much as the second lies above it
        let innovation = block.least - self.spread;
        let mut noise = self.spread * self.spread + FINEST * FINEST;
        let sigma = (self.line.variance[0] + noise).sqrt();
        if innovation > GATE * sigma {
            noise *= (innovation / (GATE * sigma)).powi(2);
            if block.at_s - self.sound_s > LONGER_WAY_S {
                self.line.variance[0] += innovation * innovation;
                self.sound_s = block.at_s;
            }
        } else {
            self.sound_s = block.at_s;
        }
        self.line.correct(innovation, noise);
        self.blocks += 1;
    }
}

impl Block {
    fn take(&mut self, residual: f64, at_s: f64) {
        self.count += 1;
        if residual < self.least {
            (self.second, self.least, self.at_s) = (self.least, residual, at_s);
        } else if residual < self.second {
            self.second = residual;
        }
    }
}
