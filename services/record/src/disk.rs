//! The thread that has the disk: chunks, files, and what to do when it is full.

use crate::Item;
use crate::names::Names;
use crate::tally::Tally;
use crossbeam::channel::{Receiver, RecvTimeoutError};
use pipeline::configuration::RecordSettings;
use recording::{About, Ending, FormatError, Record, Writer};
use std::fs::{self, File};
use std::io::BufWriter;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant, SystemTime};

/// A disk that refused is tried again after so long.
const RETRY: Duration = Duration::from_secs(1);
/// Room for a chunk with its index, so that it goes to the disk in one piece.
const BUFFER: usize = 1 << 20;

/// What the disk thread is told.
#[derive(Debug)]
pub struct Plan {
    /// Folder and sizes.
    pub settings: RecordSettings,
    /// What the first file says about itself.
    pub about: About,
    /// When the run was launched.
    pub launched: SystemTime,
    /// The topics, in the order of their places.
    pub topics: Vec<String>,
}

/// The files of a run.
pub struct Disk {
    plan: Plan,
    names: Names,
    tally: Arc<Tally>,
    state: State,
    /// Whether it has been said that nothing can be written.
    said: bool,
    flushed: Instant,
}

enum State {
    Open(Box<Part>),
    /// Nothing can be written; when to try again.
    Refused(Instant),
}

/// The file that is being written.
struct Part {
    writer: Writer<BufWriter<File>>,
    file: File,
    path: PathBuf,
    /// Its length up to the last whole chunk.
    sound: u64,
    /// Messages up to there.
    written: u64,
    /// Messages since then.
    messages: u64,
}

impl Part {
    fn create(path: PathBuf, about: &About) -> Result<Self, FormatError> {
        // one of this name could only be a remnant without messages that could not be removed
        let file = File::create(&path).map_err(mcap_error)?;
        let same = file.try_clone().map_err(mcap_error)?;
        let begun = Writer::new(BufWriter::with_capacity(BUFFER, file), about);
        let mut part = Self { writer: begun?, file: same, path, sound: 0, written: 0, messages: 0 };
        match part.flush() {
            Ok(()) => Ok(part),
            Err(error) => {
                part.cut();
                Err(error)
            }
        }
    }

    fn flush(&mut self) -> Result<(), FormatError> {
        self.writer.flush()?;
        self.sound = self.file.metadata().map_err(mcap_error)?.len();
        Ok(())
    }

    /// Leaves the whole chunks and nothing else; without any, no file.
    fn cut(self) {
        // what the buffer still holds must not reach the file
        let _ = self.writer.abandon().into_parts();
        // a disk that refuses even this leaves a file that is cut within a chunk, which readers survive
        let _ = if self.written == 0 { fs::remove_file(&self.path) } else { self.file.set_len(self.sound) };
    }
}

fn mcap_error(error: std::io::Error) -> FormatError {
    FormatError::File(error.into())
}

impl Disk {
    /// Makes the first file. One that cannot be made is tried again later, like any other.
    pub fn open(plan: Plan, tally: Arc<Tally>) -> Self {
        let names = Names::new(&plan.settings.folder, plan.about.run_id, plan.launched);
        let (state, flushed) = (State::Refused(Instant::now()), Instant::now());
        let mut disk = Self { plan, names, tally, state, said: false, flushed };
        disk.plan.about.from_the_start &= disk.names.next() == 0;
        disk.begin();
        disk
    }

    /// Writes what comes until there is no more.
    pub fn work(&mut self, items: &Receiver<Item>) {
        let patience = Duration::from_secs_f64(self.plan.settings.flush_s);
        loop {
            match items.recv_timeout(patience) {
                Ok(Item::Message { topic, time_ns, record }) => self.write(topic, time_ns, &record),
                Ok(Item::Mark) | Err(RecvTimeoutError::Timeout) => self.mark(),
                Err(RecvTimeoutError::Disconnected) => return,
            }
        }
    }

    fn write(&mut self, topic: usize, time_ns: u64, record: &Record) {
        let State::Open(part) = &mut self.state else {
            self.tally.refuse(1);
            self.plan.about.from_the_start = false;
            return;
        };
        part.messages += 1;
        if let Err(error) = part.writer.write(&self.plan.topics[topic], time_ns, record) {
            self.give_up(&error);
        }
    }

