//! Paper 000: deck deformation by velocity and rate matching in inertial space, with the flexure identified and the filter made robust.
//!
//! | file | of the paper |
//! |---|---|
//! | [`methods`] | the methods, each a preset |
//! | [`deformation`] | section 5: errors of the deformation, in Gaussian noise, impulsive waves and outliers |
//! | [`identification`] | section 3: what the identifiers find |
//! | [`shipborne`] | section 6 in simulation |
//! | [`figures`] | figures 4 to 6 |

mod deformation;
mod figures;
mod identification;
mod methods;
mod shipborne;

use crate::Study;

pub(crate) const TITLE: &str = "Paper 000: IDAM with parameters from a relevance vector machine";

const AXES: [&str; 3] = ["x", "y", "z"];

/// The studies of this paper.
pub(crate) fn studies() -> Vec<Study> {
    let mut studies: Vec<Study> = deformation::SCENARIOS.iter().map(deformation::study).collect();
    studies.push(identification::study());
    studies.push(shipborne::study());
    studies
}
