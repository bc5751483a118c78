use messages::Health;

/// The counters of a stage, summed over the processes that carried it out.
#[derive(Clone, Debug, Default)]
pub struct StageRun {
    /// The last word of the last process.
    pub last: Health,
    past: [u64; 9],
    processes: Vec<u32>,
}

/// A counter with what it counts, in words.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Total {
    /// Heading of its column.
    pub name: &'static str,
    /// The end of a sentence that begins with the number.
    pub said: &'static str,
    /// The count.
    pub count: u64,
}

const NAMES: [(&str, &str); 9] = [
    ("in", "messages taken in"),
    ("out", "messages given out"),
    ("lost", "messages never arrived"),
    ("missing", "samples were missing in the units' own streams"),
    ("refused", "samples were refused"),
    ("suspect", "samples were at the end of the range or stuck"),
    ("dropped", "messages were dropped because a slow thread did not keep up"),
    ("late", "flexure models came late"),
    ("new windows", "learning windows were started anew by a gap"),
];

fn counters(health: &Health) -> [u64; 9] {
    let Health { taken, given, lost, missing, refused, suspect, overflow, late, restarted_windows, .. } = *health;
    [taken, given, lost, missing, refused, suspect, overflow, late, restarted_windows]
}

impl StageRun {
    /// Takes what the stage says.
    pub fn take(&mut self, health: &Health) {
        if !self.processes.contains(&health.pid) {
            let before = counters(&self.last);
            self.past.iter_mut().zip(before).for_each(|(past, before)| *past = past.saturating_add(before));
            self.processes.push(health.pid);
        }
        self.last = *health;
    }

    /// How often it was started again.
    pub fn restarts(&self) -> usize {
        self.processes.len().saturating_sub(1)
    }

    /// All counters.
    pub fn totals(&self) -> [Total; 9] {
        let now = counters(&self.last);
        std::array::from_fn(|i| Total {
            name: NAMES[i].0,
            said: NAMES[i].1,
            count: self.past[i].saturating_add(now[i]),
        })
    }

    /// Those that tell of trouble and are not zero.
    pub fn troubles(&self) -> impl Iterator<Item = Total> {
        self.totals().into_iter().skip(2).filter(|total| total.count > 0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_process_counted_before_it_died_stays() {
        let mut stage = StageRun::default();
        for (pid, taken, late) in [(1, 10, 0), (1, 20, 1), (2, 5, 1), (2, 7, 1)] {
            stage.take(&Health { pid, taken, late, ..Health::default() });
        }
        assert_eq!((stage.totals()[0].count, stage.restarts()), (27, 1));
        assert_eq!(stage.troubles().map(|total| (total.name, total.count)).collect::<Vec<_>>(), [("late", 2)]);
    }
}
