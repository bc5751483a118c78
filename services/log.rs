//! What is logged by this process: as the configuration says, unless the command line says otherwise.

use pipeline::configuration::{LogLevel, LogSettings, LogTo};
use runtime::log::{Level, Log, Settings, Speaker, To};

/// Starts the log of a stage or of the launcher.
pub fn start(told: LogSettings, asked: Option<LogLevel>, stage: &str, area: Option<&str>) -> Log {
    let level = match asked.unwrap_or(told.level) {
        LogLevel::Error => Level::Error,
        LogLevel::Warn => Level::Warn,
        LogLevel::Info => Level::Info,
        LogLevel::Debug => Level::Debug,
    };
    let to = match told.to {
        LogTo::Stderr => To::Stderr,
        LogTo::Journal => To::Journal,
    };
    Log::start(Settings { level, to, speaker: Speaker { stage: stage.to_owned(), area: area.map(str::to_owned) } })
}
