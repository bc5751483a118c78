use frames::unit::seconds;
use messages::LineHealth;
use runtime::{Growth, monotonic_ns};

/// A unit that has said nothing for so long is silent, ns.
const QUIET_NS: i64 = 2_000_000_000;

/// What the log hears of a unit's wire and clock, by its health once a second.
#[derive(Default)]
pub struct Events {
    silent: bool,
    growth: Growth<7>,
    skipped_told: u64,
}

impl Events {
    /// Compares two healths in a row.
    pub fn see(&mut self, unit: &str, port: &str, before: &LineHealth, now: &LineHealth) {
        let now_ns = monotonic_ns();
        if now.opened > before.opened {
            tracing::info!(unit, port, times = now.opened, "the port is open");
        }
        self.silence(unit, port, now, now_ns);
        if now.settled != before.settled {
            let (skew_ppm, jitter_us) = (now.skew * 1e6, now.jitter * 1e6);
            match now.settled {
                0 => tracing::warn!(unit, port, "the device's clock has to be found anew"),
                _ => tracing::info!(unit, port, skew_ppm, jitter_us, "the device's clock is known"),
            }
        }
        if now.restarts > before.restarts {
            tracing::warn!(unit, port, restarts = now.restarts, "the device's clock has started anew");
        }
        if let Some(grown) = self.growth.take(losses(now), now_ns) {
            self.tell_losses(unit, port, grown, now.skipped);
        }
    }

    fn silence(&mut self, unit: &str, port: &str, now: &LineHealth, now_ns: i64) {
        if now.arrival_ns == 0 {
            return;
        }
        let silent_ns = now_ns - now.arrival_ns;
        let silent = silent_ns > QUIET_NS;
        if silent != self.silent {
            self.silent = silent;
            match silent {
                true => tracing::warn!(unit, port, silent_s = seconds(silent_ns), "nothing comes on the wire any more"),
                false => tracing::info!(unit, port, "the wire speaks again"),
            }
        }
    }

    /// What has come to each counter since the last line.
    fn tell_losses(&mut self, unit: &str, port: &str, grown: [Option<u64>; 7], skipped: u64) {
        let [damaged, lost, gaps, disordered, invalid, overflow, unkept] = grown;
        let skipped_bytes = skipped - std::mem::replace(&mut self.skipped_told, skipped);
        tracing::warn!(
            unit,
            port,
            damaged,
            lost,
            gaps,
            disordered,
            invalid,
            overflow,
            unkept,
            skipped_bytes,
            "frames are damaged or missing"
        );
    }
}

/// Bytes that belong to no frame are told with these, since a stream that is joined in the middle begins with some.
fn losses(health: &LineHealth) -> [u64; 7] {
    let LineHealth { damaged, lost, gaps, disordered, invalid, overflow, unkept, .. } = *health;
    [damaged, lost, gaps, disordered, invalid, overflow, unkept]
}
