use pipeline::configuration::Destination;
use runtime::monotonic_ns;
use serialport::TTYPort;
use socket2::{Domain, Protocol, Socket, Type};
use std::io::{self, ErrorKind, Write};
use std::net::{IpAddr, Ipv4Addr, SocketAddr, UdpSocket};
use std::os::fd::AsRawFd;
use std::path::Path;

/// A line that broke is opened again so often, ns.
const RETRY_NS: i64 = 1_000_000_000;

/// The way to a destination. It never waits: what the operating system does not take at once is not sent.
pub struct Line {
    to: Destination,
    open: Option<Open>,
    /// Whether the last telegram was taken.
    sound: bool,
    retry_ns: i64,
}

enum Open {
    Udp(UdpSocket, SocketAddr),
    Serial(Serial),
}

/// A serial line with what it has not taken yet of a telegram that it has begun.
struct Serial {
    port: TTYPort,
    rest: Vec<u8>,
}

impl Line {
    /// A line that is not open yet.
    pub fn new(to: Destination) -> Self {
        Self { to, open: None, sound: false, retry_ns: 0 }
    }

    /// Opens the line.
    pub fn open(&mut self) -> io::Result<()> {
        self.retry_ns = monotonic_ns() + RETRY_NS;
        let open = match &self.to {
            Destination::Udp { address, ttl, interface } => Open::Udp(udp(*address, *ttl, *interface)?, *address),
            Destination::Serial { device, baud } => {
                Open::Serial(Serial { port: serial(device, *baud)?, rest: Vec::new() })
            }
        };
        (self.open, self.sound) = (Some(open), true);
        Ok(())
    }

    /// Whether telegrams are taken at present.
    pub fn is_open(&self) -> bool {
        self.open.is_some() && self.sound
    }

    /// Sends a whole telegram or nothing of it; `false` if the line is full or broken.
    pub fn send(&mut self, telegram: &[u8]) -> bool {
        let sent = match &mut self.open {
            None => Ok(false),
            Some(Open::Udp(socket, address)) => socket.send_to(telegram, *address).map(|_| true),
            Some(Open::Serial(serial)) => serial.send(telegram),
        };
        self.judge(sent)
    }

    /// Sends what a slow line has left, and tries to open one that broke.
    pub fn attend(&mut self, now_ns: i64) {
        match &mut self.open {
            None if now_ns >= self.retry_ns => {
                // the next telegram tells whether it worked
                let _ = self.open();
            }
            Some(Open::Serial(serial)) if !serial.rest.is_empty() => {
                let rest = serial.work_off();
                self.judge(rest.map(|()| true));
            }
            _ => {}
        }
    }

    fn judge(&mut self, sent: io::Result<bool>) -> bool {
        // a datagram that is refused says nothing about the next one, but a serial device is gone
        if sent.is_err() && matches!(self.open, Some(Open::Serial(_))) {
            self.open = None;
            self.retry_ns = monotonic_ns() + RETRY_NS;
        }
        self.sound = matches!(sent, Ok(true));
        self.sound
    }
}

impl Serial {
    /// What has been begun is finished first; a telegram of which nothing is taken is not sent.
    fn send(&mut self, telegram: &[u8]) -> io::Result<bool> {
        self.work_off()?;
        if !self.rest.is_empty() {
            return Ok(false);
        }
        let taken = self.write(telegram)?;
        if taken > 0 {
            self.rest.extend_from_slice(&telegram[taken..]);
        }
        Ok(taken > 0)
    }

    fn work_off(&mut self) -> io::Result<()> {
        if !self.rest.is_empty() {
            let rest = std::mem::take(&mut self.rest);
            let taken = self.write(&rest)?;
            self.rest = rest[taken..].to_vec();
        }
        Ok(())
    }

    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self.port.write(bytes) {
            Err(error)
                if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted) =>
            {
                Ok(0)
            }
            other => other,
        }
    }
}

fn udp(address: SocketAddr, ttl: Option<u8>, interface: Option<Ipv4Addr>) -> io::Result<UdpSocket> {
    let socket = Socket::new(Domain::for_address(address), Type::DGRAM, Some(Protocol::UDP))?;
    socket.set_nonblocking(true)?;
    if let Some(interface) = interface {
        socket.bind(&SocketAddr::from((interface, 0)).into())?;
    }
    match address.ip() {
        IpAddr::V4(ip) if ip.is_multicast() => {
            interface.map_or(Ok(()), |interface| socket.set_multicast_if_v4(&interface))?;
            ttl.map_or(Ok(()), |ttl| socket.set_multicast_ttl_v4(ttl.into()))?;
        }
        IpAddr::V4(_) => {
            socket.set_broadcast(true)?;
            ttl.map_or(Ok(()), |ttl| socket.set_ttl_v4(ttl.into()))?;
        }
        IpAddr::V6(ip) if ip.is_multicast() => {
            ttl.map_or(Ok(()), |ttl| socket.set_multicast_hops_v6(ttl.into()))?;
        }
        IpAddr::V6(_) => ttl.map_or(Ok(()), |ttl| socket.set_unicast_hops_v6(ttl.into()))?,
    }
    Ok(socket.into())
}

fn serial(device: &Path, baud: u32) -> io::Result<TTYPort> {
    let port = serialport::new(device.to_string_lossy(), baud).open_native()?;
    // SAFETY: both calls only read and set the flags of a descriptor that `port` owns.
    let set = unsafe {
        let flags = libc::fcntl(port.as_raw_fd(), libc::F_GETFL);
        flags >= 0 && libc::fcntl(port.as_raw_fd(), libc::F_SETFL, flags | libc::O_NONBLOCK) >= 0
    };
    if set { Ok(port) } else { Err(io::Error::last_os_error()) }
}
