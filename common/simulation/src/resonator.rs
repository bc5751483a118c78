//! What a lightly damped resonance makes of the ship's swing.

use crate::RandomSwing;
use crate::gauss_markov::GAUSS;
use crate::process::spectrum;
use crate::random::Source;
use crate::sea::Sea;
use frames::unit::{nanoseconds, seconds};
use std::f64::consts::PI;

/// The longest step, s: the swing is one cubic from knot to knot.
const STEP_S: f64 = crate::knots::SPACING;
/// Points of the spectrum to the half width of its narrowest peak, and how far above the highest natural frequency they reach.
const FINE: f64 = 4.0;
const REACH: f64 = 10.0;
/// The most points of the spectrum.
const POINTS: usize = 2_000_000;

/// `y'' + 2 mu y' + b^2 y = b^2 s` with `0 < mu < b`.
#[derive(Clone, Copy)]
pub(crate) struct Resonance {
    /// 1/s.
    pub(crate) mu: f64,
    /// rad/s.
    pub(crate) b: f64,
}

impl Resonance {
    /// Power of y over that of s at the frequency w, rad/s.
    fn power(&self, w: f64) -> f64 {
        let (b2, w2) = (self.b * self.b, w * w);
        b2 * b2 / ((b2 - w2).powi(2) + 4.0 * self.mu * self.mu * w2)
    }

    /// Standard deviations of y and y' if s is a sum of sines of one amplitude whose standard deviation is `rms`.
    pub(crate) fn of_lines(&self, rms: f64, w: impl ExactSizeIterator<Item = f64>) -> [f64; 2] {
        let each = rms * rms / w.len().max(1) as f64;
        let add = |[y, rate]: [f64; 2], w: f64| [y + each * self.power(w), rate + each * self.power(w) * w * w];
        w.fold([0.0; 2], add).map(f64::sqrt)
    }

    /// The same if s is a random swing. The midpoint rule converges exponentially on such a spectrum.
    pub(crate) fn of_process(&self, swing: &RandomSwing) -> [f64; 2] {
        // an overdamped swing has its slowest pole below b^2 / mu
        let width = self.mu.min(swing.mu).min(swing.b * swing.b / (2.0 * swing.mu));
        let top = REACH * self.b.max(swing.b);
        let points = ((FINE * top / width).ceil() as usize).min(POINTS);
        let dw = top / points.max(1) as f64;
        let add = |[y, rate]: [f64; 2], i: usize| {
            let w = (i as f64 + 0.5) * dw;
            let power = self.power(w) * spectrum(swing, w) * dw / PI;
            [y + power, rate + power * w * w]
        };
        (0..points).fold([0.0; 2], add).map(f64::sqrt)
    }

    /// `[y, y']` a time `t` after the velocity was 1 and the angle 0.
    fn impulse(&self, t: f64) -> [f64; 2] {
        let w = (self.b * self.b - self.mu * self.mu).sqrt();
        let (sine, cosine) = (w * t).sin_cos();
        let fall = (-self.mu * t).exp();
        [fall * sine / w, fall * (cosine - self.mu / w * sine)]
    }
}

/// One resonance for each component of the swing.
pub(crate) struct Resonator {
    resonance: Resonance,
    /// `[y, y']` of each, rad and rad/s.
    state: [[f64; 2]; 3],
    time_ns: i64,
}

impl Resonator {
    /// In its stationary deviations `rms` at t = 0, and led back to where the run begins, so that the sampling rate does not matter.
    pub(crate) fn stationary(
        resonance: Resonance,
        rms: [[f64; 2]; 3],
        sea: &Sea,
        begin_ns: i64,
        source: &mut Source,
    ) -> Self {
        let state = rms.map(|component| component.map(|rms| rms * source.normal()));
        let mut resonator = Self { resonance, state, time_ns: begin_ns };
        resonator.step(sea, 0.0, seconds(begin_ns));
        resonator
    }

    /// Goes on to an instant; an earlier one changes nothing.
    pub(crate) fn advance(&mut self, sea: &Sea, time_ns: i64) {
        let longest_ns = nanoseconds(STEP_S);
        while self.time_ns < time_ns {
            let knot_ns = (self.time_ns.div_euclid(longest_ns) + 1) * longest_ns;
            let until_ns = time_ns.min(knot_ns);
            self.step(sea, seconds(self.time_ns), seconds(until_ns - self.time_ns));
            self.time_ns = until_ns;
        }
    }

    /// A short step of either sign. The free motion is exact, the answer to the swing is by Gauss's rule, which is as good as exact on so short a cubic.
    fn step(&mut self, sea: &Sea, begin: f64, t: f64) {
        let Resonance { mu, b } = self.resonance;
        let [x, v] = self.resonance.impulse(t);
        self.state = self.state.map(|[y, rate]| [(v + 2.0 * mu * x) * y + x * rate, v * rate - b * b * x * y]);
        for (node, weight) in GAUSS {
            let [x, v] = self.resonance.impulse((1.0 - node) * t);
            let swing = sea.swing(begin + node * t);
            let share = b * b * weight * t;
            for (state, [s, _]) in self.state.iter_mut().zip(swing) {
                *state = [state[0] + share * s * x, state[1] + share * s * v];
            }
        }
    }

    /// `[y, y']` of each component, rad and rad/s.
    pub(crate) fn state(&self) -> &[[f64; 2]; 3] {
        &self.state
    }
}
