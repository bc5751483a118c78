//! Quaternion optimisation.
//!
//! Source: paper 001 eqs 2-9. The angles `beta = int w_m`, `alpha = int w_s` of both units obey `beta = q alpha q*` for a constant rotation
//! of any size, and `q` is the eigenvector of `K = sum (L(beta) - R(alpha))^T (L(beta) - R(alpha))` to its least eigenvalue: Davenport's
//! solution of Wahba's problem.
//!
//! | form | angles since |
//! |---|---|
//! | [`Angles::Cumulative`] | the beginning, as printed |
//! | [`Angles::Windowed`] | two seconds ago, at every sample |
//!
//! Corrections: eq 2's `alpha(tau)` is `alpha(t)`. In the printed form the Earth's rate, which grows with time as the sway's angles do
//! not, comes to rule `K`; a rotation that drifts then leaks in by the ratio of both rates, and the result grows worse with time.

use super::moments::Moments;
use super::{Register, Registration};
use frames::{Main, Rot, Sub, Vec3, unit};
use messages::{Flags, ImuPair};
use nalgebra::{Matrix4, Vector3};
use std::collections::VecDeque;

/// Length of a window, s.
const WINDOW_S: f64 = 2.0;
/// Time after which the flexure's share of a residual is a new one, s.
const INDEPENDENT_S: f64 = 2.0;
/// How many independent residuals the printed form has: its angles remember everything.
const CUMULATIVE_INDEPENDENT: f64 = 2.0;
/// Least time before a solution is tried, s.
const LEAST_S: f64 = 4.0;

/// Since when angles are counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Angles {
    /// The beginning, as printed.
    Cumulative,
    /// Two seconds before.
    Windowed,
}

/// Both units' angles since the beginning, rad.
#[derive(Clone, Copy, Debug)]
struct Turned {
    time_s: f64,
    beta: Vector3<f64>,
    alpha: Vector3<f64>,
}

/// Collects pairs for quaternion optimisation.
#[derive(Clone, Debug)]
pub struct Quaternion {
    angles: Angles,
    now: Turned,
    /// Of the windowed form: the beginnings of the windows to come.
    past: VecDeque<Turned>,
    k: Matrix4<f64>,
    moments: Moments,
}

impl Quaternion {
    /// One that has seen nothing yet.
    pub fn new(angles: Angles) -> Self {
        let now = Turned { time_s: 0.0, beta: Vector3::zeros(), alpha: Vector3::zeros() };
        Self { angles, now, past: VecDeque::from([now]), k: Matrix4::zeros(), moments: Moments::new() }
    }

    fn take(&mut self, beta: Vector3<f64>, alpha: Vector3<f64>) {
        let m = left(&beta) - right(&alpha); // 001 eq 5
        self.k += m.transpose() * m; // 001 eq 6
        self.moments.add(&beta, &alpha);
    }
}

/// `[q +]` of a vector: `L(b) q = b q`.
// 001 eq 4
fn left(v: &Vector3<f64>) -> Matrix4<f64> {
    let mut m = Matrix4::zeros();
    m.fixed_view_mut::<1, 3>(0, 1).copy_from(&-v.transpose());
    m.fixed_view_mut::<3, 1>(1, 0).copy_from(v);
    m.fixed_view_mut::<3, 3>(1, 1).copy_from(&v.cross_matrix());
    m
}

/// `[q -]` of a vector: `R(a) q = q a`.
fn right(v: &Vector3<f64>) -> Matrix4<f64> {
    let mut m = left(v);
    m.fixed_view_mut::<3, 3>(1, 1).neg_mut();
    m
}

impl Register for Quaternion {
    fn add(&mut self, pair: &ImuPair) {
        if pair.flags.intersects(Flags::GAP | Flags::NEW_EPOCH | Flags::SATURATED) {
            // the chain of angles is broken; what was learnt before holds
            let Self { angles, k, moments, .. } = std::mem::replace(self, Self::new(self.angles));
            *self = Self { k, moments, ..Self::new(angles) };
            return;
        }
        let interval_s = unit::seconds(pair.interval_ns);
        self.now.time_s += interval_s;
        self.now.beta += Vec3::<Main>::from(pair.dtheta_m).column();
        self.now.alpha += Vec3::<Sub>::from(pair.dtheta_s).column();
        let now = self.now;
        match self.angles {
            Angles::Cumulative => self.take(now.beta, now.alpha),
            Angles::Windowed => {
                self.past.push_back(now);
                let full = |from: &mut Turned| now.time_s - from.time_s > WINDOW_S - 0.5 * interval_s;
                if let Some(from) = self.past.pop_front_if(full) {
                    self.take(now.beta - from.beta, now.alpha - from.alpha);
                }
            }
        }
    }

    fn solve(&self) -> Option<Registration> {
        if self.now.time_s < LEAST_S || self.moments.n < 2.0 {
            return None;
        }
        // 001 eqs 7-9
        let eigen = self.k.symmetric_eigen();
        let least = eigen.eigenvalues.imin();
        let q = eigen.eigenvectors.column(least);
        let rotation = Rot::<Main, Sub>::from_quaternion([q[0], q[1], q[2], q[3]])?;
        let (independent, length_s) = match self.angles {
            Angles::Cumulative => (CUMULATIVE_INDEPENDENT, self.now.time_s),
            Angles::Windowed => (self.now.time_s / INDEPENDENT_S, WINDOW_S),
        };
        self.moments.registration(rotation, independent, length_s)
    }
}
