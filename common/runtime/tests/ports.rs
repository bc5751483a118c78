//! Topics within one process, each test in a domain of its own.
#![allow(clippy::unwrap_used)]

use iceoryx2::prelude::{NodeBuilder, ServiceName, ipc};
use iceoryx2::service::builder::publish_subscribe::PublishSubscribeOpenError;
use messages::topic::{self, Topic};
use messages::{Header, ImuSample, Message, Scheduling, Stage, State};
use runtime::{Area, Connection, Domain, Node, Publisher, Sequence, Subscriber, TransportError, Wire, monotonic_ns};
use std::fs;
use std::os::unix::fs::PermissionsExt;

fn sample(k: u64) -> ImuSample {
    let header = Header { run_id: 7, sequence: k, time_ns: k as i64 * 10_000_000, ..Header::default() };
    ImuSample { header, dtheta: [k as f64, -1.5, 1e-9], ..ImuSample::default() }
}

fn all<M: Message>(reader: &Subscriber<M>) -> Vec<M> {
    std::iter::from_fn(|| reader.take().unwrap()).collect()
}

fn numbers(samples: &[ImuSample]) -> Vec<u64> {
    samples.iter().map(|sample| sample.header.sequence).collect()
}

fn shallow(depth: usize) -> Topic<ImuSample> {
    let mut topic = topic::main_imu();
    topic.depth = depth;
    topic
}

#[test]
fn a_message_arrives_bit_by_bit() {
    let domain = Domain::create().unwrap();
    let (here, there) = (Node::open(&domain, "here").unwrap(), Node::open(&domain, "there").unwrap());
    let reader = Subscriber::open(&there, &topic::main_imu()).unwrap();
    let writer = Publisher::open(&here, &topic::main_imu()).unwrap();
    let sent: Vec<ImuSample> = (0..50).map(sample).collect();
    for message in &sent {
        assert_eq!(writer.publish(message).unwrap(), 1);
    }
    assert_eq!(all(&reader), sent);
    assert_eq!(reader.take().unwrap(), None);
}

#[test]
fn all_readers_get_everything_and_a_writer_needs_none() {
    let domain = Domain::create().unwrap();
    let node = Node::open(&domain, "node").unwrap();
    let writer = Publisher::open(&node, &topic::main_imu()).unwrap();
    assert_eq!(writer.publish(&sample(0)).unwrap(), 0);
    let readers: Vec<_> = (0..6).map(|_| Subscriber::open(&node, &topic::main_imu()).unwrap()).collect();
    assert_eq!(writer.publish(&sample(1)).unwrap(), 6);
    for reader in &readers {
        assert_eq!(numbers(&all(reader)), [1]);
    }
    let seventh = Subscriber::open(&node, &topic::main_imu());
    assert!(matches!(seventh, Err(TransportError::Occupied { .. })), "{seventh:?}");
}

#[test]
fn a_slow_reader_loses_the_oldest_and_knows_how_many() {
    let domain = Domain::create().unwrap();
    let node = Node::open(&domain, "node").unwrap();
    let writer = Publisher::open(&node, &shallow(4)).unwrap();
    let reader = Subscriber::open(&node, &shallow(4)).unwrap();
    let mut sequence = Sequence::default();
    let mut taken = Vec::new();
    for burst in [0..3, 3..13, 13..20] {
        burst.for_each(|k| assert_eq!(writer.publish(&sample(k)).unwrap(), 1));
        for message in all(&reader) {
            sequence.see(&message.header);
            taken.push(message.header.sequence);
        }
    }
    assert_eq!(taken, [0, 1, 2, 9, 10, 11, 12, 16, 17, 18, 19]);
    assert_eq!(sequence.lost(), 6 + 3);
}

