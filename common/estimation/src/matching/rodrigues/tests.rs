use super::*;
use crate::matching::conformance::{STEP_S, Voyage, matrix_is_the_derivative};
use crate::matching::so3::Gyro;
use frames::unit::{ARCMIN, DEG_PER_H};

const ARM: Vec3<Main> = Vec3::new(10.0, 10.0, 2.0);
const CRITICAL: Flexure = Flexure { mu: 0.2146, b: 0.2146, sigma: 6.0 * ARCMIN };

fn voyage(installation: Vec3<Main>) -> Voyage {
    Voyage { installation: Rot::exp(installation), flexure: 6.0 * ARCMIN, delay_s: 0.0, lever_arm: ARM }
}

fn start(rotation: Rot<Main, Sub>, flexure: Flexure) -> Start {
    let gyro = Gyro { arw: 2.9e-7, bias: 0.01 * DEG_PER_H, ..Gyro::default() };
    Start {
        grade: Grade { main: gyro, sub: gyro, static_noise: 0.0 },
        accel: Accel { vrw: 1e-4, bias: 5e-4 },
        lever_arm: ARM,
        flexure: [flexure; 3],
        rotation,
        covariance: Matrix3::identity() * ARCMIN.powi(2),
    }
}

/// A model that has been told the truth of the voyage at step `k`, its velocities starting at step 2.
fn at_truth(installation: Vec3<Main>, options: Options, k: usize) -> RodriguesMatching {
    let voyage = voyage(installation);
    let (mut model, _) = RodriguesMatching::begin(&options, &start(voyage.deformation(0.0), CRITICAL));
    let mut lever = Vector3::zeros();
    for step in 1..=k {
        model.advance(&voyage.motion(step));
        if step <= 2 {
            model.propagate();
        }
        if step == 2 {
            lever = model.arm * bent(&voyage, step);
        }
    }
    model.pending = Pending::default();
    model.x.fill(0.0);
    model.x.fixed_rows_mut::<3>(PARAMETERS).copy_from(&parameters(voyage.deformation(0.0)));
    model.x.fixed_rows_mut::<6>(FLEXURE).copy_from(&bent(&voyage, k));
    model.x.fixed_rows_mut::<3>(LEVER).copy_from(&(model.arm * bent(&voyage, k) - lever));
    model
}

fn bent(voyage: &Voyage, k: usize) -> SVector<f64, 6> {
    let (theta, rate) = voyage.theta(k as f64 * STEP_S);
    SVector::from_fn(|i, _| if i < 3 { theta.array()[i] } else { rate.array()[i - 3] })
}

/// Differences of velocity and of rate, and what the model at the truth leaves of them.
fn residuals(model: &RodriguesMatching) -> [f64; 4] {
    let residual = model.observe().residual;
    let velocities = model.velocities.as_ref().expect("started");
    let plain = (velocities.s - velocities.m).norm();
    let rates = (model.sample.w_s - model.sample.w_m).norm();
    [plain, residual.fixed_rows::<3>(0).norm(), rates, residual.fixed_rows::<3>(3).norm()]
}

#[test]
fn the_residual_vanishes_at_the_truth_at_any_installation() {
    for installation in [Vec3::new(10.0, 10.0, 30.0) * ARCMIN, Vec3::new(0.4, -0.2, 1.5)] {
        for k in [137, 522, 1500] {
            let [velocity, left, rate, rate_left] = residuals(&at_truth(installation, Options::default(), k));
            // the rate at a sample's end is a straight line's through two means: off by 5/12 of its second derivative, over 14 m
            assert!(left < 4e-5 && left < 1e-3 * velocity, "{installation:?} {k}: {left:e} of {velocity:e}");
            // the flexure's rate in the sample's middle against its end: half a step of theta'', whose norm is at most 2.5 amplitudes
            let half = 0.5 * STEP_S * 2.5 * 6.0 * ARCMIN;
            assert!(rate_left < half && half < 0.03 * rate, "{installation:?} {k}: {rate_left:e} of {rate:e}");
        }
    }
}

