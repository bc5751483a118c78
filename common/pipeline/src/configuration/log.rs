//! What is logged of a run, and where.

use serde::Deserialize;

/// The log of the launcher and its stages.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct LogSettings {
    /// Where it goes.
    pub to: LogTo,
    /// The least that is logged.
    pub level: LogLevel,
}

/// Where a log goes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LogTo {
    /// The error output.
    #[default]
    Stderr,
    /// The journal of systemd.
    Journal,
}

/// The least that is logged.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LogLevel {
    /// What ends a stage.
    Error,
    /// What somebody should look at.
    Warn,
    /// What changes in a run.
    #[default]
    Info,
    /// What comes again and again in a sound run.
    Debug,
}

impl LogLevel {
    /// All of them, the gravest first.
    pub const ALL: [Self; 4] = [Self::Error, Self::Warn, Self::Info, Self::Debug];

    /// The name in configurations and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Error => "error",
            Self::Warn => "warn",
            Self::Info => "info",
            Self::Debug => "debug",
        }
    }
}
