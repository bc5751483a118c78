//! A flexure that changes is noticed late, and still the filter is soon where one is that was told at once.
#![allow(clippy::unwrap_used)]

use experiments::{Data, Track, presets, run, run_told};
use frames::unit::nanoseconds;
use messages::FlexureParams;
use pipeline::configuration::{Configuration, EstimatorSettings, IdentifierMethod, IdentifierSettings};

/// When the flexure changes, and the time in which errors count, s.
const CHANGE_S: f64 = 420.0;
const FROM_S: f64 = 480.0;
const TO_S: f64 = 660.0;

fn scenario(seed: u64) -> Configuration {
    presets::configuration("model_free_1_3_small", seed).unwrap().with(|c| {
        c.run.duration_s = Some(TO_S);
        let area = &mut c.areas[0];
        area.installation = None;
        (area.estimator, area.identifier) = (EstimatorSettings::default(), IdentifierSettings::default());
        area.simulation.flexure_changes.truncate(1);
        area.simulation.flexure_changes[0].at_s = CHANGE_S;
    })
}

/// The same estimator told both flexures, the second when it comes.
fn told(scenario: &Configuration, data: &Data) -> Track {
    let method =
        scenario.with(|c| c.areas[0].identifier.method = IdentifierMethod::Fixed(c.areas[0].simulation.hull()));
    let change = &scenario.areas[0].simulation.flexure_changes[0];
    let set = FlexureParams {
        id: 1,
        effective_from_ns: data.pairs[0].header.time_ns + nanoseconds(change.at_s),
        mu: change.flexure.map(|axis| axis.mu),
        b: change.flexure.map(|axis| axis.b),
        sigma: change.flexure.map(|axis| axis.sigma),
        ..FlexureParams::default()
    };
    run_told(&method, data, 1.0, &[set])
}

#[test]
fn what_was_lived_through_with_the_old_flexure_is_lived_through_again() {
    let (mut ours, mut bound) = ([0.0; 3], [0.0; 3]);
    for seed in 1..=8 {
        let scenario = scenario(seed);
        let data = Data::simulate(&scenario).unwrap();
        let tracks = [run(&scenario, &data, 1.0), told(&scenario, &data)];
        for (sum, track) in [&mut ours, &mut bound].into_iter().zip(&tracks) {
            let rmse = track.over(FROM_S..).rmse();
            (0..3).for_each(|axis| sum[axis] += rmse[axis].powi(2));
        }
    }
    let ratio = ((0..3).map(|axis| ours[axis] / bound[axis]).sum::<f64>() / 3.0).sqrt();
    assert!(ratio < 1.2, "{ratio}: {ours:?} {bound:?}");
}
