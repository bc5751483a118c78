//! The spike test on noisy waves: spikes go, steps stay, no pair is lost, and clean data are left alone.
#![allow(clippy::unwrap_used)]

use estimation::synchronise::{Settings, Synchroniser, Unit};
use frames::{Main, MainStart, Rot, Vec3, unit};
use messages::{Flags, ImuPair, ImuSample};
use rand::{RngExt, SeedableRng};
use rand_distr::StandardNormal;
use rand_pcg::Pcg64Mcg;
use std::f64::consts::TAU;

/// White noise of a gyro (rad) and of an accelerometer (m/s) in a sample, whatever its interval.
const GYRO: f64 = 3e-8;
const ACCEL: f64 = 1e-5;
const ARM: f64 = 14.0;
const SEEDS: std::ops::RangeInclusive<u64> = 1..=4;
/// The test has its scale by then: the first block may be cut off, the second must have ended.
const LEARNT: usize = 1024;

fn settings(interval_ns: i64, spike_threshold: f64, lever_arm_m: f64) -> Settings {
    Settings {
        area: 0,
        interval_ns,
        silence_ns: 50 * interval_ns,
        spike_threshold,
        lever_arm_m,
        main: Unit { mounting: Rot::identity(), range: None },
        sub: Unit { mounting: Rot::identity(), range: None },
    }
}

/// Attitude of the ship: waves of 10 degrees.
fn ship(t: f64) -> Rot<MainStart, Main> {
    Rot::exp(Vec3::new(0.17 * (0.785 * t).sin(), 0.17 * (0.785 * t + 0.4).sin(), 0.17 * (0.628 * t).sin()))
}

/// A unit on that ship, with white noise.
fn unit_samples(seed: u64, n: usize, interval_ns: i64) -> Vec<ImuSample> {
    let mut rng = Pcg64Mcg::seed_from_u64(seed);
    let interval_s = unit::seconds(interval_ns);
    let mut normal = |sigma: f64| sigma * rng.sample::<f64, _>(StandardNormal);
    (0..n)
        .map(|k| {
            let t = k as f64 * interval_s;
            let mut dtheta = (ship(t - interval_s).inverse() * ship(t)).log().array();
            dtheta.iter_mut().for_each(|x| *x += normal(GYRO));
            let dvel = [0.3 * t.sin(), 0.4 * (0.7 * t).sin(), 9.8].map(|f| f * interval_s + normal(ACCEL));
            let mut sample = ImuSample { interval_ns, dtheta, dvel, ..Default::default() };
            (sample.header.sequence, sample.header.time_ns) = (k as u64, k as i64 * interval_ns);
            sample
        })
        .collect()
}

const T: i64 = 10_000_000;

fn run(settings: Settings, main: &[ImuSample], sub: &[ImuSample]) -> (Vec<ImuPair>, Synchroniser) {
    let mut synchroniser = Synchroniser::new(settings);
    let mut pairs = Vec::new();
    for k in 0..main.len().max(sub.len()) {
        main.get(k).into_iter().for_each(|m| synchroniser.main(m));
        sub.get(k).into_iter().for_each(|s| synchroniser.sub(s));
        pairs.extend(std::iter::from_fn(|| synchroniser.pair()));
    }
    synchroniser.end();
    pairs.extend(std::iter::from_fn(|| synchroniser.pair()));
    (pairs, synchroniser)
}

/// The same with the usual threshold.
fn tested(main: &[ImuSample], sub: &[ImuSample]) -> Vec<ImuPair> {
    run(settings(T, 5.0, ARM), main, sub).0
}

fn untested(main: &[ImuSample], sub: &[ImuSample]) -> Vec<ImuPair> {
    run(settings(T, 0.0, ARM), main, sub).0
}

/// Adds spikes to every channel of the samples that lie beyond the first ones; gives how many to gyros.
fn strike(samples: &mut [ImuSample], seed: u64, probability: f64, sigmas: f64) -> f64 {
    let mut rng = Pcg64Mcg::seed_from_u64(1000 + seed);
    let mut count = 0.0;
    for sample in &mut samples[LEARNT..] {
        for axis in 0..3 {
            if rng.random::<f64>() < probability {
                sample.dtheta[axis] += sigmas * GYRO;
                count += 1.0;
            }
            if rng.random::<f64>() < probability {
                sample.dvel[axis] += sigmas * ACCEL;
            }
        }
    }
    count
}

