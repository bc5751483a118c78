use super::*;
use crate::flexure::Flexure;
use crate::matching::conformance::{STEP_S, Voyage};
use crate::matching::increment::Increments;
use crate::matching::{Accel, so3};
use frames::Vec3;
use frames::unit::{ARCSEC, nanoseconds};
use messages::{Header, ImuPair};

const ARM: Vec3<Main> = Vec3::new(18.0, 4.0, -7.0);

fn voyage(delay_s: f64) -> Voyage {
    Voyage { installation: Rot::exp(Vec3::new(0.7, -1.9, 1.1)), flexure: 20.0 * ARCSEC, delay_s, lever_arm: ARM }
}

fn hull() -> Hull {
    let second = Flexure { mu: 0.2, b: 2.0, sigma: 5.0 * ARCSEC };
    Hull { modes: [Flexure { mu: 0.1, b: 1.0, sigma: 20.0 * ARCSEC }; 3], second: [Some(second), None, Some(second)] }
}

/// The model after `steps` samples of a voyage, told the truth at the start but for an error; filter intervals are left unfinished at the end.
fn carried(voyage: &Voyage, shift_s: f64, error: &ErrorState, steps: usize, every: usize) -> Deck {
    let grade = Grade::default();
    let gyros = So3::new(grade, hull(), voyage.installation, Vec3::ZERO);
    let lever = Lever { accel: Accel { vrw: 1e-5, bias: 1e-4 }, arm: ARM, sigma: 0.02 };
    let options =
        Options { lever: Some(lever), delay: DelayOptions { sigma: 0.02, skew_sigma: 1e-4, retimed: shift_s != 0.0 } };
    let lag = (shift_s != 0.0).then_some(Lag { delay: shift_s, sigma: 1e-3 });
    let (mut deck, _) = Deck::new(options, grade, gyros, lag, &so3::Covariance::zeros());
    deck.velocity.as_mut().expect("told").inject(&with(place::GAIN, Vec3::<Main>::new(0.5, 0.5, 0.5).column()));
    let mut increments = Increments::default();
    let mut begun = false;
    for k in 0..=steps {
        let motion = voyage.motion(k.max(1));
        let first = k == 0;
        let attitude = |q: [f64; 4]| if first { [1.0, 0.0, 0.0, 0.0] } else { q };
        let pair = ImuPair {
            header: Header { time_ns: nanoseconds(k as f64 * STEP_S), ..Header::default() },
            interval_ns: nanoseconds(STEP_S),
            attitude_m: attitude(motion.a_m.quaternion()),
            attitude_s: attitude(motion.a_s.quaternion()),
            dtheta_s: motion.dtheta_s.array(),
            dvel_m: motion.dvel_m.array(),
            dvel_s: motion.dvel_s.array(),
            ..ImuPair::default()
        };
        let Some(step) = increments.next(&pair) else { continue };
        let t = k as f64 * STEP_S;
        deck.coast(STEP_S);
        let moved = deck.advance(t, &step);
        if moved && !begun && k.is_multiple_of(every) {
            begun = true;
            deck.propagate();
            let (theta, rate) = voyage.theta(t - voyage.delay_s);
            let mut truth = with(place::FLEXURE, theta.column() - deck.so3.flexed().0);
            truth += with(place::FLEXURE_RATE, rate.column() - deck.so3.flexed().1);
            truth[place::DELAY] = voyage.delay_s - deck.lateness();
            deck.inject(&truth);
            deck.start_epoch();
            deck.propagate();
            deck.inject(error);
        }
    }
    deck
}

fn with(place: usize, value: nalgebra::Vector3<f64>) -> ErrorState {
    let mut error = ErrorState::zeros();
    error.fixed_rows_mut::<3>(place).copy_from(&value);
    error
}

fn unit_error(i: usize, size: f64) -> ErrorState {
    let mut error = ErrorState::zeros();
    error[i] = size;
    error
}

/// A size of each error that is small, and large enough for differences.
fn size_of(i: usize) -> f64 {
    match i {
        place::VELOCITY..place::ACCEL_BIAS => 1e-3,
        place::ACCEL_BIAS..place::TRIAD => 1e-4,
        place::GAIN..place::ARM => 0.1,
        place::ARM..place::DELAY => 0.01,
        place::DELAY => 1e-4,
        place::SKEW => 1e-5,
        _ => 1e-5,
    }
}

