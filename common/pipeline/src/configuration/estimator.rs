//! The settings of the fast stage of an area.

use super::{DelaySettings, NetworkSettings, quantity, table};
use frames::unit;
use serde::Deserialize;

/// How the fast stage first finds the installation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RegistrationMethod {
    /// From the motion, by windows of angle increments.
    #[default]
    Motion,
    /// The configured installation is taken as it is.
    Installation,
    /// From the motion, together with the sub unit's delay.
    Delay,
    /// Quaternion optimisation over windows.
    Quaternion,
    /// Quaternion optimisation as printed, over all that came in.
    QuaternionCumulative,
    /// Least squares for a small rotation.
    LeastSquares,
    /// Analytic alignment, with accelerometers.
    Analytic,
}

/// What the fast stage compares.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MatchingMethod {
    /// Attitudes on SO(3).
    So3,
    /// The same with accelerometers, an unknown delay and a second mode of the hull, and the first minutes run over again with better parameters.
    #[default]
    Deck,
    /// Angular rates, 12 states.
    Rate,
    /// Attitudes, what a registration has left over, 18 states.
    ResidualAttitude,
    /// Attitudes without registration, for small angles, 18 states.
    SmallAngle,
    /// Attitudes without registration, as they are, 18 states.
    ExactAttitude,
    /// Velocities and rates in inertial space, with Rodrigues parameters, 24 states.
    Rodrigues,
    /// The same, with the deformation published as the sum of static part and flexure.
    RodriguesPrinted,
    /// Attitudes by direction cosines, 21 states.
    AttitudeDcm,
    /// Attitudes and their constant, 15 states.
    Quaternion,
    /// The same with the delay, and its skew where one is told, as states.
    QuaternionDelay,
    /// The same with a random walk as all there is of the deformation; with the table `delay`, a delay too.
    QuaternionWalk,
    /// The same with a network as all there is of the deformation; with the table `delay`, a delay too.
    QuaternionNetwork,
    /// "residual_attitude" with a network beside it, 56 states.
    ResidualAttitudeNetwork,
    /// The same with the network in place of the deformation, as printed.
    ResidualAttitudeNetworkPrinted,
    /// "small_angle" with a network beside it, 56 states.
    SmallAngleNetwork,
    /// The same with the network in place of the deformation, as printed.
    SmallAngleNetworkPrinted,
}

/// How the fast stage corrects its state.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FilterMethod {
    /// Linear update.
    #[default]
    Kalman,
    /// Sigma points.
    Unscented,
    /// Linear update, each value weighed by its residual in terms of its noise.
    Correntropy,
    /// Linear update, each value weighed by its residual in terms of the innovation's variance.
    CorrentropyInnovation,
    /// The model's error is predicted from the measurement given a known state, then comes the linear update.
    Predictive,
    /// The same with the model's error weighed a hundred times more.
    PredictiveWeighted,
    /// The same with the model's error predicted under the uncertain state.
    PredictiveBayes,
    /// Predictive, then weighed by residuals in terms of the noise.
    Idam,
    /// The same with the model's error weighed a hundred times more.
    IdamWeighted,
    /// The same with the model's error predicted under the uncertain state.
    IdamBayes,
}

/// What the published range is made of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RangeMethod {
    /// 1.96 standard deviations.
    #[default]
    Normal,
    /// Three standard deviations of the filter, as papers do.
    Naive,
    /// By the covariance of flexure rate and static part, with the coefficient F of 004.
    ErrorRange,
    /// By an assumed coherence of flexure and ship.
    Coherence,
    /// By the coherence of flexure and ship that the data show.
    Observed,
}

