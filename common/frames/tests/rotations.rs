//! Properties of rotations, half turns and tiny angles included.
#![allow(clippy::unwrap_used)]

use frames::{Euler, Main, Nav, Rot, Sub, Vec3, unit};
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};

fn vector(length: f64) -> impl Strategy<Value = [f64; 3]> {
    (-1.0..1.0f64, -1.0..1.0f64, -1.0..1.0f64, 0.0..1.0f64).prop_filter_map("no direction", move |(x, y, z, r)| {
        let n = (x * x + y * y + z * z).sqrt();
        (n > 1e-3).then(|| [x, y, z].map(|c| c / n * r * length))
    })
}

proptest! {
    #[test]
    fn log_undoes_exp(v in vector(PI)) {
        let phi = Vec3::<Main>::from(v);
        let back = Rot::<Main, Sub>::exp(phi).log();
        // near a half turn the two signs of the axis are the same rotation
        let error = (back - phi).norm().min((back + phi * ((TAU - phi.norm()) / phi.norm())).norm());
        prop_assert!(error < 4e-15 * (1.0 + phi.norm()), "{phi:?} {back:?}");
    }

    #[test]
    fn log_keeps_the_relative_precision_of_tiny_angles(v in vector(1e-6)) {
        let phi = Vec3::<Main>::from(v);
        let back = Rot::<Main, Sub>::exp(phi).log();
        prop_assert!((back - phi).norm() <= 1e-15 * phi.norm());
    }

    #[test]
    fn left_jacobian_is_the_central_difference_of_the_logarithm(v in vector(3.0)) {
        let phi = Vec3::<Main>::from(v);
        let r = Rot::<Main, Sub>::exp(phi);
        let jacobian = phi.left_jacobian_inverse();
        for axis in 0..3 {
            let mut e = [0.0; 3];
            e[axis] = 1e-5;
            let turned = |e: Vec3<Main>| (Rot::<Main, Main>::exp(e) * r).log_beside(phi);
            let column = (turned(e.into()) - turned(-Vec3::from(e))) / 2e-5;
            prop_assert!((column.column() - jacobian.column(axis)).norm() < 1e-6 * (1.0 + 1.0 / (3.15 - phi.norm()).powi(2)));
        }
    }

    #[test]
    fn neighbours_stay_neighbours_across_a_half_turn(v in vector(1e-3)) {
        let near = Vec3::<Main>::new(2.0, -2.0, 1.387_192_8);
        let turned = Rot::<Main, Main>::exp(v.into()) * Rot::<Main, Sub>::exp(near);
        prop_assert!((turned.log_beside(near) - near).norm() < 3e-3);
    }

    #[test]
    fn a_product_turns_like_its_factors(a in vector(PI), b in vector(PI), v in vector(10.0)) {
        let (a, b) = (Rot::<Nav, Main>::exp(a.into()), Rot::<Main, Sub>::exp(b.into()));
        let v = Vec3::<Sub>::from(v);
        prop_assert!((a * b * v - a * (b * v)).norm() < 1e-13);
        prop_assert!((a.matrix() * b.matrix() * v.column() - (a * b * v).column()).norm() < 1e-13);
    }

    #[test]
    fn matrix_and_quaternion_name_the_same_rotation(v in vector(PI)) {
        let r = Rot::<Main, Sub>::exp(v.into());
        let from_matrix = Rot::<Main, Sub>::from_matrix(&r.matrix());
        let from_quaternion = Rot::<Main, Sub>::from_quaternion(r.quaternion()).unwrap();
        prop_assert!((from_matrix.inverse() * r).log().norm() < 1e-14);
        prop_assert!((from_quaternion.inverse() * r).log().norm() < 1e-14);
        prop_assert!(r.quaternion()[0] >= 0.0);
    }

    #[test]
    fn euler_angles_come_back(roll in -PI..PI, pitch in -1.57..1.57f64, heading in 0.0..TAU) {
        let back = Euler { roll, pitch, heading }.rotation::<Main>().euler();
        prop_assert!((back.roll - roll).abs() < 1e-11 && (back.pitch - pitch).abs() < 1e-11);
        prop_assert!((back.heading - heading).abs() < 1e-11);
    }
}

#[test]
fn a_half_turn_has_the_length_pi() {
    let r = Rot::<Main, Sub>::exp(Vec3::new(PI, 0.0, 0.0));
    assert!((r.angle() - PI).abs() < 1e-15);
    assert!((r * Vec3::new(0.0, 1.0, 0.0) - Vec3::new(0.0, -1.0, 0.0)).norm() < 1e-15);
}

#[test]
fn signs_are_those_of_the_conventions_page() {
    let small = 0.1;
    let port = Vec3::<Main>::new(-1.0, 0.0, 0.0);
    let bow = Vec3::<Main>::new(0.0, 1.0, 0.0);
    let roll = Euler { roll: small, pitch: 0.0, heading: 0.0 }.rotation::<Main>();
    assert!((roll * port).z() > 0.0, "roll is positive with the port side up");
    let pitch = Euler { roll: 0.0, pitch: small, heading: 0.0 }.rotation::<Main>();
    assert!((pitch * bow).z() > 0.0, "pitch is positive with the bow up");
    let east = Euler { roll: 0.0, pitch: 0.0, heading: PI / 2.0 }.rotation::<Main>();
    assert!((east * bow).x() > 0.999, "heading 90 degrees is east");
}

#[test]
fn nanoseconds_and_seconds_agree() {
    assert_eq!(unit::seconds(10_000_000), 0.01);
    assert_eq!(unit::nanoseconds(0.015653), 15_653_000);
}
