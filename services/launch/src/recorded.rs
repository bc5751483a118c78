//! A latency of the launch, whole and by the intervals of its log.

use crate::LaunchError;
use runtime::{IntervalLog, Latency, TransportError};
use std::fs::File;
use std::io::BufWriter;
use std::path::Path;
use std::time::{Duration, Instant, SystemTime};

/// Length of an interval of the latency logs.
const LOG_INTERVAL: Duration = Duration::from_secs(10);

/// A latency, whole and by intervals.
pub struct Recorded {
    pub whole: Latency,
    log: Option<(IntervalLog<BufWriter<File>>, Latency, Instant, Instant)>,
}

impl Recorded {
    /// A latency that is also logged if there is a folder for it.
    pub fn new(folder: Option<&Path>, name: &str) -> Result<Self, LaunchError> {
        let log = match folder {
            None => None,
            Some(folder) => {
                let path = folder.join(format!("{name}.hlog"));
                let file = File::create(&path).map_err(LaunchError::output(&path))?;
                let log = IntervalLog::begin(
                    BufWriter::new(file),
                    SystemTime::now(),
                    &format!("deckflex {name}, nanoseconds"),
                )?;
                let now = Instant::now();
                Some((log, Latency::new(), now, now))
            }
        };
        Ok(Self { whole: Latency::new(), log })
    }

    /// Records the time between two instants, unless one of them is unknown.
    pub fn record(&mut self, from_ns: i64, to_ns: i64) -> Result<(), TransportError> {
        if from_ns == 0 || to_ns == 0 {
            return Ok(());
        }
        self.whole.record(to_ns - from_ns);
        if let Some((_, interval, _, since)) = &mut self.log {
            interval.record(to_ns - from_ns);
            if since.elapsed() >= LOG_INTERVAL {
                return self.rotate();
            }
        }
        Ok(())
    }

    fn rotate(&mut self) -> Result<(), TransportError> {
        if let Some((log, interval, start, since)) = &mut self.log {
            log.write("latency", since.duration_since(*start), since.elapsed(), interval)?;
            interval.clear();
            *since = Instant::now();
        }
        Ok(())
    }

    /// Closes the log.
    pub fn finish(&mut self) -> Result<(), TransportError> {
        self.rotate()?;
        if let Some((log, ..)) = self.log.take() {
            log.finish()?;
        }
        Ok(())
    }
}
