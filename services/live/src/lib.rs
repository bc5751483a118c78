//! `deckflex live`: a running launch for viewers that speak the Foxglove WebSocket, with the schemas and bytes of the recordings.
//!
//! Empty without the feature `foxglove`.

#[cfg(feature = "foxglove")]
mod follow;
#[cfg(feature = "foxglove")]
mod inputs;
#[cfg(feature = "foxglove")]
mod server;
#[cfg(feature = "foxglove")]
mod words;

#[cfg(feature = "foxglove")]
pub use follow::{LiveError, Options, Report, Say, run};
