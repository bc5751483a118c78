//! Motion of the ship: 000 eq 79 and the sphere that turns below it.

use crate::{Oscillation, Ship};
use frames::unit::seconds;
use frames::{Euler, Inertial, Main, Nav, Rot, Vec3};
use std::f64::consts::TAU;

/// Rate of the Earth, rad/s.
const EARTH_RATE: f64 = 7.292_115e-5;
/// Radius of the Earth, m; a sphere does for the transport rate.
const EARTH_RADIUS: f64 = 6_371_000.0;

impl Oscillation {
    /// Angle (rad) and rate (rad/s) at the time `t`.
    fn at(&self, t: f64) -> (f64, f64) {
        let w = if self.period > 0.0 { TAU / self.period } else { 0.0 };
        let (sine, cosine) = (w * t + self.phase).sin_cos();
        (self.amplitude * sine, self.amplitude * w * cosine)
    }
}

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
    /// Rate of n in inertial space, rad/s; held constant.
    w_in_n: Vec3<Nav>,
    /// `2 w_ie + w_en`, rad/s.
    w_coriolis_n: Vec3<Nav>,
    /// What gravity makes an accelerometer feel, m/s^2.
    lift_n: Vec3<Nav>,
}

impl Sea {
    pub(crate) fn new(ship: Ship) -> Self {
        let (east, north) = ship.course.sin_cos();
        let (sine, cosine) = ship.latitude.sin_cos();
        let w_ie_n = Vec3::new(0.0, cosine, sine) * EARTH_RATE;
        let w_en_n = Vec3::new(-north, east, east * sine / cosine) * (ship.speed / EARTH_RADIUS);
        let gravity = 9.80665 - 0.0259 * (2.0 * ship.latitude).cos();
        Self {
            ship,
            w_in_n: w_ie_n + w_en_n,
            w_coriolis_n: w_ie_n * 2.0 + w_en_n,
            lift_n: Vec3::new(0.0, 0.0, gravity),
        }
    }

    /// The motion at an instant.
    pub(crate) fn at(&self, time_ns: i64) -> Motion {
        let t = seconds(time_ns);
        let (roll, roll_rate) = self.ship.roll.at(t);
        let (pitch, pitch_rate) = self.ship.pitch.at(t);
        let (sway, heading_rate) = self.ship.heading.at(t);
        let heading = self.ship.course + sway;
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
            force_i: inertial_from_nav * self.force(heading, heading_rate),
        }
    }

    /// What the main unit's accelerometers feel between two instants, m/s, by Simpson's rule.
    pub(crate) fn velocity_increment(&self, from: &Motion, to: &Motion) -> Vec3<Inertial> {
        let begin = seconds(from.time_ns);
        let interval = seconds(to.time_ns - from.time_ns);
        let t = begin + interval / 2.0;
        let (sway, heading_rate) = self.ship.heading.at(t);
        let middle = self.inertial_from_nav(t) * self.force(self.ship.course + sway, heading_rate);
        (from.force_i + middle * 4.0 + to.force_i) * (interval / 6.0)
    }

    /// `C_n^i`: the frames coincide at the start of the run.
    fn inertial_from_nav(&self, t: f64) -> Rot<Inertial, Nav> {
        Rot::exp((self.w_in_n * t).relabel())
    }

    /// `f = v' + (2 w_ie + w_en) x v - g`, m/s^2.
    fn force(&self, heading: f64, heading_rate: f64) -> Vec3<Nav> {
        let (course, course_rate) =
            if self.ship.velocity_follows_heading { (heading, heading_rate) } else { (self.ship.course, 0.0) };
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

    #[test]
    fn rate_and_force_are_derivatives_of_attitude_and_velocity() {
        for velocity_follows_heading in [false, true] {
            let mut ship = Ship { velocity_follows_heading, ..Ship::default() };
            ship.roll.phase = 0.7;
            ship.heading.phase = -1.1;
            let sea = Sea::new(ship);
            for time_ns in [0, 1_234_567_890, 77_000_000_000] {
                let h = 1_000_000;
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
        let mut ship = Ship { velocity_follows_heading: true, ..Ship::default() };
        ship.roll.amplitude = 0.0;
        ship.pitch.amplitude = 0.0;
        let motion = Sea::new(ship).at(0);
        let force_m = motion.inertial_from_main.inverse() * motion.force_i;
        let (_, heading_rate) = ship.heading.at(0.0);
        // a turn to starboard pushes to starboard; Earth and transport rate add about a milli-g
        assert!((force_m.x() - ship.speed * heading_rate).abs() < 3e-3 && heading_rate > 0.1);
    }
}
