use pipeline::configuration::ConfigurationError;
use pipeline::recording::RecordingError;
use std::io;
use std::path::PathBuf;

/// Why there is no Allan deviation.
#[derive(Debug, thiserror::Error)]
pub enum AllanError {
    /// The configuration that names the recording is not sound.
    #[error(transparent)]
    Configuration(#[from] ConfigurationError),
    /// The recording cannot be used.
    #[error(transparent)]
    Recording(#[from] RecordingError),
    /// The configuration has no such unit, or the unit is no recording.
    #[error("{}: the unit \"{unit}\" is no recording here; recorded units: {}", path.display(), list(known))]
    Unit {
        /// The configuration.
        path: PathBuf,
        /// The unit that was asked for.
        unit: String,
        /// Those that it has recordings of.
        known: Vec<String>,
    },
    /// A unit was asked for, but the file is a recording.
    #[error("{}: --unit names a unit of a configuration (.toml), but this is a recording of one unit", .0.display())]
    NeedlessUnit(PathBuf),
    /// The recording is too short.
    #[error("{}: no gyro shows noise over 48 or more samples without a hole", .0.display())]
    TooShort(PathBuf),
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

fn list(names: &[String]) -> String {
    if names.is_empty() { "none".into() } else { names.join(", ") }
}

impl AllanError {
    /// Whether what the user gave cannot be used, so that nothing was tried.
    pub fn is_unusable(&self) -> bool {
        !matches!(self, Self::Output { .. } | Self::Json(_) | Self::Drawing(_))
    }
}
