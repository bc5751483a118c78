//! The rows of a recording as they stand in the file.

use super::RecordingError;
use super::columns::{Cells, Columns};
use csv::{ByteRecord, Reader, ReaderBuilder};
use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

/// A recording that is read row by row.
#[derive(Debug)]
pub(super) struct Rows {
    path: PathBuf,
    reader: Reader<File>,
    record: ByteRecord,
    /// Where the file ends if its last line does not.
    cut_at: Option<u64>,
    pub(super) columns: Columns,
}

impl Rows {
    pub(super) fn open(path: &Path) -> Result<Self, RecordingError> {
        let unreadable = |reason| RecordingError::Unreadable { path: path.to_path_buf(), reason };
        let mut file = File::open(path).map_err(unreadable)?;
        let cut_at = cut(&mut file).map_err(unreadable)?;
        // a stray quotation mark would otherwise swallow all lines up to the next one
        let mut reader = ReaderBuilder::new().flexible(true).quoting(false).from_reader(file);
        let header = reader.byte_headers().map_err(|error| unreadable(error.into()))?;
        let columns =
            Columns::of(header).map_err(|reason| RecordingError::Header { path: path.to_path_buf(), reason })?;
        Ok(Self { path: path.to_path_buf(), reader, record: ByteRecord::new(), cut_at, columns })
    }

    /// The next row, `Some(None)` if it cannot be used; `None` at the end.
    pub(super) fn next(&mut self) -> Result<Option<Option<Cells>>, RecordingError> {
        match self.reader.read_byte_record(&mut self.record) {
            Ok(false) => Ok(None),
            Ok(true) if Some(self.reader.position().byte()) == self.cut_at => Ok(Some(None)),
            Ok(true) => Ok(Some(self.columns.parse(&self.record))),
            Err(error) => Err(RecordingError::Unreadable { path: self.path.clone(), reason: error.into() }),
        }
    }
}

/// The length of a file whose last line has no end. Its last number may be cut in the middle and look sound.
fn cut(file: &mut File) -> std::io::Result<Option<u64>> {
    let length = file.metadata()?.len();
    if length == 0 {
        return Ok(None);
    }
    let mut last = [0];
    file.seek(SeekFrom::End(-1))?;
    file.read_exact(&mut last)?;
    file.seek(SeekFrom::Start(0))?;
    Ok((last != *b"\n").then_some(length))
}