#[test]
fn a_latched_topic_gives_a_late_reader_the_last_message() {
    let domain = Domain::create().unwrap();
    let node = Node::open(&domain, "node").unwrap();
    let writer = Publisher::open(&node, &topic::parameters("aft")).unwrap();
    let mut message = messages::FlexureParams::default();
    for id in 1..=10 {
        message.id = id;
        writer.publish(&message).unwrap();
    }
    let reader = Subscriber::open(&node, &topic::parameters("aft")).unwrap();
    writer.refresh().unwrap();
    assert_eq!(all(&reader).iter().map(|m| m.id).collect::<Vec<_>>(), [10]);
    writer.refresh().unwrap();
    assert_eq!(reader.take().unwrap(), None, "handed over once only");
}

#[test]
fn a_stream_has_no_past() {
    let domain = Domain::create().unwrap();
    let node = Node::open(&domain, "node").unwrap();
    let writer = Publisher::open(&node, &topic::main_imu()).unwrap();
    writer.publish(&sample(1)).unwrap();
    let reader = Subscriber::open(&node, &topic::main_imu()).unwrap();
    writer.refresh().unwrap();
    assert_eq!(reader.take().unwrap(), None);
    writer.publish(&sample(2)).unwrap();
    assert_eq!(numbers(&all(&reader)), [2]);
}

#[test]
fn what_a_writer_sent_outlives_it() {
    let domain = Domain::create().unwrap();
    let node = Node::open(&domain, "node").unwrap();
    let reader = Subscriber::open(&node, &topic::main_imu()).unwrap();
    for first in [0, 10, 20] {
        let writer = Publisher::open(&Node::open(&domain, "writer").unwrap(), &topic::main_imu()).unwrap();
        assert_eq!(reader.take().unwrap(), None, "which connects it");
        (first..first + 3).for_each(|k| assert_eq!(writer.publish(&sample(k)).unwrap(), 1));
        drop(writer);
        assert_eq!(numbers(&all(&reader)), [first, first + 1, first + 2]);
    }
}

#[test]
fn a_topic_has_one_living_writer() {
    let domain = Domain::create().unwrap();
    let node = Node::open(&domain, "node").unwrap();
    let first = Publisher::open(&node, &topic::main_imu()).unwrap();
    let second = Publisher::open(&Node::open(&domain, "other").unwrap(), &topic::main_imu());
    assert!(matches!(second, Err(TransportError::Occupied { .. })), "{second:?}");
    drop(first);
    Publisher::open(&node, &topic::main_imu()).unwrap();
}

#[test]
fn another_layout_is_refused() {
    let domain = Domain::create().unwrap();
    let node = Node::open(&domain, "node").unwrap();
    let _writer = Publisher::open(&node, &topic::main_imu()).unwrap();
    let mut other = topic::truth("aft");
    other.name = topic::main_imu().name;
    let reader = Subscriber::open(&node, &other);
    assert!(matches!(reader, Err(TransportError::Incompatible { .. })), "{reader:?}");
    let deeper = Subscriber::open(&node, &shallow(5000));
    assert!(matches!(deeper, Err(TransportError::Incompatible { .. })), "{deeper:?}");
}

macro_rules! twin {
    ($type:ident, $name:literal) => {
        #[repr(C)]
        #[derive(Clone, Copy, Debug, Default)]
        struct $type {
            header: Header,
        }
        // SAFETY: repr(C) and numbers only.
        unsafe impl Message for $type {
            const TYPE_NAME: &'static str = $name;
            fn header(&self) -> &Header {
                &self.header
            }
            fn header_mut(&mut self) -> &mut Header {
                &mut self.header
            }
        }
    };
}

twin!(First, "deckflex/Twin/1");
twin!(Second, "deckflex/Twin/2");
twin!(Namesake, "deckflex/Twin/1");

#[test]
fn the_type_name_is_the_identity() {
    let domain = Domain::create().unwrap();
    let node = NodeBuilder::new().config(&domain.config().unwrap()).create::<ipc::Service>().unwrap();
    let name = ServiceName::new("twin").unwrap();
    let _first = node.service_builder(&name).publish_subscribe::<Wire<First>>().create().unwrap();
    let second = node.service_builder(&name).publish_subscribe::<Wire<Second>>().open();
    assert_eq!(second.err(), Some(PublishSubscribeOpenError::IncompatibleTypes));
    node.service_builder(&name).publish_subscribe::<Wire<Namesake>>().open().unwrap();
}

