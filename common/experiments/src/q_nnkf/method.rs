//! The methods of the paper on its scenario.

use crate::{Data, Fault, Stretch, Track, presets, run};
use frames::unit::{ARCSEC, DEGREE};
use frames::{Main, Rot, Sub, Vec3};
use nalgebra::Vector3;
use pipeline::configuration::Configuration;
use std::ops::RangeInclusive;

pub(super) const AXES: [&str; 3] = ["x", "y", "z"];
pub(super) const DURATION_S: f64 = 3600.0;
/// Errors count from here, when nothing is left of the start; the paper's span is not published.
pub(super) const SPAN: RangeInclusive<f64> = 1200.0..=DURATION_S;

/// A method of the paper, or ours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Method {
    Ckf,
    Ekf,
    Nnkf,
    QKf,
    QNnkf,
    QNnkfPrinted,
    So3,
}

impl Method {
    pub fn name(self) -> &'static str {
        match self {
            Self::Ckf => "CKF",
            Self::Ekf => "EKF on the exact measurement",
            Self::Nnkf => "NNKF",
            Self::QKf => "Q-KF, no network",
            Self::QNnkf => "Q-NNKF, network beside the model",
            Self::QNnkfPrinted => "Q-NNKF as printed",
            Self::So3 => "SO(3)",
        }
    }

    /// In the identity of a row, and of its preset after `q_nnkf_`.
    pub fn key(self) -> &'static str {
        match self {
            Self::Ckf => "ckf",
            Self::Ekf => "ekf",
            Self::Nnkf => "nnkf",
            Self::QKf => "q_kf",
            Self::QNnkf => "q_nnkf",
            Self::QNnkfPrinted => "q_nnkf_printed",
            Self::So3 => "so3",
        }
    }

    fn has_network(self) -> bool {
        matches!(self, Self::Nnkf | Self::QNnkf | Self::QNnkfPrinted)
    }

    /// Lets the method run over data. The error does not depend on the filter's rate, so it is as slow as the cost of 56 states asks for.
    pub fn track(self, seed: u64, data: &Data, every_s: f64) -> Result<Track, Fault> {
        let preset = presets::configuration(&format!("q_nnkf_{}", self.key()), seed)?.with(|c| {
            let estimator = &mut c.areas[0].estimator;
            estimator.filter_hz = if self.has_network() { 1.0 } else { 2.0 };
            if self.has_network() {
                estimator.network.get_or_insert_default().seed = seed;
            }
        });
        Ok(run(&preset, data, every_s))
    }
}

/// The paper's scenario with another installation angle, as a rotation vector.
pub(super) fn scenario(seed: u64, installation: Vec3<Main>, duration_s: f64) -> Result<Configuration, Fault> {
    Ok(presets::configuration("q_nnkf", seed)?.with(|c| {
        c.areas[0].simulation.installation = installation;
        c.run.duration_s = Some(duration_s);
    }))
}

/// An installation angle in degrees about each axis.
pub(super) fn degrees(angles: [f64; 3]) -> Vec3<Main> {
    Vec3::from(angles) * DEGREE
}

/// The Euler angles of a deformation given as rotation vector, in the paper's order (its eq 22), rad.
pub(super) fn euler(rotation_vector: [f64; 3]) -> [f64; 3] {
    let c = Rot::<Main, Sub>::exp(Vec3::from(rotation_vector)).matrix();
    [c[(2, 1)].clamp(-1.0, 1.0).asin(), (-c[(2, 0)]).atan2(c[(2, 2)]), (-c[(0, 1)]).atan2(c[(1, 1)])]
}

/// What is kept of a run, arcsec.
#[derive(Clone, Copy, Debug)]
pub(super) struct Figures {
    /// Root mean square error of the Euler angles, which is what the paper tabulates.
    pub rmse: [f64; 3],
    /// Root mean square error of the rotation, seen in m.
    pub rotation: [f64; 3],
    /// The method's own standard deviation.
    pub sigma: [f64; 3],
}

impl Figures {
    pub fn of(stretch: Stretch) -> Self {
        let arcsec = |rad: [f64; 3]| rad.map(|v| v / ARCSEC);
        let difference = |estimate, truth| Vector3::from(euler(estimate)) - Vector3::from(euler(truth));
        Self {
            rmse: arcsec(stretch.rms_of(|point| difference(point.estimate, point.truth).into())),
            rotation: arcsec(stretch.rmse()),
            sigma: arcsec(stretch.sigma()),
        }
    }
}
