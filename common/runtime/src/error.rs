use std::io;
use std::path::{Path, PathBuf};

/// The exit code of a stage that met a poisoned transport: the launcher answers with a new domain, not with a mere restart.
pub const POISONED_EXIT_CODE: u8 = 75;

/// What can go wrong between a stage and the transport or the operating system.
#[derive(Debug, thiserror::Error)]
pub enum TransportError {
    /// A file or directory of a domain could not be read, written or removed.
    #[error("cannot {action} {}: {source}", path.display())]
    File {
        /// What was tried.
        action: &'static str,
        /// With which file.
        path: PathBuf,
        /// The answer of the operating system.
        source: io::Error,
    },
    /// A call of the operating system failed.
    #[error("{call} failed: {source}")]
    System {
        /// Which call.
        call: &'static str,
        /// The answer of the operating system.
        source: io::Error,
    },
    /// The path does not lead to a usable domain.
    #[error("{} is not a domain: {reason}", path.display())]
    NotADomain {
        /// The path that was given.
        path: PathBuf,
        /// Why it cannot be used.
        reason: &'static str,
    },
    /// The parent process ended before its death could be watched.
    #[error("the parent process is gone")]
    Orphaned,
    /// The name of a node or topic holds characters that the transport refuses, is empty or too long.
    #[error("the transport refuses the name \"{0}\"")]
    Name(String),
    /// The node of the process could not be opened.
    #[error("cannot open the node {node}: {reason}")]
    Node {
        /// Name of the node.
        node: String,
        /// The transport's reason.
        reason: String,
    },
    /// The topic exists with another message type, another layout or a smaller quality of service.
    #[error("topic {topic} exists with another type or quality of service: {reason}")]
    Incompatible {
        /// Name of the topic.
        topic: String,
        /// The transport's reason.
        reason: String,
    },
    /// All places of the topic are taken by living processes.
    #[error("topic {topic} has no place left: {reason}")]
    Occupied {
        /// Name of the topic.
        topic: String,
        /// The transport's reason.
        reason: String,
    },
    /// Files of the domain are in a state that only a new domain heals, as after a kill in the middle of their creation.
    #[error("the transport is poisoned at {name}: {reason}; only a new domain helps")]
    Poisoned {
        /// Name of the topic or node.
        name: String,
        /// The transport's reason.
        reason: String,
    },
    /// A port could not be made, or could not send, receive or notify.
    #[error("cannot {action} topic {topic}: {reason}")]
    Port {
        /// What was tried.
        action: &'static str,
        /// Name of the topic.
        topic: String,
        /// The transport's reason.
        reason: String,
    },
    /// A latency log could not be written.
    #[error("cannot write the latency log: {0}")]
    Log(String),
}

impl TransportError {
    /// Whether only a new domain helps; the process then ends with [`POISONED_EXIT_CODE`].
    pub fn is_poisoned(&self) -> bool {
        matches!(self, Self::Poisoned { .. })
    }

    pub(crate) fn file(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> Self {
        let path = path.to_owned();
        move |source| Self::File { action, path, source }
    }

    pub(crate) fn last_os(call: &'static str) -> Self {
        Self::System { call, source: io::Error::last_os_error() }
    }
}
