//! The pure steps of one area's lane, as the configuration wants them; the processes and the offline loop build the same.

use crate::configuration::{
    Accel, Area, Configuration, FilterMethod, Gyro, IdentifierMethod, MatchingMethod, RangeMethod, RegistrationMethod,
};
use estimation::align::analytic::Analytic;
use estimation::align::least_squares::LeastSquares;
use estimation::align::quaternion::Angles;
use estimation::align::{self, DelayRegistrar, Registrar};
use estimation::estimator::{self, DeckEstimator, DeckSettings, MakeRegister, Matched, MatchedSettings, Zeroed};
use estimation::evaluate::{Coherence, Deviations, ErrorRange, Evaluate, NORMAL_95, Observed};
use estimation::filter::Filter;
use estimation::filter::correntropy::Kernel;
use estimation::filter::predictive::Weight;
use estimation::identify::{self, Fixed, Windowed};
use estimation::matching::attitude_dcm::{self, AttitudeDcm};
use estimation::matching::deck;
use estimation::matching::exact_attitude::ExactAttitude;
use estimation::matching::neural::{self, AngleMatching, Form, Neural};
use estimation::matching::quaternion::{self, DelayOptions, Quaternion};
use estimation::matching::quaternion_network::{self, QuaternionNetwork};
use estimation::matching::rate::{self, RateMatching};
use estimation::matching::residual_attitude::ResidualAttitude;
use estimation::matching::rodrigues::{self, RodriguesMatching};
use estimation::matching::small_angle::SmallAngle;
use estimation::matching::{self, Model, angles, so3};
use estimation::synchronise::{self, Synchroniser, Unit};
use estimation::{Estimator, Identifier};
use frames::Vec3;
use frames::unit::nanoseconds;

/// What is known of a delay of which nothing is told.
const UNKNOWN_DELAY: DelayOptions = DelayOptions { sigma: 20e-3, skew_sigma: 100e-6, retimed: true };
/// Standard deviation of a surveyed lever arm, m.
const LEVER_ARM_SIGMA: f64 = 0.02;

/// The synchroniser of an area.
pub fn synchroniser(configuration: &Configuration, area: usize) -> Synchroniser {
    let Area { gyro, mounting, lever_arm, .. } = configuration.areas[area];
    Synchroniser::new(synchronise::Settings {
        area: area as u32,
        interval_ns: configuration.interval_ns(),
        silence_ns: nanoseconds(configuration.silence_s),
        spike_threshold: configuration.spike_threshold,
        lever_arm_m: lever_arm.norm(),
        main: Unit { mounting: configuration.main.mounting, range: configuration.main.gyro.range },
        sub: Unit { mounting, range: gyro.range },
    })
}

/// The estimator of an area, whose solutions are told from the area's zero.
pub fn estimator(configuration: &Configuration, area: usize) -> Box<dyn Estimator> {
    let estimator = matching(configuration, area);
    match configuration.areas[area].zero {
        Vec3::ZERO => estimator,
        zero => Box::new(Zeroed::new(estimator, zero)),
    }
}

fn matching(configuration: &Configuration, area: usize) -> Box<dyn Estimator> {
    let told = &configuration.areas[area].estimator;
    let delay = told.delay.map_or(DelayOptions::default(), |delay| delay.options());
    match told.matching {
        MatchingMethod::So3 => own(configuration, area, deck::Options::default(), false),
        MatchingMethod::Deck => {
            let delay = told.delay.map_or(UNKNOWN_DELAY, |delay| delay.options());
            own(configuration, area, deck::Options { lever: lever(configuration, area), delay }, true)
        }
        MatchingMethod::Rate => matched::<RateMatching, { rate::STATES }, 3>(
            configuration,
            area,
            rate::Options { static_walk: told.static_walk * told.static_walk },
        ),
        MatchingMethod::AttitudeDcm => matched::<AttitudeDcm, { attitude_dcm::STATES }, 3>(
            configuration,
            area,
            attitude_dcm::Options { noise: told.attitude_noise, static_walk: told.static_walk * told.static_walk },
        ),
        MatchingMethod::ResidualAttitude => matched::<ResidualAttitude, { angles::STATES }, 3>(configuration, area, ()),
        MatchingMethod::SmallAngle => matched::<SmallAngle, { angles::STATES }, 3>(configuration, area, ()),
        MatchingMethod::ExactAttitude => matched::<ExactAttitude, { angles::STATES }, 3>(configuration, area, ()),
        MatchingMethod::Rodrigues => rodrigues(configuration, area, rodrigues::Output::Chain),
        MatchingMethod::RodriguesPrinted => rodrigues(configuration, area, rodrigues::Output::Sum),
        MatchingMethod::Quaternion => quaternion(configuration, area, false, DelayOptions::default()),
        MatchingMethod::QuaternionDelay => {
            quaternion(configuration, area, false, told.delay.unwrap_or_default().options())
        }
        MatchingMethod::QuaternionWalk => quaternion(configuration, area, true, delay),
        MatchingMethod::QuaternionNetwork => {
            let network = told.network.unwrap_or_default();
            let options = quaternion_network::Options {
                input: network.input.input(),
                weight_walk: network.weight_walk,
                offset_walk: network.offset_walk,
                seed: network.seed,
                delay,
            };
            matched::<QuaternionNetwork, { quaternion_network::STATES }, 3>(configuration, area, options)
        }
        MatchingMethod::ResidualAttitudeNetwork => neural::<ResidualAttitude>(configuration, area, Form::Additive),
        MatchingMethod::ResidualAttitudeNetworkPrinted => {
            neural::<ResidualAttitude>(configuration, area, Form::Literal)
        }
        MatchingMethod::SmallAngleNetwork => neural::<SmallAngle>(configuration, area, Form::Additive),
        MatchingMethod::SmallAngleNetworkPrinted => neural::<SmallAngle>(configuration, area, Form::Literal),
    }
}

