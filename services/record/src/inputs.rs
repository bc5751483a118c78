//! The topics of a run.

use crate::Outlet;
use messages::topic::{self, Topic};
use messages::{Flags, Header, Health, Message, Solution, Stage, State};
use pipeline::configuration::{Configuration, RecordTopic};
use pipeline::recorded_run::adoption_topic;
use recording::{Adoption, Record};
use runtime::{Node, Sequence, Subscriber, TransportError};

/// All ports of the recorder.
pub struct Inputs {
    topics: Vec<String>,
    solutions: Vec<Solutions>,
    /// In an order in which each comes before what it was made of, so that a recording never holds the former only.
    others: Vec<Box<dyn Drain>>,
    health: Vec<Healths>,
}

/// The solutions of an area, which tell of the parameters too.
struct Solutions {
    port: Port<Solution>,
    adoption: Option<usize>,
    params_id: u64,
    ended: bool,
    last: Header,
}

struct Healths {
    port: Port<Health>,
    stage: Stage,
    ended: bool,
}

/// A port and the place of its topic; `None` if it is read and not recorded.
struct Port<M: Message> {
    subscriber: Subscriber<M>,
    topic: Option<usize>,
    sequence: Sequence,
}

trait Drain {
    fn drain(&mut self, outlet: &Outlet) -> Result<(), TransportError>;
}

impl<M: Message> Port<M>
where
    Record: From<M>,
{
    /// The next message, passed on if it is recorded and no end mark.
    fn take(&mut self, outlet: &Outlet) -> Result<Option<M>, TransportError> {
        let Some(message) = self.subscriber.take()? else { return Ok(None) };
        if message.header().is_end() {
            return Ok(Some(message));
        }
        let record = Record::from(message);
        if let Record::Sample(sample) = &record {
            // of other messages a gap may be the unit's own
            outlet.tally.lose(self.sequence.see(&Header { sequence: sample.ordinal, ..sample.header }));
        }
        if let Some(topic) = self.topic {
            outlet.give(topic, record);
        }
        Ok(Some(message))
    }
}

impl<M: Message> Drain for Port<M>
where
    Record: From<M>,
{
    fn drain(&mut self, outlet: &Outlet) -> Result<(), TransportError> {
        while self.take(outlet)?.is_some() {}
        Ok(())
    }
}

/// Opens ports and keeps the list of topics.
struct Opening<'a> {
    node: &'a Node,
    wanted: &'a [RecordTopic],
    topics: Vec<String>,
}

impl Opening<'_> {
    fn topic(&mut self, kind: RecordTopic, name: &str) -> Option<usize> {
        self.wanted.contains(&kind).then(|| {
            self.topics.push(name.to_owned());
            self.topics.len() - 1
        })
    }

    fn port<M: Message>(&mut self, kind: RecordTopic, topic: &Topic<M>) -> Result<Port<M>, TransportError> {
        let place = self.topic(kind, &topic.name);
        Ok(Port { subscriber: Subscriber::open(self.node, topic)?, topic: place, sequence: Sequence::default() })
    }

    /// A port that is of no use but for recording.
    fn only<M: Message>(
        &mut self,
        kind: RecordTopic,
        topic: &Topic<M>,
        into: &mut Vec<Box<dyn Drain>>,
    ) -> Result<(), TransportError>
    where
        Record: From<M>,
    {
        if self.wanted.contains(&kind) {
            into.push(Box::new(self.port(kind, topic)?));
        }
        Ok(())
    }
}

impl Inputs {
    /// Opens the ports; those of solutions and health always, since they tell how far the run is.
    pub fn open(node: &Node, configuration: &Configuration, wanted: &[RecordTopic]) -> Result<Self, TransportError> {
        use RecordTopic as T;
        let mut opening = Opening { node, wanted, topics: Vec::new() };
        let names: Vec<&str> = configuration.areas.iter().map(|area| area.name.as_str()).collect();
        let (mut solutions, mut others, mut healths) = (Vec::new(), Vec::new(), Vec::new());
        for name in &names {
            let port = opening.port(T::Solutions, &topic::solution(name))?;
            let adoption = opening.topic(T::Parameters, &adoption_topic(name));
            solutions.push(Solutions { port, adoption, params_id: 0, ended: false, last: Header::default() });
        }
        for name in &names {
            opening.only(T::States, &topic::state(name), &mut others)?;
            opening.only(T::Parameters, &topic::parameters(name), &mut others)?;
            opening.only(T::Pairs, &topic::pair(name), &mut others)?;
        }
        opening.only(T::Samples, &topic::main_imu(), &mut others)?;
        for name in &names {
            opening.only(T::Samples, &topic::area_imu(name), &mut others)?;
        }
        opening.only(T::Samples, &topic::main_attitude(), &mut others)?;
        for name in &names {
            opening.only(T::Truth, &topic::truth(name), &mut others)?;
        }
        let source = configuration.main.source.stage();
        let of_areas = names
            .iter()
            .flat_map(|name| [Stage::Synchronise, Stage::Estimate, Stage::Identify].map(|stage| (stage, Some(*name))));
        for (stage, area) in std::iter::once((source, None)).chain(of_areas) {
            let port = opening.port(T::Health, &topic::health(stage, area))?;
            healths.push(Healths { port, stage, ended: false });
        }
        Ok(Self { topics: opening.topics, solutions, others, health: healths })
    }

    /// The topics that are recorded.
    pub fn topics(&self) -> &[String] {
        &self.topics
    }

    /// Passes on everything that has come.
    pub fn drain(&mut self, outlet: &mut Outlet) -> Result<(), TransportError> {
        for area in &mut self.solutions {
            area.drain(outlet)?;
        }
        for port in &mut self.others {
            port.drain(outlet)?;
        }
        for stage in &mut self.health {
            while let Some(health) = stage.port.take(outlet)? {
                stage.ended = health.state == State::Ended as u32;
            }
        }
        outlet.mark();
        Ok(())
    }

    /// Whether the solutions of every area have come to their end mark.
    pub fn ended(&self) -> bool {
        self.solutions.iter().all(|area| area.ended)
    }

    /// Whether every identifier has said its last word.
    pub fn learnt(&self) -> bool {
        self.health.iter().filter(|stage| stage.stage == Stage::Identify).all(|stage| stage.ended)
    }

    /// The header of the newest solution of the first area.
    pub fn last(&self) -> &Header {
        &self.solutions[0].last
    }
}

impl Solutions {
    fn drain(&mut self, outlet: &Outlet) -> Result<(), TransportError> {
        while let Some(solution) = self.port.take(outlet)? {
            if solution.header.is_end() {
                self.ended = true;
                continue;
            }
            self.last = solution.header;
            let params_id = std::mem::replace(&mut self.params_id, solution.params_id);
            if let Some(topic) = self.adoption
                && solution.params_id != params_id
                && solution.params_id != 0
            {
                let late = u32::from(solution.flags.contains(Flags::LATE));
                let (header, params_id, area) = (solution.header, solution.params_id, solution.area);
                outlet.give(topic, Adoption { header, params_id, area, late }.into());
            }
        }
        Ok(())
    }
}
