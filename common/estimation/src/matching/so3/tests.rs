#![allow(clippy::unwrap_used)]
use super::*;

const DT: f64 = 0.01;

fn grade() -> Grade {
    let gyro = Gyro { arw: 3e-7, bias: 5e-8, instability: 5e-9, scale: 1e-4, misalignment: 2e-5, stamp_jitter: 0.0 };
    Grade { main: gyro, sub: gyro, static_noise: 2e-15 }
}

/// With a second mode about two axes.
fn hull() -> Hull {
    let mode = |(mu, b, sigma)| Flexure { mu, b, sigma };
    let second = [Some((0.19, 1.9, 6e-4)), None, Some((0.3, 2.5, 1e-4))];
    Hull {
        modes: [(0.21, 0.21, 1.7e-3), (0.1, 0.6, 1e-3), (0.8, 0.3, 2e-3)].map(mode),
        second: second.map(|told| told.map(mode)),
    }
}

fn installation() -> Rot<Main, Sub> {
    Rot::exp(Vec3::new(0.7, -1.9, 1.1))
}

/// Attitude of the ship's main unit at the time t, from its starting axes.
fn ship(t: f64) -> Rot<MainStart, Main> {
    Rot::exp(Vec3::new(0.17 * (0.8 * t).sin(), 0.12 * (0.7 * t + 1.0).sin(), 0.15 * (0.6 * t).sin() + 0.01 * t))
}

/// What a voyage without velocities or noise gives up to the attitudes of now.
fn increment(a_m: Rot<MainStart, Main>, a_s: Rot<SubStart, Sub>, dtheta_m: Vec3<Main>) -> Increment {
    Increment {
        time_ns: 0,
        time_s: DT,
        a_m,
        a_s,
        dtheta_m,
        disturbance: 0.0,
        rate_changes: Matrix3::zeros(),
        velocities: None,
        spiked_s: 0.0,
    }
}

/// A state carried over ten noise-free seconds of a rigid ship, with the given error put into it at the start.
fn carried(error: &ErrorState) -> So3 {
    let mut so3 = So3::new(grade(), hull(), installation(), Vec3::new(1e-4, -2e-4, 3e-4));
    so3.theta = [Vector3::new(1e-5, -2e-5, 1e-5), Vector3::new(-2e-5, 1e-5, 3e-5)];
    so3.theta_rate = [Vector3::new(2e-6, 1e-6, -1e-6), Vector3::new(1e-6, -3e-6, 2e-6)];
    so3.start_epoch(ship(0.0), ship(0.0).relabel::<SubStart, Main>() * installation(), Rot::identity());
    so3.inject(error);
    for k in 1..=1000 {
        let t = k as f64 * DT;
        let a_m = ship(t);
        let a_s = a_m.relabel::<SubStart, Main>() * installation();
        so3.coast(DT);
        so3.advance(&increment(a_m, a_s, (ship(t - DT).inverse() * a_m).log()));
    }
    so3
}

fn unit_error(i: usize, size: f64) -> ErrorState {
    let mut error = ErrorState::zeros();
    error[i] = size;
    error
}

/// The error of `b` when `a` is the truth.
fn difference(a: &So3, b: &So3) -> ErrorState {
    let mut error = ErrorState::zeros();
    let mut set = |place: usize, v: Vector3<f64>| error.fixed_rows_mut::<3>(place).copy_from(&v);
    set(place::STATIC, (a.static_part * b.static_part.inverse()).log().column());
    set(place::STATIC_RATE, (a.static_rate - b.static_rate).column());
    for (which, (angle, rate)) in MODES.into_iter().enumerate() {
        set(angle, a.theta[which] - b.theta[which]);
        set(rate, a.theta_rate[which] - b.theta_rate[which]);
    }
    set(place::CONSTANT, -(a.constant * b.constant.inverse()).log().column());
    set(place::BIAS, (a.bias - b.bias).column());
    set(place::WANDER, (a.wander - b.wander).column());
    error.fixed_rows_mut::<6>(place::SCALE).copy_from(&(a.scale - b.scale));
    error
}

#[test]
fn transition_is_the_central_difference_of_the_nominal_motion() {
    let transition = carried(&ErrorState::zeros()).propagate().transition;
    for i in 0..STATES {
        let size = 1e-5;
        let (mut plus, mut minus) = (carried(&unit_error(i, size)), carried(&unit_error(i, -size)));
        plus.propagate();
        minus.propagate();
        let column = difference(&plus, &minus) / (2.0 * size);
        let error = (column - transition.column(i)).amax();
        // the bias of 4e-4 rad/s turns the constant by 4e-3 rad in ten seconds: that is the size of what is of second order
        assert!(error < 1e-2 * transition.column(i).amax(), "state {i}: {error}");
    }
}

