/// The host's monotonic clock, ns: the same in all processes of a host, of no meaning on another one.
pub fn monotonic_ns() -> i64 {
    let mut now = libc::timespec { tv_sec: 0, tv_nsec: 0 };
    // SAFETY: the pointer is valid; the call cannot fail for this clock.
    unsafe { libc::clock_gettime(libc::CLOCK_MONOTONIC, &mut now) };
    now.tv_sec * 1_000_000_000 + now.tv_nsec
}

/// Sleeps until the monotonic clock reads `deadline_ns`; at once if it is past. Gives `false` when a signal came before.
pub fn sleep_until(deadline_ns: i64) -> bool {
    let deadline_ns = deadline_ns.max(0);
    let deadline = libc::timespec { tv_sec: deadline_ns / 1_000_000_000, tv_nsec: deadline_ns % 1_000_000_000 };
    // SAFETY: the deadline lives through the call and its nanoseconds are in range; the remaining time is not asked for.
    unsafe { libc::clock_nanosleep(libc::CLOCK_MONOTONIC, libc::TIMER_ABSTIME, &deadline, std::ptr::null_mut()) == 0 }
}

/// The times at which the samples of a fixed rate are due.
///
/// Each is computed from the epoch, so nothing accumulates, neither rounding nor lateness.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pacer {
    /// When sample 0 is due, ns of the monotonic clock.
    pub epoch_ns: i64,
    /// Time between samples, ns; need not be a whole number.
    pub period_ns: f64,
}

impl Pacer {
    /// Sample 0 at `epoch_ns`, then `rate_hz` samples a second. The rate is greater than zero.
    pub fn new(epoch_ns: i64, rate_hz: f64) -> Self {
        Self { epoch_ns, period_ns: 1e9 / rate_hz }
    }

    /// When sample `k` is due, ns of the monotonic clock.
    pub fn due_ns(&self, k: u64) -> i64 {
        self.epoch_ns.saturating_add((k as f64 * self.period_ns).round() as i64)
    }

    /// The last sample that is due at `now_ns`; 0 before the epoch. Where a restarted source goes on.
    pub fn present(&self, now_ns: i64) -> u64 {
        let elapsed_ns = now_ns.saturating_sub(self.epoch_ns).max(0);
        let guess = (elapsed_ns as f64 / self.period_ns) as u64;
        // The guess may be off by rounding, by one at most.
        if self.due_ns(guess + 1) <= now_ns {
            guess + 1
        } else if guess > 0 && self.due_ns(guess) > now_ns {
            guess - 1
        } else {
            guess
        }
    }

    /// Sleeps until sample `k` is due. Gives `false` when a signal came before.
    pub fn wait(&self, k: u64) -> bool {
        sleep_until(self.due_ns(k))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn due_times_do_not_drift() {
        let week = 7 * 86_400;
        for rate in [1u64, 3, 100, 125, 200, 1000] {
            let pacer = Pacer::new(12_345, rate as f64);
            for second in [0, 1, 59, 3600, week] {
                let due = pacer.due_ns(second * rate);
                assert!((due - 12_345 - second as i64 * 1_000_000_000).abs() <= 1, "{rate} Hz after {second} s: {due}");
            }
        }
    }

    #[test]
    fn present_is_the_last_sample_due() {
        for rate in [3.0, 100.0, 128.0, 199.9] {
            let pacer = Pacer::new(1_000_000_007, rate);
            for k in (0..1000).chain(50_000_000..50_001_000) {
                assert_eq!(pacer.present(pacer.due_ns(k)), k, "{rate} Hz");
                assert_eq!(pacer.present(pacer.due_ns(k + 1) - 1), k, "{rate} Hz");
            }
            assert_eq!(pacer.present(0), 0);
            assert_eq!(pacer.present(i64::MIN), 0);
        }
    }

    #[test]
    fn sleeping_ends_after_the_deadline() {
        let pacer = Pacer::new(monotonic_ns(), 200.0);
        for k in [1, 2, 5] {
            assert!(pacer.wait(k));
            assert!(monotonic_ns() >= pacer.due_ns(k));
        }
        assert!(sleep_until(-5), "a deadline in the past is no reason to wait");
    }
}
