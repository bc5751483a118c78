//! The scenarios of the papers: motion, drift, changes, impulses, coupling and errors against their definitions.
#![allow(clippy::unwrap_used)]

use frames::unit::{ARCSEC, DEG_PER_H, DEGREE};
use frames::{Main, MainStart, Nav, Rot, Sub, Vec3};
use simulation::*;

const SHIP_003: [RandomSwing; 3] = [
    RandomSwing { mu: 0.10, b: 1.135_4, sigma: 2.2 * DEGREE, band_limit_hz: Some(0.4) },
    RandomSwing { mu: 0.06, b: 0.443_9, sigma: 3.4 * DEGREE, band_limit_hz: Some(0.4) },
    RandomSwing { mu: 0.12, b: 0.336_3, sigma: 0.8 * DEGREE, band_limit_hz: Some(0.4) },
];

/// No gain and no phase wanders.
const FIXED: Response = Response::Phase { wander: 0.0, wander_tau: 0.0 };

fn quiet() -> Scenario {
    let area = Area { unit: Unit::ideal(), ..Area::default() };
    let ins = InsErrors { attitude: [0.0; 3], noise: 0.0 };
    Scenario { main: Unit::ideal(), ins, areas: vec![area], duration_s: None, ..Scenario::default() }
}

fn random_ship(seed: u64) -> Scenario {
    let [pitch, roll, heading] = SHIP_003.map(Swing::Random);
    let mut scenario = Scenario { seed, rate_hz: 10.0, ..quiet() };
    scenario.ship = Ship { roll, pitch, heading, speed: 0.0, ..Ship::default() };
    scenario
}

/// Everything at once.
fn rich(seed: u64) -> Scenario {
    let mut scenario = Scenario { rate_hz: 50.0, duration_s: Some(120.0), ..random_ship(seed) };
    scenario.ship.pitch = Swing::Tones(Tones { rms: 0.04, period: 8.0, count: 24 });
    scenario.ship.speed = 5.0;
    scenario.ship.turns = Some(Turns { rate: 0.03, length_s: 20.0, every_s: 40.0, ramp_s: 10.0 });
    scenario.ship.sea_change = Some(SeaChange { at_s: 50.0, factor: 1.5, ramp_s: 20.0 });
    let area = &mut scenario.areas[0];
    area.installation = Rot::exp(Vec3::new(0.1, -0.3, 2.5));
    area.quasi_static = QuasiStatic { amplitude: [0.01, 0.02, -0.03], period: 300.0, phase: [0.0, 0.3, 0.6] };
    let flexure = [0.4, 0.6, 0.5].map(|b| GaussMarkov { mu: 0.1, b, sigma: 3e-3 });
    area.flexure_changes =
        vec![FlexureChange { at_s: 33.337, flexure }, FlexureChange { at_s: 70.0, flexure: [flexure[1]; 3] }];
    area.second_flexure = Some([GaussMarkov::damped(0.2, 0.3, 1e-3); 3]);
    area.impulses = Some(Impulses { factor: 50.0, probability: 5e-4, cell_s: 0.01 });
    let in_phase_rotation = Vec3::new(30.0, -20.0, 50.0) * ARCSEC;
    area.coupling =
        Some(Coupling { share: 0.5, response: Response::Phase { wander: 0.35, wander_tau: 100.0 }, in_phase_rotation });
    scenario
}

