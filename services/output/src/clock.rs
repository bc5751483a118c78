use messages::{LineHealth, UtcSource, topic};
use pipeline::configuration::{Configuration, Port};
use runtime::{HostUtc, Node, Subscriber, TransportError, host_utc, monotonic_ns};
use telegrams::UtcMap;

/// What the INS told is of use for so long, ns: its clock and the host's part by less than a millisecond in that time.
const INS_NS: i64 = 5_000_000_000;

/// UTC: as the main unit's INS tells it, or else as the host has it.
pub struct Clock {
    ins: Option<Subscriber<LineHealth>>,
    told: Option<Told>,
    sources: Sources,
}

/// What the INS told last.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Told {
    offset_ns: i64,
    at_ns: i64,
}

/// Which source is in use, and the mapping that follows from it.
struct Sources {
    map: UtcMap,
    source: UtcSource,
    offset_ns: i64,
    error_ns: Option<i64>,
    /// When the source in use was read, or told.
    at_ns: i64,
}

impl Clock {
    /// Listens to the main unit's wire where there is one; kept bytes tell when they were kept.
    pub fn open(node: &Node, configuration: &Configuration) -> Result<Self, TransportError> {
        let wired = configuration.main.source.line().is_some_and(|line| !matches!(line.port, Port::File(_)));
        let ins = wired.then(|| Subscriber::open(node, &topic::line(None))).transpose()?;
        let mut clock = Self { ins, told: None, sources: Sources::new(monotonic_ns(), host_utc()) };
        clock.read()?;
        Ok(clock)
    }

    /// Reads the source anew.
    pub fn read(&mut self) -> Result<(), TransportError> {
        while let Some(line) = self.ins.as_ref().map_or(Ok(None), Subscriber::take)? {
            if line.utc_at_ns != 0 {
                self.told = Some(Told { offset_ns: line.utc_offset_ns, at_ns: line.utc_at_ns });
            }
        }
        let before = self.sources.source;
        self.sources.take(monotonic_ns(), host_utc(), self.told);
        if self.sources.source != before {
            let (from, to) = (before.name(), self.sources.source.name());
            let ahead_ms = self.ahead_ns(monotonic_ns()) as f64 * 1e-6;
            tracing::info!(from, to, ahead_ms, "UTC comes from another clock");
        }
        Ok(())
    }

    /// UTC at an instant of the monotonic clock, ns since 1970.
    pub fn utc_ns(&self, instant_ns: i64) -> i64 {
        self.sources.map.utc_ns(instant_ns).unwrap_or(instant_ns + self.sources.offset_ns)
    }

    /// Where it comes from.
    pub fn source(&self) -> UtcSource {
        self.sources.source
    }

    /// Age of what it comes from, ns.
    pub fn age_ns(&self, now_ns: i64) -> i64 {
        now_ns - self.sources.at_ns
    }

    /// How wrong the source says that it may be, ns.
    pub fn error_ns(&self) -> Option<i64> {
        self.sources.error_ns
    }

    /// By how much it runs ahead of its source, ns.
    pub fn ahead_ns(&self, now_ns: i64) -> i64 {
        self.sources.map.ahead_ns(now_ns)
    }
}

impl Sources {
    fn new(now_ns: i64, host: HostUtc) -> Self {
        let source = UtcSource::HostFree;
        Self { map: UtcMap::default(), source, offset_ns: host.offset_ns, error_ns: None, at_ns: now_ns }
    }

    fn take(&mut self, now_ns: i64, host: HostUtc, ins: Option<Told>) {
        match ins.filter(|told| now_ns - told.at_ns <= INS_NS) {
            Some(told) => {
                (self.source, self.error_ns) = (UtcSource::Ins, None);
                (self.offset_ns, self.at_ns) = (told.offset_ns, told.at_ns);
            }
            None => {
                self.source = if host.error_ns.is_some() { UtcSource::Host } else { UtcSource::HostFree };
                self.error_ns = host.error_ns;
                (self.offset_ns, self.at_ns) = (host.offset_ns, now_ns);
            }
        }
        self.map.measure(now_ns, self.offset_ns);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SECOND: i64 = 1_000_000_000;
    const HOST: HostUtc = HostUtc { offset_ns: 1_000 * SECOND, error_ns: Some(7) };

    #[test]
    fn the_ins_is_preferred_while_it_is_young_and_no_stamp_runs_back() {
        let mut sources = Sources::new(0, HOST);
        let mut last = i64::MIN;
        let mut seen = Vec::new();
        for tenth in 0..200 {
            let now_ns = tenth * SECOND / 10;
            if tenth % 10 == 0 {
                // from the third second on it tells UTC 30 ms before the host's, and from the eighth on no more
                let at_ns = (now_ns - SECOND / 2).min(8 * SECOND);
                let told = (tenth >= 30).then_some(Told { offset_ns: HOST.offset_ns - 30_000_000, at_ns });
                sources.take(now_ns, HOST, told);
                seen.push((sources.source, now_ns - sources.at_ns, sources.error_ns));
            }
            let utc_ns = sources.map.utc_ns(now_ns).unwrap_or_default();
            assert!(utc_ns > last, "{utc_ns} after {last}");
            last = utc_ns;
            let off_ms = (utc_ns - now_ns - HOST.offset_ns) / 1_000_000;
            // at half speed it has met the INS's after 60 ms
            if tenth != 30 {
                let behind = (31..140).contains(&tenth);
                assert_eq!(off_ms, if behind { -30 } else { 0 }, "{tenth}");
            }
        }
        assert!(seen[..3].iter().all(|(source, age, error)| (*source, *age, *error) == (UtcSource::Host, 0, Some(7))));
        assert!(seen[3..14].iter().all(|(source, _, error)| (*source, *error) == (UtcSource::Ins, None)));
        assert_eq!((seen[3].1, seen[13].1), (SECOND / 2, 5 * SECOND));
        assert!(seen[14..].iter().all(|(source, age, _)| (*source, *age) == (UtcSource::Host, 0)));
    }

    #[test]
    fn a_host_that_is_not_synchronised_is_named_so() {
        let mut sources = Sources::new(0, HOST);
        sources.take(SECOND, HostUtc { error_ns: None, ..HOST }, None);
        assert_eq!(sources.source, UtcSource::HostFree);
    }
}
