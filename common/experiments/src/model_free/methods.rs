//! The methods of the paper and those beside them, as configurations for a scenario.

use super::Size;
use crate::{Fault, presets};
use estimation::identify;
use frames::unit::{ARCSEC, nanoseconds};
use messages::{FlexureParams, Header};
use pipeline::configuration::{Configuration, IdentifierMethod, MatchingMethod, RegistrationMethod};

/// Noise that drives the rate of a static part that moves, rad^2/s^3.
const STATIC_RATE_NOISE: f64 = 1e-6 * ARCSEC * ARCSEC;

/// The scenario with the fast and the slow stage of a preset, whose flexure and walks are those of the small size.
pub(super) fn of(preset: &str, scenario: &Configuration, size: Size) -> Result<Configuration, Fault> {
    let method = presets::configuration(preset, 0)?;
    Ok(scenario.with(|c| {
        let (area, told) = (&mut c.areas[0], &method.areas[0]);
        area.estimator = told.estimator;
        area.identifier = told.identifier;
        area.installation = told.installation;
        area.estimator.static_walk *= size.factor();
        if let Some(network) = &mut area.estimator.network {
            network.offset_walk *= size.factor();
        }
        if let IdentifierMethod::Fixed(hull) = &mut area.identifier.method {
            hull.modes.iter_mut().for_each(|axis| axis.sigma *= size.factor());
        }
    }))
}

/// A filter that knows nothing of a delay, with a static part that moves or is a constant.
pub(super) fn matched(method: &Configuration, moves: bool) -> Configuration {
    method.with(|c| {
        let estimator = &mut c.areas[0].estimator;
        estimator.matching = MatchingMethod::Quaternion;
        estimator.registration = RegistrationMethod::Installation;
        estimator.delay = None;
        estimator.static_rate_noise = if moves { STATIC_RATE_NOISE } else { 0.0 };
    })
}

/// The same method with the model of the flexure that holds from the start on.
pub(super) fn told(method: &Configuration) -> Configuration {
    method.with(|c| {
        let area = &mut c.areas[0];
        area.identifier.method = IdentifierMethod::Fixed(area.simulation.hull());
    })
}

/// The same method with a flexure that is identified as it goes.
pub(super) fn identified(method: &Configuration) -> Configuration {
    method.with(|c| {
        let identifier = &mut c.areas[0].identifier;
        identifier.method = IdentifierMethod::Learnt(identify::Method::Whittle);
        (identifier.window_s, identifier.period_s, identifier.minimum_s) = (300.0, 60.0, 60.0);
    })
}

/// The true models from later times on, as parameter sets.
pub(super) fn changes(scenario: &Configuration, begin_ns: i64) -> Vec<FlexureParams> {
    let changes = scenario.areas[0].simulation.flexure_changes.iter().zip(1..);
    changes
        .map(|(change, id)| FlexureParams {
            header: Header::default(),
            id,
            effective_from_ns: begin_ns + nanoseconds(change.at_s),
            mu: change.flexure.map(|axis| axis.mu),
            b: change.flexure.map(|axis| axis.b),
            sigma: change.flexure.map(|axis| axis.sigma),
            ..FlexureParams::default()
        })
        .collect()
}
