//! What both units felt from one pair taken in to the next, in a form that does not depend on any estimate.
//!
//! Everything stands in the starting axes of the epoch, so that neighbouring increments can be joined and a filter can run over them again
//! with other parameters.

use frames::{Main, MainStart, Rot, Sub, SubStart, Vec3, unit};
use messages::{Flags, ImuPair};
use nalgebra::Matrix3;
use serde::{Deserialize, Serialize};

/// What both units felt over a time.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct Increment {
    /// The end, data time in ns.
    pub time_ns: i64,
    /// Its duration, s.
    pub time_s: f64,
    /// Accumulated attitude of the main unit at the end.
    pub a_m: Rot<MainStart, Main>,
    /// Accumulated attitude of the sub unit at the end.
    pub a_s: Rot<SubStart, Sub>,
    /// Turn of the main unit, rad.
    pub dtheta_m: Vec3<Main>,
    /// Standard deviation of further angle errors in it, rad: what was bridged, and coning.
    pub disturbance: f64,
    /// Sum of the outer products of the changes of the main unit's mean rate from sample to sample, rad^2/s^2.
    pub rate_changes: Matrix3<f64>,
    /// Velocity increments; `None` if some were lost on the way or cannot be true.
    pub velocities: Option<Velocities>,
    /// So much of the duration had a spike in it, s: a velocity increment may have been replaced by what its neighbours say.
    pub spiked_s: f64,
}

/// Velocity increments of both units, each in its own starting axes, m/s.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Velocities {
    /// Main unit.
    pub m: Vec3<MainStart>,
    /// Sub unit.
    pub s: Vec3<SubStart>,
}

impl Velocities {
    /// None.
    pub const ZERO: Self = Self { m: Vec3::ZERO, s: Vec3::ZERO };
}

impl Increment {
    /// The main unit's attitude at the middle.
    pub fn middle_m(&self) -> Rot<MainStart, Main> {
        self.a_m * Rot::<Main, Main>::exp(self.dtheta_m * -0.5)
    }

    /// This increment and the next as one.
    pub fn then(&self, next: &Self) -> Self {
        let start_m = self.a_m * Rot::<Main, Main>::exp(-self.dtheta_m);
        Self {
            time_s: self.time_s + next.time_s,
            dtheta_m: (start_m.inverse() * next.a_m).log(),
            disturbance: self.disturbance.hypot(next.disturbance),
            rate_changes: self.rate_changes + next.rate_changes,
            spiked_s: self.spiked_s + next.spiked_s,
            velocities: self.velocities.zip(next.velocities).map(|(a, b)| Velocities { m: a.m + b.m, s: a.s + b.s }),
            ..*next
        }
    }
}

/// Makes increments of the pairs of an epoch that have data.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Increments {
    last: Option<Last>,
}

#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
struct Last {
    time_ns: i64,
    a_m: Rot<MainStart, Main>,
    dtheta_m: Vec3<Main>,
    rate_m: Option<Vec3<Main>>,
}

impl Increments {
    /// Begins anew: the next pair only says from where.
    pub fn restart(&mut self) {
        self.last = None;
    }

    /// The increment that ends with a pair; `None` at the epoch's first. From the accumulated attitudes, so that a pair lost on the way loses only time and velocity.
    pub fn next(&mut self, pair: &ImuPair) -> Option<Increment> {
        let time_ns = pair.header.time_ns;
        let a_m = Rot::<MainStart, Main>::from_wxyz(pair.attitude_m);
        let a_s = Rot::<SubStart, Sub>::from_wxyz(pair.attitude_s);
        let Some(last) = self.last else {
            self.last = Some(Last { time_ns, a_m, dtheta_m: Vec3::ZERO, rate_m: None });
            return None;
        };
        let time_s = unit::seconds(time_ns - last.time_ns).max(0.0);
        let dtheta_m = (last.a_m.inverse() * a_m).log();
        let rate_m = if time_s > 0.0 { Some(dtheta_m / time_s) } else { last.rate_m };
        let middle_m = a_m * Rot::<Main, Main>::exp(dtheta_m * -0.5);
        let change = match (rate_m, last.rate_m) {
            (Some(now), Some(before)) => (middle_m * (now - before)).column(),
            _ => Default::default(),
        };
        // a unit that gives mean rates leaves out this much of the attitude's change, and two units not the same part of it
        let coning = last.dtheta_m.cross(dtheta_m).norm() / 12.0;
        let lost = 2 * (time_ns - last.time_ns - pair.interval_ns).abs() > pair.interval_ns
            || pair.flags.intersects(Flags::ACCEL_STUCK | Flags::SATURATED);
        let dtheta_s = Vec3::<Sub>::from(pair.dtheta_s);
        let velocities = (!lost).then(|| Velocities {
            m: middle_m * Vec3::from(pair.dvel_m),
            s: a_s * Rot::<Sub, Sub>::exp(dtheta_s * -0.5) * Vec3::from(pair.dvel_s),
        });
        self.last = Some(Last { time_ns, a_m, dtheta_m, rate_m });
        Some(Increment {
            time_ns,
            time_s,
            a_m,
            a_s,
            dtheta_m,
            disturbance: pair.disturbance.hypot(coning),
            rate_changes: change * change.transpose(),
            velocities,
            spiked_s: if pair.flags.contains(Flags::SPIKE) { time_s } else { 0.0 },
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::matching::conformance::{STEP_S, Voyage};

    #[test]
    fn joined_increments_are_those_of_the_whole() {
        let voyage = Voyage {
            installation: Rot::exp(Vec3::new(0.3, -0.5, 1.0)),
            flexure: 1e-3,
            delay_s: 0.0,
            lever_arm: Vec3::new(9.0, 3.0, -2.0),
        };
        let every = |stride: usize| {
            let mut increments = Increments::default();
            let steps = (0..=40).filter(|k| k % stride == 0).filter_map(|k| {
                let motion = voyage.motion(k.max(1));
                increments.next(&ImuPair {
                    header: messages::Header { time_ns: unit::nanoseconds(k as f64 * STEP_S), ..Default::default() },
                    interval_ns: unit::nanoseconds(STEP_S),
                    attitude_m: motion.a_m.quaternion(),
                    attitude_s: motion.a_s.quaternion(),
                    dtheta_s: motion.dtheta_s.array(),
                    dvel_m: motion.dvel_m.array(),
                    dvel_s: motion.dvel_s.array(),
                    ..ImuPair::default()
                })
            });
            steps.reduce(|all, next| all.then(&next)).expect("some")
        };
        let (fine, coarse) = (every(1), every(40));
        assert!((fine.dtheta_m - coarse.dtheta_m).norm() < 1e-14);
        assert!((fine.time_s - coarse.time_s).abs() < 1e-12 && fine.a_m == coarse.a_m);
        assert!(coarse.velocities.is_none(), "39 samples were lost on the way");
        let gravity = fine.velocities.expect("complete").m.norm();
        assert!((gravity - 9.8 * 40.0 * STEP_S).abs() < 1e-4, "{gravity}");
    }
}