fn sum(pairs: &[ImuPair], of: impl Fn(&ImuPair) -> [f64; 3]) -> f64 {
    pairs.iter().flat_map(of).sum()
}

#[test]
fn nothing_is_left_of_spikes() {
    for seed in SEEDS {
        for (probability, sigmas) in [(0.01, 50.0), (0.002, 1000.0)] {
            let (main, clean) = (unit_samples(10 + seed, 12_000, T), unit_samples(20 + seed, 12_000, T));
            let mut sub = clean.clone();
            let count = strike(&mut sub, seed, probability, sigmas);
            let (expected, raw, found) = (untested(&main, &clean), untested(&main, &sub), tested(&main, &sub));
            for of in [|p: &ImuPair| p.dtheta_s, |p: &ImuPair| p.dvel_s] {
                let harm = sum(&raw, of) - sum(&expected, of);
                let left = sum(&found, of) - sum(&expected, of);
                assert!(left.abs() < 0.02 * harm, "seed {seed}, {sigmas} sigma: {left} of {harm}");
            }
            let flagged = found.iter().filter(|p| p.flags.contains(Flags::SPIKE)).count() as f64;
            assert!(flagged > 0.97 * count, "seed {seed}: {flagged} of {count}");
            // what is left of a replaced value is as large as the pair says
            let mut ratios = Vec::new();
            for (k, axis) in (0..12_000).flat_map(|k| (0..3).map(move |axis| (k, axis))) {
                if (found[k].dtheta_s[axis] - raw[k].dtheta_s[axis]).abs() > GYRO {
                    ratios.push((found[k].dtheta_s[axis] - expected[k].dtheta_s[axis]).abs() / found[k].disturbance);
                }
            }
            ratios.sort_by(f64::total_cmp);
            let median = ratios[ratios.len() / 2];
            assert!((0.5..0.9).contains(&median), "seed {seed}, {sigmas} sigma: {median} of {}", ratios.len());
        }
    }
}

#[test]
fn a_spike_of_the_main_unit_goes_too_and_without_the_test_none_does() {
    let (mut main, sub) = (unit_samples(1, 3000, T), unit_samples(2, 3000, T));
    main[2000].dtheta[1] += 500.0 * GYRO;
    main[2500].dvel[2] += 500.0 * ACCEL;
    let (found, synchroniser) = run(settings(T, 5.0, ARM), &main, &sub);
    let raw = untested(&main, &sub);
    assert!(raw[2000].dtheta_m[1] - found[2000].dtheta_m[1] > 490.0 * GYRO);
    assert!(raw[2500].dvel_m[2] - found[2500].dvel_m[2] > 490.0 * ACCEL);
    assert_eq!(synchroniser.counts().suspect, 2);
    assert!(raw.iter().all(|p| !p.flags.contains(Flags::SPIKE) && p.disturbance == 0.0));
}

#[test]
fn two_spikes_in_a_row_go() {
    for seed in SEEDS {
        for sizes in [[1.0, 1.0], [1.0, -1.0], [1.0, 0.3]] {
            let (main, mut sub) = (unit_samples(1, 3000, T), unit_samples(seed, 3000, T));
            let clean = untested(&main, &sub);
            (0..2).for_each(|i| sub[2000 + i].dtheta[0] += 1000.0 * sizes[i] * GYRO);
            let found = tested(&main, &sub);
            for k in 2000..2002 {
                let left = found[k].dtheta_s[0] - clean[k].dtheta_s[0];
                assert!(left.abs() < 12.0 * GYRO, "seed {seed}, {sizes:?}, {k}: {} sigma", left / GYRO);
            }
        }
    }
}

/// A slam: the rate steps within the sample 2000, of which it has only the share `part`; with the lever arm, so does the velocity.
fn slam(samples: &mut [ImuSample], size: f64, part: f64) {
    let second = unit::seconds(T);
    samples[2000].dtheta[0] += part * size;
    samples[2001..].iter_mut().for_each(|s| s.dtheta[0] += size);
    samples[2000].dvel[2] += 10.0 * size / second;
}