#[test]
fn the_other_sign_of_the_parameters_leaves_much() {
    let mut model = at_truth(Vec3::new(10.0, 10.0, 30.0) * ARCMIN, Options::default(), 522);
    let [velocity, left, ..] = residuals(&model);
    let l = model.three(PARAMETERS);
    model.x.fixed_rows_mut::<3>(PARAMETERS).copy_from(&-l);
    let other = residuals(&model)[1];
    assert!(other > 100.0 * left, "{other:e} {left:e} of {velocity:e}");
}

#[test]
fn without_the_dynamic_lever_arm_its_velocity_is_left() {
    let rigid = Options { dynamic_lever_arm: false, ..Options::default() };
    let installation = Vec3::new(10.0, 10.0, 30.0) * ARCMIN;
    let [_, left, ..] = residuals(&at_truth(installation, rigid, 522));
    let [_, bending, ..] = residuals(&at_truth(installation, Options::default(), 522));
    assert!(left > 50.0 * bending, "{left:e} {bending:e}");
}

#[test]
fn the_measurement_matrix_is_the_derivative() {
    let step = SVector::<f64, STATES>::repeat(1e-3);
    for k in [137, 522] {
        let mut model = at_truth(Vec3::new(0.1, -0.2, 0.3), Options::default(), k);
        model.x.fixed_rows_mut::<3>(VELOCITY).fill(0.3);
        model.x.fixed_rows_mut::<3>(TILT).fill(1e-4);
        matrix_is_the_derivative(&model, &step, 1e-6);
    }
}

#[test]
fn the_chain_gives_the_truth_and_the_sum_lacks_the_flexure_at_the_start() {
    let installation = Vec3::new(10.0, 10.0, 30.0) * ARCMIN;
    let truth = voyage(installation);
    for k in [137, 522, 1500] {
        let angle = |rotation: Rot<Main, Sub>| (rotation * truth.deformation(k as f64 * STEP_S).inverse()).angle();
        let chain = at_truth(installation, Options::default(), k).view();
        assert!(angle(chain.deformation) < 1e-9, "{k}");
        let static_error = (chain.static_part * Rot::<Main, Sub>::exp(installation).inverse()).angle();
        assert!(static_error < 1e-9);
        let sum = Options { output: Output::Sum, ..Options::default() };
        let off = angle(at_truth(installation, sum, k).view().deformation);
        let (theta, _) = truth.theta(0.0);
        assert!((off - theta.norm()).abs() < 0.02 * theta.norm(), "{k}: {off:e}");
    }
}

#[test]
fn the_rows_of_the_view_are_derivatives() {
    for output in [Output::Chain, Output::Sum] {
        let mut model = at_truth(Vec3::new(0.1, -0.2, 0.3), Options { output, ..Options::default() }, 137);
        model.pending.time_s = 0.05;
        let view = model.view();
        for i in 0..STATES {
            let mut error = SVector::<f64, STATES>::zeros();
            error[i] = 1e-6;
            let mut other = model.clone();
            other.inject(&error);
            let moved = other.view();
            let total = (moved.deformation * view.deformation.inverse()).log().column() / 1e-6;
            assert!((total - view.rows.column(i)).norm() < 5e-3, "{output:?} {i}: {total} {}", view.rows.column(i));
            let fixed = (moved.static_part * view.static_part.inverse()).log().column() / 1e-6;
            assert!((fixed - view.static_rows.column(i)).norm() < 5e-3, "{output:?} {i}");
        }
    }
}

/// Two half steps of the transition and noise are the whole step's.
#[test]
fn propagation_composes() {
    let truth = voyage(Vec3::new(10.0, 10.0, 30.0) * ARCMIN);
    let begin = || {
        let mut model = RodriguesMatching::begin(&Options::default(), &start(truth.deformation(0.0), CRITICAL)).0;
        for k in 1..=2 {
            model.advance(&truth.motion(k));
            model.propagate();
        }
        model
    };
    let (mut whole, mut halves) = (begin(), begin());
    (3..=22).for_each(|k| whole.advance(&truth.motion(k)));
    let one = whole.propagate();
    (3..=12).for_each(|k| halves.advance(&truth.motion(k)));
    let first = halves.propagate();
    (13..=22).for_each(|k| halves.advance(&truth.motion(k)));
    let second = halves.propagate();
    let transition = second.transition * first.transition;
    assert!((transition - one.transition).amax() < 1e-9, "{:e}", (transition - one.transition).amax());
    let noise = second.transition * first.noise * second.transition.transpose() + second.noise;
    for place in [(TILT, TILT), (LEVER, LEVER), (FLEXURE, FLEXURE), (RATE, LEVER), (RATE + 1, RATE + 1)] {
        let (a, b) = (noise[place], one.noise[place]);
        assert!((a - b).abs() < 1e-6 * b.abs(), "{place:?}: {a:e} {b:e}");
    }
}