/// `A_m C_s^m(t) = C_s^m(0) A_s`, and `C_s^m = Exp(theta) static`, whatever moves.
#[test]
fn truth_is_one_product_that_both_gyros_feel() {
    for (seed, factor, phase_s) in [(1, 1.0, 0.0), (2, 3.0, 0.0), (3, 1.0, 0.0)] {
        let mut scenario = rich(seed);
        scenario.areas[0].wire = Wire { rate_error: factor - 1.0, phase_s, ..Wire::default() };
        let installation = scenario.areas[0].installation;
        let mut simulator = Simulator::new(&scenario);
        let first = simulator.step().unwrap().truth[0];
        let start = Rot::<Main, Sub>::from_wxyz(first.q).relabel::<MainStart, Sub>();
        let (mut main, mut sub) = (Rot::<MainStart, Main>::identity(), Rot::<Sub, Sub>::identity());
        let mut drift = 0.0f64;
        while let Some(epoch) = simulator.step() {
            main = main * Rot::<Main, Main>::exp(epoch.main.dtheta.into());
            epoch.sub.iter().for_each(|s| sub = sub * Rot::<Sub, Sub>::exp(s.dtheta.into()));
            let truth = &epoch.truth[0];
            let static_part = Rot::<Main, Sub>::from_wxyz(truth.static_q);
            let whole = Rot::<Main, Main>::exp(truth.dynamic.into()) * static_part;
            let given = Rot::<Main, Sub>::from_wxyz(truth.q);
            assert!((whole.inverse() * given).angle() < 1e-14);
            assert!(((main * given).inverse() * (start * sub)).angle() < 1e-11, "{seed} {}", truth.header.time_ns);
            let t = truth.header.time_ns as f64 / 1e9;
            let w = std::f64::consts::TAU * t / 300.0;
            let q = Vec3::new(0.01 * w.sin(), 0.02 * (w + 0.3).sin(), -0.03 * (w + 0.6).sin());
            assert!(((Rot::<Main, Main>::exp(q) * installation).inverse() * static_part).angle() < 1e-14);
            drift = drift.max(q.norm());
        }
        assert!(drift > 0.02);
    }
}

/// The sub unit feels the bending lever arm also where the flexure is coupled and switched: its rate belongs to its angle.
#[test]
fn rates_of_the_flexure_are_derivatives_of_its_angle() {
    let mut scenario = rich(4);
    scenario.rate_hz = 200.0;
    scenario.ship.speed = 0.0;
    let area = &mut scenario.areas[0];
    area.impulses = None;
    // hardly driven, so that the differences of the truth are good rates
    area.flexure = [0.5, 0.7, 0.3].map(|b| GaussMarkov { mu: 1e-8, b, sigma: 5e-3 });
    area.second_flexure = Some([0.8, 0.6, 0.9].map(|b| GaussMarkov { mu: 1e-8, b, sigma: 2e-3 }));
    let next = area.flexure.map(|m| GaussMarkov { b: 1.5 * m.b, ..m });
    area.flexure_changes = vec![FlexureChange { at_s: 33.337, flexure: next }];
    let arm = area.lever_arm;
    let mut simulator = Simulator::new(&scenario);
    let (mut c_m, mut v_m) = (Rot::<MainStart, Main>::identity(), Vec3::<MainStart>::ZERO);
    let (mut c_s, mut v_s) = (Rot::<Sub, Sub>::identity(), Vec3::<Sub>::ZERO);
    let start = Rot::<Main, Sub>::from_wxyz(simulator.step().unwrap().truth[0].q).relabel::<MainStart, Sub>();
    let mut rows = Vec::new();
    while let Some(epoch) = simulator.step() {
        let (dm, ds): (Vec3<Main>, Vec3<Sub>) = (epoch.main.dtheta.into(), epoch.sub[0].dtheta.into());
        v_m += c_m * Rot::<Main, Main>::exp(dm * 0.5) * Vec3::from(epoch.main.dvel);
        v_s += c_s * Rot::<Sub, Sub>::exp(ds * 0.5) * Vec3::from(epoch.sub[0].dvel);
        (c_m, c_s) = (c_m * Rot::<Main, Main>::exp(dm), c_s * Rot::<Sub, Sub>::exp(ds));
        rows.push((c_m, dm, Vec3::<Main>::from(epoch.truth[0].dynamic), start * v_s - v_m));
    }
    let term = |i: usize| {
        let (w, rate) = ((rows[i].1 + rows[i + 1].1) / 0.01, (rows[i + 1].2 - rows[i - 1].2) / 0.01);
        rows[i].0 * (w.cross(arm + rows[i].2.cross(arm)) + rate.cross(arm))
    };
    for i in (1..rows.len() - 1).step_by(7) {
        let (expected, felt) = (term(i) - term(1), rows[i].3 - rows[1].3);
        assert!((felt - expected).norm() < 1e-4, "{i}: {felt:?} {expected:?}");
    }
}

