//! The pure steps of one area's lane, as the configuration wants them; the processes and the offline loop build the same.

use crate::configuration::{Area, Configuration, EstimatorMethod, Gyro, IdentifierMethod};
use estimation::estimator::{self, So3Estimator};
use estimation::identify::{self, Fixed, Rvm};
use estimation::matching::so3;
use estimation::synchronise::{self, Synchroniser, Unit};
use estimation::{Estimator, Identifier};
use frames::unit::nanoseconds;

/// The synchroniser of an area.
pub fn synchroniser(configuration: &Configuration, area: usize) -> Synchroniser {
    let Area { gyro, mounting, .. } = configuration.areas[area];
    Synchroniser::new(synchronise::Settings {
        area: area as u32,
        interval_ns: configuration.interval_ns(),
        silence_ns: nanoseconds(configuration.silence_s),
        main: Unit { mounting: configuration.main.mounting, range: configuration.main.gyro.range },
        sub: Unit { mounting, range: gyro.range },
    })
}

/// The estimator of an area.
pub fn estimator(configuration: &Configuration, area: usize) -> Box<dyn Estimator> {
    let index = area as u32;
    let area = &configuration.areas[area];
    let flexure = match area.identifier.method {
        IdentifierMethod::Fixed(flexure) => Some(flexure),
        IdentifierMethod::Rvm => None,
    };
    match area.estimator.method {
        EstimatorMethod::So3 => Box::new(So3Estimator::new(estimator::Settings {
            area: index,
            grade: so3::Grade {
                main: figures(&configuration.main.gyro),
                sub: figures(&area.gyro),
                static_noise: area.estimator.static_rate_noise,
            },
            interval_s: 1.0 / configuration.rate_hz,
            filter_hz: area.estimator.filter_hz,
            registration_s: area.estimator.registration_s,
            installation: area
                .installation
                .map(|told| estimator::Installation { rotation: told.rotation, sigma: told.sigma }),
            flexure,
        })),
    }
}

/// The identifier of an area.
pub fn identifier(configuration: &Configuration, area: usize) -> Box<dyn Identifier + Send> {
    let told = &configuration.areas[area].identifier;
    match told.method {
        IdentifierMethod::Rvm => Box::new(Rvm::new(identify::Settings {
            window_s: told.window_s,
            period_s: told.period_s,
            lead_s: told.lead_s,
            minimum_s: told.minimum_s,
            dictionary: told.dictionary,
            area: area as u32,
        })),
        IdentifierMethod::Fixed(_) => Box::new(Fixed),
    }
}

fn figures(gyro: &Gyro) -> so3::Gyro {
    so3::Gyro {
        arw: gyro.arw,
        bias: gyro.bias,
        instability: gyro.instability(),
        scale: gyro.scale,
        misalignment: gyro.misalignment,
        stamp_jitter: gyro.stamp_jitter,
    }
}
