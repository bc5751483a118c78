//! Random parts against their models; every bound is a number of standard deviations of the estimate itself.
#![allow(clippy::unwrap_used)]

use frames::unit::{ARCMIN, DEG_PER_H, DEG_PER_SQRT_H, MICRO_G};
use frames::{Main, Nav, Rot, Vec3};
use simulation::*;

/// `R(tau)`, 000 eq 17 with the factor the right way up.
fn autocovariance(m: &GaussMarkov, tau: f64) -> f64 {
    let k = m.b * m.b - m.mu * m.mu;
    let l = k.abs().sqrt();
    let (c, s) = if l * tau < 1e-9 {
        (1.0, tau)
    } else if k > 0.0 {
        ((l * tau).cos(), (l * tau).sin() / l)
    } else {
        let (slow, fast) = (((l - m.mu) * tau).exp(), (-(l + m.mu) * tau).exp());
        return m.sigma * m.sigma * ((slow + fast) + m.mu * (slow - fast) / l) / 2.0;
    };
    m.sigma * m.sigma * (-m.mu * tau).exp() * (c + m.mu * s)
}

/// Variance and autocovariance of the three dampings, on a regular grid and with a sub unit whose instants fall between.
#[test]
fn flexure_has_the_autocovariance_of_its_model() {
    let (rate, duration) = (2.0, 10_000.0);
    let models = [
        GaussMarkov::critical(10.0, 6.0 * ARCMIN),
        GaussMarkov { mu: 0.1, b: 0.6, sigma: 1e-3 },
        GaussMarkov { mu: 0.9, b: 0.4, sigma: 10.0 * ARCMIN },
    ];
    for (wire, seeds) in [
        (Wire::default(), 0..6),
        (Wire { phase_s: 0.13, ..Wire::default() }, 6..12),
        (Wire { rate_error: 0.037, ..Wire::default() }, 12..18),
    ] {
        let runs = seeds.clone().count() as f64;
        let mut sums = [[0.0; 3]; 3];
        let lags = [0usize, 4, 13];
        for seed in seeds {
            let area = Area { flexure: models, wire, ..Area::default() };
            let mut simulator = Simulator::new(&Scenario {
                rate_hz: rate,
                seed,
                duration_s: Some(duration),
                areas: vec![area],
                ..Scenario::default()
            });
            let mut series = Vec::new();
            while let Some(epoch) = simulator.step() {
                series.push(epoch.truth[0].dynamic);
            }
            for (sums, axis) in sums.iter_mut().zip(0..) {
                for (sum, lag) in sums.iter_mut().zip(lags) {
                    let products: f64 = series.windows(lag + 1).map(|w| w[0][axis] * w[lag][axis]).sum();
                    *sum += products / (series.len() - lag) as f64 / runs;
                }
            }
        }
        for (model, sums) in models.iter().zip(sums) {
            for (found, lag) in sums.into_iter().zip(lags) {
                let r = |k: i64| autocovariance(model, k.abs() as f64 / rate);
                let lag = lag as i64;
                // Bartlett: variance of a sample autocovariance of a Gaussian process
                let spread: f64 = (-2000..=2000).map(|k| r(k) * r(k) + r(k + lag) * r(k - lag)).sum();
                let sd = (spread / (rate * duration * runs)).sqrt();
                assert!((found - r(lag)).abs() < 4.0 * sd, "{model:?} {wire:?} lag {lag}: {found} {} +- {sd}", r(lag));
                assert!(sd < 0.06 * r(0));
            }
        }
    }
}

/// The rate must fit the angle: increments over one step have the variance `2 (R(0) - R(T))`, which is `b^2 sigma^2 T^2` nearly.
#[test]
fn flexure_moves_as_fast_as_its_model() {
    let mut sums = [0.0; 3];
    let (seeds, steps) = (12, 6000);
    for seed in 0..seeds {
        let mut simulator = Simulator::new(&Scenario { rate_hz: 10.0, seed, duration_s: None, ..Scenario::default() });
        let mut last = simulator.step().unwrap().truth[0].dynamic;
        for _ in 0..steps {
            let now = simulator.step().unwrap().truth[0].dynamic;
            for axis in 0..3 {
                sums[axis] += (now[axis] - last[axis]).powi(2) / (steps as f64 * seeds as f64);
            }
            last = now;
        }
    }
    for (model, found) in Area::default().flexure.iter().zip(sums) {
        let r = |k: i64| autocovariance(model, k.abs() as f64 / 10.0);
        let increment = |k: i64| 2.0 * r(k) - r(k - 1) - r(k + 1);
        let spread: f64 = (-2000..=2000).map(|k| 2.0 * increment(k).powi(2)).sum();
        let sd = (spread / (steps as f64 * seeds as f64)).sqrt();
        assert!((found - increment(0)).abs() < 4.0 * sd && sd < 0.1 * increment(0), "{found} {} +- {sd}", increment(0));
    }
}

