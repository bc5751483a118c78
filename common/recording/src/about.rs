use std::collections::BTreeMap;

/// What a recording says about itself at its beginning.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct About {
    /// Version of the program.
    pub version: String,
    /// The run, the same in all its files.
    pub run_id: u64,
    /// The number of the file within the run, from 0.
    pub part: u64,
    /// Whether the file begins before the run's first sample, so that all that led to its solutions stands in it.
    pub from_the_start: bool,
    /// Name of the configuration's file.
    pub path: String,
    /// Its text.
    pub configuration: String,
}

/// What a recording says about itself at its end.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Ending {
    /// Whether the streams ended, so that there is no further file.
    pub end_of_run: bool,
    /// Messages of the run so far that are in no file: the disk was full, or too slow.
    pub dropped: u64,
    /// Messages that did not reach the recorder.
    pub lost: u64,
}

const ABOUT: &str = "deckflex";
const ENDING: &str = "deckflex.end";

fn number(map: &BTreeMap<String, String>, key: &str) -> Option<u64> {
    map.get(key)?.parse().ok()
}

impl About {
    pub(crate) fn metadata(&self) -> mcap::records::Metadata {
        let pairs = [
            ("version", self.version.clone()),
            ("run_id", self.run_id.to_string()),
            ("part", self.part.to_string()),
            ("from_the_start", u8::from(self.from_the_start).to_string()),
            ("path", self.path.clone()),
            ("configuration", self.configuration.clone()),
        ];
        mcap::records::Metadata { name: ABOUT.to_owned(), metadata: map(pairs) }
    }

    /// From the metadata of this name; `None` if they are others or not whole.
    pub fn from_metadata(name: &str, map: &BTreeMap<String, String>) -> Option<Self> {
        let text = |key: &str| map.get(key).cloned();
        (name == ABOUT).then_some(())?;
        Some(Self {
            version: text("version")?,
            run_id: number(map, "run_id")?,
            part: number(map, "part")?,
            from_the_start: number(map, "from_the_start")? != 0,
            path: text("path")?,
            configuration: text("configuration")?,
        })
    }
}

impl Ending {
    pub(crate) fn metadata(&self) -> mcap::records::Metadata {
        let pairs = [
            ("end_of_run", u8::from(self.end_of_run).to_string()),
            ("dropped", self.dropped.to_string()),
            ("lost", self.lost.to_string()),
        ];
        mcap::records::Metadata { name: ENDING.to_owned(), metadata: map(pairs) }
    }

    /// From the metadata of this name; `None` if they are others or not whole.
    pub fn from_metadata(name: &str, map: &BTreeMap<String, String>) -> Option<Self> {
        (name == ENDING).then_some(())?;
        Some(Self {
            end_of_run: number(map, "end_of_run")? != 0,
            dropped: number(map, "dropped")?,
            lost: number(map, "lost")?,
        })
    }
}

fn map<const N: usize>(pairs: [(&str, String); N]) -> BTreeMap<String, String> {
    pairs.into_iter().map(|(key, value)| (key.to_owned(), value)).collect()
}
