//! Writes recordings of a simulated configuration: `main.csv` and one file an area, as `deckflex replay` reads them.
//!
//! `cargo run -p deckflex-pipeline --example simulated_recording -- config/demo.toml 40 config/recordings`

use frames::{Main, Nav, Rot, unit};
use messages::ImuSample;
use pipeline::configuration::Configuration;
use pipeline::source::{Batch, Source};
use std::error::Error;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;

const COLUMNS: &str = "t_s,dtheta_x_rad,dtheta_y_rad,dtheta_z_rad,dvel_x_m_s,dvel_y_m_s,dvel_z_m_s";

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [configuration, seconds, folder] = arguments.as_slice() else {
        return Err("usage: simulated_recording CONFIGURATION SECONDS FOLDER".into());
    };
    let mut configuration = Configuration::read(Path::new(configuration))?;
    configuration.run.duration_s = Some(seconds.parse()?);
    std::fs::create_dir_all(folder)?;
    let create = |name: &str| File::create(Path::new(folder).join(format!("{name}.csv"))).map(BufWriter::new);
    let mut main = create("main")?;
    writeln!(main, "{COLUMNS},roll_deg,pitch_deg,heading_deg")?;
    let mut areas = configuration.areas.iter().map(|area| create(&area.name)).collect::<Result<Vec<_>, _>>()?;
    areas.iter_mut().try_for_each(|area| writeln!(area, "{COLUMNS}"))?;

    let mut source = Source::open(&configuration, 0)?;
    let mut batch = Batch::default();
    while source.next(&mut batch) {
        write!(main, "{}", increments(&batch.main))?;
        let ship = batch.attitude.map(|ins| Rot::<Nav, Main>::from_wxyz(ins.q).euler());
        match ship {
            Some(e) => {
                let [roll, pitch, heading] = [e.roll, e.pitch, e.heading].map(|angle| angle / unit::DEGREE);
                writeln!(main, ",{roll:.7},{pitch:.7},{heading:.7}")?;
            }
            None => writeln!(main, ",,,")?,
        }
        for sample in &batch.sub {
            writeln!(areas[sample.unit as usize - 1], "{}", increments(sample))?;
        }
    }
    Ok(())
}

/// Stamp and increments with a resolution far below the units' noise.
fn increments(sample: &ImuSample) -> String {
    let numbers: Vec<String> = sample.dtheta.iter().map(|x| format!("{x:.12}")).collect();
    let velocities: Vec<String> = sample.dvel.iter().map(|x| format!("{x:.9}")).collect();
    format!("{},{},{}", unit::seconds(sample.header.time_ns), numbers.join(","), velocities.join(","))
}
