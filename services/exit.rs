//! What is told of an error, and with which exit code.

use runtime::{POISONED_EXIT_CODE, TransportError};
use std::error::Error;
use std::path::PathBuf;
use std::process::ExitCode;

/// The configuration, the recording or the command line cannot be used.
const UNUSABLE: u8 = 2;

/// Prints the error; the exit code tells the launcher and scripts what to do about it.
pub fn failed(error: &(dyn Error + 'static)) -> ExitCode {
    eprintln!("deckflex: {error}");
    let poisoned = error.downcast_ref::<TransportError>().is_some_and(TransportError::is_poisoned)
        || matches!(error.downcast_ref(), Some(replay::ReplayError::Transport(error)) if error.is_poisoned())
        || matches!(error.downcast_ref(), Some(acquire::AcquireError::Transport(error)) if error.is_poisoned())
        || matches!(error.downcast_ref(), Some(output::OutputError::Transport(error)) if error.is_poisoned())
        || matches!(error.downcast_ref(), Some(record::RecordError::Transport(error)) if error.is_poisoned());
    let unusable = error.is::<pipeline::configuration::ConfigurationError>()
        || error.is::<check::CheckError>()
        || matches!(error.downcast_ref(), Some(bound::BoundError::Configuration(_)))
        || matches!(error.downcast_ref(), Some(process::ProcessError::Recording(_)))
        || matches!(error.downcast_ref(), Some(replay::ReplayError::Recording(_)))
        || error.downcast_ref().is_some_and(acquire::AcquireError::is_lasting)
        || error.is::<simulate::EmulatorError>()
        || matches!(error.downcast_ref(), Some(output::OutputError::Destination { .. }))
        || matches!(error.downcast_ref(), Some(launch::LaunchError::Refused(_)))
        || matches!(error.downcast_ref(), Some(record::RecordError::Configuration(_) | record::RecordError::Nowhere))
        || error.is::<recover::RecoverError>()
        || error.is::<export::ExportError>()
        || error.downcast_ref().is_some_and(report::ReportError::is_unusable)
        || matches!(error.downcast_ref(), Some(error) if allan::AllanError::is_unusable(error))
        || matches!(error.downcast_ref(), Some(error) if compare::CompareError::is_unusable(error))
        || matches!(error.downcast_ref(), Some(monitor::MonitorError::Configuration(_)))
        || error.is::<Refusal>();
    match (poisoned, unusable) {
        (true, _) => ExitCode::from(POISONED_EXIT_CODE),
        (_, true) => ExitCode::from(UNUSABLE),
        _ => ExitCode::FAILURE,
    }
}

/// A command line that asks for what cannot be.
#[derive(Debug, thiserror::Error)]
pub enum Refusal {
    #[error("the configuration has no area \"{0}\"")]
    NoSuchArea(String),
    #[error("cannot record in {0}: {1}")]
    NoFolder(PathBuf, std::io::Error),
    #[error("a simulated run has no end of its own: give --duration or run.duration_s")]
    Endless,
}