#[test]
fn slams_pass_to_the_bit() {
    for seed in SEEDS {
        for (sigmas, part) in [(30.0, 0.5), (50.0, 1.0), (200.0, 0.5), (200.0, 0.1), (-1000.0, 0.9), (5000.0, 0.0)] {
            let (main, mut sub) = (unit_samples(1, 3000, T), unit_samples(seed, 3000, T));
            slam(&mut sub, sigmas * GYRO, part);
            let (expected, found) = (untested(&main, &sub), tested(&main, &sub));
            for k in 1990..2010 {
                assert_eq!(found[k].dtheta_s, expected[k].dtheta_s, "seed {seed}, {sigmas} sigma, {part}: {k}");
                assert_eq!(found[k].dvel_s, expected[k].dvel_s, "seed {seed}, {sigmas} sigma, {part}: {k}");
            }
        }
    }
}

/// What a flexure at the end of a lever arm adds, driven at every instant: steps of the rate of twelve deviations of the noise in a sample. At each of `kicks` it
/// is driven thirty times as strongly.
fn bend(samples: &mut [ImuSample], seed: u64, kicks: &[usize]) {
    const PARTS: usize = 5;
    let mut rng = Pcg64Mcg::seed_from_u64(2000 + seed);
    let arm = Vec3::<Main>::new(10.0, 10.0, 2.0);
    let second = unit::seconds(T);
    let mut rate = Vec3::<Main>::ZERO;
    for (k, sample) in samples.iter_mut().enumerate() {
        let strength = if kicks.contains(&k) { 30.0 } else { 1.0 };
        let (mut turn, mut gained) = (Vec3::<Main>::ZERO, Vec3::<Main>::ZERO);
        for _ in 0..PARTS {
            let size = strength * 12.0 * GYRO / (PARTS as f64).sqrt();
            let step = Vec3::from([(); 3].map(|()| size * rng.sample::<f64, _>(StandardNormal)));
            rate = rate * 0.999 + step;
            turn += rate / PARTS as f64;
            gained += step.cross(arm) / second;
        }
        for axis in 0..3 {
            sample.dtheta[axis] += turn.array()[axis];
            sample.dvel[axis] += gained.array()[axis];
        }
    }
}

/// By themselves the accelerometers are rougher than these spikes.
#[test]
fn spikes_that_hide_in_the_flexure_are_found_by_all_channels_together() {
    let mut shares = [0.0; 6];
    for seed in SEEDS {
        let (main, mut sub) = (unit_samples(10 + seed, 20_000, T), unit_samples(20 + seed, 20_000, T));
        bend(&mut sub, seed, &[]);
        let expected = untested(&main, &sub);
        strike(&mut sub, seed, 0.01, 50.0);
        let (raw, found) = (untested(&main, &sub), tested(&main, &sub));
        for (channel, share) in shares.iter_mut().enumerate() {
            let of = |p: &ImuPair| [p.dtheta_s, p.dvel_s].concat()[channel];
            let sum = |pairs: &[ImuPair]| pairs[3 * LEARNT..].iter().map(of).sum::<f64>();
            *share += (sum(&found) - sum(&expected)) / (sum(&raw) - sum(&expected)) / 4.0;
        }
    }
    // about the vertical the arm is long in both directions, and no gyro tells which of both bent
    let [gyros @ .., ahead, across, up] = shares;
    assert!(gyros.iter().chain(&[ahead, across]).all(|share| share.abs() < 0.1), "{shares:?}");
    assert!(up.abs() < 0.5, "{shares:?}");
}

/// A kick lasts for part of a sample, in which the rate goes its own way: by themselves the channels take half of such kicks for spikes.
#[test]
fn slams_pass_among_spikes_that_are_found_together() {
    let kicks: Vec<usize> = (5000..20_000).step_by(500).collect();
    let is_near = |k: usize| kicks.iter().any(|kick| kick.abs_diff(k) < 10);
    let mut altered = Vec::new();
    for seed in SEEDS {
        let (main, mut sub) = (unit_samples(10 + seed, 20_000, T), unit_samples(20 + seed, 20_000, T));
        bend(&mut sub, seed, &kicks);
        let clean = sub.clone();
        strike(&mut sub, seed, 0.01, 50.0);
        sub.iter_mut().enumerate().filter(|(k, _)| is_near(*k)).for_each(|(k, sample)| *sample = clean[k]);
        let (expected, found) = (untested(&main, &sub), tested(&main, &sub));
        let off = |k: usize, axis: usize| {
            let turn = (found[k].dtheta_s[axis] - expected[k].dtheta_s[axis]) / GYRO;
            // a difference of sums, which round
            turn.abs().max((found[k].dvel_s[axis] - expected[k].dvel_s[axis]).abs() / ACCEL) > 1e-3
        };
        let is_altered = |kick: usize| (kick - 5..kick + 5).any(|k| (0..3).any(|axis| off(k, axis)));
        altered.extend(kicks.iter().filter(|kick| is_altered(**kick)).map(|kick| (seed, *kick)));
    }
    assert!(altered.len() <= 4, "{altered:?} of 120");
}

