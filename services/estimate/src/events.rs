//! What the log hears of an area's solutions: what changes, and not every sample.

use frames::unit::seconds;
use messages::{Alarms, Flags, FlexureParams, Solution};
use runtime::Throttle;

/// What is told when it comes and when it goes; the others come and go with single samples, or say what validity says.
const STATES: Flags = Flags::UNOBSERVABLE
    .union(Flags::SILENT)
    .union(Flags::STUCK)
    .union(Flags::ACCEL_STUCK)
    .union(Flags::TIME_BACK)
    .union(Flags::INCONSISTENT);
/// What is told when it comes.
const HAPPENINGS: Flags = Flags::RESET.union(Flags::NEW_EPOCH);

/// Watches the solutions of an area. A sample that changes nothing costs some comparisons and no allocation.
#[derive(Debug)]
pub struct Events {
    states: Vec<Turn>,
    happenings: Vec<Happening>,
    /// Flags of the solution before; `None` before the first, with which every chain begins.
    seen: Option<Flags>,
    /// Something has changed that has not been told yet.
    pending: bool,
    valid: Turn,
    params_id: u64,
    alarms: Alarms,
    /// The set that was offered last, while it is not in force.
    offered: Option<(u64, i64)>,
}

/// Something that is so or not.
#[derive(Debug)]
struct Turn {
    flag: Flags,
    words: &'static str,
    is: bool,
    told: bool,
    /// When `is` changed last.
    changed_ns: i64,
    /// When `told` began.
    since_ns: Option<i64>,
    changes: u64,
    throttle: Throttle,
}

impl Turn {
    fn new(flag: Flags, words: &'static str) -> Self {
        let throttle = Throttle::default();
        Self { flag, words, is: false, told: false, changed_ns: 0, since_ns: None, changes: 0, throttle }
    }

    /// How long the state before lasted, s, and how often it has changed if more than once: if it is time to tell of a change.
    fn take(&mut self, is: bool, time_ns: i64) -> Option<(Option<f64>, Option<u64>)> {
        if is != self.is {
            (self.is, self.changed_ns) = (is, time_ns);
            self.changes += 1;
        }
        if self.is == self.told || !self.throttle.pass(time_ns) {
            return None;
        }
        self.told = is;
        let lasted_s = self.since_ns.replace(self.changed_ns).map(|since_ns| seconds(self.changed_ns - since_ns));
        let changes = std::mem::take(&mut self.changes);
        Some((lasted_s, (changes > 1).then_some(changes)))
    }

    fn open(&self) -> bool {
        self.is != self.told
    }
}

/// Something that comes with a sample.
#[derive(Debug)]
struct Happening {
    flag: Flags,
    words: &'static str,
    times: u64,
    throttle: Throttle,
}

impl Happening {
    fn new(flag: Flags, words: &'static str) -> Self {
        Self { flag, words, times: 0, throttle: Throttle::default() }
    }

    fn see(&mut self, time_ns: i64) {
        self.times += 1;
        if self.throttle.pass(time_ns) {
            let times = std::mem::take(&mut self.times);
            let (flag, time_s, words) = (self.flag.names(), seconds(time_ns), self.words);
            tracing::warn!(flag, time_s, times, "{words}");
        }
    }
}

fn sentences(of: Flags) -> impl Iterator<Item = (Flags, &'static str)> {
    Flags::SENTENCES.into_iter().filter(move |(flag, _)| of.contains(*flag))
}

impl Default for Events {
    fn default() -> Self {
        Self {
            states: sentences(STATES).map(|(flag, words)| Turn::new(flag, words)).collect(),
            happenings: sentences(HAPPENINGS).map(|(flag, words)| Happening::new(flag, words)).collect(),
            seen: None,
            pending: false,
            valid: Turn::new(Flags::empty(), ""),
            params_id: 0,
            alarms: Alarms::empty(),
            offered: None,
        }
    }
}

impl Events {
    /// Notes a parameter set that has been offered to the estimator.
    pub fn offer(&mut self, set: &FlexureParams) {
        self.offered = Some((set.id, set.effective_from_ns));
    }

    /// Looks at a solution.
    pub fn see(&mut self, solution: &Solution) {
        let time_ns = solution.header.time_ns;
        let before = self.seen.replace(solution.flags).unwrap_or(HAPPENINGS);
        let come = (solution.flags & HAPPENINGS) - before;
        if !come.is_empty() {
            let come = self.happenings.iter_mut().filter(|happening| come.contains(happening.flag));
            come.for_each(|happening| happening.see(time_ns));
        }
        if self.pending || (solution.flags ^ before).intersects(STATES) {
            self.states.iter_mut().for_each(|turn| tell_state(turn, solution));
        }
        if self.pending || solution.is_valid() != self.valid.is {
            self.tell_validity(solution);
        }
        self.pending = self.valid.open() || self.states.iter().any(Turn::open);
        if solution.params_id != self.params_id {
            self.tell_model(solution.params_id, time_ns);
        }
        if let Some((id, effective_from_ns)) = self.offered.filter(|(_, from_ns)| time_ns >= *from_ns) {
            self.offered = None;
            if id != solution.params_id {
                let (effective_s, in_force) = (seconds(effective_from_ns), solution.params_id);
                tracing::warn!(id, effective_s, in_force, "a flexure model was refused");
            }
        }
    }

