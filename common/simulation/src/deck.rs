use crate::Area;
use crate::hull::Hull;
use crate::imu::Imu;
use crate::random::{Purpose, Source};
use crate::sampling::Sampling;
use crate::sea::{Motion, Sea, increments};
use crate::simulator::header;
use crate::troubles::Troubles;
use crate::wire::Line;
use frames::unit::seconds;
use frames::{Inertial, Rot, Sub, Vec3};
use messages::{ImuSample, Truth};

/// One area: the hull under it, its unit, and the line from there.
pub(crate) struct Deck {
    hull: Hull,
    imu: Imu<Sub>,
    troubles: Troubles,
    line: Line,
    sampling: Sampling,
    /// The sample whose end comes next; the first is only where the first one that is given begins.
    next: i64,
    last: Option<Pose>,
    run_id: u64,
    index: u32,
}

/// The sub unit at one of its sampling instants.
#[derive(Clone, Copy)]
struct Pose {
    motion: Motion,
    inertial_from_sub: Rot<Inertial, Sub>,
    lever_velocity_i: Vec3<Inertial>,
}

/// What every unit of a run shares.
pub(crate) struct Run {
    pub(crate) rate_hz: f64,
    pub(crate) seed: u64,
    pub(crate) run_id: u64,
}

/// What the main unit went through since its last sample.
pub(crate) struct Leg {
    pub(crate) from: Motion,
    pub(crate) to: Motion,
    pub(crate) dvel_i: Vec3<Inertial>,
}

impl Deck {
    /// `begin_ns` is where the main unit's first sample begins.
    pub(crate) fn new(area: &Area, index: u32, run: &Run, sea: &Sea, begin_ns: i64) -> Self {
        let Run { rate_hz, seed, run_id } = *run;
        let sampling = Sampling::new(rate_hz * (1.0 + area.wire.rate_error), area.wire.phase_s);
        let next = sampling.last_by(begin_ns);
        Self {
            hull: Hull::new(
                area,
                u64::from(area.hull.unwrap_or(index)),
                seed,
                sea,
                begin_ns.min(sampling.instant(next)),
            ),
            imu: Imu::new(&area.unit, seed, u64::from(index) + 1),
            troubles: Troubles::new(&area.events),
            line: Line::new(&area.wire, Source::new(seed, Purpose::Wire, u64::from(index))),
            sampling,
            next,
            last: None,
            run_id,
            index,
        }
    }

    /// Goes on to the end of the leg, sends off the samples that end on the way, and hands out those that are due.
    pub(crate) fn advance(&mut self, sea: &Sea, leg: &Leg, out: &mut Vec<ImuSample>) {
        let now_ns = leg.to.time_ns;
        loop {
            let end_ns = self.sampling.instant(self.next);
            if end_ns > now_ns {
                break;
            }
            self.hull.advance(sea, end_ns);
            self.sample(sea, leg, end_ns);
            self.next += 1;
        }
        self.hull.advance(sea, now_ns);
        self.line.deliver(now_ns, out);
    }

    /// Hands out what is still under way.
    pub(crate) fn finish(&mut self, out: &mut Vec<ImuSample>) {
        self.line.flush(out);
    }

    /// The truth at the end of the leg of main sample `sequence`.
    pub(crate) fn truth(&self, sequence: u64, motion: &Motion) -> Truth {
        Truth {
            header: header(self.run_id, sequence, motion.time_ns),
            q: self.hull.main_from_sub().quaternion(),
            static_q: self.hull.static_part().quaternion(),
            dynamic: self.hull.theta().array(),
            ship: motion.nav_from_main.quaternion(),
            area: self.index,
            reserved: 0,
        }
    }

    fn sample(&mut self, sea: &Sea, leg: &Leg, end_ns: i64) {
        let motion = if end_ns == leg.to.time_ns { leg.to } else { sea.at(end_ns) };
        let to = Pose {
            motion,
            inertial_from_sub: motion.inertial_from_main * self.hull.main_from_sub(),
            lever_velocity_i: motion.inertial_from_main * self.hull.lever_velocity(motion.w_im_m),
        };
        let Some(from) = self.last.replace(to) else { return };
        let begin_ns = from.motion.time_ns;
        let main_dvel_i = if end_ns == leg.to.time_ns && begin_ns == leg.from.time_ns {
            leg.dvel_i
        } else {
            sea.velocity_increment(&from.motion, &motion)
        };
        let dvel_i = main_dvel_i + to.lever_velocity_i - from.lever_velocity_i;
        let (dtheta, dvel) = increments(from.inertial_from_sub, to.inertial_from_sub, dvel_i);
        let interval_ns = end_ns - begin_ns;
        let (mut dtheta, mut dvel) = self.imu.measure(dtheta, dvel, seconds(interval_ns));
        self.troubles.spoil(end_ns, &mut dtheta, &mut dvel);
        let sample = ImuSample {
            header: header(self.run_id, self.next as u64, end_ns),
            interval_ns,
            dtheta,
            dvel,
            unit: self.index + 1,
            ..ImuSample::default()
        };
        self.line.send(sample, &self.troubles);
    }
}
