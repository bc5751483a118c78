use std::fmt;
use std::io::{self, ErrorKind};
use wire::Port;

/// Why a port cannot be opened or has broken off.
#[derive(Debug)]
pub struct LineError {
    port: String,
    kind: ErrorKind,
    reason: String,
}

impl LineError {
    pub(super) fn new(port: &Port, error: impl Into<io::Error>) -> Self {
        let error = error.into();
        Self { port: port.to_string(), kind: error.kind(), reason: error.to_string() }
    }

    /// Whether waiting will hardly help: no permission, an address that is taken or not this computer's.
    pub fn is_lasting(&self) -> bool {
        matches!(self.kind, ErrorKind::PermissionDenied | ErrorKind::AddrInUse | ErrorKind::AddrNotAvailable)
    }
}

impl fmt::Display for LineError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.port, self.reason)?;
        match self.kind {
            ErrorKind::PermissionDenied => f.write_str(" (is the user in the group of the device, often dialout?)"),
            _ => Ok(()),
        }
    }
}

impl std::error::Error for LineError {}
