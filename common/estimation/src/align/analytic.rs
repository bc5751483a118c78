//! Analytic coarse alignment.
//!
//! Source: the rival "ACA" of paper 001's table 2 (its reference 13), which the paper does not write out: here specific force and rate of
//! both units, averaged over a second, give two directions each, and the two triads give the rotation. It uses accelerometers, whose
//! biases tilt it, and neither the lever arm nor the swing of the ship average out: it wanders about for ever.

use super::{Register, Registration};
use frames::{Main, Rot, Sub, Vec3, unit};
use messages::{Flags, ImuPair};
use nalgebra::{Matrix3, Vector3};
use std::collections::VecDeque;

/// Over what time force and rate are averaged, s.
const WINDOW_S: f64 = 1.0;
/// How many past windows tell how far the last one may be off.
const WINDOWS: usize = 60;
/// Least number of windows before a solution is tried.
const LEAST_WINDOWS: usize = 4;

/// Nothing is known better than that, rad^2.
const LEAST_VARIANCE: f64 = 1e-18;

/// Sums over a window.
#[derive(Clone, Copy, Debug)]
struct Window {
    length_s: f64,
    force: [Vector3<f64>; 2],
    turn: [Vector3<f64>; 2],
}

const EMPTY: Window =
    Window { length_s: 0.0, force: [Vector3::new(0.0, 0.0, 0.0); 2], turn: [Vector3::new(0.0, 0.0, 0.0); 2] };

/// Collects pairs for analytic alignment.
#[derive(Clone, Debug)]
pub struct Analytic {
    filling: Window,
    found: VecDeque<(Rot<Main, Sub>, f64)>,
}

impl Analytic {
    /// One that has seen nothing yet.
    pub fn new() -> Self {
        Self { filling: EMPTY, found: VecDeque::with_capacity(WINDOWS) }
    }
}

impl Default for Analytic {
    fn default() -> Self {
        Self::new()
    }
}

/// The axes of the first direction, of the plane of both, and what completes them; with the sine between the directions.
fn triad(first: &Vector3<f64>, second: &Vector3<f64>) -> Option<(Matrix3<f64>, f64)> {
    let x = first.try_normalize(0.0)?;
    let normal = x.cross(&second.try_normalize(0.0)?);
    let y = normal.try_normalize(0.0)?;
    Some((Matrix3::from_columns(&[x, y, x.cross(&y)]), normal.norm()))
}

impl Register for Analytic {
    fn add(&mut self, pair: &ImuPair) {
        if pair.flags.intersects(Flags::GAP | Flags::NEW_EPOCH | Flags::SATURATED) {
            self.filling = EMPTY;
            return;
        }
        let interval_s = unit::seconds(pair.interval_ns);
        let window = &mut self.filling;
        window.length_s += interval_s;
        let add = |sum: &mut [Vector3<f64>; 2], m: [f64; 3], s: [f64; 3]| {
            sum[0] += Vector3::from(m);
            sum[1] += Vector3::from(s);
        };
        add(&mut window.force, pair.dvel_m, pair.dvel_s);
        add(&mut window.turn, pair.dtheta_m, pair.dtheta_s);
        if window.length_s < WINDOW_S - 0.5 * interval_s {
            return;
        }
        let Window { force, turn, .. } = std::mem::replace(window, EMPTY);
        if let (Some((m, sine)), Some((s, _))) = (triad(&force[0], &turn[0]), triad(&force[1], &turn[1])) {
            if self.found.len() == WINDOWS {
                self.found.pop_front();
            }
            self.found.push_back((Rot::from_matrix(&(m * s.transpose())), sine));
        }
    }

    fn solve(&self) -> Option<Registration> {
        let &(rotation, ratio) = self.found.back()?;
        if self.found.len() < LEAST_WINDOWS {
            return None;
        }
        let mut covariance = Matrix3::identity() * LEAST_VARIANCE;
        for (other, _) in &self.found {
            let apart = (*other * rotation.inverse()).log().column();
            covariance += apart * apart.transpose() / (self.found.len() - 1) as f64;
        }
        covariance.iter().all(|x| x.is_finite()).then_some(Registration {
            rotation,
            covariance,
            bias: Vec3::ZERO,
            bias_sigma: Vector3::repeat(f64::INFINITY),
            residual_rate: covariance.diagonal().map(|v| v.sqrt() / WINDOW_S),
            ratio,
        })
    }
}
