//! Alarms: raised and ended by data time, with a hold.

use frames::unit::ARCMIN;
use messages::{Alarms, Header, Solution};
use pipeline::alarm::AlarmWatch;
use pipeline::configuration::AlarmLimits;

const LIMITS: AlarmLimits = AlarmLimits {
    deformation: Some([10.0 * ARCMIN, 20.0 * ARCMIN, 30.0 * ARCMIN]),
    range: Some([ARCMIN, ARCMIN, ARCMIN]),
    invalid_s: Some(2.0),
    hold_s: 1.0,
};

/// At so many hundredths of a second.
fn solution(k: i64, phi_arcmin: [f64; 3], range_arcmin: f64, valid: bool) -> Solution {
    Solution {
        header: Header { time_ns: k * 10_000_000, ..Header::default() },
        phi: phi_arcmin.map(|v| v * ARCMIN),
        range: [range_arcmin * ARCMIN; 3],
        valid: valid.into(),
        ..Solution::default()
    }
}

#[test]
fn a_limit_has_to_be_crossed_for_as_long_as_the_hold() {
    let mut watch = AlarmWatch::new(Some(&LIMITS));
    let mut stands = Vec::new();
    for k in 0..1000 {
        // beyond the limit about y, to the other side, for 0.9 s and then for 3 s
        let beyond = (100..190).contains(&k) || (300..600).contains(&k);
        watch.see(&solution(k, [9.0, if beyond { -21.0 } else { 19.0 }, 0.0], 0.5, true));
        if !watch.raised().is_empty() {
            assert_eq!(watch.raised(), Alarms::DEFORMATION_Y);
            stands.push(k);
        }
    }
    assert_eq!((stands.first(), stands.last(), stands.len()), (Some(&400), Some(&699), 300));
}

#[test]
fn each_range_has_its_alarm_and_its_name() {
    let mut watch = AlarmWatch::new(Some(&LIMITS));
    (0..200).for_each(|k| watch.see(&solution(k, [0.0; 3], 1.5, true)));
    assert_eq!(watch.raised().names(), "range_x|range_y|range_z");
}

#[test]
fn no_valid_solution_is_an_alarm_that_the_next_one_ends() {
    let mut watch = AlarmWatch::new(Some(&LIMITS));
    watch.see(&solution(0, [0.0; 3], 0.5, true));
    for k in 1..=200 {
        watch.see(&solution(k, [0.0; 3], 9.0, false));
        assert!(watch.raised().is_empty(), "{k}");
    }
    watch.see(&solution(201, [0.0; 3], 9.0, false));
    assert_eq!(watch.raised(), Alarms::INVALID);
    watch.see(&solution(202, [0.0; 3], 0.5, true));
    assert!(watch.raised().is_empty());
    watch.without(2_000_000_001);
    assert_eq!(watch.raised(), Alarms::INVALID, "a stage that gets nothing says so by its clock");
}

#[test]
fn without_limits_nothing_is_raised() {
    let mut watch = AlarmWatch::new(None);
    (0..1000).for_each(|k| watch.see(&solution(k, [1e4; 3], 1e4, k % 2 == 0)));
    watch.without(i64::MAX);
    assert!(watch.raised().is_empty());
}