/// An estimator by the project's own model.
fn own(configuration: &Configuration, area: usize, options: deck::Options, replay: bool) -> Box<dyn Estimator> {
    let settings = DeckSettings { area: settings(configuration, area), options, replay };
    Box::new(DeckEstimator::new(settings, evaluation(configuration, area)))
}

/// What the accelerometers of both units can tell; `None` where one has none.
fn lever(configuration: &Configuration, area: usize) -> Option<deck::Lever> {
    let told = &configuration.areas[area];
    configuration.main.accel.and(told.accel)?;
    Some(deck::Lever { accel: accel(configuration, area), arm: told.lever_arm, sigma: LEVER_ARM_SIGMA })
}

/// Figures of both units' accelerometers together.
fn accel(configuration: &Configuration, area: usize) -> matching::Accel {
    let (main, sub) = (configuration.main.accel, configuration.areas[area].accel);
    let both = |figure: fn(&Accel) -> f64| main.as_ref().map_or(0.0, figure).hypot(sub.as_ref().map_or(0.0, figure));
    matching::Accel { vrw: both(|accel| accel.vrw), bias: both(|accel| accel.bias) }
}

fn rodrigues(configuration: &Configuration, area: usize, output: rodrigues::Output) -> Box<dyn Estimator> {
    let Area { estimator, identifier, .. } = &configuration.areas[area];
    let (dynamic_lever_arm, cautious) = (estimator.dynamic_lever_arm, identifier.safety);
    matched::<RodriguesMatching, { rodrigues::STATES }, { rodrigues::ROWS }>(
        configuration,
        area,
        rodrigues::Options { output, dynamic_lever_arm, cautious },
    )
}

fn quaternion(configuration: &Configuration, area: usize, rigid: bool, delay: DelayOptions) -> Box<dyn Estimator> {
    let walk = configuration.areas[area].estimator.static_walk;
    let options = quaternion::Options { static_walk: walk * walk, rigid, delay };
    matched::<Quaternion, { quaternion::STATES }, 3>(configuration, area, options)
}

/// An estimator by a matching by angles with a network.
fn neural<M: AngleMatching + 'static>(configuration: &Configuration, area: usize, form: Form) -> Box<dyn Estimator> {
    let network = configuration.areas[area].estimator.network.unwrap_or_default();
    let options = neural::Options { form, seed: network.seed, sigma: network.weight_sigma };
    matched::<Neural<M>, { neural::STATES }, 3>(configuration, area, options)
}

