//! Published frames and stored captures decode to the listed values.
#![allow(clippy::unwrap_used)]

use frames::{Euler, Nav, Rot, Vec3, unit};
use wire::kvh::{self, Extra, Kvh};
use wire::stdbin::{self, Masks, Stdbin, Telegram};
use wire::stim300::{self, Cluster, Stim300};
use wire::{Framer, Look, Protocol};

fn hex(text: &str) -> Vec<u8> {
    (0..text.len()).step_by(2).map(|i| u8::from_str_radix(&text[i..i + 2], 16).unwrap()).collect()
}

fn whole<P: Protocol>(bytes: &[u8]) -> P::Frame {
    match P::look(bytes) {
        Look::Whole { frame, length } if length == bytes.len() => frame,
        other => panic!("{other:?}"),
    }
}

const V1: &str = "FE81FF553B041F78B9B96613BA234B38BB7C0410B8DEF4803F7F4B7B701F001DF12FB6EE";
const V2: &str = "FE81FF55B3D0BBE732193EF430AC19A5BA8F78D63A2905943F7ECBD47768001DADC5F651";
const V3: &str = "FE81FF55B46B86C6B44F5B83B4106D09BB713CB7BBABD9143F7E319A7769001D95BBDB4F";
const V4: &str = "FE81FF5537A96A6E38586C1FB75BF862BF803E78BB650D283B0A37AC773D00284BFA34D8";

#[test]
fn kvh_frames_of_real_units() {
    let listed = [
        (V1, [0.0020160358, -0.00035362001, -0.0006229165], [-0.003845457, -0.00010631327, 0.99724549], 0x70, 31, 29),
        (V2, [-9.719934e-8, 8.920086e-9, 1.2521936e-9], [-0.0010946046, 0.00064476696, 0.99529767], 0x77, 104, 29),
        (V4, [2.019593e-5, 5.1599109e-5, -1.3111248e-5], [-1.0019064, -0.003495047, 0.002109031], 0x77, 61, 40),
    ];
    for (text, rotation, acceleration, status, sequence, temperature) in listed {
        let kvh::Frame::Inertial(frame) = whole::<Kvh>(&hex(text)) else { panic!("no data") };
        for (value, told) in frame.rotation.iter().chain(&frame.acceleration).zip(rotation.iter().chain(&acceleration))
        {
            let told: f64 = *told;
            assert!((f64::from(*value) / told - 1.0).abs() < 1e-6, "{value} instead of {told}");
        }
        assert_eq!((frame.status, frame.sequence, frame.extra), (status, sequence, Extra::Plain { temperature }));
        let mut again = Vec::new();
        frame.encode(&mut again);
        assert_eq!(again, hex(text));
    }
}

#[test]
fn a_bad_check_is_refused() {
    assert!(matches!(Kvh::look(&hex(V3)), Look::Damaged));
    let mut framer = Framer::<Kvh>::default();
    framer.push(&hex(&[V2, V3, V4].concat()));
    let frames: Vec<_> = std::iter::from_fn(|| framer.next_frame()).collect();
    assert_eq!(frames, [whole::<Kvh>(&hex(V2)), whole::<Kvh>(&hex(V4))]);
    let counts = framer.counts();
    assert_eq!((counts.good, counts.damaged, counts.skipped), (2, 1, 36));
}

#[test]
fn kvh_answers_to_a_test() {
    let frame = whole::<Kvh>(&hex("FE8100AA7F7F7F7F7F7F23"));
    assert_eq!(frame, kvh::Frame::BuiltInTest { result: [0x7F, 0x7F, 0x7F, 0x7F, 0x7F, 0x7F, 0, 0], extended: false });
    assert!(matches!(Kvh::look(&hex("FE8100AA7F7F7F7F7F7F24")), Look::Damaged));
}

#[test]
fn kvh_formats_b_and_c_come_back() {
    let of = |extra| kvh::Inertial {
        rotation: [1e-5, -2e-5, 3e-5],
        acceleration: [0.1, -0.2, 1.0],
        extra,
        status: kvh::ALL_VALID,
        sequence: 127,
    };
    for (extra, length) in [
        (Extra::Stamped { microseconds: 4_294_967_290, temperature: -3 }, 40),
        (Extra::Slow { value: 21.5 }, 38),
        (Extra::Plain { temperature: 29 }, 36),
    ] {
        let mut bytes = Vec::new();
        of(extra).encode(&mut bytes);
        assert_eq!(bytes.len(), length);
        assert_eq!(whole::<Kvh>(&bytes), kvh::Frame::Inertial(of(extra)));
    }
}

fn captured(bytes: &[u8]) -> Vec<Telegram> {
    let mut framer = Framer::<Stdbin>::default();
    framer.push(bytes);
    let frames: Vec<_> = std::iter::from_fn(|| framer.next_frame()).collect();
    assert_eq!((framer.counts().damaged, framer.counts().skipped), (0, 0));
    let telegram = |frame: stdbin::Frame| match frame {
        stdbin::Frame::Telegram(telegram) => telegram,
        stdbin::Frame::Answer => panic!("an answer"),
    };
    frames.into_iter().map(telegram).collect()
}

