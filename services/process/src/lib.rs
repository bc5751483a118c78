//! `deckflex process`: the offline loop over a configuration, one thread, as fast as it goes.

mod again;

pub use again::Again;

use estimation::synchronise::Counts;
use indicatif::{ProgressBar, ProgressStyle};
use messages::{Solution, Truth};
use pipeline::configuration::{Configuration, Source};
use pipeline::offline::{self, Outcome, Sink};
use pipeline::recording::RecordingError;
use pipeline::solution_file::SolutionFile;
use pipeline::summary::{Figures, Summary};
use std::fmt;
use std::fs::File;
use std::io::{self, BufWriter};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Why a run failed.
#[derive(Debug, thiserror::Error)]
pub enum ProcessError {
    /// A recording cannot be read.
    #[error(transparent)]
    Recording(#[from] RecordingError),
    /// An output file cannot be written.
    #[error("cannot write {}: {source}", path.display())]
    Output {
        /// The file or folder.
        path: PathBuf,
        /// The operating system's answer.
        source: io::Error,
    },
}

/// What a run gave.
#[derive(Clone, Debug)]
pub struct Report {
    /// The figures that `summary.json` holds.
    pub summary: Summary,
    /// What became of the samples.
    pub outcome: Outcome,
    /// How long it took.
    pub elapsed: Duration,
    /// Solutions a second over all areas.
    pub rate: f64,
    /// Of a recorded run that was gone through again: whether it gave what was recorded.
    pub again: Option<Again>,
}

/// Runs the configuration and writes `solution_<area>.csv` and `summary.json` into the folder.
///
/// With the configuration of a recorded run, that run is gone through again as it was.
///
/// # Errors
/// A recording cannot be read or a file cannot be written.
pub fn run(configuration: &Configuration, out: &Path) -> Result<Report, ProcessError> {
    let failed = |path: &Path| {
        let path = path.to_path_buf();
        move |source| ProcessError::Output { path, source }
    };
    std::fs::create_dir_all(out).map_err(failed(out))?;
    let mut writer = Writer::create(configuration, out).map_err(failed(out))?;
    let start = Instant::now();
    let (outcome, again) = match &configuration.main.source {
        Source::Mcap(run) if configuration.as_recorded => again::run(configuration, run, &mut writer)?,
        _ => (offline::run(configuration, &mut writer)?, None),
    };
    let elapsed = start.elapsed();
    writer.progress.finish_and_clear();
    let solutions = writer.areas.iter().map(|area| area.figures.summary().samples).sum::<u64>();
    let path = out.join("summary.json");
    let summary = writer.finish().map_err(failed(out))?;
    summary.write(&path).map_err(failed(&path))?;
    Ok(Report { summary, outcome, elapsed, rate: solutions as f64 / elapsed.as_secs_f64(), again })
}

/// Takes the loop's output to the files.
struct Writer {
    areas: Vec<Area>,
    progress: ProgressBar,
    begin_ns: Option<i64>,
    /// The first failure; the loop itself knows nothing of files.
    failure: Option<io::Error>,
}

struct Area {
    file: SolutionFile<BufWriter<File>>,
    figures: Figures,
}

impl Writer {
    fn create(configuration: &Configuration, out: &Path) -> io::Result<Self> {
        let open = |area: &pipeline::configuration::Area| {
            let file = SolutionFile::create(out, &area.name)?;
            Ok(Area { file, figures: Figures::new(&area.name, configuration.settle_s) })
        };
        let areas = configuration.areas.iter().map(open).collect::<io::Result<_>>()?;
        Ok(Self { areas, progress: progress(configuration), begin_ns: None, failure: None })
    }

    fn finish(self) -> io::Result<Summary> {
        if let Some(failure) = self.failure {
            return Err(failure);
        }
        let mut areas = Vec::new();
        for area in self.areas {
            areas.push(area.figures.summary());
            area.file.finish()?;
        }
        Ok(Summary { areas })
    }
}

impl Sink for Writer {
    fn truth(&mut self, truth: &Truth) {
        self.areas[truth.area as usize].figures.truth(truth);
    }

    fn solution(&mut self, solution: &Solution) {
        let area = &mut self.areas[solution.area as usize];
        area.figures.solution(solution);
        if let Err(failure) = area.file.write(solution) {
            self.failure.get_or_insert(failure);
        }
        if solution.header.sequence.is_multiple_of(1000) {
            let begin_ns = *self.begin_ns.get_or_insert(solution.header.time_ns);
            self.progress.set_position((solution.header.time_ns - begin_ns).max(0) as u64 / 1_000_000_000);
        }
    }
}

/// A bar in seconds of data, with the time left; a running count where the length is not known; nothing without a terminal.
fn progress(configuration: &Configuration) -> ProgressBar {
    let (bar, template) = match configuration.run.duration_s {
        Some(duration_s) => (ProgressBar::new(duration_s as u64), "{bar:40} {pos}/{len} s of data, {eta} left"),
        None => (ProgressBar::new_spinner(), "{spinner} {pos} s of data"),
    };
    match ProgressStyle::with_template(template) {
        Ok(style) => bar.with_style(style),
        Err(_) => bar,
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let three = |v: &Option<[f64; 3]>, digits: usize| match v {
            Some([x, y, z]) => format!("{x:.digits$} {y:.digits$} {z:.digits$}"),
            None => "unknown".to_owned(),
        };
        for (place, area) in self.summary.areas.iter().enumerate() {
            writeln!(f, "area {}: {} solutions, {:.1} % valid", area.name, area.samples, 100.0 * area.valid_fraction)?;
            writeln!(
                f,
                "  installation    {} deg (by motion, rotation vector in m)",
                three(&area.installation_deg, 4)
            )?;
            writeln!(f, "  static part     {} deg (by the filter)", three(&area.static_deg, 4))?;
            writeln!(f, "  sigma           {} arcsec", three(&area.sigma_arcsec, 1))?;
            if area.rmse_arcsec.is_some() {
                writeln!(
                    f,
                    "  rms error       {} arcsec from {} s on",
                    three(&area.rmse_arcsec, 1),
                    area.settled_from_s
                )?;
                writeln!(f, "  within range    {} of the time", three(&area.coverage_95, 3))?;
            }
            if area.deck_rmse_arcsec.is_some() {
                writeln!(f, "  deck rms error  {} arcsec about east, north, up", three(&area.deck_rmse_arcsec, 1))?;
            }
            if let Some(Counts { missing, refused, suspect }) = self.outcome.areas.get(place) {
                writeln!(f, "  samples missing {missing}, refused {refused}, suspect {suspect}")?;
            }
        }
        if self.outcome.unreadable_rows > 0 {
            writeln!(f, "{} rows of the recordings could not be read", self.outcome.unreadable_rows)?;
        }
        self.again.iter().try_for_each(|again| write!(f, "{again}"))?;
        write!(f, "{:.2} s, {:.0} solutions a second", self.elapsed.as_secs_f64(), self.rate)
    }
}
