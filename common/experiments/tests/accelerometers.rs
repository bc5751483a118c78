//! Accelerometers that die take nothing with them but what they alone showed.
#![allow(clippy::unwrap_used)]

use experiments::{Data, presets, run};
use frames::unit::seconds;
use messages::Flags;
use pipeline::configuration::{Configuration, MatchingMethod};
use simulation::{Event, Trouble};

const DIES_S: f64 = 200.0;

/// The largest error over its range from then on; all solutions must be valid.
fn worst(configuration: &Configuration, data: &Data) -> f64 {
    let track = run(configuration, data, 0.0);
    let after = track.over(DIES_S..);
    assert_eq!(after.valid_share(), 1.0);
    let over = after.points.iter().flat_map(|point| [0, 1, 2].map(|axis| point.error[axis].abs() / point.range[axis]));
    over.fold(0.0, f64::max)
}

#[test]
fn dead_accelerometers_are_told_at_once_and_do_no_harm() {
    for seed in [1, 2, 3, 4] {
        let whole = presets::configuration("idam_so3_whittle", seed).unwrap().with(|c| {
            c.run.duration_s = Some(400.0);
            c.areas[0].installation = None;
            c.areas[0].estimator.matching = MatchingMethod::Deck;
        });
        let dying = whole.with(|c| {
            c.areas[0].simulation.events = vec![Event { at_s: DIES_S, trouble: Trouble::DeadAccelerometers }];
        });
        let data = Data::simulate(&dying).unwrap();
        for pair in &data.pairs {
            let since_s = seconds(pair.header.time_ns) - DIES_S;
            let told = pair.flags.contains(Flags::ACCEL_STUCK);
            assert!(since_s.abs() < 0.02 || told == (since_s > 0.0), "{seed}: {since_s}");
        }
        let (harmed, usual) = (worst(&dying, &data), worst(&whole, &Data::simulate(&whole).unwrap()));
        assert!(harmed < 1.1 * usual, "{seed}: {harmed} of the range, {usual} with accelerometers");
    }
}
