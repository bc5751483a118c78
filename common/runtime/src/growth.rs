use crate::Throttle;
use messages::Health;

/// Counters that go on growing are told so often, ns.
const PAUSE_NS: i64 = 10_000_000_000;

/// Tells when what a stage counts of lost and useless data has grown.
#[derive(Debug)]
pub(crate) struct Growth {
    told: [u64; 7],
    throttle: Throttle,
}

fn counts(health: &Health) -> [u64; 7] {
    let Health { lost, missing, refused, suspect, overflow, late, restarted_windows, .. } = *health;
    [lost, missing, refused, suspect, overflow, late, restarted_windows]
}

impl Growth {
    pub fn new() -> Self {
        Self { told: [0; 7], throttle: Throttle::new(PAUSE_NS) }
    }

    /// Looks at the counters; each field tells what has come to it since the last line.
    pub fn see(&mut self, health: &Health, now_ns: i64) {
        if counts(health) != self.told && self.throttle.pass(now_ns) {
            self.tell(health);
        }
    }

    /// Tells what has not been told.
    pub fn end(&mut self, health: &Health) {
        if counts(health) != self.told {
            self.tell(health);
        }
    }

    fn tell(&mut self, health: &Health) {
        let grown: [Option<u64>; 7] = std::array::from_fn(|i| {
            let grown = counts(health)[i].saturating_sub(self.told[i]);
            (grown > 0).then_some(grown)
        });
        self.told = counts(health);
        let [lost, missing, refused, suspect, overflow, late, restarted_windows] = grown;
        let time_s = health.header.time_ns as f64 * 1e-9;
        tracing::warn!(
            lost,
            missing,
            refused,
            suspect,
            overflow,
            late,
            restarted_windows,
            time_s,
            "data are missing, late or of no use"
        );
    }
}
