//! The range by the coherence of flexure and ship that the data show.
//!
//! A flexure rate `d` in step with the ship's rate `w` is a static angle to any processing of the same data ([`super::Coherence`]). How much of
//! it there may be is told by the part that is not hidden: over the last hour the estimated rate is regressed on the ship's rate and swing, in step and a
//! quarter behind, and the share `g_i = sqrt(R^2)` of its deviation that they explain stands for the hidden part too:
//!
//! `e_x = sqrt(<v_y^2> V_z + <v_z^2> V_y) / (<w_y^2> + <w_z^2>)`, `V_i = g_i^2 <d_i^2>` plus the variance of the estimate,
//!
//! with `v` the ship's rate in waves alone: a turn shows the static angle, and no flexure goes with it. The range is 1.96 deviations of
//! the filter and, in quadrature, four times that and 0.15 of the angle of full coherence, since a coupling may hide by chance: of the part in
//! step only what no static angle takes up is seen, so one of any phase hides more than four times what it shows in one case of six.

use super::error_range::others;
use super::window::Window;
use super::{Evaluate, Evidence, Kept, NORMAL_95};
use nalgebra::{Matrix3, SMatrix, SVector, Vector3};
use serde::{Deserialize, Serialize};

/// How many times the angle of the coherence that is seen counts, and how much that of full coherence.
const SEEN: f64 = 4.0;
const UNSEEN: f64 = 0.15;
/// A share of the square up to so many times what chance explains is none: chance exceeds it once in sixteen.
const BY_CHANCE: f64 = 2.0;
/// Slower movements of the ship than this are turns, s.
const WAVES_S: f64 = 30.0;
/// Evidence is taken so often, s.
const EVERY_S: f64 = 0.1;
/// The flexure's rate keeps its sign for about so long: so much of the data counts as one value, s.
const CORRELATION_S: f64 = 1.5;
/// The ship's rate in waves and its swing.
const REGRESSORS: usize = 6;
/// Products of the regressors, of them with the flexure's rates; squares of these and of the ship's rate.
const MEANS: usize = REGRESSORS * REGRESSORS + REGRESSORS * 3 + 6;

/// Half width about each axis of the total.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Observed {
    window: Window<MEANS>,
    waiting_s: f64,
    taken_s: f64,
    /// Slow part of the ship's rate, rad/s, and the swing by the rest, rad.
    slow: Vector3<f64>,
    swing: Vector3<f64>,
    coherent: Vector3<f64>,
}

impl Observed {
    /// A range that has seen nothing.
    pub fn new() -> Self {
        Self {
            window: Window::new(),
            waiting_s: 0.0,
            taken_s: 0.0,
            slow: Vector3::zeros(),
            swing: Vector3::zeros(),
            coherent: Vector3::zeros(),
        }
    }

    /// What a coherent flexure may hide, by the means so far.
    fn take(&mut self, evidence: &Evidence) {
        let w = evidence.w_im_m.column();
        let kept = self.waiting_s / WAVES_S;
        self.slow += (w - self.slow) * kept.min(1.0);
        let waves = w - self.slow;
        self.swing += waves * self.waiting_s - self.swing * kept.min(1.0);
        let x = SVector::<f64, REGRESSORS>::from_iterator(waves.iter().chain(self.swing.iter()).copied());
        let d = evidence.rate.column();
        let (xx, xd) = (x * x.transpose(), x * d.transpose());
        let squares = d.component_mul(&d);
        let rates = w.component_mul(&w);
        let values = xx.iter().chain(xd.iter()).chain(squares.iter()).chain(rates.iter()).copied();
        let mean = self.window.mean(SVector::from_iterator(values), self.waiting_s);
        self.taken_s += self.waiting_s;
        self.waiting_s = 0.0;
        if let Some(mean) = mean {
            self.coherent = self.angle(&mean, &evidence.rate_covariance);
        }
    }

