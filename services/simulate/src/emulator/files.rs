//! What was true, for whoever wants to judge: never for another process.

use frames::unit;
use pipeline::configuration::Configuration;
use simulation::Epoch;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;

/// `truth_<area>.csv`: the deformation at the main unit's instants; `times_<unit>.csv`: when each sample really ended. Times are of the
/// host's monotonic clock.
pub struct Files {
    truths: Vec<BufWriter<File>>,
    times: Vec<BufWriter<File>>,
}

impl Files {
    pub fn create(folder: &Path, configuration: &Configuration) -> io::Result<Self> {
        std::fs::create_dir_all(folder)?;
        let file = |name: String, heading: &str| {
            let mut file = BufWriter::new(File::create(folder.join(name))?);
            writeln!(file, "{heading}")?;
            io::Result::Ok(file)
        };
        let areas = configuration.areas.iter().map(|area| area.name.as_str());
        let truths = areas.clone().map(|area| file(format!("truth_{area}.csv"), "t_s,q_w,q_x,q_y,q_z"));
        let times = std::iter::once("main").chain(areas).map(|unit| file(format!("times_{unit}.csv"), "number,t_ns"));
        Ok(Self { truths: truths.collect::<io::Result<_>>()?, times: times.collect::<io::Result<_>>()? })
    }

    pub fn write(&mut self, epoch: &Epoch, host_ns: impl Fn(i64) -> i64) -> io::Result<()> {
        for truth in &epoch.truth {
            let file = &mut self.truths[truth.area as usize];
            let [w, x, y, z] = truth.q;
            writeln!(file, "{},{w},{x},{y},{z}", unit::seconds(host_ns(truth.header.time_ns)))?;
        }
        for sample in std::iter::once(&epoch.main).chain(&epoch.sub) {
            let file = &mut self.times[sample.unit as usize];
            writeln!(file, "{},{}", sample.header.sequence, host_ns(sample.header.time_ns))?;
        }
        Ok(())
    }

    pub fn finish(mut self) -> io::Result<()> {
        self.truths.iter_mut().chain(&mut self.times).try_for_each(Write::flush)
    }
}