/// Variance of angle and rate of the ship of 003: closed form as printed, the numbers of the band-limited one by its spectrum.
#[test]
fn a_random_ship_has_its_spectrum() {
    for limit in [None, Some(0.4)] {
        let (mut angle, mut rate, mut n) = ([0.0; 3], [0.0; 3], 0.0);
        for seed in 0..6 {
            let mut scenario = random_ship(seed);
            for swing in [&mut scenario.ship.roll, &mut scenario.ship.pitch, &mut scenario.ship.heading] {
                let Swing::Random(swing) = swing else { panic!() };
                swing.band_limit_hz = limit;
            }
            scenario.rate_hz = 20.0;
            let mut simulator = Simulator::new(&scenario);
            let mut last = None;
            for _ in 0..80_000 {
                let ship = Rot::<Nav, Main>::from_wxyz(simulator.step().unwrap().truth[0].ship).euler();
                let now = [ship.pitch, ship.roll, ship.heading - 45.0 * DEGREE];
                let before: [f64; 3] = last.replace(now).unwrap_or(now);
                for k in 0..3 {
                    angle[k] += now[k] * now[k];
                    rate[k] += ((now[k] - before[k]) * 20.0).powi(2);
                }
                n += 1.0;
            }
        }
        for (k, model) in SHIP_003.into_iter().enumerate() {
            let (sigma2, rate2) = moments(&RandomSwing { band_limit_hz: limit, ..model });
            // of a variance: two over the number of independent samples, mu T
            let spread = (1.5 / (model.mu * n / 20.0)).sqrt();
            assert!((angle[k] / n / sigma2 - 1.0).abs() < 4.0 * spread, "{limit:?} {k}: {} {sigma2}", angle[k] / n);
            assert!((rate[k] / n / rate2 - 1.0).abs() < 4.0 * spread, "{limit:?} {k}: {} {rate2}", rate[k] / n);
            assert!(spread < 0.04);
        }
    }
}

/// Variance of angle and of its difference quotient over 0.05 s, by the spectrum.
fn moments(m: &RandomSwing) -> (f64, f64) {
    let dw = 5e-4;
    (0..400_000).map(|i| (i as f64 + 0.5) * dw).fold((0.0, 0.0), |(s, r), w| {
        let gauss_markov =
            4.0 * m.mu * (m.b * m.sigma).powi(2) / ((m.b * m.b - w * w).powi(2) + (2.0 * m.mu * w).powi(2));
        let limit = m.band_limit_hz.map_or(1.0, |hz| 1.0 / (1.0 + (w / (std::f64::consts::TAU * hz)).powi(8)));
        let power = gauss_markov * limit * dw / std::f64::consts::PI;
        (s + power, r + power * ((w * 0.025).sin() / 0.025).powi(2))
    })
}

#[test]
fn a_ship_does_not_depend_on_the_sampling_and_tones_have_their_rms() {
    for swing in [Swing::Tones(Tones { rms: 0.05, period: 7.0, count: 24 }), Swing::Random(SHIP_003[1])] {
        let run = |rate_hz: f64| {
            let mut scenario = Scenario { rate_hz, ..random_ship(8) };
            scenario.ship.roll = swing;
            let mut simulator = Simulator::new(&scenario);
            (0..(3000.0 * rate_hz) as usize)
                .map(|_| Rot::<Nav, Main>::from_wxyz(simulator.step().unwrap().truth[0].ship).euler().roll)
                .collect::<Vec<f64>>()
        };
        let (slow, fast) = (run(10.0), run(40.0));
        assert!(slow.iter().zip(fast.iter().step_by(4)).all(|(a, b)| (a - b).abs() < 1e-12));
        if let Swing::Tones(tones) = swing {
            let rms = (slow.iter().map(|x| x * x).sum::<f64>() / slow.len() as f64).sqrt();
            assert!((rms / tones.rms - 1.0).abs() < 0.05, "{rms}");
        }
    }
}

