//! Keys of what goes wrong on a simulated ship.
#![allow(clippy::unwrap_used)]

use crate::text::{close, message_with, read_with};
use frames::unit::ARCMIN;
use simulation::{Event, GaussMarkov, Scenario, SeaChange, Trouble};

fn told(lines: &str) -> Scenario {
    read_with(lines).unwrap_or_else(|error| panic!("{error}")).scenario(1)
}

#[test]
fn events_are_read_in_si_and_in_any_order() {
    let s = told(
        "[area.simulation]\nevents = [{ at_s = 60, kind = \"gap\", length_s = 2.5 }, { at_s = 9, kind = \"stuck_gyro\", axis = \"z\" },\n\
         { at_s = 5, kind = \"dead_accelerometers\" }, { at_s = 0, kind = \"delay_step\", by_ms = -12.5 }]",
    );
    let troubles = [
        (60.0, Trouble::Gap(2.5)),
        (9.0, Trouble::StuckGyro(2)),
        (5.0, Trouble::DeadAccelerometers),
        (0.0, Trouble::DelayStep(-0.0125)),
    ];
    assert_eq!(s.areas[0].events, troubles.map(|(at_s, trouble)| Event { at_s, trouble }));
    for (axis, number) in [("x", 0), ("y", 1)] {
        let s =
            told(&format!("[area.simulation]\nevents = [{{ at_s = 1, kind = \"stuck_gyro\", axis = \"{axis}\" }}]"));
        assert_eq!(s.areas[0].events[0].trouble, Trouble::StuckGyro(number));
    }
}

#[test]
fn a_sea_and_a_second_mode_are_read_in_si() {
    let s = told(
        "[area.simulation]\nsecond_flexure = { mu_per_s = [1, 2, 3], b_rad_per_s = [4, 5, 6], sigma_arcmin = [1, 2, 3] }\n\
         [simulation]\nsea_change = { at_s = 600, factor = 2 }",
    );
    assert_eq!(s.ship.sea_change, Some(SeaChange { at_s: 600.0, factor: 2.0, ramp_s: 60.0 }));
    let second = s.areas[0].second_flexure.unwrap();
    assert!((second[1].mu, second[1].b) == (2.0, 5.0) && close(second[1].sigma, 2.0 * ARCMIN));
    let s = told(
        "[area.simulation]\nsecond_flexure = { tau_s = [1, 2, 3], sigma_arcmin = [1, 1, 1] }\n\
         [simulation]\nsea_change = { at_s = 0, factor = 0.5, ramp_s = 5 }",
    );
    assert_eq!(s.ship.sea_change, Some(SeaChange { at_s: 0.0, factor: 0.5, ramp_s: 5.0 }));
    assert_eq!(s.areas[0].second_flexure.unwrap()[2], GaussMarkov::critical(3.0, ARCMIN));
}

#[test]
fn nothing_goes_wrong_unless_told() {
    let s = told("");
    assert_eq!((s.areas[0].events.len(), s.areas[0].second_flexure, s.ship.sea_change), (0, None, None));
}

#[test]
fn mistakes_in_troubles_are_told_with_their_place() {
    let event = |text: &str| format!("[area.simulation]\nevents = [{{ {text} }}]");
    let sea = |text: &str| format!("[simulation]\nsea_change = {{ {text} }}");
    let second = |text: &str| format!("[area.simulation]\nsecond_flexure = {{ {text} }}");
    let goes_with = "\"dead_accelerometers\" goes with no other key but `at_s`, \"stuck_gyro\" with `axis`, \"gap\" with `length_s`, \
                     \"delay_step\" with `by_ms`";
    for (lines, message) in [
        (
            event("at_s = -1, kind = \"dead_accelerometers\""),
            "area[0].simulation.events[0].at_s = -1: must be within 0 to 100000000",
        ),
        (
            event("at_s = 1, kind = \"gap\", length_s = 0"),
            "area[0].simulation.events[0].length_s = 0: must be within 0.001 to 1000000",
        ),
        (
            event("at_s = 1, kind = \"delay_step\", by_ms = 1001"),
            "area[0].simulation.events[0].by_ms = 1001: must be within -1000 to 1000",
        ),
        (
            event("at_s = 1, kind = \"stuck_gyro\", axis = \"w\""),
            "area[0].simulation.events[0].axis = \"w\": must be one of \"x\", \"y\", \"z\"",
        ),
        (
            event("at_s = 1, kind = \"stuck_giro\""),
            "area[0].simulation.events[0].kind = \"stuck_giro\": must be one of \"dead_accelerometers\", \"stuck_gyro\", \"gap\", \"delay_step\"; did you mean `stuck_gyro`?",
        ),
        (
            event("at_s = 1, kind = \"gap\", lenght_s = 3"),
            "unknown key `lenght_s` in [area.simulation.events]; did you mean `length_s`?",
        ),
        (event("kind = \"gap\", length_s = 3"), "the required key `area[0].simulation.events[0].at_s` is missing"),
        (event("at_s = 1"), "the required key `area[0].simulation.events[0].kind` is missing"),
        (event("at_s = 1, kind = \"gap\""), &format!("area[0].simulation.events: {goes_with}")),
        (event("at_s = 1, kind = \"stuck_gyro\""), &format!("area[0].simulation.events: {goes_with}")),
        (
            event("at_s = 1, kind = \"delay_step\", by_ms = 3, length_s = 3"),
            &format!("area[0].simulation.events: {goes_with}"),
        ),
        (
            event("at_s = 1, kind = \"dead_accelerometers\", axis = \"x\""),
            &format!("area[0].simulation.events: {goes_with}"),
        ),
        (sea("at_s = 1, factor = 11"), "simulation.sea_change.factor = 11: must be within 0 to 10"),
        (sea("at_s = 1, factor = 2, ramp_s = 0"), "simulation.sea_change.ramp_s = 0: must be within 1 to 86400"),
        (sea("factor = 2"), "the required key `simulation.sea_change.at_s` is missing"),
        (sea("at_s = 1, faktor = 2"), "unknown key `faktor` in [simulation.sea_change]; did you mean `factor`?"),
        (
            second("tau_s = [1, 1, 1]"),
            "area[0].simulation.second_flexure: needs `tau_s` or `mu_per_s`, and one of `sigma_arcmin`, `sigma_arcsec`, `sigma_mrad`",
        ),
        (
            second("sigma_arcmin = [1, 1, 1]"),
            "area[0].simulation.second_flexure: needs `tau_s` or `mu_per_s`, and one of `sigma_arcmin`, `sigma_arcsec`, `sigma_mrad`",
        ),
        (
            second("at_s = 3, tau_s = [1, 1, 1], sigma_arcmin = [1, 1, 1]"),
            "area[0].simulation.second_flexure: `at_s` belongs to `flexure_changes`: a second mode is there from the start on",
        ),
    ] {
        assert_eq!(message_with(&lines), format!("ship.toml:10: {message}"), "{lines}");
    }
}
