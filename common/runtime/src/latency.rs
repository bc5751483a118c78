use crate::TransportError;
use hdrhistogram::Histogram;
use hdrhistogram::serialization::V2DeflateSerializer;
use hdrhistogram::serialization::interval_log::{IntervalLogWriterBuilder, Tag};
use std::io::Write;
use std::time::{Duration, SystemTime};

/// 100 s: what takes longer is an outage, not a latency.
const LONGEST_NS: u64 = 100_000_000_000;
const SIGNIFICANT_DIGITS: u8 = 3;

/// A histogram of latencies from 1 ns to 100 s with three digits. Recording neither allocates nor fails.
#[derive(Clone, Debug)]
pub struct Latency {
    histogram: Histogram<u64>,
    out_of_range: u64,
}

/// The figures of a latency report, microseconds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Summary {
    /// Number of latencies.
    pub count: u64,
    /// Median.
    pub p50_us: f64,
    /// What one in 10 exceeds.
    pub p90_us: f64,
    /// What one in 100 exceeds.
    pub p99_us: f64,
    /// What one in 1000 exceeds.
    pub p999_us: f64,
    /// The greatest one.
    pub max_us: f64,
    /// Those of `count` that were negative or above 100 s and stand in the histogram as its end.
    pub out_of_range: u64,
}

impl Default for Latency {
    fn default() -> Self {
        Self::new()
    }
}

impl Latency {
    /// An empty histogram; the only allocation, of about 220 kB.
    pub fn new() -> Self {
        let histogram = Histogram::new_with_bounds(1, LONGEST_NS, SIGNIFICANT_DIGITS)
            .expect("the bounds are constants that the histogram accepts");
        Self { histogram, out_of_range: 0 }
    }

    /// Records one latency, ns. One out of range is counted and recorded as the nearest in range.
    pub fn record(&mut self, latency_ns: i64) {
        let latency = u64::try_from(latency_ns).unwrap_or(0);
        if latency_ns < 0 || latency > LONGEST_NS {
            self.out_of_range += 1;
        }
        self.histogram.saturating_record(latency.clamp(1, LONGEST_NS));
    }

    /// The figures of the report; zeros when nothing was recorded.
    pub fn summary(&self) -> Summary {
        let us = |quantile| self.histogram.value_at_quantile(quantile) as f64 / 1e3;
        Summary {
            count: self.histogram.len(),
            p50_us: us(0.5),
            p90_us: us(0.9),
            p99_us: us(0.99),
            p999_us: us(0.999),
            max_us: self.histogram.max() as f64 / 1e3,
            out_of_range: self.out_of_range,
        }
    }

    /// How many lie from each edge (ns, ascending) up to the next one; those before the first or from the last on stand in no place.
    pub fn counts(&self, edges_ns: &[u64]) -> Vec<u64> {
        let mut counts = vec![0; edges_ns.len().saturating_sub(1)];
        for recorded in self.histogram.iter_recorded() {
            let above = edges_ns.partition_point(|edge| *edge <= recorded.value_iterated_to());
            if let Some(count) = above.checked_sub(1).and_then(|place| counts.get_mut(place)) {
                *count += recorded.count_at_value();
            }
        }
        counts
    }

    /// Adds what another histogram holds.
    pub fn add(&mut self, other: &Self) {
        // Cannot fail: both have the same bounds.
        let _ = self.histogram.add(&other.histogram);
        self.out_of_range += other.out_of_range;
    }

    /// Empties the histogram without giving up its memory.
    pub fn clear(&mut self) {
        self.histogram.reset();
        self.out_of_range = 0;
    }
}

/// A `.hlog` file: one line a histogram and interval, in the format that the tools of HdrHistogram read.
pub struct IntervalLog<W: Write> {
    writer: W,
    serializer: V2DeflateSerializer,
}

impl<W: Write> IntervalLog<W> {
    /// Begins a log; the times of its intervals count from `start`. `comment` becomes its first line.
    ///
    /// # Errors
    /// If nothing can be written.
    pub fn begin(mut writer: W, start: SystemTime, comment: &str) -> Result<Self, TransportError> {
        let mut serializer = V2DeflateSerializer::new();
        IntervalLogWriterBuilder::new()
            .add_comment(comment)
            .with_start_time(start)
            .with_base_time(start)
            .begin_log_with(&mut writer, &mut serializer)
            .map_err(|error| TransportError::Log(error.to_string()))?;
        Ok(Self { writer, serializer })
    }

    /// Writes what was recorded from `since` to `since + duration` after the start. The tag tells one latency of a log from another;
    /// it holds no comma, blank or line break.
    ///
    /// # Errors
    /// If nothing can be written, or the tag is not allowed.
    pub fn write(
        &mut self,
        tag: &str,
        since: Duration,
        duration: Duration,
        latency: &Latency,
    ) -> Result<(), TransportError> {
        let tag = Tag::new(tag).ok_or_else(|| TransportError::Log(format!("the tag \"{tag}\" is not allowed")))?;
        // A builder without comment and times writes no header of its own.
        let mut log = IntervalLogWriterBuilder::new()
            .begin_log_with(&mut self.writer, &mut self.serializer)
            .map_err(|error| TransportError::Log(error.to_string()))?;
        log.write_histogram(&latency.histogram, since, duration, Some(tag))
            .map_err(|error| TransportError::Log(format!("{error:?}")))
    }