/// 000 eqs 54-56, 75, 76 as printed, integrated by small steps: the same lever arm velocity as the boundary terms.
#[test]
fn the_bending_lever_arms_velocity_is_the_integral_of_its_acceleration() {
    let truth = voyage(Vec3::ZERO);
    let mut model = at_truth(Vec3::ZERO, Options::default(), 2);
    let before = model.arm * bent(&truth, 2);
    let l0 = -ARM.skew();
    let mut sum = Vector3::zeros();
    for k in 3..=202 {
        let t = (k as f64 - 0.5) * STEP_S;
        let h = 1e-3;
        let w = truth.rate(t).column();
        let w_dot = (truth.rate(t + h) - truth.rate(t - h)).column() / (2.0 * h);
        let (theta, rate) = truth.theta(t);
        let second = (truth.theta(t + h).1 - truth.theta(t - h).1).column() / (2.0 * h);
        let turn = w.cross_matrix();
        let arm =
            (turn * turn + w_dot.cross_matrix()) * l0 * theta.column() + turn * l0 * rate.column() * 2.0 + l0 * second;
        let c: Rot<MainStart, Main> = (truth.attitude(0.0).inverse() * truth.attitude(t)).relabel();
        sum += c.matrix() * arm * STEP_S;
        model.advance(&truth.motion(k));
    }
    let boundary = model.arm * bent(&truth, 202) - before;
    assert!((sum - boundary).norm() < 2e-3 * boundary.norm(), "{sum} {boundary}");
}

#[test]
fn the_flexures_noise_enters_the_lever_arm_with_it() {
    let truth = voyage(Vec3::ZERO);
    let mut model = at_truth(Vec3::ZERO, Options::default(), 2);
    model.advance(&truth.motion(3));
    let noise = model.propagate().noise;
    let driven: SMatrix<f64, 3, 3> = noise.fixed_view::<3, 3>(RATE, RATE).into();
    let expected = CRITICAL.density() * STEP_S;
    assert!((driven[(0, 0)] - expected).abs() < 0.01 * expected);
    // eq 77: G has C L0 where Vr is
    let lever: Matrix3<f64> = noise.fixed_view::<3, 3>(LEVER, RATE).into();
    let printed = model.a_m.matrix() * -ARM.skew() * driven;
    assert!((lever - printed).amax() < 0.01 * printed.amax());
}

#[test]
fn lost_samples_start_the_velocities_anew() {
    let truth = voyage(Vec3::ZERO);
    let mut model = at_truth(Vec3::ZERO, Options::default(), 50);
    model.advance(&Motion { interval_s: 5.0 * STEP_S, ..truth.motion(55) });
    assert!(model.velocities.is_none());
    model.advance(&truth.motion(56));
    let prediction = model.propagate();
    assert!(model.velocities.is_some() && prediction.transition[(VELOCITY, VELOCITY)] == 0.0);
}

#[test]
fn an_adopted_flexure_counts_as_larger_unless_told_otherwise() {
    for (cautious, factor) in [(true, WIDER), (false, 1.0)] {
        let options = Options { cautious, ..Options::default() };
        let mut model = RodriguesMatching::begin(&options, &start(Rot::identity(), CRITICAL)).0;
        assert_eq!(model.flexure, [CRITICAL; 3], "what is told stays as it is");
        model.set_flexure([Flexure { mu: 0.24, b: 0.48, sigma: ARCMIN }; 3]);
        assert!((model.flexure[0].sigma - factor * ARCMIN).abs() < 1e-12);
    }
}
