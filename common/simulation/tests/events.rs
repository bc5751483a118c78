//! What goes wrong at a time: the unit, its wire, the sea and a hull with a second mode.
#![allow(clippy::unwrap_used)]

use messages::ImuSample;
use simulation::*;

/// Of every run, s.
const AT_S: f64 = 7.0;
const AT_NS: i64 = 7_000_000_000;

fn scenario(seed: u64, troubles: &[Trouble]) -> Scenario {
    let mut scenario = Scenario { seed, duration_s: Some(20.0), ..Scenario::default() };
    scenario.areas[0].wire = Wire { delay_s: 0.004, jitter_s: 1e-4, loss: 0.02, duplicate: 0.02, ..Wire::default() };
    scenario.areas[0].events = troubles.iter().map(|&trouble| Event { at_s: AT_S, trouble }).collect();
    scenario
}

fn run(scenario: &Scenario) -> Vec<Epoch> {
    let mut simulator = Simulator::new(scenario);
    std::iter::from_fn(|| simulator.step().cloned()).collect()
}

fn samples(scenario: &Scenario) -> Vec<ImuSample> {
    run(scenario).into_iter().flat_map(|epoch| epoch.sub).collect()
}

/// The true end, which at 100 Hz and without a phase belongs to the number.
fn end_ns(sample: &ImuSample) -> i64 {
    sample.header.sequence as i64 * 10_000_000
}

/// The samples of a run with troubles beside the same of a run without.
fn beside(seed: u64, troubles: &[Trouble]) -> Vec<(ImuSample, ImuSample)> {
    let (spoilt, sound) = (samples(&scenario(seed, troubles)), samples(&scenario(seed, &[])));
    assert_eq!(spoilt.len(), sound.len());
    spoilt.into_iter().zip(sound).collect()
}

#[test]
fn a_dead_triad_reads_zero_from_its_time_on() {
    for seed in 0..3 {
        for (spoilt, sound) in beside(seed, &[Trouble::DeadAccelerometers]) {
            let dvel = if end_ns(&sound) < AT_NS { sound.dvel } else { [0.0; 3] };
            assert_eq!(spoilt, ImuSample { dvel, ..sound });
        }
    }
}

#[test]
fn a_stuck_axis_repeats_its_last_value_bit_for_bit() {
    for (seed, axis) in [(0, 0), (1, 1), (2, 2), (3, 3)] {
        // the last value before may be that of a sample that is lost
        let mut lossless = scenario(seed, &[]);
        lossless.areas[0].wire = Wire::default();
        let held = samples(&lossless).iter().rfind(|sample| end_ns(sample) < AT_NS).unwrap().dtheta;
        let mut stuck = 0;
        for (spoilt, sound) in beside(seed, &[Trouble::StuckGyro(axis)]) {
            let mut dtheta = sound.dtheta;
            if let Some(value) = dtheta.get_mut(axis).filter(|_| end_ns(&sound) >= AT_NS) {
                *value = held[axis];
                stuck += 1;
            }
            assert_eq!(spoilt.dtheta.map(f64::to_bits), dtheta.map(f64::to_bits));
            assert_eq!(spoilt, ImuSample { dtheta, ..sound });
        }
        assert_eq!(stuck > 1200, axis < 3, "a fourth axis is none");
    }
}

#[test]
fn a_gap_has_no_samples_and_changes_no_others() {
    for seed in 0..3 {
        let gapped = samples(&scenario(seed, &[Trouble::Gap(2.5)]));
        let mut sound = samples(&scenario(seed, &[]));
        let whole = sound.len();
        sound.retain(|sample| !(AT_NS..AT_NS + 2_500_000_000).contains(&end_ns(sample)));
        assert_eq!(gapped, sound);
        assert!((220..280).contains(&(whole - sound.len())), "{}", whole - sound.len());
    }
}

#[test]
fn steps_of_the_delay_shift_the_stamps_and_add_up() {
    for (seed, steps) in [(0, &[0.012][..]), (1, &[-0.008]), (2, &[0.012, -0.002])] {
        let troubles: Vec<Trouble> = steps.iter().map(|&by_s| Trouble::DelayStep(by_s)).collect();
        let whole_ns = (steps.iter().sum::<f64>() * 1e9).round() as i64;
        for (spoilt, mut sound) in beside(seed, &troubles) {
            let shift = spoilt.header.time_ns - sound.header.time_ns;
            let expected = if end_ns(&sound) < AT_NS { 0 } else { whole_ns };
            assert!((shift - expected).abs() <= 1, "{shift}");
            sound.header.time_ns = spoilt.header.time_ns;
            assert_eq!(spoilt, sound);
        }
    }
}

#[test]
fn troubles_leave_the_truth_and_the_main_unit_alone() {
    let all = [Trouble::DeadAccelerometers, Trouble::StuckGyro(1), Trouble::Gap(1.0), Trouble::DelayStep(0.01)];
    for (a, b) in run(&scenario(5, &all)).iter().zip(run(&scenario(5, &[]))) {
        assert_eq!((&a.main, &a.attitude, &a.truth), (&b.main, &b.attitude, &b.truth));
    }
}

