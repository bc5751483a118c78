use super::*;
use crate::matching::conformance::{STEP_S, Voyage, matrix_is_the_derivative};
use crate::matching::constant::Since;
use crate::matching::grade::Grade;
use frames::unit::ARCSEC;

const RETIMED: DelayOptions = DelayOptions { sigma: 0.05, skew_sigma: 1e-4, retimed: true };

fn voyage(delay_s: f64) -> Voyage {
    let installation = Rot::exp(Vec3::new(150.0, -200.0, 250.0) * ARCSEC);
    Voyage { installation, flexure: 20.0 * ARCSEC, delay_s, lever_arm: Vec3::ZERO }
}

fn start() -> Start {
    Start {
        grade: Grade { static_noise: 1e-6 * ARCSEC * ARCSEC, ..Grade::default() },
        accel: Default::default(),
        lever_arm: Vec3::ZERO,
        flexure: [Flexure { mu: 0.1, b: 1.0, sigma: 20.0 * ARCSEC }; 3],
        rotation: Rot::identity(),
        covariance: Matrix3::identity() * 1e-6,
    }
}

/// A model that has come to step `k` of a voyage, at the truth.
fn at_truth(voyage: &Voyage, shift: f64, k: usize) -> Quaternion {
    let (mut model, _) = Quaternion::begin(&Options { delay: RETIMED, ..Options::default() }, &start());
    let mut known = shift;
    model.chain.attitudes.absorb(&mut known);
    (1..=k).for_each(|k| model.advance(&voyage.motion(k)));
    let moment = k as f64 * STEP_S - voyage.delay_s.max(0.0);
    let (theta, rate) = voyage.theta(moment);
    model.state.static_part = voyage.installation;
    (model.state.theta, model.state.theta_rate) = (theta.column(), rate.column());
    model.state.link.delay = voyage.delay_s - shift;
    // the exact constant of the two starting frames
    let main = voyage.attitude(0.0);
    let sub = voyage.attitude(-voyage.delay_s) * voyage.deformation(-voyage.delay_s);
    model.state.link.constant = (main.inverse() * sub).relabel();
    model.chain.begun = true;
    model.chain.since = Since::default();
    model
}

#[test]
fn the_residual_vanishes_at_the_truth_to_second_order_of_the_rest() {
    for delay_s in [0.0, 0.02, 0.2, -0.06] {
        for k in [137, 522] {
            let exact = at_truth(&voyage(delay_s), delay_s, k).observe().residual.norm();
            assert!(exact < 1e-3 * ARCSEC, "{delay_s} {k}: {}", exact / ARCSEC);
        }
    }
    let left = |rest: f64| at_truth(&voyage(0.2), 0.2 - rest, 522).observe().residual.norm();
    assert!(left(2e-3) < 0.05 * ARCSEC && (left(2e-3) / left(1e-3) - 4.0).abs() < 0.2);
}

#[test]
fn the_linear_term_alone_fails_at_200_ms() {
    // 002 eq 12 to first order: w' tau^2 / 2
    let left = at_truth(&voyage(0.2), 0.0, 522).observe().residual.norm();
    assert!(left > 50.0 * ARCSEC, "{}", left / ARCSEC);
}

#[test]
fn the_measurement_matrix_is_the_derivative() {
    let voyage = voyage(0.02);
    let mut step = SVector::<f64, STATES>::repeat(1e-6);
    step[DELAY] = 1e-5;
    matrix_is_the_derivative(&at_truth(&voyage, 0.02, 137), &step, 2e-3);
    matrix_is_the_derivative(&at_truth(&voyage, 0.019, 522), &step, 2e-3);
}

