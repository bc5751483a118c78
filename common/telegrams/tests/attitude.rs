//! Angles, sigmas and rates against trigonometry and differences that know nothing of quaternions.
#![allow(clippy::unwrap_used)]

use frames::{Euler, Nav, Rot, Sub, Vec3};
use rand::{RngExt, SeedableRng};
use std::f64::consts::TAU;
use telegrams::{Attitude, Axes};

type Matrix = [[f64; 3]; 3];

fn product(a: &Matrix, b: &Matrix) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|k| a[i][k] * b[k][j]).sum()))
}

/// From the ship's axes (starboard, bow, up) to east, north, up: the bow is raised, the port side is raised, the ship is turned clockwise.
fn from_ship(angles: Euler) -> Matrix {
    let ((sr, cr), (sp, cp), (sh, ch)) = (angles.roll.sin_cos(), angles.pitch.sin_cos(), angles.heading.sin_cos());
    // port side up: the starboard side goes down
    let rolled = [[cr, 0.0, sr], [0.0, 1.0, 0.0], [-sr, 0.0, cr]];
    let pitched = [[1.0, 0.0, 0.0], [0.0, cp, -sp], [0.0, sp, cp]];
    // the bow of a ship that heads east points east
    let turned = [[ch, sh, 0.0], [-sh, ch, 0.0], [0.0, 0.0, 1.0]];
    product(&turned, &product(&pitched, &rolled))
}

/// The angles of a matrix: where bow and starboard side point to.
fn angles_of(c: &Matrix) -> Axes {
    let starboard_up = c[2][0];
    let (bow_east, bow_north, bow_up) = (c[0][1], c[1][1], c[2][1]);
    Axes {
        roll: (-starboard_up).atan2(c[2][2]),
        pitch: bow_up.atan2(bow_east.hypot(bow_north)),
        heading: bow_east.atan2(bow_north).rem_euclid(TAU),
    }
}

/// A small turn about east, north and up, by its series.
fn small_turn([x, y, z]: [f64; 3]) -> Matrix {
    let skew = [[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]];
    let square = product(&skew, &skew);
    std::array::from_fn(|i| std::array::from_fn(|j| f64::from(u8::from(i == j)) + skew[i][j] + square[i][j] / 2.0))
}

fn some_angles() -> impl Iterator<Item = Euler> {
    let mut random = rand_pcg::Pcg64::seed_from_u64(2);
    (0..300).map(move |_| Euler {
        roll: random.random_range(-3.1..3.1),
        pitch: random.random_range(-1.3..1.3),
        heading: random.random_range(0.0..TAU),
    })
}

fn apart(a: f64, b: f64) -> f64 {
    ((a - b + TAU / 2.0).rem_euclid(TAU) - TAU / 2.0).abs()
}

const SIGMA: [f64; 3] = [2e-4, 3e-4, 5e-4];

#[test]
fn the_angles_are_those_of_a_ship() {
    for told in some_angles() {
        let attitude = Attitude::new(told.rotation::<Sub>(), SIGMA.into(), Vec3::ZERO).unwrap();
        let seen = angles_of(&from_ship(told));
        for (a, b) in [
            (attitude.angles.roll, seen.roll),
            (attitude.angles.pitch, seen.pitch),
            (attitude.angles.heading, seen.heading),
        ] {
            assert!(apart(a, b) < 1e-12, "{told:?}");
        }
    }
}

#[test]
fn rates_and_sigmas_are_the_differences_of_turned_ships() {
    let step = 1e-5;
    for told in some_angles() {
        let matrix = from_ship(told);
        let derivative = |axis: usize| {
            let turn = |size: f64| {
                let mut e = [0.0; 3];
                e[axis] = size;
                angles_of(&product(&small_turn(e), &matrix))
            };
            let (ahead, back) = (turn(step), turn(-step));
            let slope = |a: f64, b: f64| ((a - b + TAU / 2.0).rem_euclid(TAU) - TAU / 2.0) / (2.0 * step);
            [slope(ahead.roll, back.roll), slope(ahead.pitch, back.pitch), slope(ahead.heading, back.heading)]
        };
        let columns = [derivative(0), derivative(1), derivative(2)];
        let turning = [0.02, -0.03, 0.05];
        let attitude = Attitude::new(told.rotation::<Sub>(), SIGMA.into(), turning.into()).unwrap();
        let rates = [attitude.rate.roll, attitude.rate.pitch, attitude.rate.heading];
        let sigmas = [attitude.sigma.roll, attitude.sigma.pitch, attitude.sigma.heading];
        for angle in 0..3 {
            let rate: f64 = (0..3).map(|axis| columns[axis][angle] * turning[axis]).sum();
            assert!((rates[angle] - rate).abs() < 1e-7, "{told:?}: angle {angle}");
            let variance: f64 = (0..3).map(|axis| (columns[axis][angle] * SIGMA[axis]).powi(2)).sum();
            assert!((sigmas[angle] / variance.sqrt() - 1.0).abs() < 1e-6, "{told:?}: angle {angle}");
        }
    }
}

/// Turned east, what was an error about north is one of the pitch with the other sign, and what was about east is one of the roll.
#[test]
fn a_level_ship_shows_each_sigma_where_it_belongs() {
    for (heading, roll, pitch) in [(0.0, SIGMA[1], SIGMA[0]), (TAU / 4.0, SIGMA[0], SIGMA[1])] {
        let deck = Euler { roll: 0.0, pitch: 0.0, heading }.rotation::<Sub>();
        let sigma = Attitude::new(deck, SIGMA.into(), Vec3::ZERO).unwrap().sigma;
        for (ours, wanted) in [(sigma.roll, roll), (sigma.pitch, pitch), (sigma.heading, SIGMA[2])] {
            assert!((ours - wanted).abs() < 1e-12);
        }
    }
}

#[test]
fn what_cannot_be_told_is_not_told() {
    let level = Rot::<Nav, Sub>::identity();
    assert!(Attitude::new(level, [f64::NAN, 0.0, 0.0].into(), Vec3::ZERO).is_none());
    assert!(Attitude::new(level, SIGMA.into(), [f64::INFINITY, 0.0, 0.0].into()).is_none());
    let steep = Euler { roll: 0.0, pitch: 1.5, heading: 0.0 }.rotation::<Sub>();
    assert!(Attitude::new(steep, SIGMA.into(), Vec3::ZERO).is_none());
}
