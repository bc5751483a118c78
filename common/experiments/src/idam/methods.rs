//! The methods that are compared, each the estimator and the identifier of a preset.

use crate::{Fault, Published, presets};
use pipeline::configuration::{Configuration, IdentifierMethod};

/// A method.
#[derive(Debug)]
pub(super) struct Method {
    /// In the identities of rows.
    pub id: &'static str,
    /// In tables and figures.
    pub name: &'static str,
    /// Whose estimator and identifier it is.
    pub preset: &'static str,
    /// Whether it is told the true flexure instead of identifying it.
    pub told: bool,
    /// Whether the filter takes the flexure as it comes, without the rule that makes it safe.
    pub raw: bool,
    /// The method that bounds it.
    pub bound: &'static str,
    /// What the paper says of its RMSE about z, arcmin.
    pub paper: Paper,
    /// Why its verdict is what it is.
    pub why: &'static str,
}

/// What the paper says of a method's RMSE about z, arcmin.
#[derive(Clone, Copy, Debug)]
pub(super) enum Paper {
    /// A figure.
    Figure(f64),
    /// The best figure of the paper, which a method of ours should not exceed.
    Best,
    /// Nothing.
    Nothing,
}

/// The paper's IDAM, arcmin.
const IDAM: f64 = 4.26;

impl Method {
    const fn new(id: &'static str, name: &'static str, preset: &'static str, paper: Paper, why: &'static str) -> Self {
        Self { id, name, preset, told: false, raw: false, bound: "ekf-true", paper, why }
    }

    const fn told(self) -> Self {
        Self { told: true, ..self }
    }

    const fn raw(self) -> Self {
        Self { raw: true, ..self }
    }

    const fn bound(self, bound: &'static str) -> Self {
        Self { bound, ..self }
    }

    /// The scenario with this method.
    pub(super) fn on(&self, scenario: &Configuration) -> Result<Configuration, Fault> {
        let preset = presets::configuration(self.preset, scenario.run.seed)?;
        Ok(scenario.with(|c| {
            c.areas[0].estimator = preset.areas[0].estimator;
            c.areas[0].identifier = preset.areas[0].identifier;
            if self.told {
                tell(c);
            }
            if self.raw {
                c.areas[0].identifier.safety = false;
            }
        }))
    }

    /// What the paper says of an axis.
    pub(super) fn published(&self, axis: &str) -> Published {
        match (axis, self.paper) {
            ("z", Paper::Figure(value)) => Published::Magnitude(value, 1),
            ("z", Paper::Best) => Published::AtMost(IDAM),
            ("z", Paper::Nothing) => Published::Nothing("the paper has no such method".into()),
            _ => Published::Nothing("the paper gives numbers for z only".into()),
        }
    }
}

/// Gives the filter the true flexure.
fn tell(configuration: &mut Configuration) {
    let area = &mut configuration.areas[0];
    area.identifier.method = IdentifierMethod::Fixed(area.simulation.hull());
}

const CHAIN: &str = "The chain of both gyros through the estimated installation carries no flexure into the output, \
                     so that a flexure model need not be known well.";
const RAW: &str = "Nothing is added to the flexure that was found: with the bending lever arm one that is thought too small turns into \
                   false knowledge, which the safety rule of the rows above prevents.";
const LITERAL: &str = "The predicted error of the model takes most of each innovation, and the update counts the same \
                       measurement again: the misalignment at the start is hardly corrected, which is the paper's size.";

/// All methods; each comes after its bound.
pub(super) const METHODS: [Method; 19] = [
    Method::new(
        "ekf-true",
        "EKF, true parameters",
        "idam_ekf",
        Paper::Nothing,
        "The filter of the paper's model with the true flexure bounds those that identify it.",
    )
    .told(),
    Method::new("ekf-rvm", "EKF, RVM", "idam_ekf", Paper::Best, CHAIN),
    Method::new("ekf-svr", "EKF, SVR (SVRAM)", "idam_svram", Paper::Figure(6.56), CHAIN),
    Method::new("ekf-woa", "EKF, WOA (WOAM)", "idam_woam", Paper::Figure(5.032), CHAIN),
    Method::new("ekf-whittle", "EKF, Whittle", "idam_whittle", Paper::Best, CHAIN),
    Method::new("ekf-rvm-raw", "EKF, RVM as identified", "idam_ekf", Paper::Best, RAW).raw(),
    Method::new("ekf-svr-raw", "EKF, SVR (SVRAM) as identified", "idam_svram", Paper::Figure(6.56), RAW).raw(),
    Method::new("ekf-woa-raw", "EKF, WOA (WOAM) as identified", "idam_woam", Paper::Figure(5.032), RAW).raw(),
    Method::new("ekf-whittle-raw", "EKF, Whittle as identified", "idam_whittle", Paper::Best, RAW).raw(),
    Method::new("mpf", "MPF, RVM", "idam_mpf", Paper::Nothing, LITERAL),
    Method::new(
        "mcc-noise",
        "MCC by R, RVM",
        "idam_mcc",
        Paper::Nothing,
        "Weights cannot help against impulsive waves, which are no error of a measurement; they help against spikes.",
    ),
    Method::new(
        "mcc-innovation",
        "MCC by the innovation, RVM",
        "idam_mcc_innovation",
        Paper::Nothing,
        "Weights cannot help against impulsive waves, which are no error of a measurement; they help against spikes.",
    ),
    Method::new("idam-literal", "IDAM to the letter", "idam_literal", Paper::Figure(IDAM), LITERAL),
    Method::new(
        "idam-weighted",
        "IDAM, A = 100 dt Q^-1",
        "idam_weighted",
        Paper::Best,
        "With a heavy weight little is predicted, and the harm is gone.",
    ),
    Method::new(
        "idam-bayes",
        "IDAM, Bayes weighting",
        "idam_bayes",
        Paper::Best,
        "The predicted error of the model is the noise's own share of the innovation, so that the misalignment is corrected.",
    ),
    Method::new(
        "printed",
        "EKF, RVM, 2 l + theta",
        "idam_printed",
        Paper::Nothing,
        "The parameters l hold the flexure at the start, which the sum counts as static.",
    ),
    Method::new(
        "so3-true",
        "SO(3), true parameters",
        "idam",
        Paper::Nothing,
        "The attitude filter with the true flexure bounds the one that identifies it.",
    )
    .told()
    .bound("so3-true"),
    Method::new("so3-rvm", "SO(3), RVM", "idam", Paper::Best, CHAIN).bound("so3-true"),
    Method::new("so3-whittle", "SO(3), Whittle", "idam_so3_whittle", Paper::Best, CHAIN).bound("so3-true"),
];

/// The method of an identity.
///
/// # Panics
/// There is none: identities are constants of the studies, whose tests look every one of them up.
pub(super) fn method(id: &str) -> &'static Method {
    METHODS.iter().find(|method| method.id == id).unwrap_or_else(|| panic!("no method {id}"))
}
