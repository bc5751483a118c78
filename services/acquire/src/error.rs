use runtime::TransportError;
use std::path::PathBuf;
use wire::Complaint;

/// Why units on wires could not be read.
#[derive(Debug, thiserror::Error)]
pub enum AcquireError {
    /// The transport or the operating system refuses.
    #[error(transparent)]
    Transport(#[from] TransportError),
    /// What comes is not what the configuration says.
    #[error("{unit}, {port}: {complaint}")]
    Stream {
        /// `main`, or the name of the area.
        unit: String,
        /// Where it comes from.
        port: String,
        /// What is wrong with it.
        complaint: Complaint,
    },
    /// A port could not be opened at the start.
    #[error("{unit}: cannot open {reason}")]
    Port {
        /// `main`, or the name of the area.
        unit: String,
        /// The port and the operating system's reason.
        reason: String,
    },
    /// A file of raw bytes cannot be used.
    #[error("{}: {reason}", path.display())]
    Raw {
        /// The file.
        path: PathBuf,
        /// Why not.
        reason: String,
    },
    /// The configuration has no units on wires.
    #[error("no source of the configuration is a device on a wire")]
    NoLine,
}

impl AcquireError {
    /// Whether another start would not help.
    pub fn is_lasting(&self) -> bool {
        !matches!(self, Self::Transport(_))
    }
}
