//! What became of the telegrams of each destination.

use messages::{OutputState, UtcSource};
use pipeline::configuration::Configuration;
use serde::Serialize;
use std::fmt;

/// Counts of one destination.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Telegrams {
    /// Telegrams that went out.
    pub sent: u64,
    /// Of these, those that said that the attitude is invalid.
    pub invalid: u64,
    /// Of these, those whose attitude was carried forward.
    pub extrapolated: u64,
    /// Telegrams that a full or broken line did not take.
    pub unsendable: u64,
    /// Telegrams that were too old or not later than the one before.
    pub withheld: u64,
    /// Of those that went out, those whose area has a zero in force.
    pub zeroed: u64,
}

impl Telegrams {
    fn of(state: &OutputState) -> Self {
        let OutputState { sent, invalid, extrapolated, unsendable, withheld, zeroed, .. } = *state;
        Self { sent, invalid, extrapolated, unsendable, withheld, zeroed }
    }

    fn add(&mut self, other: Self) {
        self.sent += other.sent;
        self.invalid += other.invalid;
        self.extrapolated += other.extrapolated;
        self.unsendable += other.unsendable;
        self.withheld += other.withheld;
        self.zeroed += other.zeroed;
    }

    fn all(&self) -> u64 {
        self.sent + self.unsendable + self.withheld
    }
}

/// One destination of telegrams.
#[derive(Clone, Debug, Serialize)]
pub struct OutputRow {
    /// The destination in words.
    pub to: String,
    /// Name of its area.
    pub area: String,
    /// The counts of all processes that served it.
    #[serde(flatten)]
    pub telegrams: Telegrams,
    /// Whether it took telegrams at the end.
    pub open: bool,
    /// From the published solution to the telegram's departure: median, microseconds.
    pub p50_us: f64,
    /// What one in 100 exceeds.
    pub p99_us: f64,
    /// The longest.
    pub max_us: f64,
    /// Where UTC came from.
    pub utc: &'static str,
    /// How old the reading of its clock was, ms.
    pub utc_age_ms: f64,
    /// How wrong it says that it may be, ms; `None` where it does not say.
    pub utc_error_ms: Option<f64>,
}

impl fmt::Display for OutputRow {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Telegrams { sent, invalid, extrapolated, unsendable, withheld, zeroed } = self.telegrams;
        write!(f, "output to {}, area {}: {sent} telegrams, {invalid} of them invalid", self.to, self.area)?;
        write!(f, ", {extrapolated} carried forward")?;
        if zeroed > 0 {
            write!(f, ", {zeroed} told from a zero")?;
        }
        write!(f, "; {unsendable} unsendable, {withheld} withheld")?;
        write!(f, "; after {:.0} us (p99 {:.0}, max {:.0})", self.p50_us, self.p99_us, self.max_us)?;
        write!(f, "; UTC: {}, {:.1} s old", self.utc, self.utc_age_ms / 1e3)?;
        self.utc_error_ms.map_or(Ok(()), |ms| write!(f, " within {ms:.1} ms"))
    }
}

/// What is known of one destination, kept over restarts.
pub struct OutputRecord {
    to: String,
    area: String,
    past: Telegrams,
    now: OutputState,
}

impl OutputRecord {
    /// The destinations of a configuration, of which nothing is known.
    pub fn all(configuration: &Configuration) -> Vec<Self> {
        let new = |output: &pipeline::configuration::Output| Self {
            to: output.to.to_string(),
            area: output.area.clone(),
            past: Telegrams::default(),
            now: OutputState::default(),
        };
        configuration.outputs.iter().map(new).collect()
    }

    /// Takes in a state; counts that have become smaller are those of a new process.
    pub fn update(&mut self, state: OutputState) {
        if Telegrams::of(&state).all() < Telegrams::of(&self.now).all() {
            self.past.add(Telegrams::of(&self.now));
        }
        self.now = state;
    }

    /// The row of the report.
    pub fn row(&self) -> OutputRow {
        let us = |ns: i64| ns as f64 / 1e3;
        let mut telegrams = self.past;
        telegrams.add(Telegrams::of(&self.now));
        OutputRow {
            to: self.to.clone(),
            area: self.area.clone(),
            telegrams,
            open: self.now.open != 0,
            p50_us: us(self.now.delay_p50_ns),
            p99_us: us(self.now.delay_p99_ns),
            max_us: us(self.now.delay_max_ns),
            utc: UtcSource::from_code(self.now.utc_source).map_or("unknown", UtcSource::name),
            utc_age_ms: self.now.utc_age_ns as f64 / 1e6,
            utc_error_ms: (self.now.utc_error_ns >= 0).then_some(self.now.utc_error_ns as f64 / 1e6),
        }
    }
}