/// What is altered stands in the past of what comes next, so that an alteration that is wrong can bring about the next one.
#[test]
fn a_step_of_one_gyro_is_not_chased() {
    for seed in SEEDS {
        let (main, mut sub) = (unit_samples(10 + seed, 20_000, T), unit_samples(20 + seed, 20_000, T));
        bend(&mut sub, seed, &[]);
        for (n, k) in (5000..20_000).step_by(1000).enumerate() {
            let end = sub.len().min(k + 1000);
            sub[k..end].iter_mut().for_each(|s| s.dtheta[n % 3] += 100.0 * GYRO);
        }
        let expected = untested(&main, &sub);
        strike(&mut sub, seed, 0.01, 50.0);
        let found = tested(&main, &sub);
        for axis in 0..3 {
            let left = |k: usize| ((found[k].dtheta_s[axis] - expected[k].dtheta_s[axis]) / GYRO).abs();
            let worst = (3 * LEARNT..19_990).map(left).fold(0.0, f64::max);
            assert!(worst < 150.0, "seed {seed}, axis {axis}: {worst}");
        }
    }
}

/// Size of a spike that a channel shows by itself on [`lurching`] data, in deviations of the noise.
const LARGE: f64 = 3e4;

/// Turns whose rate steps by three thousand deviations of the noise, and an accelerometer that goes with one of them in a proportion that swings by a tenth
/// within a minute: both together see a thousandth of what one sees, for a while.
fn lurching(seed: u64) -> Vec<ImuSample> {
    let mut samples = unit_samples(20 + seed, 20_000, T);
    let mut rng = Pcg64Mcg::seed_from_u64(3000 + seed);
    let mut rate = [0.0; 3];
    for (k, sample) in samples.iter_mut().enumerate() {
        for axis in 0..3 {
            rate[axis] = 0.999 * rate[axis] + 3000.0 * GYRO * rng.sample::<f64, _>(StandardNormal);
            sample.dtheta[axis] += rate[axis];
        }
        let swing = 1.0 + 0.1 * (TAU * k as f64 * unit::seconds(T) / 60.0).sin();
        sample.dvel[1] += swing * ACCEL / GYRO * rate[0];
    }
    samples
}

/// The spikes end, and what was learnt among them is asked on. What it alters wrongly must not make the next sample look wrong.
#[test]
fn what_was_learnt_and_holds_no_more_brings_no_chase_about() {
    const END: usize = 8000;
    for seed in SEEDS {
        let (main, mut sub) = (unit_samples(10 + seed, 20_000, T), lurching(seed));
        let calm = sub[END..].to_vec();
        strike(&mut sub, seed, 0.01, LARGE);
        sub[END..].copy_from_slice(&calm);
        let (raw, found) = (untested(&main, &sub), tested(&main, &sub));
        for axis in 0..3 {
            let altered = (END..19_990).scan(0.0, |sum, k| {
                *sum += found[k].dtheta_s[axis] - raw[k].dtheta_s[axis];
                Some(sum.abs() / GYRO)
            });
            let worst = altered.fold(0.0, f64::max);
            assert!(worst < LARGE, "seed {seed}, axis {axis}: {worst}");
        }
    }
}

#[test]
fn three_spikes_are_no_reason_to_ask_all_channels() {
    const SPIKES: [usize; 3] = [5100, 5200, 5300];
    for seed in SEEDS {
        let (main, mut sub) = (unit_samples(10 + seed, 20_000, T), lurching(seed));
        let expected = untested(&main, &sub);
        SPIKES.into_iter().for_each(|k| sub[k].dtheta[1] += LARGE * GYRO);
        let found = tested(&main, &sub);
        let off = |k: &usize, axis: usize| {
            let turn = (found[*k].dtheta_s[axis] - expected[*k].dtheta_s[axis]) / GYRO;
            turn.abs().max((found[*k].dvel_s[axis] - expected[*k].dvel_s[axis]).abs() / ACCEL) > 1.0
        };
        let altered: Vec<usize> = (LEARNT..19_990).filter(|k| (0..3).any(|axis| off(k, axis))).collect();
        assert_eq!(altered, SPIKES, "seed {seed}");
    }
}

