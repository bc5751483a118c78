//! What is simulated, as plain data. The defaults are the demonstration of paper 000 section 5.

use frames::unit::{ARCMIN, ARCSEC, DEG_PER_H, DEG_PER_SQRT_H, DEGREE, KNOT, MICRO_G, PPM};
use frames::{Case, Frame, Main, Rot, Sub, Vec3};

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

/// Motion of the ship, 000 eq 79.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ship {
    /// Latitude, rad, strictly between the poles; kept constant.
    pub latitude: f64,
    /// Longitude, rad: where the scenario plays; nothing that the units feel depends on it.
    pub longitude: f64,
    /// Speed over ground, m/s, constant.
    pub speed: f64,
    /// Mean heading and course, rad, clockwise from north.
    pub course: f64,
    /// Roll, positive with the port side up.
    pub roll: Oscillation,
    /// Pitch, positive with the bow up.
    pub pitch: Oscillation,
    /// Heading about the course.
    pub heading: Oscillation,
    /// Whether the velocity points along the momentary heading, which accelerates the ship sideways, or along the course.
    pub velocity_follows_heading: bool,
}

impl Default for Ship {
    fn default() -> Self {
        let sway = |period| Oscillation { amplitude: 10.0 * DEGREE, period, phase: 0.0 };
        Self {
            latitude: 45.0 * DEGREE,
            longitude: 126.0 * DEGREE,
            speed: 20.0 * KNOT,
            course: 45.0 * DEGREE,
            roll: sway(8.0),
            pitch: sway(8.0),
            heading: sway(10.0),
            velocity_follows_heading: false,
        }
    }
}

/// `amplitude sin(2 pi t / period + phase)`. The default is none.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Oscillation {
    /// rad; 0 for no sway.
    pub amplitude: f64,
    /// s; without a positive period the angle stands still.
    pub period: f64,
    /// rad.
    pub phase: f64,
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
    /// "Body from case". Samples are in case axes, the errors are those of the case axes.
    pub mounting: Rot<B, Case>,
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
            mounting: Rot::identity(),
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
            mounting: Rot::identity(),
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

/// A deck area with its sub unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Area {
    /// From the main to the sub unit while the hull is not bent, m.
    pub lever_arm: Vec3<Main>,
    /// Gain g of the bent lever arm `r = r0 + g theta x r0`: 1 as in 000 eq 6, 0 for a lever arm that does not bend.
    pub dynamic_lever_arm: f64,
    /// The static part `C_Phi` of the deformation, which includes how the unit was installed.
    pub installation: Rot<Main, Sub>,
    /// The flexure about x, y, z of m.
    pub flexure: [GaussMarkov; 3],
    /// The sub unit.
    pub unit: Unit<Sub>,
    /// What happens to its samples on their way.
    pub wire: Wire,
}

impl Default for Area {
    fn default() -> Self {
        Self {
            lever_arm: Vec3::new(10.0, 10.0, 2.0),
            dynamic_lever_arm: 1.0,
            installation: Rot::exp(Vec3::new(10.0 * ARCMIN, 10.0 * ARCMIN, 30.0 * ARCMIN)),
            flexure: [
                GaussMarkov::critical(10.0, 6.0 * ARCMIN),
                GaussMarkov::critical(10.0, 6.0 * ARCMIN),
                GaussMarkov::critical(30.0, 10.0 * ARCMIN),
            ],
            unit: Unit::default(),
            wire: Wire::default(),
        }
    }
}

/// Flexure of one axis, 000 eq 3: `x'' + 2 mu x' + b^2 x = w`, density of w `4 mu b^2 sigma^2`, stationary from the start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GaussMarkov {
    /// Damping, 1/s.
    pub mu: f64,
    /// Natural frequency, rad/s.
    pub b: f64,
    /// Standard deviation, rad.
    pub sigma: f64,
}

impl GaussMarkov {
    /// Critically damped, with an autocovariance that has fallen to 1/e after `tau` s: `mu = b = 2.146 / tau`.
    pub const fn critical(tau: f64, sigma: f64) -> Self {
        let beta = 2.146 / tau;
        Self { mu: beta, b: beta, sigma }
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
