//! From the host's monotonic clock to UTC, and UTC in sentences.

use std::fmt;

const SECOND_NS: i64 = 1_000_000_000;

/// The mapping from the host's monotonic clock to UTC, brought up to date now and then.
///
/// UTC never runs backwards: when the clock behind it is set back, the mapping runs at half speed until it has met it again.
#[derive(Clone, Copy, Debug, Default)]
pub struct UtcMap {
    /// What to add to the monotonic clock, by the last measurement.
    target_ns: i64,
    /// What was added at `measured_ns`.
    from_ns: i64,
    measured_ns: Option<i64>,
}

impl UtcMap {
    /// Takes in a measurement: at `now_ns` of the monotonic clock UTC is `offset_ns` more.
    pub fn measure(&mut self, now_ns: i64, offset_ns: i64) {
        self.from_ns = if self.measured_ns.is_some() { self.offset_ns(now_ns).max(offset_ns) } else { offset_ns };
        (self.target_ns, self.measured_ns) = (offset_ns, Some(now_ns));
    }

    /// What to add to the monotonic clock at an instant of it.
    fn offset_ns(&self, instant_ns: i64) -> i64 {
        let since_ns = (instant_ns - self.measured_ns.unwrap_or(instant_ns)).max(0);
        self.target_ns.max(self.from_ns - since_ns / 2)
    }

    /// UTC at an instant of the monotonic clock, nanoseconds since 1970; `None` before the first measurement.
    pub fn utc_ns(&self, instant_ns: i64) -> Option<i64> {
        self.measured_ns.map(|_| instant_ns + self.offset_ns(instant_ns))
    }

    /// By how much the mapping still runs ahead of a clock that was set back, ns.
    pub fn ahead_ns(&self, now_ns: i64) -> i64 {
        self.offset_ns(now_ns) - self.target_ns
    }
}

/// The time of day as sentences have it, `hhmmss.sss`; what is beyond the millisecond is cut off, so that it never shows a later one.
pub fn time_of_day(utc_ns: i64) -> impl fmt::Display {
    struct Time(i64);
    impl fmt::Display for Time {
        fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            let (seconds, nanoseconds) = (self.0.div_euclid(SECOND_NS), self.0.rem_euclid(SECOND_NS));
            let of_day = seconds.rem_euclid(86_400);
            let (hour, minute, second) = (of_day / 3600, of_day / 60 % 60, of_day % 60);
            write!(f, "{hour:02}{minute:02}{second:02}.{:03}", nanoseconds / 1_000_000)
        }
    }
    Time(utc_ns)
}
