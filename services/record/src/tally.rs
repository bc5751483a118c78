use messages::Health;
use std::sync::atomic::{AtomicU64, Ordering};

/// What became of the messages, counted by both threads.
#[derive(Debug, Default)]
pub struct Tally {
    taken: AtomicU64,
    lost: AtomicU64,
    written: AtomicU64,
    /// There was no room in the channel.
    overflow: AtomicU64,
    /// The disk did not take them.
    refused: AtomicU64,
    /// Files that have been begun.
    files: AtomicU64,
}

impl Tally {
    pub fn take(&self) {
        self.taken.fetch_add(1, Ordering::Relaxed);
    }

    pub fn drop_one(&self) {
        self.overflow.fetch_add(1, Ordering::Relaxed);
    }

    pub fn refuse(&self, messages: u64) {
        self.refused.fetch_add(messages, Ordering::Relaxed);
    }

    pub fn write(&self, messages: u64) {
        self.written.fetch_add(messages, Ordering::Relaxed);
    }

    pub fn begin_file(&self) {
        self.files.fetch_add(1, Ordering::Relaxed);
    }

    pub fn files(&self) -> u64 {
        self.files.load(Ordering::Relaxed)
    }

    /// Messages that never came, by gaps in their numbers.
    pub fn lose(&self, messages: u64) {
        self.lost.fetch_add(messages, Ordering::Relaxed);
    }

    pub fn lost(&self) -> u64 {
        self.lost.load(Ordering::Relaxed)
    }

    /// Messages that are in no file, for want of room on the way or on the disk.
    pub fn dropped(&self) -> u64 {
        self.overflow.load(Ordering::Relaxed) + self.refused.load(Ordering::Relaxed)
    }

    pub fn tell(&self, health: &mut Health) {
        health.taken = self.taken.load(Ordering::Relaxed);
        health.given = self.written.load(Ordering::Relaxed);
        health.lost = self.lost();
        health.overflow = self.dropped();
    }
}
