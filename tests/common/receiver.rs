//! Receivers of telegrams: a socket and a pseudo-terminal, and the binary by its published offsets.

use std::fs::File;
use std::io::Read;
use std::net::UdpSocket;
use std::os::fd::FromRawFd;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::thread::{self, JoinHandle};
use std::time::Duration;

/// Collects datagrams until it is asked for them.
pub struct Receiver {
    pub port: u16,
    over: Arc<AtomicBool>,
    received: Arc<Mutex<Vec<Vec<u8>>>>,
    thread: JoinHandle<()>,
}

impl Receiver {
    pub fn start() -> Self {
        let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
        socket.set_read_timeout(Some(Duration::from_millis(100))).unwrap();
        let port = socket.local_addr().unwrap().port();
        let over = Arc::new(AtomicBool::new(false));
        let received = Arc::new(Mutex::new(Vec::new()));
        let (until, into) = (Arc::clone(&over), Arc::clone(&received));
        let thread = thread::spawn(move || {
            let mut buffer = [0; 2048];
            while !until.load(Ordering::Relaxed) {
                if let Ok(length) = socket.recv(&mut buffer) {
                    into.lock().unwrap().push(buffer[..length].to_vec());
                }
            }
        });
        Self { port, over, received, thread }
    }

    /// The telegrams of the binary so far.
    pub fn binary(&self) -> Vec<Binary> {
        self.received.lock().unwrap().iter().map(|bytes| Binary::read(bytes)).collect()
    }

    /// All datagrams.
    pub fn end(self) -> Vec<Vec<u8>> {
        self.over.store(true, Ordering::Relaxed);
        self.thread.join().unwrap();
        Arc::try_unwrap(self.received).unwrap().into_inner().unwrap()
    }
}

/// Kongsberg's binary.
#[derive(Clone, Copy, Debug)]
pub struct Binary {
    pub utc_ns: i64,
    pub status: u32,
    /// Roll, pitch, heading, degrees.
    pub angles: [f32; 3],
}

impl Binary {
    pub fn read(bytes: &[u8]) -> Self {
        assert_eq!((bytes.len(), &bytes[..8]), (132, &b"#KMB\x84\x00\x01\x00"[..]));
        let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap());
        Self {
            utc_ns: i64::from(word(8)) * 1_000_000_000 + i64::from(word(12)),
            status: word(16),
            angles: [40, 44, 48].map(|at| f32::from_bits(word(at))),
        }
    }

    pub fn is_valid(&self) -> bool {
        self.status & 0b110 == 0
    }
}

/// A serial line: what is written to `device` can be read from `other_end`.
pub struct SerialLine {
    pub device: PathBuf,
    other_end: File,
    _device_end: File,
}

impl SerialLine {
    pub fn new() -> Self {
        let (mut other, mut device, mut name) = (0, 0, [0 as libc::c_char; 128]);
        // SAFETY: the pointers are valid, and the name of a pseudo-terminal is far shorter than its place.
        let made = unsafe {
            let made = libc::openpty(&mut other, &mut device, name.as_mut_ptr(), std::ptr::null(), std::ptr::null());
            libc::fcntl(other, libc::F_SETFL, libc::O_NONBLOCK);
            made
        };
        assert_eq!(made, 0);
        let name: String = name.iter().take_while(|c| **c != 0).map(|c| char::from(*c as u8)).collect();
        // SAFETY: the call above has opened both, and nobody else owns them.
        let (other_end, _device_end) = unsafe { (File::from_raw_fd(other), File::from_raw_fd(device)) };
        Self { device: name.into(), other_end, _device_end }
    }

    /// What has come and not been read yet.
    pub fn read(&mut self) -> String {
        let mut bytes = Vec::new();
        let mut buffer = [0; 4096];
        while let Ok(length @ 1..) = self.other_end.read(&mut buffer) {
            bytes.extend_from_slice(&buffer[..length]);
        }
        String::from_utf8(bytes).unwrap()
    }
}
