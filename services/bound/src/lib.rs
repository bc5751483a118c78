//! `deckflex bound`: the covariance that the data of a configuration would allow against time, were the flexure's true model known.
//!
//! The configuration's ship, hull and units are simulated, and the project's own estimator runs over them with the true flexure of each
//! area. What it gives is the covariance of a filter whose model is right: no filter that has to learn the flexure can promise less.

mod chart;
mod curve;
mod error;
mod json;
mod plan;
mod report;

pub use curve::Point;
pub use error::BoundError;
pub use report::{Area, Report, Row};

use curve::{Seen, Watch, is_unobservable, pooled};
use indicatif::{ProgressBar, ProgressStyle};
use pipeline::configuration::Configuration;
use pipeline::offline;
use pipeline::recording::RecordingError;
use plan::Plan;
use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::thread;

/// Seeds of the runs; the covariance depends a little on noise and waves.
pub const SEEDS: [u64; 4] = [1, 2, 3, 4];

/// What the user asks for.
#[derive(Clone, Debug)]
pub struct Options {
    /// The configuration.
    pub configuration: PathBuf,
    /// Length of the data, s; `None` for the configuration's, or half an hour.
    pub duration_s: Option<f64>,
    /// Where the figure goes.
    pub svg: Option<PathBuf>,
    /// Where the numbers go.
    pub json: Option<PathBuf>,
}

/// Runs the told filter over the simulated data and writes `options.svg` and `options.json`.
///
/// # Errors
/// The configuration cannot be used; an output cannot be written, which is found out before the work starts.
pub fn run(options: &Options) -> Result<Report, BoundError> {
    let plan = Plan::read(&options.configuration, options.duration_s)?;
    let svg = options.svg.as_deref().map(Output::create).transpose()?;
    let json = options.json.as_deref().map(Output::create).transpose()?;
    let report = report(&plan)?;
    if let Some(svg) = svg {
        svg.write(&chart::svg(&report)?)?;
    }
    if let Some(json) = json {
        json.write(&json::of(&report)?)?;
    }
    Ok(report)
}

fn report(plan: &Plan) -> Result<Report, BoundError> {
    let Plan { configuration, duration_s } = plan;
    let runs = runs(configuration, *duration_s)?;
    let area = |index: usize| {
        let seen: Vec<&Seen> = runs.iter().map(|run| &run[index]).collect();
        let told = &configuration.areas[index];
        let is_unobservable = is_unobservable(&seen);
        Area {
            name: told.name.clone(),
            has_accelerometers: plan::has_accelerometers(configuration, index),
            curve: pooled(&seen, *duration_s),
            is_unobservable,
            surveyed: plan::surveyed(told).filter(|_| is_unobservable),
            left_out: plan::left_out(configuration, index),
        }
    };
    Ok(Report { duration_s: *duration_s, areas: (0..configuration.areas.len()).map(area).collect() })
}

/// A thread for each seed.
fn runs(configuration: &Configuration, duration_s: f64) -> Result<Vec<Vec<Seen>>, RecordingError> {
    let bar = progress(duration_s);
    let one = |seed: u64| {
        let configuration = configuration.with(|configuration| configuration.run.seed = seed);
        let mut watch = Watch::new(configuration.areas.len(), |seconds| bar.inc(seconds));
        offline::run(&configuration, &mut watch)?;
        Ok(watch.finish())
    };
    let runs = thread::scope(|scope| {
        let started = SEEDS.map(|seed| scope.spawn(move || one(seed)));
        let joined = started.map(|run| run.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)));
        joined.into_iter().collect()
    });
    bar.finish_and_clear();
    runs
}

/// A bar in seconds of data of all runs; nothing without a terminal.
fn progress(duration_s: f64) -> ProgressBar {
    let bar = ProgressBar::new((duration_s.ceil() * SEEDS.len() as f64) as u64);
    match ProgressStyle::with_template("{bar:40} {pos}/{len} s of data, {eta} left") {
        Ok(style) => bar.with_style(style),
        Err(_) => bar,
    }
}

/// A file that is open before there is anything to write.
struct Output {
    path: PathBuf,
    file: File,
}

impl Output {
    fn create(path: &Path) -> Result<Self, BoundError> {
        let path = path.to_path_buf();
        match File::create(&path) {
            Ok(file) => Ok(Self { path, file }),
            Err(source) => Err(BoundError::Output { path, source }),
        }
    }

    fn write(mut self, text: &str) -> Result<(), BoundError> {
        let written = self.file.write_all(text.as_bytes());
        written.map_err(|source| BoundError::Output { path: self.path, source })
    }
}
