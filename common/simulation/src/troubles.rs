//! What goes wrong with a sub unit, sample by sample, as [`crate::Event`] defines it.

use crate::{Event, Trouble};
use frames::unit::nanoseconds;

/// The troubles of one unit.
pub(crate) struct Troubles {
    /// With the time of each, ns.
    events: Vec<(i64, Trouble)>,
    /// What the gyros gave last, rad.
    last: Option<[f64; 3]>,
}

impl Troubles {
    pub(crate) fn new(events: &[Event]) -> Self {
        Self { events: events.iter().map(|event| (nanoseconds(event.at_s), event.trouble)).collect(), last: None }
    }

    fn due(&self, end_ns: i64) -> impl Iterator<Item = &(i64, Trouble)> {
        self.events.iter().filter(move |(at_ns, _)| *at_ns <= end_ns)
    }

    /// Spoils the increments of the sample that truly ends at a time; samples must come in their order, none left out.
    pub(crate) fn spoil(&mut self, end_ns: i64, dtheta: &mut [f64; 3], dvel: &mut [f64; 3]) {
        for (_, trouble) in self.due(end_ns) {
            match *trouble {
                Trouble::DeadAccelerometers => *dvel = [0.0; 3],
                Trouble::StuckGyro(axis) => {
                    if let (Some(value), Some(last)) = (dtheta.get_mut(axis), &self.last) {
                        *value = last[axis];
                    }
                }
                Trouble::Gap(_) | Trouble::DelayStep(_) => {}
            }
        }
        self.last = Some(*dtheta);
    }

    /// Whether no sample that truly ends at a time comes.
    pub(crate) fn silent(&self, end_ns: i64) -> bool {
        self.due(end_ns).any(|(at_ns, trouble)| match trouble {
            Trouble::Gap(length_s) => end_ns < at_ns.saturating_add(nanoseconds(*length_s)),
            _ => false,
        })
    }

    /// By how much later the stamp of a sample that truly ends at a time is, s.
    pub(crate) fn delay_s(&self, end_ns: i64) -> f64 {
        self.due(end_ns).fold(0.0, |sum, (_, trouble)| match trouble {
            Trouble::DelayStep(by_s) => sum + by_s,
            _ => sum,
        })
    }
}