#[test]
fn drawn_phases_differ_between_seeds_and_axes() {
    let mut seen = Vec::new();
    for seed in 0..5 {
        let mut scenario = Scenario { seed, ..quiet() };
        let sine = Swing::Sine(Oscillation { amplitude: 0.05, period: 8.0, phase: 0.0, random_phase: true });
        scenario.ship = Ship { roll: sine, pitch: sine, ..scenario.ship };
        let ship = Rot::<Nav, Main>::from_wxyz(Simulator::new(&scenario).step().unwrap().truth[0].ship).euler();
        seen.extend([ship.roll, ship.pitch]);
    }
    seen.sort_by(f64::total_cmp);
    assert!(seen.windows(2).all(|pair| pair[1] - pair[0] > 1e-6) && seen[0] < -0.01 && seen[9] > 0.01);
}

#[test]
fn a_change_of_model_carries_the_flexure_on_and_has_the_new_spread() {
    let (before, after) = (GaussMarkov { mu: 0.2, b: 1.0, sigma: 1e-4 }, GaussMarkov { mu: 0.3, b: 2.0, sigma: 1e-2 });
    let (mut early, mut late, mut n) = (0.0, 0.0, 0.0);
    for seed in 0..4 {
        let mut scenario = Scenario { seed, rate_hz: 20.0, duration_s: Some(4000.0), ..quiet() };
        scenario.areas[0].flexure = [before; 3];
        scenario.areas[0].flexure_changes = vec![FlexureChange { at_s: 2000.013, flexure: [after; 3] }];
        let mut unchanged = Simulator::new(&Scenario {
            areas: vec![Area { flexure_changes: vec![], ..scenario.areas[0].clone() }],
            ..scenario.clone()
        });
        let mut simulator = Simulator::new(&scenario);
        let mut last = [0.0; 3];
        while let Some(epoch) = simulator.step() {
            let (t, now) = (epoch.truth[0].header.time_ns as f64 / 1e9, epoch.truth[0].dynamic);
            let reference = unchanged.step().unwrap().truth[0].dynamic;
            assert!(t > 2000.013 || now == reference);
            // in one step the new noise moves the angle by sigma b sqrt(4 mu dt^3 / 3) = 2e-4
            assert!((2000.0..2000.1).contains(&t) <= (0..3).all(|k| (now[k] - last[k]).abs() < 1.2e-3));
            let power = now.iter().map(|x| x * x / 3.0).sum::<f64>();
            if t < 2000.0 {
                early += power
            } else if t > 2050.0 {
                late += power;
                n += 1.0
            }
            last = now;
        }
    }
    let ratio = |power: f64, m: &GaussMarkov| power / n / (m.sigma * m.sigma);
    assert!((ratio(early, &before) - 1.0).abs() < 0.15 && (ratio(late, &after) - 1.0).abs() < 0.15);
}

#[test]
fn a_hull_that_starts_at_rest_is_straight_at_the_start() {
    let mut scenario = quiet();
    scenario.areas[0].starts_at_rest = true;
    let mut simulator = Simulator::new(&scenario);
    assert_eq!(simulator.step().unwrap().truth[0].dynamic, [0.0; 3]);
    let after: Vec<f64> = (0..3000).map(|_| simulator.step().unwrap().truth[0].dynamic[2]).collect();
    assert!(after[0].abs() < 1e-6 && after[0] != 0.0 && after[2999].abs() > 1e-5);
}

