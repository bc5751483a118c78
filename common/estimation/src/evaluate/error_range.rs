//! The range by the covariance of flexure rate and static part.
//!
//! Source: paper 004 eqs 21-33. What a flexure rate that is off by `d` does to the static part is, over the last hour,
//!
//! `e_x = -(<w_y d_z> - <w_z d_y>) / (<w_y^2> + <w_z^2>)` and so on (eq 30), and `d_i = F sgn(P_ik) sqrt|P_ik|` (eq 32) with `P_ik`
//! the covariance of the rate about i and the static part about k.
//!
//! Corrections: eqs 29 to 33 are lost in the only text there is. Of the covariances that the text can mean, only the one above gives
//! its figures: those of two rates, or of flexure and rate, give ranges of nothing. Its unit is wrong: a covariance of rate and angle has
//! a root in rad/sqrt(s), so that F carries s^-1/2 and its value hangs on the second as the unit of time. The range is the filter's
//! own deviation made some five times larger, which no other scenario bears out; [`super::Coherence`] replaces it.

use super::window::Window;
use super::{Evaluate, Evidence, Kept};
use nalgebra::{SVector, Vector3};
use serde::{Deserialize, Serialize};

/// Half width `F |e|` about each axis, of the static part.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct ErrorRange {
    factor: [f64; 3],
    /// Of the squares of the ship's rate, then of its products `w_a d_b - w_b d_a`.
    window: Window<6>,
}

impl ErrorRange {
    /// A range with the coefficient F of each axis, s^-1/2.
    pub fn new(factor: [f64; 3]) -> Self {
        Self { factor, window: Window::new() }
    }

    pub(super) fn factor(&self) -> [f64; 3] {
        self.factor
    }
}

/// The axes that follow an axis.
pub(super) fn others(axis: usize) -> (usize, usize) {
    ((axis + 1) % 3, (axis + 2) % 3)
}

impl Evaluate for ErrorRange {
    fn range(&mut self, evidence: &Evidence) -> [f64; 3] {
        let w = evidence.w_im_m.column();
        let p = &evidence.rate_with_static;
        // 004 eq 32 with F = 1
        let rate = |i: usize, k: usize| p[(i, k)].signum() * p[(i, k)].abs().sqrt();
        let product = Vector3::from_fn(|k, _| {
            let (a, b) = others(k);
            w[a] * rate(b, k) - w[b] * rate(a, k)
        });
        let squares = w.component_mul(&w);
        let values = SVector::<f64, 6>::from_iterator(squares.iter().chain(product.iter()).copied());
        let Some(mean) = self.window.mean(values, evidence.interval_s) else { return [0.0; 3] };
        // 004 eq 30, 33
        [0, 1, 2].map(|k| {
            let (a, b) = others(k);
            self.factor[k] * mean[3 + k].abs() / (mean[a] + mean[b]).max(f64::MIN_POSITIVE)
        })
    }

