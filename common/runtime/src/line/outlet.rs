//! The other end of a line, for emulated units.

use super::LineError;
use serialport::{SerialPort, TTYPort};
use std::io::{self, ErrorKind, Write};
use std::net::{Ipv4Addr, Ipv6Addr, SocketAddr, UdpSocket};
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::time::Duration;
use wire::Port;

/// Where a unit would be: a pseudo-terminal whose other end is found at the port's path, or a socket that sends to its address.
#[derive(Debug)]
pub enum Outlet {
    /// A pseudo-terminal.
    Serial {
        /// The end that is written to.
        near: TTYPort,
        /// Kept open, so that writing does not fail while nobody reads.
        _far: TTYPort,
        /// A symbolic link to the other end.
        link: PathBuf,
    },
    /// A socket and where it sends to.
    Udp(UdpSocket, SocketAddr),
}

impl Outlet {
    /// Opens the outlet that a reader of this port will hear.
    ///
    /// # Errors
    /// The path of a serial line is taken by something else than a link, the operating system refuses, or the port is a server's.
    pub fn open(port: &Port) -> Result<Self, LineError> {
        let open = || match port {
            Port::Serial { path, .. } => pseudo_terminal(path),
            Port::Udp(address) => {
                let any: SocketAddr = match address {
                    SocketAddr::V4(_) => (Ipv4Addr::UNSPECIFIED, 0).into(),
                    SocketAddr::V6(_) => (Ipv6Addr::UNSPECIFIED, 0).into(),
                };
                Ok(Self::Udp(UdpSocket::bind(any)?, *address))
            }
            Port::Tcp(_) | Port::File(_) => {
                Err(io::Error::new(ErrorKind::Unsupported, "only `serial` and `udp` can be emulated"))
            }
        };
        open().map_err(|error| LineError::new(port, error))
    }

    /// Sends a frame; `false` where nobody takes it.
    pub fn send(&mut self, frame: &[u8]) -> bool {
        match self {
            // a full buffer takes nothing or a part, as a line that breaks off
            Self::Serial { near, .. } => near.write(frame).is_ok_and(|count| count == frame.len()),
            Self::Udp(socket, to) => socket.send_to(frame, *to).is_ok(),
        }
    }
}

impl Drop for Outlet {
    fn drop(&mut self) {
        if let Self::Serial { link, .. } = self {
            // fails only where it has been removed already
            let _ = std::fs::remove_file(link);
        }
    }
}

fn pseudo_terminal(path: &Path) -> io::Result<Outlet> {
    let (mut near, far) = TTYPort::pair()?;
    near.set_timeout(Duration::ZERO)?;
    let name = far.name().ok_or_else(|| io::Error::other("the pseudo-terminal has no name"))?;
    // of an emulator that was killed
    if path.is_symlink() {
        std::fs::remove_file(path)?;
    }
    symlink(name, path)?;
    Ok(Outlet::Serial { near, _far: far, link: path.to_owned() })
}
