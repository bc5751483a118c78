//! `deckflex recover`: what can be read of a recording that was cut, as a complete file that every reader opens.

use recording::{Event, FormatError, Reader, Writer};
use std::collections::BTreeMap;
use std::fmt;
use std::fs::{self, File};
use std::io::{self, BufReader, BufWriter, Write};
use std::path::{Path, PathBuf};

/// Bytes of messages in a chunk.
const CHUNK: u64 = 1 << 18;

/// Why a recording could not be recovered.
#[derive(Debug, thiserror::Error)]
pub enum RecoverError {
    /// The recording cannot be opened.
    #[error("{}: cannot read the recording: {source}", path.display())]
    Unreadable {
        /// The recording.
        path: PathBuf,
        /// The operating system's answer.
        source: io::Error,
    },
    /// Nothing can be read of it.
    #[error("{}: not a recording, or one of which nothing is left: {reason}", path.display())]
    Nothing {
        /// The recording.
        path: PathBuf,
        /// What stands in the way.
        reason: String,
    },
    /// The new file exists already.
    #[error("{} exists already", .0.display())]
    Exists(PathBuf),
    /// The new file cannot be written.
    #[error("cannot write {}: {source}", path.display())]
    Output {
        /// The new file.
        path: PathBuf,
        /// What stands in the way.
        source: FormatError,
    },
}

/// What was recovered.
#[derive(Clone, Debug)]
pub struct Report {
    /// The new file.
    pub path: PathBuf,
    /// Messages by topic, with the time of the last one since 1970, s.
    pub topics: BTreeMap<String, (u64, f64)>,
    /// Bytes at the end that could not be read, and why; `None` for a complete recording.
    pub cut: Option<(u64, String)>,
}

/// Writes what can be read of a recording into a new file, by default beside it.
///
/// # Errors
/// Nothing can be read, or the new file exists or cannot be written; a file that was begun is then removed.
pub fn run(path: &Path, out: Option<&Path>) -> Result<Report, RecoverError> {
    let unreadable = |source| RecoverError::Unreadable { path: path.to_path_buf(), source };
    let file = File::open(path).map_err(unreadable)?;
    let length = file.metadata().map_err(unreadable)?.len();
    let mut reader = Reader::new(BufReader::new(file));
    let Some(first) = reader.next() else {
        let reason = reader.cut().unwrap_or("it is empty").to_owned();
        return Err(RecoverError::Nothing { path: path.to_path_buf(), reason });
    };
    let out = out.map_or_else(|| path.with_extension("recovered.mcap"), Path::to_path_buf);
    let output = |source| RecoverError::Output { path: out.clone(), source };
    let file = File::create_new(&out).map_err(|source| match source.kind() {
        io::ErrorKind::AlreadyExists => RecoverError::Exists(out.clone()),
        _ => output(FormatError::File(source.into())),
    })?;
    let mut topics = BTreeMap::new();
    let events = std::iter::once(first).chain(reader.by_ref());
    if let Err(error) = copy(events, BufWriter::new(file), &mut topics) {
        // half a copy would look like the whole
        let _ = fs::remove_file(&out);
        return Err(output(error));
    }
    let cut = reader.cut().map(|reason| (length.saturating_sub(reader.sound_bytes()), reason.to_owned()));
    Ok(Report { path: out, topics, cut })
}

fn copy(
    events: impl Iterator<Item = Event>,
    out: BufWriter<File>,
    topics: &mut BTreeMap<String, (u64, f64)>,
) -> Result<(), FormatError> {
    let mut writer = Writer::copying(out)?;
    for event in events {
        match event {
            Event::Metadata(metadata) => writer.metadata(&metadata)?,
            Event::Message(message) => {
                writer.copy(&message)?;
                let (count, last_s) = topics.entry(message.channel.topic.clone()).or_insert((0, 0.0));
                (*count, *last_s) = (*count + 1, message.log_time as f64 * 1e-9);
            }
        }
        if writer.held() > CHUNK {
            writer.flush()?;
        }
    }
    writer.finish_as_is()?.flush().map_err(|error| FormatError::File(error.into()))
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}", self.path.display())?;
        let last = self.topics.values().fold(0.0, |a: f64, (_, last_s)| a.max(*last_s));
        for (topic, (count, last_s)) in &self.topics {
            writeln!(f, "  {count:>9} {topic}, the last {:.3} s before the end", last - last_s)?;
        }
        match &self.cut {
            Some((bytes, reason)) => {
                write!(f, "cut: the end is missing ({reason}), and of what is there {bytes} bytes cannot be read")
            }
            None => write!(f, "the recording was complete"),
        }
    }
}
