use experiments::Fault;
use std::io;
use std::path::PathBuf;

/// Why the experiments failed.
#[derive(Debug, thiserror::Error)]
pub enum ReproduceError {
    /// A file or folder cannot be written.
    #[error("cannot write {}: {source}", path.display())]
    Output {
        /// The file or folder.
        path: PathBuf,
        /// The operating system's answer.
        source: io::Error,
    },
    /// An experiment cannot be carried out.
    #[error(transparent)]
    Experiment(#[from] Fault),
    /// The threads cannot be started.
    #[error(transparent)]
    Threads(#[from] rayon::ThreadPoolBuildError),
    /// The rows cannot be told as JSON.
    #[error(transparent)]
    Json(#[from] serde_json::Error),
    /// A figure cannot be drawn.
    #[error("cannot draw \"{title}\": {reason}")]
    Drawing {
        /// The figure.
        title: String,
        /// The answer of the plotting library.
        reason: String,
    },
}
