//! Motion of the ship: 000 eq 79 and the sphere that turns below it.

use crate::Ship;
use crate::resonator::Resonance;
use crate::swing::Track;
use frames::unit::seconds;
use frames::{Euler, Inertial, Main, Nav, Rot, Vec3};

/// Rate of the Earth, rad/s.
const EARTH_RATE: f64 = 7.292_115e-5;
/// Radius of the Earth, m; a sphere does for the transport rate.
const EARTH_RADIUS: f64 = 6_371_000.0;

/// The main unit's true motion at one instant.
#[derive(Clone, Copy)]
pub(crate) struct Motion {
    pub(crate) time_ns: i64,
    pub(crate) nav_from_main: Rot<Nav, Main>,
    pub(crate) inertial_from_main: Rot<Inertial, Main>,
    /// rad/s.
    pub(crate) w_im_m: Vec3<Main>,
    /// Specific force, m/s^2.
    pub(crate) force_i: Vec3<Inertial>,
}

/// The ship at sea.
pub(crate) struct Sea {
    ship: Ship,
    roll: Track,
    pitch: Track,
    heading: Track,
    /// Rate of n in inertial space, rad/s; held constant.
    w_in_n: Vec3<Nav>,
    /// `2 w_ie + w_en`, rad/s.
    w_coriolis_n: Vec3<Nav>,
    /// What gravity makes an accelerometer feel, m/s^2.
    lift_n: Vec3<Nav>,
}

impl Sea {
    /// The times between `history_s` before the one that it was advanced to and that one can be asked.
    pub(crate) fn new(ship: Ship, seed: u64, history_s: f64) -> Self {
        let track = |swing, axis| Track::new(swing, seed, axis, history_s);
        let (east, north) = ship.course.sin_cos();
        let (sine, cosine) = ship.latitude.sin_cos();
        let w_ie_n = Vec3::new(0.0, cosine, sine) * EARTH_RATE;
        let w_en_n = Vec3::new(-north, east, east * sine / cosine) * (ship.speed / EARTH_RADIUS);
        let gravity = 9.80665 - 0.0259 * (2.0 * ship.latitude).cos();
        Self {
            roll: track(&ship.roll, 0),
            pitch: track(&ship.pitch, 1),
            heading: track(&ship.heading, 2),
            ship,
            w_in_n: w_ie_n + w_en_n,
            w_coriolis_n: w_ie_n * 2.0 + w_en_n,
            lift_n: Vec3::new(0.0, 0.0, gravity),
        }
    }

    /// Goes on to an instant.
    pub(crate) fn advance(&mut self, time_ns: i64) {
        for track in [&mut self.roll, &mut self.pitch, &mut self.heading] {
            track.advance(seconds(time_ns));
        }
    }

    /// The swing (pitch, roll, -heading sway) without turns, for what bends with it: angle and rate of each, rad and rad/s.
    pub(crate) fn swing(&self, t: f64) -> [[f64; 2]; 3] {
        self.signed(t, |track| track.at(t))
    }

    /// The same a quarter of a period late.
    pub(crate) fn late(&self, t: f64) -> [[f64; 2]; 3] {
        self.signed(t, |track| track.late(t))
    }

    fn signed(&self, t: f64, of: impl Fn(&Track) -> (f64, f64)) -> [[f64; 2]; 3] {
        self.swings().map(|(track, sign)| {
            let (angle, rate) = self.swollen(t, of(track));
            [sign * angle, sign * rate]
        })
    }

    fn swings(&self) -> [(&Track, f64); 3] {
        [(&self.pitch, 1.0), (&self.roll, 1.0), (&self.heading, -1.0)]
    }

    /// Angle (rad) and rate (rad/s) in the sea as it is by now, from those in the sea of the start.
    fn swollen(&self, t: f64, start: (f64, f64)) -> (f64, f64) {
        self.ship.sea_change.map_or(start, |change| change.apply(t, start))
    }

    /// Standard deviation of each component of the swing before the sea changes, rad.
    pub(crate) fn swing_rms(&self) -> [f64; 3] {
        self.swings().map(|(track, _)| track.rms())
    }

    /// Standard deviations of angle and rate (rad, rad/s) of what a resonance makes of each component.
    pub(crate) fn resonant_rms(&self, resonance: &Resonance) -> [[f64; 2]; 3] {
        self.swings().map(|(track, _)| track.resonant_rms(resonance))
    }

    /// Course (rad) and rate of turn (rad/s).
    fn course(&self, t: f64) -> (f64, f64) {
        self.ship.turns.map_or((self.ship.course, 0.0), |turns| {
            let (turned, rate) = turns.at(t);
            (self.ship.course + turned, rate)
        })
    }

    /// The motion at an instant.
    pub(crate) fn at(&self, time_ns: i64) -> Motion {
        let t = seconds(time_ns);
        let (roll, roll_rate) = self.swollen(t, self.roll.at(t));
        let (pitch, pitch_rate) = self.swollen(t, self.pitch.at(t));
        let course = self.course(t);
        let (sway, sway_rate) = self.swollen(t, self.heading.at(t));
        let (heading, heading_rate) = (course.0 + sway, course.1 + sway_rate);
        let nav_from_main = Euler { roll, pitch, heading }.rotation::<Main>();
        let inertial_from_nav = self.inertial_from_nav(t);
        // heading turns about minus z of n, pitch about x before the roll, roll about y of m
        let w_in_n = self.w_in_n - Vec3::new(0.0, 0.0, heading_rate);
        let (sine, cosine) = roll.sin_cos();
        let w_euler_m = Vec3::new(pitch_rate * cosine, roll_rate, pitch_rate * sine);
        Motion {
            time_ns,
            nav_from_main,
            inertial_from_main: inertial_from_nav * nav_from_main,
            w_im_m: nav_from_main.inverse() * w_in_n + w_euler_m,
            force_i: inertial_from_nav * self.force(course, (heading, heading_rate)),
        }
    }

