//! The health of all stages as a text file for the node exporter of Prometheus.
//!
//! It is the launcher that writes it: it hears every stage, outlives them all and knows who was restarted; `output` exists only where
//! telegrams are sent.

use crate::collector::Collector;
use crate::set::{Role, Set};
use crate::{LaunchError, OutputRow};
use frames::unit::seconds;
use messages::{Alarms, Health, Solution, Stage, State};
use std::fmt::Write;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

const PERIOD_NS: i64 = 5_000_000_000;

/// The file, written anew now and then.
pub struct Textfile {
    path: Option<PathBuf>,
    due_ns: i64,
    failures: u64,
    /// Whether the last writing failed.
    failed: bool,
}

/// A counter of all stages: its name, what it counts, and where it stands.
type Counter = (&'static str, &'static str, fn(&Health) -> u64);

const COUNTERS: [Counter; 9] = [
    ("taken", "Messages taken in", |health| health.taken),
    ("given", "Messages or telegrams given out", |health| health.given),
    ("lost", "Messages that never arrived", |health| health.lost),
    ("missing", "Samples missing in a unit's own stream", |health| health.missing),
    ("refused", "Samples or telegrams refused", |health| health.refused),
    ("suspect", "Samples at the end of the range or with stuck channels", |health| health.suspect),
    ("overflow", "Messages dropped inside a stage or by a full line", |health| health.overflow),
    ("late", "Parameter sets that came late", |health| health.late),
    ("restarted_windows", "Windows started anew by a gap", |health| health.restarted_windows),
];

impl Textfile {
    /// The first writing tells whether the place is good.
    pub fn create(path: Option<PathBuf>) -> Result<Self, LaunchError> {
        if let Some(path) = &path {
            replace(path, "").map_err(LaunchError::output(path))?;
        }
        Ok(Self { path, due_ns: 0, failures: 0, failed: false })
    }

    /// Writes the present state, every five seconds. A disk that is full later is no reason to stop: it is counted in the next file.
    pub fn show(&mut self, now_ns: i64, collector: &Collector, set: &Set) {
        let Some(path) = self.path.as_deref().filter(|_| now_ns >= self.due_ns) else { return };
        self.due_ns = now_ns + PERIOD_NS;
        let mut page = Page::default();
        page.value("up", "Whether the launch runs", "gauge", "", 1.0);
        page.value("textfile_failures_total", "Files that could not be written", "counter", "", self.failures as f64);
        stages(&mut page, collector, set);
        areas(&mut page, collector, now_ns);
        outputs(&mut page, collector);
        let written = replace(path, &page.text);
        let (failed, path) = (written.is_err(), path.display());
        self.failures += u64::from(failed);
        match written {
            Ok(()) if self.failed => tracing::info!(%path, failures = self.failures, "the text file is written again"),
            Err(reason) if !self.failed => tracing::warn!(%path, %reason, "the text file cannot be written"),
            _ => {}
        }
        self.failed = failed;
    }

    /// Says that the launch has ended.
    pub fn end(&self) -> Result<(), LaunchError> {
        let Some(path) = &self.path else { return Ok(()) };
        let mut page = Page::default();
        page.value("up", "Whether the launch runs", "gauge", "", 0.0);
        replace(path, &page.text).map_err(LaunchError::output(path))
    }
}

fn stages(page: &mut Page, collector: &Collector, set: &Set) {
    let labels = |role: &Role| {
        let area = role.area.map_or("", |area| collector.area_name(area));
        format!("stage=\"{}\",area=\"{area}\"", role.stage.name())
    };
    for (name, help, count) in COUNTERS {
        let name = format!("stage_{name}_total");
        for (role, health) in collector.healths() {
            page.value(&name, help, "counter", &labels(role), count(health) as f64);
        }
    }
    for (role, restarts) in set.restarts() {
        page.value("stage_restarts_total", "Starts after a death", "counter", &labels(&role), restarts as f64);
    }
    for (role, health) in collector.healths() {
        let running = health.state == State::Running as u32;
        page.value("stage_running", "Whether the stage handles data", "gauge", &labels(role), truth(running));
    }
    for (role, health) in collector.healths().filter(|(role, _)| role.stage == Stage::Estimate) {
        let area = role.area.map_or("", |area| collector.area_name(area));
        for (name, alarm) in Alarms::all().iter_names() {
            let labels = format!("area=\"{area}\",alarm=\"{}\"", name.to_lowercase());
            let raised = truth(health.alarms.contains(alarm));
            page.value("alarm", "Whether a limit has been crossed for too long", "gauge", &labels, raised);
        }
    }
}

