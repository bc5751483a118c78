//! A flexure that becomes another one is noticed, and one that does not is left alone.
#![allow(clippy::unwrap_used)]

use estimation::flexure::Flexure;
use estimation::identify::change::changed;
use nalgebra::Vector2;
use rand::{RngExt, SeedableRng};
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64;

const STEP_S: f64 = 0.1;
const ARCSEC: f64 = std::f64::consts::PI / 648_000.0;

fn hull(factor: f64) -> [Flexure; 3] {
    [(0.13, 1.19, 80.0), (0.11, 1.07, 120.0), (0.2, 0.9, 60.0)].map(|(mu, b, sigma)| Flexure {
        mu,
        b: b * factor,
        sigma: sigma * factor * ARCSEC,
    })
}

/// Rates of one hull, then of another, of so many seconds each, with white noise.
fn rates(parts: [([Flexure; 3], f64); 2], seed: u64) -> [Vec<f64>; 3] {
    slammed(parts, seed, 0.0)
}

/// The same where waves hit the hull, in so large a share of the steps with 15 times the usual noise.
fn slammed(parts: [([Flexure; 3], f64); 2], seed: u64, share: f64) -> [Vec<f64>; 3] {
    let mut rng = Pcg64::seed_from_u64(seed);
    let mut normal = || -> f64 { StandardNormal.sample(&mut rng) };
    let mut chance = Pcg64::seed_from_u64(!seed);
    [0, 1, 2].map(|axis| {
        let mut state = Vector2::new(normal() * parts[0].0[axis].sigma, 0.0);
        let mut rates = Vec::new();
        for (hull, length_s) in parts {
            let (step, noise) = (hull[axis].transition(STEP_S), hull[axis].noise(STEP_S).cholesky().unwrap().l());
            for _ in 0..(length_s / STEP_S) as usize {
                let blow = if share > 0.0 && chance.random::<f64>() < share { 15.0 } else { 1.0 };
                let next = step * state + noise * Vector2::new(normal(), normal()) * blow;
                rates.push((next[0] - state[0]) / STEP_S + normal() * 0.2 * ARCSEC);
                state = next;
            }
        }
        rates
    })
}

#[test]
fn a_hull_that_stays_is_left_alone() {
    for seed in 0..20 {
        for length_s in [130.0, 300.0, 600.0] {
            let found = changed(&rates([(hull(1.0), length_s), (hull(1.0), 0.0)], seed), STEP_S);
            assert_eq!(found, None, "{seed} {length_s}");
        }
    }
}

/// Three blows a minute and axis: no two minutes have the same power, and still it is one hull.
#[test]
fn a_slamming_sea_is_left_alone() {
    for seed in 0..20 {
        for length_s in [310.0, 450.0, 600.0] {
            let found = changed(&slammed([(hull(1.0), length_s), (hull(1.0), 0.0)], seed, 0.005), STEP_S);
            assert_eq!(found, None, "{seed} {length_s}");
        }
    }
}

/// A window is looked at every ten seconds; one of less than twenty is not kept.
#[test]
fn another_hull_is_noticed_within_two_minutes_and_placed_to_seconds() {
    for seed in 0..10 {
        for factor in [1.6, 0.6] {
            let rates = rates([(hull(1.0), 300.0), (hull(factor), 120.0)], seed);
            let until = |length: usize| rates.each_ref().map(|axis| axis[..length].to_vec());
            let found = (3000..=4200).step_by(100).find_map(|length| Some((length, changed(&until(length), STEP_S)?)));
            let (length, part_s) = found.unwrap_or_else(|| panic!("{seed} {factor}: not noticed"));
            let since_s = length as f64 * STEP_S - 300.0;
            assert!(since_s > 0.0 && (part_s - since_s.max(20.0)).abs() < 5.0, "{seed} {factor}: {found:?}");
        }
    }
}

#[test]
fn too_little_says_nothing() {
    assert_eq!(changed(&rates([(hull(1.0), 200.0), (hull(2.0), 90.0)], 1), STEP_S), None);
    assert_eq!(changed(&[vec![0.0; 3000], vec![0.0; 3000], vec![0.0; 3000]], STEP_S), None);
    assert_eq!(changed(&[vec![f64::NAN; 3000], vec![0.0; 3000], vec![0.0; 3000]], STEP_S), None);
}
