use runtime::TransportError;
use std::io;

/// Why the stage cannot do its work.
#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    /// A destination cannot be opened.
    #[error("output[{number}].to = {to}: {reason}")]
    Destination {
        /// Its place in the configuration.
        number: usize,
        /// The destination in words.
        to: String,
        /// The operating system's answer.
        reason: io::Error,
    },
    /// The transport or the operating system refuses.
    #[error(transparent)]
    Transport(#[from] TransportError),
}
