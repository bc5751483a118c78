use pipeline::configuration::ConfigurationError;
use pipeline::recording::RecordingError;

/// Why a trial could not be carried out.
#[derive(Debug, thiserror::Error)]
pub enum Fault {
    /// A preset is not sound.
    #[error(transparent)]
    Configuration(#[from] ConfigurationError),
    /// There is no preset of this name.
    #[error("there is no preset \"{0}\"")]
    NoSuchPreset(String),
    /// A recording cannot be read.
    #[error(transparent)]
    Recording(#[from] RecordingError),
    /// The configuration has no end, or its units are not simulated.
    #[error("{0}: an experiment needs simulated units and run.duration_s")]
    NotAnExperiment(String),
}
