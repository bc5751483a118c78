//! Least squares for a small rotation.
//!
//! Source: the rival "LSE" of paper 001's table 2, which the paper does not write out: here `beta = alpha + phi x alpha` with the angles of
//! both units since the beginning, as in eq 2, solved for `phi` by normal equations. It loses half the square of the angle; at the paper's
//! angles it is otherwise quaternion optimisation.

use super::moments::Moments;
use super::{Register, Registration};
use frames::{Main, Rot, Sub, Vec3, unit};
use messages::{Flags, ImuPair};
use nalgebra::Vector3;

/// How many independent residuals there are: the angles remember everything.
const INDEPENDENT: f64 = 2.0;
/// Least time before a solution is tried, s.
const LEAST_S: f64 = 4.0;

/// Collects pairs for least squares.
#[derive(Clone, Debug)]
pub struct LeastSquares {
    time_s: f64,
    beta: Vector3<f64>,
    alpha: Vector3<f64>,
    moments: Moments,
}

impl LeastSquares {
    /// One that has seen nothing yet.
    pub fn new() -> Self {
        Self { time_s: 0.0, beta: Vector3::zeros(), alpha: Vector3::zeros(), moments: Moments::new() }
    }
}

impl Default for LeastSquares {
    fn default() -> Self {
        Self::new()
    }
}

impl Register for LeastSquares {
    fn add(&mut self, pair: &ImuPair) {
        if pair.flags.intersects(Flags::GAP | Flags::NEW_EPOCH | Flags::SATURATED) {
            // the chain of angles is broken; what was learnt before holds
            *self = Self { moments: self.moments.clone(), ..Self::new() };
            return;
        }
        self.time_s += unit::seconds(pair.interval_ns);
        self.beta += Vec3::<Main>::from(pair.dtheta_m).column();
        self.alpha += Vec3::<Sub>::from(pair.dtheta_s).column();
        self.moments.add(&self.beta, &self.alpha);
    }

    fn solve(&self) -> Option<Registration> {
        if self.time_s < LEAST_S || self.moments.n < 2.0 {
            return None;
        }
        // sum [alpha x]^T [alpha x] phi = sum alpha x beta
        let ab = &self.moments.ab;
        let turned = Vector3::new(ab[(2, 1)] - ab[(1, 2)], ab[(0, 2)] - ab[(2, 0)], ab[(1, 0)] - ab[(0, 1)]);
        let phi = Moments::information(self.moments.sub()).try_inverse()? * turned;
        let rotation = Rot::<Main, Sub>::exp(Vec3::from_column(phi));
        self.moments.registration(rotation, INDEPENDENT, self.time_s)
    }
}
