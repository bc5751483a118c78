//! Keeps the bytes of a stream in a file, in a thread of its own: a slow disk holds up nobody.

use crate::AcquireError;
use crate::piece::Piece;
use crate::reader::{Counts, raw};
use crossbeam::channel::{Receiver, RecvTimeoutError, Sender, bounded};
use runtime::scheduling;
use std::fs::{File, OpenOptions};
use std::io::Write;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::thread::JoinHandle;
use std::time::Duration;

/// Pieces that may wait for the disk: 20 s at 200 Hz.
const DEPTH: usize = 4096;
/// What has come is written at least so often.
const PERIOD: Duration = Duration::from_millis(500);
const BLOCK: usize = 1 << 16;

/// The way to the thread that writes.
pub struct Keeper {
    pieces: Option<Sender<Piece>>,
    counts: Arc<Counts>,
    thread: Option<JoinHandle<()>>,
}

impl Keeper {
    /// Makes the file, or with `resume` goes on with it.
    ///
    /// # Errors
    /// The file cannot be written, or the operating system gives no thread.
    pub fn start(path: &Path, resume: bool, counts: Arc<Counts>) -> Result<Self, AcquireError> {
        let mut options = OpenOptions::new();
        let options = if resume { options.append(true) } else { options.write(true).truncate(true) };
        let mut file = options.create(true).open(path).map_err(|error| raw(path, &error))?;
        if file.metadata().map_err(|error| raw(path, &error))?.len() == 0 {
            file.write_all(&wire::raw::MAGIC).map_err(|error| raw(path, &error))?;
        }
        let (pieces, taken) = bounded(DEPTH);
        let shared = Arc::clone(&counts);
        let thread = std::thread::Builder::new().name("keeper".into()).spawn(move || keep(&taken, file, &shared));
        let thread = thread.map_err(|source| runtime::TransportError::System { call: "starting a thread", source })?;
        Ok(Self { pieces: Some(pieces), counts, thread: Some(thread) })
    }

    /// Hands a piece over; one that finds no place is counted.
    pub fn keep(&self, piece: Piece) {
        if self.pieces.as_ref().is_none_or(|pieces| pieces.try_send(piece).is_err()) {
            self.counts.unkept.fetch_add(1, Ordering::Relaxed);
        }
    }
}

impl Drop for Keeper {
    fn drop(&mut self) {
        self.pieces = None;
        if let Some(thread) = self.thread.take() {
            // a thread that panicked has said so itself
            let _ = thread.join();
        }
    }
}

fn keep(pieces: &Receiver<Piece>, mut file: File, counts: &Counts) {
    scheduling::lower();
    let (mut block, mut waiting) = (Vec::with_capacity(2 * BLOCK), 0);
    loop {
        let news = pieces.recv_timeout(PERIOD);
        if let Ok(piece) = &news {
            wire::raw::append(&mut block, piece.arrival_ns, piece.bytes());
            waiting += 1;
        }
        if block.len() >= BLOCK || (news.is_err() && !block.is_empty()) {
            if file.write_all(&block).is_err() {
                counts.unkept.fetch_add(waiting, Ordering::Relaxed);
            }
            block.clear();
            waiting = 0;
        }
        if matches!(news, Err(RecvTimeoutError::Disconnected)) {
            return;
        }
    }
}