const CAPTURE_V2: &[u8] = include_bytes!("data/stdbin/log_STDBIN_V2.log");
const CAPTURE_V3: &[u8] = include_bytes!("data/stdbin/log_STDBIN_V3.log");

#[test]
fn stdbin_version_2_of_a_real_unit() {
    let telegrams = captured(CAPTURE_V2);
    let [telegram] = telegrams.as_slice() else { panic!("{} telegrams", telegrams.len()) };
    let [heading, roll, pitch] = telegram.attitude.unwrap();
    assert!((heading - 209.982).abs() < 1e-3 && (roll - 0.016).abs() < 1e-4 && (pitch - 0.206).abs() < 1e-3);
    assert_eq!((telegram.version, telegram.time, telegram.counter), (2, 9_215_311, 2));
    assert_eq!((telegram.masks.navigation, telegram.masks.extended), (0x03E3_FFFF, 0));
    // neither a quaternion nor a raw rate, and the rate that there is has no place
    assert_eq!((telegram.quaternion, telegram.rotation), (None, None));
    // it has not been told UTC: the time is since its start, and the date is that of no day
    assert_eq!((telegram.date, telegram.utc_ns()), (Some([1, 1, 2006]), None));
}

#[test]
fn stdbin_version_3_of_a_real_unit() {
    let telegrams = captured(CAPTURE_V3);
    assert_eq!(telegrams.len(), 17);
    for (index, telegram) in telegrams.iter().enumerate() {
        // one of them comes without the two satellite receivers
        let external = if telegram.masks.external == 0x5ED1 { 0x5ED1 } else { 0x5ED7 };
        let masks = Masks { navigation: 0x7FE3_FFFF, extended: 7, external };
        assert_eq!((telegram.version, telegram.masks), (3, masks));
        assert_eq!(telegram.counter, 8 + index as u32);
    }
    assert_eq!(telegrams.iter().filter(|telegram| telegram.masks.external == 0x5ED7).count(), 16);
    let steps: Vec<u32> = telegrams.windows(2).map(|pair| pair[1].time - pair[0].time).collect();
    assert!(steps.iter().all(|step| step.abs_diff(10_000) <= 1), "{steps:?}");
    let first = telegrams[0];
    assert_eq!(first.attitude.unwrap(), [0.0, 0.809, -0.521]);
    // not block 5, which says -0.00136, -0.002145 and -0.000025
    assert_eq!(first.rotation.unwrap(), [0.0; 3]);
    assert_eq!(first.acceleration.unwrap(), [0.0, 0.0, 7.999_994]);
    // told UTC at a whole second, 353.5 ms before
    assert_eq!((first.date, first.time, first.utc), (Some([14, 3, 2019]), 566_983_535, Some(566_980_000)));
    // 15:44:58.3535 of that day
    assert!(telegrams.iter().all(|telegram| telegram.utc_ns().is_some()));
    assert_eq!(first.utc_ns(), Some(1_552_578_298_353_500_000));
    assert_eq!(first.position.unwrap().map(|v| (v * 1e4).round()), [488_991.0, 20_620.0]);
}

/// What its quaternion turns, checked against the angles of the same telegram.
#[test]
fn the_quaternion_is_that_of_the_angles() {
    for telegram in captured(CAPTURE_V3) {
        let [heading, roll, pitch] = telegram.attitude.unwrap().map(|angle| f64::from(angle) * unit::DEGREE);
        let body: Rot<Nav, Nav> = Euler { roll, pitch: -pitch, heading }.rotation();
        // from bow, port, up into starboard, bow, up, and the same of north, west, up into east, north, up
        let turn = Rot::<Nav, Nav>::exp(Vec3::new(0.0, 0.0, unit::DEGREE * 90.0));
        let vessel_from_north = Rot::<Nav, Nav>::from_quaternion(telegram.quaternion.unwrap().map(f64::from)).unwrap();
        let again = turn * vessel_from_north.inverse() * turn.inverse();
        let apart = (again * body.inverse()).angle();
        // the angles are rounded to thousandths of a degree
        assert!(apart < 2e-3 * unit::DEGREE, "{} degrees at heading {heading}", apart / unit::DEGREE);
    }
}

#[test]
fn stdbin_telegrams_of_all_versions_come_back() {
    for version in 2..=5 {
        let mut told = Telegram {
            version,
            time: 863_999_999,
            counter: u32::MAX,
            attitude: Some([359.5, -3.0, 2.0]),
            attitude_deviation: Some([0.02, 0.01, 0.01]),
            position: Some([45.0, 126.0]),
            quaternion: Some([1.0, 0.0, 0.0, 0.0]),
            acceleration: Some([0.1, 0.2, 9.8]),
            rotation: Some([1.0, -2.0, 3.0]),
            date: Some([29, 2, 2024]),
            utc: Some(863_990_000),
            masks: Masks { navigation: 0x1400_2083, extended: 4, external: 1 },
        };
        if version == 2 {
            (told.rotation, told.masks.extended) = (None, 0);
        }
        let mut bytes = Vec::new();
        told.encode(&mut bytes);
        assert_eq!(whole::<Stdbin>(&bytes), stdbin::Frame::Telegram(told));
        bytes[30] ^= 1;
        assert!(matches!(Stdbin::look(&bytes), Look::Damaged));
    }
}