    fn kept(&self) -> Kept {
        Kept::ErrorRange(self.clone())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evaluate::{Coherence, Deviations};
    use frames::Vec3;
    use nalgebra::Matrix3;

    /// Rates of the ship at step `k` of a second, in proportion 3 : 2 : 1.
    fn ship(k: usize) -> Vector3<f64> {
        let t = k as f64;
        Vector3::new(0.03 * (0.9 * t).sin(), 0.02 * (1.1 * t + 1.0).sin(), 0.01 * (0.7 * t + 2.0).sin())
    }

    /// Evidence of a filter whose static part has the variance `variance`, and whose rate follows `-w x phi0`.
    fn evidence(k: usize, variance: f64) -> Evidence {
        Evidence {
            time_s: k as f64,
            interval_s: 1.0,
            w_im_m: Vec3::from_column(ship(k)),
            covariance: Matrix3::identity() * variance,
            static_covariance: Matrix3::identity() * variance,
            rate: Vec3::new(1e-5, 2e-5, 3e-5),
            rate_covariance: Matrix3::identity() * 1e-12,
            rate_with_static: -ship(k).cross_matrix() * variance,
        }
    }

    fn after_two_hours(mut range: impl Evaluate, variance: f64) -> [f64; 3] {
        (0..7200).map(|k| range.range(&evidence(k, variance))).last().expect("an hour")
    }

    #[test]
    fn it_is_linear_in_the_coefficient() {
        let one = after_two_hours(ErrorRange::new([1.0; 3]), 1e-12);
        let many = after_two_hours(ErrorRange::new([0.0, 2.0, 3.5]), 1e-12);
        assert!(one.iter().all(|range| *range > 0.0), "{one:?}");
        assert_eq!(many[0], 0.0);
        assert!((many[1] - 2.0 * one[1]).abs() < 1e-12 * one[1] && (many[2] - 3.5 * one[2]).abs() < 1e-12 * one[2]);
    }

    #[test]
    fn it_is_the_filters_deviation_made_larger() {
        // sqrt P times <|s|^1.5> over <s^2>, with <|sin|^1.5> = .5564 and <sin^2> = .5
        let sigma = 1e-6;
        let range = after_two_hours(ErrorRange::new([1.0; 3]), sigma * sigma);
        for (axis, (one, two)) in [(0.02, 0.01), (0.01, 0.03), (0.03, 0.02)].into_iter().enumerate() {
            let (one, two): (f64, f64) = (one, two);
            let expected = sigma * 0.5564 * (one.powf(1.5) + two.powf(1.5)) / (0.5 * (one * one + two * two));
            assert!((range[axis] - expected).abs() < 0.01 * expected, "{axis}: {} {expected}", range[axis]);
            assert!(range[axis] > 4.0 * sigma);
        }
    }

    #[test]
    fn its_unit_is_wrong() {
        // another unit of time, minutes for seconds: the same scenario, and another range
        let mut minutes = ErrorRange::new([1.0; 3]);
        let told = |k| {
            let mut told = evidence(k, 1e-12);
            told.w_im_m = told.w_im_m * 60.0;
            told.rate_with_static *= 60.0;
            told
        };
        let range = (0..7200).map(|k| minutes.range(&told(k))).last().expect("two hours");
        let seconds = after_two_hours(ErrorRange::new([1.0; 3]), 1e-12);
        assert!((range[0] * 60f64.sqrt() - seconds[0]).abs() < 1e-9 * seconds[0]);
        let mut coherent = Coherence::new([1.0; 3]);
        let told = |k| {
            let mut told = told(k);
            told.rate = told.rate * 60.0;
            told.rate_covariance *= 3600.0;
            told
        };
        let range = (0..7200).map(|k| coherent.range(&told(k))).last().expect("two hours");
        let seconds = after_two_hours(Coherence::new([1.0; 3]), 1e-12);
        assert!((range[0] - seconds[0]).abs() < 1e-9 * seconds[0], "the one by coherence does not mind");
    }

    /// How far rates `gain w` move the static part by least squares, and the range by then.
    fn moved(gain: Matrix3<f64>) -> (Vector3<f64>, [f64; 3]) {
        let mut range = Coherence::new([1.0; 3]);
        let mut told = [0.0; 3];
        let (mut information, mut pull) = (Matrix3::zeros(), Vector3::zeros());
        for k in 0..3600 {
            let w = ship(k);
            let rate = gain * w;
            told = range.range(&Evidence { rate: Vec3::from_column(rate), ..evidence(k, 1e-16) });
            let turn = w.cross_matrix();
            information += turn.transpose() * turn;
            pull += turn.transpose() * rate;
        }
        (information.try_inverse().expect("moves") * pull, told)
    }

    #[test]
    fn coherence_bounds_a_rate_in_step_with_the_ship() {
        for axis in 0..3 {
            let mut gain = Matrix3::zeros();
            gain.set_row(axis, &nalgebra::RowVector3::new(3e-4, -5e-4, 2e-4));
            let (moved, told) = moved(gain);
            assert!((0..3).all(|k| moved[k].abs() <= told[k] * 1.01), "{moved} {told:?}");
        }
        let (moved, told) = moved(Matrix3::new(2e-4, -4e-4, 1e-4, 3e-4, 1e-4, -5e-4, -2e-4, 6e-4, 3e-4));
        assert!((0..3).all(|k| moved[k].abs() <= told[k] * 1.42), "{moved} {told:?}");
        let plain = Deviations(3.0).range(&evidence(0, 1e-16));
        assert!(plain[0] < moved.amax() / 100.0, "the naive range knows nothing of it");
    }
}
