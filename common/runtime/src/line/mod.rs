//! Bytes from a serial line, a datagram socket or a connection, as they come.

mod error;
mod outlet;

pub use error::LineError;
pub use outlet::Outlet;

use crate::monotonic_ns;
use serialport::TTYPort;
use std::io::{self, ErrorKind, Read};
use std::net::{TcpStream, ToSocketAddrs, UdpSocket};
use std::time::Duration;
use wire::Port;

/// How long a read waits for bytes.
const WAIT: Duration = Duration::from_millis(100);
/// How long a connection may take.
const CONNECT: Duration = Duration::from_secs(2);
/// Between attempts to open a port, ns.
const RETRY_NS: i64 = 500_000_000;

#[derive(Debug)]
enum Open {
    Serial(TTYPort),
    Udp(UdpSocket),
    Tcp(TcpStream),
}

/// A port that is opened, and opened again when it breaks off.
#[derive(Debug)]
pub struct Line {
    port: Port,
    open: Option<Open>,
    retry_ns: i64,
    opened: u64,
    fault: Option<LineError>,
}

impl Line {
    /// A line that is still closed.
    pub fn new(port: Port) -> Self {
        Self { port, open: None, retry_ns: i64::MIN, opened: 0, fault: None }
    }

    /// Waits up to a tenth of a second for bytes and gives how many there are; none also while the port cannot be opened.
    ///
    /// Of a datagram that is longer than `into` the rest is lost.
    pub fn read(&mut self, into: &mut [u8]) -> usize {
        let result = match &mut self.open {
            None => {
                self.try_to_open();
                return 0;
            }
            Some(Open::Serial(port)) => port.read(into),
            Some(Open::Udp(socket)) => socket.recv(into),
            Some(Open::Tcp(stream)) => match stream.read(into) {
                // the other side has gone
                Ok(0) => Err(ErrorKind::ConnectionAborted.into()),
                result => result,
            },
        };
        match result {
            Ok(count) => count,
            Err(error) if is_mere_waiting(error.kind()) => 0,
            Err(error) => {
                self.fault = Some(LineError::new(&self.port, error));
                (self.open, self.retry_ns) = (None, monotonic_ns() + RETRY_NS);
                0
            }
        }
    }

    /// How often the port has been opened.
    pub fn opened(&self) -> u64 {
        self.opened
    }

    /// Why the port is not open; `None` while it is, or before the first attempt.
    pub fn fault(&self) -> Option<&LineError> {
        self.fault.as_ref()
    }

    fn try_to_open(&mut self) {
        let now_ns = monotonic_ns();
        if now_ns < self.retry_ns {
            std::thread::sleep(WAIT);
            return;
        }
        match open(&self.port) {
            Ok(open) => {
                (self.open, self.fault) = (Some(open), None);
                self.opened += 1;
            }
            Err(error) => {
                self.fault = Some(LineError::new(&self.port, error));
                self.retry_ns = now_ns + RETRY_NS;
            }
        }
    }
}

fn is_mere_waiting(kind: ErrorKind) -> bool {
    matches!(kind, ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted)
}

fn open(port: &Port) -> io::Result<Open> {
    match port {
        Port::Serial { path, baud } => {
            let path = path.to_string_lossy();
            let port = serialport::new(path, *baud).timeout(WAIT).open_native()?;
            Ok(Open::Serial(port))
        }
        Port::Udp(address) => {
            let socket = UdpSocket::bind(address)?;
            socket.set_read_timeout(Some(WAIT))?;
            Ok(Open::Udp(socket))
        }
        Port::Tcp(server) => {
            let mut last = io::Error::from(ErrorKind::NotFound);
            for address in server.to_socket_addrs()? {
                match TcpStream::connect_timeout(&address, CONNECT) {
                    Ok(stream) => {
                        stream.set_read_timeout(Some(WAIT))?;
                        return Ok(Open::Tcp(stream));
                    }
                    Err(error) => last = error,
                }
            }
            Err(last)
        }
        Port::File(_) => Err(io::Error::new(ErrorKind::Unsupported, "it is a file, and no port")),
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use std::io::Write;
    use std::net::TcpListener;
    use std::time::Instant;

    /// Reads until there are so many bytes.
    fn next(line: &mut Line, count: usize) -> Vec<u8> {
        let (mut all, mut piece, begin) = (Vec::new(), [0; 64], Instant::now());
        while all.len() < count && begin.elapsed() < Duration::from_secs(20) {
            let read = line.read(&mut piece);
            all.extend_from_slice(&piece[..read]);
        }
        all
    }

    #[test]
    fn a_server_that_hangs_up_is_called_again() {
        let server = TcpListener::bind("127.0.0.1:0").unwrap();
        let address = server.local_addr().unwrap();
        let mut line = Line::new(Port::Tcp(address.to_string()));
        for (call, words) in [b"one, in two pieces".as_slice(), b"two"].into_iter().enumerate() {
            let words = words.to_owned();
            let server = server.try_clone().unwrap();
            let speaker = std::thread::spawn({
                let words = words.clone();
                move || {
                    let (mut stream, _) = server.accept().unwrap();
                    let (first, second) = words.split_at(words.len() / 2);
                    stream.write_all(first).unwrap();
                    std::thread::sleep(WAIT / 2);
                    stream.write_all(second).unwrap();
                }
            });
            assert_eq!(next(&mut line, words.len()), words);
            assert_eq!((line.opened(), line.fault().is_none()), (call as u64 + 1, true));
            speaker.join().unwrap();
        }
        drop(server);
        assert_eq!(next_fault(&mut line), (2, true), "nobody answers any more");
    }

    /// How often the line was opened when it has a fault.
    fn next_fault(line: &mut Line) -> (u64, bool) {
        let begin = Instant::now();
        while line.fault().is_none() && begin.elapsed() < Duration::from_secs(20) {
            line.read(&mut [0; 64]);
        }
        (line.opened(), line.fault().is_some())
    }
}
