//! The synchroniser on analytic motion: interpolation, order, holes, silence, restarts.
#![allow(clippy::unwrap_used)]

use estimation::synchronise::{Settings, Synchroniser, Unit};
use frames::{Main, MainStart, Rot, Sub, SubStart, Vec3, unit};
use messages::{Flags, ImuPair, ImuSample, MainAttitude};
use proptest::prelude::*;

const T: i64 = 10_000_000;

fn settings() -> Settings {
    Settings {
        area: 0,
        interval_ns: T,
        silence_ns: 500_000_000,
        spike_threshold: 5.0,
        lever_arm_m: 0.0,
        main: Unit { mounting: Rot::identity(), range: Some(30.0) },
        sub: Unit { mounting: Rot::identity(), range: Some(30.0) },
    }
}

/// Attitude of the ship at the time t: waves of 10 degrees.
fn ship(t: f64) -> Rot<MainStart, Main> {
    Rot::exp(Vec3::new(0.17 * (0.785 * t).sin(), 0.17 * (0.785 * t + 0.4).sin(), 0.17 * (0.628 * t).sin()))
}

/// The sample whose interval ends at `time_ns`; both units feel the same ship.
fn sample(sequence: u64, time_ns: i64) -> ImuSample {
    let t = unit::seconds(time_ns);
    let dtheta = (ship(t - unit::seconds(T)).inverse() * ship(t)).log();
    let mut sample =
        ImuSample { interval_ns: T, dtheta: dtheta.array(), dvel: [0.0, 0.0, 0.098], ..Default::default() };
    (sample.header.sequence, sample.header.time_ns) = (sequence, time_ns);
    sample
}

fn main_samples(n: u64) -> Vec<ImuSample> {
    (0..n).map(|k| sample(k, k as i64 * T)).collect()
}

/// Samples of a sub unit that takes them `phase_ns` after the main unit.
fn sub_samples(n: u64, phase_ns: i64) -> Vec<ImuSample> {
    (0..n).map(|k| sample(k, k as i64 * T + phase_ns)).collect()
}

fn run(main: &[ImuSample], sub: &[ImuSample]) -> (Vec<ImuPair>, Synchroniser) {
    let mut synchroniser = Synchroniser::new(settings());
    let mut pairs = Vec::new();
    let mut sub = sub.iter().peekable();
    for m in main {
        synchroniser.main(m);
        while let Some(s) = sub.next_if(|s| s.header.time_ns <= m.header.time_ns) {
            synchroniser.sub(s);
        }
        while let Some(pair) = synchroniser.pair() {
            pairs.push(pair);
        }
    }
    sub.for_each(|s| synchroniser.sub(s));
    synchroniser.end();
    while let Some(pair) = synchroniser.pair() {
        pairs.push(pair);
    }
    (pairs, synchroniser)
}

/// Largest distance between the relative turn of both units since the first good pair, which is none for a rigid ship.
fn false_deformation(pairs: &[ImuPair]) -> f64 {
    let good: Vec<_> = pairs.iter().filter(|p| !p.flags.contains(Flags::GAP)).collect();
    let relation = |p: &ImuPair| {
        let a_m = Rot::<MainStart, Main>::from_wxyz(p.attitude_m);
        let a_s = Rot::<SubStart, Sub>::from_wxyz(p.attitude_s);
        a_m * Rot::<Main, Sub>::identity() * a_s.inverse()
    };
    good.iter().map(|p| (relation(p) * relation(good[0]).inverse()).log().norm()).fold(0.0, f64::max)
}

#[test]
fn equal_instants_are_paired_at_once_and_exactly() {
    let mut synchroniser = Synchroniser::new(settings());
    for (m, s) in main_samples(300).iter().zip(&sub_samples(300, 0)) {
        synchroniser.main(m);
        assert!(synchroniser.pair().is_none());
        synchroniser.sub(s);
        let pair = synchroniser.pair().expect("no look-ahead is needed");
        assert_eq!(pair.header.sequence, m.header.sequence);
        assert_eq!(pair.attitude_m, pair.attitude_s);
        assert!(!pair.flags.contains(Flags::INTERPOLATED));
    }
}

#[test]
fn a_stamp_within_a_hundredth_needs_no_look_ahead() {
    let (pairs, _) = run(&main_samples(500), &sub_samples(500, 90_000));
    assert!(pairs.iter().all(|p| !p.flags.contains(Flags::INTERPOLATED)));
    assert!(false_deformation(&pairs) < 1e-7, "{}", false_deformation(&pairs));
}

