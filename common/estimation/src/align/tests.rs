//! The registrations of paper 001 on motions whose answer is known.

use super::analytic::Analytic;
use super::least_squares::LeastSquares;
use super::quaternion::{Angles, Quaternion};
use super::*;
use crate::matching::conformance::{STEP_S, Voyage};
use frames::unit::{ARCSEC, nanoseconds};

/// Pairs of a rigid deck for so many seconds. The sub unit's rotation drifts about every axis by `drift` rad/s; the Earth turns.
fn pairs(installation: Vec3<Main>, drift: f64, seconds: usize) -> Vec<ImuPair> {
    let voyage = Voyage { installation: Rot::exp(installation), flexure: 0.0, delay_s: 0.0, lever_arm: Vec3::ZERO };
    let earth = Vec3::<Main>::new(0.0, 0.9, 0.4) * (7.292e-5 * STEP_S);
    let pair = |k: usize| {
        let motion = voyage.motion(k);
        let t = k as f64 * STEP_S;
        let turned = Rot::<Main, Main>::exp(Vec3::new(drift, drift, drift) * t) * voyage.installation;
        let dtheta_m = motion.dtheta_m + earth;
        ImuPair {
            interval_ns: nanoseconds(STEP_S),
            dtheta_m: dtheta_m.array(),
            dtheta_s: (turned.inverse() * (dtheta_m + Vec3::new(drift, drift, drift) * STEP_S)).array(),
            dvel_m: motion.dvel_m.array(),
            dvel_s: (turned.inverse() * motion.dvel_m).array(),
            ..ImuPair::default()
        }
    };
    (1..=seconds * 100).map(pair).collect()
}

/// The error against the installation as it was at the beginning.
fn error(mut register: impl Register, installation: Vec3<Main>, pairs: &[ImuPair]) -> f64 {
    pairs.iter().for_each(|pair| register.add(pair));
    let found = register.solve().expect("three axes of motion");
    (found.rotation * Rot::<Main, Sub>::exp(installation).inverse()).angle()
}

#[test]
fn a_constant_rotation_is_found_at_any_angle() {
    for size in [0.0, 0.02, 0.5, 2.0, 3.1] {
        let installation = Vec3::new(0.5, 0.6, -0.62) * size;
        let pairs = pairs(installation, 0.0, 20);
        for angles in [Angles::Cumulative, Angles::Windowed] {
            assert!(error(Quaternion::new(angles), installation, &pairs) < 1e-9, "{angles:?} {size}");
        }
        assert!(error(Analytic::new(), installation, &pairs) < 1e-7, "{size}");
    }
}

#[test]
fn least_squares_loses_the_square_of_the_angle() {
    let of = |size: f64| {
        let installation = Vec3::new(0.5, 0.6, -0.62) * size;
        error(LeastSquares::new(), installation, &pairs(installation, 0.0, 20))
    };
    let (small, double) = (of(1e-3), of(2e-3));
    assert!(small < 1e-6 && (3.5..4.5).contains(&(double / small)), "{small:e} {double:e}");
}

#[test]
fn what_is_printed_grows_worse_with_time_and_windows_do_not() {
    let installation = Vec3::new(250.0, 1000.0, 2400.0) * ARCSEC;
    let drift = 0.3 * ARCSEC;
    let pairs = pairs(installation, drift, 900);
    let late = |angles, seconds: usize| {
        let then = drift * seconds as f64;
        let now = (Rot::<Main, Main>::exp(Vec3::new(then, then, then)) * Rot::<Main, Sub>::exp(installation)).log();
        error(Quaternion::new(angles), now, &pairs[..seconds * 100]) / ARCSEC
    };
    // windows lag by half the time, which is all they do
    let lag = |seconds: f64| 0.5 * 0.3 * seconds * 3f64.sqrt();
    for seconds in [30, 300, 900] {
        let windowed = late(Angles::Windowed, seconds);
        assert!((windowed - lag(seconds as f64)).abs() < 2.0 + 0.02 * windowed, "{seconds} s: {windowed}");
    }
    let (printed, windowed) = (late(Angles::Cumulative, 900), late(Angles::Windowed, 900));
    assert!(printed > 2.0 * windowed, "{printed} {windowed}");
}

#[test]
fn too_little_motion_or_data_gives_nothing_or_says_so() {
    let few = pairs(Vec3::ZERO, 0.0, 2);
    let still = vec![ImuPair { interval_ns: nanoseconds(STEP_S), ..ImuPair::default() }; 2000];
    let all = || -> [Box<dyn Register>; 4] {
        [
            Box::new(Quaternion::new(Angles::Cumulative)),
            Box::new(Quaternion::new(Angles::Windowed)),
            Box::new(LeastSquares::new()),
            Box::new(Analytic::new()),
        ]
    };
    for pairs in [&few, &still] {
        for mut register in all() {
            pairs.iter().for_each(|pair| register.add(pair));
            assert!(register.solve().is_none_or(|found| !found.is_observable()));
        }
    }
}
