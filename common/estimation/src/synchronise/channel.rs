//! Watches the channels of one unit: range, and values that no longer change.

use messages::{Flags, ImuSample};

/// A channel that has kept every bit for so many samples while another one moved is stuck.
const STUCK_SAMPLES: u32 = 20;
/// How near to the end of the range a value counts as clipped; the last code of a converter lies somewhat below the nominal end.
const CLIP: f64 = 0.998;

/// The memory of the three gyro channels.
#[derive(Clone, Copy, Debug)]
pub(super) struct Channels {
    range: Option<f64>,
    value: [f64; 3],
    repeats: [u32; 3],
}

impl Channels {
    /// Channels with a measuring range in rad/s.
    pub fn new(range: Option<f64>) -> Self {
        Self { range, value: [f64::NAN; 3], repeats: [0; 3] }
    }

    /// The flags that this sample's numbers deserve.
    pub fn inspect(&mut self, sample: &ImuSample, interval_s: f64) -> Flags {
        if !sample.dtheta.iter().chain(&sample.dvel).all(|x| x.is_finite()) {
            return Flags::NOT_FINITE;
        }
        let mut flags = Flags::empty();
        let mut rate = [0.0; 3];
        for axis in 0..3 {
            rate[axis] = sample.dtheta[axis] / interval_s;
            let same = rate[axis].to_bits() == self.value[axis].to_bits();
            self.repeats[axis] = if same { self.repeats[axis].saturating_add(1) } else { 0 };
            if self.range.is_some_and(|range| rate[axis].abs() >= CLIP * range) {
                flags |= Flags::SATURATED;
            }
        }
        self.value = rate;
        let moving = self.repeats.contains(&0);
        if moving && self.repeats.iter().any(|&n| n >= STUCK_SAMPLES) {
            flags |= Flags::STUCK;
        }
        flags
    }
}
