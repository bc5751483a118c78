//! The units' samples as recordings: `main.csv` with the attitude, and a file an area.

use crate::ExportError;
use frames::{Main, Nav, Rot, unit};
use messages::ImuSample;
use pipeline::configuration::Configuration;
use pipeline::recorded_run::Playback;
use pipeline::source::Batch;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

const COLUMNS: &str = "t_s,dtheta_x_rad,dtheta_y_rad,dtheta_z_rad,dvel_x_m_s,dvel_y_m_s,dvel_z_m_s";

/// The file of a unit.
pub struct Samples {
    out: BufWriter<File>,
    path: PathBuf,
    rows: u64,
}

impl Samples {
    /// Writes the samples of all units, main unit first; gives the files with their rows.
    pub fn write(run: &Path, configuration: &Configuration, folder: &Path) -> Result<Vec<(PathBuf, u64)>, ExportError> {
        let mut playback = Playback::open(run, configuration, 0)?;
        let output = |source| ExportError::Output { path: folder.to_path_buf(), source };
        let names = std::iter::once("main").chain(configuration.areas.iter().map(|area| area.name.as_str()));
        let mut units =
            names.map(|name| Self::create(folder, name)).collect::<io::Result<Vec<Self>>>().map_err(output)?;
        let mut batch = Batch::default();
        while playback.next(&mut batch) {
            let attitude = batch.attitude.map_or(",,,".to_owned(), |attitude| {
                let euler = Rot::<Nav, Main>::from_wxyz(attitude.q).euler();
                let degrees = [euler.roll, euler.pitch, euler.heading].map(|angle| angle / unit::DEGREE);
                degrees.iter().fold(String::new(), |row, x| format!("{row},{x}"))
            });
            units[0].row(&batch.main, &attitude).map_err(output)?;
            for sample in &batch.sub {
                units[sample.unit as usize].row(sample, "").map_err(output)?;
            }
        }
        units.into_iter().map(|unit| unit.finish().map_err(output)).collect()
    }

    fn create(folder: &Path, name: &str) -> io::Result<Self> {
        let path = folder.join(format!("{name}.csv"));
        let mut out = BufWriter::new(File::create(&path)?);
        writeln!(out, "{COLUMNS}{}", if name == "main" { ",roll_deg,pitch_deg,heading_deg" } else { "" })?;
        Ok(Self { out, path, rows: 0 })
    }

    fn row(&mut self, sample: &ImuSample, attitude: &str) -> io::Result<()> {
        self.rows += 1;
        write!(self.out, "{}", unit::seconds(sample.header.time_ns))?;
        sample.dtheta.iter().chain(&sample.dvel).try_for_each(|x| write!(self.out, ",{x}"))?;
        writeln!(self.out, "{attitude}")
    }

    fn finish(mut self) -> io::Result<(PathBuf, u64)> {
        self.out.flush()?;
        Ok((self.path, self.rows))
    }
}
