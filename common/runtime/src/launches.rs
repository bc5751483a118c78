//! Finds the launch that a process wants to look at, which is no stage of it.

use crate::{Domain, Running, TransportError};
use std::path::{Path, PathBuf};

/// A launch that runs now.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Launch {
    /// Root of its domain.
    pub root: PathBuf,
    /// Its configuration, absolute.
    pub configuration: PathBuf,
}

impl Launch {
    /// All launches of this user, or those of a configuration.
    ///
    /// # Errors
    /// The folder of domains cannot be read.
    pub fn running(configuration: Option<&Path>) -> Result<Vec<Self>, TransportError> {
        let wanted = configuration.map(|path| path.canonicalize().unwrap_or_else(|_| path.to_path_buf()));
        let known = |running: Running| Some(Self { configuration: configuration_of(running.pid)?, root: running.root });
        let mut launches: Vec<Self> = Domain::running()?.into_iter().filter_map(known).collect();
        launches.retain(|launch| wanted.as_ref().is_none_or(|wanted| launch.configuration == *wanted));
        launches.sort_unstable_by(|a, b| a.root.cmp(&b.root));
        Ok(launches)
    }

    /// Whether it still runs.
    pub fn is_alive(&self) -> bool {
        Domain::open(&self.root).is_ok()
    }
}

/// Looks out for a launch to attach to.
#[derive(Clone, Debug, Default)]
pub struct Lookout {
    configuration: Option<PathBuf>,
    seen: Option<Launch>,
}

impl Lookout {
    /// For the launch of a configuration, or for any.
    pub fn new(configuration: Option<&Path>) -> Self {
        Self { configuration: configuration.map(Path::to_path_buf), seen: None }
    }

    /// Looks; gives a launch that was there at the last look already. At its very start its topics are still being made, and who is
    /// killed while it makes one spoils it for all.
    ///
    /// # Errors
    /// As [`Launch::running`].
    pub fn look(&mut self) -> Result<Option<Launch>, TransportError> {
        let found = Launch::running(self.configuration.as_deref())?;
        match self.seen.take().filter(|seen| found.contains(seen)) {
            Some(launch) => {
                self.seen = Some(launch.clone());
                Ok(Some(launch))
            }
            None => {
                self.seen = found.into_iter().next();
                Ok(None)
            }
        }
    }
}

/// What the launcher was told on its command line.
fn configuration_of(pid: u32) -> Option<PathBuf> {
    let line = std::fs::read(format!("/proc/{pid}/cmdline")).ok()?;
    let arguments: Vec<String> =
        line.split(|byte| *byte == 0).map(|a| String::from_utf8_lossy(a).into_owned()).collect();
    let folder = std::fs::read_link(format!("/proc/{pid}/cwd")).ok()?;
    folder.join(positional(&arguments)?).canonicalize().ok()
}

/// The argument of `launch` that belongs to no option; each of its options takes a value.
fn positional(arguments: &[String]) -> Option<&str> {
    let at = arguments.iter().position(|argument| argument == "launch")?;
    let mut rest = arguments[at + 1..].iter();
    while let Some(argument) = rest.next() {
        match argument.strip_prefix("--") {
            None => return Some(argument.as_str()).filter(|text| !text.is_empty()),
            Some(option) if !option.contains('=') => {
                rest.next();
            }
            Some(_) => {}
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(line: &str) -> Option<String> {
        let arguments: Vec<String> = line.split(' ').map(str::to_owned).collect();
        positional(&arguments).map(str::to_owned)
    }

    #[test]
    fn the_configuration_is_found_wherever_it_stands() {
        for line in [
            "deckflex launch ship.toml --duration 60s",
            "/usr/bin/deckflex launch --duration 60s --json=a.json ship.toml --out x",
        ] {
            assert_eq!(of(line).as_deref(), Some("ship.toml"), "{line}");
        }
        for line in ["deckflex process ship.toml", "deckflex launch", "deckflex launch --out x"] {
            assert_eq!(of(line), None, "{line}");
        }
    }
}
