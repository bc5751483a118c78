//! Flexure in step with the ship's swing: 004 section 3, as [`crate::Coupling`] defines it.

use crate::processes::Processes;
use crate::random::Source;
use crate::{Area, Coupling, GaussMarkov};
use frames::{Main, Vec3};

/// The ship's swing (pitch, roll, -heading sway): `[angle, rate]` of each axis, rad and rad/s, and the same a quarter of a
/// period late.
pub(crate) struct SwingVector {
    pub(crate) swing: [[f64; 2]; 3],
    pub(crate) late: [[f64; 2]; 3],
}

/// The coupling of one hull.
pub(crate) struct Coherence {
    in_phase_rotation: Vec3<Main>,
    /// Gains on the swing and on the late swing, a row each axis of the flexure.
    gains: [[f64; 6]; 3],
    /// Gain and phase of each axis.
    wander: Processes<6>,
    source: Source,
}

impl Coherence {
    /// `rms` is that of the ship's swing about each axis, rad.
    pub(crate) fn new(coupling: &Coupling, area: &Area, rms: [f64; 3], mut source: Source) -> Self {
        let gains = area.flexure.map(|model| gains(coupling.share * model.sigma, rms, &mut source));
        let slow = match coupling.wander_tau {
            tau if tau > 0.0 => GaussMarkov::critical(tau, coupling.wander),
            _ => GaussMarkov { mu: 0.0, b: 0.0, sigma: 0.0 },
        };
        let wander = Processes::stationary([slow; 6], &mut source);
        Self { in_phase_rotation: coupling.in_phase_rotation, gains, wander, source }
    }

    /// A positive time goes by.
    pub(crate) fn advance(&mut self, interval_ns: i64) {
        self.wander.advance(interval_ns, 1.0, &mut self.source);
    }

    /// Angle (rad) and rate (rad/s) of the coherent flexure.
    pub(crate) fn bend(&self, ship: &SwingVector) -> [Vec3<Main>; 2] {
        let wave = [0, 1].map(|order| Vec3::from(ship.swing.map(|axis| axis[order])));
        let mut bend = wave.map(|s| s.cross(self.in_phase_rotation).array());
        for (axis, gains) in self.gains.iter().enumerate() {
            let [a, adot] = self.wander.state()[axis];
            let [p, pdot] = self.wander.state()[axis + 3];
            let (sine, cosine) = p.sin_cos();
            let [u, udot, v, vdot] = products(gains, ship);
            let turned = cosine * u + sine * v;
            let turned_rate = cosine * udot + sine * vdot + pdot * (cosine * v - sine * u);
            bend[0][axis] += (1.0 + a) * turned;
            bend[1][axis] += (1.0 + a) * turned_rate + adot * turned;
        }
        bend.map(Vec3::from)
    }
}

/// `u`, its rate, `v`, its rate.
fn products(gains: &[f64; 6], ship: &SwingVector) -> [f64; 4] {
    let mut sum = [0.0; 4];
    for j in 0..3 {
        let (k1, k2, s, late) = (gains[j], gains[j + 3], ship.swing[j], ship.late[j]);
        for order in 0..2 {
            sum[order] += k1 * s[order] + k2 * late[order];
            sum[order + 2] += k1 * late[order] - k2 * s[order];
        }
    }
    sum
}

/// A random direction among the six parts, so long that their sum has the standard deviation `sigma`.
fn gains(sigma: f64, rms: [f64; 3], source: &mut Source) -> [f64; 6] {
    let swings = |j: usize| rms[j % 3] > 0.0;
    let drawn: [f64; 6] = std::array::from_fn(|j| source.normal() * f64::from(u8::from(swings(j))));
    let length = drawn.iter().map(|g| g * g).sum::<f64>().sqrt();
    std::array::from_fn(|j| if swings(j) { sigma * drawn[j] / (length * rms[j % 3]) } else { 0.0 })
}