    fn angle(&self, mean: &SVector<f64, MEANS>, rate_covariance: &Matrix3<f64>) -> Vector3<f64> {
        const XD: usize = REGRESSORS * REGRESSORS;
        const DD: usize = XD + REGRESSORS * 3;
        let xx = SMatrix::<f64, REGRESSORS, REGRESSORS>::from_iterator(mean.iter().copied());
        let xd = SMatrix::<f64, REGRESSORS, 3>::from_iterator(mean.iter().skip(XD).copied());
        let waves = xx.diagonal();
        let floor = (waves.max() * 1e-9).max(f64::MIN_POSITIVE);
        let explained = (xx + SMatrix::identity() * floor).cholesky().map(|normal| normal.solve(&xd));
        let share = |i: usize| {
            let square = mean[DD + i].max(f64::MIN_POSITIVE);
            let r2 = explained.as_ref().map_or(1.0, |by| (by.column(i).dot(&xd.column(i)) / square).clamp(0.0, 1.0));
            // so much of the square chance may explain in so little data
            let chance = BY_CHANCE * REGRESSORS as f64 * CORRELATION_S / self.taken_s.max(f64::MIN_POSITIVE);
            if chance < 1.0 { ((r2 - chance) / (1.0 - chance)).max(0.0) } else { 1.0 }
        };
        let size = |i: usize| mean[DD + i] + rate_covariance[(i, i)];
        Vector3::from_fn(|k, _| {
            let (a, b) = others(k);
            let ship = (mean[DD + 3 + a] + mean[DD + 3 + b]).max(f64::MIN_POSITIVE);
            let hidden = |of: &dyn Fn(usize) -> f64| (waves[a] * of(b) + waves[b] * of(a)).sqrt() / ship;
            (SEEN * hidden(&|i| share(i) * size(i))).hypot(UNSEEN * hidden(&size))
        })
    }
}

impl Default for Observed {
    fn default() -> Self {
        Self::new()
    }
}

impl Evaluate for Observed {
    fn range(&mut self, evidence: &Evidence) -> [f64; 3] {
        let sound = evidence.rate.is_finite() && evidence.w_im_m.is_finite() && evidence.interval_s > 0.0;
        if sound {
            self.waiting_s += evidence.interval_s;
            if self.waiting_s >= EVERY_S - 0.5 * evidence.interval_s {
                self.take(evidence);
            }
        }
        let own = evidence.covariance.diagonal().map(|variance| NORMAL_95 * variance.sqrt());
        own.zip_map(&self.coherent, f64::hypot).into()
    }

    fn hidden(&self) -> Option<Vector3<f64>> {
        Some(self.coherent / NORMAL_95)
    }

    fn kept(&self) -> Kept {
        Kept::Observed(self.clone())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use frames::Vec3;

    /// A ship in waves, with a flexure of which the share `coherent` goes with the roll.
    fn seen(coherent: f64, turning: f64) -> [f64; 3] {
        let mut range = Observed::new();
        let mut last = [0.0; 3];
        for k in 0..36_000 {
            let t = k as f64 * 0.1;
            let w = Vector3::new(0.06 * (0.8 * t).sin(), 0.04 * (0.7 * t + 1.0).sin(), 0.03 * (0.9 * t + 2.0).sin());
            let own = Vector3::new((1.31 * t).sin(), (1.57 * t + 0.4).sin(), (1.93 * t + 1.0).sin());
            let d = (own * (1.0 - coherent * coherent).sqrt() + w / 0.045 * coherent) * 1e-4;
            last = range.range(&Evidence {
                time_s: t,
                interval_s: 0.1,
                w_im_m: Vec3::from_column(w + Vector3::repeat(turning)),
                covariance: Matrix3::identity() * 1e-12,
                static_covariance: Matrix3::zeros(),
                rate: Vec3::from_column(d),
                rate_covariance: Matrix3::zeros(),
                rate_with_static: Matrix3::zeros(),
            });
        }
        last
    }

    #[test]
    fn a_coherence_that_is_seen_widens_it_and_none_leaves_a_little() {
        let (none, half, full) = (seen(0.0, 0.0), seen(0.5, 0.0), seen(1.0, 0.0));
        for axis in 0..3 {
            assert!(half[axis] > 3.0 * none[axis] && full[axis] > 1.5 * half[axis], "{none:?} {half:?} {full:?}");
            assert!(none[axis] > 1.96e-6 && none[axis] < 0.25 * full[axis]);
        }
    }

    #[test]
    fn turns_narrow_it() {
        let (straight, turning) = (seen(0.5, 0.0), seen(0.5, 0.1));
        assert!((0..3).all(|axis| turning[axis] < 0.5 * straight[axis]), "{straight:?} {turning:?}");
    }

    #[test]
    fn numbers_that_are_none_do_not_enter() {
        let mut range = Observed::new();
        let evidence = Evidence {
            time_s: 0.0,
            interval_s: 0.1,
            w_im_m: Vec3::new(f64::NAN, 0.0, 0.0),
            covariance: Matrix3::identity(),
            static_covariance: Matrix3::identity(),
            rate: Vec3::ZERO,
            rate_covariance: Matrix3::identity(),
            rate_with_static: Matrix3::zeros(),
        };
        assert_eq!(range.range(&evidence), [NORMAL_95; 3]);
    }
}
