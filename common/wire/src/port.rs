use std::fmt;
use std::net::SocketAddr;
use std::path::PathBuf;

/// Where a unit's bytes come from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Port {
    /// A serial line, 8 data bits, no parity, 1 stop bit.
    Serial {
        /// Such as `/dev/ttyUSB0`.
        path: PathBuf,
        /// Bits a second.
        baud: u32,
    },
    /// Datagrams that are sent to this address of this computer.
    Udp(SocketAddr),
    /// A server, `host:port`.
    Tcp(String),
    /// A file of [raw bytes](crate::raw), at the pace of its times.
    File(PathBuf),
}

impl fmt::Display for Port {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Serial { path, baud } => write!(f, "serial {} at {baud}", path.display()),
            Self::Udp(address) => write!(f, "udp {address}"),
            Self::Tcp(server) => write!(f, "tcp {server}"),
            Self::File(path) => write!(f, "file {}", path.display()),
        }
    }
}
