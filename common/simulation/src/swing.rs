//! One Euler angle as a function of time.

use crate::knots::Knots;
use crate::random::{Purpose, Source};
use crate::resonator::Resonance;
use crate::{Oscillation, Swing};
use std::f64::consts::TAU;

/// One Euler angle of one run.
pub(crate) enum Track {
    Sine { amplitude: f64, w: f64, phase: f64 },
    Knots(Knots),
}

impl Track {
    /// `axis` tells the angles of one ship apart; what lies `history_s` back can still be asked.
    pub(crate) fn new(swing: &Swing, seed: u64, axis: u64, history_s: f64) -> Self {
        let mut source = Source::new(seed, Purpose::Sea, axis);
        match swing {
            Swing::Sine(sine) => Self::sine(sine, &mut source),
            Swing::Tones(tones) => Self::Knots(Knots::of_tones(tones, source, history_s)),
            Swing::Random(swing) => Self::Knots(Knots::of_process(swing, source, history_s)),
        }
    }

    fn sine(sine: &Oscillation, source: &mut Source) -> Self {
        let w = if sine.period > 0.0 { TAU / sine.period } else { 0.0 };
        let drawn = if sine.random_phase { TAU * source.uniform() } else { 0.0 };
        Self::Sine { amplitude: sine.amplitude, w, phase: sine.phase + drawn }
    }

    /// Makes the times up to `t` ready to be asked.
    pub(crate) fn advance(&mut self, t: f64) {
        if let Self::Knots(knots) = self {
            knots.advance(t);
        }
    }

    /// Angle (rad) and rate (rad/s) at the time `t`.
    pub(crate) fn at(&self, t: f64) -> (f64, f64) {
        match self {
            Self::Sine { amplitude, w, phase } => {
                let (sine, cosine) = (w * t + phase).sin_cos();
                (amplitude * sine, amplitude * w * cosine)
            }
            Self::Knots(knots) => knots.at(t, 0),
        }
    }

    /// The same a quarter of a period late.
    pub(crate) fn late(&self, t: f64) -> (f64, f64) {
        match self {
            Self::Sine { amplitude, w, phase } => {
                let (sine, cosine) = (w * t + phase).sin_cos();
                (-amplitude * cosine, amplitude * w * sine)
            }
            Self::Knots(knots) => knots.at(t, 1),
        }
    }

    /// Standard deviation of the angle, rad.
    pub(crate) fn rms(&self) -> f64 {
        match self {
            Self::Sine { amplitude, w, .. } if *w > 0.0 => amplitude.abs() / 2f64.sqrt(),
            Self::Sine { .. } => 0.0,
            Self::Knots(knots) => knots.rms(),
        }
    }

    /// Standard deviations of angle and rate (rad, rad/s) of what a resonance makes of the angle.
    pub(crate) fn resonant_rms(&self, resonance: &Resonance) -> [f64; 2] {
        match self {
            Self::Sine { w, .. } => resonance.of_lines(self.rms(), [*w].into_iter()),
            Self::Knots(knots) => knots.resonant_rms(resonance),
        }
    }
}
