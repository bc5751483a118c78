//! Watches the channels of one unit: range, and values that no longer change.

use messages::{Flags, ImuSample};

/// No channel is stuck that has kept every bit for fewer samples than this while another one moved.
const LEAST: u32 = 20;
/// A run of equal values is a fault if the channel, as it moved so far, gives one so long by chance with this probability.
const CHANCE: f64 = 1e-9;
/// A slow or coarse channel repeats itself longer than chance: so many times the longest run so far is no fault.
const LONGER: u32 = 3;
/// Steps after which what was learnt of a channel counts half.
const MEMORY: u32 = 8192;
/// How near to the end of the range a value counts as clipped; the last code of a converter lies somewhat below the nominal end.
const CLIP: f64 = 0.998;

/// How often and for how long a channel repeats its value when nothing is wrong.
#[derive(Clone, Copy, Debug)]
struct Habit {
    value: f64,
    run: u32,
    longest: u32,
    steps: u32,
    repeats: u32,
}

impl Habit {
    const NEW: Self = Self { value: f64::NAN, run: 0, longest: 0, steps: 0, repeats: 0 };

    /// Whether the value prolongs a run that is no habit.
    fn is_stuck(&mut self, value: f64) -> bool {
        let same = value.to_bits() == self.value.to_bits();
        if same {
            self.run = self.run.saturating_add(1);
            if self.run >= self.limit() {
                return true;
            }
        } else {
            if self.run < self.limit() {
                self.longest = self.longest.max(self.run);
            }
            (self.value, self.run) = (value, 0);
        }
        if self.steps == MEMORY {
            (self.steps, self.repeats, self.longest) = (self.steps / 2, self.repeats / 2, self.longest / 2);
        }
        self.steps += 1;
        self.repeats += u32::from(same);
        false
    }

    /// The length of a run from which on it is a fault.
    fn limit(&self) -> u32 {
        let repeating = f64::from(self.repeats + 1) / f64::from(self.steps + 2);
        // the cast saturates
        let by_chance = (CHANCE.ln() / repeating.ln()).ceil() as u32;
        LEAST.max(by_chance).max(self.longest.saturating_mul(LONGER))
    }

    fn has_moved(&self) -> bool {
        self.steps > self.repeats + 1
    }
}

/// No deck falls so freely that its accelerometers feel less than this, m/s^2.
const LEAST_FORCE: f64 = 1.0;

/// The memory of the channels: three gyros, then three accelerometers.
#[derive(Clone, Copy, Debug)]
pub(super) struct Channels {
    range: Option<f64>,
    habits: [Habit; 6],
}

impl Channels {
    /// Channels with a measuring range of the gyros in rad/s.
    pub fn new(range: Option<f64>) -> Self {
        Self { range, habits: [Habit::NEW; 6] }
    }

    /// The flags that this sample's numbers deserve.
    pub fn inspect(&mut self, sample: &ImuSample, interval_s: f64) -> Flags {
        if !sample.dtheta.iter().chain(&sample.dvel).all(|x| x.is_finite()) {
            return Flags::NOT_FINITE;
        }
        let mut stuck = [false; 6];
        let mut flags = Flags::empty();
        for axis in 0..3 {
            let rate = sample.dtheta[axis] / interval_s;
            stuck[axis] = self.habits[axis].is_stuck(rate);
            // a unit without accelerometers gives none that move
            let habit = &mut self.habits[3 + axis];
            stuck[3 + axis] = habit.is_stuck(sample.dvel[axis]) && habit.has_moved();
            if self.range.is_some_and(|range| rate.abs() >= CLIP * range) {
                flags |= Flags::SATURATED;
            }
        }
        let force = sample.dvel.iter().map(|v| v * v).sum::<f64>().sqrt() / interval_s;
        if force < LEAST_FORCE && self.habits[3..].iter().any(Habit::has_moved) {
            flags |= Flags::ACCEL_STUCK;
        }
        if self.habits.iter().any(|habit| habit.run == 0) {
            if stuck[..3].contains(&true) {
                flags |= Flags::STUCK;
            }
            if stuck[3..].contains(&true) {
                flags |= Flags::ACCEL_STUCK;
            }
        }
        flags
    }
}
