//! Paper 001: a large misalignment angle by quaternion optimisation and what it left over by a filter with a neural network.
//!
//! Truth is the product `Exp(flexure) Exp(quasi-static) C_installation`; the paper adds Euler angles (its eq 35), which is off by up to
//! 23 arcsec at 4.5 degrees. Errors of tables 3 to 6 are those of the Euler angles, as the paper's. The bound is the standard deviation of the
//! filter on SO(3) that is told the true parameters, after it has settled: 2.4, 3.7, 3.5 arcsec. It exceeds what a known law of the quasi-static
//! part would allow, which no method is told.

mod case;
mod large;
mod method;
mod published;
mod registration;
mod sweep;

use crate::Study;

pub(crate) const TITLE: &str = "Paper 001: Q-NNKF, matching at a large misalignment angle";

/// The studies of this paper.
pub(crate) fn studies() -> Vec<Study> {
    vec![registration::study(), case::study(), sweep::study(), large::study()]
}