/// The same variance, far longer tails, at either sampling rate.
#[test]
fn impulsive_waves_keep_the_variance_and_have_tails() {
    for rate_hz in [20.0, 100.0] {
        let (mut second, mut fourth, mut n) = (0.0, 0.0, 0.0);
        for seed in 0..4 {
            let mut scenario = Scenario { seed, rate_hz, duration_s: Some(4000.0), ..quiet() };
            scenario.areas[0].flexure = [GaussMarkov { mu: 2.0, b: 4.0, sigma: 1e-3 }; 3];
            scenario.areas[0].impulses = Some(Impulses { factor: 50.0, probability: 5e-4, cell_s: 0.01 });
            let mut simulator = Simulator::new(&scenario);
            while let Some(epoch) = simulator.step() {
                for x in epoch.truth[0].dynamic.map(|x| x * 1e3) {
                    (second, fourth, n) = (second + x * x, fourth + x.powi(4), n + 1.0);
                }
            }
        }
        let (variance, kurtosis) = (second / n, fourth / n / (second / n).powi(2));
        assert!((variance - 1.0).abs() < 0.1 && kurtosis > 10.0, "{rate_hz}: {variance} {kurtosis}");
    }
}

/// Coherent flexure alone: the ratio of deviations is the share, and without wander it is a fixed combination of the swing.
#[test]
fn coherent_flexure_has_its_share_and_follows_the_swing() {
    let (sigma, share) = (12.0 * ARCSEC, 0.5);
    for seed in 0..5 {
        let mut scenario = random_ship(seed);
        // so slow that only the coherent part is left
        scenario.areas[0].flexure = [GaussMarkov { mu: 1e-9, b: 1e-9, sigma }; 3];
        scenario.areas[0].starts_at_rest = true;
        let none = Vec3::ZERO;
        scenario.areas[0].coupling = Some(Coupling { share, response: FIXED, in_phase_rotation: none });
        let mut simulator = Simulator::new(&scenario);
        let (mut power, n) = ([0.0; 3], 100_000.0);
        for _ in 0..100_000 {
            let theta = simulator.step().unwrap().truth[0].dynamic;
            (0..3).for_each(|k| power[k] += theta[k] * theta[k] / n);
        }
        for k in 0..3 {
            assert!((power[k].sqrt() / (share * sigma) - 1.0).abs() < 0.15, "{seed} {k} {power:?}");
        }
    }
}

/// `theta_c = -[e x] s`: to the gyros `w x e`, a static rotation by e.
#[test]
fn an_in_phase_rotation_looks_like_a_static_one() {
    let mut scenario = random_ship(3);
    let e = Vec3::<Main>::new(30.0, -20.0, 50.0) * ARCSEC;
    scenario.areas[0].flexure = [GaussMarkov { mu: 0.1, b: 0.4, sigma: 0.0 }; 3];
    scenario.areas[0].coupling = Some(Coupling { share: 0.0, response: FIXED, in_phase_rotation: e });
    let mut simulator = Simulator::new(&scenario);
    let (mut last, mut found, mut normal) = (None, nalgebra::Vector3::zeros(), nalgebra::Matrix3::zeros());
    for _ in 0..40_000 {
        let epoch = simulator.step().unwrap();
        let theta = Vec3::<Main>::from(epoch.truth[0].dynamic);
        let ship = Rot::<Nav, Main>::from_wxyz(epoch.truth[0].ship).euler();
        let s = Vec3::<Main>::new(ship.pitch, ship.roll, -(ship.heading - 45.0 * DEGREE));
        assert!((theta - s.cross(e)).norm() < 1e-14);
        if let Some(last) = last.replace(theta) {
            // least squares of `theta' = w x e` over the run
            let w = nalgebra::Vector3::from(epoch.main.dtheta).cross_matrix();
            found += w.transpose() * nalgebra::Vector3::from((theta - last).array());
            normal += w.transpose() * w;
        }
    }
    let found = normal.try_inverse().unwrap() * found;
    assert!((Vec3::from([found.x, found.y, found.z]) - e).norm() < 0.05 * e.norm(), "{:?}", found / ARCSEC);
}

