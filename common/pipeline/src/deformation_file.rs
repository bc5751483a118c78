//! Files of a deformation against time: solution files, and what a reference unit or a simulator gives in the same columns.

use csv::{ReaderBuilder, StringRecord};
use frames::{Main, Rot, Sub, Vec3, unit};
use std::path::{Path, PathBuf};

/// Why such a file cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum DeformationFileError {
    /// The file cannot be opened or read on.
    #[error("{}: cannot read the file: {reason}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the operating system or the reader says.
        reason: csv::Error,
    },
    /// Columns are missing.
    #[error("{}: needs the column t_s and either q_w, q_x, q_y, q_z or phi_x_arcsec, phi_y_arcsec, phi_z_arcsec", .0.display())]
    Columns(PathBuf),
    /// No row can be used.
    #[error("{}: no row holds a valid deformation ({invalid} invalid or empty, {refused} unreadable)", path.display())]
    Empty {
        /// The file.
        path: PathBuf,
        /// Rows without a valid deformation.
        invalid: u64,
        /// Rows that are not numbers.
        refused: u64,
    },
}

/// A valid deformation at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// Time of validity, s.
    pub t: f64,
    /// `C_s^m`.
    pub rotation: Rot<Main, Sub>,
    /// Half width of the 95 % range about each axis of m, rad, if the file tells one.
    pub range: Option<[f64; 3]>,
}

/// The valid rows of a file, in the order of time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DeformationFile {
    /// The rows.
    pub rows: Vec<Row>,
    /// Rows that say that they are invalid, or hold no deformation.
    pub invalid: u64,
    /// Rows that are not numbers, or not later than the one before.
    pub refused: u64,
}

struct Columns {
    time: usize,
    valid: Option<usize>,
    rotation: Rotation,
    range: Option<[usize; 3]>,
}

enum Rotation {
    Quaternion([usize; 4]),
    Vector([usize; 3]),
}

impl Columns {
    fn of(header: &StringRecord) -> Option<Self> {
        let at = |name: &str| header.iter().position(|column| column.trim() == name);
        let three = |names: [&str; 3]| Some([at(names[0])?, at(names[1])?, at(names[2])?]);
        let quaternion = || Some([at("q_w")?, at("q_x")?, at("q_y")?, at("q_z")?]);
        let vector = three(["phi_x_arcsec", "phi_y_arcsec", "phi_z_arcsec"]);
        Some(Self {
            time: at("t_s")?,
            valid: at("valid"),
            rotation: quaternion().map(Rotation::Quaternion).or(vector.map(Rotation::Vector))?,
            range: three(["range_x_arcsec", "range_y_arcsec", "range_z_arcsec"]),
        })
    }

    /// The outer `None` refuses the row, the inner one says that it has no valid deformation.
    fn parse(&self, record: &StringRecord) -> Option<Option<Row>> {
        let text = |i: usize| record.get(i).map(str::trim);
        let number = |i: usize| text(i)?.parse::<f64>().ok().filter(|v| v.is_finite());
        let t = number(self.time)?;
        let first = match &self.rotation {
            Rotation::Quaternion(at) => at[0],
            Rotation::Vector(at) => at[0],
        };
        let is_invalid = match self.valid {
            Some(i) => text(i)? != "1",
            None => false,
        };
        if is_invalid || text(first)?.is_empty() {
            return Some(None);
        }
        let three = |at: [usize; 3]| Some([number(at[0])?, number(at[1])?, number(at[2])?]);
        let rotation = match self.rotation {
            Rotation::Quaternion(at) => {
                Rot::from_quaternion([number(at[0])?, number(at[1])?, number(at[2])?, number(at[3])?])?
            }
            Rotation::Vector(at) => Rot::exp(Vec3::from(three(at)?.map(|v| v * unit::ARCSEC))),
        };
        let range = self.range.and_then(three).map(|range| range.map(|v| v * unit::ARCSEC));
        Some(Some(Row { t, rotation, range }))
    }
}

impl DeformationFile {
    /// Reads a file whole.
    ///
    /// # Errors
    /// The file cannot be read, lacks columns or has no valid row.
    pub fn read(path: &Path) -> Result<Self, DeformationFileError> {
        let unreadable = |reason| DeformationFileError::Unreadable { path: path.to_path_buf(), reason };
        let mut reader = ReaderBuilder::new().flexible(true).quoting(false).from_path(path).map_err(unreadable)?;
        let header = reader.headers().map_err(unreadable)?;
        let columns = Columns::of(header).ok_or_else(|| DeformationFileError::Columns(path.to_path_buf()))?;
        let mut file = Self::default();
        let mut record = StringRecord::new();
        loop {
            match reader.read_record(&mut record) {
                Ok(false) => break,
                Ok(true) => file.take(columns.parse(&record)),
                // text that is no text, in one row
                Err(error) if matches!(error.kind(), csv::ErrorKind::Utf8 { .. }) => file.refused += 1,
                Err(error) => return Err(unreadable(error)),
            }
        }
        if file.rows.is_empty() {
            let Self { invalid, refused, .. } = file;
            return Err(DeformationFileError::Empty { path: path.to_path_buf(), invalid, refused });
        }
        Ok(file)
    }

    fn take(&mut self, row: Option<Option<Row>>) {
        let last = self.rows.last().map(|row| row.t);
        match row {
            Some(Some(row)) if last.is_none_or(|last| row.t > last) => self.rows.push(row),
            Some(None) => self.invalid += 1,
            _ => self.refused += 1,
        }
    }
}
