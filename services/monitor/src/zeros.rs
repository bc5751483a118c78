//! A zero into the configuration, and the file that tells of all of them.

use frames::{Vec3, unit};
use messages::Solution;
use pipeline::configuration::{Configuration, ConfigurationError};
use pipeline::zero::{NoZero, Zero};
use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};
use toml_edit::{Array, DocumentMut, Item, Table, Value};

const HEADER: &str = "utc_s,t_s,run_id,area,old_x_deg,old_y_deg,old_z_deg,new_x_deg,new_y_deg,new_z_deg,solutions,\
range_x_arcmin,range_y_arcmin,range_z_arcmin\n";
const KEY: &str = "zero_deg";

/// Why a zero was not written.
#[derive(Debug, thiserror::Error)]
pub enum ZeroError {
    /// The solutions do not give one.
    #[error(transparent)]
    Refused(#[from] NoZero),
    /// A recorded run is what it is.
    #[error("the launch plays back a recorded run, whose configuration stays as it is")]
    Recorded,
    /// The configuration has no table of its own for the area.
    #[error("{} has no [[area]] named \"{area}\" to write to", path.display())]
    NoArea {
        /// The configuration.
        path: PathBuf,
        /// Name of the area.
        area: String,
    },
    /// The file is not as it was when the launch began, and cannot be used now.
    #[error(transparent)]
    Configuration(#[from] ConfigurationError),
    /// A file cannot be written.
    #[error("cannot write {}: {reason}", path.display())]
    File {
        /// Which.
        path: PathBuf,
        /// The operating system's reason.
        reason: io::Error,
    },
}

/// Where zeros go.
#[derive(Clone, Copy, Debug)]
pub struct Place<'a> {
    /// The configuration of the launch.
    pub configuration: &'a Path,
    /// The file of all zeros.
    pub zeros: &'a Path,
    /// Name of the area.
    pub area: &'a str,
}

impl Place<'_> {
    /// Writes the zero of an area into the configuration, and a line about it into the file of zeros; `last` is the newest solution.
    ///
    /// # Errors
    /// One of the files cannot be written, or the configuration cannot be used; it then is as it was.
    pub fn write(&self, zero: &Zero, last: &Solution) -> Result<(), ZeroError> {
        let before = Configuration::read(self.configuration)?;
        let area = before.areas.iter().find(|area| area.name == self.area);
        let old = area.map_or(Vec3::ZERO, |area| area.zero).array().map(|x| x / unit::DEGREE);
        // what the file can hold is what is told
        let new = zero.value.array().map(|x| (x / unit::DEGREE * 1e6).round() / 1e6);
        let text = self.edited(&Configuration::text(self.configuration)?, new)?;
        Configuration::parse(self.configuration, &text)?;
        let file = |path: &Path| {
            let path = path.to_path_buf();
            |reason| ZeroError::File { path, reason }
        };
        // first, so that no zero goes without a record for want of a place
        let mut record = self.open().map_err(file(self.zeros))?;
        replace(self.configuration, &text).map_err(file(self.configuration))?;
        let line = self.line(old, new, zero, last);
        record.write_all(line.as_bytes()).map_err(file(self.zeros))
    }

    /// The text with the zero, its comments and layout kept.
    fn edited(&self, text: &str, zero_deg: [f64; 3]) -> Result<String, ZeroError> {
        let no_area = || ZeroError::NoArea { path: self.configuration.to_path_buf(), area: self.area.to_owned() };
        // what is no TOML has been refused by the reading before
        let mut document: DocumentMut = text.parse().map_err(|_| no_area())?;
        let areas = document.get_mut("area").and_then(Item::as_array_of_tables_mut).ok_or_else(no_area)?;
        let is_it = |table: &&mut Table| table.get("name").and_then(Item::as_str) == Some(self.area);
        let table = areas.iter_mut().find(is_it).ok_or_else(no_area)?;
        let mut value = Value::from(zero_deg.into_iter().collect::<Array>());
        if let Some(old) = table.get(KEY).and_then(Item::as_value) {
            *value.decor_mut() = old.decor().clone();
        }
        table[KEY] = Item::Value(value);
        Ok(document.to_string())
    }

    fn open(&self) -> io::Result<File> {
        let mut file = OpenOptions::new().create(true).append(true).open(self.zeros)?;
        if file.metadata()?.len() == 0 {
            file.write_all(HEADER.as_bytes())?;
        }
        Ok(file)
    }

