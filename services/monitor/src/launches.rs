//! Finds the launch to look at.

use runtime::{Domain, Running, TransportError};
use std::path::{Path, PathBuf};

/// A launch that runs now.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Launch {
    /// Root of its domain.
    pub root: PathBuf,
    /// Its configuration, absolute.
    pub configuration: PathBuf,
}

/// All launches of this user, or those of a configuration.
pub fn find(configuration: Option<&Path>) -> Result<Vec<Launch>, TransportError> {
    let wanted = configuration.map(|path| path.canonicalize().unwrap_or_else(|_| path.to_path_buf()));
    let known = |running: Running| Some(Launch { configuration: configuration_of(running.pid)?, root: running.root });
    let mut launches: Vec<Launch> = Domain::running()?.into_iter().filter_map(known).collect();
    launches.retain(|launch| wanted.as_ref().is_none_or(|wanted| launch.configuration == *wanted));
    launches.sort_unstable_by(|a, b| a.root.cmp(&b.root));
    Ok(launches)
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
