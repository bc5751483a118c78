//! `deckflex report`: one page about a recorded run, with pictures and tables, that needs nothing but a browser.

mod error;
mod gather;
mod page;
mod plot;

pub use error::ReportError;

use gather::Run;
use pipeline::configuration::Configuration;
use pipeline::recorded_run;
use std::fmt;
use std::path::{Path, PathBuf};

/// What was written.
#[derive(Clone, Debug)]
pub struct Report {
    /// The page.
    pub path: PathBuf,
    /// Its length in bytes.
    pub bytes: usize,
    /// Areas with solutions and of them the valid ones.
    pub areas: Vec<(String, u64, u64)>,
}

/// Writes the page about a recorded run and those of its files that follow, by default beside the recording with the ending `.html`.
///
/// # Errors
/// The recording cannot be read, or the page cannot be written.
pub fn run(recording: &Path, out: Option<&Path>) -> Result<Report, ReportError> {
    if !recorded_run::is_one(recording) {
        // with the reason in the words of whoever opens it
        recorded_run::about(recording)?;
    }
    let configuration = Configuration::read(recording)?;
    let run = Run::read(recording, &configuration)?;
    let text = page::of(recording, &run);
    let path = out.map_or_else(|| recording.with_extension("html"), Path::to_path_buf);
    std::fs::write(&path, &text).map_err(|source| ReportError::Output { path: path.clone(), source })?;
    let areas = run.areas.iter().map(|area| (area.name.clone(), area.solutions, area.valid)).collect();
    Ok(Report { path, bytes: text.len(), areas })
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}, {} kB", self.path.display(), self.bytes.div_ceil(1000))?;
        self.areas
            .iter()
            .try_for_each(|(name, solutions, valid)| writeln!(f, "area {name}: {solutions} solutions, {valid} valid"))
    }
}
