//! The configuration: one TOML file whose keys carry their unit; SI units from here on.

mod alarm;
mod area;
mod area_simulation;
mod document;
mod error;
mod estimator;
mod events;
mod flexure;
mod identifier;
mod instrument;
mod line;
mod log;
mod model_free;
mod output;
mod quantity;
mod record;
mod rules;
mod scenario;
mod simulation;
mod spikes;
mod swing;
mod table;
mod unit_errors;

pub use alarm::AlarmLimits;
pub use area::{Area, Installation, MainUnit};
pub use area_simulation::AreaSimulation;
pub use error::ConfigurationError;
pub use estimator::{EstimatorSettings, FilterMethod, MatchingMethod, RangeMethod, RegistrationMethod};
pub use identifier::{IdentifierMethod, IdentifierSettings};
pub use instrument::{Accel, Gyro, Source};
pub use line::Line;
pub use log::{LogLevel, LogSettings, LogTo};
pub use model_free::{DelaySettings, NetworkInput, NetworkSettings};
pub use output::{Destination, Output, Telegrams};
pub use record::{RecordSettings, RecordTopic};
pub use simulation::{Ins, Simulation, Wire};
pub use wire::Port;

use crate::recorded_run;
use document::Document;
use serde::{Deserialize, Deserializer};
use std::path::{Path, PathBuf};

/// Everything that a run is told.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Configuration {
    /// The file, as it was named.
    #[serde(skip)]
    pub path: PathBuf,
    /// Whether it stands in the recorded run that is its source: the run is gone through again as it was.
    #[serde(skip)]
    pub as_recorded: bool,
    /// Samples a second of every unit.
    #[serde(deserialize_with = "quantity::rate_hz")]
    pub rate_hz: f64,
    /// A unit that gives nothing for so long is silent, s.
    #[serde(default = "half", deserialize_with = "quantity::silence_s")]
    pub silence_s: f64,
    /// A value is a spike if it is off its neighbours by more than so many times the unit's own roughness; 0 for no test.
    #[serde(default, deserialize_with = "spikes::threshold")]
    pub spike_threshold: f64,
    /// The error figures of a summary leave out the first so many seconds.
    #[serde(default = "two_minutes", deserialize_with = "quantity::settle_s")]
    pub settle_s: f64,
    /// The main inertial unit.
    #[serde(deserialize_with = "table::one")]
    pub main: MainUnit,
    /// The deck areas, at least one.
    #[serde(rename = "area", default, deserialize_with = "table::many")]
    pub areas: Vec<Area>,
    /// Where telegrams go.
    #[serde(rename = "output", default, deserialize_with = "table::many")]
    pub outputs: Vec<Output>,
    /// How the run is carried out.
    #[serde(default, deserialize_with = "table::one")]
    pub run: Run,
    /// Recordings are played back at so many times the recorded pace.
    #[serde(rename = "replay", default = "as_recorded", deserialize_with = "pace")]
    pub replay_pace: f64,
    /// What is recorded of the run; `None` for nothing.
    #[serde(default, deserialize_with = "table::optional")]
    pub record: Option<RecordSettings>,
    /// What is logged, and where.
    #[serde(default, deserialize_with = "table::one")]
    pub log: LogSettings,
    /// What the simulator makes of the ship.
    #[serde(default, deserialize_with = "table::one")]
    pub simulation: Simulation,
}

fn half() -> f64 {
    0.5
}

fn two_minutes() -> f64 {
    120.0
}

impl Configuration {
    /// Reads and checks a configuration, and that its recordings exist. That of a recorded run is read from the recording, which is
    /// then the source of all its units.
    ///
    /// # Errors
    /// The file cannot be read or is not TOML; a key is unknown, missing, of the wrong type or out of its range; keys
    /// contradict each other; a recording cannot be found.
    pub fn read(path: &Path) -> Result<Self, ConfigurationError> {
        let text = Self::text(path)?;
        if recorded_run::is_one(path) { Self::assemble(path, &text, Some(path)) } else { Self::parse(path, &text) }
    }

    /// The text of a configuration, which a recorded run holds.
    ///
    /// # Errors
    /// The file cannot be read.
    pub fn text(path: &Path) -> Result<String, ConfigurationError> {
        let unreadable = |reason| ConfigurationError::Unreadable { path: path.to_path_buf(), reason };
        if recorded_run::is_one(path) {
            let about = recorded_run::about(path).map_err(|error| unreadable(std::io::Error::other(error)))?;
            return Ok(about.configuration);
        }
        std::fs::read_to_string(path).map_err(unreadable)
    }

    /// Checks the text of a configuration, and that its recordings exist; `path` is what errors name and where the paths of
    /// recordings start from.
    ///
    /// # Errors
    /// Those of [`Self::read`], but for the file itself.
    pub fn parse(path: &Path, text: &str) -> Result<Self, ConfigurationError> {
        Self::assemble(path, text, None)
    }

    fn assemble(path: &Path, text: &str, recorded: Option<&Path>) -> Result<Self, ConfigurationError> {
        let document = Document::parse(path, text)?;
        let mut configuration: Self = toml::from_str(text).map_err(|error| document.explain(&error))?;
        configuration.path = path.to_path_buf();
        if let Some(run) = recorded {
            configuration.take_from(run);
        }
        rules::apply(&mut configuration, &document)?;
        Ok(configuration)
    }

    /// Takes all units from a recorded run, to its end, and leaves out what acts on anything outside.
    fn take_from(&mut self, run: &Path) {
        let run = std::path::absolute(run).unwrap_or_else(|_| run.to_path_buf());
        self.main.source = Source::Mcap(run.clone());
        self.areas.iter_mut().for_each(|area| area.source = Source::Mcap(run.clone()));
        self.as_recorded = true;
        self.run.duration_s = None;
        self.replay_pace = as_recorded();
        self.record = None;
        self.outputs.clear();
    }

    /// A copy with some values changed, which are not checked again.
    pub fn with(&self, change: impl FnOnce(&mut Self)) -> Self {
        let mut configuration = self.clone();
        change(&mut configuration);
        configuration
    }

    /// Has the run recorded in a folder, whether the configuration speaks of it or not.
    pub fn record_in(&mut self, folder: &Path) {
        self.record.get_or_insert_with(|| RecordSettings::new(folder)).folder = folder.to_path_buf();
    }

    /// The nominal time from one sample to the next, ns.
    pub fn interval_ns(&self) -> i64 {
        frames::unit::nanoseconds(1.0 / self.rate_hz)
    }
}

/// How a run is carried out.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Run {
    /// Seed of all random numbers of the simulator.
    pub seed: u64,
    /// Length of the data, s; `None` runs until it is stopped or the recording ends.
    #[serde(deserialize_with = "quantity::duration_s")]
    pub duration_s: Option<f64>,
    /// The scheduling class to ask for.
    pub scheduling: SchedulingChoice,
}

impl Default for Run {
    fn default() -> Self {
        Self { seed: 1, duration_s: None, scheduling: SchedulingChoice::Auto }
    }
}

/// The scheduling class to ask for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SchedulingChoice {
    /// Real-time if the operating system grants it.
    #[default]
    Auto,
    /// The ordinary time-sharing class.
    Normal,
    /// Real-time, first in first out; an error if it is not granted.
    Fifo,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Replay {
    #[serde(default = "as_recorded", deserialize_with = "quantity::pace")]
    pace: f64,
}

fn as_recorded() -> f64 {
    1.0
}

fn pace<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    table::one(deserializer).map(|replay: Replay| replay.pace)
}