/// Largest roll, pitch and sway of the heading within a span of time, rad.
fn largest(epochs: &[Epoch], from_s: f64, to_s: f64) -> [f64; 3] {
    let span = (from_s * 1e9) as i64..(to_s * 1e9) as i64;
    epochs.iter().filter(|epoch| span.contains(&epoch.main.header.time_ns)).fold([0.0; 3], |largest, epoch| {
        let [w, x, y, z] = epoch.truth[0].ship;
        // Rz(-heading) Rx(pitch) Ry(roll)
        let pitch = (2.0 * (y * z + w * x)).asin();
        let roll = (2.0 * (w * y - x * z)).atan2(w * w - x * x - y * y + z * z);
        let heading = (2.0 * (x * y - w * z)).atan2(w * w - x * x + y * y - z * z);
        let course = std::f64::consts::FRAC_PI_4;
        let now = [roll, pitch, heading - course];
        [0, 1, 2].map(|i| f64::max(largest[i], now[i].abs()))
    })
}

#[test]
fn the_swing_doubles_and_what_the_units_feel_goes_on() {
    let mut scenario = Scenario { rate_hz: 20.0, duration_s: Some(300.0), ..Scenario::default() };
    (scenario.main, scenario.areas[0].unit) = (Unit::ideal(), Unit::ideal());
    scenario.areas[0].flexure = [GaussMarkov { mu: 0.1, b: 0.5, sigma: 0.0 }; 3];
    let calm = run(&scenario);
    scenario.ship.sea_change = Some(SeaChange { at_s: 100.0, factor: 2.0, ramp_s: 60.0 });
    let rough = run(&scenario);
    let before = largest(&rough, 0.0, 100.0);
    for (was, is) in before.iter().zip(largest(&rough, 160.0, 300.0)) {
        assert!((is / was - 2.0).abs() < 1e-3, "{was} {is}");
    }
    for (a, b) in calm.iter().zip(&rough).filter(|(a, _)| a.main.header.time_ns <= 100_000_000_000) {
        assert_eq!(a, b);
    }
    // from sample to sample twice the sea at most changes twice as much, and by a little more while it grows
    let jerk = |epochs: &[Epoch], of: fn(&ImuSample) -> [f64; 3]| {
        let jump = |pair: &[Epoch]| {
            let (a, b) = (of(&pair[0].sub[0]), of(&pair[1].sub[0]));
            (0..3).map(|i| (b[i] - a[i]).powi(2)).sum::<f64>().sqrt()
        };
        epochs.windows(2).map(jump).fold(0.0, f64::max)
    };
    for of in [|s: &ImuSample| s.dtheta, |s: &ImuSample| s.dvel] {
        // at twice the angles the product of two of them counts four times
        assert!(jerk(&rough, of) < 2.5 * jerk(&calm, of), "{} {}", jerk(&rough, of), jerk(&calm, of));
    }
}

/// Both modes alone and together, draw by draw; the first is the same with the second beside it.
#[test]
fn the_second_mode_is_another_process_that_adds() {
    let (first, second) = (GaussMarkov::critical(5.0, 1e-3), GaussMarkov::damped(0.5, 0.4, 7e-4));
    let still = GaussMarkov { sigma: 0.0, ..first };
    let (mut both, mut cross, mut n) = (0.0, 0.0, 0.0);
    for seed in 0..6 {
        let run = |flexure: GaussMarkov, second_flexure: Option<GaussMarkov>| {
            let second_flexure = second_flexure.map(|model| [model; 3]);
            let area = Area { flexure: [flexure; 3], second_flexure, ..Area::default() };
            let scenario =
                Scenario { seed, rate_hz: 10.0, duration_s: Some(3000.0), areas: vec![area], ..Scenario::default() };
            run(&scenario).into_iter().flat_map(|epoch| epoch.truth[0].dynamic).collect::<Vec<f64>>()
        };
        let (sum, one, other) = (run(first, Some(second)), run(first, None), run(still, Some(second)));
        for ((sum, one), other) in sum.iter().zip(one).zip(other) {
            assert!((sum - (one + other)).abs() < 1e-15);
            (both, cross, n) = (both + sum * sum, cross + one * other, n + 1.0);
        }
    }
    let expected = first.sigma.powi(2) + second.sigma.powi(2);
    // 18 axes of 600 times a correlation time of 5 s
    assert!((both / n / expected - 1.0).abs() < 0.06, "{}", both / n / expected);
    assert!((cross / n).abs() < 0.06 * first.sigma * second.sigma, "{}", cross / n / first.sigma / second.sigma);
}

#[test]
fn a_hull_of_two_modes_at_rest_is_straight() {
    let mut scenario = Scenario { duration_s: Some(1.0), ..Scenario::default() };
    scenario.areas[0].starts_at_rest = true;
    scenario.areas[0].second_flexure = Some([GaussMarkov::damped(0.5, 0.4, 7e-4); 3]);
    let epochs = run(&scenario);
    assert_eq!(epochs[0].truth[0].dynamic, [0.0; 3]);
    assert!(epochs[100].truth[0].dynamic.iter().all(|angle| *angle != 0.0));
}
