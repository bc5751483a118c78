//! `deckflex export`: a recorded run as CSV files.

mod samples;
mod tables;

use pipeline::configuration::{Configuration, ConfigurationError};
use pipeline::recorded_run::{Files, is_one};
use pipeline::recording::RecordingError;
use samples::Samples;
use std::fmt;
use std::io;
use std::path::{Path, PathBuf};
use tables::Tables;

/// Why a run could not be exported.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    /// The configuration in the recording cannot be used.
    #[error(transparent)]
    Configuration(#[from] ConfigurationError),
    /// The recording cannot be read.
    #[error(transparent)]
    Recording(#[from] RecordingError),
    /// A file cannot be written.
    #[error("cannot write {}: {source}", path.display())]
    Output {
        /// The file or folder.
        path: PathBuf,
        /// The operating system's answer.
        source: io::Error,
    },
}

/// What was written.
#[derive(Clone, Debug)]
pub struct Report {
    /// Each file with its rows.
    pub files: Vec<(PathBuf, u64)>,
    /// What is wrong with the recording, a sentence each.
    pub remarks: Vec<String>,
}

/// Writes all topics of a recorded run into a folder: the units' samples as recordings that can be the source of a run, the solutions
/// as `process` does, every other topic with the fields of its messages as columns.
///
/// # Errors
/// The recording cannot be read, or a file cannot be written.
pub fn run(path: &Path, out: &Path) -> Result<Report, ExportError> {
    if !is_one(path) {
        // with the reason in the words of whoever opens it
        pipeline::recorded_run::about(path)?;
    }
    let configuration = Configuration::read(path)?;
    let output = |source| ExportError::Output { path: out.to_path_buf(), source };
    std::fs::create_dir_all(out).map_err(output)?;
    let mut files = Files::open(path)?;
    let mut tables = Tables::new(out, &configuration);
    for (topic, record) in files.by_ref() {
        tables.write(&topic, &record).map_err(output)?;
    }
    let mut written = tables.finish().map_err(output)?;
    written.extend(Samples::write(path, &configuration, out)?);
    let mut remarks: Vec<String> =
        files.cuts().iter().map(|(path, reason)| format!("{} is cut: {reason}", path.display())).collect();
    if files.unreadable() > 0 {
        remarks.push(format!("{} messages could not be read", files.unreadable()));
    }
    Ok(Report { files: written, remarks })
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (path, rows) in &self.files {
            writeln!(f, "{rows:>9} rows {}", path.display())?;
        }
        self.remarks.iter().try_for_each(|remark| writeln!(f, "{remark}"))
    }
}
