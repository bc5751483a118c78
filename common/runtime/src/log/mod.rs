//! Where the events of `tracing` go: to the error output or to the journal of systemd, and never at the cost of who speaks.
//!
//! Whoever speaks makes a line of the event and hands it to a thread of its own; one that finds no room is dropped and counted, so a
//! terminal that has been stopped or a journal that waits for its disk holds up no stage. That is also why the journal is spoken to here
//! by its own protocol, which is a few lines.

mod fields;
mod journal;
mod line;
mod outlet;
mod subscriber;

use journal::Journal;
use outlet::{Outlet, Sink};
use std::io::IsTerminal;
use std::path::Path;
use std::sync::Arc;
use subscriber::Subscriber;
use tracing::level_filters::LevelFilter;

/// What is told at least.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    /// What ends a stage or loses a recording.
    Error,
    /// What somebody should look at.
    Warn,
    /// What changes in a run.
    Info,
    /// What comes again and again in a sound run.
    Debug,
}

/// Where it is told.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum To {
    /// A line an event on the error output.
    Stderr,
    /// The journal of systemd; the error output where there is none.
    Journal,
}

/// What is logged by this process, and where.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Settings {
    /// Events below it are not even looked at.
    pub level: Level,
    /// Their destination.
    pub to: To,
    /// Who speaks.
    pub speaker: Speaker,
}

/// The process that speaks: each line says it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Speaker {
    /// Name of the stage.
    pub stage: String,
    /// Name of its area, if it serves one.
    pub area: Option<String>,
}

/// The log of this process; dropped, it waits for a second at most until everything has been written.
#[derive(Debug)]
#[must_use = "what is still under way is lost without it"]
pub struct Log {
    outlet: Arc<Outlet>,
}

impl Drop for Log {
    fn drop(&mut self) {
        self.outlet.flush();
    }
}

impl Log {
    /// Starts to log. A process has one log: that which was started first.
    pub fn start(settings: Settings) -> Self {
        Self::with(settings, Path::new(journal::SOCKET))
    }

    fn with(settings: Settings, socket: &Path) -> Self {
        let colour = std::io::stderr().is_terminal();
        let opened = match settings.to {
            To::Stderr => Ok(Sink::Stderr { colour }),
            To::Journal => Journal::open(socket).map(Sink::Journal),
        };
        let (sink, missing) = opened.map_or_else(|reason| (Sink::Stderr { colour }, Some(reason)), |sink| (sink, None));
        let outlet = Arc::new(Outlet::start(sink));
        let subscriber = Subscriber::new(settings.level.filter(), settings.speaker, Arc::clone(&outlet));
        // what was started first remains
        let _ = tracing::subscriber::set_global_default(subscriber);
        if let Some(reason) = missing {
            tracing::warn!(socket = %socket.display(), %reason, "there is no journal here: the log goes to the error output");
        }
        Self { outlet }
    }
}

impl Level {
    fn filter(self) -> LevelFilter {
        match self {
            Self::Error => LevelFilter::ERROR,
            Self::Warn => LevelFilter::WARN,
            Self::Info => LevelFilter::INFO,
            Self::Debug => LevelFilter::DEBUG,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Mutex;
    use tracing::{debug, error, info, warn};

    /// The words that get through at a level.
    fn heard(level: Level) -> Vec<String> {
        let heard = Arc::new(Mutex::new(Vec::new()));
        let kept = Arc::clone(&heard);
        let outlet = Arc::new(Outlet::with(move |line, speaker| {
            kept.lock().unwrap_or_else(|e| e.into_inner()).push(line.text(speaker, false));
        }));
        let speaker = Speaker { stage: "estimate".into(), area: Some("radar".into()) };
        let subscriber = Subscriber::new(level.filter(), speaker, Arc::clone(&outlet));
        tracing::subscriber::with_default(subscriber, || {
            debug!(restarts = 1, "recurs");
            info!(after_s = 2.0 / 3.0, "changes");
            warn!(reason = %"no such file", lost = Some(3u64), missing = None::<u64>, "look");
            error!(sound = false, "ends");
            drop(tracing::error_span!("a span is no event").entered());
        });
        outlet.flush();
        let lines = std::mem::take(&mut *heard.lock().unwrap_or_else(|e| e.into_inner()));
        lines.iter().filter_map(|line| line.split_once("Z ").map(|(_, rest)| rest.trim_end().to_owned())).collect()
    }

    #[test]
    fn what_is_below_the_level_is_not_told() {
        let all = [
            "DEBUG estimate/radar: recurs  restarts=1",
            "INFO  estimate/radar: changes  after_s=0.666667",
            "WARN  estimate/radar: look  reason=\"no such file\"  lost=3",
            "ERROR estimate/radar: ends  sound=false",
        ];
        for (level, from) in [(Level::Debug, 0), (Level::Info, 1), (Level::Warn, 2), (Level::Error, 3)] {
            assert_eq!(heard(level), all[from..], "{level:?}");
        }
    }
}
