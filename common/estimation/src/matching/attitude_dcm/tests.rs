use super::*;
use crate::filter::Filter;
use crate::matching::conformance::{STEP_S, Voyage, matrix_is_the_derivative};
use frames::Vec3;

const MRAD: f64 = 1e-3;
const FLEXED: Flexure = Flexure { mu: 0.1, b: 1.1, sigma: 0.5 * MRAD };

fn voyage(size: f64) -> Voyage {
    Voyage {
        installation: Rot::exp(Vec3::new(3.5, -3.5, 3.5) * (size * MRAD)),
        flexure: 0.5 * size * MRAD,
        delay_s: 0.0,
        lever_arm: Vec3::ZERO,
    }
}

fn gyro(arw: f64, bias: f64) -> crate::matching::so3::Gyro {
    crate::matching::so3::Gyro { arw, bias, ..Default::default() }
}

fn start() -> Start {
    let grade = Grade { main: gyro(2e-6, 1e-7), sub: gyro(3e-6, 3e-7), ..Grade::default() };
    Start {
        grade,
        accel: Default::default(),
        lever_arm: Vec3::ZERO,
        flexure: [FLEXED; 3],
        rotation: Rot::identity(),
        covariance: Matrix3::identity() * (10.0 * MRAD).powi(2),
    }
}

fn begun() -> (AttitudeDcm, SMatrix<f64, STATES, STATES>) {
    AttitudeDcm::begin(&Options { noise: 0.01 * MRAD, static_walk: 0.0 }, &start())
}

/// The model after `k` steps of a noise-free voyage, with the truth for its state.
fn at_truth(voyage: &Voyage, k: usize) -> AttitudeDcm {
    let (mut model, _) = begun();
    (1..=k).for_each(|k| model.advance(&voyage.motion(k)));
    let (theta, rate) = voyage.theta(k as f64 * STEP_S);
    model.x.fixed_rows_mut::<3>(STATIC).copy_from(&voyage.installation.log().column());
    model.x.fixed_rows_mut::<3>(FLEXURE).copy_from(&theta.column());
    model.x.fixed_rows_mut::<3>(RATE).copy_from(&rate.column());
    // what is left of phi(0) beside phi0
    model.x.fixed_rows_mut::<3>(ATTITUDE[1]).copy_from(&voyage.theta(0.0).0.column());
    model
}

#[test]
fn the_residual_vanishes_at_the_truth_to_second_order() {
    for k in [1, 137, 522] {
        let size = at_truth(&voyage(1.0), k).observe().residual.norm();
        let double = at_truth(&voyage(2.0), k).observe().residual.norm();
        assert!(size < 0.02 * MRAD && double < 4.5 * size.max(1e-9), "{k}: {size:e} {double:e}");
    }
}

#[test]
fn without_the_flexure_at_the_start_the_residual_is_of_its_size() {
    let mut model = at_truth(&voyage(1.0), 137);
    model.x.fixed_rows_mut::<3>(ATTITUDE[1]).fill(0.0);
    assert!(model.observe().residual.norm() > 0.2 * MRAD);
}

#[test]
fn the_printed_coefficient_of_the_static_part_leaves_much() {
    // "(B - A) = I - C_i^m C_s^i is very small": as if the static part were not to be seen
    let mut model = at_truth(&voyage(1.0), 222);
    model.x.fixed_rows_mut::<3>(STATIC).fill(0.0);
    assert!(model.observe().residual.norm() > 0.1 * MRAD);
}

#[test]
fn the_measurement_matrix_is_the_derivative() {
    matrix_is_the_derivative(&at_truth(&voyage(1.0), 137), &SVector::repeat(1e-6), 1e-8);
}

