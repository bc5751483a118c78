//! The table at the end of a launch, and the same as JSON.

use crate::OutputRow;
use crate::line_row::LineRow;
use runtime::{Latency, Summary};
use serde::Serialize;
use std::fmt;

/// What a launch measured.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// Solutions of the area that has the fewest; there is one a pair.
    pub pairs: u64,
    /// Parameter sets of all areas.
    pub parameters: u64,
    /// Those that came after the time from which they were to be in force.
    pub late_parameters: u64,
    /// The scheduling class that all fast stages really obtained.
    pub scheduling: &'static str,
    /// Samples a second.
    pub rate_hz: f64,
    /// Samples that were missing in the units' own streams.
    pub missing_samples: u64,
    /// Samples and rows that were refused: not finite, repeated, out of time, unreadable.
    pub refused_samples: u64,
    /// Whether the streams had to be given up before their end marks.
    pub cut_short: bool,
    /// One row a stage and area.
    pub stages: Vec<StageRow>,
    /// One row an area: from the sample's due time to the published solution.
    pub end_to_end: Vec<AreaRow>,
    /// One row a unit on a wire.
    pub lines: Vec<LineRow>,
    /// One row a destination of telegrams.
    pub outputs: Vec<OutputRow>,
}

/// A latency in figures, microseconds.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Percentiles {
    /// Median.
    pub p50_us: f64,
    /// What one in 10 exceeds.
    pub p90_us: f64,
    /// What one in 100 exceeds.
    pub p99_us: f64,
    /// What one in 1000 exceeds.
    pub p999_us: f64,
    /// The largest.
    pub max_us: f64,
    /// Median of the time that the algorithm has to wait for later samples.
    pub wait_us: f64,
}

impl Percentiles {
    /// The figures of a histogram beside the algorithm's wait.
    pub fn of(latency: &Latency, wait_us: f64) -> Self {
        let Summary { p50_us, p90_us, p99_us, p999_us, max_us, .. } = latency.summary();
        Self { p50_us, p90_us, p99_us, p999_us, max_us, wait_us }
    }
}

impl fmt::Display for Percentiles {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let columns = [self.wait_us, self.p50_us, self.p90_us, self.p99_us, self.p999_us, self.max_us];
        columns.iter().try_for_each(|us| write!(f, " {us:>9.0}"))
    }
}

/// Counts and latency of a stage: from the moment its last input was published to its own output.
#[derive(Clone, Debug, Serialize)]
pub struct StageRow {
    /// Name of the stage.
    pub name: &'static str,
    /// Name of the area, empty for a source.
    pub area: String,
    /// Messages taken in.
    #[serde(rename = "in")]
    pub taken: u64,
    /// Messages given out.
    #[serde(rename = "out")]
    pub given: u64,
    /// Messages lost before the stage.
    pub lost: u64,
    /// How often it was started again.
    pub restarts: u64,
    /// Messages dropped inside the stage.
    pub overflow: u64,
    /// Its latency.
    #[serde(flatten)]
    pub latency: Percentiles,
}

/// The whole way of one area.
#[derive(Clone, Debug, Serialize)]
pub struct AreaRow {
    /// Name of the area.
    pub area: String,
    /// Solutions received.
    pub pairs: u64,
    /// Solutions missing in their sequence.
    pub lost: u64,
    /// Parameter sets received.
    pub parameters: u64,
    /// Solutions that say that their parameters came late.
    pub late_parameters: u64,
    /// Data time of the first parameter set after the first solution, s.
    pub first_parameters_s: Option<f64>,
    /// Rotation vector of the zero that the solutions are told from.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub zero_deg: Option<[f64; 3]>,
    /// Its latency.
    #[serde(flatten)]
    pub latency: Percentiles,
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "{:<12} {:<12} {:>8} {:>8} {:>5} {:>8} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9}",
            "stage",
            "area",
            "in",
            "out",
            "lost",
            "restarts",
            "wait us",
            "p50 us",
            "p90 us",
            "p99 us",
            "p99.9 us",
            "max us"
        )?;
        for row in &self.stages {
            let StageRow { name, area, taken, given, lost, restarts, latency, .. } = row;
            writeln!(f, "{name:<12} {area:<12} {taken:>8} {given:>8} {lost:>5} {restarts:>8}{latency}")?;
        }
        for row in &self.end_to_end {
            let AreaRow { area, pairs, lost, latency, .. } = row;
            writeln!(f, "{:<12} {area:<12} {pairs:>8} {pairs:>8} {lost:>5} {:>8}{latency}", "end to end", "")?;
        }
        for row in &self.end_to_end {
            let first = row.first_parameters_s.map_or("none".to_owned(), |s| format!("first after {s:.1} s of data"));
            writeln!(
                f,
                "area {}: {} parameter sets ({first}), {} late",
                row.area, row.parameters, row.late_parameters
            )?;
            if let Some([x, y, z]) = row.zero_deg {
                writeln!(f, "area {}: told from a zero of {x:.4}, {y:.4}, {z:.4} degrees", row.area)?;
            }
        }
        self.outputs.iter().try_for_each(|row| writeln!(f, "{row}"))?;
        writeln!(
            f,
            "scheduling obtained: {}; samples missing in the units' own streams: {}, refused: {}",
            self.scheduling, self.missing_samples, self.refused_samples
        )?;
        self.lines.iter().try_for_each(|line| writeln!(f, "{line}"))?;
        for row in self.stages.iter().filter(|row| row.overflow > 0) {
            writeln!(f, "{} {} dropped {} messages that it could not work off", row.name, row.area, row.overflow)?;
        }
        if self.cut_short {
            writeln!(f, "the streams did not end in time and were cut short")?;
        }
        Ok(())
    }
}
