//! `deckflex synchronise`: one area's stream onto the main unit's instants.

use estimation::synchronise::Synchroniser;
use messages::{Header, ImuPair, ImuSample, MainAttitude, Stage, topic};
use pipeline::configuration::Configuration;
use pipeline::lane;
use runtime::{Area, Context, Publisher, Sequence, Subscriber, Supply, TransportError, Waiter, monotonic_ns};
use std::time::Duration;

/// How long a sleep may last without data.
const NAP: Duration = Duration::from_millis(200);
/// After the main unit's end mark, the sub unit's is waited for so long, ns.
const PATIENCE_NS: i64 = 2_000_000_000;

/// The inputs of the stage.
struct Inputs {
    main: Subscriber<ImuSample>,
    attitude: Subscriber<MainAttitude>,
    sub: Subscriber<ImuSample>,
    main_sequence: Sequence,
    sub_sequence: Sequence,
    main_supply: Supply,
    sub_supply: Supply,
    main_end: Option<(Header, i64)>,
    sub_end: bool,
}

impl Inputs {
    /// Hands everything that has come to the synchroniser.
    ///
    /// The order matters: a main sample's attitude was published before it, so it is there once the sample is; and whatever the sub
    /// unit had given by then is there too, so that a late wake-up does not look like silence.
    fn drain(&mut self, synchroniser: &mut Synchroniser) -> Result<u64, TransportError> {
        let (mut taken, mut taken_of_sub) = (0, 0);
        while let Some(sample) = self.main.take()? {
            while let Some(attitude) = self.attitude.take()? {
                synchroniser.attitude(&attitude);
            }
            if sample.header.is_end() {
                self.main_end.get_or_insert((sample.header, monotonic_ns()));
                continue;
            }
            self.main_sequence.see(&Header { sequence: sample.ordinal, ..sample.header });
            synchroniser.main(&sample);
            taken += 1;
        }
        while let Some(sample) = self.sub.take()? {
            if sample.header.is_end() {
                self.sub_end = true;
                continue;
            }
            self.sub_sequence.see(&Header { sequence: sample.ordinal, ..sample.header });
            synchroniser.sub(&sample);
            taken_of_sub += 1;
        }
        let now_ns = monotonic_ns();
        if self.main_end.is_none() {
            self.main_supply.see(taken > 0, now_ns);
        }
        if !self.sub_end {
            self.sub_supply.see(taken_of_sub > 0, now_ns);
        }
        Ok(taken)
    }

    /// The header of the end mark, once nothing more can come.
    fn ended(&self) -> Option<Header> {
        let (header, since_ns) = self.main_end?;
        (self.sub_end || monotonic_ns() - since_ns > PATIENCE_NS).then_some(header)
    }
}

/// Runs the stage of one area until its streams end or a signal comes.
///
/// # Errors
/// The transport or the operating system refuses.
pub fn run(configuration: &Configuration, area: usize, context: &Context) -> Result<(), TransportError> {
    let name = configuration.areas[area].name.as_str();
    let place = Area { index: area as u32, name };
    let (stop, mut connection) = context.connect(Stage::Synchronise, Some(place))?;
    let node = &connection.node;
    let mut inputs = Inputs {
        main: Subscriber::open(node, &topic::main_imu())?,
        attitude: Subscriber::open(node, &topic::main_attitude())?,
        sub: Subscriber::open(node, &topic::area_imu(name))?,
        main_sequence: Sequence::default(),
        sub_sequence: Sequence::default(),
        main_supply: Supply::new("samples of the main unit"),
        sub_supply: Supply::new("samples of the area's unit"),
        main_end: None,
        sub_end: false,
    };
    let pairs = Publisher::open(node, &topic::pair(name))?;
    let mut synchroniser = lane::synchroniser(configuration, area);
    let beat = &mut connection.beat;
    beat.ready()?;
    let mut waiter = Waiter::new();
    loop {
        waiter.wait(&[&inputs.main, &inputs.sub], NAP)?;
        let taken = inputs.drain(&mut synchroniser)?;
        let ended = inputs.ended();
        if ended.is_some() {
            synchroniser.end();
        }
        while let Some(mut pair) = synchroniser.pair() {
            pair.header.stamps.pair_ns = monotonic_ns();
            pairs.publish(&pair)?;
            beat.health.given += 1;
            beat.handled(&pair.header);
        }
        let counts = synchroniser.counts();
        beat.health.taken += taken;
        beat.health.lost = inputs.main_sequence.lost() + inputs.sub_sequence.lost();
        beat.health.missing = counts.missing;
        beat.health.refused = counts.refused;
        beat.health.suspect = counts.suspect;
        if let Some(header) = ended {
            pairs.publish(&ImuPair { header, area: place.index, ..ImuPair::default() })?;
            return beat.ended();
        }
        if stop.requested() {
            return Ok(());
        }
        beat.tick(monotonic_ns())?;
    }
}
