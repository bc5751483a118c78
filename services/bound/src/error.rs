use pipeline::configuration::ConfigurationError;
use pipeline::recording::RecordingError;
use std::io;
use std::path::PathBuf;

/// Why there is no bound.
#[derive(Debug, thiserror::Error)]
pub enum BoundError {
    /// The configuration is not sound, or tells no motion or no true flexure to reckon from.
    #[error(transparent)]
    Configuration(#[from] ConfigurationError),
    /// The source cannot be opened.
    #[error(transparent)]
    Source(#[from] RecordingError),
    /// An output file cannot be written.
    #[error("cannot write {}: {source}", path.display())]
    Output {
        /// The file.
        path: PathBuf,
        /// The operating system's answer.
        source: io::Error,
    },
    /// The numbers cannot be told as JSON.
    #[error(transparent)]
    Json(#[from] serde_json::Error),
    /// The figure cannot be drawn.
    #[error("cannot draw the figure: {0}")]
    Drawing(String),
}
