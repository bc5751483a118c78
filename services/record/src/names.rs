//! The files of a run: `<when it was launched>-<run id>_<number>.mcap`.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

/// The names of a run's files in a folder.
#[derive(Debug)]
pub struct Names {
    folder: PathBuf,
    stem: String,
    next: u64,
}

impl Names {
    /// Goes on behind the files that an earlier recorder of the same run has left.
    pub fn new(folder: &Path, run_id: u64, launched: SystemTime) -> Self {
        let date: String = humantime::format_rfc3339_seconds(launched).to_string().replace(['-', ':'], "");
        let mut names = Self { folder: folder.to_path_buf(), stem: format!("{date}-{run_id:x}"), next: 0 };
        // what the clock said then may differ by a second from what it says now
        let ending = format!("-{run_id:x}");
        let found = names.numbered().into_iter().filter(|(_, stem, _)| stem.ends_with(&ending));
        if let Some((number, stem, _)) = found.max_by_key(|(number, ..)| *number) {
            (names.stem, names.next) = (stem, number + 1);
        }
        names
    }

    /// The number of the next file.
    pub fn next(&self) -> u64 {
        self.next
    }

    /// Its path.
    pub fn path(&self) -> PathBuf {
        self.folder.join(format!("{}_{:03}.mcap", self.stem, self.next))
    }

    /// Notes that it has been made.
    pub fn advance(&mut self) {
        self.next += 1;
    }

    /// Notes that the last one is gone again.
    pub fn withdraw(&mut self) {
        self.next -= 1;
    }

    /// The run's files with their sizes, the oldest first.
    pub fn files(&self) -> Vec<(PathBuf, u64)> {
        let mut files: Vec<_> = self.numbered().into_iter().filter(|(_, stem, _)| *stem == self.stem).collect();
        files.sort_by_key(|(number, ..)| *number);
        let size = |path: &PathBuf| fs::metadata(path).map_or(0, |data| data.len());
        files.into_iter().map(|(.., path)| (size(&path), path)).map(|(size, path)| (path, size)).collect()
    }

    /// All files of the folder that have such a name: number, stem and path.
    fn numbered(&self) -> Vec<(u64, String, PathBuf)> {
        let Ok(entries) = fs::read_dir(&self.folder) else { return Vec::new() };
        let parse = |path: PathBuf| {
            let (stem, number) = path.file_name()?.to_str()?.strip_suffix(".mcap")?.rsplit_once('_')?;
            Some((number.parse().ok()?, stem.to_owned(), path))
        };
        entries.flatten().filter_map(|entry| parse(entry.path())).collect()
    }

    /// Makes the folder where it does not exist.
    pub fn make_folder(&self) -> io::Result<()> {
        fs::create_dir_all(&self.folder)
    }
}