    /// Ends the log and gives the writer back.
    ///
    /// # Errors
    /// If what is buffered cannot be written.
    pub fn finish(mut self) -> Result<W, TransportError> {
        self.writer.flush().map_err(|error| TransportError::Log(error.to_string()))?;
        Ok(self.writer)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hdrhistogram::serialization::Deserializer;
    use hdrhistogram::serialization::interval_log::{IntervalLogIterator, LogEntry};

    fn base64(text: &str) -> Vec<u8> {
        let value = |c: u8| match c {
            b'A'..=b'Z' => c - b'A',
            b'a'..=b'z' => c - b'a' + 26,
            b'0'..=b'9' => c - b'0' + 52,
            b'+' => 62,
            b'/' => 63,
            other => panic!("{other} is not base64"),
        };
        let (mut bytes, mut bits, mut held) = (Vec::new(), 0u32, 0);
        for c in text.bytes().filter(|&c| c != b'=') {
            bits = bits << 6 | u32::from(value(c));
            held += 6;
            if held >= 8 {
                held -= 8;
                bytes.push((bits >> held) as u8);
            }
        }
        bytes
    }

    fn close(value: f64, expected: f64) -> bool {
        (value / expected - 1.0).abs() < 2e-3
    }

    #[test]
    fn the_summary_has_the_right_quantiles() {
        let mut latency = Latency::new();
        for k in 1..=10_000 {
            latency.record(k * 1000);
        }
        let summary = latency.summary();
        assert_eq!((summary.count, summary.out_of_range), (10_000, 0));
        for (value, expected) in [
            (summary.p50_us, 5000.0),
            (summary.p90_us, 9000.0),
            (summary.p99_us, 9900.0),
            (summary.p999_us, 9990.0),
            (summary.max_us, 10_000.0),
        ] {
            assert!(close(value, expected), "{value} instead of {expected}");
        }
        latency.clear();
        assert_eq!(latency.summary(), Summary::default());
    }

    #[test]
    fn what_is_out_of_range_is_counted_and_kept_at_the_end() {
        let mut latency = Latency::new();
        for ns in [-1, i64::MIN, 0, 1, 100_000_000_000, 100_000_000_001, i64::MAX] {
            latency.record(ns);
        }
        let summary = latency.summary();
        assert_eq!((summary.count, summary.out_of_range), (7, 4));
        assert!(close(summary.max_us, 1e8), "{}", summary.max_us);
    }

    #[test]
    fn sums_hold_both() {
        let (mut a, mut b) = (Latency::new(), Latency::new());
        a.record(1_000_000);
        b.record(3_000_000);
        b.record(-1);
        a.add(&b);
        assert_eq!((a.summary().count, a.summary().out_of_range), (3, 1));
        assert!(close(a.summary().max_us, 3000.0));
    }

    #[test]
    fn latencies_are_counted_between_edges() {
        let mut latency = Latency::new();
        [500, 1_500, 1_600, 2_500, 9_000].into_iter().for_each(|ns| latency.record(ns));
        assert_eq!(latency.counts(&[1_000, 2_000, 3_000, 4_000]), [2, 1, 0]);
        assert_eq!(latency.counts(&[]), []);
    }

    #[test]
    fn the_log_is_read_by_its_own_reader() {
        let start = SystemTime::UNIX_EPOCH + Duration::from_secs(1_700_000_000);
        let mut log = IntervalLog::begin(Vec::new(), start, "source to solution, ns").expect("memory takes all");
        let mut latency = Latency::new();
        for second in 0..3 {
            latency.clear();
            (0..=second).for_each(|k| latency.record(1000 * (k + 1)));
            let since = Duration::from_secs(second as u64);
            log.write("chain", since, Duration::from_secs(1), &latency).expect("memory takes all");
        }
        assert!(log.write("with blank", Duration::ZERO, Duration::ZERO, &latency).is_err());
        let bytes = log.finish().expect("memory takes all");
        let entries: Vec<LogEntry> =
            IntervalLogIterator::new(&bytes).map(|entry| entry.expect("it is a log")).collect();
        assert!(matches!(entries[0], LogEntry::StartTime(time) if time == Duration::from_secs(1_700_000_000)));
        assert!(matches!(entries[1], LogEntry::BaseTime(_)));
        let mut counts = Vec::new();
        for entry in &entries[2..] {
            let LogEntry::Interval(interval) = entry else { panic!("{entry:?} is no interval") };
            assert_eq!(interval.tag().expect("all have one").as_str(), "chain");
            assert_eq!(interval.start_timestamp(), Duration::from_secs(counts.len() as u64));
            let encoded = base64(interval.encoded_histogram());
            let histogram: Histogram<u64> =
                Deserializer::new().deserialize(&mut encoded.as_slice()).expect("a histogram");
            assert!(close(histogram.max() as f64, 1000.0 * (counts.len() + 1) as f64));
            counts.push(histogram.len());
        }
        assert_eq!(counts, [1, 2, 3]);
    }
}
