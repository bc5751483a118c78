//! One area's solutions as they come, and what can be told of the area at an instant.

use crate::{Attitude, Deformation, Motion, Report};
use frames::{Nav, Rot, Sub, Vec3};
use messages::{ClockDomain, Flags, Header, Solution};

/// A solution that carries one of these is valid, but of less trust than usual.
const LESS_TRUSTED: Flags = Flags::PRIOR.union(Flags::UNOBSERVABLE).union(Flags::INCONSISTENT);

/// What is known of an area when one of its solutions has come.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// The instant of the attitude on the host's monotonic clock, ns.
    pub instant_ns: i64,
    /// The attitude; `None` when it is not known or not valid.
    pub attitude: Option<Attitude>,
    /// The deformation at the solution's own instant; `None` when it is not valid.
    pub deformation: Option<Deformation>,
    /// Rotation vector of the zero in force, rad; `None` without one.
    pub zero: Option<[f64; 3]>,
    /// Whether the attitude was carried forward.
    pub extrapolated: bool,
    /// Whether the solution is of less trust than usual.
    pub less_trusted: bool,
}

impl Moment {
    /// The same as a report, when its instant is this one in UTC, ns since 1970.
    pub fn report(&self, utc_ns: i64) -> Report {
        let Self { attitude, deformation, zero, .. } = *self;
        Report { utc_ns, attitude, deformation, zero, reduced: self.extrapolated || self.less_trusted }
    }
}

/// Follows the solutions of one area.
#[derive(Clone, Copy, Debug, Default)]
pub struct Track {
    motion: Motion,
}

impl Track {
    /// Takes in a solution; marks of the end are not for it.
    pub fn see(&mut self, solution: &Solution) {
        if !solution.is_valid() {
            self.motion = Motion::default();
        } else if let Some(deck) = known(solution) {
            self.motion.see(solution.header.time_ns, deck, solution.deck_sigma.into());
        }
    }

    /// What can be told by the solution that was seen last, the attitude carried forward by `lead_ns`.
    ///
    /// Where the solution has no attitude of its own, the last one is carried forward if it is not too old.
    pub fn moment(&self, solution: &Solution, lead_ns: i64) -> Moment {
        let time_ns = solution.header.time_ns;
        let instant_ns = instant_ns(&solution.header);
        let found = self.motion.at(time_ns, lead_ns).filter(|_| solution.is_valid());
        let at_ns = found.map_or(time_ns + lead_ns, |(_, at_ns)| at_ns);
        let own = known(solution).is_some();
        Moment {
            instant_ns: instant_ns + at_ns - time_ns,
            attitude: found.map(|(attitude, _)| attitude),
            deformation: deformation(solution),
            zero: solution.flags.contains(Flags::ZEROED).then_some(solution.zero),
            extrapolated: found.is_some() && (at_ns != time_ns || !own),
            less_trusted: solution.flags.intersects(LESS_TRUSTED),
        }
    }
}

/// When a message's data were valid, on the host's monotonic clock: where its own time is of another clock, when its sample was due.
pub fn instant_ns(header: &Header) -> i64 {
    if header.clock_domain == ClockDomain::HostMonotonic as u32 { header.time_ns } else { header.stamps.due_ns }
}

fn known(solution: &Solution) -> Option<Rot<Nav, Sub>> {
    Rot::from_quaternion(solution.deck).filter(|_| Vec3::<Nav>::from(solution.deck_sigma).is_finite())
}

fn deformation(solution: &Solution) -> Option<Deformation> {
    let finite = solution.phi.iter().chain(&solution.range).all(|v| v.is_finite());
    (solution.is_valid() && finite).then_some(Deformation { angles: solution.phi, range: solution.range })
}
