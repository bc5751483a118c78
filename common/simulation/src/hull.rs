//! The true deformation of one area, as [`Area`] defines it, and the lever arm that bends with it.

use crate::coupling::Coherence;
use crate::impulses::Gusts;
use crate::processes::Processes;
use crate::random::{Purpose, Source};
use crate::sampling::NEVER;
use crate::sea::Sea;
use crate::{Area, FlexureChange, QuasiStatic};
use frames::unit::{nanoseconds, seconds};
use frames::{Main, Rot, Sub, Vec3};
use std::f64::consts::TAU;

/// A hull that remembers how it is bent now.
pub(crate) struct Hull {
    lever_arm: Vec3<Main>,
    gain: f64,
    installation: Rot<Main, Sub>,
    quasi_static: QuasiStatic,
    flexure: Processes<3>,
    source: Source,
    second: Option<(Processes<3>, Source)>,
    /// In the order of their times; those before `next_change` are done.
    changes: Vec<FlexureChange>,
    next_change: usize,
    gusts: Option<Gusts>,
    coherence: Option<Coherence>,
    /// How far the processes are.
    time_ns: i64,
    now: Bend,
}

/// How the hull is bent at one instant.
#[derive(Clone, Copy)]
struct Bend {
    /// rad.
    theta: Vec3<Main>,
    /// rad/s.
    rate: Vec3<Main>,
    static_part: Rot<Main, Sub>,
}

impl QuasiStatic {
    /// The rotation vector at the time `t`, rad.
    fn at(&self, t: f64) -> Vec3<Main> {
        let w = TAU / self.period;
        Vec3::from([0, 1, 2].map(|k| self.amplitude[k] * (w * t + self.phase[k]).sin()))
    }
}

impl Hull {
    /// A hull at the given time, which is not after the start of the run.
    pub(crate) fn new(area: &Area, index: u64, seed: u64, sea: &Sea, time_ns: i64) -> Self {
        let mut source = Source::new(seed, Purpose::Flexure, index);
        let mut flexure = Processes::stationary(area.flexure, &mut source);
        if area.starts_at_rest {
            flexure.rest();
        }
        let second = area.second_flexure.map(|models| {
            let mut source = Source::new(seed, Purpose::SecondFlexure, index);
            let mut second = Processes::stationary(models, &mut source);
            if area.starts_at_rest {
                second.rest();
            }
            (second, source)
        });
        let mut changes = area.flexure_changes.clone();
        changes.sort_by(|a, b| a.at_s.total_cmp(&b.at_s));
        let coherence = area
            .coupling
            .map(|coupling| Coherence::new(&coupling, area, sea, time_ns, Source::new(seed, Purpose::Coupling, index)));
        let mut hull = Self {
            lever_arm: area.lever_arm,
            gain: area.dynamic_lever_arm,
            installation: area.installation,
            quasi_static: area.quasi_static,
            flexure,
            source,
            second,
            changes,
            next_change: 0,
            gusts: area.impulses.and_then(|i| Gusts::new(&i, Source::new(seed, Purpose::Impulses, index))),
            coherence,
            time_ns: if area.starts_at_rest { time_ns.max(0) } else { time_ns },
            now: Bend { theta: Vec3::ZERO, rate: Vec3::ZERO, static_part: area.installation },
        };
        hull.bend(sea, time_ns);
        hull
    }

    /// Bends on to a later instant; the same one again changes nothing.
    pub(crate) fn advance(&mut self, sea: &Sea, time_ns: i64) {
        while self.time_ns < time_ns {
            let until_ns = self.stretch(time_ns);
            self.time_ns = until_ns;
        }
        self.bend(sea, time_ns);
    }

    /// Steps the processes on to where the models or the strength of the noise change, at most to `time_ns`.
    fn stretch(&mut self, time_ns: i64) -> i64 {
        let due = |change: &FlexureChange| nanoseconds(change.at_s);
        while let Some(change) = self.changes.get(self.next_change)
            && due(change) <= self.time_ns
        {
            self.flexure.change(change.flexure);
            self.next_change += 1;
        }
        let change_ns = self.changes.get(self.next_change).map_or(NEVER, due);
        let (gain, gust_ns) = self.gusts.as_mut().map_or((1.0, NEVER), |gusts| gusts.at(self.time_ns));
        let until_ns = time_ns.min(change_ns).min(gust_ns);
        self.flexure.advance(until_ns - self.time_ns, gain, &mut self.source);
        if let Some((second, source)) = &mut self.second {
            second.advance(until_ns - self.time_ns, gain, source);
        }
        if let Some(coherence) = &mut self.coherence {
            coherence.advance(until_ns - self.time_ns);
        }
        until_ns
    }

    fn bend(&mut self, sea: &Sea, time_ns: i64) {
        self.now.theta = self.flexure.state().map(|[angle, _]| angle).into();
        self.now.rate = self.flexure.state().map(|[_, rate]| rate).into();
        if let Some((second, _)) = &self.second {
            self.now.theta += second.state().map(|[angle, _]| angle).into();
            self.now.rate += second.state().map(|[_, rate]| rate).into();
        }
        if let Some(coherence) = &mut self.coherence {
            let [angle, rate] = coherence.bend(sea, time_ns);
            self.now.theta += angle;
            self.now.rate += rate;
        }
        if self.quasi_static.period > 0.0 {
            self.now.static_part = Rot::exp(self.quasi_static.at(seconds(time_ns))) * self.installation;
        }
    }

    /// The flexure theta, rad.
    pub(crate) fn theta(&self) -> Vec3<Main> {
        self.now.theta
    }

    /// The static part `Exp(q) C_Phi`.
    pub(crate) fn static_part(&self) -> Rot<Main, Sub> {
        self.now.static_part
    }

    /// The whole deformation `C_s^m`.
    pub(crate) fn main_from_sub(&self) -> Rot<Main, Sub> {
        Rot::<Main, Main>::exp(self.now.theta) * self.now.static_part
    }

    /// Velocity of the sub unit relative to the main unit in inertial space, m/s: `w x r + r'`, 000 eq 6, 7.
    pub(crate) fn lever_velocity(&self, w_im_m: Vec3<Main>) -> Vec3<Main> {
        let r = self.lever_arm + (self.now.theta * self.gain).cross(self.lever_arm);
        w_im_m.cross(r) + (self.now.rate * self.gain).cross(self.lever_arm)
    }
}