#[test]
fn the_measurement_is_the_derivative_of_the_exact_one() {
    // attitude errors of the units, by turning the data themselves: C_hat = (I - [Psi x]) C
    let voyage = voyage(1.0);
    let motion = voyage.motion(137);
    let seen = |unit: usize, psi: Vector3<f64>| {
        let turn = |on: bool| Matrix3::identity() - psi.cross_matrix() * f64::from(u8::from(on));
        difference(&(turn(unit == 0) * motion.a_m.matrix()), &(turn(unit == 1) * motion.a_s.matrix()))
    };
    let matrix = at_truth(&voyage, 137).matrix();
    for unit in 0..2 {
        for axis in 0..3 {
            let step = Vector3::ith(axis, 1e-6);
            let slope = (seen(unit, step) - seen(unit, -step)) / 2e-6;
            let column = matrix.column(ATTITUDE[unit] + axis);
            assert!((slope - column).norm() < 8.0 * MRAD, "{unit} {axis}: {slope} {column}");
        }
    }
}

#[test]
fn the_transition_is_that_of_the_differential_equation() {
    let voyage = voyage(1.0);
    let (mut model, _) = begun();
    let eps = SVector::<f64, 6>::from_iterator((0..6).map(|k| 1e-6 * (k as f64 - 2.0)));
    model.x.fixed_rows_mut::<6>(BIAS[0]).copy_from(&eps);
    model.x[FLEXURE] = MRAD;
    let mut psi = SVector::<f64, 6>::zeros();
    let steps = 50;
    for k in 1..=steps {
        model.advance(&voyage.motion(k));
        // the middle of the step, by a twentieth of it
        for part in 0..20 {
            let t = (k as f64 - 1.0 + (part as f64 + 0.5) / 20.0) * STEP_S;
            let a_m = (voyage.attitude(0.0).inverse() * voyage.attitude(t)).matrix();
            let sub = |t: f64| voyage.attitude(t) * voyage.deformation(t);
            let a_s = (sub(0.0).inverse() * sub(t)).matrix();
            let rate = [-a_m * eps.fixed_rows::<3>(0), -a_s * eps.fixed_rows::<3>(3)];
            for (unit, rate) in rate.into_iter().enumerate() {
                let mut place = psi.fixed_rows_mut::<3>(3 * unit);
                place += rate * (STEP_S / 20.0);
            }
        }
    }
    let before = model.x;
    let Prediction { transition, .. } = model.propagate();
    assert!((transition * before - model.x).norm() < 1e-18);
    let found: SVector<f64, 6> = model.x.fixed_rows::<6>(ATTITUDE[0]).into();
    assert!((found - psi).norm() < 1e-4 * psi.norm(), "{found} {psi}");
    let expected = FLEXED.transition(steps as f64 * STEP_S)[(0, 0)] * MRAD;
    assert!((model.x[FLEXURE] - expected).abs() < 1e-9 * MRAD);
}

#[test]
fn the_noise_is_that_of_flexure_and_gyros() {
    let (mut model, _) = begun();
    let voyage = voyage(1.0);
    (1..=10).for_each(|k| model.advance(&voyage.motion(k)));
    let noise = model.propagate().noise;
    let flexure = FLEXED.noise(10.0 * STEP_S);
    assert!((noise[(RATE, RATE)] - flexure[(1, 1)]).abs() < 1e-12 * flexure[(1, 1)]);
    // printed: the flexure's whole noise on its angle; right: nearly none
    assert!(noise[(FLEXURE, FLEXURE)] < 0.01 * noise[(RATE, RATE)]);
    assert!((noise[(ATTITUDE[0], ATTITUDE[0])] - 4e-12 * 0.1).abs() < 1e-20);
    assert_eq!(noise[(BIAS[0], BIAS[0])], 0.0, "a random walk of the angle is none of the bias");
}

#[test]
fn a_filter_finds_the_static_part() {
    for size in [1.0, -1.0] {
        let voyage = voyage(size);
        let (mut model, mut p) = begun();
        for k in 1..=30_000 {
            model.advance(&voyage.motion(k));
            if k % 10 == 0 {
                let Prediction { transition, noise } = model.propagate();
                p = transition * p * transition.transpose() + noise;
                Filter::Kalman.correct(&mut model, &mut p, &noise).expect("sound numbers");
            }
        }
        let error = (model.view().static_part * voyage.installation.inverse()).log();
        let sigma = [0, 1, 2].map(|k| p[(k, k)].sqrt());
        assert!(
            (0..3).all(|k| error.array()[k].abs() < 3.0 * sigma[k] && sigma[k] < 2.0 * MRAD),
            "{error:?} {sigma:?}"
        );
    }
}