#[test]
fn a_run_starts_stationary() {
    let seeds = 2000;
    let mut squares = [0.0; 3];
    for seed in 0..seeds {
        let mut simulator = Simulator::new(&Scenario { seed, ..Scenario::default() });
        let theta = simulator.step().unwrap().truth[0].dynamic;
        (0..3).for_each(|axis| squares[axis] += theta[axis] * theta[axis] / seeds as f64);
    }
    for (model, found) in Area::default().flexure.iter().zip(squares) {
        let ratio = found / (model.sigma * model.sigma);
        assert!((ratio - 1.0).abs() < 4.0 * (2.0 / seeds as f64).sqrt(), "{ratio}");
    }
}

fn quiet(seed: u64) -> Scenario {
    let mut scenario = Scenario { seed, duration_s: None, main: Unit::ideal(), ..Scenario::default() };
    scenario.areas[0].unit = Unit::ideal();
    scenario
}

/// Errors of the first samples: gyro and accelerometer of main and sub unit.
fn errors(noisy: &Scenario, count: usize) -> Vec<[Vec3<Main>; 4]> {
    let mut ideal = noisy.clone();
    ideal.main = Unit::ideal();
    ideal.areas[0].unit = Unit::ideal();
    let (mut noisy, mut ideal) = (Simulator::new(noisy), Simulator::new(&ideal));
    (0..count)
        .map(|_| {
            let (a, b) = (noisy.step().unwrap(), ideal.step().unwrap());
            let difference = |x: [f64; 3], y: [f64; 3]| Vec3::from(x) - Vec3::from(y);
            [
                difference(a.main.dtheta, b.main.dtheta),
                difference(a.main.dvel, b.main.dvel),
                difference(a.sub[0].dtheta, b.sub[0].dtheta),
                difference(a.sub[0].dvel, b.sub[0].dvel),
            ]
        })
        .collect()
}

#[test]
fn white_noise_grows_with_the_square_root_of_time() {
    let count = 8000;
    for (seed, rate_hz) in [(1, 100.0), (2, 200.0), (3, 100.0)] {
        let mut scenario = Scenario { rate_hz, ..quiet(seed) };
        (scenario.main.arw, scenario.main.vrw) = (0.003 * DEG_PER_SQRT_H, 20.0 * MICRO_G);
        (scenario.areas[0].unit.arw, scenario.areas[0].unit.vrw) = (0.1 * DEG_PER_SQRT_H, 100.0 * MICRO_G);
        let rows = errors(&scenario, count);
        let walks = [scenario.main.arw, scenario.main.vrw, scenario.areas[0].unit.arw, scenario.areas[0].unit.vrw];
        for (channel, walk) in walks.into_iter().enumerate() {
            for axis in 0..3 {
                let x: Vec<f64> = rows.iter().map(|row| row[channel].array()[axis]).collect();
                let variance = walk * walk / rate_hz;
                let found: f64 = x.iter().map(|x| x * x).sum::<f64>() / count as f64;
                let neighbours: f64 = x.windows(2).map(|w| w[0] * w[1]).sum::<f64>() / (count - 1) as f64;
                assert!((found / variance - 1.0).abs() < 4.0 * (2.0 / count as f64).sqrt(), "{channel} {axis}");
                assert!((neighbours / variance).abs() < 4.0 / (count as f64).sqrt(), "{channel} {axis}");
            }
        }
    }
}

#[test]
fn the_noises_of_the_units_are_independent() {
    let count = 8000;
    let mut scenario = quiet(7);
    (scenario.main.arw, scenario.main.vrw) = (1e-6, 1e-4);
    (scenario.areas[0].unit.arw, scenario.areas[0].unit.vrw) = (1e-6, 1e-4);
    let rows = errors(&scenario, count);
    let scale = [1e-7, 1e-5, 1e-7, 1e-5];
    let channels = |row: &[Vec3<Main>; 4]| -> Vec<f64> {
        row.iter().zip(scale).flat_map(|(v, s)| v.array().map(|x| x / s)).collect()
    };
    let rows: Vec<Vec<f64>> = rows.iter().map(channels).collect();
    for i in 0..12 {
        for j in 0..i {
            let correlation = rows.iter().map(|row| row[i] * row[j]).sum::<f64>() / count as f64;
            assert!(correlation.abs() < 4.5 / (count as f64).sqrt(), "{i} {j}: {correlation}");
        }
    }
}