#[test]
fn the_transition_is_the_derivative() {
    let voyage = voyage(0.02);
    let steps = 10;
    let base = at_truth(&voyage, 0.02, 137);
    let moved = |error: &SVector<f64, STATES>| {
        let mut model = base.clone();
        model.chain.since = Since::default();
        model.state = model.state.moved(error);
        (138..138 + steps).for_each(|k| model.advance(&voyage.motion(k)));
        (model.propagate(), model.state)
    };
    let (Prediction { transition, .. }, nominal) = moved(&SVector::zeros());
    for i in 0..STATES {
        let mut error = SVector::<f64, STATES>::zeros();
        error[i] = 1e-6;
        let state = moved(&error).1;
        let three = |v: Vec3<Main>| v.column();
        let mut found = SVector::<f64, STATES>::zeros();
        let mut put = |place: usize, v: Vector3<f64>| found.fixed_rows_mut::<3>(place).copy_from(&v);
        put(STATIC, three((state.static_part * nominal.static_part.inverse()).log()));
        put(STATIC_RATE, three(state.static_rate - nominal.static_rate));
        put(FLEXURE, state.theta - nominal.theta);
        put(FLEXURE_RATE, state.theta_rate - nominal.theta_rate);
        put(CONSTANT, -(state.link.constant * nominal.link.constant.inverse()).log().column());
        put(BIAS, three(state.link.bias - nominal.link.bias));
        found[DELAY] = state.link.delay - nominal.link.delay;
        found[SKEW] = state.skew - nominal.skew;
        let difference = (found / 1e-6 - transition.column(i)).amax();
        assert!(difference < 1e-5, "state {i}: {difference:e}");
    }
}

#[test]
fn the_noise_is_the_integral_of_the_densities() {
    let options = Options { static_walk: 2e-12, ..Options::default() };
    let run = |parts: usize| {
        let (mut model, _) = Quaternion::begin(&options, &start());
        model.chain.grade.main.arw = 1e-7;
        model.chain.begun = true;
        let mut p = SMatrix::<f64, STATES, STATES>::zeros();
        for _ in 0..parts {
            model.chain.since.time_s = 0.5 / parts as f64;
            model.chain.since.walk = 1e-14 * model.chain.since.time_s;
            let Prediction { transition, noise } = model.propagate();
            p = transition * p * transition.transpose() + noise;
        }
        p
    };
    assert!((run(1) - run(64)).norm() < 1e-9 * run(1).norm());
    let (one, static_walk) = (run(1), 2e-12 * 0.5);
    assert!((one[(0, 0)] - static_walk - 1e-6 * ARCSEC * ARCSEC * 0.125 / 3.0).abs() < 1e-9 * static_walk);
}

#[test]
fn the_constant_begins_with_the_error_of_what_it_is_made_of() {
    let voyage = voyage(0.2);
    let (mut model, p) = Quaternion::begin(&Options { delay: RETIMED, ..Options::default() }, &start());
    let mut known = 0.2;
    model.chain.attitudes.absorb(&mut known);
    for k in 1..=10 {
        model.advance(&voyage.motion(k));
    }
    assert!(model.chain.attitudes.together().is_none(), "the main unit's attitude before the start is not known");
    assert_eq!(model.observe().matrix.amax(), 0.0);
    (11..=40).for_each(|k| model.advance(&voyage.motion(k)));
    let Prediction { transition, noise } = model.propagate();
    let p = transition * p * transition.transpose() + noise;
    let seen = model.observe();
    let left = seen.matrix * p * seen.matrix.transpose();
    assert!(seen.residual.norm() < 1e-12 && left.diagonal().amax() < 1e-9 * p[(0, 0)], "{left}");
}

#[test]
fn the_output_is_of_the_stamp_not_of_the_data() {
    for (delay_s, tolerance) in [(0.0, 1e-3), (0.03, 0.05), (0.2, 1.0), (-0.06, 1e-3)] {
        let voyage = voyage(delay_s);
        let model = at_truth(&voyage, delay_s, 522);
        let error = (model.view().deformation * voyage.deformation(522.0 * STEP_S).inverse()).log().norm();
        assert!(error < tolerance * ARCSEC, "{delay_s}: {}", error / ARCSEC);
    }
}

#[test]
fn a_rest_beyond_a_millisecond_is_re_timed_and_nothing_else_moves() {
    let voyage = voyage(0.03);
    let mut model = at_truth(&voyage, 0.025, 300);
    let before = model.observe().residual;
    let mut error = SVector::<f64, STATES>::zeros();
    error[DELAY] = 1e-9;
    model.inject(&error);
    assert!(model.state.link.delay.abs() < 1e-15 && (model.chain.attitudes.shift() - 0.03).abs() < 2e-9);
    assert!(
        (model.observe().residual - before).norm() < 0.5 * ARCSEC && model.observe().residual.norm() < 0.01 * ARCSEC
    );
    assert_eq!(
        model.view().delay.map(|(value, _)| value),
        Some(model.chain.attitudes.shift() + model.state.link.delay)
    );
}
