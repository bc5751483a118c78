//! What the configuration says about an inertial unit: its source, its grade and how it is mounted.

use super::line::{Line, SourceTable};
use super::{quantity, table};
use frames::{Case, Frame, Rot, Vec3};
use messages::Stage;
use nalgebra::Matrix3;
use serde::Deserialize;
use serde::de::{Deserializer, Error};
use std::path::PathBuf;
use wire::Family;

/// Where the samples of a unit come from.
#[derive(Clone, Debug, PartialEq)]
pub enum Source {
    /// A recording; the path is absolute.
    Csv(PathBuf),
    /// A recorded run, which holds all units; the path is absolute.
    Mcap(PathBuf),
    /// The simulator.
    Simulator,
    /// A device at the end of a wire.
    Line(Line),
}

impl Source {
    /// The name of the kind, as in the configuration.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Csv(_) => "csv",
            Self::Mcap(_) => "mcap",
            Self::Simulator => "simulator",
            Self::Line(line) => line.device.family().name(),
        }
    }

    /// The stage that hands out its samples.
    pub fn stage(&self) -> Stage {
        match self {
            Self::Simulator => Stage::Simulate,
            Self::Csv(_) | Self::Mcap(_) => Stage::Replay,
            Self::Line(_) => Stage::Acquire,
        }
    }

    /// What stands at the end of the wire, if it is one.
    pub fn line(&self) -> Option<&Line> {
        match self {
            Self::Line(line) => Some(line),
            Self::Csv(_) | Self::Mcap(_) | Self::Simulator => None,
        }
    }
}

#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Kind {
    Csv,
    Mcap,
    Simulator,
    Kvh,
    Stdbin,
    Stim300,
}

impl Kind {
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Csv => "csv",
            Self::Mcap => "mcap",
            Self::Simulator => "simulator",
            Self::Kvh => Family::Kvh.name(),
            Self::Stdbin => Family::Stdbin.name(),
            Self::Stim300 => Family::Stim300.name(),
        }
    }
}

/// The paths are still those that stand in the file.
pub(super) fn source<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Source, D::Error> {
    let table: SourceTable = table::one(deserializer)?;
    let (kind, name) = (table.kind, table.kind.name());
    if let (Kind::Csv | Kind::Mcap | Kind::Simulator, Some(key)) = (kind, table.line_key()) {
        return Err(D::Error::custom(format!("a source of kind \"{name}\" has no `{key}`")));
    }
    match (kind, &table.path) {
        (Kind::Csv, Some(path)) => Ok(Source::Csv(path.clone())),
        (Kind::Mcap, Some(path)) => Ok(Source::Mcap(path.clone())),
        (Kind::Mcap, None) => Err(D::Error::custom("a source of kind \"mcap\" needs the key `path`")),
        (Kind::Csv, None) => Err(D::Error::custom("a source of kind \"csv\" needs the key `path`")),
        (_, Some(_)) => Err(D::Error::custom(format!("a source of kind \"{name}\" has no `path`"))),
        (Kind::Simulator, None) => Ok(Source::Simulator),
        (_, None) => table.line().map(Source::Line).map_err(D::Error::custom),
    }
}

/// The grade of a gyro triad: one standard deviation each.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Gyro {
    /// Angle random walk, rad/sqrt(s).
    #[serde(rename = "arw_deg_per_sqrt_h", deserialize_with = "quantity::arw_deg_per_sqrt_h")]
    pub arw: f64,
    /// Bias, rad/s.
    #[serde(rename = "bias_deg_per_h", deserialize_with = "quantity::bias_deg_per_h")]
    pub bias: f64,
    /// By how much the bias varies in the run, rad/s; a tenth of the bias if it is not told.
    #[serde(rename = "instability_deg_per_h", default, deserialize_with = "quantity::instability_deg_per_h")]
    instability: Option<f64>,
    /// Scale factor error, a ratio.
    #[serde(rename = "scale_ppm", default, deserialize_with = "quantity::scale_ppm")]
    pub scale: f64,
    /// Error of the direction of an axis, rad.
    #[serde(rename = "misalignment_arcsec", default, deserialize_with = "quantity::misalignment_arcsec")]
    pub misalignment: f64,
    /// Jitter of the time stamps, s.
    #[serde(rename = "stamp_jitter_us", default, deserialize_with = "quantity::stamp_jitter_us")]
    pub stamp_jitter: f64,
    /// End of the measuring range, rad/s; `None` if it is not known.
    #[serde(rename = "range_deg_per_s", default, deserialize_with = "quantity::range_deg_per_s")]
    pub range: Option<f64>,
}

impl Gyro {
    /// By how much the bias varies in the run, rad/s.
    pub fn instability(&self) -> f64 {
        self.instability.unwrap_or(0.1 * self.bias)
    }
}

/// The grade of an accelerometer triad: one standard deviation each.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Accel {
    /// Velocity random walk, m/s/sqrt(s).
    #[serde(rename = "vrw_ug_per_sqrt_hz", default, deserialize_with = "quantity::vrw_ug_per_sqrt_hz")]
    pub vrw: f64,
    /// Bias, m/s^2.
    #[serde(rename = "bias_ug", default, deserialize_with = "quantity::bias_ug")]
    pub bias: f64,
    /// Scale factor error, a ratio.
    #[serde(rename = "scale_ppm", default, deserialize_with = "quantity::scale_ppm")]
    pub scale: f64,
    /// Error of the direction of an axis, rad.
    #[serde(rename = "misalignment_arcsec", default, deserialize_with = "quantity::misalignment_arcsec")]
    pub misalignment: f64,
    /// End of the measuring range, m/s^2; `None` if it is not known.
    #[serde(rename = "range_g", default, deserialize_with = "quantity::range_g")]
    pub range: Option<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct MountingTable {
    #[serde(default, deserialize_with = "quantity::rotation_vector_deg")]
    rotation_vector_deg: Option<[f64; 3]>,
    #[serde(default, deserialize_with = "quantity::matrix")]
    matrix: Option<[[f64; 3]; 3]>,
}

/// Body axes from the unit's case axes.
pub(super) fn mounting<'de, D: Deserializer<'de>, F: Frame>(deserializer: D) -> Result<Rot<F, Case>, D::Error> {
    let mounting: MountingTable = table::one(deserializer)?;
    match (mounting.rotation_vector_deg, mounting.matrix) {
        (Some(phi), None) => Ok(Rot::exp(Vec3::from(phi))),
        (None, Some(rows)) => rotation(rows).map_err(D::Error::custom),
        _ => Err(D::Error::custom("needs either `rotation_vector_deg` or `matrix`")),
    }
}

/// A matrix typed with few decimals is accepted and replaced by the nearest rotation.
fn rotation<F: Frame>(rows: [[f64; 3]; 3]) -> Result<Rot<F, Case>, String> {
    let c = Matrix3::from_fn(|row, column| rows[row][column]);
    let excess = (c * c.transpose() - Matrix3::identity()).amax();
    if excess > 1e-3 {
        return Err(format!(
            "the matrix must be orthogonal within 0.001, but C C^T differs from the unit matrix by {excess:.4}"
        ));
    }
    if c.determinant() < 0.0 {
        return Err("the matrix must have the determinant +1, but it has -1: it mirrors an axis".into());
    }
    let svd = c.svd(true, true);
    match (svd.u, svd.v_t) {
        (Some(u), Some(v_t)) => Ok(Rot::from_matrix(&(u * v_t))),
        _ => Err("the matrix has no nearest rotation".into()),
    }
}
