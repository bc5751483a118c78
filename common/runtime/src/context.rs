use crate::scheduling::{self, Request};
use crate::{Area, Connection, Domain, Stop, TransportError, die_with_parent};
use messages::{Scheduling, Stage};
use std::path::PathBuf;

/// What the launcher tells each of its stages.
#[derive(Clone, Debug)]
pub struct Context {
    /// The domain's root.
    pub domain: PathBuf,
    /// Which run this is; kept over restarts.
    pub run_id: u64,
    /// When the run's first sample was or is due, ns of the monotonic clock; kept over restarts.
    pub epoch_ns: i64,
    /// Whether the stage takes the place of one that died: a source then goes on at the present instead of catching up.
    pub resume: bool,
    /// The scheduling class of the fast stages.
    pub scheduling: Request,
}

/// Real-time priority of the fast stages; below the kernel's own threads.
const PRIORITY: i32 = 40;

impl Context {
    /// Makes this process a stage: signals, the launcher's death, the transport, and the scheduling class last, since what has
    /// gone before allocates and waits.
    ///
    /// # Errors
    /// The transport or the operating system refuses.
    pub fn connect(&self, stage: Stage, area: Option<Area<'_>>) -> Result<(Stop, Connection), TransportError> {
        let stop = Stop::install()?;
        die_with_parent()?;
        let domain = Domain::open(&self.domain)?;
        let mut connection = Connection::open(&domain, stage, area, self.run_id)?;
        let obtained = match stage {
            Stage::Identify => scheduling::lower(),
            // nobody waits for it, and it must not fall behind for seconds
            Stage::Record => Scheduling::Normal,
            _ => scheduling::apply(self.scheduling, PRIORITY),
        };
        connection.beat.health.scheduling = obtained as u32;
        Ok((stop, connection))
    }
}