    /// What the main unit's accelerometers feel between two instants, m/s, by Simpson's rule.
    pub(crate) fn velocity_increment(&self, from: &Motion, to: &Motion) -> Vec3<Inertial> {
        let begin = seconds(from.time_ns);
        let interval = seconds(to.time_ns - from.time_ns);
        let t = begin + interval / 2.0;
        let (course, sway) = (self.course(t), self.swollen(t, self.heading.at(t)));
        let middle = self.inertial_from_nav(t) * self.force(course, (course.0 + sway.0, course.1 + sway.1));
        (from.force_i + middle * 4.0 + to.force_i) * (interval / 6.0)
    }

    /// `C_n^i`: the frames coincide at the start of the run.
    fn inertial_from_nav(&self, t: f64) -> Rot<Inertial, Nav> {
        Rot::exp((self.w_in_n * t).relabel())
    }

    /// `f = v' + (2 w_ie + w_en) x v - g`, m/s^2.
    ///
    /// Course and heading come with their rates.
    fn force(&self, course: (f64, f64), heading: (f64, f64)) -> Vec3<Nav> {
        let (course, course_rate) = if self.ship.velocity_follows_heading { heading } else { course };
        let (sine, cosine) = course.sin_cos();
        let v_n = Vec3::new(sine, cosine, 0.0) * self.ship.speed;
        let vdot_n = Vec3::new(cosine, -sine, 0.0) * (self.ship.speed * course_rate);
        vdot_n + self.w_coriolis_n.cross(v_n) + self.lift_n
    }
}

/// Rotation vector (rad) and velocity increment (m/s) that an ideal unit with body axes B feels between two attitudes.
///
/// The velocity is turned with the attitude half way, so that composing the samples in the same manner is exact.
pub(crate) fn increments<B: frames::Frame>(
    from: Rot<Inertial, B>,
    to: Rot<Inertial, B>,
    dvel_i: Vec3<Inertial>,
) -> (Vec3<B>, Vec3<B>) {
    let turn: Rot<B, B> = from.inverse() * to;
    let dtheta = turn.log();
    let middle = from * Rot::<B, B>::exp(dtheta * 0.5);
    (dtheta, middle.inverse() * dvel_i)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Oscillation, RandomSwing, Swing, Tones, Turns};

    fn swing_of(kind: usize, sine: Swing, process: RandomSwing) -> Swing {
        match kind % 3 {
            0 => sine,
            1 => Swing::Tones(Tones { rms: 0.1, period: 8.0, count: 24 }),
            _ => Swing::Random(process),
        }
    }

    #[test]
    fn rate_and_force_are_derivatives_of_attitude_and_velocity() {
        for (velocity_follows_heading, kind) in [(false, 0), (true, 0), (false, 1), (true, 1), (true, 2)] {
            let sine = |phase| Swing::Sine(Oscillation { amplitude: 0.17, period: 9.0, phase, random_phase: true });
            let process = RandomSwing { mu: 0.06, b: 0.44, sigma: 0.06, band_limit_hz: Some(0.4) };
            let ship = Ship {
                velocity_follows_heading,
                roll: swing_of(kind, sine(0.7), process),
                heading: swing_of(kind + 1, sine(-1.1), process),
                turns: Some(Turns { rate: 0.02, length_s: 20.0, every_s: 70.0, ramp_s: 10.0 }),
                ..Ship::default()
            };
            let mut sea = Sea::new(ship, 5, 10.0);
            for time_ns in [25_000_000, 1_234_567_890, 77_000_000_000] {
                let h = 1_000_000;
                sea.advance(time_ns + 200 * h);
                let (a, now, b) = (sea.at(time_ns - h), sea.at(time_ns), sea.at(time_ns + h));
                let turn: Rot<Main, Main> = a.inertial_from_main.inverse() * b.inertial_from_main;
                let middle_from_start: Rot<Main, Main> = now.inertial_from_main.inverse() * a.inertial_from_main;
                let w = middle_from_start * (turn.log() / seconds(2 * h));
                assert!((w - now.w_im_m).norm() < 1e-6 * (1.0 + w.norm()), "{w:?} {:?}", now.w_im_m);
                // against a hundred short steps of the trapezoidal rule
                let sum = (0..100).fold(Vec3::ZERO, |sum, i| {
                    let step = |k: i64| sea.at(time_ns + k * h).force_i;
                    sum + (step(i) + step(i + 1)) * (seconds(h) / 2.0)
                });
                let simpson = sea.velocity_increment(&now, &sea.at(time_ns + 100 * h));
                assert!((simpson - sum).norm() < 1e-7, "{simpson:?} {sum:?}");
            }
        }
    }

    #[test]
    fn sideways_force_follows_the_turn() {
        let still = Swing::STILL;
        let ship = Ship { velocity_follows_heading: true, roll: still, pitch: still, ..Ship::default() };
        let sea = Sea::new(ship, 1, 1.0);
        let motion = sea.at(0);
        let force_m = motion.inertial_from_main.inverse() * motion.force_i;
        let (_, heading_rate) = sea.heading.at(0.0);
        // a turn to starboard pushes to starboard; Earth and transport rate add about a milli-g
        assert!((force_m.x() - ship.speed * heading_rate).abs() < 3e-3 && heading_rate > 0.1);
    }
}
