//! `deckflex doctor`: looks at what of this computer stands in the way of a live run, and says how to mend it. It changes nothing.

mod finding;
mod memory;
mod ports;
mod process;
mod processor;

pub use finding::{Finding, Grade, Report};

use pipeline::configuration::{Configuration, ConfigurationError};
use std::path::{Path, PathBuf};

/// The computer as it is looked at.
#[derive(Clone, Debug)]
pub struct Host {
    /// In front of `/proc`, `/sys`, `/dev`, `/etc`: `/`, or a made tree.
    pub root: PathBuf,
    /// Size of the shared memory's file system and what of it is free, bytes; `None` where it is not known.
    pub shared_memory: Option<[u64; 2]>,
}

impl Host {
    /// This computer.
    pub fn this() -> Self {
        Self { root: PathBuf::from("/"), shared_memory: memory::size(Path::new("/dev/shm")) }
    }

    fn path(&self, path: &str) -> PathBuf {
        self.root.join(path.trim_start_matches('/'))
    }

    /// The text of a file without the blanks around it; `None` where it cannot be read.
    fn read(&self, path: &str) -> Option<String> {
        Some(std::fs::read_to_string(self.path(path)).ok()?.trim().to_owned())
    }

    /// Names in a folder in their order; none where there is no such folder.
    fn names(&self, path: &str) -> Vec<String> {
        let entries = std::fs::read_dir(self.path(path)).into_iter().flatten().flatten();
        let mut names: Vec<String> = entries.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
        names.sort_unstable();
        names
    }
}

/// Looks at the computer, and at what a configuration needs of it.
///
/// # Errors
/// The configuration cannot be used.
pub fn run(host: &Host, configuration: Option<&Path>) -> Result<Report, ConfigurationError> {
    let areas =
        configuration.map(Configuration::read).transpose()?.map_or(1, |configuration| configuration.areas.len());
    let mut findings = process::limits(host);
    findings.extend(ports::serial(host));
    findings.extend(ports::latency_timers(host));
    findings.extend(processor::findings(host));
    findings.extend(memory::findings(host, areas));
    Ok(Report { findings })
}
