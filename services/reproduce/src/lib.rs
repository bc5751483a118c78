//! `deckflex reproduce`: the papers' experiments, our figures beside theirs and beside the bound.

mod error;
mod json;
mod number;
mod page;
mod plot;
mod progress;
mod selection;
mod table;

pub use error::ReproduceError;
pub use experiments::Plan;
pub use selection::{Selection, UnknownExperiment};

use experiments::Findings;
use std::fmt;
use std::fs::File;
use std::io::Write;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

/// What the user asks for.
#[derive(Clone, Debug)]
pub struct Options {
    /// Which experiments.
    pub selection: Selection,
    /// How many trials, from which seed.
    pub plan: Plan,
    /// Where the rows go as JSON.
    pub json: Option<PathBuf>,
    /// The folder where the page goes.
    pub report: Option<PathBuf>,
    /// Threads at work; `None` for one a core. The results do not depend on it.
    pub threads: Option<NonZeroUsize>,
}

/// What the experiments gave; it displays as tables.
#[derive(Clone, Debug)]
pub struct Report {
    experiments: Vec<(&'static str, Findings)>,
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let tables = self.experiments.iter().map(|(title, findings)| table::of(title, &findings.rows));
        f.write_str(&tables.collect::<Vec<String>>().join("\n"))
    }
}

/// Carries out the experiments and writes `options.json` and `index.html` in `options.report`.
///
/// # Errors
/// An output cannot be written, which is found out before the work starts; the threads cannot be started; an experiment cannot be
/// carried out.
pub fn run(options: &Options) -> Result<Report, ReproduceError> {
    let json = options.json.as_deref().map(Output::create).transpose()?;
    let page = options.report.as_deref().map(Output::page).transpose()?;
    let threads = options.threads.map_or(0, NonZeroUsize::get);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
    let experiments = options.selection.experiments();
    let bar = progress::Bar::new(experiments.clone().map(|experiment| experiment.cost(&options.plan)).sum());
    let found = experiments
        .map(|experiment| Ok((experiment.title, pool.install(|| experiment.run(&options.plan, &bar))?)))
        .collect::<Result<_, ReproduceError>>();
    bar.clear();
    let report = Report { experiments: found? };
    if let Some(json) = json {
        json.write(&json::of(report.experiments.iter().flat_map(|(_, findings)| &findings.rows))?)?;
    }
    if let Some(page) = page {
        page.write(&page::of(&report.experiments, &options.plan)?)?;
    }
    Ok(report)
}

/// A file that is open before there is anything to write.
struct Output {
    path: PathBuf,
    file: File,
}

impl Output {
    fn create(path: &Path) -> Result<Self, ReproduceError> {
        let path = path.to_path_buf();
        match File::create(&path) {
            Ok(file) => Ok(Self { path, file }),
            Err(source) => Err(ReproduceError::Output { path, source }),
        }
    }

    fn page(folder: &Path) -> Result<Self, ReproduceError> {
        std::fs::create_dir_all(folder)
            .map_err(|source| ReproduceError::Output { path: folder.to_path_buf(), source })?;
        Self::create(&folder.join("index.html"))
    }

    fn write(mut self, text: &str) -> Result<(), ReproduceError> {
        let written = self.file.write_all(text.as_bytes());
        written.map_err(|source| ReproduceError::Output { path: self.path, source })
    }
}
