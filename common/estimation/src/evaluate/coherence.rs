//! The range by an assumed coherence of flexure and ship.
//!
//! A flexure rate `d` in step with the ship's rate is a static angle to any processing of the same data. Over the last hour it is (004
//! eq 30 with the physical rate in place of the filter's error, each product bounded by Cauchy's inequality)
//!
//! `e_x = F sqrt(<w_y^2> V_z + <w_z^2> V_y) / (<w_y^2> + <w_z^2>)`, `V_i = <d_i^2>` as estimated plus the variance of the estimate,
//!
//! where F is the largest share of the flexure's deviation that is in step with the ship, 0 to 1, and has no unit. The two products
//! count as independent: where both are fully coherent and of the same sign, the angle is up to sqrt(2) larger. To this come three
//! deviations of the filter's own. The range does not shrink with time, as the error does not.

use super::error_range::others;
use super::window::Window;
use super::{Evaluate, Evidence, Kept};
use nalgebra::SVector;
use serde::{Deserialize, Serialize};

/// Half width about each axis, of the static part; the filter's deviations are those of the total.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Coherence {
    factor: [f64; 3],
    /// Of the squares of the ship's rate, then of the variances of the flexure's rate.
    window: Window<6>,
}

/// Deviations of the filter that are added.
const DEVIATIONS: f64 = 3.0;

impl Coherence {
    /// A range for a coherence of at most so much about each axis, 0 to 1.
    pub fn new(factor: [f64; 3]) -> Self {
        Self { factor, window: Window::new() }
    }

    pub(super) fn factor(&self) -> [f64; 3] {
        self.factor
    }
}

impl Evaluate for Coherence {
    fn range(&mut self, evidence: &Evidence) -> [f64; 3] {
        let (w, d) = (evidence.w_im_m.column(), evidence.rate.column());
        let squares = w.component_mul(&w);
        let sizes = d.component_mul(&d) + evidence.rate_covariance.diagonal();
        let values = SVector::<f64, 6>::from_iterator(squares.iter().chain(sizes.iter()).copied());
        let mean = self.window.mean(values, evidence.interval_s);
        let own = evidence.covariance.diagonal().map(|variance| DEVIATIONS * variance.sqrt());
        let Some(mean) = mean else { return own.into() };
        [0, 1, 2].map(|k| {
            let (a, b) = others(k);
            let coherent = (mean[a] * mean[3 + b] + mean[b] * mean[3 + a]).sqrt();
            own[k] + self.factor[k] * coherent / (mean[a] + mean[b]).max(f64::MIN_POSITIVE)
        })
    }

    fn kept(&self) -> Kept {
        Kept::Coherence(self.clone())
    }
}
