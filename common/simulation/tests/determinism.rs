//! The same scenario gives the same bits, and one part's randomness never moves another's.
#![allow(clippy::unwrap_used)]

use simulation::*;

fn run(scenario: &Scenario) -> Vec<Epoch> {
    let mut simulator = Simulator::new(scenario);
    let mut epochs = Vec::new();
    while let Some(epoch) = simulator.step() {
        epochs.push(epoch.clone());
    }
    epochs
}

fn demo(seed: u64) -> Scenario {
    Scenario { seed, duration_s: Some(5.0), ..Scenario::default() }
}

const ROUGH: Wire = Wire {
    delay_s: 0.01,
    skew: 1e-4,
    jitter_s: 1e-4,
    phase_s: 0.0,
    rate_error: 0.0,
    loss: 0.1,
    duplicate: 0.1,
    swap: 0.1,
    transit_s: 0.02,
};

#[test]
fn the_seed_decides_everything() {
    for seed in [0, 1, u64::MAX] {
        let mut scenario = demo(seed);
        scenario.areas[0].wire = Wire { rate_error: 1e-3, ..ROUGH };
        let first = run(&scenario);
        assert_eq!(first, run(&scenario));
        let other = run(&Scenario { seed: seed ^ 1, ..scenario });
        assert_eq!(first.len(), other.len());
        for (a, b) in first.iter().zip(&other) {
            assert_ne!(a.main.dtheta, b.main.dtheta);
            assert_ne!(a.truth[0].dynamic, b.truth[0].dynamic);
            assert_ne!(a.attitude.q, b.attitude.q);
            assert_eq!(a.truth[0].ship, b.truth[0].ship);
        }
    }
}

#[test]
fn a_run_of_another_length_begins_alike() {
    let (short, long) = (run(&demo(3)), run(&Scenario { duration_s: Some(9.0), ..demo(3) }));
    assert_eq!((short.len(), long.len()), (501, 901));
    assert_eq!(short[..], long[..501]);
}

#[test]
fn the_wire_changes_neither_the_main_stream_nor_the_truth() {
    let plain = demo(4);
    let mut rough = plain.clone();
    rough.areas[0].wire = ROUGH;
    let (plain, rough) = (run(&plain), run(&rough));
    for (a, b) in plain.iter().zip(&rough) {
        assert_eq!((&a.main, &a.attitude, &a.truth), (&b.main, &b.attitude, &b.truth));
    }
    let sent: Vec<_> = plain.iter().flat_map(|epoch| &epoch.sub).collect();
    for sample in rough.iter().flat_map(|epoch| &epoch.sub) {
        let true_sample = sent[sample.header.sequence as usize];
        assert_eq!((sample.dtheta, sample.dvel), (true_sample.dtheta, true_sample.dvel));
    }
}

#[test]
fn another_area_changes_nothing_for_the_first() {
    let one = demo(5);
    let mut two = one.clone();
    two.areas.push(Area { wire: ROUGH, ..Area::default() });
    for (a, b) in run(&one).iter().zip(&run(&two)) {
        assert_eq!((&a.main, &a.attitude, a.truth[0]), (&b.main, &b.attitude, b.truth[0]));
        let first: Vec<_> = b.sub.iter().filter(|sample| sample.unit == 1).copied().collect();
        assert_eq!(a.sub, first);
        assert_eq!((b.truth.len(), b.truth[1].area), (2, 1));
        assert_ne!(b.truth[0].dynamic, b.truth[1].dynamic);
    }
}

#[test]
fn headers_say_where_a_message_belongs() {
    let scenario = Scenario { run_id: 77, ..demo(6) };
    for (k, epoch) in (0..).zip(run(&scenario)) {
        let header = epoch.main.header;
        assert_eq!((header.run_id, header.sequence, header.clock_domain, header.end), (77, k, 0, 0));
        assert_eq!(header.stamps, messages::Stamps::default());
        assert_eq!((epoch.attitude.header, epoch.truth[0].header, epoch.main.unit), (header, header, 0));
        assert_eq!((epoch.sub[0].header, epoch.sub[0].unit), (header, 1));
    }
}

#[test]
fn impossible_scenarios_end_at_once() {
    for rate_hz in [0.0, -100.0, f64::NAN, f64::INFINITY] {
        assert!(Simulator::new(&Scenario { rate_hz, ..demo(1) }).step().is_none());
        assert!(Simulator::new(&Scenario { rate_hz, duration_s: None, ..demo(1) }).step().is_none());
    }
    assert!(Simulator::new(&Scenario { duration_s: Some(-1.0), ..demo(1) }).step().is_none());
    for rate_error in [-1.0, -2.0, f64::NAN] {
        let mut scenario = demo(1);
        scenario.areas[0].wire.rate_error = rate_error;
        let epochs = run(&scenario);
        assert!(epochs.len() == 501 && epochs.iter().all(|epoch| epoch.sub.is_empty() && epoch.truth.len() == 1));
    }
}

/// Checksum of all numbers of a run (FNV-1a over the bits).
fn checksum(scenario: &Scenario) -> u64 {
    run(scenario).iter().fold(0xcbf2_9ce4_8422_2325, |sum, epoch| {
        let units = std::iter::once(&epoch.main).chain(&epoch.sub).flat_map(|s| s.dtheta.into_iter().chain(s.dvel));
        let truth = epoch.truth.iter().flat_map(|t| t.q.into_iter().chain(t.static_q).chain(t.dynamic).chain(t.ship));
        units.chain(truth).chain(epoch.attitude.q).fold(sum, |sum, number: f64| {
            number
                .to_bits()
                .to_le_bytes()
                .iter()
                .fold(sum, |sum, byte| (sum ^ u64::from(*byte)).wrapping_mul(0x100_0000_01b3))
        })
    })
}

/// What is added to the simulator must not move what was there.
#[test]
fn the_demonstration_keeps_its_bits() {
    let mut rough = demo(2);
    rough.areas[0].wire = Wire { phase_s: 0.003, rate_error: 1e-3, ..ROUGH };
    rough.ship.velocity_follows_heading = true;
    assert_eq!([checksum(&demo(1)), checksum(&rough)], [3_836_885_592_862_173_388, 12_709_470_766_344_004_344]);
}
