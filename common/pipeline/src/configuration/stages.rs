//! The settings of the two stages that serve an area.

use super::{DelaySettings, NetworkSettings, quantity, table};
use estimation::flexure::Flexure;
use estimation::identify;
use frames::unit;
use serde::Deserialize;
use serde::de::{Deserializer, Error};

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
    #[default]
    So3,
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
}

impl MatchingMethod {
    /// The registrations that this matching can start from.
    pub fn registrations(self) -> &'static [RegistrationMethod] {
        match self {
            Self::So3 => &[RegistrationMethod::Motion],
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
            Self::So3 | Self::Rate | Self::AttitudeDcm => &[FilterMethod::Kalman],
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
            _ => &[RangeMethod::Normal, RangeMethod::Naive, RangeMethod::ErrorRange, RangeMethod::Coherence],
        }
    }

    /// Whether it can be told of a delay.
    pub fn takes_delay(self) -> bool {
        matches!(self, Self::QuaternionDelay | Self::QuaternionWalk | Self::QuaternionNetwork)
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
    /// What the published range is made of.
    pub range: RangeMethod,
    /// What the range is multiplied by about each axis, if it takes a factor: F of 004 (s^-1/2), or the coherence.
    #[serde(deserialize_with = "quantity::range_factor")]
    pub range_factor: [f64; 3],
    /// How often the filter takes a measurement, Hz.
    #[serde(deserialize_with = "quantity::filter_hz")]
    pub filter_hz: f64,
    /// How long to try registering by motion before falling back to the configured installation, s.
    #[serde(deserialize_with = "quantity::registration_s")]
    pub registration_s: f64,
    /// Density of the noise that drives the rate of the static part, rad^2/s^3.
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
            matching: MatchingMethod::So3,
            filter: FilterMethod::Kalman,
            range: RangeMethod::Normal,
            range_factor: [1.0; 3],
            filter_hz: 10.0,
            registration_s: 20.0,
            static_rate_noise: 1e-4 * unit::ARCSEC * unit::ARCSEC,
            static_walk: 0.0,
            dynamic_lever_arm: true,
            attitude_noise: 2.0 * unit::ARCSEC,
            delay: None,
            network: None,
        }
    }
}

/// The methods of the slow stage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum IdentifierMethod {
    /// The model is learnt from a window of data by this method.
    Learnt(identify::Method),
    /// Nothing is learnt: this model, an axis of m each.
    Fixed([Flexure; 3]),
}

/// The slow stage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IdentifierSettings {
    /// Which method.
    pub method: IdentifierMethod,
    /// Length of the window of data, s.
    pub window_s: f64,
    /// Time from one parameter set to the next, s.
    pub period_s: f64,
    /// From the end of a window to the data time at which its parameters take effect, s.
    pub lead_s: f64,
    /// Shortest window that gives parameters, s.
    pub minimum_s: f64,
    /// Size factor of the dictionary of models, 1 to 100.
    pub dictionary: usize,
    /// Whether what is learnt is made safe for a filter, or used as the method gives it.
    pub safety: bool,
}

impl Default for IdentifierSettings {
    fn default() -> Self {
        Self {
            method: IdentifierMethod::Learnt(identify::Method::Rvm),
            window_s: 300.0,
            period_s: 10.0,
            lead_s: 1.0,
            minimum_s: 10.0,
            dictionary: 1,
            safety: true,
        }
    }
}

#[derive(Deserialize)]
#[serde(rename_all = "snake_case")]
enum Method {
    Rvm,
    RvmGaussian,
    SupportVector,
    Whale,
    ParticleSwarm,
    TuftsKumaresan,
    TuftsKumaresanPrinted,
    YuleWalker,
    MatrixPencil,
    Whittle,
    Fixed,
}

impl Method {
    /// `None` where nothing is learnt.
    fn learnt(&self) -> Option<identify::Method> {
        Some(match self {
            Self::Rvm => identify::Method::Rvm,
            Self::RvmGaussian => identify::Method::RvmGaussian,
            Self::SupportVector => identify::Method::SupportVector,
            Self::Whale => identify::Method::Whale,
            Self::ParticleSwarm => identify::Method::ParticleSwarm,
            Self::TuftsKumaresan => identify::Method::TuftsKumaresan,
            Self::TuftsKumaresanPrinted => identify::Method::TuftsKumaresanPrinted,
            Self::YuleWalker => identify::Method::YuleWalker,
            Self::MatrixPencil => identify::Method::MatrixPencil,
            Self::Whittle => identify::Method::Whittle,
            Self::Fixed => return None,
        })
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, default)]
struct IdentifierTable {
    method: Method,
    #[serde(deserialize_with = "quantity::window_s")]
    window_s: f64,
    #[serde(deserialize_with = "quantity::period_s")]
    period_s: f64,
    #[serde(deserialize_with = "quantity::lead_s")]
    lead_s: f64,
    /// By default 10 s, or the whole of a shorter window.
    #[serde(deserialize_with = "minimum_s")]
    minimum_s: Option<f64>,
    #[serde(deserialize_with = "quantity::dictionary")]
    dictionary: usize,
    safety: bool,
    #[serde(deserialize_with = "table::optional")]
    flexure: Option<FlexureTable>,
}

impl Default for IdentifierTable {
    fn default() -> Self {
        let IdentifierSettings { window_s, period_s, lead_s, dictionary, safety, .. } = Default::default();
        Self { method: Method::Rvm, window_s, period_s, lead_s, minimum_s: None, dictionary, safety, flexure: None }
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FlexureTable {
    #[serde(deserialize_with = "quantity::mu_per_s")]
    mu_per_s: [f64; 3],
    #[serde(deserialize_with = "quantity::b_rad_per_s")]
    b_rad_per_s: [f64; 3],
    #[serde(deserialize_with = "quantity::sigma_arcsec")]
    sigma_arcsec: [f64; 3],
}

/// Joins method and flexure.
pub(super) fn identifier<'de, D: Deserializer<'de>>(deserializer: D) -> Result<IdentifierSettings, D::Error> {
    let table: IdentifierTable = table::one(deserializer)?;
    let method = match (table.method.learnt(), table.flexure) {
        (Some(method), None) => IdentifierMethod::Learnt(method),
        (Some(method), Some(_)) => {
            let name = method.name();
            let message = format!("the key `flexure` goes with method \"fixed\" only, not with \"{name}\"");
            return Err(D::Error::custom(message));
        }
        (None, None) => return Err(D::Error::custom("method \"fixed\" needs the key `flexure`")),
        (None, Some(f)) => IdentifierMethod::Fixed(std::array::from_fn(|i| Flexure {
            mu: f.mu_per_s[i],
            b: f.b_rad_per_s[i],
            sigma: f.sigma_arcsec[i],
        })),
    };
    let IdentifierTable { window_s, period_s, lead_s, dictionary, safety, .. } = table;
    let minimum_s = table.minimum_s.unwrap_or(IdentifierSettings::default().minimum_s.min(window_s));
    Ok(IdentifierSettings { method, window_s, period_s, lead_s, minimum_s, dictionary, safety })
}

fn minimum_s<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<f64>, D::Error> {
    quantity::window_s(deserializer).map(Some)
}
