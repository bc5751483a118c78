//! Recordings: CSV files with one row a sample, in time order.
//!
//! | columns | meaning |
//! |---|---|
//! | `t_s` | end of the row's interval, s |
//! | `gyro_{x,y,z}_rad_s` or `dtheta_{x,y,z}_rad` | mean rate over the interval, or angle increment over it |
//! | `accel_{x,y,z}_m_s2` or `dvel_{x,y,z}_m_s` | mean specific force, or velocity increment; may be absent |
//! | `roll_deg`, `pitch_deg`, `heading_deg` | attitude of the ship, main unit only; may be absent, and empty in a row |
//!
//! Columns stand in any order; others are ignored.

mod columns;
mod head;
mod rows;
mod series;

pub use head::{Head, head};
pub use series::{Series, series};

use columns::Cells;
use frames::unit;
use messages::{ClockDomain, Flags, Header, ImuSample, MainAttitude};
use rows::Rows;
use std::path::{Path, PathBuf};

/// Why a recording cannot be used, or ended early.
#[derive(Debug, thiserror::Error)]
pub enum RecordingError {
    /// The file cannot be opened or read on.
    #[error("{}: cannot read the recording: {reason}", path.display())]
    Unreadable {
        /// The recording.
        path: PathBuf,
        /// The operating system's reason.
        reason: std::io::Error,
    },
    /// The columns are not those of a recording.
    #[error("{}: the header is not recognised: {reason}", path.display())]
    Header {
        /// The recording.
        path: PathBuf,
        /// Which columns are missing.
        reason: String,
    },
    /// The file is no recorded run.
    #[error("{}: not a recorded run: {reason}", path.display())]
    NoRun {
        /// The file.
        path: PathBuf,
        /// What it lacks.
        reason: String,
    },
    /// A file of a recorded run is not there, though later ones are.
    #[error("{}: this file of the run is missing, though {} is there", missing.display(), later.display())]
    Hole {
        /// The file that is missing.
        missing: PathBuf,
        /// One that comes after it.
        later: PathBuf,
    },
    /// The recorded run has no samples of a unit.
    #[error("{}: the recorded run has no samples of {topic}; it has {known}", path.display())]
    NoUnit {
        /// The file.
        path: PathBuf,
        /// The topic that it lacks.
        topic: String,
        /// The topics of samples that it has.
        known: String,
    },
    /// There is a header, but no usable row.
    #[error("{}: no row can be used ({refused} refused)", path.display())]
    Empty {
        /// The recording.
        path: PathBuf,
        /// Rows that cannot be parsed.
        refused: u64,
    },
    /// Units on wires have no recording.
    #[error("sources of kind \"{0}\" give their samples live, to `launch`")]
    Live(&'static str),
}

/// What has been read so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Rows passed on.
    pub rows: u64,
    /// Rows that cannot be parsed: cut, too long, or not numbers.
    pub refused: u64,
    /// Rows passed on with the time of the row before.
    pub repeated: u64,
    /// Rows passed on with a time before that of the row before.
    pub back: u64,
    /// Rows passed on with a NaN or an infinity.
    pub not_finite: u64,
}

/// One row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// The sample, in the unit's case axes.
    pub sample: ImuSample,
    /// The attitude, if the row has one; of the main unit only. Its `sigma` is 0: a recording does not tell it.
    pub attitude: Option<MainAttitude>,
}

/// A recording as a stream of rows.
///
/// A row that cannot be parsed uses up a sequence number and is counted, and so does a last line without its line end, which may
/// be cut in the middle of a number. Repeated and backward times are passed on: the synchroniser decides about them.
#[derive(Debug)]
pub struct Recording {
    rows: Rows,
    unit: u32,
    run_id: u64,
    nominal_ns: i64,
    sequence: u64,
    previous_ns: Option<i64>,
    counts: Counts,
    error: Option<RecordingError>,
    ended: bool,
}

impl Recording {
    /// Opens the recording of a unit (0 for the main unit, otherwise 1 + the index of the area); `nominal_ns` is the interval of
    /// the configured rate.
    ///
    /// # Errors
    /// The file cannot be read, or its header is not recognised.
    pub fn open(path: &Path, unit: u32, run_id: u64, nominal_ns: i64) -> Result<Self, RecordingError> {
        Ok(Self {
            rows: Rows::open(path)?,
            unit,
            run_id,
            nominal_ns,
            sequence: 0,
            previous_ns: None,
            counts: Counts::default(),
            error: None,
            ended: false,
        })
    }

    /// What has been read so far.
    pub fn counts(&self) -> Counts {
        self.counts
    }

    /// Why the stream ended before the file did.
    pub fn error(&self) -> Option<&RecordingError> {
        self.error.as_ref()
    }

    /// Whether rows may carry an attitude.
    pub fn has_attitude(&self) -> bool {
        self.unit == 0 && self.rows.columns.attitude.is_some()
    }

    /// The time since the row before where that is plausible, or else the nominal interval.
    fn interval(&mut self, time_ns: i64) -> (i64, Flags) {
        let step = self.previous_ns.replace(time_ns).map(|previous| time_ns.saturating_sub(previous));
        match step {
            Some(0) => self.counts.repeated += 1,
            Some(step) if step < 0 => {
                self.counts.back += 1;
                return (self.nominal_ns, Flags::TIME_BACK);
            }
            Some(step) if step <= self.nominal_ns + self.nominal_ns / 2 => return (step, Flags::empty()),
            _ => {}
        }
        (self.nominal_ns, Flags::empty())
    }

    fn row(&mut self, cells: &Cells, sequence: u64) -> Row {
        let (interval_ns, mut flags) = self.interval(cells.time_ns);
        if !cells.gyro.iter().chain(cells.accel.iter().flatten()).all(|v| v.is_finite()) {
            flags |= Flags::NOT_FINITE;
            self.counts.not_finite += 1;
        }
        let header = Header {
            run_id: self.run_id,
            sequence,
            time_ns: cells.time_ns,
            clock_domain: ClockDomain::Recorded as u32,
            ..Header::default()
        };
        let interval = unit::seconds(interval_ns);
        let columns = &self.rows.columns;
        let dvel = columns.accel.zip(cells.accel).map_or([0.0; 3], |(triad, v)| triad.increment(v, interval));
        let dtheta = columns.gyro.increment(cells.gyro, interval);
        let attitude = cells.attitude.filter(|_| self.unit == 0);
        Row {
            sample: ImuSample { header, interval_ns, dtheta, dvel, flags, unit: self.unit, ordinal: 0 },
            attitude: attitude.map(|c| MainAttitude { header, q: c.quaternion(), sigma: [0.0; 3] }),
        }
    }
}

impl Iterator for Recording {
    type Item = Row;

    fn next(&mut self) -> Option<Row> {
        while !self.ended {
            match self.rows.next() {
                Ok(Some(cells)) => {
                    let sequence = self.sequence;
                    self.sequence += 1;
                    let Some(cells) = cells else {
                        self.counts.refused += 1;
                        continue;
                    };
                    self.counts.rows += 1;
                    return Some(self.row(&cells, sequence));
                }
                Ok(None) => self.ended = true,
                Err(error) => {
                    self.error = Some(error);
                    self.ended = true;
                }
            }
        }
        None
    }
}
