//! Flexure in step with the ship's swing: 004 section 3, as [`crate::Coupling`] defines it.

use crate::processes::Processes;
use crate::random::Source;
use crate::resonator::{Resonance, Resonator};
use crate::sea::Sea;
use crate::{Area, Coupling, GaussMarkov, Response};
use frames::unit::seconds;
use frames::{Main, Vec3};

/// `[angle, rate]` about each axis, rad and rad/s.
type Angles = [[f64; 2]; 3];

/// The coupling of one hull.
pub(crate) struct Coherence {
    in_phase_rotation: Vec3<Main>,
    answer: Answer,
}

/// The hull's response at work; gains have a row each axis of the flexure.
enum Answer {
    Phase(Box<Phase>),
    Delayed { gains: [[f64; 3]; 3], delay_s: f64 },
    Resonant { gains: [[f64; 3]; 3], resonator: Resonator },
}

/// Gain and phase that wander.
struct Phase {
    /// Gains on the swing and on the late swing.
    gains: [[f64; 6]; 3],
    /// Gain and phase of each axis.
    wander: Processes<6>,
    source: Source,
}

impl Coherence {
    /// `time_ns` is where the run begins, at most a sample before t = 0.
    pub(crate) fn new(coupling: &Coupling, area: &Area, sea: &Sea, time_ns: i64, mut source: Source) -> Self {
        let sigma = area.flexure.map(|model| coupling.share * model.sigma);
        let answer = match coupling.response {
            Response::Phase { wander, wander_tau } => {
                let gains = sigma.map(|sigma| gains(sigma, sea.swing_rms(), &mut source));
                let slow = match wander_tau {
                    tau if tau > 0.0 => GaussMarkov::critical(tau, wander),
                    _ => GaussMarkov { mu: 0.0, b: 0.0, sigma: 0.0 },
                };
                let wander = Processes::stationary([slow; 6], &mut source);
                Answer::Phase(Box::new(Phase { gains, wander, source }))
            }
            Response::Delayed { delay_s } => {
                Answer::Delayed { gains: sigma.map(|sigma| gains(sigma, sea.swing_rms(), &mut source)), delay_s }
            }
            Response::Resonant { mu, b } => {
                let resonance = Resonance { mu, b };
                let rms = sea.resonant_rms(&resonance);
                let gains = sigma.map(|sigma| gains(sigma, rms.map(|[angle, _]| angle), &mut source));
                Answer::Resonant { gains, resonator: Resonator::stationary(resonance, rms, sea, time_ns, &mut source) }
            }
        };
        Self { in_phase_rotation: coupling.in_phase_rotation, answer }
    }

    /// A positive time goes by for what wanders.
    pub(crate) fn advance(&mut self, interval_ns: i64) {
        if let Answer::Phase(phase) = &mut self.answer {
            phase.wander.advance(interval_ns, 1.0, &mut phase.source);
        }
    }

    /// Angle (rad) and rate (rad/s) of the coherent flexure; times must not go back.
    pub(crate) fn bend(&mut self, sea: &Sea, time_ns: i64) -> [Vec3<Main>; 2] {
        let t = seconds(time_ns);
        let swing = sea.swing(t);
        let wave = [0, 1].map(|order| Vec3::from(swing.map(|axis| axis[order])));
        let mut bend = wave.map(|s| s.cross(self.in_phase_rotation).array());
        let answer = match &mut self.answer {
            Answer::Phase(phase) => phase.bend(&swing, &sea.late(t)),
            Answer::Delayed { gains, delay_s } => product(gains, &sea.swing(t - *delay_s)),
            Answer::Resonant { gains, resonator } => {
                resonator.advance(sea, time_ns);
                product(gains, resonator.state())
            }
        };
        for (axis, [angle, rate]) in answer.into_iter().enumerate() {
            bend[0][axis] += angle;
            bend[1][axis] += rate;
        }
        bend.map(Vec3::from)
    }
}

impl Phase {
    fn bend(&self, swing: &Angles, late: &Angles) -> Angles {
        std::array::from_fn(|axis| {
            let [a, adot] = self.wander.state()[axis];
            let [p, pdot] = self.wander.state()[axis + 3];
            let (sine, cosine) = p.sin_cos();
            let [u, udot, v, vdot] = products(&self.gains[axis], swing, late);
            let turned = cosine * u + sine * v;
            let turned_rate = cosine * udot + sine * vdot + pdot * (cosine * v - sine * u);
            [(1.0 + a) * turned, (1.0 + a) * turned_rate + adot * turned]
        })
    }
}

