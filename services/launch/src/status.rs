//! One live line on a terminal.

use crate::collector::Collector;
use crate::set::Set;
use frames::unit;
use indicatif::{ProgressBar, ProgressStyle};
use messages::Solution;
use pipeline::configuration::Configuration;
use std::fmt::Write;

const PERIOD_NS: i64 = 500_000_000;

/// The line; nothing where the error output is not a terminal.
pub struct Status {
    line: ProgressBar,
    duration: String,
    shown_ns: i64,
}

impl Status {
    /// A line that shows nothing yet.
    pub fn new(configuration: &Configuration) -> Self {
        let line = ProgressBar::new_spinner();
        if let Ok(style) = ProgressStyle::with_template("{msg}") {
            line.set_style(style);
        }
        let duration = configuration.run.duration_s.map_or(String::new(), |s| format!(" of {s:.0} s"));
        Self { line, duration, shown_ns: 0 }
    }

    /// Brings the line up to date, twice a second.
    pub fn show(&mut self, now_ns: i64, collector: &Collector, set: &Set) {
        if now_ns - self.shown_ns < PERIOD_NS || self.line.is_hidden() {
            return;
        }
        self.shown_ns = now_ns;
        if !set.has_source() {
            self.line.set_message(format!("starting {} processes", set.processes().count()));
            return;
        }
        let mut text = String::new();
        for (name, last) in collector.latest() {
            let Some(last) = last else { continue };
            if text.is_empty() {
                let _ = write!(text, "{:.0} s{}", unit::seconds(last.header.time_ns), self.duration);
            }
            let _ = write!(text, " | {name} {}", deformation(last));
        }
        for words in collector.quiet(now_ns) {
            let _ = write!(text, " | {words}");
        }
        let restarts: u64 = set.restarts().iter().map(|(_, n)| n).sum();
        let _ = write!(text, " | {:.0} us end to end", collector.median_us());
        if restarts > 0 {
            let _ = write!(text, " | {restarts} restarts");
        }
        self.line.set_message(text);
    }
}

impl Drop for Status {
    fn drop(&mut self) {
        self.line.finish_and_clear();
    }
}

/// The deformation with its range, arcmin, or why there is none.
fn deformation(solution: &Solution) -> String {
    if !solution.is_valid() {
        return format!("invalid ({})", solution.flags.names());
    }
    let [x, y, z] = solution.phi.map(|v| v / unit::ARCMIN);
    let widest = solution.range.iter().fold(0.0, |a: f64, b| a.max(*b)) / unit::ARCMIN;
    format!("{x:+.2} {y:+.2} {z:+.2} +-{widest:.2} arcmin")
}
