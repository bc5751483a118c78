//! How the units' wires do, where the units are on wires.

use crate::line_row::LineRow;
use messages::{LineHealth, topic};
use pipeline::configuration::Configuration;
use runtime::{Node, Subscriber, TransportError};

/// A unit that has said nothing for so long is named on the live line, ns.
const QUIET_NS: i64 = 2_000_000_000;

/// What each unit's wire said last.
pub struct Lines {
    lines: Vec<Line>,
}

struct Line {
    name: String,
    port: Option<Subscriber<LineHealth>>,
    last: Option<LineHealth>,
}

impl Lines {
    /// One a unit; none where the units are not on wires.
    pub fn new(configuration: &Configuration) -> Self {
        let areas = configuration.areas.iter().map(|area| area.name.as_str());
        let names = std::iter::once("main").chain(areas).filter(|_| configuration.main.source.line().is_some());
        Self { lines: names.map(|name| Line { name: name.to_owned(), port: None, last: None }).collect() }
    }

    /// Opens the readers in a domain.
    pub fn connect(&mut self, node: &Node) -> Result<(), TransportError> {
        for (index, line) in self.lines.iter_mut().enumerate() {
            let area = (index > 0).then_some(line.name.as_str());
            line.port = Some(Subscriber::open(node, &topic::line(area))?);
        }
        Ok(())
    }

    /// Takes in everything that has come.
    pub fn drain(&mut self) -> Result<(), TransportError> {
        for line in &mut self.lines {
            while let Some(health) = line.port.as_ref().map_or(Ok(None), Subscriber::take)? {
                line.last = Some(health);
            }
        }
        Ok(())
    }

    /// The units from which nothing comes, in words.
    pub fn quiet(&self, now_ns: i64) -> impl Iterator<Item = String> {
        self.lines.iter().filter_map(move |line| {
            let last = line.last?;
            let bytes = now_ns - last.arrival_ns < QUIET_NS;
            match (bytes, last.good > 0) {
                (true, true) => None,
                (true, false) => Some(format!("{}: bytes come, but no frame of its device", line.name)),
                (false, _) if last.opened == 0 => Some(format!("{}: the port cannot be opened", line.name)),
                (false, _) => Some(format!("{}: nothing comes", line.name)),
            }
        })
    }

    /// For the report.
    pub fn rows(&self) -> Vec<LineRow> {
        self.lines.iter().filter_map(|line| Some(LineRow::new(line.name.clone(), &line.last?))).collect()
    }
}
