//! The topics of a launch on their way to the viewers.

use crate::server::Server;
use foxglove::{ChannelId, PartialMetadata, RawChannel, SinkId};
use messages::topic::{self, Topic};
use messages::{Header, Message, Stage};
use pipeline::configuration::{Configuration, Source};
use recording::Record;
use runtime::{Domain, Launch, Node, Sequence, Subscriber, TransportError, host_utc};
use std::sync::Arc;

/// All topics of a launch.
pub struct Inputs {
    ports: Vec<Box<dyn PassOn>>,
    node: Node,
    since_1970_ns: i64,
}

/// A topic, by which message it carries.
trait PassOn {
    fn pass_on(&mut self, node: &Node, since_1970_ns: i64) -> Result<(), TransportError>;
    /// Gives the last message of a latched topic to a viewer that came after it.
    fn repeat(&self, channel: ChannelId, sink: SinkId);
    /// Messages given and lost.
    fn close(&self) -> (u64, u64);
}

/// A topic. One that is not latched is read while a viewer wants it only, since each reader costs the writer a wake-up a message.
struct Port<M: Message> {
    topic: Topic<M>,
    channel: Arc<RawChannel>,
    subscriber: Option<Subscriber<M>>,
    sequence: Sequence,
    last: Option<(Vec<u8>, PartialMetadata)>,
    given: u64,
    lost: u64,
}

impl<M: Message> Port<M>
where
    Record: From<M>,
{
    fn is_latched(&self) -> bool {
        self.topic.history > 0
    }

    fn attend(&mut self, node: &Node) -> Result<(), TransportError> {
        let wanted = self.is_latched() || self.channel.has_sinks();
        if wanted && self.subscriber.is_none() {
            self.subscriber = Some(Subscriber::open(node, &self.topic)?);
            self.sequence = Sequence::default();
        } else if !wanted {
            self.subscriber = None;
        }
        Ok(())
    }

    fn give(&mut self, message: M, since_1970_ns: i64) {
        let record = Record::from(message);
        // a gap in a unit's own numbers is the unit's
        let number = match &record {
            Record::Sample(sample) => Some(sample.ordinal),
            Record::Solution(_) | Record::Pair(_) => Some(record.header().sequence),
            _ => None,
        };
        if let Some(sequence) = number {
            self.lost += self.sequence.see(&Header { sequence, ..*record.header() });
        }
        let published_ns = record.published_ns().unwrap_or_else(runtime::monotonic_ns);
        let time_ns = (published_ns + since_1970_ns).max(0).unsigned_abs();
        let (bytes, when) = (record.encode(), PartialMetadata { log_time: Some(time_ns) });
        self.given += u64::from(self.channel.has_sinks());
        self.channel.log_with_meta(&bytes, when);
        self.last = self.is_latched().then_some((bytes, when));
    }
}

impl<M: Message> PassOn for Port<M>
where
    Record: From<M>,
{
    fn pass_on(&mut self, node: &Node, since_1970_ns: i64) -> Result<(), TransportError> {
        self.attend(node)?;
        while let Some(message) = self.subscriber.as_ref().map_or(Ok(None), Subscriber::take)? {
            if !message.header().is_end() {
                self.give(message, since_1970_ns);
            }
        }
        Ok(())
    }

    fn repeat(&self, channel: ChannelId, sink: SinkId) {
        if let Some((bytes, when)) = self.last.as_ref().filter(|_| self.channel.id() == channel) {
            self.channel.log_with_meta_to_sink(bytes, *when, Some(sink));
        }
    }

    fn close(&self) -> (u64, u64) {
        self.channel.close();
        (self.given, self.lost)
    }
}

/// Opens topics.
struct Opening<'a> {
    server: &'a Server,
    ports: Vec<Box<dyn PassOn>>,
}

impl Opening<'_> {
    fn port<M: Message>(&mut self, topic: Topic<M>) -> Result<(), TransportError>
    where
        Record: From<M>,
    {
        let channel = self.server.channel(&topic.name, &Record::from(M::default())).map_err(|error| {
            TransportError::Port { action: "show", topic: topic.name.clone(), reason: error.to_string() }
        })?;
        let (sequence, last) = (Sequence::default(), None);
        self.ports.push(Box::new(Port { topic, channel, subscriber: None, sequence, last, given: 0, lost: 0 }));
        Ok(())
    }
}

impl Inputs {
    /// Offers the topics of a launch to the viewers.
    pub fn open(launch: &Launch, configuration: &Configuration, server: &Server) -> Result<Self, TransportError> {
        let node = Node::open(&Domain::open(&launch.root)?, "live")?;
        let mut opening = Opening { server, ports: Vec::new() };
        for name in configuration.areas.iter().map(|area| area.name.as_str()) {
            opening.port(topic::solution(name))?;
            opening.port(topic::parameters(name))?;
            opening.port(topic::pair(name))?;
            opening.port(topic::area_imu(name))?;
            if configuration.main.source == Source::Simulator {
                opening.port(topic::truth(name))?;
            }
            for stage in [Stage::Synchronise, Stage::Estimate, Stage::Identify] {
                opening.port(topic::health(stage, Some(name)))?;
            }
        }
        opening.port(topic::main_imu())?;
        opening.port(topic::main_attitude())?;
        opening.port(topic::health(configuration.main.source.stage(), None))?;
        Ok(Self { ports: opening.ports, node, since_1970_ns: host_utc().offset_ns })
    }

    /// Passes on everything that has come.
    pub fn pass_on(&mut self, server: &Server) -> Result<(), TransportError> {
        for (channel, sink) in server.subscribed() {
            self.ports.iter().for_each(|port| port.repeat(channel, sink));
        }
        self.ports.iter_mut().try_for_each(|port| port.pass_on(&self.node, self.since_1970_ns))
    }

    /// Takes the topics from the viewers; messages given and lost.
    pub fn close(self) -> (u64, u64) {
        let counts = self.ports.iter().map(|port| port.close());
        counts.fold((0, 0), |(given, lost), (g, l)| (given + g, lost + l))
    }
}