/// `K s` and its rate.
fn product(gains: &[[f64; 3]; 3], s: &Angles) -> Angles {
    gains.map(|row| [0, 1].map(|order| row.iter().zip(s).map(|(gain, component)| gain * component[order]).sum()))
}

/// `u`, its rate, `v`, its rate.
fn products(gains: &[f64; 6], swing: &Angles, late: &Angles) -> [f64; 4] {
    let mut sum = [0.0; 4];
    for j in 0..3 {
        let (k1, k2, s, late) = (gains[j], gains[j + 3], swing[j], late[j]);
        for order in 0..2 {
            sum[order] += k1 * s[order] + k2 * late[order];
            sum[order + 2] += k1 * late[order] - k2 * s[order];
        }
    }
    sum
}

/// A random direction among the N parts, so long that their sum has the standard deviation `sigma`; part j has that of component
/// j modulo 3.
fn gains<const N: usize>(sigma: f64, rms: [f64; 3], source: &mut Source) -> [f64; N] {
    let swings = |j: usize| rms[j % 3] > 0.0;
    let drawn: [f64; N] = std::array::from_fn(|j| source.normal() * f64::from(u8::from(swings(j))));
    let length = drawn.iter().map(|g| g * g).sum::<f64>().sqrt();
    std::array::from_fn(|j| if swings(j) { sigma * drawn[j] / (length * rms[j % 3]) } else { 0.0 })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Purpose;
    use crate::{RandomSwing, Ship, Swing, Tones};

    const RESPONSES: [Response; 3] = [
        Response::Phase { wander: 0.35, wander_tau: 100.0 },
        Response::Delayed { delay_s: 1.3 },
        Response::Resonant { mu: 0.08, b: 1.6 },
    ];

    fn sea(seed: u64) -> Sea {
        let roll = Swing::Random(RandomSwing { mu: 0.06, b: 0.44, sigma: 0.06, band_limit_hz: Some(0.4) });
        let pitch = Swing::Tones(Tones { rms: 0.05, period: 8.0, count: 24 });
        Sea::new(Ship { roll, pitch, ..Ship::default() }, seed, 10.0)
    }

    fn coherence(response: Response, sea: &Sea, seed: u64) -> Coherence {
        let coupling = Coupling { share: 0.5, response, in_phase_rotation: Vec3::new(1e-4, -2e-4, 3e-4) };
        Coherence::new(&coupling, &Area::default(), sea, 0, Source::new(seed, Purpose::Coupling, 0))
    }

    /// Without a step of what wanders: its own rates are those of a Gauss-Markov process.
    #[test]
    fn the_rate_is_the_derivative_of_the_angle() {
        let h = 1_000_000;
        for seed in 1..4 {
            for response in RESPONSES {
                let mut sea = sea(seed);
                let mut coherence = coherence(response, &sea, seed);
                if let Answer::Phase(phase) = &mut coherence.answer {
                    phase.wander.rest();
                }
                for time_ns in [20_000_000, 1_234_567_890, 49_999_500_000, 77_000_000_000] {
                    sea.advance(time_ns + h);
                    let [a, now, b] = [-h, 0, h].map(|late| coherence.bend(&sea, time_ns + late));
                    let rate = (b[0] - a[0]) / seconds(2 * h);
                    assert!((rate - now[1]).norm() < 1e-4 * now[1].norm(), "{response:?} {rate:?} {:?}", now[1]);
                }
            }
        }
    }

    #[test]
    fn the_steps_of_a_resonator_do_not_matter() {
        for seed in 1..4 {
            let [fine, middle, coarse] = [7_000_000, 100_000_000, 700_000_000].map(|step_ns| {
                let mut sea = sea(seed);
                let mut coherence = coherence(RESPONSES[2], &sea, seed);
                let bend = |bend, k: i64| {
                    sea.advance(k * step_ns);
                    let now = coherence.bend(&sea, k * step_ns);
                    if k * step_ns == 70_000_000_000 { now } else { bend }
                };
                (1..=70_000_000_000 / step_ns).fold([Vec3::ZERO; 2], bend)
            });
            for bend in [middle, coarse] {
                for order in 0..2 {
                    assert!((bend[order] - fine[order]).norm() < 1e-9 * fine[order].norm(), "{seed} {bend:?} {fine:?}");
                }
            }
        }
    }
}