#[test]
fn without_a_lever_arm_nothing_explains_the_slam() {
    let (main, mut sub) = (unit_samples(1, 3000, T), unit_samples(2, 3000, T));
    slam(&mut sub, 200.0 * GYRO, 0.5);
    let (found, _) = run(settings(T, 5.0, 0.0), &main, &sub);
    assert!(untested(&main, &sub)[2000].dvel_s[2] - found[2000].dvel_s[2] > 0.9 * 2000.0 * GYRO / unit::seconds(T));
}

#[test]
fn each_main_sample_has_one_pair_in_order_and_at_most_two_samples_late() {
    for seed in SEEDS {
        let (mut main, mut sub) = (unit_samples(10 + seed, 8000, T), unit_samples(20 + seed, 8000, T));
        strike(&mut main, 50 + seed, 0.003, 300.0);
        strike(&mut sub, seed, 0.01, 50.0);
        let mut synchroniser = Synchroniser::new(settings(T, 5.0, ARM));
        let mut next = 0;
        for k in 0..8000 {
            synchroniser.main(&main[k]);
            synchroniser.sub(&sub[k]);
            while let Some(pair) = synchroniser.pair() {
                assert_eq!(pair.header.sequence, next, "seed {seed}");
                assert!(!pair.flags.contains(Flags::GAP));
                next += 1;
            }
            assert!(next as usize + 2 > k, "seed {seed}: pair {next} still waits at {k}");
        }
        synchroniser.end();
        assert_eq!(next + std::iter::from_fn(|| synchroniser.pair()).count() as u64, 8000, "seed {seed}");
    }
}

#[test]
fn clean_data_are_left_alone_and_rarely_wait() {
    let (mut alarms, mut late, mut all) = (0, 0, 0);
    for seed in SEEDS {
        let (main, sub) = (unit_samples(10 + seed, 60_000, T), unit_samples(20 + seed, 60_000, T));
        let mut synchroniser = Synchroniser::new(settings(T, 5.0, ARM));
        for k in 0..main.len() {
            synchroniser.main(&main[k]);
            synchroniser.sub(&sub[k]);
            let mut newest = None;
            while let Some(pair) = synchroniser.pair() {
                alarms += u64::from(pair.flags.contains(Flags::SPIKE));
                newest = Some(pair.header.sequence);
            }
            late += u64::from(newest != Some(k as u64));
            all += 1;
        }
    }
    // 12 channels a pair; of a normal variable 6e-7 lie beyond 5
    assert!((alarms as f64) < 4e-6 * 12.0 * all as f64, "{alarms} alarms of {all} pairs");
    assert!((late as f64) < 0.01 * all as f64, "{late} of {all} pairs had to wait");
}

#[test]
fn swell_hides_no_spike_at_ten_hertz_and_is_none() {
    let slow = 10 * T;
    let mut alarms = 0;
    for seed in SEEDS {
        let (main, mut sub) = (unit_samples(1, 6000, slow), unit_samples(seed, 6000, slow));
        let (clean, _) = run(settings(slow, 5.0, ARM), &main, &sub);
        alarms += clean.iter().filter(|p| p.flags.contains(Flags::SPIKE)).count();
        (2000..6000).step_by(50).for_each(|k| sub[k].dtheta[k / 50 % 3] += 1000.0 * GYRO);
        let (found, _) = run(settings(slow, 5.0, ARM), &main, &sub);
        let left = sum(&found, |p| p.dtheta_s) - sum(&clean, |p| p.dtheta_s);
        assert!(left.abs() < 0.02 * 80.0 * 1000.0 * GYRO, "seed {seed}: {} sigma", left / GYRO);
    }
    // the same rate as at a hundred hertz
    assert!((alarms as f64) < 4e-6 * 12.0 * 24_000.0, "{alarms} alarms");
}

