//! Which of an area's limits have been crossed for too long.

use crate::configuration::AlarmLimits;
use frames::unit::nanoseconds;
use messages::{Alarms, Solution};

/// Watches the solutions of an area, by data time.
#[derive(Clone, Debug)]
pub struct AlarmWatch {
    limits: Vec<Limit>,
    hold_ns: i64,
    invalid_ns: Option<i64>,
    valid_since: Option<i64>,
    raised: Alarms,
}

/// The limit of one component.
#[derive(Clone, Debug)]
struct Limit {
    alarm: Alarms,
    value: fn(&Solution, usize) -> f64,
    axis: usize,
    greatest: f64,
    /// Since when the component has been on the other side of the limit than the alarm says.
    other_since: Option<i64>,
}

const DEFORMATION: [Alarms; 3] = [Alarms::DEFORMATION_X, Alarms::DEFORMATION_Y, Alarms::DEFORMATION_Z];
const RANGE: [Alarms; 3] = [Alarms::RANGE_X, Alarms::RANGE_Y, Alarms::RANGE_Z];

impl AlarmWatch {
    /// Without limits nothing is ever raised.
    pub fn new(limits: Option<&AlarmLimits>) -> Self {
        let mut all = Vec::new();
        let mut add = |greatest: Option<[f64; 3]>, alarms: [Alarms; 3], value: fn(&Solution, usize) -> f64| {
            for (axis, greatest) in greatest.into_iter().flatten().enumerate() {
                all.push(Limit { alarm: alarms[axis], value, axis, greatest, other_since: None });
            }
        };
        add(limits.and_then(|limits| limits.deformation), DEFORMATION, |solution, axis| solution.phi[axis].abs());
        add(limits.and_then(|limits| limits.range), RANGE, |solution, axis| solution.range[axis]);
        Self {
            limits: all,
            hold_ns: limits.map_or(0, |limits| nanoseconds(limits.hold_s)),
            invalid_ns: limits.and_then(|limits| limits.invalid_s).map(nanoseconds),
            valid_since: None,
            raised: Alarms::empty(),
        }
    }

    /// Takes in a solution. One that is not valid leaves the alarms of deformation and range as they are.
    pub fn see(&mut self, solution: &Solution) {
        let time_ns = solution.header.time_ns;
        if !solution.is_valid() {
            let since_ns = *self.valid_since.get_or_insert(time_ns);
            self.without(time_ns - since_ns);
            return;
        }
        self.valid_since = Some(time_ns);
        self.raised.remove(Alarms::INVALID);
        for limit in &mut self.limits {
            let beyond = (limit.value)(solution, limit.axis) > limit.greatest;
            if beyond == self.raised.contains(limit.alarm) {
                limit.other_since = None;
            } else if time_ns - *limit.other_since.get_or_insert(time_ns) >= self.hold_ns {
                self.raised.set(limit.alarm, beyond);
                limit.other_since = None;
            }
        }
    }

    /// Notes that there has been no valid solution for so long, ns.
    pub fn without(&mut self, silent_ns: i64) {
        if self.invalid_ns.is_some_and(|longest_ns| silent_ns > longest_ns) {
            self.raised.insert(Alarms::INVALID);
        }
    }

    /// The alarms that stand.
    pub fn raised(&self) -> Alarms {
        self.raised
    }
}
