//! The recording of a run: an MCAP file whose messages any reader can understand, since their schemas stand in it.
//!
//! Messages are Protocol Buffers: numbers come back to the bit, NaN and infinities included, and the common viewers read them. The
//! schema of each message is worked out from the fields of its struct (`structure`), so the two cannot part.
//!
//! A file consists of whole chunks: what was flushed can be read though the rest is missing.

mod about;
mod adoption;
mod field;
mod reader;
mod record;
mod structure;
mod writer;

pub use about::{About, Ending};
pub use adoption::Adoption;
pub use reader::{Event, Message, Reader};
pub use record::Record;
pub use writer::Writer;

/// What a recording's file begins with.
pub use mcap::MAGIC;

/// Why a recording cannot be written or read.
#[derive(Debug, thiserror::Error)]
pub enum FormatError {
    /// The file's own structure, or the file.
    #[error("{}", reason(.0))]
    File(#[from] mcap::McapError),
    /// A message's bytes are not those of its schema.
    #[error("a message of topic {topic} cannot be read: {reason}")]
    Message {
        /// The topic.
        topic: String,
        /// What is wrong with it.
        reason: prost::DecodeError,
    },
}

/// The library does not pass on what the operating system says.
fn reason(error: &mcap::McapError) -> String {
    match error {
        mcap::McapError::Io(error) => error.to_string(),
        other => other.to_string(),
    }
}
