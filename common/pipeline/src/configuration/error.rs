use std::path::{Path, PathBuf};

/// Why a configuration cannot be used. Each text names file, line, key, value and what is allowed.
#[derive(Debug, thiserror::Error)]
pub enum ConfigurationError {
    /// The file cannot be read.
    #[error("{}: cannot read the configuration: {reason}", path.display())]
    Unreadable {
        /// The configuration.
        path: PathBuf,
        /// The operating system's reason.
        reason: std::io::Error,
    },
    /// A key is unknown, missing or has a value that is not allowed, or the text is not TOML.
    #[error("{}: {message}", place(path, *line))]
    Invalid {
        /// The configuration.
        path: PathBuf,
        /// Line of the key, from 1; `None` for a key that is missing from the top level.
        line: Option<usize>,
        /// Key, value and what is allowed.
        message: String,
    },
    /// Several keys contradict each other or the files; one line of text each.
    #[error("{}", texts(.0))]
    Several(Vec<ConfigurationError>),
}

fn place(path: &Path, line: Option<usize>) -> String {
    line.map_or(path.display().to_string(), |line| format!("{}:{line}", path.display()))
}

fn texts(errors: &[ConfigurationError]) -> String {
    errors.iter().map(ToString::to_string).collect::<Vec<String>>().join("\n")
}
