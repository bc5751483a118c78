//! What is simulated, as plain data. The defaults are the demonstration of paper 000 section 5.

use crate::{Area, Ship};
use frames::unit::{ARCSEC, DEG_PER_H, DEG_PER_SQRT_H, MICRO_G, PPM};
use frames::{Case, Frame, Main, Rot, Sub};

/// A whole run. Without a positive finite rate the simulator gives nothing.
#[derive(Clone, Debug, PartialEq)]
pub struct Scenario {
    /// Samples per second of every unit's nominal clock, 1/s; at most 1e6.
    pub rate_hz: f64,
    /// Selects the realisation of everything random.
    pub seed: u64,
    /// The last main sample is the last one at or before this time, s; `None` never ends.
    pub duration_s: Option<f64>,
    /// Written into every header.
    pub run_id: u64,
    /// How the ship moves.
    pub ship: Ship,
    /// The main unit.
    pub main: Unit<Main>,
    /// Errors of the attitude that the main INS gives.
    pub ins: InsErrors,
    /// The deck areas, one sub unit each.
    pub areas: Vec<Area>,
}

impl Default for Scenario {
    fn default() -> Self {
        Self {
            rate_hz: 100.0,
            seed: 1,
            duration_s: Some(600.0),
            run_id: 1,
            ship: Ship::default(),
            main: Unit::default(),
            ins: InsErrors::default(),
            areas: vec![Area::default()],
        }
    }
}

/// Errors of an inertial unit with body axes `B`. What is given as "1 sigma" is drawn once a run for each axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit<B: Frame> {
    /// Angle random walk of the gyros, rad/sqrt s.
    pub arw: f64,
    /// Bias of the gyros, rad/s, 1 sigma.
    pub bias: f64,
    /// Scale error of the gyros, 1 sigma.
    pub scale: f64,
    /// Each of the six off-diagonals of the gyros' error matrix, rad, 1 sigma.
    pub misalignment: f64,
    /// Velocity random walk of the accelerometers, m/s/sqrt s.
    pub vrw: f64,
    /// Bias of the accelerometers, m/s^2, 1 sigma.
    pub accel_bias: f64,
    /// Scale error of the accelerometers, 1 sigma.
    pub accel_scale: f64,
    /// Each of the six off-diagonals of the accelerometers' error matrix, rad, 1 sigma.
    pub accel_misalignment: f64,
    /// What the gyros' biases do beside that.
    pub bias_wander: Wander,
    /// Samples that are far off, of gyros and accelerometers alike.
    pub outliers: Outliers,
    /// "Body from case". Samples are in case axes, the errors are those of the case axes.
    pub mounting: Rot<B, Case>,
}

/// A first-order Gauss-Markov process of each axis, stationary from the start. The default is none.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wander {
    /// Standard deviation, rad/s.
    pub sigma: f64,
    /// Correlation time, s; positive unless sigma is 0.
    pub tau: f64,
}

/// Contaminated noise, 000 section 5: each axis of a sample is now and then far off. The default is never.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Outliers {
    /// Probability of an outlier for each axis of a sample.
    pub probability: f64,
    /// How far off, in standard deviations of the white noise of that sample.
    pub size: f64,
    /// Whether all are positive, or else of either sign alike.
    pub one_sided: bool,
}

impl<B: Frame> Unit<B> {
    /// A unit without errors whose case axes are its body axes.
    pub const fn ideal() -> Self {
        Self {
            arw: 0.0,
            bias: 0.0,
            scale: 0.0,
            misalignment: 0.0,
            vrw: 0.0,
            accel_bias: 0.0,
            accel_scale: 0.0,
            accel_misalignment: 0.0,
            bias_wander: Wander { sigma: 0.0, tau: 0.0 },
            outliers: Outliers { probability: 0.0, size: 0.0, one_sided: false },
            mounting: Rot::identity(),
        }
    }
}

/// The paper does not say how good the main unit is; here it is three to five times better than the sub unit.
impl Default for Unit<Main> {
    fn default() -> Self {
        Self {
            arw: 0.001 * DEG_PER_SQRT_H,
            bias: 0.003 * DEG_PER_H,
            scale: PPM,
            misalignment: ARCSEC,
            vrw: 10.0 * MICRO_G,
            accel_bias: 10.0 * MICRO_G,
            accel_scale: PPM,
            accel_misalignment: ARCSEC,
            ..Self::ideal()
        }
    }
}

/// 000 section 5, (2); its velocity random walk is read as 10 ug/sqrt Hz, since the printed ug/sqrt h is no such unit.
impl Default for Unit<Sub> {
    fn default() -> Self {
        Self {
            arw: 0.001 * DEG_PER_SQRT_H,
            bias: 0.01 * DEG_PER_H,
            scale: 5.0 * PPM,
            misalignment: 5.0 * ARCSEC,
            vrw: 10.0 * MICRO_G,
            accel_bias: 50.0 * MICRO_G,
            accel_scale: 5.0 * PPM,
            accel_misalignment: 5.0 * ARCSEC,
            ..Self::ideal()
        }
    }
}

/// Errors of the main INS: `C_hat = Exp(e) C_m^n`, e seen in n.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InsErrors {
    /// Constant part about east, north, up, rad, 1 sigma, drawn once a run.
    pub attitude: [f64; 3],
    /// White part of every sample about each axis, rad, 1 sigma.
    pub noise: f64,
}

/// Not in the paper: an INS of the main unit's class.
impl Default for InsErrors {
    fn default() -> Self {
        Self { attitude: [10.0 * ARCSEC, 10.0 * ARCSEC, 30.0 * ARCSEC], noise: ARCSEC }
    }
}

/// What happens to a sub unit's samples between the unit and whoever reads them. The default is nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wire {
    /// Data that end at t carry the stamp `t + delay_s + skew t`, s.
    pub delay_s: f64,
    /// By how much the delay grows in a second.
    pub skew: f64,
    /// White noise of the stamp, s, 1 sigma.
    pub jitter_s: f64,
    /// Sample j of the unit truly ends at `phase_s + j T / (1 + rate_error)`, T the nominal period, s.
    ///
    /// The first sample is number 0 or, where that would end before the main unit starts, a later one.
    pub phase_s: f64,
    /// Relative error of the unit's own rate. The stamps and intervals stay true to the unit's real instants.
    pub rate_error: f64,
    /// Probability that a sample is lost; its sequence number is then missing.
    pub loss: f64,
    /// Probability that a sample comes twice, number and contents alike.
    pub duplicate: f64,
    /// Probability that a sample comes after its successor.
    pub swap: f64,
    /// A sample is handed out this long after its stamp, s.
    pub transit_s: f64,
}