impl MatchingMethod {
    /// The registrations that this matching can start from.
    pub fn registrations(self) -> &'static [RegistrationMethod] {
        match self {
            Self::So3 | Self::Deck => &[RegistrationMethod::Motion],
            Self::Rate | Self::AttitudeDcm | Self::Rodrigues | Self::RodriguesPrinted => {
                &[RegistrationMethod::Motion, RegistrationMethod::Installation]
            }
            Self::ResidualAttitude | Self::ResidualAttitudeNetwork | Self::ResidualAttitudeNetworkPrinted => &[
                RegistrationMethod::Motion,
                RegistrationMethod::Installation,
                RegistrationMethod::Quaternion,
                RegistrationMethod::QuaternionCumulative,
                RegistrationMethod::LeastSquares,
                RegistrationMethod::Analytic,
            ],
            Self::SmallAngle | Self::ExactAttitude | Self::SmallAngleNetwork | Self::SmallAngleNetworkPrinted => {
                &[RegistrationMethod::Installation]
            }
            Self::Quaternion => &[RegistrationMethod::Motion, RegistrationMethod::Installation],
            Self::QuaternionDelay | Self::QuaternionWalk | Self::QuaternionNetwork => {
                &[RegistrationMethod::Motion, RegistrationMethod::Installation, RegistrationMethod::Delay]
            }
        }
    }

    /// The filters that have a meaning with this matching.
    pub fn filters(self) -> &'static [FilterMethod] {
        match self {
            Self::So3 | Self::Deck | Self::Rate | Self::AttitudeDcm => &[FilterMethod::Kalman],
            Self::Quaternion | Self::QuaternionDelay | Self::QuaternionWalk | Self::QuaternionNetwork => {
                &[FilterMethod::Kalman, FilterMethod::Unscented]
            }
            Self::ResidualAttitude
            | Self::SmallAngle
            | Self::ExactAttitude
            | Self::ResidualAttitudeNetwork
            | Self::ResidualAttitudeNetworkPrinted
            | Self::SmallAngleNetwork
            | Self::SmallAngleNetworkPrinted => &[FilterMethod::Kalman, FilterMethod::Unscented],
            Self::Rodrigues | Self::RodriguesPrinted => &[
                FilterMethod::Kalman,
                FilterMethod::Unscented,
                FilterMethod::Correntropy,
                FilterMethod::CorrentropyInnovation,
                FilterMethod::Predictive,
                FilterMethod::PredictiveWeighted,
                FilterMethod::PredictiveBayes,
                FilterMethod::Idam,
                FilterMethod::IdamWeighted,
                FilterMethod::IdamBayes,
            ],
        }
    }

    /// The ranges that have a meaning with this matching.
    pub fn ranges(self) -> &'static [RangeMethod] {
        match self {
            Self::So3 => &[RangeMethod::Normal],
            _ => &[
                RangeMethod::Normal,
                RangeMethod::Naive,
                RangeMethod::ErrorRange,
                RangeMethod::Coherence,
                RangeMethod::Observed,
            ],
        }
    }

    /// Whether it can be told of a delay.
    pub fn takes_delay(self) -> bool {
        matches!(self, Self::Deck | Self::QuaternionDelay | Self::QuaternionWalk | Self::QuaternionNetwork)
    }

    /// Whether it has a network.
    pub fn takes_network(self) -> bool {
        matches!(
            self,
            Self::QuaternionNetwork
                | Self::ResidualAttitudeNetwork
                | Self::ResidualAttitudeNetworkPrinted
                | Self::SmallAngleNetwork
                | Self::SmallAngleNetworkPrinted
        )
    }
}

/// The fast stage.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct EstimatorSettings {
    /// How the installation is first found.
    pub registration: RegistrationMethod,
    /// What is compared.
    pub matching: MatchingMethod,
    /// How the state is corrected.
    pub filter: FilterMethod,
    /// What the published range is made of; by default what suits the matching.
    pub range: Option<RangeMethod>,
    /// What the range is multiplied by about each axis, if it takes a factor: F of 004 (s^-1/2), or the coherence.
    #[serde(deserialize_with = "quantity::range_factor")]
    pub range_factor: [f64; 3],
    /// How often the filter takes a measurement, Hz.
    #[serde(deserialize_with = "quantity::filter_hz")]
    pub filter_hz: f64,
    /// How long to try registering by motion before falling back to the configured installation, s.
    #[serde(deserialize_with = "quantity::registration_s")]
    pub registration_s: f64,
    /// So many times their figures the gyros' biases may be.
    #[serde(deserialize_with = "quantity::bias_doubt")]
    pub bias_doubt: f64,
    /// Density of the noise that drives the rate of the static part, rad^2/s^3; 0 says that it never moves.
    #[serde(
        rename = "static_rate_noise_arcsec2_per_s3",
        deserialize_with = "quantity::static_rate_noise_arcsec2_per_s3"
    )]
    pub static_rate_noise: f64,
    /// Random walk of the static part, for models without a rate of it, rad/sqrt(s).
    #[serde(rename = "static_walk_arcsec_per_sqrt_h", deserialize_with = "quantity::static_walk_arcsec_per_sqrt_h")]
    pub static_walk: f64,
    /// Whether the lever arm bends with the deck, for models that use accelerometers.
    pub dynamic_lever_arm: bool,
    /// White noise of the attitude that is measured by direction cosines, rad.
    #[serde(rename = "attitude_noise_arcsec", deserialize_with = "quantity::attitude_noise_arcsec")]
    pub attitude_noise: f64,
    /// What is known of a delay; without it there is none but with "quaternion_delay".
    #[serde(deserialize_with = "table::optional")]
    pub delay: Option<DelaySettings>,
    /// The network of the matchings that have one; input and walks are those of "quaternion_network".
    #[serde(deserialize_with = "table::optional")]
    pub network: Option<NetworkSettings>,
}

impl Default for EstimatorSettings {
    fn default() -> Self {
        Self {
            registration: RegistrationMethod::Motion,
            matching: MatchingMethod::default(),
            filter: FilterMethod::Kalman,
            range: None,
            range_factor: [1.0; 3],
            filter_hz: 10.0,
            registration_s: 20.0,
            bias_doubt: 1.0,
            static_rate_noise: 1e-4 * unit::ARCSEC * unit::ARCSEC,
            static_walk: 0.0,
            dynamic_lever_arm: true,
            attitude_noise: 2.0 * unit::ARCSEC,
            delay: None,
            network: None,
        }
    }
}

impl EstimatorSettings {
    /// What the published range is made of.
    pub fn range(&self) -> RangeMethod {
        let suitable = if self.matching == MatchingMethod::Deck { RangeMethod::Observed } else { RangeMethod::Normal };
        self.range.unwrap_or(suitable)
    }
}