    fn line(&self, old: [f64; 3], new: [f64; 3], zero: &Zero, last: &Solution) -> String {
        let utc = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0.0, |since| since.as_secs_f64());
        let three = |v: [f64; 3], digits: usize| v.map(|x| format!("{x:.digits$}")).join(",");
        let (t, run_id, area) = (unit::seconds(last.header.time_ns), last.header.run_id, self.area);
        let (old, new, range) = (three(old, 6), three(new, 6), three(zero.range.map(|x| x / unit::ARCMIN), 3));
        format!("{utc:.3},{t},{run_id},{area},{old},{new},{},{range}\n", zero.solutions)
    }
}

/// Gives a file another text, all of it or nothing, with the rights that it has.
fn replace(path: &Path, text: &str) -> io::Result<()> {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(".zero");
    let other = path.with_file_name(name);
    let written = write_beside(path, &other, text).and_then(|()| fs::rename(&other, path));
    if written.is_err() {
        // the first error is the one that tells
        let _ = fs::remove_file(&other);
    }
    written
}

fn write_beside(path: &Path, other: &Path, text: &str) -> io::Result<()> {
    let mut file = File::create(other)?;
    file.set_permissions(fs::metadata(path)?.permissions())?;
    file.write_all(text.as_bytes())?;
    file.sync_all()
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use messages::Header;

    fn demo() -> String {
        fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../config/two_areas.toml")).unwrap()
    }

    fn zero(x: f64) -> Zero {
        Zero { value: Vec3::new(x, -0.25, 1.0) * unit::DEGREE, solutions: 6001, range: [unit::ARCMIN; 3] }
    }

    fn last() -> Solution {
        Solution { header: Header { run_id: 7, time_ns: 61_500_000_000, ..Header::default() }, ..Solution::default() }
    }

    #[test]
    fn one_line_is_new_or_changed_and_the_rest_of_the_file_stays() {
        let folder = tempfile::tempdir().unwrap();
        let [path, zeros] = ["two.toml", "zeros.csv"].map(|name| folder.path().join(name));
        let text = demo();
        fs::write(&path, &text).unwrap();
        let area = Configuration::parse(&path, &text).unwrap().areas[1].name.clone();
        let place = Place { configuration: &path, zeros: &zeros, area: &area };
        place.write(&zero(0.123_456_789), &last()).unwrap();
        let first = fs::read_to_string(&path).unwrap();
        place.write(&zero(1.5), &last()).unwrap();
        let second = fs::read_to_string(&path).unwrap();
        for (told, x) in [(&first, "0.123457"), (&second, "1.5")] {
            let line = format!("zero_deg = [{x}, -0.25, 1.0]");
            let without: Vec<&str> = told.lines().filter(|found| *found != line).collect();
            assert_eq!(without, text.lines().collect::<Vec<_>>());
            assert_eq!(told.lines().count(), text.lines().count() + 1);
        }
        let areas = Configuration::read(&path).unwrap().areas;
        assert_eq!(areas[0].zero, Vec3::ZERO);
        assert_eq!(areas[1].zero, Vec3::new(1.5, -0.25, 1.0) * unit::DEGREE);

        let told = fs::read_to_string(&zeros).unwrap();
        let rows: Vec<Vec<&str>> = told.lines().map(|line| line.split(',').collect()).collect();
        assert_eq!(rows[0].join(",") + "\n", HEADER);
        let ending = |old: &'static str, new: &'static str| format!("61.5,7,{area},{old},{new},6001,1.000,1.000,1.000");
        assert_eq!(rows[1][1..].join(","), ending("0.000000,0.000000,0.000000", "0.123457,-0.250000,1.000000"));
        assert_eq!(rows[2][1..].join(","), ending("0.123457,-0.250000,1.000000", "1.500000,-0.250000,1.000000"));
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2, "something is left beside the files");
    }

    #[test]
    fn the_file_stays_as_it_is_where_there_is_no_place_for_a_zero_or_for_its_record() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("two.toml");
        let text = demo();
        fs::write(&path, &text).unwrap();
        let area = Configuration::parse(&path, &text).unwrap().areas[0].name.clone();
        let (good, bad) = (folder.path().join("zeros.csv"), folder.path().join("no/zeros.csv"));
        let errors = [
            Place { configuration: &path, zeros: &bad, area: &area }.write(&zero(1.0), &last()).unwrap_err(),
            Place { configuration: &path, zeros: &good, area: "funnel" }.write(&zero(1.0), &last()).unwrap_err(),
            Place { configuration: &path, zeros: &good, area: &area }.write(&zero(20.0), &last()).unwrap_err(),
        ];
        for (error, words) in
            errors.iter().zip(["cannot write", "no [[area]] named \"funnel\"", "must be within -5 to 5"])
        {
            assert!(error.to_string().contains(words), "{error}");
        }
        assert_eq!(fs::read_to_string(&path).unwrap(), text);
        assert!(!good.exists());
    }
}
