use crate::monotonic_ns;

/// What the host's clock says about UTC.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HostUtc {
    /// UTC since 1970 minus the monotonic clock, ns.
    pub offset_ns: i64,
    /// How wrong it may be, ns, while the operating system holds the clock for synchronised; `None` when it does not.
    pub error_ns: Option<i64>,
}

/// Of so many readings the one that the scheduler disturbed least is taken.
const READINGS: usize = 5;

/// Reads the host's clock beside the monotonic one.
pub fn host_utc() -> HostUtc {
    let readings = [(); READINGS].map(|()| {
        let before_ns = monotonic_ns();
        let utc_ns = realtime_ns();
        let after_ns = monotonic_ns();
        (after_ns - before_ns, utc_ns - before_ns - (after_ns - before_ns) / 2)
    });
    let offset_ns = readings.into_iter().min().map_or(0, |(_, offset_ns)| offset_ns);
    HostUtc { offset_ns, error_ns: synchronised_within_ns() }
}

fn realtime_ns() -> i64 {
    let mut now = libc::timespec { tv_sec: 0, tv_nsec: 0 };
    // SAFETY: the pointer is valid; the call cannot fail for this clock.
    unsafe { libc::clock_gettime(libc::CLOCK_REALTIME, &mut now) };
    now.tv_sec * 1_000_000_000 + now.tv_nsec
}

fn synchronised_within_ns() -> Option<i64> {
    // SAFETY: all zeros is a value of the plain structure, and its mode asks to read only; the pointer is valid.
    let (state, clock) = unsafe {
        let mut clock: libc::timex = std::mem::zeroed();
        (libc::adjtimex(&mut clock), clock)
    };
    let synchronised = state >= 0 && state != libc::TIME_ERROR && clock.status & libc::STA_UNSYNC == 0;
    synchronised.then(|| clock.maxerror.saturating_mul(1000))
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use std::time::{SystemTime, UNIX_EPOCH};

    #[test]
    fn the_offset_leads_to_the_systems_time() {
        let utc = host_utc();
        let ours = monotonic_ns() + utc.offset_ns;
        let theirs = SystemTime::now().duration_since(UNIX_EPOCH).unwrap().as_nanos() as i64;
        // the scheduler may come between the two
        assert!((0..1_000_000_000).contains(&(theirs - ours)), "{}", theirs - ours);
        assert!(utc.error_ns.is_none_or(|error_ns| error_ns >= 0));
    }
}
