//! What a filter starts from: the installation by motion, or the surveyed one where the motion does not show it.

use super::DeckSettings;
use crate::align::{DelayRegistrar, Lag, Register, Registrar, Registration};
use crate::estimator::{REGISTRATION_DOUBT, guess};
use crate::flexure::Hull;
use crate::matching::deck::{Covariance, Deck};
use crate::matching::so3::{self, So3, place};
use frames::{Rot, Vec3, unit};
use messages::{Flags, Solution};
use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

/// Registration by motion takes at least so long, s.
const LEAST_REGISTRATION_S: f64 = 5.0;
/// A registration as good as this is not waited for any longer.
const GOOD_REGISTRATION: f64 = 0.5 * unit::DEGREE;

/// A flexure of more than this is not reckoned with at the start (17 arcmin, rad): a matching to 0.05 arcsec is linear in its errors to so much.
/// With 34 arcmin one of eight starts on paper 003's ship was lost, with 69 three; from 10 to 34 the others gave the same results.
const LARGEST_START: f64 = 0.005;

/// What was known longer ago than this is not started from, s.
const RESUMABLE_S: f64 = 600.0;

/// Where a filter starts.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct Origin {
    from: Registration,
    lag: Option<Lag>,
    /// What the motion showed, if it did.
    pub by_motion: Option<Registration>,
    /// What a reader of the solution should know of it.
    pub flags: Flags,
}

/// What the search for a start came to.
pub enum Found {
    /// It goes on.
    Nothing,
    /// Time is up, and neither motion nor survey gives an installation.
    Unobservable,
    /// A filter can start.
    Start(Box<Origin>),
}

impl Origin {
    /// Looks for a start after so much time.
    pub fn find(
        settings: &DeckSettings,
        registrar: &Registrar,
        delays: Option<&DelayRegistrar>,
        waited_s: f64,
    ) -> Found {
        if waited_s < LEAST_REGISTRATION_S {
            return Found::Nothing;
        }
        let seen = registrar.solve();
        let found = seen.filter(Registration::is_observable);
        let timed_out = waited_s >= settings.area.registration_s;
        match (found, settings.area.installation) {
            (Some(found), _) if timed_out || (delays.is_none() && found.largest_sigma() < GOOD_REGISTRATION) => {
                let lag = delays.and_then(Register::lag);
                let with_delay = delays.filter(|_| lag.is_some_and(|lag| lag.delay.abs() > lag.sigma));
                let from = with_delay.and_then(Register::solve).unwrap_or(found);
                Found::Start(Box::new(Self { from, lag, by_motion: Some(found), flags: Flags::empty() }))
            }
            (None, Some(installation)) if timed_out => {
                let from = Registration {
                    rotation: installation.rotation,
                    covariance: Matrix3::identity() * (installation.sigma.powi(2) / REGISTRATION_DOUBT),
                    bias: Vec3::ZERO,
                    bias_sigma: Vector3::from_element(f64::INFINITY),
                    residual_rate: seen.map_or(Vector3::zeros(), |seen| seen.residual_rate),
                    ratio: 0.0,
                };
                Found::Start(Box::new(Self {
                    from,
                    lag: None,
                    by_motion: None,
                    flags: Flags::INSTALLATION | Flags::UNOBSERVABLE,
                }))
            }
            (None, None) if timed_out => Found::Unobservable,
            _ => Found::Nothing,
        }
    }

    /// A start from what an estimator that is gone said last; `None` if that is of no use by now. How the hull bends at the moment is not known any more.
    pub fn resumed(settings: &DeckSettings, last: &Solution, time_ns: i64) -> Option<Self> {
        let passed_s = unit::seconds(time_ns.saturating_sub(last.header.time_ns));
        if !last.is_valid() || !(0.0..RESUMABLE_S).contains(&passed_s) {
            return None;
        }
        let wandered = settings.area.grade.static_rate_variance() * passed_s * passed_s;
        let covariance = Matrix3::from_row_slice(&last.static_covariance) + Matrix3::identity() * wandered;
        let from = Registration {
            rotation: Rot::from_wxyz(last.static_q),
            covariance: covariance / REGISTRATION_DOUBT,
            bias: Vec3::ZERO,
            bias_sigma: Vector3::from_element(f64::INFINITY),
            residual_rate: Vector3::zeros(),
            ratio: 0.0,
        };
        let lag = (last.delay_sigma > 0.0).then_some(Lag { delay: last.delay, sigma: last.delay_sigma });
        Some(Self { from, lag, by_motion: None, flags: Flags::empty() })
    }

    /// A broad guess of the flexure.
    pub fn guess(&self) -> Hull {
        guess(&self.from.residual_rate).into()
    }

    /// State and covariance at the start.
    pub fn begin(&self, settings: &DeckSettings, hull: Hull) -> (Deck, Covariance) {
        let (grade, from) = (settings.area.grade, &self.from);
        let specified = grade.bias_variance();
        let mut p = so3::Covariance::zeros();
        p.fixed_view_mut::<3, 3>(place::STATIC, place::STATIC).copy_from(&(from.covariance * REGISTRATION_DOUBT));
        p.fixed_view_mut::<6, 6>(place::SCALE, place::SCALE).copy_from(&grade.scale_covariance(from.rotation));
        let mut bias = Vector3::zeros();
        for axis in 0..3 {
            p[(place::STATIC_RATE + axis, place::STATIC_RATE + axis)] = grade.static_rate_variance();
            let start = hull.modes[axis].bounded(0.0, LARGEST_START);
            start.place_stationary(place::FLEXURE + axis, place::FLEXURE_RATE + axis, &mut p);
            if let Some(second) = hull.second[axis] {
                second.place_stationary(place::SECOND + axis, place::SECOND_RATE + axis, &mut p);
            }
            // what the registration saw of the bias counts only where the specification is the wider one
            let seen = from.bias_sigma[axis].powi(2) * REGISTRATION_DOUBT;
            let trust = if seen.is_finite() { specified / (specified + seen) } else { 0.0 };
            bias[axis] = trust * from.bias.array()[axis];
            p[(place::BIAS + axis, place::BIAS + axis)] = specified * (1.0 - trust);
            p[(place::WANDER + axis, place::WANDER + axis)] = grade.wander_variance();
        }
        let so3 = So3::new(grade, hull, from.rotation, Vec3::from_column(bias));
        Deck::new(settings.options, grade, so3, self.lag, &p)
    }
}
