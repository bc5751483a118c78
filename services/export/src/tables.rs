//! Every topic but the samples and the estimators' states: one table each.

use messages::topic;
use pipeline::configuration::Configuration;
use pipeline::solution_file::{self, SolutionFile};
use recording::Record;
use std::collections::{BTreeMap, HashMap};
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// The tables of a run.
pub struct Tables {
    folder: PathBuf,
    /// By topic.
    solutions: HashMap<String, String>,
    open: BTreeMap<PathBuf, (Table, u64)>,
}

enum Table {
    Solutions(SolutionFile<BufWriter<File>>),
    Fields(BufWriter<File>),
}

impl Tables {
    /// Tables that come into being with their first rows.
    pub fn new(folder: &Path, configuration: &Configuration) -> Self {
        let names = configuration.areas.iter().map(|area| area.name.clone());
        let solutions = names.map(|name| (topic::solution(&name).name, name)).collect();
        Self { folder: folder.to_path_buf(), solutions, open: BTreeMap::new() }
    }

    /// Adds a row; samples and the attitude that goes with them have files of their own.
    pub fn write(&mut self, topic: &str, record: &Record) -> io::Result<()> {
        if matches!(record, Record::Sample(_) | Record::Attitude(_) | Record::State(_)) {
            return Ok(());
        }
        let area = self.solutions.get(topic);
        let path = match area {
            Some(area) => solution_file::path(&self.folder, area),
            None => self.folder.join(format!("{}.csv", topic.replace('/', "_"))),
        };
        if !self.open.contains_key(&path) {
            let table = match area {
                Some(area) => Table::Solutions(SolutionFile::create(&self.folder, area)?),
                None => {
                    let mut out = BufWriter::new(File::create(&path)?);
                    writeln!(out, "{}", record.columns().join(","))?;
                    Table::Fields(out)
                }
            };
            self.open.insert(path.clone(), (table, 0));
        }
        match (self.open.get_mut(&path), record) {
            (Some((Table::Solutions(file), rows)), Record::Solution(solution)) => {
                *rows += 1;
                file.write(solution)
            }
            (Some((Table::Fields(out), rows)), record) => {
                *rows += 1;
                writeln!(out, "{}", record.values().join(","))
            }
            _ => Ok(()),
        }
    }

    /// Completes the files; gives them with their rows.
    pub fn finish(self) -> io::Result<Vec<(PathBuf, u64)>> {
        let mut written = Vec::new();
        for (path, (table, rows)) in self.open {
            match table {
                Table::Solutions(file) => file.finish()?.flush()?,
                Table::Fields(mut out) => out.flush()?,
            }
            written.push((path, rows));
        }
        Ok(written)
    }
}