#[test]
fn measurement_matrix_is_the_central_difference_of_the_residual() {
    let seen = carried(&ErrorState::zeros()).observe();
    for i in 0..STATES {
        let size = 1e-5;
        let moved = |size: f64| {
            let mut so3 = carried(&ErrorState::zeros());
            so3.inject(&unit_error(i, size));
            so3.observe().residual
        };
        let column = (moved(-size) - moved(size)) / (2.0 * size);
        assert!((column - seen.matrix.column(i)).amax() < 4e-3, "state {i}: {column} {}", seen.matrix.column(i));
    }
}

#[test]
fn residual_vanishes_at_the_truth() {
    let mut so3 = So3::new(grade(), hull(), installation(), Vec3::ZERO);
    so3.start_epoch(ship(0.0), ship(0.0).relabel::<SubStart, Main>() * installation(), Rot::identity());
    for k in 1..=6000 {
        let t = k as f64 * DT;
        let a_m = ship(t);
        let a_s = a_m.relabel::<SubStart, Main>() * installation();
        so3.advance(&increment(a_m, a_s, (ship(t - DT).inverse() * a_m).log()));
        assert!(so3.observe().residual.amax() < 1e-13);
    }
}

#[test]
fn errors_of_scale_and_bias_turn_the_constant_as_the_transition_says() {
    // the units really have these errors; the state is told, so nothing may be left
    let bias = Vec3::<Main>::new(2e-4, -1e-4, 1e-4);
    let scale = SVector::<f64, 6>::from([1e-3, -2e-3, 5e-4, 3e-4, -2e-4, 1e-4]);
    let mut so3 = So3::new(grade(), hull(), installation(), bias);
    so3.scale = scale;
    let mut felt = Rot::<MainStart, Main>::identity();
    let start = ship(0.0).inverse();
    so3.start_epoch(felt, Rot::<SubStart, Sub>::identity(), Rot::identity());
    for k in 1..=3000 {
        let t = k as f64 * DT;
        let true_turn = (ship(t - DT).inverse() * ship(t)).log();
        let felt_turn = true_turn + bias * DT + Vec3::from_column(symmetric(&scale) * true_turn.column());
        felt = felt * Rot::<Main, Main>::exp(felt_turn);
        let a_s = installation().inverse().relabel::<SubStart, Main>()
            * start.relabel::<Main, MainStart>()
            * ship(t)
            * installation();
        so3.advance(&increment(felt, a_s, felt_turn));
    }
    let error = (so3.deformation() * installation().inverse()).log().norm();
    assert!(error < 2e-4, "{error}: against {} untold", 30.0 * bias.norm());
}

#[test]
fn static_noise_is_the_integral_of_its_density() {
    let mut so3 = carried(&ErrorState::zeros());
    let h = so3.pending_s();
    let noise = so3.propagate().noise;
    let n = 1000;
    let mut sum = [0.0; 3];
    for i in 0..n {
        let left = h - (i as f64 + 0.5) * h / n as f64;
        let q = grade().static_noise * h / n as f64;
        sum = [sum[0] + left * left * q, sum[1] + left * q, sum[2] + q];
    }
    for (found, expected) in [(noise[(0, 0)], sum[0]), (noise[(0, 3)], sum[1]), (noise[(3, 3)], sum[2])] {
        assert!((found - expected).abs() < 1e-5 * expected);
    }
}

#[test]
fn a_new_epoch_keeps_the_deformation_and_its_error() {
    let mut so3 = carried(&unit_error(place::STATIC, 1e-3));
    let transition = so3.start_epoch(ship(3.0), Rot::<SubStart, Sub>::exp(Vec3::new(1.0, 2.0, -0.5)), Rot::identity());
    assert!((so3.deformation() * so3.predicted().inverse()).log().norm() < 1e-14);
    let rows = so3.deformation_rows() * transition;
    let by_static = rows.fixed_view::<3, 3>(0, place::STATIC);
    assert!(
        (by_static + Matrix3::identity()).norm() < 1e-12,
        "an error of the static part is one of the deformation: {by_static}"
    );
    assert!(so3.observe().residual.amax() < 1e-14);
}

#[test]
fn scale_figures_turn_with_the_installation() {
    let mut grade = grade();
    grade.sub.scale = 1e-2;
    let straight = grade.scale_covariance(Rot::identity());
    assert!((straight[(0, 0)].sqrt() - 1e-2).abs() < 1e-4 && straight[(3, 3)].sqrt() < 1e-3);
    let turned = grade.scale_covariance(Rot::exp(Vec3::new(0.0, 0.0, std::f64::consts::FRAC_PI_4)));
    assert!(turned[(3, 3)].sqrt() > 4e-3, "scale errors look like non-orthogonality at 45 degrees");
}
