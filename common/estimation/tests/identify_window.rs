//! The identifier as a stage: when it fires, what it throws away, what it rebuilds.
#![allow(clippy::unwrap_used)]

mod identify_scene;

use estimation::Identifier;
use estimation::identify::chain::{Anchor, Chain};
use estimation::identify::window::{Point, Window};
use estimation::identify::{Fixed, Method, Settings, Windowed};
use frames::unit;
use identify_scene::{Run, Scene, critical};
use messages::{Flags, FlexureParams, ImuPair, Solution, Stamps};
use nalgebra::Matrix3;

const SETTINGS: Settings = Settings {
    window_s: 30.0,
    period_s: 10.0,
    lead_s: 0.5,
    minimum_s: 8.0,
    dictionary: 1,
    method: Method::Rvm,
    safety: true,
    provisional: false,
    second_mode: false,
    area: 3,
};

fn scene(interval_s: f64, seed: u64) -> Scene {
    Scene { interval_s, ..Scene::new(critical(), seed) }
}

/// Runs a scene for a time and changes what `spoil` changes.
fn sets(
    rvm: &mut Windowed,
    run: &mut Run,
    length_s: f64,
    mut spoil: impl FnMut(&mut ImuPair, &mut Solution) -> bool,
) -> Vec<FlexureParams> {
    let mut sets = Vec::new();
    loop {
        let (mut pair, mut solution) = run.next();
        if unit::seconds(pair.header.time_ns) > length_s {
            return sets;
        }
        if spoil(&mut pair, &mut solution) {
            sets.extend(rvm.step(&pair, &solution));
        }
    }
}

fn times(sets: &[FlexureParams]) -> Vec<f64> {
    sets.iter().map(|set| unit::seconds(set.header.time_ns)).collect()
}

#[test]
fn fires_by_data_time_and_says_what_it_used() {
    let mut rvm = Windowed::new(SETTINGS);
    let found = sets(&mut rvm, &mut scene(0.01, 1).run(), 50.0, |pair, _| {
        pair.header.stamps.pair_ns = 99;
        true
    });
    assert_eq!(times(&found), [8.0, 18.0, 28.0, 38.0, 48.0]);
    for set in &found {
        assert_eq!((set.id, set.area, set.header.run_id), (set.header.sequence, 3, 7));
        assert_eq!(set.header.stamps, Stamps::default());
        assert_eq!(set.effective_from_ns, set.header.time_ns + 500_000_000);
        let used_s = unit::seconds(set.header.time_ns - set.window_begin_ns);
        assert!((used_s - unit::seconds(set.header.time_ns).min(30.0)).abs() < 0.051, "{used_s}");
        assert_eq!(set.points as f64, (used_s / 0.1).round() + 1.0);
        let numbers = [set.mu, set.b, set.sigma, set.ln_mu_sd, set.ln_b_sd, set.ln_sigma_sd];
        assert!(numbers.iter().flatten().all(|value| value.is_finite() && *value > 0.0), "{set:?}");
    }
    assert_eq!(rvm.restarted_windows(), 0);
}

#[test]
fn the_same_data_give_the_same_bits() {
    let run = || sets(&mut Windowed::new(SETTINGS), &mut scene(0.02, 4).run(), 30.0, |_, _| true);
    assert_eq!(run(), run());
}

#[test]
fn points_are_thinned_by_data_time_at_any_rate() {
    for (interval_s, spacing_ns) in [(0.01, 100_000_000), (0.005, 100_000_000), (0.016, 96_000_000), (0.1, 100_000_000)]
    {
        let (mut run, mut window) = (scene(interval_s, 2).run(), Window::new(&SETTINGS));
        for _ in 0..(20.0 / interval_s) as usize {
            let (pair, solution) = run.next();
            window.take(&pair, &solution);
        }
        let points = window.points();
        assert!(points.windows(2).all(|two| two[1].time_ns - two[0].time_ns == spacing_ns), "{interval_s}");
    }
}

