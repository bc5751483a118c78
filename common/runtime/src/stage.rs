use crate::growth::Growth;
use crate::{Domain, Node, Publisher, TransportError, monotonic_ns};
use messages::{Header, Health, Scheduling, Stage, State, topic};

const PERIOD_NS: i64 = 1_000_000_000;

/// The area that a stage serves.
#[derive(Clone, Copy, Debug)]
pub struct Area<'a> {
    /// Its place in the configuration.
    pub index: u32,
    /// Its name, part of its topics' names.
    pub name: &'a str,
}

/// What every stage has of the transport before it opens its own topics.
#[derive(Debug)]
pub struct Connection {
    /// On which the stage opens its topics.
    pub node: Node,
    /// With which it tells how it does.
    pub beat: Beat,
}

impl Connection {
    /// Connects a stage to its domain; `area` is `None` for the sources, which serve all. Says nothing yet, see [`Beat::ready`].
    ///
    /// # Errors
    /// As [`Node::open`] and [`Publisher::open`]; the latter also if the same stage of the same area runs already.
    pub fn open(domain: &Domain, stage: Stage, area: Option<Area<'_>>, run_id: u64) -> Result<Self, TransportError> {
        let name = match area {
            Some(area) => format!("{}/{}", stage.name(), area.name),
            None => stage.name().to_owned(),
        };
        let node = Node::open(domain, &name)?;
        let beat = Beat::open(&node, stage, area, run_id)?;
        Ok(Self { node, beat })
    }
}

/// A stage's health: published when the stage is ready, once a second, and when it ends.
#[derive(Debug)]
pub struct Beat {
    /// The stage counts here.
    pub health: Health,
    publisher: Publisher<Health>,
    last_ns: i64,
    growth: Growth<7>,
}

impl Beat {
    fn open(node: &Node, stage: Stage, area: Option<Area<'_>>, run_id: u64) -> Result<Self, TransportError> {
        let publisher = Publisher::open(node, &topic::health(stage, area.map(|area| area.name)))?;
        let health = Health {
            header: Header { run_id, ..Header::default() },
            stage: stage as u32,
            area: area.map_or(u32::MAX, |area| area.index),
            state: State::Ready as u32,
            pid: std::process::id(),
            ..Health::default()
        };
        Ok(Self { health, publisher, last_ns: monotonic_ns(), growth: Growth::default() })
    }

    /// Notes the main sample that was handled last: its number, its time and the clock of that time.
    pub fn handled(&mut self, header: &Header) {
        self.health.header.sequence = header.sequence;
        self.health.header.time_ns = header.time_ns;
        self.health.header.clock_domain = header.clock_domain;
    }

    /// Publishes that the stage is connected and waits for data.
    ///
    /// # Errors
    /// As [`Publisher::publish`].
    pub fn ready(&mut self) -> Result<(), TransportError> {
        let scheduling = Scheduling::from_code(self.health.scheduling).map_or("unknown", Scheduling::name);
        tracing::debug!(pid = self.health.pid, scheduling, "ready");
        self.publish(State::Ready, monotonic_ns())
    }

    /// Publishes if a second has passed since the last time; `now_ns` is the monotonic clock. For each pass of the stage's loop.
    ///
    /// # Errors
    /// As [`Publisher::publish`].
    pub fn tick(&mut self, now_ns: i64) -> Result<(), TransportError> {
        if now_ns - self.last_ns < PERIOD_NS {
            return Ok(());
        }
        let busy = self.health.taken > 0 || self.health.given > 0;
        self.publish(if busy { State::Running } else { State::Ready }, now_ns)
    }

    /// Publishes that the stream ended and everything has been worked off.
    ///
    /// # Errors
    /// As [`Publisher::publish`].
    pub fn ended(&mut self) -> Result<(), TransportError> {
        self.publish(State::Ended, monotonic_ns())
    }

    fn publish(&mut self, state: State, now_ns: i64) -> Result<(), TransportError> {
        self.health.state = state as u32;
        self.last_ns = now_ns;
        if let Some(grown) = self.growth.take(losses(&self.health), now_ns) {
            self.tell(grown);
        }
        self.publisher.publish(&self.health).map(|_| ())
    }

    /// Each field tells what has come to it since the last line.
    fn tell(&self, grown: [Option<u64>; 7]) {
        let [lost, missing, refused, suspect, overflow, late, restarted_windows] = grown;
        let time_s = self.health.header.time_ns as f64 * 1e-9;
        tracing::warn!(
            lost,
            missing,
            refused,
            suspect,
            overflow,
            late,
            restarted_windows,
            time_s,
            "data are missing, late or of no use"
        );
    }
}

/// What a stage counts of lost and useless data.
fn losses(health: &Health) -> [u64; 7] {
    let Health { lost, missing, refused, suspect, overflow, late, restarted_windows, .. } = *health;
    [lost, missing, refused, suspect, overflow, late, restarted_windows]
}

impl Drop for Beat {
    fn drop(&mut self) {
        if let Some(grown) = self.growth.end(losses(&self.health)) {
            self.tell(grown);
        }
        let Health { taken, given, state, .. } = self.health;
        tracing::debug!(taken, given, ended = state == State::Ended as u32, "stopped");
    }
}