/// Bias, scale and misalignment of a ship at rest, whose accelerometers feel gravity along z.
#[test]
fn constant_errors_spread_over_the_seeds_as_given() {
    let seeds = 1500;
    let (interval, gravity) = (0.01, 9.80665);
    let (bias, accel_bias) = (0.02 * DEG_PER_H, 70.0 * MICRO_G);
    let run = |change: &dyn Fn(&mut Scenario)| {
        let mut squares = [0.0; 9];
        for seed in 0..seeds {
            let mut scenario = quiet(seed);
            scenario.ship.speed = 0.0;
            scenario.ship.roll = Swing::STILL;
            scenario.ship.pitch = Swing::STILL;
            scenario.ship.heading = Swing::STILL;
            change(&mut scenario);
            let rows = errors(&scenario, 2);
            assert!((rows[0][2] - rows[1][2]).norm() < 1e-12, "constant over the run");
            let (gyro, accel) = (rows[1][2].array(), rows[1][3].array());
            let main = rows[1][1].array();
            let all = [gyro, accel, main].concat();
            (0..9).for_each(|i| squares[i] += (all[i] / interval).powi(2) / seeds as f64);
        }
        squares.map(f64::sqrt)
    };
    let near = |found: f64, sigma: f64| {
        let bound = 4.0 * sigma / (2.0 * seeds as f64).sqrt();
        assert!((found - sigma).abs() < bound, "{found} instead of {sigma}");
    };
    let found = run(&|s| {
        s.areas[0].unit.bias = bias;
        s.areas[0].unit.accel_bias = accel_bias;
        s.main.accel_bias = accel_bias;
    });
    (0..3).for_each(|i| near(found[i], bias));
    (3..9).for_each(|i| near(found[i], accel_bias));
    let found = run(&|s| {
        s.areas[0].installation = Rot::identity();
        s.areas[0].flexure.iter_mut().for_each(|axis| axis.sigma = 0.0);
        s.areas[0].unit.accel_scale = 1e-3;
        s.main.accel_misalignment = 1e-4;
    });
    near(found[5], 1e-3 * gravity);
    assert!(found[3] < 1e-6 && found[4] < 1e-6 && found[0] < 1e-12);
    near(found[6], 1e-4 * gravity);
    near(found[7], 1e-4 * gravity);
    assert!(found[8] < 1e-6);
}

#[test]
fn the_ins_errs_as_it_says() {
    let (seeds, count) = (300, 200);
    let ins = InsErrors { attitude: [1e-4, 2e-4, 5e-4], noise: 3e-5 };
    let (mut constant, mut white) = ([0.0; 3], 0.0);
    for seed in 0..seeds {
        let mut simulator = Simulator::new(&Scenario { seed, ins, ..Scenario::default() });
        let errors: Vec<[f64; 3]> = (0..count)
            .map(|_| {
                let epoch = simulator.step().unwrap();
                let (found, truth) = (epoch.attitude.q, epoch.truth[0].ship);
                assert_eq!(epoch.attitude.sigma, ins.attitude.map(|a| a.hypot(ins.noise)));
                (Rot::<Nav, Main>::from_wxyz(found) * Rot::<Nav, Main>::from_wxyz(truth).inverse()).log().array()
            })
            .collect();
        for axis in 0..3 {
            let mean = errors.iter().map(|e| e[axis]).sum::<f64>() / count as f64;
            constant[axis] += mean * mean / seeds as f64;
            let squares: f64 = errors.iter().map(|e| (e[axis] - mean).powi(2)).sum();
            white += squares / (count - 1) as f64 / (3 * seeds) as f64;
        }
    }
    for (found, sigma) in constant.into_iter().zip(ins.attitude) {
        let expected = sigma * sigma + ins.noise * ins.noise / count as f64;
        assert!((found / expected - 1.0).abs() < 4.0 * (2.0 / seeds as f64).sqrt(), "{found} {expected}");
    }
    let ratio = white / (ins.noise * ins.noise);
    assert!((ratio - 1.0).abs() < 4.0 * (2.0 / (3 * seeds * count) as f64).sqrt(), "{ratio}");
}