#[test]
fn a_gap_or_a_new_epoch_or_an_invalid_solution_starts_anew() {
    let within = |pair: &ImuPair, from: f64, to: f64| (from..to).contains(&unit::seconds(pair.header.time_ns));
    type Spoil = fn(&mut ImuPair, &mut Solution);
    let spoils: [(Spoil, f64); 4] = [
        (|pair, _| pair.flags |= Flags::GAP, 15.5),
        (|pair, _| pair.flags |= Flags::SILENT, 15.5),
        (|_, solution| solution.valid = 0, 15.02),
        (|pair, _| pair.attitude_s = [f64::NAN; 4], 15.5),
    ];
    for (number, (spoil, end)) in spoils.into_iter().enumerate() {
        let mut rvm = Windowed::new(SETTINGS);
        let found = sets(&mut rvm, &mut scene(0.02, 5).run(), 24.0, |pair, solution| {
            if within(pair, 15.0, end) {
                spoil(pair, solution);
            }
            true
        });
        assert_eq!(rvm.restarted_windows(), 1, "{number}");
        assert_eq!(found.len(), 2, "{number}");
        assert!((times(&found)[1] - end - 8.0).abs() < 0.03, "{number} {:?}", times(&found));
    }
    let mut rvm = Windowed::new(SETTINGS);
    sets(&mut rvm, &mut scene(0.02, 5).run(), 24.0, |pair, solution| {
        if unit::seconds(pair.header.time_ns) > 15.0 {
            (pair.epoch, solution.epoch) = (750, 750);
        }
        true
    });
    assert_eq!(rvm.restarted_windows(), 1);
}

/// Until the installation is known there is no solution; the gyros' motion of that time is as good as any.
#[test]
fn data_from_before_the_first_solution_count_where_a_filter_runs_over_them_again() {
    let mut rvm = Windowed::new(Settings { provisional: true, ..SETTINGS });
    let found = sets(&mut rvm, &mut scene(0.02, 5).run(), 24.0, |pair, solution| {
        solution.valid = u32::from(unit::seconds(pair.header.time_ns) > 15.0);
        true
    });
    assert_eq!(rvm.restarted_windows(), 0);
    assert!((times(&found)[0] - 15.0).abs() < 0.11 && found[0].window_begin_ns < 100_000_000, "{:?}", found[0]);
}

#[test]
fn lost_pairs_lose_only_time() {
    let mut rvm = Windowed::new(SETTINGS);
    let found = sets(&mut rvm, &mut scene(0.01, 6).run(), 40.0, |pair, _| pair.header.sequence % 100 > 20);
    assert_eq!((rvm.restarted_windows(), found.len()), (0, 4));
    let whole = sets(&mut Windowed::new(SETTINGS), &mut scene(0.01, 6).run(), 40.0, |_, _| true);
    for (some, all) in found.iter().zip(&whole).skip(2) {
        for axis in 0..3 {
            let ratio = some.sigma[axis] / all.sigma[axis];
            assert!((0.4..2.5).contains(&ratio), "axis {axis}: {ratio}");
        }
    }
}

#[test]
fn nothing_to_identify_gives_no_set() {
    let spoils: [fn(&mut ImuPair, &mut Solution); 2] = [
        |pair, solution| {
            (pair.attitude_m, pair.attitude_s) = ([1.0, 0.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0]);
            solution.constant = [1.0, 0.0, 0.0, 0.0];
        },
        |_, solution| solution.constant = [f64::NAN; 4],
    ];
    for spoil in spoils {
        let found = sets(&mut Windowed::new(SETTINGS), &mut scene(0.05, 7).run(), 20.0, |pair, solution| {
            spoil(pair, solution);
            true
        });
        assert!(found.is_empty());
    }
    let (pair, solution) = scene(0.05, 7).run().next();
    assert!(Fixed.step(&pair, &solution).is_none());
}

/// Points of a scene, and the anchor of its last solution, whose covariance says that the constant is known exactly.
fn held(scene: Scene, length_s: f64) -> (Vec<Point>, Anchor) {
    let (mut run, mut window) = (scene.run(), Window::new(&Settings { window_s: length_s, ..SETTINGS }));
    let mut last = None;
    for _ in 0..=(length_s / scene.interval_s) as usize {
        let (pair, solution) = run.next();
        window.take(&pair, &solution);
        last = Anchor::of(&pair, &solution);
    }
    (window.points().to_vec(), last.unwrap())
}

/// Root mean square of the difference of two chains' rates.
fn distance(one: &Chain, other: &Chain) -> f64 {
    let pairs = one.rates.iter().flatten().zip(other.rates.iter().flatten());
    (pairs.map(|(a, b)| (a - b).powi(2)).sum::<f64>() / one.rates[0].len() as f64).sqrt()
}

