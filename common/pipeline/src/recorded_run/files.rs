use crate::recording::RecordingError;
use recording::{About, Ending, Event, MAGIC, Reader, Record};
use std::collections::VecDeque;
use std::fs::File;
use std::io::{BufReader, Read};
use std::path::{Path, PathBuf};

/// Whether a file is a recorded run and not the text of a configuration.
pub fn is_one(path: &Path) -> bool {
    let mut start = [0; MAGIC.len()];
    File::open(path).and_then(|mut file| file.read_exact(&mut start)).is_ok() && start == *MAGIC
}

/// What a recorded run says about itself.
///
/// # Errors
/// The file cannot be read or is no recorded run.
pub fn about(path: &Path) -> Result<About, RecordingError> {
    open(path).map(|(_, about)| about)
}

type FileReader = Reader<BufReader<File>>;

fn open(path: &Path) -> Result<(FileReader, About), RecordingError> {
    let file = File::open(path).map_err(|reason| RecordingError::Unreadable { path: path.to_path_buf(), reason })?;
    let mut reader = Reader::new(BufReader::with_capacity(1 << 16, file));
    let about = match reader.next() {
        Some(Event::Metadata(metadata)) => About::from_metadata(&metadata.name, &metadata.metadata),
        _ => None,
    };
    match about {
        Some(about) => Ok((reader, about)),
        None => {
            let reason = reader.cut().unwrap_or("it does not begin with what deckflex says of a run").to_owned();
            Err(RecordingError::NoRun { path: path.to_path_buf(), reason })
        }
    }
}

/// The messages of a recorded run in the order in which they were recorded, through all its files.
///
/// What is cut off a file is missing, and so is what cannot be read.
pub struct Files {
    reader: FileReader,
    about: About,
    path: PathBuf,
    further: VecDeque<PathBuf>,
    ending: Option<Ending>,
    cuts: Vec<(PathBuf, String)>,
    unreadable: u64,
    recorded_ns: u64,
}

impl Files {
    /// Opens the file and those in which it goes on.
    ///
    /// # Errors
    /// The file cannot be read or is no recorded run, or a file of the run is missing between two that are there.
    pub fn open(path: &Path) -> Result<Self, RecordingError> {
        let (reader, about) = open(path)?;
        let (path, further) = (path.to_path_buf(), further(path, about.run_id)?);
        Ok(Self { reader, about, path, further, ending: None, cuts: Vec::new(), unreadable: 0, recorded_ns: 0 })
    }

    /// What the first file says about itself.
    pub fn about(&self) -> &About {
        &self.about
    }

    /// What the last file said at its end; `None` if it is cut, or not yet there.
    pub fn ending(&self) -> Option<Ending> {
        self.ending
    }

    /// The files that were found cut, and why.
    pub fn cuts(&self) -> &[(PathBuf, String)] {
        &self.cuts
    }

    /// Messages that cannot be read.
    pub fn unreadable(&self) -> u64 {
        self.unreadable
    }

    /// When the last message that was given was recorded, ns since 1970; 0 before there is one.
    pub fn recorded_ns(&self) -> u64 {
        self.recorded_ns
    }

    /// Goes on in the next file of the run; `false` if there is none.
    fn go_on(&mut self) -> bool {
        if let Some(reason) = self.reader.cut() {
            self.cuts.push((self.path.clone(), reason.to_owned()));
        }
        let Some(path) = self.further.pop_front() else { return false };
        match open(&path) {
            Ok((reader, about)) if about.run_id == self.about.run_id => {
                (self.reader, self.path, self.ending) = (reader, path, None);
                true
            }
            Ok(_) => false,
            Err(error) => {
                self.cuts.push((path, error.to_string()));
                // one that the disk had no room for may be followed by others
                self.go_on()
            }
        }
    }
}

impl Iterator for Files {
    /// Topic and message.
    type Item = (String, Record);

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            match self.reader.next() {
                Some(Event::Message(message)) => match message.record() {
                    Ok(Some(record)) => {
                        self.recorded_ns = message.log_time;
                        return Some((message.channel.topic.clone(), record));
                    }
                    // a topic of somebody else
                    Ok(None) => {}
                    Err(_) => self.unreadable += 1,
                },
                Some(Event::Metadata(metadata)) => {
                    let ending = Ending::from_metadata(&metadata.name, &metadata.metadata);
                    self.ending = ending.or(self.ending);
                }
                None if self.go_on() => {}
                None => return None,
            }
        }
    }
}

/// The files in which a file goes on, by the number at the end of its name.
fn further(path: &Path, run_id: u64) -> Result<VecDeque<PathBuf>, RecordingError> {
    let Some((stem, own)) = numbered(path) else { return Ok(VecDeque::new()) };
    let name = |number: u64| path.with_file_name(format!("{stem}_{number:03}.mcap"));
    let files: VecDeque<PathBuf> = (own + 1..).map(name).take_while(|path| path.exists()).collect();
    let missing = own + 1 + files.len() as u64;
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    let later = entries.filter(|path| numbered(path).is_some_and(|(of, number)| of == stem && number > missing));
    match later.filter(|path| about(path).is_ok_and(|about| about.run_id == run_id)).min() {
        Some(later) => Err(RecordingError::Hole { missing: name(missing), later }),
        None => Ok(files),
    }
}

/// The stem of a file's name and the number behind it.
pub(super) fn numbered(path: &Path) -> Option<(&str, u64)> {
    let name = path.file_name()?.to_str()?.strip_suffix(".mcap")?;
    let (stem, number) = name.rsplit_once('_')?;
    Some((stem, number.parse().ok()?))
}
