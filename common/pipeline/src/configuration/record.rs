//! What is recorded of a run, and where.

use super::quantity;
use serde::Deserialize;
use serde::de::{Deserializer, Error};
use std::path::{Path, PathBuf};

/// The recorder.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RecordSettings {
    /// Where the files go; absolute.
    pub folder: PathBuf,
    /// A chunk is written when it holds so many bytes.
    #[serde(rename = "chunk_kib", default = "chunk", deserialize_with = "quantity::chunk_kib")]
    pub chunk: f64,
    /// What has come is written after so many seconds at the latest.
    #[serde(default = "flush_s", deserialize_with = "quantity::flush_s")]
    pub flush_s: f64,
    /// A file of so many bytes is closed, and another one begun.
    #[serde(rename = "rotate_mb", default = "rotate", deserialize_with = "quantity::rotate_mb")]
    pub rotate: f64,
    /// The files of a run take so many bytes at most: the oldest are removed; `None` for no limit.
    #[serde(rename = "budget_mb", default, deserialize_with = "quantity::budget_mb")]
    pub budget: Option<f64>,
    /// What is recorded.
    #[serde(default = "everything", deserialize_with = "topics")]
    pub topics: Vec<RecordTopic>,
}

/// A kind of messages that can be recorded.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RecordTopic {
    /// The samples of all units and the main unit's attitude: what a replay needs.
    Samples,
    /// The synchronised pairs.
    Pairs,
    /// The parameter sets, and the samples at which they took effect.
    Parameters,
    /// The solutions.
    Solutions,
    /// The estimators' states, so that a replay can begin in the middle.
    States,
    /// How the stages do.
    Health,
    /// The truth, where there is one.
    Truth,
}

impl RecordSettings {
    /// Everything, with the usual sizes.
    pub fn new(folder: &Path) -> Self {
        Self {
            folder: folder.to_path_buf(),
            chunk: chunk(),
            flush_s: flush_s(),
            rotate: rotate(),
            budget: None,
            topics: everything(),
        }
    }
}

fn chunk() -> f64 {
    32.0 * 1024.0
}

fn flush_s() -> f64 {
    0.5
}

fn rotate() -> f64 {
    512e6
}

fn everything() -> Vec<RecordTopic> {
    use RecordTopic as T;
    vec![T::Samples, T::Pairs, T::Parameters, T::Solutions, T::States, T::Health, T::Truth]
}

fn topics<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<RecordTopic>, D::Error> {
    let topics = Vec::<RecordTopic>::deserialize(deserializer)?;
    if topics.is_empty() {
        return Err(D::Error::custom("at least one kind of messages is required"));
    }
    Ok(topics)
}