#[test]
fn the_chain_takes_the_drift_out_with_the_right_sign() {
    for seed in 0..4 {
        let quiet = Scene { arw_deg_per_sqrt_h: 0.0, ..scene(0.1, seed) };
        let biased = Scene { bias_s: [2e-5, -1e-5, 3e-5], drift_known: true, ..quiet };
        let ((points, anchor), (drifting, right)) = (held(quiet, 120.0), held(biased, 120.0));
        let truth = Chain::rebuild(&points, &anchor).unwrap();
        let with_drift = |factor: f64| {
            let anchor = Anchor { drift: right.drift * factor, ..right };
            distance(&truth, &Chain::rebuild(&drifting, &anchor).unwrap())
        };
        let (taken, left, wrong) = (with_drift(1.0), with_drift(0.0), with_drift(-1.0));
        assert!(taken < 0.02 * left && wrong > 1.8 * left, "{seed}: {taken:e} {left:e} {wrong:e}");
    }
}

#[test]
fn a_late_unit_is_re_timed_before_its_flexure_is_looked_at() {
    for seed in 0..4 {
        let (points, anchor) = held(scene(0.1, seed), 120.0);
        let truth = Chain::rebuild(&points, &anchor).unwrap();
        for (late, sign) in [(2, 1.0), (3, -1.0)] {
            // two or three points late, or the other unit
            let mut delayed = points[late..].to_vec();
            for (point, earlier) in delayed.iter_mut().zip(&points) {
                match sign {
                    1.0 => point.attitude_s = earlier.attitude_s,
                    _ => point.attitude_m = earlier.attitude_m,
                }
            }
            let told = |delay_s: f64| Anchor { delay_s, ..anchor };
            let left = Chain::rebuild(&delayed, &anchor).unwrap();
            let found = Chain::rebuild(&delayed, &told(sign * 0.1 * late as f64)).unwrap();
            let wrong = Chain::rebuild(&delayed, &told(-sign * 0.1 * late as f64)).unwrap();
            assert!((found.variance / truth.variance - 1.0).abs() < 0.1, "{seed} {late}");
            assert!(left.variance > 5.0 * truth.variance && wrong.variance > 3.0 * left.variance, "{seed} {late}");
        }
    }
}

#[test]
fn a_wrong_constant_leaks_sway_and_the_latest_one_cures_the_whole_window() {
    for seed in 0..4 {
        let ((points, anchor), (_, wrong)) =
            (held(scene(0.1, seed), 60.0), held(Scene { wrong_arcmin: [3.0, -3.0, 8.0], ..scene(0.1, seed) }, 60.0));
        let right = Chain::rebuild(&points, &anchor).unwrap();
        let leaking = Chain::rebuild(&points, &wrong).unwrap();
        assert!(leaking.variance > 1.1 * right.variance, "{seed}: {:e} {:e}", leaking.variance, right.variance);
        // a filter that admits that its constant may be wrong lets the window find a better one
        let doubted = Anchor { covariance: Matrix3::identity() * 2e-6, ..wrong };
        let cured = Chain::rebuild(&points, &doubted).unwrap();
        assert!(cured.variance < 1.05 * right.variance, "{seed}: {:e} {:e}", cured.variance, right.variance);
    }
}

#[test]
fn early_on_a_worse_constant_does_not_replace_a_better_one() {
    let settings = Settings { window_s: 60.0, period_s: 20.0, minimum_s: 20.0, ..SETTINGS };
    for seed in 0..3 {
        let guarded = |later: [f64; 3]| {
            let (mut rvm, mut run) = (Windowed::new(settings), scene(0.1, seed).run());
            let mut found = sets(&mut rvm, &mut run, 30.0, |_, _| true);
            run.mislead(later);
            found.extend(sets(&mut rvm, &mut run, 45.0, |_, _| true));
            found.pop().unwrap()
        };
        let (misled, right) = (guarded([60.0, -60.0, 120.0]), guarded([0.0; 3]));
        for axis in 0..3 {
            let ratio = misled.sigma[axis] / right.sigma[axis];
            assert!((0.8..1.25).contains(&ratio), "seed {seed}, axis {axis}: {ratio}");
        }
    }
}
