//! What ideal units feel must be what the truth says, exactly.
#![allow(clippy::unwrap_used)]

use frames::unit::DEGREE;
use frames::{Case, Main, MainStart, Nav, Rot, Sub, Vec3};
use messages::{ImuSample, Truth};
use simulation::*;

const EARTH_RATE: f64 = 7.292115e-5;

/// The demonstration with units that make no error.
fn ideal(seed: u64) -> Scenario {
    let area = Area { unit: Unit::ideal(), ..Area::default() };
    let ins = InsErrors { attitude: [0.0; 3], noise: 0.0 };
    Scenario { seed, duration_s: Some(60.0), main: Unit::ideal(), ins, areas: vec![area], ..Scenario::default() }
}

fn still(scenario: &mut Scenario) {
    scenario.ship.speed = 0.0;
    for swing in [&mut scenario.ship.roll, &mut scenario.ship.pitch, &mut scenario.ship.heading] {
        *swing = Swing::STILL;
    }
}

fn deformation(truth: &Truth) -> Rot<Main, Sub> {
    Rot::from_wxyz(truth.q)
}

/// Attitude and velocity in the axes of t = 0 by the increments of one unit.
struct Strapdown {
    attitude: Rot<MainStart, Main>,
    velocity: Vec3<MainStart>,
}

impl Strapdown {
    fn new() -> Self {
        Self { attitude: Rot::identity(), velocity: Vec3::ZERO }
    }

    fn take(&mut self, sample: &ImuSample) {
        if sample.header.time_ns <= 0 {
            return;
        }
        let dtheta: Vec3<Main> = sample.dtheta.into();
        self.velocity += self.attitude * Rot::<Main, Main>::exp(dtheta * 0.5) * Vec3::from(sample.dvel);
        self.attitude = self.attitude * Rot::<Main, Main>::exp(dtheta);
    }
}

#[test]
fn the_demonstration_is_that_of_the_paper() {
    let mut scenario = ideal(1);
    scenario.areas[0].flexure.iter_mut().for_each(|axis| axis.sigma = 0.0);
    let mut simulator = Simulator::new(&scenario);
    for k in 0..=6000 {
        let epoch = simulator.step().unwrap();
        let t = k as f64 * 0.01;
        let ship = Rot::<Nav, Main>::from_wxyz(epoch.truth[0].ship).euler();
        let roll = 10.0 * DEGREE * (std::f64::consts::TAU * t / 8.0).sin();
        let heading = (45.0 + 10.0 * (std::f64::consts::TAU * t / 10.0).sin()) * DEGREE;
        assert!((ship.roll - roll).abs() < 1e-12 && (ship.pitch - roll).abs() < 1e-12);
        assert!((ship.heading - heading).abs() < 1e-12);
        assert_eq!(epoch.attitude.q, epoch.truth[0].ship);
        assert_eq!(epoch.truth[0].q, epoch.truth[0].static_q);
        assert_eq!((epoch.main.header.time_ns, epoch.main.interval_ns), (k * 10_000_000, 10_000_000));
    }
    assert!(simulator.step().is_none() && simulator.step().is_none());
}

#[test]
fn a_ship_at_rest_feels_gravity_and_the_earth() {
    let mut scenario = ideal(1);
    still(&mut scenario);
    for (course, latitude) in [(0.0, 45.0), (45.0, 45.0), (200.0, -30.0)] {
        scenario.ship.course = course * DEGREE;
        scenario.ship.latitude = latitude * DEGREE;
        let (sine, cosine) = scenario.ship.latitude.sin_cos();
        let earth_n = Vec3::<Nav>::new(0.0, cosine, sine) * EARTH_RATE;
        let gravity = 9.80665 - 0.0259 * (2.0 * scenario.ship.latitude).cos();
        let mut simulator = Simulator::new(&scenario);
        for _ in 0..500 {
            let epoch = simulator.step().unwrap();
            let nav_from_main = Rot::<Nav, Main>::from_wxyz(epoch.truth[0].ship);
            let w_n = nav_from_main * Vec3::<Main>::from(epoch.main.dtheta) / 0.01;
            let f_n = nav_from_main * Vec3::<Main>::from(epoch.main.dvel) / 0.01;
            assert!((w_n - earth_n).norm() < 1e-12, "{w_n:?}");
            // n turns by 1e-7 rad between the middle and the end of the sample
            assert!((f_n - Vec3::new(0.0, 0.0, gravity)).norm() < 1e-5, "{f_n:?}");
        }
    }
}

#[test]
fn the_main_gyros_compose_to_the_true_attitude() {
    for seed in 0..3 {
        let scenario = ideal(seed);
        let (sine, cosine) = scenario.ship.latitude.sin_cos();
        let (east, north) = scenario.ship.course.sin_cos();
        let transport = scenario.ship.speed / 6_371_000.0;
        let w_in_n = Vec3::<Nav>::new(0.0, cosine, sine) * EARTH_RATE
            + Vec3::new(-north, east, east * sine / cosine) * transport;
        let mut simulator = Simulator::new(&scenario);
        let first = simulator.step().unwrap().truth[0].ship;
        let mut attitude = Rot::<Nav, Main>::from_wxyz(first);
        while let Some(epoch) = simulator.step() {
            let t = epoch.main.header.time_ns as f64 / 1e9;
            attitude = (attitude * Rot::<Main, Main>::exp(epoch.main.dtheta.into())).normalised();
            let truth = Rot::<Nav, Nav>::exp(w_in_n * t) * Rot::<Nav, Main>::from_wxyz(epoch.truth[0].ship);
            assert!((attitude.inverse() * truth).angle() < 1e-12);
        }
    }
}

