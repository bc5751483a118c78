//! `deckflex record`: everything that the stages exchange, into files.
//!
//! The process's main thread drains the ports; a second thread has the disk. Between them is a bounded channel whose overflow is
//! counted, so that a disk that is slow, full or gone costs messages of the recording and nothing else.

mod disk;
mod inputs;
mod names;
mod tally;
mod wishes;

use crossbeam::channel::{Sender, TrySendError, bounded};
use disk::{Disk, Plan};
use inputs::Inputs;
use messages::Stage;
use pipeline::configuration::{Configuration, ConfigurationError};
use recording::{About, Record};
use runtime::{Context, TransportError, monotonic_ns};
use std::sync::Arc;
use std::thread;
use std::time::{Duration, SystemTime};
use tally::Tally;
use wishes::Wishes;

/// How long the recorder leaves the ports alone; they hold 20 s.
const NAP: Duration = Duration::from_millis(20);
/// Messages that may wait for the disk: 20 s of one area at 100 Hz.
const BACKLOG: usize = 16_384;
/// Once the streams have ended, the identifiers' last sets are waited for so long, ns.
const LAST_SETS_NS: i64 = 1_000_000_000;

/// Why a recorder stopped.
#[derive(Debug, thiserror::Error)]
pub enum RecordError {
    /// The transport or the operating system refuses.
    #[error(transparent)]
    Transport(#[from] TransportError),
    /// The configuration's text cannot be read.
    #[error(transparent)]
    Configuration(#[from] ConfigurationError),
    /// Nothing says where to record.
    #[error("there is no [record] table and no --folder: nothing says where to record")]
    Nowhere,
}

/// Something for the disk.
// boxed, each message would be allocated by one thread and freed by another
#[allow(clippy::large_enum_variant)]
enum Item {
    /// A message of a topic, by its place in the list of topics, and its time since 1970.
    Message { topic: usize, time_ns: u64, record: Record },
    /// Whatever the messages so far came of is there too: the place for a cut.
    Mark,
}

/// Runs the stage until the streams end or a signal comes.
///
/// # Errors
/// The transport or the operating system refuses, or nothing says where to record. A disk that cannot be written is no error: what
/// could not be recorded is counted and said.
pub fn run(configuration: &Configuration, context: &Context) -> Result<(), RecordError> {
    let settings = configuration.record.clone().ok_or(RecordError::Nowhere)?;
    let about = About {
        version: env!("CARGO_PKG_VERSION").to_owned(),
        run_id: context.run_id,
        part: 0,
        from_the_start: !context.resume,
        path: configuration.path.display().to_string(),
        configuration: Configuration::text(&configuration.path)?,
    };
    let (stop, mut connection) = context.connect(Stage::Record, None)?;
    runtime::fail_beyond_file_limit()?;
    let mut inputs = Inputs::open(&connection.node, configuration, &settings.topics)?;
    let mut wishes = Wishes::open(&connection.node, configuration, &settings.topics)?;
    let tally = Arc::new(Tally::default());
    let (to_disk, items) = bounded(BACKLOG);
    // the number of a run is the instant of its launch
    let since_launch_ns = monotonic_ns().saturating_sub_unsigned(context.run_id).max(0);
    let launched = SystemTime::now() - Duration::from_nanos(since_launch_ns.unsigned_abs());
    let plan = Plan { settings, about, launched, topics: inputs.topics().to_vec() };
    let mut disk = Disk::open(plan, Arc::clone(&tally));
    let disk = thread::spawn(move || {
        disk.work(&items);
        disk
    });
    let mut outlet = Outlet { to_disk, tally: Arc::clone(&tally), since_1970_ns: since_1970_ns() };
    let beat = &mut connection.beat;
    beat.ready()?;
    let mut ended_ns = None;
    loop {
        inputs.drain(&mut outlet)?;
        wishes.tell(tally.files())?;
        let now_ns = monotonic_ns();
        if inputs.ended() {
            ended_ns.get_or_insert(now_ns);
        }
        let last_sets = |ended_ns| inputs.learnt() || now_ns - ended_ns > LAST_SETS_NS;
        let over = ended_ns.is_some_and(last_sets);
        tally.tell(&mut beat.health);
        beat.handled(inputs.last());
        if over || stop.requested() {
            break;
        }
        beat.tick(now_ns)?;
        thread::sleep(NAP);
    }
    drop(outlet);
    match disk.join() {
        Ok(mut disk) => disk.finish(ended_ns.is_some()),
        // the process must not look as if all had been well
        Err(panic) => std::panic::resume_unwind(panic),
    }
    tally.tell(&mut beat.health);
    if ended_ns.is_some() {
        beat.ended()?;
    }
    Ok(())
}

/// From the monotonic clock to the time since 1970, ns.
fn since_1970_ns() -> i64 {
    let now = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH).unwrap_or_default();
    now.as_nanos() as i64 - monotonic_ns()
}

/// The way to the disk.
struct Outlet {
    to_disk: Sender<Item>,
    tally: Arc<Tally>,
    since_1970_ns: i64,
}

impl Outlet {
    /// Passes a message on; one for which there is no room is dropped and counted.
    fn give(&self, topic: usize, record: Record) {
        let published_ns = record.published_ns().unwrap_or_else(monotonic_ns);
        let time_ns = (published_ns + self.since_1970_ns).max(0) as u64;
        self.tally.take();
        match self.to_disk.try_send(Item::Message { topic, time_ns, record }) {
            Ok(()) => {}
            Err(TrySendError::Full(_) | TrySendError::Disconnected(_)) => self.tally.drop_one(),
        }
    }

    /// Marks that whatever the messages so far came of has been passed on before.
    fn mark(&self) {
        // without room for it, the next one does
        let _ = self.to_disk.try_send(Item::Mark);
    }
}