#[test]
fn nothing_is_compared_across_a_hole() {
    let mut alarms = 0;
    for seed in SEEDS {
        let (main, sub) = (unit_samples(10 + seed, 6000, T), unit_samples(20 + seed, 6000, T));
        let sub: Vec<_> = sub.into_iter().filter(|s| s.header.sequence % 50 != 7).collect();
        let (pairs, synchroniser) = run(settings(T, 5.0, ARM), &main, &sub);
        assert_eq!(synchroniser.counts().missing, 120);
        assert!(pairs.iter().all(|p| !p.flags.contains(Flags::GAP)));
        alarms += pairs.iter().filter(|p| p.flags.contains(Flags::SPIKE)).count();
    }
    // of 480 holes
    assert!((alarms as f64) < 4e-6 * 12.0 * 24_000.0, "{alarms} alarms");
}

/// What is integrated first stands in all that comes after.
#[test]
fn a_spike_of_the_first_second_is_found() {
    for seed in SEEDS {
        let (main, mut sub) = (unit_samples(1, 400, T), unit_samples(seed, 400, T));
        let (clean, _) = run(settings(T, 5.0, ARM), &main, &sub);
        (60..400).step_by(20).for_each(|k| sub[k].dtheta[k / 20 % 3] += 1000.0 * GYRO);
        let (found, _) = run(settings(T, 5.0, ARM), &main, &sub);
        let left = sum(&found, |p| p.dtheta_s) - sum(&clean, |p| p.dtheta_s);
        assert!(left.abs() < 0.02 * 17.0 * 1000.0 * GYRO, "seed {seed}: {} sigma", left / GYRO);
    }
}

#[test]
fn whoever_joins_a_few_samples_later_judges_alike() {
    for seed in SEEDS {
        let (main, mut sub) = (unit_samples(10 + seed, 9000, T), unit_samples(20 + seed, 9000, T));
        strike(&mut sub, seed, 0.01, 50.0);
        let from = |n: usize| run(settings(T, 5.0, ARM), &main[3020..], &sub[n..]).0;
        assert!(from(3010) == from(3020), "seed {seed}");
    }
}

/// Takes the fine steps off a channel.
fn coarse(x: &mut f64, step: f64) {
    *x = (*x / step).round() * step;
}

#[test]
fn a_dead_accelerometer_is_said_and_the_gyros_go_on() {
    for seed in SEEDS {
        let (main, mut sub) = (unit_samples(1, 4000, T), unit_samples(seed, 4000, T));
        let value = sub[1999].dvel[1];
        sub[2000..3000].iter_mut().for_each(|s| s.dvel[1] = value);
        let (pairs, synchroniser) = run(settings(T, 5.0, ARM), &main, &sub);
        let said: Vec<_> = (0..4000).filter(|&k| pairs[k].flags.contains(Flags::ACCEL_STUCK)).collect();
        assert!(said[0] < 2030 && said.len() > 950 && *said.last().unwrap() == 2999, "seed {seed}: {said:?}");
        assert!(synchroniser.counts().suspect >= said.len() as u64);
        assert!(pairs.iter().all(|p| !p.flags.intersects(Flags::GAP | Flags::STUCK)));
    }
}

#[test]
fn a_coarse_unit_is_not_stuck_until_it_is() {
    for seed in SEEDS {
        let (main, mut sub) = (unit_samples(1, 12_000, T), unit_samples(seed, 12_000, T));
        // at rest, all but a few values in a hundred of one gyro and one accelerometer are the same
        sub.iter_mut().zip(unit_samples(30 + seed, 12_000, 1)).for_each(|(s, rest)| {
            (s.dtheta[2], s.dvel[0]) = (rest.dtheta[2], rest.dvel[0]);
            coarse(&mut s.dtheta[2], 4.0 * GYRO);
            coarse(&mut s.dvel[0], 4.0 * ACCEL);
        });
        let stuck = |pairs: &[ImuPair]| {
            pairs.iter().filter(|p| p.flags.intersects(Flags::STUCK | Flags::ACCEL_STUCK | Flags::GAP)).count()
        };
        assert_eq!(stuck(&tested(&main, &sub)), 0, "seed {seed}");
        let value = sub[5999].dtheta[2];
        sub[6000..8000].iter_mut().for_each(|s| s.dtheta[2] = value);
        let pairs = tested(&main, &sub);
        assert!(stuck(&pairs[6000..8000]) > 1000 && stuck(&pairs[8010..]) == 0, "seed {seed}");
    }
}