#[test]
fn four_points_leave_nothing_of_a_ships_motion() {
    let (pairs, _) = run(&main_samples(1000), &sub_samples(1002, 4_700_000));
    let interpolated = pairs.iter().filter(|p| p.flags.contains(Flags::INTERPOLATED)).count();
    assert!(interpolated > 990, "{interpolated}");
    let error = false_deformation(&pairs) / unit::ARCSEC;
    assert!(error < 1e-4, "{error} arcsec");
}

#[test]
fn increments_are_preserved() {
    let (pairs, _) = run(&main_samples(1000), &sub_samples(1002, 3_300_000));
    let good: Vec<_> = pairs.iter().filter(|p| !p.flags.contains(Flags::GAP)).collect();
    let mut composed = Rot::<SubStart, Sub>::from_wxyz(good[0].attitude_s);
    for pair in &good[1..] {
        composed = composed * Rot::<Sub, Sub>::exp(pair.dtheta_s.into());
    }
    let last = Rot::<SubStart, Sub>::from_wxyz(good.last().unwrap().attitude_s);
    assert!((composed.inverse() * last).log().norm() < 1e-12);
}

#[test]
fn repeats_and_swaps_change_nothing() {
    let main = main_samples(400);
    let clean = sub_samples(402, 3_000_000);
    let mut messy = clean.clone();
    messy.swap(100, 101);
    messy.swap(200, 202);
    messy.insert(50, messy[49]);
    messy.insert(300, messy[290]);
    let (expected, _) = run(&main, &clean);
    let (found, synchroniser) = run(&main, &messy);
    assert_eq!(found, expected);
    assert_eq!(synchroniser.counts().refused, 2);
    assert_eq!(synchroniser.counts().missing, 0);
}

#[test]
fn short_holes_are_bridged_and_said() {
    let main = main_samples(6000);
    let sub: Vec<_> = sub_samples(6002, 0).into_iter().filter(|s| s.header.sequence % 100 != 57).collect();
    let (pairs, synchroniser) = run(&main, &sub);
    assert_eq!(synchroniser.counts().missing, 60);
    assert_eq!(pairs.len(), 6000);
    assert!(pairs.iter().all(|p| !p.flags.contains(Flags::GAP)));
    assert!(pairs.iter().filter(|p| p.flags.contains(Flags::BRIDGED)).count() >= 60);
    let (error, told) = (false_deformation(&pairs), pairs.iter().map(|p| p.disturbance.powi(2)).sum::<f64>().sqrt());
    assert!(error / unit::ARCSEC < 0.5, "{} arcsec", error / unit::ARCSEC);
    assert!(error < 4.0 * told, "told {} arcsec", told / unit::ARCSEC);
}

#[test]
fn a_long_hole_starts_a_new_epoch() {
    let sub: Vec<_> = sub_samples(1002, 0).into_iter().filter(|s| !(300..400).contains(&s.header.sequence)).collect();
    let (pairs, _) = run(&main_samples(1000), &sub);
    assert_eq!(pairs.len(), 1000);
    let gaps: Vec<_> = pairs.iter().filter(|p| p.flags.contains(Flags::GAP)).map(|p| p.header.sequence).collect();
    assert_eq!(gaps, (300..400).collect::<Vec<_>>());
    let epochs: Vec<_> =
        pairs.iter().filter(|p| p.flags.contains(Flags::NEW_EPOCH)).map(|p| p.header.sequence).collect();
    assert_eq!(epochs, [0, 400]);
}

#[test]
fn silence_is_declared_by_main_data_and_ends() {
    let mut synchroniser = Synchroniser::new(settings());
    let (main, sub) = (main_samples(300), sub_samples(300, 0));
    let mut pairs = Vec::new();
    for k in 0..300 {
        synchroniser.main(&main[k]);
        if !(100..220).contains(&k) {
            synchroniser.sub(&sub[k]);
        }
        while let Some(pair) = synchroniser.pair() {
            pairs.push(pair);
        }
    }
    assert_eq!(pairs.len(), 300);
    assert!(pairs[100].flags.contains(Flags::SILENT | Flags::GAP));
    assert!(pairs[150].flags.contains(Flags::SILENT));
    assert!(!pairs[299].flags.contains(Flags::GAP));
}

