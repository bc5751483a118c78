//! An angle that is known with its rate at the knots of a fixed grid and is a cubic between them.
//!
//! The cubic IS the motion: its derivative is the rate that the gyros feel, so increments are exact at any instant, and the
//! motion does not depend on the sampling rate. The grid is so fine that a sea of 0.4 Hz differs by 1e-6 of its amplitude
//! from the motion that was drawn; a process without a band limit loses what lies above 10 Hz.

use crate::process::Process;
use crate::random::Source;
use crate::resonator::Resonance;
use crate::{RandomSwing, Tones};
use std::collections::VecDeque;
use std::f64::consts::TAU;

/// From one knot to the next, s: the sampling instants of 20 Hz are knots.
pub(crate) const SPACING: f64 = 0.05;
/// Half the width of the tones' band over its middle.
const BAND: f64 = 0.3;
/// The longest history that is kept, s.
const LONGEST: f64 = 1e4;

/// `[angle, rate]` (rad, rad/s), and the same a quarter of a period late.
pub(crate) type Knot = [[f64; 2]; 2];

enum Generator {
    Tones { amplitude: f64, w_and_phase: Vec<[f64; 2]> },
    Process(Box<Process>),
}

/// The angle, as far as it has been drawn and is still remembered.
pub(crate) struct Knots {
    generator: Generator,
    knots: VecDeque<Knot>,
    /// The number of the knot at the front; knot 0 is at t = 0.
    first: usize,
    capacity: usize,
    rms: f64,
}

impl Knots {
    pub(crate) fn of_tones(tones: &Tones, mut source: Source, history_s: f64) -> Self {
        let count = if tones.period > 0.0 { tones.count } else { 0 };
        let middle = TAU / tones.period;
        let w_and_phase = (0..count).map(|i| {
            let place = 2.0 * (i as f64 + source.uniform()) / count as f64 - 1.0;
            [middle * (1.0 + BAND * place), TAU * source.uniform()]
        });
        let w_and_phase = w_and_phase.collect();
        let rms = if count > 0 { tones.rms } else { 0.0 };
        let amplitude = rms * (2.0 / count.max(1) as f64).sqrt();
        Self::new(Generator::Tones { amplitude, w_and_phase }, rms, history_s)
    }

    pub(crate) fn of_process(swing: &RandomSwing, source: Source, history_s: f64) -> Self {
        let process = Box::new(Process::stationary(swing, source));
        let rms = process.rms();
        Self::new(Generator::Process(process), rms, history_s)
    }

    fn new(generator: Generator, rms: f64, history_s: f64) -> Self {
        let capacity = (history_s.clamp(0.0, LONGEST) / SPACING).ceil() as usize + 4;
        let mut knots = Self { generator, knots: VecDeque::with_capacity(capacity + 1), first: 0, capacity, rms };
        knots.draw();
        knots.draw();
        knots
    }

    fn draw(&mut self) {
        let number = self.first + self.knots.len();
        self.knots.push_back(match &mut self.generator {
            Generator::Tones { amplitude, w_and_phase } => sum(*amplitude, w_and_phase, number as f64 * SPACING),
            Generator::Process(process) => process.knot(),
        });
        if self.knots.len() > self.capacity {
            self.knots.pop_front();
            self.first += 1;
        }
    }

    /// Draws what is needed for times up to `t`.
    pub(crate) fn advance(&mut self, t: f64) {
        while ((self.first + self.knots.len() - 1) as f64) * SPACING <= t {
            self.draw();
        }
    }

    /// Angle and rate at the time `t`, of the motion (0) or of the late one (1); before t = 0 it is a straight line.
    pub(crate) fn at(&self, t: f64, which: usize) -> (f64, f64) {
        let knot = |i: usize| self.knots.get(i).map_or([0.0; 2], |knot| knot[which]);
        if t < 0.0 && self.first == 0 {
            let [angle, rate] = knot(0);
            return (angle + rate * t, rate);
        }
        let i = ((t / SPACING) as usize).saturating_sub(self.first).min(self.knots.len().saturating_sub(2));
        let u = t / SPACING - (self.first + i) as f64;
        let ([a, adot], [b, bdot]) = (knot(i), knot(i + 1));
        let (p, q) = (adot * SPACING - (b - a), (b - a) - bdot * SPACING);
        let angle = a + u * ((b - a) + (1.0 - u) * (p * (1.0 - u) + q * u));
        let slope = (b - a) + (1.0 - 2.0 * u) * (p * (1.0 - u) + q * u) + u * (1.0 - u) * (q - p);
        (angle, slope / SPACING)
    }

    /// Standard deviation of the angle, rad.
    pub(crate) fn rms(&self) -> f64 {
        self.rms
    }

    /// Standard deviations of angle and rate (rad, rad/s) of what a resonance makes of the angle.
    pub(crate) fn resonant_rms(&self, resonance: &Resonance) -> [f64; 2] {
        match &self.generator {
            Generator::Tones { w_and_phase, .. } => {
                resonance.of_lines(self.rms, w_and_phase.iter().map(|tone| tone[0]))
            }
            Generator::Process(process) => resonance.of_process(process.swing()),
        }
    }
}

fn sum(amplitude: f64, w_and_phase: &[[f64; 2]], t: f64) -> Knot {
    w_and_phase.iter().fold([[0.0; 2]; 2], |[now, late], [w, phase]| {
        let (sine, cosine) = (w * t + phase).sin_cos();
        let add = |[angle, rate]: [f64; 2], a: f64, r: f64| [angle + amplitude * a, rate + amplitude * w * r];
        [add(now, sine, cosine), add(late, -cosine, sine)]
    })
}