#[test]
fn domains_do_not_meet() {
    let (one, two) = (Domain::create().unwrap(), Domain::create().unwrap());
    let (here, there) = (Node::open(&one, "node").unwrap(), Node::open(&two, "node").unwrap());
    let writer = Publisher::open(&here, &topic::main_imu()).unwrap();
    let reader = Subscriber::open(&there, &topic::main_imu()).unwrap();
    let twin = Publisher::open(&there, &topic::main_imu()).unwrap();
    assert_eq!(writer.publish(&sample(1)).unwrap(), 0);
    assert_eq!(twin.publish(&sample(2)).unwrap(), 1);
    assert_eq!(numbers(&all(&reader)), [2]);
}

/// What a process leaves that is killed between creating a service's file and filling it.
#[test]
fn a_half_made_service_is_poison() {
    let domain = Domain::create().unwrap();
    let node = Node::open(&domain, "node").unwrap();
    let services = domain.root().join("services");
    let writer = Publisher::open(&node, &topic::main_imu()).unwrap();
    let files: Vec<_> = fs::read_dir(&services).unwrap().map(|entry| entry.unwrap().path()).collect();
    assert_eq!(files.len(), 2, "data and event");
    drop(writer);
    for file in files {
        fs::write(&file, "").unwrap();
        fs::set_permissions(&file, fs::Permissions::from_mode(0o200)).unwrap();
        let error = Publisher::open(&node, &topic::main_imu()).unwrap_err();
        assert!(error.is_poisoned(), "{error}");
        fs::remove_file(&file).unwrap();
    }
    Publisher::open(&node, &topic::main_imu()).unwrap();
}

#[test]
fn names_that_the_transport_refuses_are_errors() {
    let domain = Domain::create().unwrap();
    assert!(matches!(Node::open(&domain, &"x".repeat(500)), Err(TransportError::Name(_))));
    let node = Node::open(&domain, "node").unwrap();
    let topic = topic::pair(&"x".repeat(500));
    assert!(matches!(Publisher::open(&node, &topic), Err(TransportError::Name(_))));
}

#[test]
fn a_stage_tells_how_it_does() {
    let domain = Domain::create().unwrap();
    let area = Area { index: 1, name: "aft" };
    let mut stage = Connection::open(&domain, Stage::Estimate, Some(area), 42).unwrap();
    let reader = Subscriber::open(&stage.node, &topic::health(Stage::Estimate, Some("aft"))).unwrap();
    let last = || all(&reader).last().copied();

    stage.beat.health.scheduling = Scheduling::Fifo as u32;
    stage.beat.ready().unwrap();
    let ready = last().unwrap();
    assert_eq!((ready.header.run_id, ready.stage, ready.area), (42, Stage::Estimate as u32, 1));
    assert_eq!((ready.state, ready.pid), (State::Ready as u32, std::process::id()));
    assert_eq!(ready.scheduling, Scheduling::Fifo as u32);

    let now = monotonic_ns();
    stage.beat.tick(now).unwrap();
    assert_eq!(last(), None, "not before a second has passed");
    stage.beat.tick(now + 2_000_000_000).unwrap();
    assert_eq!(last().unwrap().state, State::Ready as u32);
    stage.beat.health.taken = 3;
    stage.beat.handled(&sample(99).header);
    stage.beat.tick(now + 2_900_000_000).unwrap();
    assert_eq!(last(), None);
    stage.beat.tick(now + 3_000_000_000).unwrap();
    let running = last().unwrap();
    assert_eq!((running.state, running.taken, running.header.sequence), (State::Running as u32, 3, 99));
    assert_eq!((running.header.run_id, running.header.time_ns), (42, 990_000_000));
    stage.beat.ended().unwrap();
    assert_eq!(last().unwrap().state, State::Ended as u32);
}
