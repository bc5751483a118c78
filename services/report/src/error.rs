use pipeline::configuration::ConfigurationError;
use pipeline::recording::RecordingError;
use std::io;
use std::path::PathBuf;

/// Why there is no report.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// The configuration in the recording cannot be used.
    #[error(transparent)]
    Configuration(#[from] ConfigurationError),
    /// The recording cannot be read.
    #[error(transparent)]
    Recording(#[from] RecordingError),
    /// The page cannot be written.
    #[error("cannot write {}: {source}", path.display())]
    Output {
        /// The page.
        path: PathBuf,
        /// The operating system's answer.
        source: io::Error,
    },
}

impl ReportError {
    /// Whether the recording is to blame and not the disk.
    pub fn is_unusable(&self) -> bool {
        !matches!(self, Self::Output { .. })
    }
}
