//! How the ship moves, as plain data.

use frames::unit::{DEGREE, KNOT};

/// Motion of the ship: `C_m^n = Rz(-heading) Rx(pitch) Ry(roll)`.
///
/// The navigation frame turns at the rate of the first course all the time; a turn changes the velocity in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ship {
    /// Latitude, rad, strictly between the poles; kept constant.
    pub latitude: f64,
    /// Longitude, rad: where the scenario plays; nothing that the units feel depends on it.
    pub longitude: f64,
    /// Speed over ground, m/s, constant.
    pub speed: f64,
    /// Heading and course before the first turn, rad, clockwise from north.
    pub course: f64,
    /// Roll, positive with the port side up.
    pub roll: Swing,
    /// Pitch, positive with the bow up.
    pub pitch: Swing,
    /// Heading about the course.
    pub heading: Swing,
    /// Whether the velocity points along the momentary heading, which accelerates the ship sideways, or along the course.
    pub velocity_follows_heading: bool,
    /// Turns of the course.
    pub turns: Option<Turns>,
    /// The sea as it grows or calms down.
    pub sea_change: Option<SeaChange>,
}

/// 000 section 5.
impl Default for Ship {
    fn default() -> Self {
        let sway = |period| Swing::Sine(Oscillation { amplitude: 10.0 * DEGREE, period, ..Oscillation::default() });
        Self {
            latitude: 45.0 * DEGREE,
            longitude: 126.0 * DEGREE,
            speed: 20.0 * KNOT,
            course: 45.0 * DEGREE,
            roll: sway(8.0),
            pitch: sway(8.0),
            heading: sway(10.0),
            velocity_follows_heading: false,
            turns: None,
            sea_change: None,
        }
    }
}

/// What the sea does to one Euler angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Swing {
    /// One sinusoid, 000 eq 79, 001 eq 36.
    Sine(Oscillation),
    /// Many sinusoids about one period, for the "random" sea of 002.
    Tones(Tones),
    /// A second-order Gauss-Markov process, 003 eq 30.
    Random(RandomSwing),
}

impl Swing {
    /// No motion.
    pub const STILL: Self = Self::Sine(Oscillation { amplitude: 0.0, period: 0.0, phase: 0.0, random_phase: false });
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
    /// Whether a phase drawn from the seed is added.
    pub random_phase: bool,
}

/// Sinusoids of one amplitude with drawn phases: each frequency is drawn from its own share of the band of 30 % to both
/// sides of `1 / period`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tones {
    /// Standard deviation of the sum, rad.
    pub rms: f64,
    /// Middle period, s; without a positive one the angle stands still.
    pub period: f64,
    /// How many.
    pub count: usize,
}

/// `x'' + 2 mu x' + b^2 x = w`, density of w `4 mu b^2 sigma^2`, stationary; 003 eq 30 with `b^2 = alpha^2 + beta^2`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RandomSwing {
    /// Damping, 1/s: alpha of the paper.
    pub mu: f64,
    /// Natural frequency, rad/s.
    pub b: f64,
    /// Standard deviation before the band is limited, rad.
    pub sigma: f64,
    /// Corner frequency (Hz) of a Butterworth low-pass of order 4, which ends the unphysical tail of the rate; `None` is as printed.
    pub band_limit_hz: Option<f64>,
}

/// Turn n = 1, 2, ... to starboard begins at n times `every_s`; each turns the ship by `rate * length_s`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turns {
    /// rad/s; negative turns to port.
    pub rate: f64,
    /// s, from the middle of the rate's rise to the middle of its fall.
    pub length_s: f64,
    /// s; at least the length and one ramp.
    pub every_s: f64,
    /// How long the rate takes to rise, and to fall, s; positive.
    pub ramp_s: f64,
}

/// Roll, pitch and heading sway become `factor` times as large between `at_s` and `at_s + ramp_s`, periods and phases unchanged:
/// the amplitude is `1 + (factor - 1) h((t - at_s) / ramp_s)` with `h(u) = u^3 (10 - 15 u + 6 u^2)`, so that rate and acceleration
/// are continuous. Flexure that is coupled to the swing follows it, other flexure does not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeaChange {
    /// s.
    pub at_s: f64,
    /// How many times as large.
    pub factor: f64,
    /// How long it takes, s; without a positive time the change comes at once.
    pub ramp_s: f64,
}