/// With the truth in all states the flexure's too.
fn told(voyage: &Voyage, deck: &mut Deck, steps: usize) {
    deck.propagate();
    let (theta, rate) = voyage.theta(steps as f64 * STEP_S - voyage.delay_s);
    let (was, moved) = deck.so3.flexed();
    deck.inject(&(with(place::FLEXURE, theta.column() - was) + with(place::FLEXURE_RATE, rate.column() - moved)));
}

#[test]
fn the_residual_vanishes_at_the_truth_with_any_delay() {
    for delay_s in [0.0, 0.0123, 0.2] {
        let voyage = voyage(delay_s);
        for steps in [30, 100, 700, 2400] {
            let mut deck = carried(&voyage, delay_s, &ErrorState::zeros(), steps, 1);
            told(&voyage, &mut deck, steps);
            let residual = deck.observe().residual;
            let (attitude, velocity) = (residual.fixed_rows::<3>(0).amax(), residual.fixed_rows::<3>(3).amax());
            assert!(attitude < 0.01 * ARCSEC, "{delay_s} {steps}: {:e} arcsec", attitude / ARCSEC);
            assert!(velocity < 1e-5, "{delay_s} {steps}: {velocity:e} m/s");
            assert!(deck.velocity.as_ref().expect("told").is_begun());
        }
    }
}

#[test]
fn the_measurement_matrix_is_the_derivative() {
    let voyage = voyage(0.0);
    let deck = carried(&voyage, 0.0, &ErrorState::zeros(), 230, 10);
    let mut at = deck.clone();
    told(&voyage, &mut at, 230);
    let seen = at.observe();
    for i in 0..STATES {
        let after = |size: f64| at.residual_after(&unit_error(i, size));
        let numeric = (after(-size_of(i)) - after(size_of(i))) / (2.0 * size_of(i));
        for k in 0..ROWS {
            let (found, expected) = (seen.matrix[(k, i)], numeric[k]);
            let scale = seen.matrix.row(k).amax().max(1.0);
            assert!((found - expected).abs() < 4e-4 * scale, "row {k} state {i}: {found} {expected}");
        }
    }
}

#[test]
fn the_velocity_depends_on_the_errors_as_the_transition_says() {
    let voyage = voyage(0.0);
    let steps = 40;
    let transition = carried(&voyage, 0.0, &ErrorState::zeros(), steps, 10).propagate().transition;
    for i in 0..STATES {
        let velocity = |size: f64| {
            let mut deck = carried(&voyage, 0.0, &unit_error(i, size), steps, 10);
            deck.propagate();
            deck.velocity.as_ref().expect("told").velocity()
        };
        let numeric = (velocity(size_of(i)) - velocity(-size_of(i))).column() / (2.0 * size_of(i));
        let column = transition.fixed_view::<3, 1>(place::VELOCITY, i);
        let error = (numeric - column).amax();
        assert!(error < 2e-2 * numeric.amax().max(1e-2), "state {i}: {numeric} {column}");
    }
}

#[test]
fn what_is_published_is_of_the_stamp_whatever_the_delay() {
    for delay_s in [0.0, 0.0123, 0.2] {
        let voyage = voyage(delay_s);
        let steps = 1000;
        let mut deck = carried(&voyage, delay_s, &ErrorState::zeros(), steps, 1);
        told(&voyage, &mut deck, steps);
        let view = deck.view(false);
        let error = (view.deformation * voyage.deformation(steps as f64 * STEP_S).inverse()).log().norm();
        // by the flexure's model, which a sine is not: up to one tenth of its movement over the delay
        assert!(error < 0.02 * ARCSEC + 2.0 * ARCSEC * (delay_s / 0.2), "{delay_s}: {} arcsec", error / ARCSEC);
        assert!((deck.lateness() - delay_s).abs() < 1e-9);
    }
}

#[test]
fn without_accelerometers_it_is_the_gyros_model() {
    let voyage = voyage(0.0);
    let gyros = So3::new(Grade::default(), hull(), voyage.installation, Vec3::ZERO);
    let (deck, p) = Deck::new(Options::default(), Grade::default(), gyros, None, &so3::Covariance::identity());
    assert!(p.diagonal().rows(place::VELOCITY, STATES - place::VELOCITY).amax() == 0.0);
    let seen = deck.observe();
    assert!(seen.matrix.fixed_rows::<3>(3).amax() == 0.0 && seen.residual.amax() == 0.0);
}
