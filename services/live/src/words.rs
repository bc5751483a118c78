//! What the server says about itself, in our words.

use crate::Say;
use log::{Level, LevelFilter, Log, Metadata, Record};
use std::sync::atomic::{AtomicU64, Ordering};

/// Of the server's own lines those that matter.
pub struct Words {
    say: Say,
    full: AtomicU64,
}

impl Words {
    /// From now on for this process, once.
    pub fn install(say: Say) -> &'static Self {
        let words: &'static Self = Box::leak(Box::new(Self { say, full: AtomicU64::new(0) }));
        // whoever has set another one wants the lines there
        if log::set_logger(words).is_ok() {
            log::set_max_level(LevelFilter::Info);
        }
        words
    }

    pub fn full(&self) -> u64 {
        self.full.load(Ordering::Relaxed)
    }
}

impl Log for Words {
    fn enabled(&self, metadata: &Metadata) -> bool {
        metadata.target().starts_with("foxglove")
    }

    fn log(&self, record: &Record) {
        if !self.enabled(record.metadata()) {
            return;
        }
        // the only place where the library tells that it drops, once in 30 s
        if record.target().ends_with("send_lossy") {
            self.full.fetch_add(1, Ordering::Relaxed);
            (self.say)("a viewer does not keep up: its oldest messages are dropped");
        } else if record.level() <= Level::Warn {
            (self.say)(&record.args().to_string());
        }
    }

    fn flush(&self) {}
}