    /// The place to end a chunk, if it is large or old enough.
    fn mark(&mut self) {
        let settings = &self.plan.settings;
        match &self.state {
            State::Refused(retry) if Instant::now() < *retry => {}
            State::Refused(_) => self.begin(),
            State::Open(part) if part.writer.held() == 0 => self.flushed = Instant::now(),
            State::Open(part) => {
                let large = part.writer.held() as f64 >= settings.chunk;
                if large || self.flushed.elapsed().as_secs_f64() >= settings.flush_s {
                    self.flush();
                }
            }
        }
    }

    fn flush(&mut self) {
        let State::Open(part) = &mut self.state else { return };
        if let Err(error) = part.flush() {
            return self.give_up(&error);
        }
        let messages = std::mem::take(&mut part.messages);
        part.written += messages;
        self.tally.write(messages);
        self.flushed = Instant::now();
        if std::mem::take(&mut self.said) {
            let (path, dropped) = (part.path.display(), self.tally.dropped());
            tracing::info!(%path, dropped, "recording goes on in another file; what was dropped is in none");
            self.tally.begin_file();
        }
        if part.sound as f64 >= self.plan.settings.rotate {
            self.close(false);
            self.begin();
        }
    }

    /// Begins the next file.
    fn begin(&mut self) {
        let path = self.names.path();
        let about = About { part: self.names.next(), ..self.plan.about.clone() };
        let begun = self.names.make_folder().map_err(mcap_error).and_then(|()| Part::create(path.clone(), &about));
        match begun {
            Ok(part) => {
                self.state = State::Open(Box::new(part));
                self.names.advance();
                // after a refusal it is a file only when the disk has taken a chunk of it
                if !self.said {
                    tracing::info!(path = %path.display(), part = about.part, "a file of the recording begins");
                    self.tally.begin_file();
                }
                self.plan.about.from_the_start = false;
                self.flushed = Instant::now();
                self.keep_budget(&path);
            }
            Err(error) => self.refused(&path, &error),
        }
    }

    /// Says once that nothing can be written, and plans another try.
    fn refused(&mut self, path: &Path, error: &FormatError) {
        self.state = State::Refused(Instant::now() + RETRY);
        if !std::mem::replace(&mut self.said, true) {
            let path = path.display();
            tracing::error!(%path, reason = %error, "cannot write: messages are dropped and counted until that has passed");
        }
    }

    /// The file cannot be written on: it keeps its whole chunks.
    fn give_up(&mut self, error: &FormatError) {
        let State::Open(part) = std::mem::replace(&mut self.state, State::Refused(Instant::now())) else { return };
        self.tally.refuse(part.messages);
        self.refused(&part.path, error);
        if part.written == 0 {
            self.names.withdraw();
        }
        part.cut();
    }

    fn close(&mut self, end_of_run: bool) {
        let retry = State::Refused(Instant::now());
        let State::Open(part) = std::mem::replace(&mut self.state, retry) else { return };
        let Part { writer, path, messages, file, sound, .. } = *part;
        let ending = Ending { end_of_run, dropped: self.tally.dropped(), lost: self.tally.lost() };
        match writer.finish(&ending).and_then(|out| out.into_inner().map_err(|error| mcap_error(error.into_error()))) {
            Ok(_) => self.tally.write(messages),
            Err(error) => {
                self.tally.refuse(messages);
                // it fails only where the file is cut within a chunk, which readers survive
                let _ = file.set_len(sound);
                tracing::error!(path = %path.display(), reason = %error, "cannot complete the file; `deckflex recover` can");
            }
        }
    }

    /// Removes the oldest files so that the run's, the new one at its full size included, keep within the budget.
    fn keep_budget(&self, current: &Path) {
        let Some(budget) = self.plan.settings.budget else { return };
        let mut files = self.names.files();
        files.retain(|(path, _)| path != current);
        let mut total: u64 = files.iter().map(|(_, size)| size).sum();
        for (path, size) in files {
            if total as f64 + self.plan.settings.rotate <= budget {
                return;
            }
            match fs::remove_file(&path) {
                Ok(()) => {
                    tracing::info!(path = %path.display(), "removed the run's oldest file to keep record.budget_mb")
                }
                Err(error) => {
                    tracing::warn!(path = %path.display(), reason = %error, "cannot remove the run's oldest file")
                }
            }
            total -= size;
        }
    }

    /// Completes the last file.
    pub fn finish(&mut self, end_of_run: bool) {
        if let State::Refused(_) = self.state {
            self.begin();
        }
        self.close(end_of_run);
    }
}

#[cfg(test)]
mod tests;
