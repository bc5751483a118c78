use crate::{Connection, Node, Publisher, TransportError, monotonic_ns, sleep_until};
use messages::{Header, ImuSample, MainAttitude, Truth, topic};

/// A source that has had nothing to send stays for so long after its end marks, ns.
const STAY_NS: i64 = 1_000_000_000;

/// The ports of a source: what the simulator, a recording or real units hand out.
#[derive(Debug)]
pub struct Feed {
    connection: Connection,
    main: Publisher<ImuSample>,
    attitude: Publisher<MainAttitude>,
    areas: Vec<Publisher<ImuSample>>,
    truths: Vec<Publisher<Truth>>,
    ordinals: Vec<u64>,
    last: Header,
}

/// What a source hands out at one main sampling instant.
#[derive(Debug)]
pub struct Delivery<'a> {
    /// The main unit's sample.
    pub main: &'a ImuSample,
    /// The main INS's attitude.
    pub attitude: Option<&'a MainAttitude>,
    /// The sub units' samples; `unit` is 1 + the index of the area.
    pub sub: &'a [ImuSample],
    /// The truth of each area.
    pub truth: &'a [Truth],
}

impl Feed {
    /// Opens the ports for the areas of these names, and says that the source is ready.
    ///
    /// # Errors
    /// As [`Publisher::open`].
    pub fn open(mut connection: Connection, areas: &[&str]) -> Result<Self, TransportError> {
        let node = &connection.node;
        let main = Publisher::open(node, &topic::main_imu())?;
        let attitude = Publisher::open(node, &topic::main_attitude())?;
        let of_areas =
            areas.iter().map(|area| Publisher::open(node, &topic::area_imu(area))).collect::<Result<_, _>>()?;
        let truths = areas.iter().map(|area| Publisher::open(node, &topic::truth(area))).collect::<Result<_, _>>()?;
        connection.beat.ready()?;
        let ordinals = vec![0; 1 + areas.len()];
        Ok(Self { connection, main, attitude, areas: of_areas, truths, ordinals, last: Header::default() })
    }

    /// Passes over a delivery whose time was before this process started: a restarted source goes on at the present.
    pub fn skip(&mut self, delivery: &Delivery<'_>) {
        self.ordinals[0] += 1;
        delivery.sub.iter().for_each(|sample| self.ordinals[sample.unit as usize] += 1);
    }

    /// Publishes one unit's sample by itself, as it comes, due at its own time of validity; the main unit's after its attitude.
    ///
    /// # Errors
    /// As [`Publisher::publish`].
    pub fn publish_one(&mut self, sample: &ImuSample, attitude: Option<&MainAttitude>) -> Result<(), TransportError> {
        if let Some(attitude) = attitude {
            self.attitude.publish(attitude)?;
        }
        let stamped = self.stamped(sample, sample.header.time_ns);
        if sample.unit > 0 {
            self.areas[sample.unit as usize - 1].publish(&stamped)?;
            return Ok(());
        }
        self.main.publish(&stamped)?;
        self.last = stamped.header;
        let beat = &mut self.connection.beat;
        beat.handled(&stamped.header);
        beat.health.taken += 1;
        beat.health.given += 1;
        Ok(())
    }

    /// Publishes the source's health if a second has passed; for a source without a main sample at hand.
    ///
    /// # Errors
    /// As [`Publisher::publish`].
    pub fn tick(&mut self) -> Result<(), TransportError> {
        self.connection.beat.tick(monotonic_ns())
    }

    /// On which the source may open further topics.
    pub fn node(&self) -> &Node {
        &self.connection.node
    }

    /// Publishes a delivery that was due at `due_ns`; the main sample last, so that with it everything is there.
    ///
    /// # Errors
    /// As [`Publisher::publish`].
    pub fn publish(&mut self, due_ns: i64, delivery: &Delivery<'_>) -> Result<(), TransportError> {
        for truth in delivery.truth {
            let header = handed_out(&truth.header, due_ns);
            self.truths[truth.area as usize].publish(&Truth { header, ..*truth })?;
        }
        if let Some(attitude) = delivery.attitude {
            let header = handed_out(&attitude.header, due_ns);
            self.attitude.publish(&MainAttitude { header, ..*attitude })?;
        }
        for sample in delivery.sub {
            let unit = sample.unit as usize;
            let stamped = self.stamped(sample, due_ns);
            self.areas[unit - 1].publish(&stamped)?;
        }
        let main = self.stamped(delivery.main, due_ns);
        self.main.publish(&main)?;
        self.last = main.header;
        let beat = &mut self.connection.beat;
        beat.handled(&main.header);
        beat.health.taken += 1;
        beat.health.given += 1;
        beat.tick(monotonic_ns())
    }

    /// Marks the end of every stream.
    ///
    /// # Errors
    /// As [`Publisher::publish`].
    pub fn end(mut self) -> Result<(), TransportError> {
        let header = Header { end: 1, ..self.last };
        for area in &self.areas {
            area.publish(&ImuSample { header, ..ImuSample::default() })?;
        }
        self.main.publish(&ImuSample { header, ..ImuSample::default() })?;
        self.connection.beat.ended()?;
        if self.connection.beat.health.given == 0 {
            // started again after the run's end, it may be gone before its readers have noticed that it came
            sleep_until(monotonic_ns() + STAY_NS);
        }
        Ok(())
    }

    /// What the source's health says, to be completed by the service.
    pub fn health(&mut self) -> &mut messages::Health {
        &mut self.connection.beat.health
    }

    fn stamped(&mut self, sample: &ImuSample, due_ns: i64) -> ImuSample {
        let mut sample = *sample;
        let ordinal = &mut self.ordinals[sample.unit as usize];
        sample.ordinal = *ordinal;
        *ordinal += 1;
        sample.header = handed_out(&sample.header, due_ns);
        sample
    }
}

/// The header of a message that is handed out now.
fn handed_out(header: &Header, due_ns: i64) -> Header {
    let mut header = *header;
    header.stamps.due_ns = due_ns;
    header.stamps.source_ns = monotonic_ns();
    header
}