#[test]
fn a_wandering_bias_has_its_spread_and_memory() {
    let wander = Wander { sigma: DEG_PER_H, tau: 20.0 };
    let (mut zero, mut lag, mut n) = (0.0, 0.0, 0.0);
    for seed in 0..6 {
        let mut clean = Scenario { seed, rate_hz: 10.0, duration_s: Some(4000.0), ..quiet() };
        let mut dirty = clean.clone();
        dirty.areas[0].unit.bias_wander = wander;
        let bias = |scenario: &mut Scenario| {
            let mut simulator = Simulator::new(scenario);
            std::iter::from_fn(|| simulator.step().map(|epoch| epoch.sub[0].dtheta)).collect::<Vec<_>>()
        };
        let (a, b) = (bias(&mut clean), bias(&mut dirty));
        let drift: Vec<[f64; 3]> =
            a.iter().zip(&b).map(|(a, b)| [0, 1, 2].map(|k| (b[k] - a[k]) / 0.1 / wander.sigma)).collect();
        for pair in drift.windows(201) {
            for k in 0..3 {
                (zero, lag, n) = (zero + pair[0][k].powi(2), lag + pair[0][k] * pair[200][k], n + 1.0);
            }
        }
    }
    // 3600 correlation times' worth of independent values
    assert!((zero / n - 1.0).abs() < 0.1 && (lag / n - (-1f64).exp()).abs() < 0.1, "{} {}", zero / n, lag / n);
}

#[test]
fn outliers_are_as_frequent_and_large_as_told() {
    for (one_sided, probability) in [(true, 0.01), (false, 0.05)] {
        let mut clean = Scenario { rate_hz: 100.0, duration_s: Some(400.0), ..quiet() };
        clean.areas[0].unit = Unit { arw: 1e-5, vrw: 1e-3, ..Unit::ideal() };
        let mut dirty = clean.clone();
        dirty.areas[0].unit.outliers = Outliers { probability, size: 50.0, one_sided };
        let (mut a, mut b) = (Simulator::new(&clean), Simulator::new(&dirty));
        let (mut up, mut down, mut n) = (0.0, 0.0, 0.0);
        while let (Some(a), Some(b)) = (a.step(), b.step()) {
            for (a, b, walk) in [(a.sub[0].dtheta, b.sub[0].dtheta, 1e-5), (a.sub[0].dvel, b.sub[0].dvel, 1e-3)] {
                for k in 0..3 {
                    let size = (b[k] - a[k]) / (walk * 0.1);
                    assert!(size.abs() < 1e-6 || (size.abs() - 50.0).abs() < 1e-6, "{size}");
                    up += f64::from(u8::from(size > 1.0));
                    down += f64::from(u8::from(size < -1.0));
                    n += 1.0;
                }
            }
            assert_eq!(a.main, b.main);
        }
        let spread = (probability * n).sqrt();
        assert!((up + down - probability * n).abs() < 4.0 * spread);
        assert!(if one_sided { down == 0.0 } else { (up - down).abs() < 4.0 * spread });
    }
}

/// A turn goes into the heading and the course, and the force fits the velocity's change.
#[test]
fn a_turn_changes_heading_and_velocity() {
    let mut scenario = quiet();
    scenario.ship = Ship { roll: Swing::STILL, pitch: Swing::STILL, heading: Swing::STILL, ..scenario.ship };
    scenario.ship.turns = Some(Turns { rate: DEGREE, length_s: 90.0, every_s: 150.0, ramp_s: 10.0 });
    scenario.duration_s = Some(260.0);
    let mut simulator = Simulator::new(&scenario);
    let (mut heading, mut felt) = (0.0, Vec3::<Nav>::ZERO);
    while let Some(epoch) = simulator.step() {
        let nav_from_main = Rot::<Nav, Main>::from_wxyz(epoch.truth[0].ship);
        heading = nav_from_main.euler().heading;
        felt += nav_from_main * Vec3::<Main>::from(epoch.main.dvel);
    }
    assert!((heading - 135.0 * DEGREE).abs() < 1e-9);
    // from north-east to south-east; Coriolis's force adds 2 mm/s^2 at most
    let south = felt.y() + scenario.ship.speed * 2f64.sqrt();
    assert!(south.abs() < 260.0 * 2e-3 && felt.x().abs() < 260.0 * 2e-3, "{felt:?}");
}
