use super::Speaker;
use super::journal::{self, Journal};
use super::line::Line;
use std::io::Write;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread;
use std::time::{Duration, Instant};

/// Lines that may wait.
const DEPTH: usize = 256;
/// How long the end of a process waits for them.
const PATIENCE: Duration = Duration::from_secs(1);

/// Where lines go.
#[derive(Debug)]
pub enum Sink {
    Stderr { colour: bool },
    Journal(Journal),
}

enum Item {
    Line(Line, Arc<Speaker>),
    /// Everything before has been written when the answer comes.
    Flush(SyncSender<()>),
}

/// The way to the thread that writes.
#[derive(Debug)]
pub struct Outlet {
    sender: SyncSender<Item>,
    dropped: Arc<AtomicU64>,
}

impl Outlet {
    /// Starts the thread. Where the operating system gives none, every line is dropped.
    pub fn start(sink: Sink) -> Self {
        Self::with(move |line, speaker| sink.write(line, speaker))
    }

    /// With any way to write a line.
    pub fn with(write: impl Fn(&Line, &Speaker) + Send + 'static) -> Self {
        let (sender, items) = sync_channel(DEPTH);
        let dropped = Arc::new(AtomicU64::new(0));
        let counted = Arc::clone(&dropped);
        // a process without room for a thread has other troubles, and its stage will say so
        let _ = thread::Builder::new().name("log".into()).spawn(move || work(&items, &counted, write));
        Self { sender, dropped }
    }

    /// Passes a line on; one that finds no room is dropped and counted.
    pub fn give(&self, line: Line, speaker: &Arc<Speaker>) {
        if self.sender.try_send(Item::Line(line, Arc::clone(speaker))).is_err() {
            self.dropped.fetch_add(1, Ordering::Relaxed);
        }
    }

    /// Waits for what is under way, but not for ever.
    pub fn flush(&self) {
        let until = Instant::now() + PATIENCE;
        let (answer, answered) = sync_channel(1);
        while self.sender.try_send(Item::Flush(answer.clone())).is_err() {
            if Instant::now() > until {
                return;
            }
            thread::sleep(Duration::from_millis(1));
        }
        // a sink that is stuck loses what it has not taken
        let _ = answered.recv_timeout(until.saturating_duration_since(Instant::now()));
    }
}

fn work(items: &Receiver<Item>, dropped: &AtomicU64, write: impl Fn(&Line, &Speaker)) {
    let mut speaker = None;
    for item in items {
        match item {
            Item::Line(line, from) => {
                write(&line, &from);
                speaker = Some(from);
            }
            Item::Flush(answer) => {
                // who asked may have lost patience
                let _ = answer.send(());
            }
        }
        if let Some(speaker) = &speaker
            && let lines @ 1.. = dropped.swap(0, Ordering::Relaxed)
        {
            write(&Line::dropped(lines), speaker);
        }
    }
}

impl Sink {
    fn write(&self, line: &Line, speaker: &Speaker) {
        match self {
            Self::Stderr { colour } => to_stderr(&line.text(speaker, *colour)),
            Self::Journal(journal) => {
                if journal.send(&journal::entry(line, speaker)).is_err() {
                    to_stderr(&line.text(speaker, false));
                }
            }
        }
    }
}

/// In one piece, since other processes write there too. A log on a disk that is full must end nobody.
fn to_stderr(text: &str) {
    let _ = std::io::stderr().write_all(text.as_bytes());
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use std::sync::Mutex;

    #[test]
    fn a_sink_that_is_stuck_holds_up_nobody_and_what_it_lost_is_told() {
        let (written, open) = (Arc::new(Mutex::new(Vec::new())), Arc::new(Mutex::new(())));
        let stuck = open.lock().unwrap();
        let (kept, gate) = (Arc::clone(&written), Arc::clone(&open));
        let outlet = Outlet::with(move |line: &Line, speaker: &Speaker| {
            drop(gate.lock().unwrap());
            kept.lock().unwrap().push(line.text(speaker, false));
        });
        let speaker = Arc::new(Speaker { stage: "estimate".into(), area: None });
        let before = Instant::now();
        (0..2 * DEPTH as u64).for_each(|_| outlet.give(Line::dropped(0), &speaker));
        assert!(before.elapsed() < Duration::from_secs(1), "{:?}", before.elapsed());
        drop(stuck);
        // the line that the thread holds already makes room for one more
        let until = Instant::now() + Duration::from_secs(20);
        while written.lock().unwrap().len() < DEPTH + 1 {
            assert!(Instant::now() < until, "{} lines", written.lock().unwrap().len());
            thread::sleep(Duration::from_millis(1));
        }
        outlet.flush();
        let told: u64 = written
            .lock()
            .unwrap()
            .iter()
            .filter_map(|line| line.split_once("lines=")?.1.trim().parse::<u64>().ok())
            .sum();
        let whole = written.lock().unwrap().iter().filter(|line| line.ends_with("lines=0\n")).count() as u64;
        assert_eq!(whole + told, 2 * DEPTH as u64);
    }
}
