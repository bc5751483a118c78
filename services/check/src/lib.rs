//! Checks a configuration and the head of each recording.

mod listen;
mod report;

pub use listen::{Listened, listen};
pub use report::{Report, Unit};

use pipeline::configuration::{Configuration, ConfigurationError, Source};
use pipeline::recorded_run::Course;
use pipeline::recording::{RecordingError, head};
use std::path::Path;

/// How many rows of a recording are looked at: ten minutes at 100 Hz.
const ROWS: usize = 60_000;

/// Why a configuration cannot be run.
#[derive(Debug, thiserror::Error)]
pub enum CheckError {
    /// The configuration itself.
    #[error(transparent)]
    Configuration(#[from] ConfigurationError),
    /// Recordings that cannot be used; one line of text each.
    #[error("{}", .0.iter().map(ToString::to_string).collect::<Vec<String>>().join("\n"))]
    Recordings(Vec<RecordingError>),
}

/// Reads the configuration and looks at the beginning of each of its recordings, or through its recorded run.
///
/// # Errors
/// The configuration is not sound, or a recording cannot be read, has an unknown header or no usable row.
pub fn run(path: &Path) -> Result<Report, CheckError> {
    let configuration = Configuration::read(path)?;
    let main = std::iter::once(("main", &configuration.main.source));
    let areas = configuration.areas.iter().map(|area| (area.name.as_str(), &area.source));
    let mut units = Vec::new();
    let mut errors = Vec::new();
    let mut run = None;
    if let Source::Mcap(path) = &configuration.main.source {
        match Course::read(path, &configuration) {
            Ok(course) => run = Some(course),
            Err(error) => errors.push(error),
        }
    }
    for (name, source) in main.chain(areas) {
        let Source::Csv(recording) = source else { continue };
        match head(recording, ROWS, configuration.rate_hz) {
            Ok(head) => units.push(Unit { name: name.to_string(), path: recording.clone(), head }),
            Err(error) => errors.push(error),
        }
    }
    if errors.is_empty() { Ok(Report { configuration, units, run }) } else { Err(CheckError::Recordings(errors)) }
}