    /// Looks at the alarms that stand.
    pub fn alarms(&mut self, raised: Alarms) {
        for (name, alarm) in (raised ^ self.alarms).iter_names() {
            let alarm_name = name.to_lowercase();
            match raised.contains(alarm) {
                true => tracing::warn!(alarm = alarm_name, "an alarm is raised"),
                false => tracing::info!(alarm = alarm_name, "an alarm is over"),
            }
        }
        self.alarms = raised;
    }

    fn tell_validity(&mut self, solution: &Solution) {
        let time_s = seconds(solution.header.time_ns);
        let Some((lasted_s, changes)) = self.valid.take(solution.is_valid(), solution.header.time_ns) else { return };
        let flags = solution.flags.names();
        match solution.is_valid() {
            true => {
                let delay_ms = (solution.delay_sigma > 0.0).then_some(solution.delay * 1e3);
                tracing::info!(time_s, invalid_s = lasted_s, changes, delay_ms, flags, "the solutions are valid");
            }
            false => tracing::warn!(time_s, valid_s = lasted_s, changes, flags, "the solutions are not valid"),
        }
    }

    fn tell_model(&mut self, id: u64, time_ns: i64) {
        let (time_s, before) = (seconds(time_ns), std::mem::replace(&mut self.params_id, id));
        match before {
            0 => tracing::info!(id, time_s, "the first flexure model is in force"),
            _ => tracing::debug!(id, before, time_s, "another flexure model is in force"),
        }
    }
}

fn tell_state(turn: &mut Turn, solution: &Solution) {
    let time_s = seconds(solution.header.time_ns);
    let is = solution.flags.contains(turn.flag);
    let Some((lasted_s, changes)) = turn.take(is, solution.header.time_ns) else { return };
    let (flag, words) = (turn.flag.names(), turn.words);
    match is {
        true => tracing::warn!(flag, time_s, changes, "{words}"),
        false => tracing::info!(flag, time_s, changes, lasted_s, "over: {words}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_flaps_is_told_now_and_then_and_with_how_often_it_changed() {
        let mut turn = Turn::new(Flags::INCONSISTENT, "");
        let second = |s: f64| (s * 1e9) as i64;
        assert_eq!(turn.take(false, 0), None, "nothing has changed");
        assert_eq!(turn.take(true, second(1.0)), Some((None, None)));
        let told: Vec<_> =
            (11..320).filter_map(|tenth| turn.take(tenth % 2 == 0, second(f64::from(tenth) / 10.0))).collect();
        assert_eq!(told, [(Some(10.1), Some(101)); 3]);
    }

    #[test]
    fn what_is_told_late_is_told_with_its_own_length() {
        let mut turn = Turn::new(Flags::INCONSISTENT, "");
        assert!(turn.take(true, 1_000_000_000).is_some());
        let told: Vec<_> = (2..20).filter_map(|s| Some((s, turn.take(s < 4, s * 1_000_000_000)?))).collect();
        assert_eq!(told, [(11, (Some(3.0), None))]);
    }

    /// Every chain begins with a new epoch, which is no event; another one is.
    #[test]
    fn what_happens_is_counted_from_the_second_solution_on() {
        let mut events = Events::default();
        let mut times = Vec::new();
        for (second, flags) in
            [Flags::NEW_EPOCH, Flags::PRIOR, Flags::NEW_EPOCH, Flags::PRIOR, Flags::NEW_EPOCH].into_iter().enumerate()
        {
            let mut solution = Solution { flags, ..Solution::default() };
            solution.header.time_ns = second as i64 * 1_000_000_000;
            events.see(&solution);
            times.push(events.happenings.iter().map(|happening| happening.times).sum::<u64>());
        }
        // the second one has been told at once, the third one waits
        assert_eq!(times, [0, 0, 0, 0, 1]);
    }

    #[test]
    fn a_set_that_is_not_in_force_when_its_time_has_come_was_refused() {
        let mut events = Events::default();
        let mut solution = Solution { params_id: 3, ..Solution::default() };
        events.offer(&FlexureParams { id: 7, effective_from_ns: 50, ..FlexureParams::default() });
        solution.header.time_ns = 49;
        events.see(&solution);
        assert_eq!(events.offered, Some((7, 50)), "its time has not come");
        solution.header.time_ns = 50;
        events.see(&solution);
        assert_eq!((events.offered, events.params_id), (None, 3));
    }
}