/// `A_m C_s^m(t) = C_s^m(0) A_s`, for a sub unit that samples `factor` times as fast.
#[test]
fn the_deformation_follows_from_both_gyros() {
    for (seed, factor) in [(0, 1.0), (1, 1.0), (2, 2.0), (3, 5.0)] {
        let mut scenario = ideal(seed);
        scenario.areas[0].wire.rate_error = factor - 1.0;
        scenario.areas[0].installation = Rot::exp(Vec3::new(0.1, -0.3, 2.5));
        let mut simulator = Simulator::new(&scenario);
        let (mut main, mut sub) = (Strapdown::new(), Strapdown::new());
        let start = deformation(&simulator.step().unwrap().truth[0]);
        while let Some(epoch) = simulator.step() {
            main.take(&epoch.main);
            epoch.sub.iter().for_each(|sample| sub.take(sample));
            assert_eq!(epoch.sub.len(), factor as usize);
            let sub_attitude: Rot<Sub, Sub> = sub.attitude.relabel();
            let left: Rot<MainStart, Sub> = main.attitude * deformation(&epoch.truth[0]);
            let right: Rot<MainStart, Sub> = start.relabel::<MainStart, Sub>() * sub_attitude;
            assert!((left.inverse() * right).angle() < 1e-12, "{seed} at {}", epoch.main.header.time_ns);
        }
    }
}

#[test]
fn total_is_dynamic_times_static() {
    let mut simulator = Simulator::new(&ideal(4));
    let mut largest = 0.0f64;
    while let Some(epoch) = simulator.step() {
        let truth = &epoch.truth[0];
        let product = Rot::<Main, Main>::exp(truth.dynamic.into()) * Rot::<Main, Sub>::from_wxyz(truth.static_q);
        assert!((product.inverse() * deformation(truth)).angle() < 1e-15);
        largest = largest.max(Vec3::<Main>::from(truth.dynamic).norm());
    }
    assert!(largest > 1e-4);
}

/// Sub minus main velocity in inertial space against `[C (w x r + r')]` by differences of the truth.
#[test]
fn the_sub_unit_feels_its_lever_arm() {
    for (seed, gain, factor, follows) in
        [(0, 1.0, 1.0, false), (1, 0.0, 1.0, true), (2, 0.5, 2.0, false), (3, 1.0, 3.0, true)]
    {
        let mut scenario = ideal(seed);
        scenario.rate_hz = 200.0;
        scenario.ship.velocity_follows_heading = follows;
        scenario.ship.heading =
            Swing::Sine(Oscillation { amplitude: 10.0 * DEGREE, period: 10.0, phase: 0.4, random_phase: false });
        let area = &mut scenario.areas[0];
        area.dynamic_lever_arm = gain;
        area.wire.rate_error = factor - 1.0;
        // hardly driven, so that the differences of the truth are good rates
        area.flexure = [0.5, 0.7, 0.3].map(|b| GaussMarkov { mu: 1e-8, b, sigma: 5e-3 });
        let arm = area.lever_arm;
        let mut simulator = Simulator::new(&scenario);
        let (mut main, mut sub) = (Strapdown::new(), Strapdown::new());
        let mut rows = Vec::new();
        let start = deformation(&simulator.step().unwrap().truth[0]);
        while let Some(epoch) = simulator.step() {
            main.take(&epoch.main);
            epoch.sub.iter().for_each(|sample| sub.take(sample));
            let sub_velocity: Vec3<Sub> = sub.velocity.relabel();
            let difference = start.relabel::<MainStart, Sub>() * sub_velocity - main.velocity;
            rows.push((
                main.attitude,
                Vec3::<Main>::from(epoch.main.dtheta),
                Vec3::<Main>::from(epoch.truth[0].dynamic),
                difference,
            ));
        }
        let term = |i: usize| {
            let (attitude, dtheta, theta, _) = rows[i];
            let w = (dtheta + rows[i + 1].1) / 0.01;
            let rate = (rows[i + 1].2 - rows[i - 1].2) / 0.01;
            attitude * (w.cross(arm + (theta * gain).cross(arm)) + (rate * gain).cross(arm))
        };
        let mut bend = 0.0f64;
        for i in 1..rows.len() - 1 {
            let expected = term(i) - term(1);
            let felt = rows[i].3 - rows[1].3;
            assert!((felt - expected).norm() < 2e-5, "{seed} {i}: {felt:?} {expected:?}");
            bend = bend.max(((rows[i + 1].2 - rows[i - 1].2) / 0.01).cross(arm).norm());
        }
        assert!(bend > 5e-3, "the bending must be large against the tolerance: {bend}");
    }
}

#[test]
fn samples_are_in_case_axes() {
    let plain = ideal(5);
    let mut turned = plain.clone();
    let main_from_case = Rot::<Main, Case>::exp(Vec3::new(0.0, 0.0, 1.5));
    let sub_from_case = Rot::<Sub, Case>::exp(Vec3::new(3.0, 0.2, 0.0));
    turned.main.mounting = main_from_case;
    turned.areas[0].unit.mounting = sub_from_case;
    let (mut plain, mut turned) = (Simulator::new(&plain), Simulator::new(&turned));
    for _ in 0..200 {
        let (a, b) = (plain.step().unwrap(), turned.step().unwrap());
        for (x, y) in [(a.main.dtheta, b.main.dtheta), (a.main.dvel, b.main.dvel)] {
            assert!((main_from_case * Vec3::from(y) - Vec3::from(x)).norm() < 1e-16 * 1e2);
        }
        for (x, y) in [(a.sub[0].dtheta, b.sub[0].dtheta), (a.sub[0].dvel, b.sub[0].dvel)] {
            assert!((sub_from_case * Vec3::from(y) - Vec3::from(x)).norm() < 1e-16 * 1e2);
        }
        assert_eq!(a.truth, b.truth);
    }
}
