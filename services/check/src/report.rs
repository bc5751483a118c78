use pipeline::configuration::Configuration;
use pipeline::recorded_run::Course;
use pipeline::recording::Head;
use std::fmt;
use std::path::PathBuf;

/// What was found; its text is for people.
#[derive(Clone, Debug)]
pub struct Report {
    /// The configuration, which is sound.
    pub configuration: Configuration,
    /// The units that are recordings, the main unit first; none with the simulator.
    pub units: Vec<Unit>,
    /// How the recorded run went that is the source of all units.
    pub run: Option<Course>,
}

/// A unit that is a recording.
#[derive(Clone, Debug)]
pub struct Unit {
    /// `main`, or the name of the area.
    pub name: String,
    /// The recording.
    pub path: PathBuf,
    /// What its first rows show.
    pub head: Head,
}

impl Report {
    /// What looks wrong though it can be run, a sentence each, beginning with the name of the unit.
    pub fn suspicions(&self) -> Vec<String> {
        let mut all = Vec::new();
        for unit in &self.units {
            all.extend(unit.head.suspicions.iter().map(|text| format!("{}: {text}", unit.name)));
        }
        if let Some((main, areas)) = self.units.split_first() {
            let apart = areas.iter().filter(|area| !overlap(&main.head, &area.head));
            all.extend(apart.map(|area| format!("{}: has no time in common with main", area.name)));
        }
        all
    }
}

fn overlap(a: &Head, b: &Head) -> bool {
    a.span_s[0] <= b.span_s[1] && b.span_s[0] <= a.span_s[1]
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let c = &self.configuration;
        let names: Vec<&str> = c.areas.iter().map(|area| area.name.as_str()).collect();
        let kind = c.main.source.kind();
        writeln!(f, "{}: sound", c.path.display())?;
        writeln!(f, "  {} Hz, sources {kind}, areas {}", c.rate_hz, names.join(", "))?;
        for unit in &self.units {
            write!(f, "{unit}")?;
        }
        self.run.iter().try_for_each(|run| write!(f, "{run}"))?;
        for text in self.suspicions() {
            writeln!(f, "suspicious: {text}")?;
        }
        Ok(())
    }
}

impl fmt::Display for Unit {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let h = &self.head;
        writeln!(f, "{}: {}", self.name, self.path.display())?;
        writeln!(f, "  first {} rows, {:.3} to {:.3} s, {:.4} Hz", h.rows, h.span_s[0], h.span_s[1], h.rate_hz)?;
        writeln!(
            f,
            "  gaps {}, repeated {}, back {}, refused {}, not finite {}",
            h.gaps, h.repeated, h.back, h.refused, h.not_finite
        )?;
        write!(f, "  gyro rms {:.6} rad/s", h.gyro_rms)?;
        match h.accel_norm {
            Some(norm) => write!(f, ", usual specific force {norm:.4} m/s^2")?,
            None => write!(f, ", no accelerometers")?,
        }
        if h.attitudes > 0 {
            write!(f, ", attitude in {} rows", h.attitudes)?;
        }
        writeln!(f)
    }
}