/// An estimator by any matching model.
fn matched<M: Model<N, K> + 'static, const N: usize, const K: usize>(
    configuration: &Configuration,
    area: usize,
    options: M::Options,
) -> Box<dyn Estimator> {
    let (index, settings) = (area, settings(configuration, area));
    let area = &configuration.areas[area];
    let registration: Option<MakeRegister> = match area.estimator.registration {
        RegistrationMethod::Motion => Some(|told| Box::new(Registrar::new(told.grade.scale_variance()))),
        RegistrationMethod::Delay => Some(|_| Box::new(DelayRegistrar::new())),
        RegistrationMethod::Installation => None,
        RegistrationMethod::Quaternion => Some(|_| Box::new(align::quaternion::Quaternion::new(Angles::Windowed))),
        RegistrationMethod::QuaternionCumulative => {
            Some(|_| Box::new(align::quaternion::Quaternion::new(Angles::Cumulative)))
        }
        RegistrationMethod::LeastSquares => Some(|_| Box::new(LeastSquares::new())),
        RegistrationMethod::Analytic => Some(|_| Box::new(Analytic::new())),
    };
    let filter = filter(area.estimator.filter);
    Box::new(Matched::<M, N, K>::new(
        MatchedSettings {
            area: settings,
            accel: accel(configuration, index),
            lever_arm: area.lever_arm,
            filter,
            registration,
            options,
        },
        evaluation(configuration, index),
    ))
}

fn evaluation(configuration: &Configuration, area: usize) -> Box<dyn Evaluate> {
    let told = &configuration.areas[area].estimator;
    match told.range() {
        RangeMethod::Normal => Box::new(Deviations(NORMAL_95)),
        RangeMethod::Naive => Box::new(Deviations(3.0)),
        RangeMethod::ErrorRange => Box::new(ErrorRange::new(told.range_factor)),
        RangeMethod::Coherence => Box::new(Coherence::new(told.range_factor)),
        RangeMethod::Observed => Box::new(Observed::new()),
    }
}

fn filter(method: FilterMethod) -> Filter {
    match method {
        FilterMethod::Kalman => Filter::Kalman,
        FilterMethod::Unscented => Filter::Unscented,
        FilterMethod::Correntropy => Filter::Correntropy(Kernel::BY_NOISE),
        FilterMethod::CorrentropyInnovation => Filter::Correntropy(Kernel::BY_INNOVATION),
        FilterMethod::Predictive => Filter::Predictive(Weight::LITERAL, None),
        FilterMethod::PredictiveWeighted => Filter::Predictive(Weight::HEAVY, None),
        FilterMethod::PredictiveBayes => Filter::Predictive(Weight::Bayes, None),
        FilterMethod::Idam => Filter::Predictive(Weight::LITERAL, Some(Kernel::BY_NOISE)),
        FilterMethod::IdamWeighted => Filter::Predictive(Weight::HEAVY, Some(Kernel::BY_NOISE)),
        FilterMethod::IdamBayes => Filter::Predictive(Weight::Bayes, Some(Kernel::BY_NOISE)),
    }
}

fn settings(configuration: &Configuration, area: usize) -> estimator::Settings {
    let index = area as u32;
    let area = &configuration.areas[area];
    estimator::Settings {
        area: index,
        grade: so3::Grade {
            main: figures(&configuration.main.gyro, area.estimator.bias_doubt),
            sub: figures(&area.gyro, area.estimator.bias_doubt),
            static_noise: area.estimator.static_rate_noise,
        },
        interval_s: 1.0 / configuration.rate_hz,
        filter_hz: area.estimator.filter_hz,
        registration_s: area.estimator.registration_s,
        installation: area
            .installation
            .map(|told| estimator::Installation { rotation: told.rotation, sigma: told.sigma }),
        hull: match area.identifier.method {
            IdentifierMethod::Fixed(hull) => Some(hull),
            IdentifierMethod::Learnt(_) => None,
        },
    }
}

/// The identifier of an area.
pub fn identifier(configuration: &Configuration, area: usize) -> Box<dyn Identifier + Send> {
    let told = &configuration.areas[area].identifier;
    match told.method {
        IdentifierMethod::Learnt(method) => Box::new(Windowed::new(identify::Settings {
            window_s: told.window_s,
            period_s: told.period_s,
            lead_s: told.lead_s,
            minimum_s: told.minimum_s,
            dictionary: told.dictionary,
            method,
            safety: told.safety,
            provisional: configuration.areas[area].estimator.matching == MatchingMethod::Deck,
            second_mode: configuration.areas[area].estimator.matching == MatchingMethod::Deck,
            area: area as u32,
        })),
        IdentifierMethod::Fixed(_) => Box::new(Fixed),
    }
}

fn figures(gyro: &Gyro, bias_doubt: f64) -> so3::Gyro {
    so3::Gyro {
        arw: gyro.arw,
        bias: gyro.bias * bias_doubt,
        instability: gyro.instability(),
        scale: gyro.scale,
        misalignment: gyro.misalignment,
        stamp_jitter: gyro.stamp_jitter,
    }
}
