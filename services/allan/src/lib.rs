//! `deckflex allan`: the Allan deviation of a static recording, and the noise figures that it shows.

mod chart;
mod document;
mod error;
mod kind;
mod paste;
mod report;

pub use error::AllanError;
pub use kind::Kind;
pub use report::{Report, Triad};

use estimation::allan::{Analysis, analyse};
use pipeline::configuration::{Configuration, Source};
use pipeline::recording::{Series, series};
use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};

/// What the user asks for.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// A recording, or a configuration whose units are recordings.
    pub file: PathBuf,
    /// `main` or the name of an area, for a configuration.
    pub unit: Option<String>,
    /// Where the figure goes.
    pub svg: Option<PathBuf>,
    /// Where the numbers go.
    pub json: Option<PathBuf>,
}

/// Analyses the recording and writes `options.svg` and `options.json`.
///
/// # Errors
/// The recording cannot be used or is too short; an output cannot be written, which is found out before the work starts.
pub fn run(options: &Options) -> Result<Report, AllanError> {
    let path = recording(options)?;
    let svg = options.svg.as_deref().map(Output::create).transpose()?;
    let json = options.json.as_deref().map(Output::create).transpose()?;
    let report = report(path)?;
    if let Some(svg) = svg {
        svg.write(&chart::svg(&report)?)?;
    }
    if let Some(json) = json {
        json.write(&document::of(&report)?)?;
    }
    Ok(report)
}

/// The recording that is meant.
fn recording(options: &Options) -> Result<PathBuf, AllanError> {
    let Options { file, unit, .. } = options;
    if file.extension().is_none_or(|extension| extension != "toml") {
        return match unit {
            Some(_) => Err(AllanError::NeedlessUnit(file.clone())),
            None => Ok(file.clone()),
        };
    }
    let configuration = Configuration::read(file)?;
    let unit = unit.as_deref().unwrap_or("main");
    let areas = configuration.areas.iter().map(|area| (area.name.as_str(), &area.source));
    let units: Vec<(&str, &Source)> = std::iter::once(("main", &configuration.main.source)).chain(areas).collect();
    let recorded = units.iter().filter_map(|(name, source)| match source {
        Source::Csv(path) => Some((*name, path)),
        Source::Simulator | Source::Mcap(_) | Source::Line(_) => None,
    });
    match recorded.clone().find(|(name, _)| *name == unit) {
        Some((_, path)) => Ok(path.clone()),
        None => Err(AllanError::Unit {
            path: file.clone(),
            unit: unit.to_owned(),
            known: recorded.map(|(name, _)| name.to_owned()).collect(),
        }),
    }
}

fn report(path: PathBuf) -> Result<Report, AllanError> {
    let series = series(&path)?;
    let gyro = triad(&series, Kind::Gyro, &series.gyro);
    let accel = series.accel.as_ref().map(|channels| triad(&series, Kind::Accel, channels));
    if gyro.axes.iter().all(Option::is_none) {
        return Err(AllanError::TooShort(path));
    }
    let accel = accel.filter(|triad| triad.axes.iter().any(Option::is_some));
    Ok(Report {
        path,
        samples: series.gyro[0].len(),
        interval: series.interval,
        stretches: series.stretches.len(),
        bridged: series.bridged,
        counts: series.counts,
        suspicions: series.suspicions,
        triads: std::iter::once(gyro).chain(accel).collect(),
    })
}

fn triad(series: &Series, kind: Kind, channels: &[Vec<f64>; 3]) -> Triad {
    let axis = |channel: &Vec<f64>| -> Option<Analysis> { analyse(&series.cut(channel), series.interval) };
    let mean = |channel: &Vec<f64>| channel.iter().sum::<f64>() / channel.len() as f64;
    Triad { kind, axes: [0, 1, 2].map(|i| axis(&channels[i])), mean: [0, 1, 2].map(|i| mean(&channels[i])) }
}

/// A file that is open before there is anything to write.
struct Output {
    path: PathBuf,
    file: File,
}

impl Output {
    fn create(path: &Path) -> Result<Self, AllanError> {
        let path = path.to_path_buf();
        match File::create(&path) {
            Ok(file) => Ok(Self { path, file }),
            Err(source) => Err(AllanError::Output { path, source }),
        }
    }

    fn write(mut self, text: &str) -> Result<(), AllanError> {
        let written = self.file.write_all(text.as_bytes());
        written.map_err(|source| AllanError::Output { path: self.path, source })
    }
}
