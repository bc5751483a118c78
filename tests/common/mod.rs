//! What the tests with real processes share: a folder of their own, configurations, launches and what is left of them.
#![allow(dead_code, clippy::unwrap_used)] // each test file uses a part

pub mod comparison;
pub mod launch;
pub mod page;
pub mod receiver;
pub mod retrace;
pub mod run;

use frames::{Main, Nav, Rot, unit};
use messages::{FlexureParams, ImuSample, Solution};
use pipeline::configuration::Configuration;
use pipeline::offline::{self, Sink};
use pipeline::solution_file::SolutionFile;
use pipeline::source::{Batch, Source};
use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::process::Command;
use tempfile::TempDir;

/// A folder of one test; the domains of what is started in it lie there too, so that no other process's are met or swept.
pub struct Place {
    folder: TempDir,
}

impl Place {
    pub fn new() -> Self {
        // sockets have short names, and the folder for temporary files may have a long one
        let folder = tempfile::Builder::new().prefix("dft").tempdir_in("/tmp").unwrap();
        fs::create_dir(folder.path().join("run")).unwrap();
        Self { folder }
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Makes a folder in it.
    pub fn folder(&self, name: &str) -> PathBuf {
        let path = self.path(name);
        fs::create_dir(&path).unwrap();
        path
    }

    pub fn write(&self, name: &str, text: &str) -> PathBuf {
        let path = self.path(name);
        fs::write(&path, text).unwrap();
        path
    }

    /// The program, whose domains lie in this folder.
    pub fn deckflex(&self) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_deckflex"));
        command.env("XDG_RUNTIME_DIR", self.path("run"));
        command
    }

    /// Roots of the domains that exist now.
    pub fn domains(&self) -> Vec<PathBuf> {
        let bases = fs::read_dir(self.path("run")).unwrap().flatten();
        bases.filter_map(|base| fs::read_dir(base.path()).ok()).flatten().flatten().map(|entry| entry.path()).collect()
    }
}

/// A text of the folder `config`.
pub fn shipped(name: &str) -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("config").join(name)).unwrap()
}

/// Gives keys that stand once, at the beginning of a line, other values.
pub fn changed(text: &str, changes: &[(&str, &str)]) -> String {
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    for (key, value) in changes {
        let is_it = |line: &&mut String| line.split_once('=').is_some_and(|(k, _)| k.trim() == *key);
        let mut found: Vec<&mut String> = lines.iter_mut().filter(is_it).collect();
        assert_eq!(found.len(), 1, "{key} must stand once");
        *found[0] = format!("{key} = {value}");
    }
    lines.join("\n") + "\n"
}

/// The fast stage of most tests: its first solution comes within seconds. Whittle's method needs longer windows than a test has.
const QUICK: &str = "[area.estimator]\nmatching = \"so3\"\n\n";

/// A configuration with windows short enough for a test, and an estimator that starts early.
pub fn quick(text: &str) -> String {
    let text = text.replacen("[area.identifier]", &format!("{QUICK}[area.identifier]"), 1);
    changed(&text, &[("window_s", "300\nmethod = \"rvm\""), ("minimum_s", "3"), ("period_s", "2")])
}

/// The demonstration, quick.
pub fn demo(seed: u64, lead_s: f64) -> String {
    changed(&quick(&shipped("demo.toml")), &[("seed", &seed.to_string()), ("lead_s", &lead_s.to_string())])
}

/// Records the demonstration's units, and gives the configuration that plays them back.
pub fn recorded(place: &Place, seed: u64, seconds: f64, pace: f64, lead_s: f64) -> PathBuf {
    let demo = place.write("recorded.toml", &demo(seed, lead_s));
    let mut configuration = Configuration::read(&demo).unwrap();
    configuration.run.duration_s = Some(seconds);
    record(&configuration, &place.path("recordings"));
    let text = changed(&shipped("replay.toml"), &[("pace", &pace.to_string())]);
    let identifier = format!("[area.identifier]\nmethod = \"rvm\"\nminimum_s = 3\nperiod_s = 2\nlead_s = {lead_s}\n");
    place.write("replay.toml", &format!("{text}\n{QUICK}{identifier}"))
}

const INCREMENTS: &str = "t_s,dtheta_x_rad,dtheta_y_rad,dtheta_z_rad,dvel_x_m_s,dvel_y_m_s,dvel_z_m_s";

/// Writes `main.csv` and a file an area; every number is as short as it can be read back exactly.
fn record(configuration: &Configuration, folder: &Path) {
    fs::create_dir_all(folder).unwrap();
    let file = |name: &str| BufWriter::new(File::create(folder.join(format!("{name}.csv"))).unwrap());
    let mut main = file("main");
    let mut areas: Vec<_> = configuration.areas.iter().map(|area| file(&area.name)).collect();
    writeln!(main, "{INCREMENTS},roll_deg,pitch_deg,heading_deg").unwrap();
    areas.iter_mut().for_each(|area| writeln!(area, "{INCREMENTS}").unwrap());
    let mut source = Source::open(configuration, 0).unwrap();
    let mut batch = Batch::default();
    while source.next(&mut batch) {
        let attitude = Rot::<Nav, Main>::from_wxyz(batch.attitude.unwrap().q).euler();
        let [roll, pitch, heading] = [attitude.roll, attitude.pitch, attitude.heading].map(|a| a / unit::DEGREE);
        writeln!(main, "{},{roll},{pitch},{heading}", row(&batch.main)).unwrap();
        for sample in &batch.sub {
            writeln!(areas[sample.unit as usize - 1], "{}", row(sample)).unwrap();
        }
    }
}

fn row(sample: &ImuSample) -> String {
    let numbers = sample.dtheta.iter().chain(&sample.dvel);
    numbers.fold(unit::seconds(sample.header.time_ns).to_string(), |row, x| format!("{row},{x}"))
}

/// What the offline loop gives of the first area.
pub struct Offline {
    file: SolutionFile<Vec<u8>>,
    pub sets: Vec<FlexureParams>,
}

impl Sink for Offline {
    fn solution(&mut self, solution: &Solution) {
        if solution.area == 0 {
            self.file.write(solution).unwrap();
        }
    }

    fn parameters(&mut self, parameters: &FlexureParams) {
        self.sets.push(*parameters);
    }
}

/// The first area's solution file of a configuration, and all parameter sets, by the loop in this process.
pub fn offline(configuration: &Configuration) -> (String, Vec<FlexureParams>) {
    let mut sink = Offline { file: SolutionFile::new(Vec::new()).unwrap(), sets: Vec::new() };
    offline::run(configuration, &mut sink).unwrap();
    (String::from_utf8(sink.file.finish().unwrap()).unwrap(), sink.sets)
}

/// Reads a configuration and gives the run a length.
pub fn configuration(path: &Path, seconds: f64) -> Configuration {
    let mut configuration = Configuration::read(path).unwrap();
    configuration.run.duration_s = Some(seconds);
    configuration
}

/// Says where two texts part, which their difference as a whole would not.
pub fn first_difference(a: &str, b: &str) -> Option<String> {
    if a == b {
        return None;
    }
    let line = a.lines().zip(b.lines()).position(|(a, b)| a != b).unwrap_or(a.lines().count().min(b.lines().count()));
    let show = |text: &str| text.lines().nth(line).unwrap_or("(the end)").to_owned();
    Some(format!("line {} of {} and {}:\n{}\n{}", line + 1, a.lines().count(), b.lines().count(), show(a), show(b)))
}
