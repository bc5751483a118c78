//! One thread a port: it does nothing but read and note when.

use crate::AcquireError;
use crate::keeper::Keeper;
use crate::piece::Piece;
use crossbeam::channel::Sender;
use pipeline::configuration::{Line, Port};
use runtime::line::{self, LineError};
use runtime::{Context, monotonic_ns, scheduling, sleep_until};
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, OnceLock};
use std::thread::JoinHandle;

/// What a reader tells.
#[allow(clippy::large_enum_variant)] // a box would be an allocation for every piece
pub enum News {
    Bytes(Piece),
    /// The port cannot be opened, or has broken off.
    Fault {
        unit: usize,
        reason: String,
        /// Waiting will hardly help.
        lasting: bool,
    },
    /// The file of raw bytes has come to its end.
    Ended {
        unit: usize,
    },
}

/// What a reader counts.
#[derive(Debug, Default)]
pub struct Counts {
    /// Pieces dropped because the stage did not keep up.
    pub overflow: AtomicU64,
    /// Pieces that could not be kept.
    pub unkept: AtomicU64,
    /// How often the port was opened.
    pub opened: AtomicU64,
}

/// A reader's thread, and what it shares with the stage.
pub struct Reader {
    pub counts: Arc<Counts>,
    over: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

/// Above the stages: when bytes came is only known if they are taken at once.
const PRIORITY: i32 = 41;
/// The longest datagram.
const DATAGRAM: usize = 65_536;

/// What all readers share.
#[derive(Clone)]
pub struct Common {
    pub news: Sender<News>,
    /// From the times of kept bytes to present ones, ns: the same for all files, which are of one run.
    pub shift_ns: Arc<OnceLock<i64>>,
}

struct Work {
    unit: usize,
    common: Common,
    counts: Arc<Counts>,
    over: Arc<AtomicBool>,
    keeper: Option<Keeper>,
}

impl Reader {
    /// Starts to read; a stage that takes another one's place goes on with its file of raw bytes.
    ///
    /// # Errors
    /// A file of raw bytes cannot be read or made, or the operating system gives no thread.
    pub fn start(unit: usize, told: &Line, common: Common, context: &Context) -> Result<Self, AcquireError> {
        let resume = context.resume;
        let (counts, over) = (Arc::new(Counts::default()), Arc::new(AtomicBool::new(false)));
        let keeper = told.raw.as_deref().map(|path| Keeper::start(path, resume, Arc::clone(&counts))).transpose()?;
        let work = Work { unit, common, counts: Arc::clone(&counts), over: Arc::clone(&over), keeper };
        let run: Box<dyn FnOnce() + Send> = match &told.port {
            Port::File(path) => {
                let contents = std::fs::read(path).map_err(|error| raw(path, &error))?;
                if wire::raw::pieces(&contents).is_none() {
                    return Err(raw(path, &"it is no file of raw bytes"));
                }
                Box::new(move || work.replay(&contents))
            }
            port => {
                let line = line::Line::new(port.clone());
                Box::new(move || work.read(line))
            }
        };
        let class = context.scheduling;
        let run = move || {
            scheduling::apply(class, PRIORITY);
            run();
        };
        let thread = std::thread::Builder::new().name(format!("reader {unit}")).spawn(run);
        let thread = thread.map_err(|source| runtime::TransportError::System { call: "starting a thread", source })?;
        Ok(Self { counts, over, thread: Some(thread) })
    }
}

impl Drop for Reader {
    fn drop(&mut self) {
        self.over.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            // a reader that panicked has said so itself
            let _ = thread.join();
        }
    }
}

pub(crate) fn raw(path: &Path, reason: &dyn std::fmt::Display) -> AcquireError {
    AcquireError::Raw { path: path.to_owned(), reason: reason.to_string() }
}

impl Work {
    fn is_over(&self) -> bool {
        self.over.load(Ordering::Relaxed)
    }

    fn read(self, mut line: line::Line) {
        let mut buffer = vec![0; DATAGRAM];
        let mut told = None;
        while !self.is_over() {
            let count = line.read(&mut buffer);
            let arrival_ns = monotonic_ns();
            self.hand_on(arrival_ns, &buffer[..count]);
            self.counts.opened.store(line.opened(), Ordering::Relaxed);
            let fault = line.fault().map(ToString::to_string);
            if fault != told {
                if let (Some(reason), Some(error)) = (&fault, line.fault()) {
                    self.fault(reason, error);
                }
                told = fault;
            }
        }
    }

    fn fault(&self, reason: &str, error: &LineError) {
        let news = News::Fault { unit: self.unit, reason: reason.to_owned(), lasting: error.is_lasting() };
        // a stage that does not even take this has other troubles
        let _ = self.common.news.try_send(news);
    }

    /// At the pace of the arrivals, which become present ones.
    fn replay(self, contents: &[u8]) {
        for (arrival_ns, bytes) in wire::raw::pieces(contents).into_iter().flatten() {
            let shift_ns = *self.common.shift_ns.get_or_init(|| monotonic_ns() - arrival_ns);
            while !self.is_over() && monotonic_ns() < arrival_ns + shift_ns {
                // a signal may wake it early
                sleep_until((arrival_ns + shift_ns).min(monotonic_ns() + 100_000_000));
            }
            if self.is_over() {
                return;
            }
            self.hand_on(arrival_ns + shift_ns, bytes);
        }
        let _ = self.common.news.send(News::Ended { unit: self.unit });
    }

    fn hand_on(&self, arrival_ns: i64, bytes: &[u8]) {
        for piece in Piece::all(self.unit, arrival_ns, bytes) {
            if let Some(keeper) = &self.keeper {
                keeper.keep(piece);
            }
            if self.common.news.try_send(News::Bytes(piece)).is_err() {
                self.counts.overflow.fetch_add(1, Ordering::Relaxed);
            }
        }
    }
}
