//! The points of the window: pairs thinned to 10 Hz by data time, without a gap.

use super::Settings;
use frames::{Main, MainStart, Rot, Sub, SubStart, unit};
use messages::{Flags, ImuPair, Solution};
use std::collections::VecDeque;

/// Nominal distance of two points, ns.
const SPACING_NS: i64 = 100_000_000;
/// A longer distance of two points starts the window anew, ns.
const GAP_NS: i64 = 350_000_000;

/// The gyros' attitudes of both units at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Data time, ns.
    pub time_ns: i64,
    /// `C_m^m0` by the main unit's gyros.
    pub attitude_m: Rot<MainStart, Main>,
    /// `C_s^s0` by the sub unit's gyros.
    pub attitude_s: Rot<SubStart, Sub>,
}

/// The latest points of one run and epoch.
#[derive(Clone, Debug)]
pub struct Window {
    points: VecDeque<Point>,
    length_ns: i64,
    period_ns: i64,
    minimum_ns: i64,
    /// Whether points without a solution count.
    unsolved: bool,
    source: (u64, u64),
    begin_ns: i64,
    fired_ns: Option<i64>,
    restarted: u64,
}

impl Window {
    /// An empty window; a length or period that is not positive is taken as one point.
    pub fn new(settings: &Settings) -> Self {
        let positive = |seconds: f64| unit::nanoseconds(seconds).max(SPACING_NS);
        Self {
            points: VecDeque::new(),
            length_ns: positive(settings.window_s),
            period_ns: positive(settings.period_s),
            minimum_ns: positive(settings.minimum_s),
            unsolved: settings.provisional,
            source: (0, 0),
            begin_ns: 0,
            fired_ns: None,
            restarted: 0,
        }
    }

    /// Takes a pair; `true` when the window is due to be identified, the pair being its last point. Points are the gyros' alone, so that those from before
    /// the first valid solution can count. They do where a filter undoes what the first windows get wrong: elsewhere parameters that come with the first
    /// solution, whose constant is the coarsest, cost the demonstration 8 % for good.
    pub fn take(&mut self, pair: &ImuPair, solution: &Solution) -> bool {
        if pair.header.sequence != solution.header.sequence {
            return false;
        }
        let solved = solution.is_valid() && solution.epoch == pair.epoch;
        if !solved && !self.unsolved {
            self.restart();
            return false;
        }
        if (pair.flags | solution.flags).intersects(Flags::GAP | Flags::SILENT) {
            return false;
        }
        let time_ns = pair.header.time_ns;
        let source = (pair.header.run_id, pair.epoch);
        if let Some(last) = self.points.back() {
            let elapsed = time_ns - last.time_ns;
            if source != self.source || !(0..=GAP_NS).contains(&elapsed) {
                self.restart();
            } else if elapsed < SPACING_NS - pair.interval_ns.clamp(0, SPACING_NS) / 2 {
                return false;
            }
        }
        let attitudes = (Rot::from_quaternion(pair.attitude_m), Rot::from_quaternion(pair.attitude_s));
        let (Some(attitude_m), Some(attitude_s)) = attitudes else { return false };
        if self.points.is_empty() {
            (self.source, self.begin_ns) = (source, time_ns);
        }
        self.points.push_back(Point { time_ns, attitude_m, attitude_s });
        while self.points.front().is_some_and(|first| time_ns - first.time_ns > self.length_ns) {
            self.points.pop_front();
        }
        solved && self.due(time_ns)
    }

    fn due(&mut self, time_ns: i64) -> bool {
        let due = match self.fired_ns {
            None => time_ns - self.begin_ns >= self.minimum_ns,
            Some(fired_ns) => time_ns - fired_ns >= self.period_ns,
        };
        if due {
            self.fired_ns = Some(time_ns);
        }
        due
    }

    fn restart(&mut self) {
        if !self.points.is_empty() {
            self.points.clear();
            self.fired_ns = None;
            self.restarted += 1;
        }
    }

    /// Forgets all but the last points.
    pub fn keep(&mut self, length_s: f64) {
        let Some(last) = self.points.back() else { return };
        let oldest_ns = last.time_ns - unit::nanoseconds(length_s);
        while self.points.front().is_some_and(|first| first.time_ns < oldest_ns) {
            self.points.pop_front();
        }
    }

    /// The points, oldest first.
    pub fn points(&mut self) -> &[Point] {
        self.points.make_contiguous()
    }

    /// Length of what is held, s.
    pub fn length_s(&self) -> f64 {
        match (self.points.front(), self.points.back()) {
            (Some(first), Some(last)) => unit::seconds(last.time_ns - first.time_ns),
            _ => 0.0,
        }
    }

    /// How often points were thrown away because of a gap, a new epoch or run, or an invalid solution.
    pub fn restarted(&self) -> u64 {
        self.restarted
    }
}