/// The last solution of each area.
fn areas(page: &mut Page, collector: &Collector, now_ns: i64) {
    let known = || collector.latest().filter_map(|(area, last)| Some((area, last?)));
    for (area, last) in known() {
        let age_s = seconds(now_ns - last.header.stamps.solution_ns);
        page.value("solution_age_seconds", "Age of the last solution", "gauge", &format!("area=\"{area}\""), age_s);
    }
    for (area, last) in known() {
        let valid = truth(last.is_valid());
        page.value("solution_valid", "Whether the last solution is valid", "gauge", &format!("area=\"{area}\""), valid);
    }
    let mut of_axes = |name: &str, help: &str, of: fn(&Solution) -> [f64; 3]| {
        for (area, last) in known() {
            for (axis, value) in ["x", "y", "z"].into_iter().zip(of(last)) {
                page.value(name, help, "gauge", &format!("area=\"{area}\",axis=\"{axis}\""), value);
            }
        }
    };
    of_axes("deformation_radians", "Deformation", |last| last.phi);
    of_axes("range_radians", "Half width of the 95 % range of the deformation", |last| last.range);
    of_axes("zero_radians", "Zero from which the deformation is told", |last| last.zero);
}

fn outputs(page: &mut Page, collector: &Collector) {
    let rows: Vec<OutputRow> = collector.outputs().collect();
    let labels = |row: &OutputRow| format!("to=\"{}\",area=\"{}\"", escaped(&row.to), row.area);
    let mut all = |name: &str, help: &str, kind: &str, of: fn(&OutputRow) -> f64| {
        rows.iter().for_each(|row| page.value(name, help, kind, &labels(row), of(row)));
    };
    all("output_sent_total", "Telegrams that went out", "counter", |row| row.telegrams.sent as f64);
    all("output_invalid_total", "Telegrams that said invalid", "counter", |row| row.telegrams.invalid as f64);
    all("output_zeroed_total", "Telegrams told from a zero", "counter", |row| row.telegrams.zeroed as f64);
    all("output_unsendable_total", "Telegrams not taken by the line", "counter", |row| row.telegrams.unsendable as f64);
    all("output_withheld_total", "Telegrams too old or not later", "counter", |row| row.telegrams.withheld as f64);
    all("output_open", "Whether the line takes telegrams", "gauge", |row| truth(row.open));
    all("output_utc_age_seconds", "Age of the reading of UTC", "gauge", |row| row.utc_age_ms / 1e3);
    all("output_utc_synchronised", "Whether UTC is synchronised", "gauge", |row| truth(row.utc_error_ms.is_some()));
}

fn truth(is_so: bool) -> f64 {
    f64::from(u8::from(is_so))
}

fn escaped(text: &str) -> String {
    text.replace('\\', "\\\\").replace('"', "\\\"")
}

/// The text of the file: the values of a metric stand together under one heading.
#[derive(Default)]
struct Page {
    text: String,
    metric: String,
}

impl Page {
    fn value(&mut self, name: &str, help: &str, kind: &str, labels: &str, value: f64) {
        // writing to a text cannot fail
        if self.metric != name {
            self.metric = name.to_owned();
            let _ = writeln!(self.text, "# HELP deckflex_{name} {help}\n# TYPE deckflex_{name} {kind}");
        }
        let braces = if labels.is_empty() { String::new() } else { format!("{{{labels}}}") };
        let _ = writeln!(self.text, "deckflex_{name}{braces} {value}");
    }
}

/// Puts a new file in the place of the old one at once, so that nobody reads half of it.
fn replace(path: &Path, text: &str) -> io::Result<()> {
    let mut beside = path.as_os_str().to_owned();
    // the exporter passes over names with another ending
    beside.push(".new");
    fs::write(&beside, text)?;
    fs::rename(&beside, path)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn the_values_of_a_metric_stand_under_one_heading() {
        let mut page = Page::default();
        page.value("a_total", "How many", "counter", "x=\"1\"", 2.0);
        page.value("a_total", "How many", "counter", "x=\"2\"", 3.5);
        page.value("b", "How much", "gauge", "", -1e-7);
        let text = "# HELP deckflex_a_total How many\n# TYPE deckflex_a_total counter\ndeckflex_a_total{x=\"1\"} 2\n\
                    deckflex_a_total{x=\"2\"} 3.5\n# HELP deckflex_b How much\n# TYPE deckflex_b gauge\ndeckflex_b -0.0000001\n";
        assert_eq!(page.text, text);
        assert_eq!(escaped("a\"b\\c"), "a\\\"b\\\\c");
    }

    #[test]
    fn a_file_is_replaced_at_once_or_not_at_all() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("deckflex.prom");
        let textfile = Textfile::create(Some(path.clone())).unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "");
        textfile.end().unwrap();
        assert!(fs::read_to_string(&path).unwrap().ends_with("deckflex_up 0\n"));
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "nothing is left beside it");
        let Err(error) = Textfile::create(Some(folder.path().join("nowhere/deckflex.prom"))) else { panic!("a fault") };
        assert!(error.to_string().contains("nowhere/deckflex.prom"), "{error}");
    }
}
