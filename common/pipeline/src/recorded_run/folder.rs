//! The files of a run in a folder.

use super::about;
use super::files::numbered;
use crate::recording::RecordingError;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The file that stands for a run: the first one that is there if a folder is named, otherwise what is named.
///
/// # Errors
/// The folder cannot be read, or holds no run or more than one.
pub fn first_file(path: &Path) -> Result<PathBuf, RecordingError> {
    if !path.is_dir() {
        return Ok(path.to_path_buf());
    }
    let unreadable = |reason| RecordingError::Unreadable { path: path.to_path_buf(), reason };
    let mut runs: BTreeMap<u64, BTreeMap<u64, PathBuf>> = BTreeMap::new();
    for entry in std::fs::read_dir(path).map_err(unreadable)? {
        let file = entry.map_err(unreadable)?.path();
        // one that is cut before it says whose it is stands for nothing
        if let (Some((_, number)), Ok(about)) = (numbered(&file), about(&file)) {
            runs.entry(about.run_id).or_default().insert(number, file);
        }
    }
    let none = |reason: &str| RecordingError::NoRun { path: path.to_path_buf(), reason: reason.to_owned() };
    match runs.len() {
        0 => Err(none("the folder holds no file `..._<number>.mcap` of one")),
        1 => runs.into_values().flat_map(BTreeMap::into_values).next().ok_or_else(|| none("it is empty")),
        n => Err(none(&format!("the folder holds files of {n} runs: name the first file of one"))),
    }
}
