//! The way of a sub unit's samples to whoever reads them.

use crate::Wire;
use crate::random::Source;
use crate::troubles::Troubles;
use frames::unit::{nanoseconds, seconds};
use messages::ImuSample;
use std::collections::VecDeque;

/// Samples under way, first in first out but for swaps: a sample that is not due keeps those behind it waiting.
pub(crate) struct Line {
    wire: Wire,
    /// With the time at which each is handed out, ns.
    under_way: VecDeque<(i64, ImuSample)>,
    /// A sample that lets its successor go first, and how often it comes.
    held: Option<(ImuSample, usize)>,
    source: Source,
}

impl Line {
    pub(crate) fn new(wire: &Wire, source: Source) -> Self {
        Self { wire: *wire, under_way: VecDeque::new(), held: None, source }
    }

    /// Sends a sample off, stamped true.
    pub(crate) fn send(&mut self, mut sample: ImuSample, troubles: &Troubles) {
        let jitter = self.wire.jitter_s * self.source.normal();
        let lost = self.source.happens(self.wire.loss);
        let copies = if self.source.happens(self.wire.duplicate) { 2 } else { 1 };
        let late = self.source.happens(self.wire.swap);
        let end_ns = sample.header.time_ns;
        if lost || troubles.silent(end_ns) {
            return;
        }
        let delay = self.wire.delay_s + troubles.delay_s(end_ns);
        let shift = nanoseconds(delay + self.wire.skew * seconds(end_ns) + jitter);
        sample.header.time_ns = end_ns.saturating_add(shift);
        if let Some((earlier, earlier_copies)) = self.held.take() {
            self.enqueue(sample, copies);
            self.enqueue(earlier, earlier_copies);
        } else if late {
            self.held = Some((sample, copies));
        } else {
            self.enqueue(sample, copies);
        }
    }

    /// Hands out what is due by a time.
    pub(crate) fn deliver(&mut self, until_ns: i64, out: &mut Vec<ImuSample>) {
        while let Some((_, sample)) = self.under_way.pop_front_if(|(due_ns, _)| *due_ns <= until_ns) {
            out.push(sample);
        }
    }

    /// Hands out everything that is still under way.
    pub(crate) fn flush(&mut self, out: &mut Vec<ImuSample>) {
        out.extend(self.under_way.drain(..).map(|(_, sample)| sample));
        if let Some((sample, copies)) = self.held.take() {
            out.extend(std::iter::repeat_n(sample, copies));
        }
    }

    fn enqueue(&mut self, sample: ImuSample, copies: usize) {
        let due_ns = sample.header.time_ns.saturating_add(nanoseconds(self.wire.transit_s));
        for _ in 0..copies {
            self.under_way.push_back((due_ns, sample));
        }
    }
}
