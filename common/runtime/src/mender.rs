use crate::TransportError;
use crate::domain::shared_memory;
use std::fs::OpenOptions;
use std::io;
use std::os::fd::AsRawFd;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};
use std::time::Duration;

/// Whoever meets a segment without a size waits twice as long at most: a living maker is given one period.
const PERIOD: Duration = Duration::from_millis(100);
const PAGE: libc::off_t = 4096;

/// Gives a size to shared memory whose maker was killed before it could.
///
/// Who opens a segment waits until it has a size, and as root the transport waits for ever (others may not open it before it is
/// finished, and that it gives up): a single kill within these few microseconds hangs the successor of the dead process, and whoever
/// else cleans up after it. A segment that has a size and is not finished is given up in any case.
#[derive(Debug)]
pub(crate) struct Mender {
    over: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl Mender {
    /// Watches the files in shared memory whose names begin with the prefix, until it is dropped.
    pub(crate) fn start(prefix: String) -> Result<Self, TransportError> {
        let over = Arc::new(AtomicBool::new(false));
        let watch = {
            let over = Arc::clone(&over);
            move || {
                let mut before = Vec::new();
                while !over.load(Ordering::Relaxed) {
                    before = mend(&prefix, &before);
                    thread::park_timeout(PERIOD);
                }
            }
        };
        let thread = thread::Builder::new().name("mender".into()).spawn(watch);
        let thread = thread.map_err(|source| TransportError::System { call: "starting a thread", source })?;
        Ok(Self { over, thread: Some(thread) })
    }
}

impl Drop for Mender {
    fn drop(&mut self) {
        self.over.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            thread.thread().unpark();
            // it holds nothing that a panic could have spoilt
            let _ = thread.join();
        }
    }
}

/// Mends the segments that had no size before either, and gives those that have none.
fn mend(prefix: &str, before: &[PathBuf]) -> Vec<PathBuf> {
    let mut unfinished = shared_memory(prefix);
    unfinished.retain(|path| path.metadata().is_ok_and(|data| data.len() == 0));
    for path in unfinished.iter().filter(|path| before.contains(path)) {
        match grow(path) {
            Ok(()) => {
                tracing::warn!(file = %path.display(), "mended what a process has left half made in shared memory")
            }
            // removed meanwhile, which is as good
            Err(error) if error.kind() == io::ErrorKind::NotFound => {}
            Err(error) => {
                tracing::warn!(file = %path.display(), %error, "cannot mend what a process has left half made")
            }
        }
    }
    unfinished
}

/// Makes a file a page long unless it is longer. Its maker, if it lives after all, sets the size that it wants after this.
fn grow(path: &Path) -> io::Result<()> {
    let file = OpenOptions::new().write(true).open(path)?;
    // SAFETY: the descriptor is open; the call never makes a file smaller, and never changes what it holds.
    match unsafe { libc::posix_fallocate(file.as_raw_fd(), 0, PAGE) } {
        0 => Ok(()),
        error => Err(io::Error::from_raw_os_error(error)),
    }
}
