//! What holds for every identifier, whatever its method.
#![allow(clippy::unwrap_used)]

mod identify_scene;

use estimation::Identifier;
use estimation::flexure::Flexure;
use estimation::identify::{Fixed, Kind, Method, Series, Settings, Windowed, identify_axis};
use identify_scene::{Scene, under_damped};
use messages::{FlexureParams, ImuPair, Solution};
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64;

fn settings(method: Method, safety: bool) -> Settings {
    Settings { window_s: 60.0, period_s: 20.0, minimum_s: 40.0, method, safety, ..Settings::default() }
}

/// What an identifier gives in 85 s of a scene whose messages are changed by `spoil`.
fn sets(identifier: &mut dyn Identifier, seed: u64, spoil: fn(&mut ImuPair, &mut Solution)) -> Vec<FlexureParams> {
    let mut run = Scene::new(under_damped(), seed).run();
    let mut sets = Vec::new();
    for _ in 0..850 {
        let (mut pair, mut solution) = run.next();
        spoil(&mut pair, &mut solution);
        sets.extend(identifier.step(&pair, &solution));
    }
    sets
}

fn untouched(_: &mut ImuPair, _: &mut Solution) {}

#[test]
fn every_set_is_sound_and_comes_in_time() {
    for method in Method::ALL {
        let found = sets(&mut Windowed::new(settings(method, true)), 1, untouched);
        let times: Vec<i64> = found.iter().map(|set| set.header.time_ns / 1_000_000_000).collect();
        assert!(!times.is_empty() && times.iter().all(|t| [40, 60, 80].contains(t)), "{method:?}: {times:?}");
        for set in &found {
            for axis in 0..3 {
                let model = Flexure { mu: set.mu[axis], b: set.b[axis], sigma: set.sigma[axis] };
                let sds = [set.ln_mu_sd[axis], set.ln_b_sd[axis], set.ln_sigma_sd[axis]];
                assert!(model.is_sound() && sds.iter().all(|sd| sd.is_finite() && *sd > 0.0), "{method:?}: {set:?}");
            }
        }
    }
}

#[test]
fn the_same_data_give_the_same_bits() {
    for method in Method::ALL {
        let run = || sets(&mut Windowed::new(settings(method, true)), 2, untouched);
        assert_eq!(run(), run(), "{method:?}");
    }
}

#[test]
fn safety_widens_and_can_be_switched_off() {
    for method in Method::ALL {
        let run = |safety| sets(&mut Windowed::new(settings(method, safety)), 3, untouched);
        let (safe, raw) = (run(true), run(false));
        assert_eq!(safe.len(), raw.len(), "{method:?}");
        for (safe, raw) in safe.iter().zip(&raw) {
            assert_eq!((safe.id, safe.ln_mu_sd), (raw.id, raw.ln_mu_sd));
            assert!((0..3).all(|axis| safe.sigma[axis] > raw.sigma[axis] || safe.b[axis] < raw.b[axis]), "{method:?}");
        }
    }
}

#[test]
fn bad_messages_give_no_set() {
    let spoils: [fn(&mut ImuPair, &mut Solution); 3] = [
        |pair, _| pair.attitude_s = [f64::NAN; 4],
        |_, solution| solution.constant = [f64::NAN; 4],
        |pair, solution| {
            (pair.attitude_m, pair.attitude_s) = ([1.0, 0.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0]);
            solution.constant = [1.0, 0.0, 0.0, 0.0];
        },
    ];
    for spoil in spoils {
        for method in Method::ALL {
            assert!(sets(&mut Windowed::new(settings(method, true)), 4, spoil).is_empty(), "{method:?}");
        }
        assert!(sets(&mut Fixed, 4, spoil).is_empty());
    }
    assert!(sets(&mut Fixed, 4, untouched).is_empty());
}

#[test]
fn series_that_say_nothing_identify_nothing() {
    let mut hole = vec![1e-3; 600];
    hole[300] = f64::NAN;
    let mut endless = vec![1e-3; 600];
    endless[10] = f64::INFINITY;
    let series: [Vec<f64>; 8] =
        [vec![], vec![1e-3], vec![1e-3, -1e-3], vec![0.0; 600], vec![1e-3; 600], vec![f64::NAN; 600], hole, endless];
    for method in Method::ALL {
        for (number, values) in series.iter().enumerate() {
            for (kind, step_s) in
                [(Kind::Angles, 0.05), (Kind::Rates, 0.1), (Kind::Rates, 0.0), (Kind::Angles, f64::NAN)]
            {
                let found = identify_axis(method, &Series { kind, values, step_s });
                assert_eq!(found, None, "{method:?} {kind:?} {number}");
            }
        }
    }
}

/// They may be taken for a flexure or not; what comes out is sound.
#[test]
fn series_without_flexure_are_survived() {
    let mut rng = Pcg64::seed_from_u64(5);
    let white: Vec<f64> = (0..600).map(|_| StandardNormal.sample(&mut rng)).collect();
    let mut spike = vec![0.0; 600];
    spike[300] = 1.0;
    let series: Vec<Vec<f64>> = vec![
        white.iter().map(|v: &f64| v * 1e-5).collect(),
        white.iter().map(|v| v * 1e150).collect(),
        white[..17].to_vec(),
        spike,
        (0..600).map(|k| f64::from(k % 2) - 0.5).collect(),
        (0..600).map(|k| (0.1 * f64::from(k)).sin()).collect(),
        (0..600).map(|k| 1e-6 * f64::from(k)).collect(),
    ];
    for method in Method::ALL {
        for (number, values) in series.iter().enumerate() {
            for (kind, step_s) in [(Kind::Angles, 0.05), (Kind::Rates, 0.1), (Kind::Angles, 20.0), (Kind::Rates, 1e-6)]
            {
                if let Some(found) = identify_axis(method, &Series { kind, values, step_s }) {
                    assert!(found.flexure.is_sound(), "{method:?} {kind:?} {number}: {found:?}");
                }
            }
        }
    }
}

#[test]
fn names_are_unlike() {
    let mut names = Method::ALL.map(Method::name).to_vec();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), Method::ALL.len());
}
