//! Any bytes are survived, and the next good frame is found.
#![allow(clippy::unwrap_used)]

use proptest::prelude::*;
use wire::kvh::{Extra, Inertial, Kvh};
use wire::stdbin::{Stdbin, Telegram};
use wire::stim300::{Cluster, Datagram, Stim300};
use wire::{Detector, Family, Framer, Protocol};

fn kvh() -> Vec<Vec<u8>> {
    let extras = [
        Extra::Plain { temperature: 20 },
        Extra::Stamped { microseconds: 7, temperature: 20 },
        Extra::Slow { value: 1.5 },
    ];
    let frame = |extra| Inertial { rotation: [1e-5; 3], acceleration: [1.0; 3], extra, status: 0x77, sequence: 3 };
    let mut frames: Vec<_> = extras.map(|extra| encoded(|out| frame(extra).encode(out))).to_vec();
    frames.push(vec![0xFE, 0x81, 0, 0xAA, 0x7F, 0x7F, 0x7F, 0x7F, 0x7F, 0x7F, 0x23]);
    frames
}

fn stdbin() -> Vec<Vec<u8>> {
    let of = |version, rotation| Telegram {
        version,
        attitude: Some([10.0, 1.0, 2.0]),
        acceleration: Some([0.0, 0.0, 9.8]),
        rotation,
        time: 17,
        ..Telegram::default()
    };
    let made = [of(2, None), of(3, Some([1.0; 3])), of(4, Some([1.0; 3])), of(5, Some([1.0; 3]))];
    let mut frames: Vec<_> = made.iter().map(|telegram| encoded(|out| telegram.encode(out))).collect();
    frames.push(include_bytes!("data/stdbin/log_STDBIN_V2.log").to_vec());
    frames.push(include_bytes!("data/stdbin/log_STDBIN_V3.log")[..729].to_vec());
    frames
}

fn stim300() -> Vec<Vec<u8>> {
    let cluster = Some(Cluster { values: [77, -5, 123_456], status: 0 });
    let small = Datagram { id: 0x91, acceleration: cluster, counter: 9, ..Datagram::default() };
    let large =
        Datagram { id: 0xF7, inclination: cluster, temperatures: [cluster; 3], auxiliary: Some((5, 0)), ..small };
    let ended = [encoded(|out| small.encode(out)), b"\r\n".to_vec()].concat();
    vec![encoded(|out| small.encode(out)), encoded(|out| large.encode(out)), ended]
}

fn encoded(encode: impl Fn(&mut Vec<u8>)) -> Vec<u8> {
    let mut out = Vec::new();
    encode(&mut out);
    out
}

fn all<P: Protocol>(framer: &mut Framer<P>) -> Vec<String> {
    std::iter::from_fn(|| framer.next_frame()).map(|frame| format!("{frame:?}")).collect()
}

/// What `frame` is read as when it stands alone.
fn alone<P: Protocol>(frame: &[u8]) -> String {
    let mut framer = Framer::<P>::default();
    framer.push(frame);
    let frames = all(&mut framer);
    assert_eq!((frames.len(), framer.counts().skipped), (1, 0));
    frames[0].clone()
}

/// Good frames for the framer to see through a false promise of a long one.
fn tail<P: Protocol>(frame: &[u8]) -> Vec<u8> {
    frame.repeat(2 + P::LONGEST / frame.len())
}

fn survives_garbage<P: Protocol>(frames: &[Vec<u8>], mut seed: u64) {
    let mut framer = Framer::<P>::default();
    let mut random = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 56) as u8
    };
    for _ in 0..1000 {
        framer.push(&std::iter::repeat_with(&mut random).take(1000).collect::<Vec<u8>>());
        while framer.next_frame().is_some() {}
    }
    assert!(framer.counts().skipped > 990_000);
    for frame in frames {
        framer.push(&tail::<P>(frame));
        let found = all(&mut framer);
        let expected = 2 + P::LONGEST / frame.len();
        assert_eq!(found, vec![alone::<P>(frame); expected]);
    }
}

#[test]
fn a_million_random_bytes() {
    for seed in 1..=2 {
        survives_garbage::<Kvh>(&kvh(), seed);
        survives_garbage::<Stdbin>(&stdbin(), seed);
        survives_garbage::<Stim300>(&stim300(), seed);
    }
}

fn survives_truncation<P: Protocol>(frames: &[Vec<u8>]) {
    for cut in frames {
        for length in 0..cut.len() {
            for frame in frames {
                let mut framer = Framer::<P>::default();
                framer.push(&cut[..length]);
                let before = all(&mut framer).len();
                framer.push(&tail::<P>(frame));
                let found = all(&mut framer);
                let wanted = alone::<P>(frame);
                let good = found.iter().filter(|found| **found == wanted).count();
                // a cut line end completes a frame that stands before it
                assert_eq!(good, 2 + P::LONGEST / frame.len(), "{length} of {} bytes, {before} before", cut.len());
            }
        }
    }
}

#[test]
fn every_truncation_of_every_frame() {
    survives_truncation::<Kvh>(&kvh());
    survives_truncation::<Stdbin>(&stdbin());
    survives_truncation::<Stim300>(&stim300());
}

#[test]
fn a_stream_is_known_by_its_frames() {
    for (frames, family) in [(kvh(), Family::Kvh), (stdbin(), Family::Stdbin), (stim300(), Family::Stim300)] {
        let mut detector = Detector::default();
        detector.push(&[0xFE, b'I', 0x91, 3, 4]);
        assert_eq!(detector.found(), None);
        for frame in &frames {
            detector.push(&tail::<Stdbin>(frame));
        }
        assert_eq!(detector.found(), Some(family));
    }
}

fn bitten<P: Protocol>(frame: &[u8], place: usize, bit: u8) {
    let mut bytes = frame.to_vec();
    let place = place % bytes.len();
    bytes[place] ^= 1 << bit;
    let mut framer = Framer::<P>::default();
    framer.push(&[&bytes[..], &tail::<P>(frame)].concat());
    let found = all(&mut framer);
    assert!(found.iter().all(|found| *found == alone::<P>(frame)), "a wrong bit was let through");
    assert_eq!(found.len(), 2 + P::LONGEST / frame.len());
}

proptest! {
    #[test]
    fn a_wrong_bit_is_never_let_through(index in 0..100usize, place in 0..4000usize, bit in 0..8u8) {
        let pick = |frames: Vec<Vec<u8>>| frames[index % frames.len()].clone();
        bitten::<Kvh>(&pick(kvh()), place, bit);
        bitten::<Stdbin>(&pick(stdbin()), place, bit);
        let plain = &stim300()[index % 2];
        bitten::<Stim300>(plain, place, bit);
    }

    /// However the stream is cut into pieces, it says the same.
    #[test]
    fn pieces_make_the_whole(pieces in prop::collection::vec(1..60usize, 1..40), garbage in prop::collection::vec(any::<u8>(), 0..50)) {
        let stream = [garbage, kvh().concat(), kvh().concat()].concat();
        let mut whole = Framer::<Kvh>::default();
        whole.push(&stream);
        let expected = all(&mut whole);
        let mut framer = Framer::<Kvh>::default();
        let (mut found, mut rest) = (Vec::new(), &stream[..]);
        for piece in pieces.iter().cycle() {
            let (head, tail) = rest.split_at((*piece).min(rest.len()));
            framer.push(head);
            found.extend(all(&mut framer));
            rest = tail;
            if rest.is_empty() {
                break;
            }
        }
        prop_assert_eq!(found, expected);
        prop_assert_eq!(framer.counts(), whole.counts());
    }
}