#[test]
fn numbers_that_are_none_are_survived() {
    let mut main = main_samples(500);
    let mut sub = sub_samples(500, 0);
    main[100].dtheta[1] = f64::NAN;
    sub[200].dvel[0] = f64::INFINITY;
    let (pairs, synchroniser) = run(&main, &sub);
    assert_eq!(pairs.len(), 500);
    assert!(pairs[100].flags.contains(Flags::GAP | Flags::NOT_FINITE));
    assert!(pairs[101].flags.contains(Flags::BRIDGED));
    assert!(!pairs[101].flags.contains(Flags::NEW_EPOCH));
    assert_eq!(synchroniser.counts().refused, 2);
    assert!(false_deformation(&pairs) / unit::ARCSEC < 0.1);
}

#[test]
fn a_stuck_channel_is_a_gap_until_it_moves() {
    let mut sub = sub_samples(600, 0);
    let value = sub[199].dtheta[2];
    (200..300).for_each(|k| sub[k].dtheta[2] = value);
    let (pairs, synchroniser) = run(&main_samples(600), &sub);
    assert!(synchroniser.counts().suspect > 70);
    assert!(pairs[250].flags.contains(Flags::GAP));
    assert!(!pairs[310].flags.contains(Flags::GAP));
}

#[test]
fn a_clock_that_jumps_back_is_survived() {
    let mut sub = sub_samples(600, 0);
    sub[200].header.time_ns -= 3 * T;
    sub[300..].iter_mut().for_each(|s| s.header.time_ns -= 500 * T);
    let (pairs, synchroniser) = run(&main_samples(600), &sub);
    assert_eq!(pairs.len(), 600);
    assert_eq!(synchroniser.counts().refused, 1);
    assert!(pairs[201].flags.contains(Flags::TIME_BACK));
    assert!(pairs[400].flags.contains(Flags::GAP), "the stamps no longer agree");
}

#[test]
fn a_synchroniser_that_starts_later_gives_the_same_increments() {
    let (main, sub) = (main_samples(800), sub_samples(802, 3_000_000));
    let cut = |n: usize| run(&main[400..], &sub[n..]).0;
    // whatever the sub unit's first sample was, the bits of the new epoch are the same
    let (a, b) = (cut(0), cut(395));
    assert_eq!(a, b);
    assert!(a[0].flags.contains(Flags::NEW_EPOCH) && a[0].epoch == 400);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn arrival_order_of_the_two_streams_changes_no_bit(phase in 0..T, chunk in 1usize..40) {
        let (main, sub) = (main_samples(200), sub_samples(203, phase));
        let (expected, _) = run(&main, &sub);
        let mut synchroniser = Synchroniser::new(settings());
        let mut found = Vec::new();
        for (m, s) in main.chunks(chunk).zip(sub.chunks(chunk)) {
            s.iter().for_each(|s| synchroniser.sub(s));
            m.iter().for_each(|m| synchroniser.main(m));
            while let Some(pair) = synchroniser.pair() { found.push(pair); }
        }
        sub[200.min(sub.len())..].iter().for_each(|s| synchroniser.sub(s));
        synchroniser.end();
        while let Some(pair) = synchroniser.pair() { found.push(pair); }
        prop_assert_eq!(found, expected);
    }

    #[test]
    fn whatever_comes_is_survived(times in prop::collection::vec(-1_000_000_000i64..3_000_000_000, 1..80),
                                  numbers in prop::collection::vec(0u64..100, 1..80)) {
        let mut synchroniser = Synchroniser::new(settings());
        for (k, (&time, &number)) in times.iter().zip(&numbers).enumerate() {
            let mut s = sample(number, time);
            if k % 7 == 3 { s.dtheta[k % 3] = f64::NAN; }
            if k % 2 == 0 { synchroniser.main(&s) } else { synchroniser.sub(&s) }
            while synchroniser.pair().is_some() {}
        }
        synchroniser.end();
        while synchroniser.pair().is_some() {}
    }
}

#[test]
fn attitudes_wait_for_their_samples_however_many_come_at_once() {
    let mut synchroniser = Synchroniser::new(settings());
    for k in 0..1000 {
        let mut attitude = MainAttitude { q: [1.0, 0.0, 0.0, 0.0], ..Default::default() };
        attitude.header.sequence = k;
        synchroniser.attitude(&attitude);
    }
    for (m, s) in main_samples(1000).iter().zip(&sub_samples(1000, 0)) {
        synchroniser.main(m);
        synchroniser.sub(s);
        assert_eq!(synchroniser.pair().unwrap().ins, [1.0, 0.0, 0.0, 0.0]);
    }
}
