use super::{Marks, Trace};
use frames::unit;
use messages::{Alarms, Solution};
use pipeline::alarm::AlarmWatch;
use pipeline::configuration::AlarmLimits;

/// For how long an alarm stood.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spell {
    /// Which.
    pub alarm: Alarms,
    /// Since when, s from the beginning.
    pub from_s: f64,
    /// Until when; `None` if it stood at the end.
    pub to_s: Option<f64>,
    /// The largest value meanwhile, rad; `None` where the alarm is not one of a value.
    pub most: Option<f64>,
}

/// The alarms of an area, worked out from its solutions as `estimate` does.
#[derive(Clone, Debug)]
pub struct AlarmRun {
    watch: AlarmWatch,
    valid_ns: Option<i64>,
    raised: Alarms,
    /// In the order in which they were raised.
    pub spells: Vec<Spell>,
    /// Which stood when.
    pub trace: Trace<Marks>,
}

impl AlarmRun {
    /// With the limits of the configuration.
    pub fn new(limits: Option<&AlarmLimits>, interval_ns: i64) -> Self {
        Self {
            watch: AlarmWatch::new(limits),
            valid_ns: None,
            raised: Alarms::empty(),
            spells: Vec::new(),
            trace: Trace::new(interval_ns),
        }
    }

    /// Takes the next solution.
    pub fn take(&mut self, since_ns: i64, solution: &Solution) {
        let time_ns = solution.header.time_ns;
        if let Some(valid_ns) = self.valid_ns {
            // a silence raises the alarm although no solution says so
            self.watch.without(time_ns.saturating_sub(valid_ns));
            self.compare(since_ns);
        }
        self.watch.see(solution);
        self.compare(since_ns);
        if solution.is_valid() {
            self.valid_ns = Some(time_ns);
        }
        if !self.raised.is_empty() {
            for spell in self.spells.iter_mut().filter(|spell| spell.to_s.is_none()) {
                let value = value(spell.alarm, solution);
                spell.most = spell.most.into_iter().chain(value).reduce(f64::max);
            }
        }
        self.trace.take(since_ns, Marks { any: u64::from(self.raised.bits()) });
    }

    fn compare(&mut self, since_ns: i64) {
        let now = self.watch.raised();
        for alarm in (now - self.raised).iter() {
            self.spells.push(Spell { alarm, from_s: unit::seconds(since_ns), to_s: None, most: None });
        }
        let over = self.raised - now;
        for spell in self.spells.iter_mut().filter(|spell| spell.to_s.is_none() && over.contains(spell.alarm)) {
            spell.to_s = Some(unit::seconds(since_ns));
        }
        self.raised = now;
    }
}

/// What an alarm is about.
fn value(alarm: Alarms, solution: &Solution) -> Option<f64> {
    let axis = |alarms: [Alarms; 3]| alarms.iter().position(|of| *of == alarm);
    let deformation = axis([Alarms::DEFORMATION_X, Alarms::DEFORMATION_Y, Alarms::DEFORMATION_Z]);
    let range = axis([Alarms::RANGE_X, Alarms::RANGE_Y, Alarms::RANGE_Z]);
    let of = |at: usize| solution.is_valid().then(|| solution.phi[at].abs());
    deformation.map_or_else(|| range.and_then(|at| solution.is_valid().then(|| solution.range[at])), of)
}

#[cfg(test)]
mod tests {
    use super::*;
    use messages::Header;

    fn solution(t_s: f64, x: f64, valid: u32) -> Solution {
        let header = Header { time_ns: unit::nanoseconds(t_s), ..Header::default() };
        Solution { header, valid, phi: [x, 0.0, 0.0], ..Solution::default() }
    }

    #[test]
    fn an_alarm_has_its_beginning_its_end_and_its_largest_value() {
        let limits = AlarmLimits { deformation: Some([1.0; 3]), range: None, invalid_s: Some(2.0), hold_s: 0.5 };
        let mut run = AlarmRun::new(Some(&limits), 100_000_000);
        for i in 0..100 {
            let t = 0.1 * f64::from(i);
            let x = if (2.0..4.0).contains(&t) { 1.0 + 0.1 * t } else { 0.2 };
            run.take(unit::nanoseconds(t), &solution(t, x, 1));
        }
        run.take(unit::nanoseconds(15.0), &solution(15.0, 0.0, 1));
        run.take(unit::nanoseconds(16.0), &solution(16.0, 0.0, 0));
        run.take(unit::nanoseconds(18.5), &solution(18.5, 0.0, 0));
        let [first, silence, last] = run.spells[..] else { panic!("{:?}", run.spells) };
        assert_eq!(first.alarm, Alarms::DEFORMATION_X);
        assert!((first.from_s - 2.5).abs() < 0.15 && first.to_s.is_some_and(|t| (t - 4.5).abs() < 0.15), "{first:?}");
        assert!(first.most.is_some_and(|most| (most - 1.39).abs() < 1e-9), "{first:?}");
        assert_eq!((silence.alarm, silence.from_s, silence.to_s), (Alarms::INVALID, 15.0, Some(15.0)));
        assert_eq!((last.alarm, last.from_s, last.to_s, last.most), (Alarms::INVALID, 18.5, None, None));
    }

    #[test]
    fn without_limits_nothing_is_raised() {
        let mut run = AlarmRun::new(None, 1);
        run.take(0, &solution(0.0, 9.0, 0));
        run.take(1, &solution(1e6, 9.0, 1));
        assert!(run.spells.is_empty());
    }
}