#[test]
fn stdbin_answers_are_passed_over() {
    let mut bytes = vec![b'A', b'N', 3, 0, 12, 1, 2, 3];
    let sum: u32 = bytes.iter().map(|b| u32::from(*b)).sum();
    bytes.extend_from_slice(&sum.to_be_bytes());
    assert_eq!(whole::<Stdbin>(&bytes), stdbin::Frame::Answer);
    bytes.extend_from_slice(CAPTURE_V2);
    let mut framer = Framer::<Stdbin>::default();
    framer.push(&bytes);
    assert_eq!(framer.next_frame(), Some(stdbin::Frame::Answer));
    assert!(matches!(framer.next_frame(), Some(stdbin::Frame::Telegram(_))));
}

#[test]
fn stim300_datagrams() {
    let zero = whole::<Stim300>(&hex("9100000000000000000000000000000000000000000000003499f542"));
    let none = stim300::Datagram { id: 0x91, acceleration: Some(Cluster::default()), ..Default::default() };
    assert_eq!(zero, stim300::Frame::Sample(none));
    let gyro = Cluster { values: [1.5, -2.25, 0.125].map(|v| (v / stim300::RATE_DEG_PER_S) as i32), status: 0 };
    let force = Cluster { values: [0.01, -0.02, -1.0].map(|v: f64| (v * 524_288.0).round() as i32), status: 0 };
    let with = |id, acceleration| stim300::Datagram { id, gyro, acceleration, counter: 17, latency: 500, ..none };
    for (text, id, force) in [
        ("91006000ff70000008000000147bffd70af80000001101f4c36b3adc", 0x91, Some(force)),
        ("90006000ff7000000800001101f4fc6bef8e", 0x90, None),
    ] {
        assert_eq!(whole::<Stim300>(&hex(text)), stim300::Frame::Sample(with(id, force)));
        let mut again = Vec::new();
        with(id, force).encode(&mut again);
        assert_eq!(again, hex(text));
        again[3] ^= 4;
        assert!(matches!(Stim300::look(&again), Look::Damaged));
    }
}

/// Bytes with the check, as the data sheet's table has them.
const LENGTHS: [(u8, usize); 24] = [
    (0x90, 18),
    (0x91, 28),
    (0x92, 28),
    (0x93, 38),
    (0x94, 25),
    (0xA5, 42),
    (0xA6, 42),
    (0xA7, 59),
    (0xF0, 22),
    (0xF1, 32),
    (0xF2, 32),
    (0xF3, 42),
    (0xF4, 29),
    (0xF5, 46),
    (0xF6, 46),
    (0xF7, 63),
    (0x98, 22),
    (0x99, 32),
    (0x9A, 32),
    (0x9B, 42),
    (0x9C, 29),
    (0xAD, 46),
    (0xAE, 46),
    (0xAF, 63),
];

#[test]
fn stim300_datagrams_of_every_kind_come_back() {
    let cluster = |k: i32| Cluster { values: [k, -k, 2 * k], status: k as u8 };
    for (id, length) in LENGTHS {
        let has = stim300::Content::of(id).unwrap();
        let warmth = |present: bool, k| (present && has.temperature).then(|| cluster(k));
        let told = stim300::Datagram {
            id,
            gyro: cluster(1_000_000),
            acceleration: has.acceleration.then(|| cluster(-3)),
            inclination: has.inclination.then(|| cluster(7)),
            temperatures: [warmth(true, 11), warmth(has.acceleration, 12), warmth(has.inclination, 13)],
            auxiliary: has.auxiliary.then_some((8_388_607, 1)),
            counter: 255,
            latency: 65_535,
        };
        let mut bytes = Vec::new();
        told.encode(&mut bytes);
        assert_eq!(bytes.len(), length, "{id:02X}");
        assert_eq!(whole::<Stim300>(&bytes), stim300::Frame::Sample(told), "{id:02X}");
    }
    assert_eq!(stim300::Content::of(0x95), None);
}

#[test]
fn stim300_tells_its_configuration() {
    let mut data = vec![0xBC, b'F', 24, 0b1010_0000, 0, 0x71, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x40, 0, 0, 0, 0];
    let check = crc::Crc::<u32>::new(&crc::CRC_32_MPEG_2).checksum(&[&data[..], &[0, 0]].concat());
    data.extend_from_slice(&check.to_be_bytes());
    let stim300::Frame::Configuration(said) = whole::<Stim300>(&data) else { panic!("no configuration") };
    assert_eq!((said.rate_hz, said.range_g, said.gyro_unit), (None, Some(30), stim300::GyroUnit::Increment));
    assert!(!said.gyro_delayed);
}
