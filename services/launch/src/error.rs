use runtime::TransportError;
use std::io;
use std::path::PathBuf;

/// Why a launch failed.
#[derive(Debug, thiserror::Error)]
pub enum LaunchError {
    /// The transport or the operating system refuses.
    #[error(transparent)]
    Transport(#[from] TransportError),
    /// A stage could not be started.
    #[error("cannot start the stage {stage}: {source}")]
    Start {
        /// Name of the stage.
        stage: String,
        /// The operating system's answer.
        source: io::Error,
    },
    /// A stage refuses its configuration or its recording; another start would not help.
    #[error("the stage {0} cannot do its work (its own message stands above)")]
    Refused(String),
    /// A stage met a poisoned transport.
    #[error("the stage {0} met a poisoned transport")]
    StagePoisoned(String),
    /// New domains did not help.
    #[error("the transport was poisoned {0} times in a row")]
    Poisoned(u32),
    /// Real-time scheduling was asked for and not granted.
    #[error(
        "run.scheduling = \"fifo\": the operating system does not grant SCHED_FIFO to every stage (root or CAP_SYS_NICE is needed); \"auto\" goes on without it"
    )]
    NoRealTime,
    /// A file could not be written.
    #[error("cannot write {}: {source}", path.display())]
    Output {
        /// The file.
        path: PathBuf,
        /// The operating system's answer.
        source: io::Error,
    },
    /// Files of the transport could not be removed.
    #[error("the transport left files behind: {0:?}")]
    Leftovers(Vec<PathBuf>),
}

impl LaunchError {
    /// Whether a new domain may help.
    pub fn is_poisoned(&self) -> bool {
        match self {
            Self::Transport(error) => error.is_poisoned(),
            Self::StagePoisoned(_) => true,
            _ => false,
        }
    }

    pub(crate) fn output(path: impl Into<PathBuf>) -> impl FnOnce(io::Error) -> Self {
        let path = path.into();
        move |source| Self::Output { path, source }
    }
}
